/* The same steps as those of Python's assembly.py, which has more to say where something is wrong, and knows wishes and redundant
 * rows: least steps in the mass metric, in absolute coordinates, told in rad and parts of the mechanism's length.
 *
 * Where rows are independent, a least step with J x = r is x = W^-2 J^T (J W^-2 J^T)^-1 r, by orthogonalization of the rows of J W^-1; and
 * that of Levenberg and Marquardt, damped by mu, is x = -J^T (J J^T + mu)^-1 r.
 */
#include "assembly.h"

#include <math.h>
#include <string.h>

#include "../linalg/small.h"
#include "../point/expand.h"
#include "plan.h"

static const double CLOSED = 1e-12;         /* these are as in assembly.py */
static const double SMALLEST = 1e-3;
static const double TRACKED = 0.1;
static const double LONGEST = 0.4;
static const double LEAST_MASS = 1e-6;
static const double INDEPENDENT = 1e-7;     /* of a row: what has to be left once others are taken out */
enum { ATTEMPTS = 200, NEARER = 50, ITERATIONS = 40, POWERS = 200 };

typedef struct assembly {
    const zd_mechanism *mechanism;
    const zd_system *system;
    double length;
    int n, mh, m, most;     /* most: rows of m and of all targets */
    int targets;
    const zd_target *target;
    const zd_wanted *wanted;
    zd_terms terms;
    double *scratch, *at_rest;          /* (measures' scratch,), (n,) zeros */
    double *scale, *weight;             /* (n,) */
    double *size[2];                    /* (most,): of the rows without targets and with them, where they were first met */
    int is_known[2];
    double *dense, *r, *J, *Q, *L;      /* (m, n), (most,), (most, n), (most, n), (most, most) */
    double *y, *step, *tried, *start;   /* (most,), (n,), (n,), (most,) */
    int rows;                           /* of r and J */
} assembly;

/* Which rows are meant, and how much of what they were at the start is left to them */
typedef struct problem {
    int joints_alone, held;
    double left;
} problem;

static assembly take(zd_arena *arena, const zd_mechanism *mechanism, const zd_wanted *wanted)
{
    const zd_system *system = &mechanism->system;
    const size_t n = (size_t)system->nv, m = (size_t)(system->mh + system->mn);
    const size_t most = m + (size_t)wanted->targets + 3;        /* and room for the rows of a vector */
    return (assembly){
        .mechanism = mechanism, .system = system, .length = wanted->length, .n = system->nv, .mh = system->mh, .m = (int)m, .most = (int)most,
        .targets = wanted->targets, .target = wanted->target, .wanted = wanted,
        .terms = {.M = zd_take_doubles(arena, n * n), .C = zd_take_doubles(arena, m * n), .Phi = zd_take_doubles(arena, m),
                  .Phi_t = zd_take_doubles(arena, m), .scratch = zd_take_doubles(arena, (size_t)system->scratch)},
        .scratch = zd_take_doubles(arena, (size_t)mechanism->measures.scratch), .at_rest = zd_take_doubles(arena, n),
        .scale = zd_take_doubles(arena, n), .weight = zd_take_doubles(arena, n),
        .size = {zd_take_doubles(arena, most), zd_take_doubles(arena, most)},
        .dense = zd_take_doubles(arena, m * n), .r = zd_take_doubles(arena, most), .J = zd_take_doubles(arena, most * n),
        .Q = zd_take_doubles(arena, most * n), .L = zd_take_doubles(arena, most * most), .y = zd_take_doubles(arena, most),
        .step = zd_take_doubles(arena, n), .tried = zd_take_doubles(arena, n), .start = zd_take_doubles(arena, most),
    };
}

