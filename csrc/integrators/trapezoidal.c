/* The trapezoidal rule,
 *
 *     y1 = y0 + h/2 (f(t0, y0) + f(t1, y1)),
 *
 * which for y = (p, v) is the method of Newmark with beta = 1/4 and gamma = 1/2, for any system: y1 is found by Newton's
 * iteration with the matrix I - h/2 df/dy. That matrix comes from differences and is kept from step to step as long as
 * the iteration contracts well with it.
 */
#include <math.h>
#include <string.h>

#include "../linalg/dense.h"
#include "../linalg/iteration.h"
#include "../linalg/small.h"
#include "integrator.h"

enum {
    MAX_ITERATIONS = 20,
    STALLS = 3,             /* successive iterations: by then every entry that can converge has done so */
};
static const double SLOW = 0.01;                /* contraction of the residual above which the matrix is computed anew */
static const double STEP_ROUNDING = 4 * 0x1p-52; /* residual relative to its terms below which the step is solved */
static const double NEARLY = 1e-12;             /* residual relative to its terms: a smaller one that no longer shrinks is rounding error */
static const double NEVER = 1e-9;               /* residual relative to the largest terms: a larger one is not taken for rounding error */
/* ratio to the change by a disturbance of the last bit: a larger residual is not rounding error */
static const double ROUNDING_RATIO = 16;
/* relative to the largest terms: smaller terms may themselves be the rounding error of others */
static const double MIN_TERMS = 0x1p-12;
static const double STALLED = 0.5;              /* contraction of the residual above which the iteration has stalled */

typedef struct trapezoidal {
    int size;
    double *y0, *f0;    /* (size,) */
    double *y1, *f1;    /* (size,) */
    double *disturbed;  /* (size,): y1 with other last bits */
    double *g;          /* (size,): residual, then Newton's step */
    zd_differences differences;
    double *J;          /* (size, size): I - h/2 df/dy in the units of the differences, factored */
    int *order;         /* (size,) */
    int factored;
    double factored_h;
    const zd_rate *rate;
    double t1, h;       /* end and size of the step */
    double defect, before;  /* residual relative to its terms, now and in the previous iteration */
    int stalls;             /* number of successive iterations that have stalled */
} trapezoidal;

static int suits(const zd_system *system)
{
    return !zd_is_too_large(system);
}

