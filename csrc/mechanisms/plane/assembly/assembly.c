/* The same steps as those of Python's assembly.py, which has more to say where something is wrong, and knows wishes and redundant
 * rows: least steps in the mass metric, in absolute coordinates, told in rad and parts of the mechanism's length.
 *
 * Where rows are independent, a least step with J x = r is x = W^-2 J^T (J W^-2 J^T)^-1 r, by orthogonalization of the rows of J W^-1; and
 * that of Levenberg and Marquardt, damped by mu, is x = -J^T (J J^T + mu)^-1 r.
 */
#include "assembly.h"

#include <math.h>
#include <string.h>

#include "../../../linalg/small.h"
#include "../plan.h"

static const double CLOSED = 1e-12;         /* these are as in assembly.py */
static const double SMALLEST = 1e-3;        /* and in assembly_rows.c */
static const double TRACKED = 0.1;
static const double LONGEST = 0.4;
static const double INDEPENDENT = 1e-7;     /* smallest relative pivot of an independent row */
enum { ATTEMPTS = 200, NEARER = 50, ITERATIONS = 40, POWERS = 200 };

/* ---- steps ---- */

/* x <- minimum-norm solution of J x = right in the mass metric. Returns 0 if rows are redundant. A redundant row of a staying coordinate,
 * as loops make them, is skipped where the other rows already satisfy it. */
static int least_step(zd_assembly *self, const double *right, double *x)
{
    const int n = self->n, m = self->rows;
    for (int k = 0; k < m; k++) {
        double *q = self->Q + k * n, *L = self->L + k * self->most;
        for (int i = 0; i < n; i++) q[i] = self->J[k * n + i] / self->weight[i];
        const double square = zd_dot(n, q, q);
        memset(L, 0, (size_t)k * sizeof *L);
        for (int j = 0; j < 2 * k; j++) {       /* twice is enough */
            const double *other = self->Q + (j % k) * n, along = zd_dot(n, other, q);
            L[j % k] += along;
            zd_add_scaled(n, q, -along, other);
        }
        const double rest = zd_dot(n, q, q);
        const int is_independent = rest > INDEPENDENT * INDEPENDENT * square;
        if (!is_independent && k < self->firm) return 0;
        L[k] = is_independent ? sqrt(rest) : 0;
        for (int i = 0; i < n; i++) q[i] = is_independent ? q[i] / L[k] : 0;
    }
    memset(x, 0, (size_t)n * sizeof *x);
    for (int k = 0; k < m; k++) {
        const double *L = self->L + k * self->most;
        self->y[k] = L[k] > 0 ? (right[k] - zd_dot(k, L, self->y)) / L[k] : 0;
        zd_add_scaled(n, x, self->y[k], self->Q + k * n);
    }
    for (int i = 0; i < n; i++) x[i] /= self->weight[i];
    return 1;
}

/* to <- p + step, with the step shortened so that no scaled coordinate moves by more than `longest` */
static void move(const zd_assembly *self, const double *p, double longest, double *step, double *to)
{
    const double most = zd_largest(self->n, step), share = most > longest ? longest / most : 1;
    for (int i = 0; i < self->n; i++) {
        step[i] *= share;
        to[i] = p[i] + step[i] * self->scale[i];
    }
}

/* Least steps until nothing gets better; returns whether that is near enough. */
static int newton(zd_assembly *self, const zd_assembly_problem *of, double *p)
{
    double best = zd_assembly_find(self, of, p);
    for (int i = 0; i < ITERATIONS && best >= 1e-15; i++) {
        if (!least_step(self, self->r, self->step)) return 0;
        for (int j = 0; j < self->n; j++) self->step[j] = -self->step[j];
        move(self, p, LONGEST, self->step, self->tried);
        const double error = zd_assembly_find(self, of, self->tried);
        if (!(error < best)) break;
        zd_copy(self->n, self->tried, p);
        best = error;
    }
    return best <= CLOSED;
}

/* L <- J J^T; returns its largest eigenvalue */
static double square_rows(zd_assembly *self)
{
    const int m = self->rows, n = self->n;
    double largest = 0;
    for (int i = 0; i < m; i++)
        for (int j = 0; j < m; j++) self->L[i * m + j] = zd_dot(n, self->J + i * n, self->J + j * n);
    for (int i = 0; i < m; i++) self->Q[i] = 1 + 1.0 / (i + 2);     /* a vector that is orthogonal to none of interest */
    for (int k = 0; k < POWERS; k++) {
        for (int i = 0; i < m; i++) self->y[i] = zd_dot(m, self->L + i * m, self->Q);
        largest = sqrt(zd_dot(m, self->y, self->y));
        for (int i = 0; i < m; i++) self->Q[i] = largest > 0 ? self->y[i] / largest : 0;
    }
    return largest;
}

