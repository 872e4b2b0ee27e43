/* Radau's method IIA with three stages, of order five:
 *
 *     z_i = h sum_j a_ij f(t + c_j h, y + z_j),    y <- y + z_3
 *
 * It is stable for steps of any size and damps what it cannot resolve. Z is found by Newton's iteration; with A^-1 = T Lambda T^-1 and
 * W = T^-1 Z, its equations (Lambda / h) W - J W = T^-1 F(Z) - (Lambda / h) W fall apart into one real and one complex system of the state's
 * size, or of half of that: radau_pairs.c. J is kept from step to step as long as the iteration contracts well with it, and its factors as
 * long as h stays. Where steps are longer than one J serves, each stage has its own: radau_stages.c.
 *
 * E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd edition, 1996, section IV.8: the numbers, the estimate of the error,
 * and when to make J anew.
 */
#include <math.h>
#include <string.h>

#include "../linalg/newton.h"
#include "../linalg/norms.h"
#include "../linalg/roots.h"
#include "radau_factors.h"
#include "radau_stages.h"

enum {
    STAGES = ZD_RADAU_STAGES,
    MOST_ITERATIONS = 40,   /* to rounding; */
    WORTHWHILE = 10,        /* where an error is allowed, shorter steps are cheaper than more of them */
};

static const double *const c = zd_radau_c;
/* Of the error's estimate, in the stages: (-13 - 7 sqrt(6)) / 3, (-13 + 7 sqrt(6)) / 3, -1 / 3 */
static const double e[STAGES] = {-10.048809399827415562, 1.3821427331607488952, -1.0 / 3};

static const double SLOW = 0.001;               /* J is made anew for the next step when an iteration has left more of the one before */
static const double SMALL = 0.0001;             /* of the error that is allowed: what the iteration may leave, which adds up over steps */
static const double ROUNDING = 4 * 0x1p-52;     /* of the state: with no more, a step of fixed size is solved */
static const double NEARLY = 1e-12;             /* of the state: a change so small that no longer shrinks is rounding; */
static const double PERHAPS = 1e-9;             /* one so small may be, where rates are stiff */
static const double EXPLAINED = 16;             /* times what rounding the stages in another way changes: so much it may be */
static const double LEAST = 1e-3;               /* of the largest entry of the state: the others are varied by no less */
static const double WORTH_STAGES = 2;           /* times the bound: a step so much longer is worth a J for each stage */
static const double LONGER = 2;                 /* times the step before: where its polynomial still leads near enough to solve with J there */
static const double SHORTER = 0.5;              /* the bound, of a step that was too long for the iteration with one J, */
static const double GROWTH = 0.005;             /* and by how much more it grows with each step after that */
static const double STALLED = 0.5;              /* of the change before: an iteration that changes more has stalled */

typedef struct radau {
    int size;
    double *f0;             /* (size,): where the step begins */
    double *f, *z, *w;      /* (STAGES, size) */
    double *change;         /* (STAGES, size): of w, by an iteration; */
    double *other;          /* the same, where stages are rounded in another way */
    double *before;         /* (STAGES, size): z of the step before, by which an iteration starts */
    double *stage;          /* (size,) */
    double *error_scale;    /* (size,): what the error of the step is measured by, */
    int has_scale;          /* if it is: values within a step, which are not, are solved to rounding, as they have to be the same whenever asked for */
    zd_radau_matrices matrices;
    zd_radau_stages stages;
    int by_stages;          /* whether the step last made was solved with a J for each of them */
    double *seen;           /* (size,): the differences' scale, */
    double *seen_before;    /* and what it was before the step, which an iteration may have led anywhere */
    double t0, h;           /* of the step last made, from its beginning */
    double before_h;        /* 0: there was no step before */
    double contraction;     /* what the last iteration left of the change before */
    double bound;           /* s: of steps with one J, from one that was too long for the iteration, and growing since; 0: there was none */
    int steps_since;        /* that */
    double norm_before;     /* of the iteration before, in this step; 0: there was none */
    int iterations;
    /* of the step being solved */
    const zd_rate *rate;
    const double *y0;
} radau;

static int suits(const zd_system *system)
{
    return !zd_is_too_large(system);
}