static void *create(zd_arena *arena, const void *table, zd_motion *motion, double *y, int size, const void *given)
{
    (void)table, (void)y, (void)given;
    size_t n = size;
    trapezoidal self = {
        .size = size,
        .y0 = zd_arena_doubles(arena, n),
        .f0 = zd_arena_doubles(arena, n),
        .y1 = zd_arena_doubles(arena, n),
        .f1 = zd_arena_doubles(arena, n),
        .disturbed = zd_arena_doubles(arena, n),
        .g = zd_arena_doubles(arena, n),
        .differences = zd_differences_create(arena, size),
        .J = zd_arena_doubles(arena, n * n),
        .order = zd_arena_ints(arena, n),
        .rate = &motion->rate,
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

static int rate_at_end(trapezoidal *self, double *f)
{
    return self->rate->evaluate(self->rate->context, self->t1, self->y1, f);
}

static int factor_matrix(trapezoidal *self)
{
    const int n = self->size;
    zd_differences_choose_units(&self->differences);
    int status = zd_differences_make(&self->differences, self->rate, self->t1, self->h, -0.5 * self->h, self->y1, self->f1, self->J);
    if (status) return status;
    for (int i = 0; i < n; i++) self->J[i * n + i] += 1;
    self->factored = zd_lu_factor(n, self->J, self->order) == n;
    self->factored_h = self->h;
    return self->factored ? ZD_DONE : ZD_NO_STEP;
}

/* Residual of an entry, relative to its terms; infinite where it is not a number. */
static double share_of_terms(double g, double terms)
{
    return isnan(g) ? INFINITY : g != 0 && terms > 0 ? fabs(g) / terms : 0;
}

/* y1 with its last bits changed, up and down by turns */
static void disturb(const trapezoidal *self, double by, double *y)
{
    for (int i = 0; i < self->size; i++) y[i] = self->y1[i] * (1 + (i % 2 ? by : -by));
}

/* Largest entry of the residual, relative to its terms or to the least that counts as terms. */
static double measure_stalled(const trapezoidal *self, const double *g, double scale)
{
    double largest = 0;
    for (int i = 0; i < self->size; i++)
        largest = fmax(largest, share_of_terms(g[i], fmax(self->differences.scale[i], MIN_TERMS * scale)));
    return largest;
}

/* Sets *is_rounding where the residual is the rounding error of the rates, which grows with stiffness: then a y1 with other last bits changes
 * the residual by about its own size. */
static int test_for_rounding(trapezoidal *self, double largest, double scale, int *is_rounding)
{
    const double defect = measure_stalled(self, self->g, scale);
    *is_rounding = self->defect < NEARLY || (self->stalls >= STALLS && defect < NEARLY);
    if (*is_rounding || !(largest < NEVER * scale)) return ZD_DONE;
    double *disturbed = self->disturbed, *change = self->differences.varied;
    disturb(self, 0x1p-52, disturbed);
    int status = self->rate->evaluate(self->rate->context, self->t1, disturbed, change);
    if (status) return status;
    for (int i = 0; i < self->size; i++) change[i] = 0.5 * self->h * (change[i] - self->f1[i]);
    *is_rounding = defect <= ROUNDING_RATIO * measure_stalled(self, change, scale);
    return ZD_DONE;
}

static int residual(void *context, double *size)
{
    trapezoidal *self = context;
    int is_rounding = 0, status = rate_at_end(self, self->f1);
    if (status) return status;
    double largest = 0, scale = 0, from_nothing = 0, *seen = self->differences.scale;
    self->defect = 0;
    for (int i = 0; i < self->size; i++) {
        double mean = 0.5 * self->h * (self->f0[i] + self->f1[i]);
        double g = self->g[i] = self->y1[i] - self->y0[i] - mean;
        seen[i] = fmax(seen[i], fabs(self->y0[i]) + fabs(mean));
        self->defect = fmax(self->defect, share_of_terms(g, seen[i]));
        if (!(seen[i] > 0)) from_nothing = fmax(from_nothing, fabs(g));
        largest = fmax(largest, fabs(g));
        scale = fmax(scale, seen[i]);
    }
    /* Entries whose y and f have been zero so far: a residual there is rounding error of the other entries. */
    if (from_nothing > 0) self->defect = fmax(self->defect, from_nothing / scale);
    /* f may be a difference of larger terms, whose rounding error then remains. Where f and y almost vanish, the residual is measured
     * by the largest entry. */
    const int stalled = self->defect > STALLED * self->before && self->defect < INFINITY;
    self->stalls = stalled ? self->stalls + 1 : 0;
    if (stalled) status = test_for_rounding(self, largest, scale, &is_rounding);
    *size = !stalled ? self->defect : is_rounding ? 0 : largest / scale;
    return status;
}

static int improve(void *context)
{
    trapezoidal *self = context;
    double now = self->defect;
    int stale = !self->factored || self->factored_h != self->h || now > SLOW * self->before;
    self->before = now;
    if (stale) {
        int status = factor_matrix(self);
        if (status) return status;
    }
    for (int i = 0; i < self->size; i++) self->g[i] /= self->differences.unit[i];
    zd_lu_solve(self->size, self->J, self->order, self->g);
    for (int i = 0; i < self->size; i++) self->y1[i] -= self->g[i] * self->differences.unit[i];
    return ZD_DONE;
}

static int solve_step(trapezoidal *self, zd_statistics *statistics)
{
    const zd_newton newton = {residual, improve, STEP_ROUNDING, MAX_ITERATIONS, 0, NULL, 0};
    int iterations;
    double left;
    self->before = INFINITY;
    self->stalls = 0;
    int status = zd_newton_solve(&newton, self, &iterations, &left);
    statistics->implicit_iterations += iterations;
    return status;
}

/* The state may have become another one. */
static void resize(trapezoidal *self, int size)
{
    if (size == self->size) return;
    self->size = size;
    self->factored = 0;
    zd_differences_resize(&self->differences, size);
}

static int step(void *memory, const zd_rate *rate, double t, double h, double *y, zd_statistics *statistics)
{
    trapezoidal *self = memory;
    resize(self, rate->size);
    size_t bytes = self->size * sizeof *y;
    self->t1 = t + h;
    self->h = h;
    memcpy(self->y0, y, bytes);
    int status = rate->evaluate(rate->context, t, y, self->f0);
    if (status) return status;
    for (int i = 0; i < self->size; i++) self->y1[i] = y[i] + h * self->f0[i];

    self->differences.min_size = 0;
    status = solve_step(self, statistics);
    if (status == ZD_NO_CONVERGENCE || status == ZD_NO_STEP) {
        self->factored = 0;
        self->differences.min_size = 1e-3 * zd_max_abs(self->size, y);
        for (int i = 0; i < self->size; i++) self->y1[i] = y[i] + h * self->f0[i];
        status = solve_step(self, statistics);
    }
    if (status) return status == ZD_NO_CONVERGENCE ? ZD_NO_STEP : status;
    memcpy(y, self->y1, bytes);
    return ZD_DONE;
}

const zd_integrator zd_trapezoidal = {
    .card = {
        .name = "trapezoidal",
        .summary = "The implicit trapezoidal rule: Newmark's method with beta = 1/4, gamma = 1/2.",
        .equations = "section 4.2",
        .order = 2,
        .description = "An implicit method of order two whose equations are solved by Newton's iteration with a matrix from differences, "
                       "which is reused while the iteration converges. It is stable for steps of any size, hence suited for stiff systems, "
                       "and conserves the energy of linear ones. Motions that it does not resolve are stable, but wrong.",
        .reference = "N. M. Newmark, A method of computation for structural dynamics, Journal of the Engineering Mechanics "
                     "Division 85 (1959) 67-94",
    },
    .suits = suits,
    .create = create,
    .step = step,
};