/* The square root of the mass metric, in scaled coordinates */
static void weigh(assembly *self, const double *p)
{
    double largest = 0;
    self->system->evaluate(self->system->data, ZD_M | ZD_MOVED, 0, p, self->at_rest, &self->terms);
    for (int i = 0; i < self->n; i++) {
        const double mass = self->system->structure ? self->terms.M[i] : self->terms.M[i * (self->n + 1)];
        self->scale[i] = self->mechanism->coordinate[i].kind == ZD_COORDINATE_ANGLE ? 1 : self->length;
        self->weight[i] = mass * (self->scale[i] * self->scale[i]);
        largest = fmax(largest, self->weight[i]);
    }
    for (int i = 0; i < self->n; i++) self->weight[i] = sqrt(fmax(self->weight[i], LEAST_MASS * (largest > 0 ? largest : 1)));
}

/* ---- rows ---- */

/* Adds the row of a target that is a rate or not, and how far it is from met. */
static void add_target(assembly *self, const zd_target *target, const double *p)
{
    double value[3] = {0};
    const zd_measured out = {.value = value, .row = self->Q};
    const zd_measures *measures = self->system->measures;
    measures->evaluate(self->system->data, target->measure, 0, p, self->at_rest, NULL, NULL, &out, self->scratch);
    self->r[self->rows] = value[target->component] - target->value;
    memcpy(self->J + self->rows++ * self->n, self->Q + target->component * self->n, (size_t)self->n * sizeof *self->J);
}

/* r and J of rows 0 ... count - 1 of C, and of the targets that are rates or not; in scaled coordinates */
static void write_rows(assembly *self, const double *p, int count, int targets, int rates)
{
    const int terms = (self->m ? ZD_C : 0) | (self->mh ? ZD_PHI : 0) | (self->system->provides & ZD_PHI_T);
    self->rows = count;
    if (terms) self->system->evaluate(self->system->data, terms | ZD_MOVED, 0, p, self->at_rest, &self->terms);
    if (self->m && self->system->structure) zd_expand(self->system, ZD_C, self->terms.C, self->dense);
    const double *C = self->system->structure ? self->dense : self->terms.C;
    for (int k = 0; k < count; k++) self->r[k] = rates ? (self->system->provides & ZD_PHI_T ? self->terms.Phi_t[k] : 0) : self->terms.Phi[k];
    zd_copy(count * self->n, C, self->J);
    for (int i = 0; targets && i < self->targets; i++)
        if (self->target[i].is_rate == rates) add_target(self, self->target + i, p);
    for (int k = 0; k < self->rows; k++)
        for (int i = 0; i < self->n; i++) self->J[k * self->n + i] *= self->scale[i];
}

static double length_of(const assembly *self, int row)
{
    return sqrt(zd_dot(self->n, self->J + row * self->n, self->J + row * self->n));
}

static void divide_row(assembly *self, int row, double by)
{
    self->r[row] /= by;
    for (int i = 0; i < self->n; i++) self->J[row * self->n + i] /= by;
}

/* In units of their sizes where they were first met: these must not change while squares are made least. */
static void divide_by_sizes(assembly *self, int which)
{
    double *size = self->size[which], largest = self->length;
    for (int k = 0; !self->is_known[which] && k < self->rows; k++) {
        size[k] = length_of(self, k);
        largest = fmax(largest, size[k]);
    }
    for (int k = 0; !self->is_known[which] && k < self->rows; k++) size[k] = fmax(size[k], SMALLEST * largest);
    self->is_known[which] = 1;
    for (int k = 0; k < self->rows; k++) divide_row(self, k, size[k]);
}

static int is_of_joint(const assembly *self, int row)
{
    return row < self->mh && zd_mechanism_rows(self->mechanism)[row].owner == ZD_OF_JOINT;
}

/* The drive of constant speed that a row of C is, of those wanted; -1: it is none. */
static int drive_of(const assembly *self, int row)
{
    if (row >= self->mh) return -1;
    const zd_row_owner *owner = zd_mechanism_rows(self->mechanism) + row;
    for (int i = 0; owner->owner == ZD_OF_RELATION && i < self->wanted->drives; i++)
        if (self->wanted->drive[i] == owner->index) return i;
    return -1;
}