static void *take(zd_arena *arena, const void *table, const zd_system *system, int size, const void *given)
{
    (void)given;
    (void)table, (void)system;
    const size_t n = (size_t)size;
    radau self = {
        .size = size,
        .f0 = zd_take_doubles(arena, n),
        .f = zd_take_doubles(arena, STAGES * n),
        .z = zd_take_doubles(arena, STAGES * n),
        .w = zd_take_doubles(arena, STAGES * n),
        .change = zd_take_doubles(arena, STAGES * n),
        .other = zd_take_doubles(arena, STAGES * n),
        .before = zd_take_doubles(arena, STAGES * n),
        .stage = zd_take_doubles(arena, n),
        .seen_before = zd_take_doubles(arena, n),
        .error_scale = zd_take_doubles(arena, n),
        .matrices = zd_radau_matrices_take(arena, size),
        .stages = zd_radau_stages_take(arena, size),
        .contraction = 1,
    };
    self.seen = self.matrices.differences.scale;
    return zd_take_filled(arena, &self, sizeof self);
}

/* ---- Newton's iteration ---- */

static void see_sizes(radau *self)
{
    const int n = self->size;
    const double *z = self->z, *change = self->change;
    double *seen = self->seen;
    for (int k = 0; k < STAGES * n; k++) seen[k % n] = fmax(seen[k % n], fabs(z[k]) + fabs(change[k]));
}

/* In units of what an iteration may leave */
static double measure(const radau *self)
{
    const int n = self->size;
    const double *scale = self->has_scale ? self->error_scale : self->seen;
    double sum = 0, largest = 0;
    for (int k = 0; k < STAGES * n; k++) {
        const double part = fabs(self->change[k]) / scale[k % n];
        if (self->change[k] == 0) continue;
        if (isnan(part)) return part;
        sum += part * part;
        largest = fmax(largest, part);
    }
    return self->has_scale ? sqrt(sum / (STAGES * n)) / SMALL : largest / ROUNDING;
}

/* change <- what an iteration adds to w */
static void solve(radau *self)
{
    const int n = self->size;
    const double h = self->h, *w = self->w;
    double *x = self->change;
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
    radau *self = context;
    for (int i = 0; i < STAGES * self->size; i++) self->w[i] += self->change[i];
    zd_radau_transform(self->size, zd_radau_T, self->w, self->z);
    return ZD_DONE;
}

/* With entries that are off by shares of these sizes, up and down by turns; 0: by nothing */
static int evaluate_stages(radau *self, double share)
{
    const int n = self->size;
    for (int s = 0; s < STAGES; s++) {
        for (int i = 0; i < n; i++) self->stage[i] = (self->y0[i] + self->z[s * n + i]) * (1 + ((i + s) % 2 ? share : -share));
        int status = self->rate->evaluate(self->rate->context, self->t0 + c[s] * self->h, self->stage, self->f + s * n);
        if (status) return status;
    }
    return ZD_DONE;
}

static void exchange(double **a, double **b)
{
    double *kept = *a;
    *a = *b;
    *b = kept;
}

/* Whether a change that no longer shrinks is nothing but what rates are rounded by, which is the more the stiffer they are: then the
 * change is another by about as much where the stages are rounded in another way. Entries of the state that are nothing but rounding do
 * not show their size: that of all has to do. */
static int explain_by_rounding(radau *self, double norm, int *explained)
{
    const int n = self->size;
    const double largest = zd_max_abs(STAGES * n, self->change), of_state = fmax(zd_max_abs(n, self->y0), zd_max_abs(STAGES * n, self->z));
    *explained = largest < NEARLY * zd_max_abs(n, self->seen);
    if (*explained || !(largest < PERHAPS * of_state)) return ZD_DONE;
    int status = evaluate_stages(self, 0x1p-52);
    if (status) return status;
    exchange(&self->change, &self->other);
    solve(self);
    for (int k = 0; k < STAGES * n; k++) self->change[k] -= self->other[k];
    *explained = norm <= EXPLAINED * measure(self);
    exchange(&self->change, &self->other);
    return ZD_DONE;
}

/* x^n, without pow, which ties a program to newer C libraries */
static double power(double x, int n)
{
    double product = 1;
    while (n-- > 0) product *= x;
    return product;
}

/* `size` is what w will miss once the change has been added, as the iteration contracts. */
static int residual(void *context, double *size)
{
    radau *self = context;
    int explained = 0, status = evaluate_stages(self, 0);
    if (status) return status;
    solve(self);
    see_sizes(self);
    const double norm = measure(self), before = self->norm_before;
    const int left = WORTHWHILE - ++self->iterations;
    if (before > 0) self->contraction = norm / before;
    const double share = self->contraction;
    self->norm_before = norm;
    *size = norm == 0 ? 0 : share < 1 ? share / (1 - share) * norm : norm;
    if (before > 0 && share > STALLED) status = explain_by_rounding(self, norm, &explained);
    if (status) return status;
    if (explained) *size = 0;
    else if (self->has_scale && before > 0 && !(share < 1 && *size * power(share, left) <= 1)) return ZD_NO_CONVERGENCE;
    return *size <= 1 ? add_change(self) : ZD_DONE;
}

