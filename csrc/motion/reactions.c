/* User functions u(r) of forces that read reactions and accelerations r. These are affine in vdot and lambda, which are in the forces:
 *
 *     r = R(r),     R(r): measured at the vdot and lambda of (8), (9), (13) with the forces u(r)
 *
 * Newton's method for r - R(r) = 0 starts at r0 = R(0) of the same state, so that no number depends on earlier evaluations. The columns of
 * dr/dr - dR/dr = I - G du/dr are differences, each of one evaluation of the forces and one solve with the same factors. They are taken away
 * from r = 0, where friction has a kink. A correction with the matrix of the iteration before that is small ends the iteration, as the
 * matrix has hardly changed; friction proportional to a reaction needs one matrix.
 *
 * The motion is unique if det(I - G du/dr) > 0 from r0 to r. Beyond that (Painleve) there are several accelerations, or none.
 */
#include "reactions.h"

#include <math.h>
#include <string.h>

#include "../constraints/rank.h"
#include "../linalg/lu.h"
#include "../linalg/norms.h"

static const double INCREMENT = 1e-6;       /* difference, in scales of a reaction */
static const double FLOOR = 1e-3;           /* least scale of a reaction, in units of the largest force, against rounding */
static const double LAST = 1e-8;            /* last correction, in scales of a reaction: hardly an error is left after it */
static const double CONDITION = 1e10;       /* largest condition of I - G du/dr, in the scales of the reactions */
enum { ITERATIONS = 30 };

static void write(const zd_motion *motion)
{
    const zd_reactions *self = &motion->reactions;
    const zd_inputs *inputs = self->inputs;
    for (int k = 0; k < inputs->measure_places; k++)
        *inputs->measure_place[k].place = self->r[inputs->measure_place[k].input];
    for (int i = 0; i < inputs->derivations; i++) inputs->derive[i](inputs->data[i]);
}

/* R <- R(r), with vdot and lambda at the point */
static int evaluate(zd_motion *motion)
{
    const zd_reactions *self = &motion->reactions;
    const zd_inputs *inputs = self->inputs;
    const zd_measures *measures = inputs->of->measures;
    zd_point *point = motion->point;
    write(motion);
    point->known &= ~(ZD_FORCE | ZD_POWER | ZD_ACCELERATED);
    const int status = zd_equations_by_matrices.accelerate(motion);
    if (status) return status;
    zd_rank_find_multipliers(point);
    for (int i = 0; i < inputs->measures; i++) {
        const zd_measured out = {.value = self->measured, .is_given = 1};
        if (measures->evaluate(inputs->of->data, point->terms.inputs, inputs->measure[i].measure, point->t, point->p, point->v, point->vdot,
                               point->lambda, &out, self->scratch)) return ZD_CALLBACK;
        self->R[i] = self->measured[inputs->measure[i].component];
    }
    return ZD_DONE;
}

/* scale <- of each reaction at r, from the forces at the point */
static void find_scales(const zd_motion *motion)
{
    const zd_reactions *self = &motion->reactions;
    const zd_point *point = motion->point;
    const double of_f = point->terms.f ? zd_max_abs(motion->system.nv, point->terms.f) : 0;
    const double largest = fmax(of_f, zd_max_abs(zd_constraints(&motion->system), point->lambda));
    for (int i = 0; i < self->count; i++) {
        self->scale[i] = fmax(fabs(self->r[i]), FLOOR * largest);
        if (!(self->scale[i] > 0)) self->scale[i] = 1;
    }
}

/* matrix <- I - G du/dr at r, in the scales of the reactions; F has r - R(r) */
static int differentiate(zd_motion *motion)
{
    zd_reactions *self = &motion->reactions;
    const int n = self->count;
    for (int j = 0; j < n; j++) {
        const double r = self->r[j], increment = copysign(INCREMENT * self->scale[j], r);
        self->r[j] = r + increment;
        const double step = self->r[j] - r;
        const int status = evaluate(motion);
        self->r[j] = r;
        if (status) return status;
        for (int i = 0; i < n; i++) {
            const double at_r = self->r[i] - self->F[i];
            self->matrix[i * n + j] = (i == j) - (self->R[i] - at_r) / step * self->scale[j] / self->scale[i];
        }
    }
    return ZD_DONE;
}