/* r and J of the problem at p, without such drives; returns the largest |r| */
static double find(assembly *self, const problem *of, const double *p)
{
    write_rows(self, p, self->mh, of->held, 0);
    divide_by_sizes(self, self->rows > self->mh);
    int count = 0;
    for (int k = 0; k < self->rows; k++) {
        if (drive_of(self, k) >= 0 || (of->joints_alone && !is_of_joint(self, k))) continue;
        self->r[count] = self->r[k] - of->left * self->start[k];
        zd_copy(self->n, self->J + k * self->n, self->J + count++ * self->n);
    }
    self->rows = count;
    return zd_largest(count, self->r);
}

/* ---- steps ---- */

/* x <- the least with J x = right, in the mass metric; returns whether rows are independent */
static int least_step(assembly *self, const double *right, double *x)
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
        if (!(rest > INDEPENDENT * INDEPENDENT * square)) return 0;
        L[k] = sqrt(rest);
        for (int i = 0; i < n; i++) q[i] /= L[k];
    }
    memset(x, 0, (size_t)n * sizeof *x);
    for (int k = 0; k < m; k++) {
        self->y[k] = (right[k] - zd_dot(k, self->L + k * self->most, self->y)) / self->L[k * self->most + k];
        zd_add_scaled(n, x, self->y[k], self->Q + k * n);
    }
    for (int i = 0; i < n; i++) x[i] /= self->weight[i];
    return 1;
}

/* Where a step leads, shortened so that it moves no coordinate by more than that */
static void move(const assembly *self, const double *p, double longest, double *step, double *to)
{
    const double most = zd_largest(self->n, step), share = most > longest ? longest / most : 1;
    for (int i = 0; i < self->n; i++) {
        step[i] *= share;
        to[i] = p[i] + step[i] * self->scale[i];
    }
}

/* Least steps until nothing gets better; returns whether that is near enough. */
static int newton(assembly *self, const problem *of, double *p)
{
    double best = find(self, of, p);
    for (int i = 0; i < ITERATIONS && best >= 1e-15; i++) {
        if (!least_step(self, self->r, self->step)) return 0;
        for (int j = 0; j < self->n; j++) self->step[j] = -self->step[j];
        move(self, p, LONGEST, self->step, self->tried);
        const double error = find(self, of, self->tried);
        if (!(error < best)) break;
        zd_copy(self->n, self->tried, p);
        best = error;
    }
    return best <= CLOSED;
}

