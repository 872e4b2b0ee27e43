/* Radau's method IIA with three stages, of order five:
 *
 *     z_i = h sum_j a_ij f(t + c_j h, y + z_j),    y <- y + z_3
 *
 * It is stable for steps of any size and damps what it cannot resolve. Z is found by Newton's iteration; with A^-1 = T Lambda T^-1 and
 * W = T^-1 Z, its equations (Lambda / h) W - J W = T^-1 F(Z) - (Lambda / h) W fall apart into one real and one complex system of the state's
 * size, or of half of that: pairs.c. J is kept from step to step as long as the iteration contracts well with it, and its factors as
 * long as h stays. Where steps are longer than one J serves, each stage has its own: stages.c.
 *
 * E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd edition, 1996, section IV.8: the numbers, the estimate of the error,
 * and when to make J anew.
 */
#include <math.h>

#include "../../linalg/small.h"
#include "iteration.h"

enum { STAGES = ZD_RADAU_STAGES };

static const double *const c = zd_radau_c;
/* Weights of the stages in the error estimate: (-13 - 7 sqrt(6)) / 3, (-13 + 7 sqrt(6)) / 3, -1 / 3 */
static const double e[STAGES] = {-10.048809399827415562, 1.3821427331607488952, -1.0 / 3};

static const double SLOW = 0.001;               /* contraction of an iteration above which J is computed anew for the next step */
static const double CHANGE_ROUNDING = 4 * 0x1p-52; /* change relative to the state below which a fixed step is solved */
static const double MIN_INCREMENT = 1e-3;     /* smallest increment of any entry, relative to that of the largest entry of the state */
static const double WORTH_STAGES = 2;           /* ratio of the step to the bound above which each stage gets its own J */
static const double LONGER = 2;                 /* ratio to the previous step up to which its polynomial predicts the stages for J */
static const double SHORTER = 0.5;              /* ratio of the bound to a step that was too long for the iteration with one J */
static const double GROWTH = 0.005;             /* relative growth of the bound with each step after that */

typedef struct radau {
    zd_radau_newton newton; /* with start, size and stages of the last step */
    double *f0;             /* (size,): rate at the start of the step */
    double *before;         /* (STAGES, size): z of the previous step, from which iterations are started */
    double previous_h;        /* size of the previous step; 0: none */
    double *seen_before;    /* (size,): newton.seen before the step, restored if it fails */
    double bound;           /* s: upper bound of steps with one J, set by one that was too long for the iteration; 0: none */
    int steps_since;        /* steps since the bound was set */
    int filters;            /* true in the first step and in one that is repeated: a large error estimate is filtered */
} radau;

static int suits(const zd_system *system)
{
    return !zd_is_too_large(system);
}

