/* Least reactions of redundant constraints.
 *
 * Multipliers are determined up to N z, with N a basis of the vectors for which C^T n = 0: they do not move anything. S, the wrenches of all
 * joints and relations, is linear in the multipliers. z minimizes |S (lambda + N z)| with moments divided by a length, so that the choice
 * depends neither on coordinates nor on the axes of the drawing. S N has as columns the differences of the reactions at lambda + n and at
 * lambda, in which those of inboard joints are included.
 */
#include "least_reactions.h"

#include <math.h>

#include "../../linalg/row_space.h"
#include "../../linalg/small.h"

static const double DEPENDENT = 1e-8;       /* relative to the norm of a constraint: residual norm below which it is redundant */
static const double ZERO_ROW = 1e-12;       /* relative to the longest constraint: norm below which one is zero */

typedef struct least_reactions {
    zd_row_space C, SN;
    double *N;              /* (m, m): null vectors, one after another */
    double *wrenches;       /* (2, rows): weighted wrenches at lambda and at lambda + n */
    double *moved, *z;      /* (m,) */
} least_reactions;

static int rows_of_wrenches(const zd_measuring *self) { return ZD_WRENCH_SIZE * self->joints + self->elements->relations; }

static void take(least_reactions *to, zd_arena *arena, const zd_measuring *self)
{
    const int m = self->elements->m, rows = rows_of_wrenches(self);
    to->C = zd_row_space_take(arena, m, self->nv);
    to->SN = zd_row_space_take(arena, rows, m);
    to->N = zd_take_doubles(arena, (size_t)m * (size_t)m);
    to->wrenches = zd_take_doubles(arena, 2 * (size_t)rows);
    to->moved = zd_take_doubles(arena, (size_t)m);
    to->z = zd_take_doubles(arena, (size_t)m);
}

/* Magnitude of the entries that a marker quantity can have in a constraint */
static double largest_arm(const zd_measuring *self, int quantity)
{
    double wrench[ZD_WRENCH_SIZE] = {0};
    self->numerics->unit_wrench(self->readings.mechanism, self->readings.frame, quantity, wrench);
    const double pull = zd_dot(ZD_WRENCH_FORCE, wrench, wrench), turn = zd_dot(ZD_WRENCH_FORCE, wrench + 3, wrench + 3);
    return fmax(sqrt(pull) * fmin(self->elements->length, 1), sqrt(turn));
}

/* C (m, nv) <- constraints, each divided by its norm; norm (m,), 0 where one is zero up to rounding */
static int write_constraints(const zd_measuring *self, double t, double *C, double *norm)
{
    const zd_readings *of = &self->readings;
    const zd_planned_elements *elements = self->elements;
    const int n = self->nv, m = elements->m;
    double longest = 0;
    for (int i = 0; i < m; i++) {
        zd_combined all;
        const zd_relation *row = elements->row + i;
        const int status = zd_combine(elements, of, row, t, &all);
        if (status) return ZD_CALLBACK;
        for (int k = 0; k < row->terms; k++) {
            self->numerics->write_row(of->mechanism, of->frame, elements->term[row->first + k].quantity, all.factors[k], self->row);
            zd_add_scaled(n, C + i * n, 1, self->row);
            longest = fmax(longest, fabs(all.factors[k]) * largest_arm(self, elements->term[row->first + k].quantity));
        }
        norm[i] = sqrt(zd_dot(n, C + i * n, C + i * n));
        longest = fmax(longest, norm[i]);
    }
    for (int i = 0; i < m; i++) {
        if (!(norm[i] > ZERO_ROW * longest)) norm[i] = 0;
        for (int j = 0; j < n; j++) C[i * n + j] = norm[i] > 0 ? C[i * n + j] / norm[i] : 0;
    }
    return ZD_DONE;
}