/* L <- J J^T; returns its largest eigenvalue */
static double square_rows(assembly *self)
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
static void damped_step(assembly *self, double mu)
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
static int close_joints(assembly *self, double *p)
{
    const problem joints = {1, 0, 0};
    double damping = 1e-2;
    find(self, &joints, p);
    if (self->rows > self->n) return 0;
    double size = zd_dot(self->rows, self->r, self->r);
    for (int i = 0; i < ATTEMPTS && size >= 1e-12; i++) {
        const double largest = fmax(square_rows(self), 1);
        double tried = INFINITY;
        for (; damping < 1e12; damping *= 4) {
            damped_step(self, damping * largest);
            move(self, p, LONGEST, self->step, self->tried);
            find(self, &joints, self->tried);
            tried = zd_dot(self->rows, self->r, self->r);
            if (tried < size) break;
            find(self, &joints, p);
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
static int track(assembly *self, double *p)
{
    problem all = {0, 1, 0};
    memset(self->start, 0, (size_t)self->most * sizeof *self->start);
    write_rows(self, p, self->mh, 1, 0);
    divide_by_sizes(self, self->rows > self->mh);
    for (int k = 0; k < self->rows; k++) self->start[k] = is_of_joint(self, k) || drive_of(self, k) >= 0 ? 0 : self->r[k];
    const double way = zd_largest(self->rows, self->start);
    if (!(way < INFINITY)) return 0;
    const int parts = (int)fmin(200, fmax(1, ceil(way / TRACKED)));
    for (int part = 1; part <= parts; part++) {
        all.left = 1.0 - (double)part / parts;
        if (!newton(self, &all, p)) return 0;
    }
    return 1;
}

static double distance(const assembly *self, const double *p, const double *drawn)
{
    double sum = 0;
    for (int i = 0; i < self->n; i++) {
        const double x = (p[i] - drawn[i]) / self->scale[i] * self->weight[i];
        sum += x * x;
    }
    return sqrt(sum);
}

/* From closed positions to those nearest to the drawing on the same branch, by the method of Gauss and Newton; `memory` (2, n). */
static int approach(assembly *self, const double *drawn, double *p, double *memory)
{
    const problem all = {0, 1, 0};
    double *step = memory, *tried = memory + self->n, before = distance(self, p, drawn);
    for (int i = 0; i < NEARER; i++) {
        find(self, &all, p);
        for (int j = 0; j < self->n; j++) step[j] = (drawn[j] - p[j]) / self->scale[j];
        for (int k = 0; k < self->rows; k++) self->r[k] += zd_dot(self->n, self->J + k * self->n, step);
        if (!least_step(self, self->r, self->step)) return 0;
        for (int j = 0; j < self->n; j++) step[j] -= self->step[j];
        move(self, p, TRACKED, step, tried);
        if (!newton(self, &all, tried)) return 1;
        const double nearer = distance(self, tried, drawn);
        if (!(nearer < before * (1 - 1e-6))) return 1;
        zd_copy(self->n, tried, p);
        before = nearer;
    }
    return 1;
}

/* Whether all rows and targets are met as drawn; without targets the sizes of the rows need not be known for that. */
static int is_closed(assembly *self, const double *p, int held)
{
    const problem all = {0, 1, 0};
    write_rows(self, p, self->mh, 0, 0);
    if (!held && !self->wanted->drives && zd_largest(self->mh, self->r) <= CLOSED * SMALLEST * self->length) return 1;
    return find(self, &all, p) <= CLOSED;
}

static int find_positions(assembly *self, double *p, double *memory)
{
    int held = 0;
    for (int i = 0; i < self->targets; i++) held += !self->target[i].is_rate;
    if (is_closed(self, p, held)) return 1;
    double *drawn = memory + 2 * self->n;
    zd_copy(self->n, p, drawn);
    return close_joints(self, p) && track(self, p) && approach(self, drawn, p, memory);
}

/* ---- velocities ---- */

static int find_velocities(assembly *self, const double *p, double *v)
{
    memset(v, 0, (size_t)self->n * sizeof *v);
    write_rows(self, p, self->m, 1, 1);
    double most = zd_largest(self->rows, self->r), off = 0;
    if (most == 0) return 1;
    for (int k = 0; k < self->rows; k++) {
        const double size = length_of(self, k);
        divide_row(self, k, size < 1e-9 * self->length ? -self->length : -size);
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

static void find_places(assembly *self, const double *p, double *places)
{
    write_rows(self, p, self->mh, 0, 0);
    for (int k = 0; k < self->mh; k++)
        if (drive_of(self, k) >= 0) places[drive_of(self, k)] = self->r[k];
}

int zd_assemble(const zd_mechanism *mechanism, const zd_wanted *wanted, double *p, double *v, double *places)
{
    zd_arena arena = {NULL, 0};
    take(&arena, mechanism, wanted);
    zd_take_doubles(&arena, 3 * (size_t)mechanism->system.nv);
    arena = (zd_arena){zd_allocate(arena.used), 0};
    if (!arena.base) return 0;
    assembly self = take(&arena, mechanism, wanted);
    double *memory = zd_take_doubles(&arena, 3 * (size_t)mechanism->system.nv);
    weigh(&self, p);
    const int found = self.rows <= self.n && find_positions(&self, p, memory) && find_velocities(&self, p, v);
    if (found && wanted->drives) find_places(&self, p, places);
    zd_release(arena.base);
    return found && zd_largest(mechanism->system.nv, p) < INFINITY && zd_largest(mechanism->system.nv, v) < INFINITY;
}