/* step <- -J^T (J J^T + mu)^-1 r; L has J J^T, and keeps it */
static void damped_step(zd_assembly *self, double mu)
{
    const int m = self->rows, n = self->n;
    double *A = self->Q;        /* (m, m), m <= n of independent rows */
    zd_copy(m * m, self->L, A);
    for (int i = 0; i < m; i++) A[i * m + i] += mu;
    zd_cholesky(m, A, A);
    zd_forward(m, A, self->r, self->y);
    zd_backward(m, A, self->y, self->y);
    memset(self->step, 0, (size_t)n * sizeof *self->step);
    for (int k = 0; k < m; k++) zd_add_scaled(n, self->step, -self->y[k], self->J + k * n);
}

/* Levenberg's and Marquardt's method, then Newton's; returns whether the joints are closed. */
static int close_joints(zd_assembly *self, double *p)
{
    const zd_assembly_problem joints = {ZD_OF_JOINTS, 0, 0};
    double damping = 1e-2;
    zd_assembly_find(self, &joints, p);
    if (self->rows > self->n) return 0;
    double size = zd_dot(self->rows, self->r, self->r);
    for (int i = 0; i < ATTEMPTS && size >= 1e-12; i++) {
        const double largest = fmax(square_rows(self), 1);
        double tried = INFINITY;
        for (; damping < 1e12; damping *= 4) {
            damped_step(self, damping * largest);
            move(self, p, LONGEST, self->step, self->tried);
            zd_assembly_find(self, &joints, self->tried);
            tried = zd_dot(self->rows, self->r, self->r);
            if (tried < size) break;
            zd_assembly_find(self, &joints, p);
        }
        if (!(tried < size)) return 0;
        const double gain = size - tried;
        zd_copy(self->n, self->tried, p);
        size = tried;
        damping = fmax(damping / 5, 1e-12);
        if (gain < 1e-14 * size) break;
    }
    return newton(self, &joints, p);
}

/* ---- positions ---- */

/* Leads drives, couplings and targets from where they are to where they shall be, in small steps on one branch. */
static int track(zd_assembly *self, double *p)
{
    zd_assembly_problem all = {ZD_OF_ALL, 1, 0};
    memset(self->start, 0, (size_t)self->most * sizeof *self->start);
    zd_assembly_write_rows(self, p, self->mh, 1, 0);
    zd_assembly_divide_by_sizes(self, self->rows > self->mh);
    for (int k = 0; k < self->rows; k++) self->start[k] = zd_assembly_is_of_joint(self, k) || zd_assembly_drive_of(self, k) >= 0 ? 0
        : self->r[k];
    const double way = zd_largest(self->rows, self->start);
    if (!(way < INFINITY)) return 0;
    const int parts = (int)fmin(200, fmax(1, ceil(way / TRACKED)));
    for (int part = 1; part <= parts; part++) {
        all.left = 1.0 - (double)part / parts;
        if (!newton(self, &all, p)) return 0;
    }
    return 1;
}

static double distance(const zd_assembly *self, const double *p, const double *drawn)
{
    double sum = 0;
    for (int i = 0; i < self->n; i++) {
        const double x = (p[i] - drawn[i]) / self->scale[i] * self->weight[i];
        sum += x * x;
    }
    return sqrt(sum);
}

/* Gauss-Newton method from closed positions to those nearest to the reference configuration on the same branch; `memory` (2, n). */
static int approach(zd_assembly *self, const zd_assembly_problem *of, const double *drawn, double *p, double *memory)
{
    double *step = memory, *tried = memory + self->n, before = distance(self, p, drawn);
    for (int i = 0; i < NEARER; i++) {
        zd_assembly_find(self, of, p);
        for (int j = 0; j < self->n; j++) step[j] = (drawn[j] - p[j]) / self->scale[j];
        for (int k = 0; k < self->rows; k++) self->r[k] += zd_dot(self->n, self->J + k * self->n, step);
        if (!least_step(self, self->r, self->step)) return 0;
        for (int j = 0; j < self->n; j++) step[j] -= self->step[j];
        move(self, p, TRACKED, step, tried);
        if (!newton(self, of, tried)) return 1;
        const double nearer = distance(self, tried, drawn);
        if (!(nearer < before * (1 - 1e-6))) return 1;
        zd_copy(self->n, tried, p);
        before = nearer;
    }
    return 1;
}