/* N <- null vectors of C^T: of row d the coefficients by which the independent rows give it. Returns their number. */
static int write_null_vectors(least_reactions *of, int m, const double *norm)
{
    const zd_row_space *C = &of->C;
    for (int d = C->rank; d < m; d++) {
        double *vector = of->N + (d - C->rank) * m;
        memset(vector, 0, (size_t)m * sizeof *vector);
        for (int k = C->rank - 1; k >= 0; k--) {
            double sum = C->A[d * C->n + k];
            for (int i = k + 1; i < C->rank; i++) sum -= C->A[i * C->n + k] * of->moved[i];
            of->moved[k] = sum / C->diagonal[k];
            vector[C->order[k]] = -of->moved[k] / norm[C->order[k]];
        }
        vector[C->order[d]] = norm[C->order[d]] > 0 ? 1 / norm[C->order[d]] : 1;
    }
    return m - C->rank;
}

/* to (rows,) <- wrenches of all joints, and the largest forces of relations without a joint, weighted */
static int write_wrenches(const zd_measuring *self, const zd_measured_state *at, double *to)
{
    const zd_readings *of = &self->readings;
    const zd_planned_elements *elements = self->elements;
    for (int joint = 0; joint < self->joints; joint++, to += ZD_WRENCH_SIZE) {
        memset(to, 0, ZD_WRENCH_SIZE * sizeof *to);
        const int status = self->numerics->reaction(of->mechanism, of->frame, joint, at, to);
        if (status) return status;
        for (int k = 0; k < self->numerics->torques; k++) to[ZD_WRENCH_FORCE + k] /= elements->length;
    }
    for (int i = 0; i < elements->relations; i++) {
        const zd_relation *row = elements->row + elements->row_of_relation[i];
        double largest = 0;
        for (int term = 0; term < row->terms && row->joint < 0; term++) {
            double force, wrench[ZD_WRENCH_SIZE] = {0};
            const int status = zd_drive_force(elements, of, i, term, at->t, at->lambda, &force);
            if (status) return status;
            self->numerics->unit_wrench(of->mechanism, of->frame, elements->term[row->first + term].quantity, wrench);
            const double pull = zd_dot(ZD_WRENCH_FORCE, wrench, wrench), turn = zd_dot(ZD_WRENCH_FORCE, wrench + 3, wrench + 3);
            const double size = force * (pull > 0 ? sqrt(pull) : sqrt(turn) / elements->length);
            if (fabs(size) > fabs(largest)) largest = size;
        }
        to[i] = largest;
    }
    return ZD_DONE;
}

/* SN <- columns of weighted wrenches; z <- coefficients of the null vectors in the least multipliers */
static int find_coefficients(const zd_measuring *self, const zd_measured_state *at, least_reactions *of, int count)
{
    const int m = self->elements->m, rows = rows_of_wrenches(self);
    double *base = of->wrenches, *other = base + rows;
    int status = write_wrenches(self, at, base);
    of->SN.n = count;
    for (int j = 0; j < count && !status; j++) {
        for (int i = 0; i < m; i++) of->moved[i] = at->lambda[i] + of->N[j * m + i];
        const zd_measured_state there = {at->t, at->p, at->v, at->vdot, of->moved};
        status = write_wrenches(self, &there, other);
        for (int i = 0; i < rows; i++) of->SN.A[i * count + j] = base[i] - other[i];
    }
    if (status) return status;
    zd_row_space_factor(&of->SN, rows, 1e-11, 0);
    zd_row_space_solve(&of->SN, base, of->z);
    return ZD_DONE;
}

int zd_least_reactions(const zd_measuring *self, const zd_measured_state *at, double *to)
{
    const int m = self->elements->m;
    least_reactions of;
    zd_arena size = {NULL, 0, NULL};
    take(&of, &size, self);
    void *memory = zd_allocate(size.used + sizeof(double) * (size_t)m);
    if (!memory) return ZD_NO_MEMORY;
    zd_arena arena = {memory, 0, NULL};
    take(&of, &arena, self);
    double *norm = (double *)(void *)((char *)memory + size.used);
    int status = write_constraints(self, at->t, of.C.A, norm);
    memcpy(to, at->lambda, (size_t)m * sizeof *to);
    if (!status) zd_row_space_factor(&of.C, m, DEPENDENT, 0.5 * DEPENDENT);
    if (!status && of.C.rank < m) {
        const int count = write_null_vectors(&of, m, norm);
        status = find_coefficients(self, at, &of, count);
        for (int j = 0; j < count && !status; j++) zd_add_scaled(m, to, of.z[j], of.N + j * m);
    }
    zd_release(memory);
    return status;
}
