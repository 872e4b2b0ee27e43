#include "iteration.h"

#include <math.h>

#include "../../linalg/iteration.h"
#include "../../linalg/roots.h"
#include "../../linalg/small.h"

enum {
    STAGES = ZD_RADAU_STAGES,
    MAX_ITERATIONS = 40,   /* iterations to rounding */
    WORTHWHILE = 10,        /* iterations to a tolerance: shorter steps are cheaper than more */
};

static const double ITERATION_ERROR = 0.0001;   /* error of the iteration relative to the tolerance of the step: it adds up over steps */
static const double CHANGE_ROUNDING = 4 * 0x1p-52; /* change relative to the state below which a fixed step is solved */
static const double NEARLY = 1e-12;             /* change relative to the state: a smaller one that no longer shrinks is rounding error */
static const double NEVER = 1e-9;               /* change relative to the state: a larger one is never taken for rounding error */
static const double ROUNDING_RATIO = 16;        /* ratio of the change to that by a disturbance of the last bit: rounding error below */
static const double STALLED = 0.5;              /* ratio of two successive changes above which the iteration has stalled */

zd_radau_newton zd_radau_newton_create(zd_arena *arena, const zd_rate *rate, const double *y, int size)
{
    const size_t n = size;
    zd_radau_newton self = {
        .size = size,
        .f = zd_arena_doubles(arena, STAGES * n),
        .z = zd_arena_doubles(arena, STAGES * n),
        .w = zd_arena_doubles(arena, STAGES * n),
        .change = zd_arena_doubles(arena, STAGES * n),
        .other = zd_arena_doubles(arena, STAGES * n),
        .stage = zd_arena_doubles(arena, n),
        .scale = zd_arena_doubles(arena, n),
        .matrices = zd_radau_matrices_create(arena, size),
        .stages = zd_radau_stages_create(arena, size),
        .contraction = 1,
        .rate = rate,
        .y0 = y,
        .t0 = NAN,
    };
    self.seen = self.matrices.differences.scale;
    return self;
}

static void see_sizes(zd_radau_newton *self)
{
    const int n = self->size;
    const double *z = self->z, *change = self->change;
    double *seen = self->seen;
    for (int k = 0; k < STAGES * n; k++) seen[k % n] = fmax(seen[k % n], fabs(z[k]) + fabs(change[k]));
}

/* Norm of a change, in units of its tolerance */
static double measure(const zd_radau_newton *self, const double *change)
{
    const int n = self->size;
    const double *scale = self->has_scale ? self->scale : self->seen;
    double sum = 0, largest = 0;
    for (int k = 0; k < STAGES * n; k++) {
        const double part = fabs(change[k]) / scale[k % n];
        if (change[k] == 0) continue;
        if (isnan(part)) return part;
        sum += part * part;
        largest = fmax(largest, part);
    }
    return self->has_scale ? sqrt(sum / (STAGES * n)) / ITERATION_ERROR : largest / CHANGE_ROUNDING;
}

/* x <- Newton's correction of w */
static void solve(zd_radau_newton *self, double *x)
{
    const int n = self->size;
    const double h = self->h, *w = self->w;
    zd_radau_transform(n, zd_radau_T_inverse, self->f, x);
    for (int i = 0; i < n; i++) {
        x[i] -= ZD_RADAU_GAMMA / h * w[i];
        x[n + i] -= (ZD_RADAU_ALPHA * w[n + i] + ZD_RADAU_BETA * w[2 * n + i]) / h;
        x[2 * n + i] -= (ZD_RADAU_ALPHA * w[2 * n + i] - ZD_RADAU_BETA * w[n + i]) / h;
    }
    if (self->by_stages) {
        zd_radau_stages_solve(&self->stages, &self->matrices, x);
        return;
    }
    zd_radau_solve_real(&self->matrices, x);
    zd_radau_solve_complex(&self->matrices, x + n, x + 2 * n);
}

static int add_change(void *context)
{
    zd_radau_newton *self = context;
    for (int i = 0; i < STAGES * self->size; i++) self->w[i] += self->change[i];
    zd_radau_transform(self->size, zd_radau_T, self->w, self->z);
    return ZD_DONE;
}

/* f <- rates at all stages, with entries changed by a relative disturbance of alternating sign. */
static int evaluate_stages(zd_radau_newton *self, double disturbance)
{
    const int n = self->size;
    for (int s = 0; s < STAGES; s++) {
        for (int i = 0; i < n; i++) self->stage[i] = (self->y0[i] + self->z[s * n + i]) * (1 + ((i + s) % 2 ? disturbance : -disturbance));
        int status = self->rate->evaluate(self->rate->context, self->t0 + zd_radau_c[s] * self->h, self->stage, self->f + s * n);
        if (status) return status;
    }
    return ZD_DONE;
}

/* Test whether the iteration no longer converges because it has reached the rounding error of the rates, which grows with stiffness. Stages
 * that differ in their last bit then give a change that differs by about its own size. Changes are compared with the largest entry of
 * the state, as an entry that is itself only rounding error does not show how large it should be. */
static int test_for_rounding(zd_radau_newton *self, double norm, int *is_rounding)
{
    const int n = self->size;
    const double largest = zd_max_abs(STAGES * n, self->change), of_state = fmax(zd_max_abs(n, self->y0), zd_max_abs(STAGES * n, self->z));
    *is_rounding = largest < NEARLY * zd_max_abs(n, self->seen);
    if (*is_rounding || !(largest < NEVER * of_state)) return ZD_DONE;
    int status = evaluate_stages(self, 0x1p-52);
    if (status) return status;
    solve(self, self->other);
    for (int k = 0; k < STAGES * n; k++) self->other[k] -= self->change[k];
    *is_rounding = norm <= ROUNDING_RATIO * measure(self, self->other);
    return ZD_DONE;
}

/* size <- error of w after the change has been added, estimated from the contraction. */
static int residual(void *context, double *size)
{
    zd_radau_newton *self = context;
    int is_rounding = 0, status = evaluate_stages(self, 0);
    if (status) return status;
    solve(self, self->change);
    see_sizes(self);
    const double norm = measure(self, self->change), before = self->norm_before;
    const int left = WORTHWHILE - ++self->iterations;
    const double share = before > 0 ? norm / before : self->contraction;
    if (before > 0) self->contraction = fmax(share, self->iterations > 2 ? self->contraction : 0);
    self->norm_before = norm;
    *size = norm == 0 ? 0 : share < 1 ? share / (1 - share) * norm : norm;
    if (before > 0 && share > STALLED) status = test_for_rounding(self, norm, &is_rounding);
    if (status) return status;
    if (is_rounding) *size = 0;
    else if (self->has_scale && before > 0 && !(share < 1 && *size * zd_power(share, left) <= 1)) return ZD_NO_CONVERGENCE;
    return *size <= 1 ? add_change(self) : ZD_DONE;
}

int zd_radau_newton_iterate(zd_radau_newton *self, zd_statistics *statistics)
{
    const zd_newton newton = {residual, add_change, 1, MAX_ITERATIONS, 0, NULL, 0};
    int iterations;
    double left;
    zd_radau_transform(self->size, zd_radau_T_inverse, self->z, self->w);
    self->norm_before = 0;
    self->iterations = 0;
    self->contraction = zd_power(zd_root(fmax(self->contraction, 0x1p-52), 5), 4);     /* it may have changed since */
    int status = zd_newton_solve(&newton, self, &iterations, &left);
    statistics->implicit_iterations += self->iterations;
    return status;
}