/* True if all rows and targets are satisfied as drawn; without targets, the sizes of the rows are not needed for that. */
static int is_closed(zd_assembly *self, const double *p, int held)
{
    const zd_assembly_problem all = {ZD_OF_ALL, 1, 0};
    zd_assembly_write_rows(self, p, self->mh, 0, 0);
    if (!held && !self->wanted->drives && zd_largest(self->mh, self->r) <= CLOSED * SMALLEST * self->length) return 1;
    return zd_assembly_find(self, &all, p) <= CLOSED;
}

static int is_anything_staying(const zd_assembly *self)
{
    int any = 0;
    for (int i = 0; i < self->targets; i++) any |= self->target[i].stays && !self->target[i].is_rate;
    return any;
}

/* Coordinates that stay are from now on as they are here. */
static void keep_staying(zd_assembly *self, const double *p)
{
    for (int i = 0; i < self->targets; i++)
        if (self->target[i].stays && !self->target[i].is_rate) self->staying[i] = zd_assembly_measure(self, self->target + i, p, NULL);
    self->knows_staying = 1;
    self->is_known[1] = 0;      /* sizes are those of fewer rows */
}

static int find_positions(zd_assembly *self, double *p, double *memory)
{
    int held = 0;
    for (int i = 0; i < self->targets; i++) held += !self->target[i].is_rate && !self->target[i].stays;
    if (is_closed(self, p, held)) return 1;
    const zd_assembly_problem drawing = {ZD_OF_DRAWING, 0, 0}, all = {ZD_OF_ALL, 1, 0};
    double *drawn = memory + 2 * self->n;
    zd_copy(self->n, p, drawn);
    if (!close_joints(self, p)) return 0;
    if (!is_anything_staying(self)) return track(self, p) && approach(self, &all, drawn, p, memory);
    if (!newton(self, &drawing, p) || !approach(self, &drawing, drawn, p, memory)) return 0;
    keep_staying(self, p);
    zd_copy(self->n, p, drawn);
    return track(self, p) && approach(self, &all, drawn, p, memory);
}

/* ---- velocities ---- */

static int find_velocities(zd_assembly *self, const double *p, double *v)
{
    memset(v, 0, (size_t)self->n * sizeof *v);
    zd_assembly_write_rows(self, p, self->m, 1, 1);
    double most = zd_largest(self->rows, self->r), off = 0;
    if (most == 0) return 1;
    for (int k = 0; k < self->rows; k++) {
        const double size = zd_assembly_length_of(self, k);
        zd_assembly_divide_row(self, k, size < 1e-9 * self->length ? -self->length : -size);
    }
    most = zd_largest(self->rows, self->r);
    for (int k = 0; k < self->rows * self->n; k++) self->J[k] = -self->J[k];
    if (!least_step(self, self->r, v)) return 0;
    for (int k = 0; k < self->rows; k++) off = fmax(off, fabs(zd_dot(self->n, self->J + k * self->n, v) - self->r[k]));
    if (!(off <= 1e-9 * fmax(most, zd_largest(self->n, v)))) return 0;
    for (int i = 0; i < self->n; i++) v[i] *= self->scale[i];
    return 1;
}

/* ---- the whole ---- */

static void find_places(zd_assembly *self, const double *p, double *places)
{
    zd_assembly_write_rows(self, p, self->mh, 0, 0);
    for (int k = 0; k < self->mh; k++)
        if (zd_assembly_drive_of(self, k) >= 0) places[zd_assembly_drive_of(self, k)] = self->r[k];
}

int zd_assemble(const zd_plane *mechanism, const zd_wanted *wanted, double *p, double *v, double *places)
{
    zd_arena arena = {0};
    zd_assembly_take(&arena, mechanism, wanted);
    zd_take_doubles(&arena, 3 * (size_t)mechanism->system.nv);
    arena = (zd_arena){.base = zd_allocate(arena.used)};
    if (!arena.base) return 0;
    zd_assembly self = zd_assembly_take(&arena, mechanism, wanted);
    double *memory = zd_take_doubles(&arena, 3 * (size_t)mechanism->system.nv);
    zd_assembly_weigh(&self, p);
    const int found = self.rows <= self.n && find_positions(&self, p, memory) && find_velocities(&self, p, v);
    if (found && wanted->drives) find_places(&self, p, places);
    zd_release(arena.base);
    return found && zd_largest(mechanism->system.nv, p) < INFINITY && zd_largest(mechanism->system.nv, v) < INFINITY;
}