static int iterate(radau *self, zd_statistics *statistics)
{
    const zd_newton newton = {residual, add_change, 1, MOST_ITERATIONS, 0, NULL, 0};
    int iterations;
    double left;
    zd_radau_transform(self->size, zd_radau_T_inverse, self->z, self->w);
    self->norm_before = 0;
    self->iterations = 0;
    self->contraction = power(zd_root(fmax(self->contraction, 0x1p-52), 5), 4);     /* it may have changed since */
    int status = zd_newton_solve(&newton, self, &iterations, &left);
    statistics->implicit_iterations += self->iterations;
    return status;
}

/* ---- a step ---- */

/* z from where the step before leads, or from nothing */
static void start(radau *self)
{
    const int n = self->size;
    memset(self->z, 0, (size_t)(STAGES * n) * sizeof(double));
    if (self->before_h == 0) return;
    for (int s = 0; s < STAGES; s++)
        for (int i = 0; i < n; i++)
            self->z[s * n + i] = zd_radau_value_between(self->before + i, n, 1 + c[s] * self->h / self->before_h) - self->before[2 * n + i];
}

/* The step before is the one last made, where this begins at its end; or still the one before that, where it begins at its beginning anew. */
static void remember(radau *self, double t, double h, const zd_rate *rate)
{
    if (rate->size != self->size || rate->pairs != self->matrices.pairs) {
        self->size = rate->size;
        self->h = self->before_h = 0;
        zd_radau_matrices_resize(&self->matrices, rate->size, rate->pairs);
    }
    const double end = self->t0 + self->h;
    if (self->h != 0 && fabs(t - end) <= ROUNDING * fabs(end)) {
        exchange(&self->before, &self->z);
        self->before_h = self->h;
        if (self->by_stages) zd_radau_stages_give_J(&self->stages, &self->matrices);
    } else if (t != self->t0) self->before_h = 0;
    self->t0 = t;
    self->h = h;
}

static int solve_step(radau *self, double *y, int with_new_J, zd_statistics *statistics)
{
    zd_radau_matrices *matrices = &self->matrices;
    self->by_stages = 0;
    int status = with_new_J ? zd_radau_make_J(matrices, self->rate, self->t0, self->h, y, self->f0) : ZD_DONE;
    if (with_new_J) self->contraction = 1;
    if (!status) status = zd_radau_factor(matrices, self->h);
    if (status) return status;
    start(self);
    return iterate(self, statistics);
}

static int iterate_by_stages(radau *self, double *y, zd_statistics *statistics)
{
    int status = zd_radau_stages_make(&self->stages, &self->matrices, self->rate, self->t0, self->h, y, self->z, self->stage, self->f);
    self->contraction = 1;
    return status ? status : iterate(self, statistics);
}

/* With a J for each stage: where it is thought to be, and where the iteration has led if that does not serve. The estimate of the error has
 * that of the beginning. */
static int solve_by_stages(radau *self, double *y, zd_statistics *statistics)
{
    zd_radau_matrices *matrices = &self->matrices;
    self->by_stages = 1;
    int status = matrices->has_J ? ZD_DONE : zd_radau_make_J(matrices, self->rate, self->t0, self->h, y, self->f0);
    if (!status) status = zd_radau_factor_real(matrices, self->h);
    if (status) return status;
    start(self);
    status = iterate_by_stages(self, y, statistics);
    return status == ZD_NO_CONVERGENCE && self->contraction < 1 ? iterate_by_stages(self, y, statistics) : status;
}

/* Longer steps than the iteration has just been able to solve with one J are solved with that of each stage. */
static int solve_somehow(radau *self, double *y, zd_statistics *statistics)
{
    const int had_J = self->matrices.has_J, has_stages = zd_radau_stages_serve(&self->matrices);
    if (has_stages && self->bound > 0 && self->h > self->bound) return solve_by_stages(self, y, statistics);
    int status = solve_step(self, y, !had_J, statistics);
    if (status && status != ZD_CALLBACK && had_J) status = solve_step(self, y, 1, statistics);
    if (!status) return ZD_DONE;
    self->bound = SHORTER * self->h;
    self->steps_since = 0;
    return status == ZD_CALLBACK || !has_stages ? status : solve_by_stages(self, y, statistics);
}