static void *create(zd_arena *arena, const void *table, zd_motion *motion, double *y, int size, const void *given)
{
    (void)table, (void)given;
    const size_t n = size;
    radau self = {
        .newton = zd_radau_newton_create(arena, &motion->rate, y, size),
        .f0 = zd_arena_doubles(arena, n),
        .before = zd_arena_doubles(arena, STAGES * n),
        .seen_before = zd_arena_doubles(arena, n),
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

/* ---- a step ---- */

/* z <- extrapolation of the previous step's polynomial, or 0 */
static void start(radau *self)
{
    zd_radau_newton *it = &self->newton;
    const int n = it->size;
    zd_clear(STAGES * n, it->z);
    if (self->previous_h == 0) return;
    for (int s = 0; s < STAGES; s++)
        for (int i = 0; i < n; i++)
            it->z[s * n + i] = zd_radau_dense_output(self->before + i, n, 1 + c[s] * it->h / self->previous_h) - self->before[2 * n + i];
}

/* The step before is the one last made, where this begins at its end; or still the one before that, where it begins at its beginning anew. */
static void save_step(radau *self, double t, double h, const zd_rate *rate)
{
    zd_radau_newton *it = &self->newton;
    self->filters = isnan(it->t0) || t == it->t0;
    if (rate->size != it->size || rate->pairs != it->matrices.pairs) {
        it->size = rate->size;
        it->h = self->previous_h = 0;
        zd_radau_matrices_resize(&it->matrices, rate->size, rate->pairs);
    }
    const double end = it->t0 + it->h;
    if (it->h != 0 && fabs(t - end) <= CHANGE_ROUNDING * fabs(end)) {
        zd_copy_all(STAGES * it->size, it->z, self->before);
        self->previous_h = it->h;
        if (it->by_stages) zd_radau_stages_give_J(&it->stages, &it->matrices);
    } else if (t != it->t0) self->previous_h = 0;
    it->t0 = t;
    it->h = h;
}

static int solve_step(radau *self, double *y, int with_new_J, zd_statistics *statistics)
{
    zd_radau_newton *it = &self->newton;
    int status = with_new_J ? zd_radau_make_J(&it->matrices, it->rate, it->t0, it->h, y, self->f0) : ZD_DONE;
    if (with_new_J || it->by_stages) it->contraction = 1;       /* one J for each stage contracts much better */
    it->by_stages = 0;
    if (!status) status = zd_radau_factor(&it->matrices, it->h);
    if (status) return status;
    start(self);
    return zd_radau_newton_iterate(it, statistics);
}

static int iterate_by_stages(radau *self, double *y, zd_statistics *statistics)
{
    zd_radau_newton *it = &self->newton;
    int status = zd_radau_stages_make(&it->stages, &it->matrices, it->rate, it->t0, it->h, y, it->z, it->stage, it->f);
    it->contraction = 1;
    return status ? status : zd_radau_newton_iterate(it, statistics);
}

/* With a J for each stage: where it is thought to be, and where the iteration has led if that does not serve. The estimate of the error has
 * that of the beginning. */
static int solve_by_stages(radau *self, double *y, zd_statistics *statistics)
{
    zd_radau_newton *it = &self->newton;
    it->by_stages = 1;
    int status = it->matrices.has_J ? ZD_DONE : zd_radau_make_J(&it->matrices, it->rate, it->t0, it->h, y, self->f0);
    if (!status) status = zd_radau_factor_real(&it->matrices, it->h);
    if (status) return status;
    start(self);
    status = iterate_by_stages(self, y, statistics);
    return status == ZD_NO_CONVERGENCE && it->contraction < 1 ? iterate_by_stages(self, y, statistics) : status;
}

/* Longer steps than the iteration has just been able to solve with one J are solved with that of each stage. */
static int solve_somehow(radau *self, double *y, zd_statistics *statistics)
{
    zd_radau_newton *it = &self->newton;
    const int had_J = it->matrices.has_J, has_stages = zd_radau_stages_serve(&it->matrices);
    if (has_stages && self->bound > 0 && it->h > self->bound) return solve_by_stages(self, y, statistics);
    int status = solve_step(self, y, !had_J, statistics);
    if (status && status != ZD_CALLBACK && had_J) status = solve_step(self, y, 1, statistics);
    if (!status) return ZD_DONE;
    self->bound = SHORTER * it->h;
    self->steps_since = 0;
    return status == ZD_CALLBACK || !has_stages ? status : solve_by_stages(self, y, statistics);
}

static int step(void *memory, const zd_rate *rate, double t, double h, double *y, zd_statistics *statistics)
{
    radau *self = memory;
    zd_radau_newton *it = &self->newton;
    save_step(self, t, h, rate);
    int status = zd_rate_of_beginning(rate, t, y, self->f0);
    if (status) return status;
    it->matrices.differences.min_size = MIN_INCREMENT * zd_max_abs(rate->size, y);
    zd_copy_all(rate->size, it->seen, self->seen_before);
    for (int i = 0; i < rate->size; i++) it->seen[i] = fmax(it->seen[i], fabs(y[i]) + fabs(h * self->f0[i]));
    status = solve_somehow(self, y, statistics);
    it->has_scale = 0;
    it->matrices.has_J = !status && (it->contraction <= SLOW || it->iterations <= 2);
    if (status) {
        zd_copy_all(rate->size, self->seen_before, it->seen);
        it->contraction = 1;
        it->h = 0;
        return status == ZD_NO_CONVERGENCE || status == ZD_NOT_FINITE ? ZD_NO_STEP : status;
    }
    self->bound *= ++self->steps_since * GROWTH + 1;
    for (int i = 0; i < it->size; i++) y[i] += it->z[2 * it->size + i];
    return ZD_DONE;
}

/* ---- its error ---- */

static void set_scale(void *memory, int size, const double *scale)
{
    radau *self = memory;
    zd_radau_newton *it = &self->newton;
    zd_copy_all(size, scale, it->scale);
    it->has_scale = 1;
}

/* error <- (gamma / h - J)^-1 (f + sum_i e_i z_i / h) */
static void estimate(const radau *self, const double *f, double *error)
{
    const zd_radau_newton *it = &self->newton;
    const int n = it->size;
    const double *z = it->z;
    for (int i = 0; i < n; i++) error[i] = f[i] + (e[0] * z[i] + e[1] * z[n + i] + e[2] * z[2 * n + i]) / it->h;
    zd_radau_solve_real(&it->matrices, error);
}

/* Error estimate. In a step that is long for the fastest components, the estimate contains their deviation from equilibrium at its beginning,
 * which the method damps. Where such a deviation is expected, in the first step, or has had a step rejected, an estimate that is too large
 * is computed again from the rate at y0 + error, which filters that part (Hairer and Wanner, equation 8.20). In other steps it is the
 * error of these components, which move with the slow ones, and must not be filtered. */
static int error(void *memory, const zd_rate *rate, double t1, double h, const double *y, const double *scale, double *norm,
                 double *lambda_h)
{
    (void)t1, (void)h;
    radau *self = memory;
    zd_radau_newton *it = &self->newton;
    const int n = it->size;
    double *error = it->change, *f = it->f;
    *lambda_h = 0;
    estimate(self, self->f0, error);
    *norm = zd_root_mean_square(n, error, scale);
    if (*norm <= 1 || !self->filters) return ZD_DONE;
    for (int i = 0; i < n; i++) it->stage[i] = y[i] - it->z[2 * n + i] + error[i];
    int status = rate->evaluate(rate->context, it->t0, it->stage, f);
    if (status) return status;
    estimate(self, f, error);
    *norm = zd_root_mean_square(n, error, scale);
    return ZD_DONE;
}

static void forget(void *memory)
{
    radau *self = memory;
    self->newton.t0 = NAN;
    self->newton.matrices.has_J = 0;
}

/* Largest step for which the iteration is expected to converge. Its contraction is not known before, as J changes within a step, so bounds
 * are learned from steps that failed. */
static double limit_step(const void *memory, double h)
{
    const radau *self = memory;
    const zd_radau_newton *it = &self->newton;
    if (self->bound == 0 || h <= self->bound) return h;
    return zd_radau_stages_serve(&it->matrices) && h > WORTH_STAGES * self->bound ? fmin(h, LONGER * it->h) : self->bound;
}

/* The collocation polynomial through the stages needs no preparation. */
static int prepare_dense(void *self, const zd_rate *rate, double t, double h, const double *y0, const double *y1)
{
    (void)self, (void)rate, (void)t, (void)h, (void)y0, (void)y1;
    return ZD_DONE;
}

static void dense_output(const void *memory, double share, const double *y0, double *y)
{
    const radau *self = memory;
    const zd_radau_newton *it = &self->newton;
    for (int i = 0; i < it->size; i++) y[i] = y0[i] + zd_radau_dense_output(it->z + i, it->size, share);
}

const zd_integrator zd_radau = {
    .card = {
        .name = "radau",
        .summary = "Radau's implicit method IIA with three stages, of order five, for stiff systems.",
        .equations = "Hairer and Wanner, section IV.8",
        .order = 5, .error_order = 3,
        .description = "Order five, stable for steps of any size; components that are too fast for a step are damped: for stiff systems, "
                       "with adaptive steps by an error estimate of order three. Its equations are solved by Newton's iteration with a "
                       "Jacobian, which is reused while the iteration converges: that of the equations if these are compiled expressions, "
                       "else from derivatives of the residuals, as in linearization; near bifurcations, where rates change abruptly, a step "
                       "of fixed size may not be solved, and stops the run.",
        .reference = "E. Hairer, G. Wanner, Solving Ordinary Differential Equations II: Stiff and Differential-Algebraic Problems, "
                     "2nd edition, Springer, 1996, section IV.8",
    },
    .takes_jacobian = 1,
    .suits = suits,
    .create = create,
    .step = step,
    .set_scale = set_scale,
    .error = error,
    .limit_step = limit_step,
    .forget = forget,
    .prepare_dense = prepare_dense,
    .dense_output = dense_output,
};