/* Sum of magnitudes in the row of the (n, n) matrix where it is largest */
static double largest_row(int n, const double *A)
{
    double largest = 0;
    for (int i = 0; i < n; i++) {
        double sum = 0;
        for (int j = 0; j < n; j++) sum += fabs(A[i * n + j]);
        largest = fmax(largest, sum);
    }
    return largest;
}

/* Factors the matrix; ZD_SEVERAL_MOTIONS unless its determinant is positive, and its condition small. */
static int factor(zd_reactions *self)
{
    const int n = self->count;
    const double size = 1 + largest_row(n, self->matrix);
    if (zd_lu_factor(n, self->matrix, self->order) < n || !(zd_lu_determinant(n, self->matrix, self->order) > 0)) return ZD_SEVERAL_MOTIONS;
    for (int j = 0; j < n; j++) {
        double *row = self->inverse + j * n;
        for (int i = 0; i < n; i++) row[i] = i == j;
        zd_lu_solve_transposed(n, self->matrix, self->order, row);
    }
    return size * largest_row(n, self->inverse) <= CONDITION ? ZD_DONE : ZD_SEVERAL_MOTIONS;
}

/* change <- matrix^-1 F; returns true if it is small. */
static int is_last(const zd_reactions *self)
{
    for (int i = 0; i < self->count; i++) self->change[i] = self->F[i] / self->scale[i];
    zd_lu_solve(self->count, self->matrix, self->order, self->change);
    return zd_max_abs(self->count, self->change) <= LAST;
}

static void correct(zd_reactions *self)
{
    for (int i = 0; i < self->count; i++) self->r[i] -= self->change[i] * self->scale[i];
}

/* F <- r - R(r) */
static int find_residual(zd_motion *motion)
{
    const zd_reactions *self = &motion->reactions;
    const int status = evaluate(motion);
    for (int i = 0; i < self->count; i++) self->F[i] = self->r[i] - self->R[i];
    return status;
}

/* Newton's method from r */
static int iterate(zd_motion *motion)
{
    zd_reactions *self = &motion->reactions;
    int ends = 0;
    for (int k = 0; k < ITERATIONS && !ends; k++) {
        int status = find_residual(motion);
        if (status) return status;
        if (!zd_is_finite(self->count, self->F)) return ZD_DONE;       /* as vdot, which the step checks */
        ends = k && is_last(self);
        if (!ends) {
            find_scales(motion);
            status = differentiate(motion);
            if (!status) status = factor(self);
            if (status) return status;
            ends = is_last(self);
        }
        correct(self);
    }
    return ends ? evaluate(motion) : ZD_SEVERAL_MOTIONS;
}

static int accelerate(zd_motion *motion)
{
    const zd_reactions *self = &motion->reactions;
    memset(self->r, 0, (size_t)self->count * sizeof *self->r);
    int status = evaluate(motion);
    memcpy(self->r, self->R, (size_t)self->count * sizeof *self->r);
    if (!status && zd_is_finite(self->count, self->r)) status = iterate(motion);
    if (status) motion->point->known &= ~(ZD_FORCE | ZD_POWER | ZD_ACCELERATED);
    return status;
}

static const zd_equations equations = {
    accelerate, zd_motion_rate, zd_motion_leave, zd_motion_expand, zd_motion_reduce, ~(ZD_FORCE | ZD_POWER), 1};

void zd_reactions_take(zd_motion *motion, zd_arena *arena, const zd_inputs *inputs)
{
    if (!inputs || !inputs->measures) return;
    const size_t n = (size_t)inputs->measures;
    const zd_measures *measures = inputs->of->measures;
    int largest = 0;
    for (int i = 0; i < measures->count; i++)
        if (measures->measure[i].size > largest) largest = measures->measure[i].size;
    motion->reactions = (zd_reactions){
        .count = inputs->measures,
        .inputs = inputs,
        .r = zd_take_doubles(arena, n),
        .R = zd_take_doubles(arena, n),
        .F = zd_take_doubles(arena, n),
        .change = zd_take_doubles(arena, n),
        .scale = zd_take_doubles(arena, n),
        .matrix = zd_take_doubles(arena, n * n),
        .inverse = zd_take_doubles(arena, n * n),
        .order = zd_take(arena, n * sizeof(int)),
        .measured = zd_take_doubles(arena, (size_t)largest),
        .scratch = zd_take_doubles(arena, (size_t)measures->scratch),
    };
    motion->equations = &equations;
}