static int step(void *memory, const zd_rate *rate, double t, double h, double *y, zd_statistics *statistics)
{
    radau *self = memory;
    remember(self, t, h, rate);
    self->rate = rate;
    self->y0 = y;
    int status = zd_rate_of_beginning(rate, t, y, self->f0);
    if (status) return status;
    self->matrices.differences.least_size = LEAST * zd_max_abs(rate->size, y);
    memcpy(self->seen_before, self->seen, (size_t)rate->size * sizeof *self->seen);
    for (int i = 0; i < rate->size; i++) self->seen[i] = fmax(self->seen[i], fabs(y[i]) + fabs(h * self->f0[i]));
    status = solve_somehow(self, y, statistics);
    self->has_scale = 0;
    self->matrices.has_J = !status && (self->contraction <= SLOW || self->iterations <= 2);
    if (status) {
        memcpy(self->seen, self->seen_before, (size_t)rate->size * sizeof *self->seen);
        self->contraction = 1;
        self->h = 0;
        return status == ZD_NO_CONVERGENCE || status == ZD_NOT_FINITE ? ZD_NO_STEP : status;
    }
    self->bound *= ++self->steps_since * GROWTH + 1;
    for (int i = 0; i < self->size; i++) y[i] += self->z[2 * self->size + i];
    return ZD_DONE;
}

/* ---- its error ---- */

static void weigh(void *memory, int size, const double *scale)
{
    radau *self = memory;
    memcpy(self->error_scale, scale, (size_t)size * sizeof *scale);
    self->has_scale = 1;
}

static double root_mean_square(int n, const double *x, const double *scale)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += x[i] / scale[i] * (x[i] / scale[i]);
    return sqrt(sum / n);
}

/* error <- (gamma / h - J)^-1 (f + sum_i e_i z_i / h) */
static void estimate(const radau *self, const double *f, double *error)
{
    const int n = self->size;
    const double *z = self->z;
    for (int i = 0; i < n; i++) error[i] = f[i] + (e[0] * z[i] + e[1] * z[n + i] + e[2] * z[2 * n + i]) / self->h;
    zd_radau_solve_real(&self->matrices, error);
}

/* Where the step is long for the fastest parts, what it damps is taken for error at first: what follows if that is added at the beginning. */
static int error(void *memory, const zd_rate *rate, double t1, double h, const double *y, const double *scale, double *norm,
                 double *lambda_h)
{
    (void)t1, (void)h;
    radau *self = memory;
    const int n = self->size;
    double *error = self->change, *f = self->f;
    *lambda_h = 0;
    estimate(self, self->f0, error);
    *norm = root_mean_square(n, error, scale);
    if (*norm <= 1) return ZD_DONE;
    for (int i = 0; i < n; i++) self->stage[i] = y[i] - self->z[2 * n + i] + error[i];
    int status = rate->evaluate(rate->context, self->t0, self->stage, f);
    if (status) return status;
    estimate(self, f, error);
    *norm = root_mean_square(n, error, scale);
    return ZD_DONE;
}

/* What the iteration contracts by is not known beforehand, as J changes within a step: so it is tried. */
static double fit(const void *memory, double h)
{
    const radau *self = memory;
    if (self->bound == 0 || h <= self->bound) return h;
    return zd_radau_stages_serve(&self->matrices) && h > WORTH_STAGES * self->bound ? fmin(h, LONGER * self->h) : self->bound;
}

/* The polynomial that the stages lie on */
static int spread(void *self, const zd_rate *rate, double t, double h, const double *y0, const double *y1)
{
    (void)self, (void)rate, (void)t, (void)h, (void)y0, (void)y1;
    return ZD_DONE;
}

static void between(const void *memory, double share, const double *y0, double *y)
{
    const radau *self = memory;
    for (int i = 0; i < self->size; i++) y[i] = y0[i] + zd_radau_value_between(self->z + i, self->size, share);
}

const zd_integrator zd_radau = {
    .card = {
        .name = "radau",
        .summary = "Radau's implicit method IIA with three stages, of order five, for stiff systems.",
        .equations = "Hairer and Wanner, section IV.8",
        .order = 5, .error_order = 3,
        .description = "Order five, stable for steps of any size, and parts that are too fast for a step are damped: for stiff systems, "
                       "at steps chosen by an error estimate of order three. Its equations are solved by Newton's iteration with a "
                       "Jacobian, which is kept while it serves: that of the equations where these are expressions that are compiled, else "
                       "one by differences; near bifurcations, where rates change abruptly, "
                       "a step of fixed size may not be solved, and stops the run.",
        .reference = "E. Hairer, G. Wanner, Solving Ordinary Differential Equations II: Stiff and Differential-Algebraic Problems, "
                     "2nd edition, Springer, 1996, section IV.8",
    },
    .takes_jacobian = 1,
    .suits = suits,
    .take = take,
    .step = step,
    .weigh = weigh,
    .error = error,
    .fit = fit,
    .spread = spread,
    .between = between,
};
