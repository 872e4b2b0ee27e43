/* Taylor's method of any order: the motion's own series from where a step begins,
 *
 *     y(t + h) = sum_k y_k h^k,    k = 0 ... order
 *
 * whose coefficients come from the system. They tell before the step is made how long it may be: so that the last two terms are as small as
 * the error that is allowed, and what comes after them is smaller. Shorter steps from the same place, to times between, have the same
 * coefficients. Coefficients do not tell of a law that is flat here and steep further on: the rate at the end of a step is compared with
 * that of the series, and the step is made shorter where they differ.
 *
 * A state in independent velocities is expanded to (p, v) at the start of a step, whose series is that of the same motion, and (p, v) at its
 * end is reduced to the state. Sizes and errors then are those of all of p and v.
 *
 * A. Jorba, M. Zou, Experimental Mathematics 14 (2005) 99: the order that takes the least time for a tolerance, 1 - ln(tolerance) / 2.
 */
#include <math.h>
#include <string.h>

#include "../linalg/roots.h"
#include "integrator.h"

enum { MIN_ORDER = 2 };
static const double RESIDUAL = 10;      /* bound of h times the difference of rates, in units of the order times the tolerance */

typedef struct given_taylor {
    double order;
} given_taylor;

static const zd_parameter parameters[] = {
    {"order", "", "Order of the series with fixed steps; with adaptive steps the highest, lowered if the tolerance allows.", 1, ZD_COUNT,
     (const double[]){20}},
};

typedef struct taylor {
    const zd_system *system;
    int size, order;        /* size: p, v, and the energy input if there is one */
    int highest;            /* order */
    int is_known;           /* true if the coefficients are those at (t0, y0) */
    int converts;           /* true if the state is not (p, v) */
    double t0;
    double rtol, atol;
    double *y0;             /* the state */
    double *start, *end;    /* (nq + nv,): p and v at both ends of a step, where the state is converted */
    double *own_scale;      /* (size,): in units of which their errors are */
    double *p, *v, *work;   /* (order + 1, nq), (order + 1, nv), (order + 1,): coefficients */
    double *scratch;
    double *rate;           /* (size,) at the end of a step; (2, size) where the state is converted */
    int found;              /* series not yet counted in the statistics */
} taylor;

static int suits(const zd_system *system)
{
    return system->series != NULL;
}

static void *create(zd_arena *arena, const void *table, zd_motion *motion, double *y, int size, const void *given)
{
    (void)table, (void)y;
    const zd_system *system = &motion->system;
    const int order = (int)fmax(((const given_taylor *)given)->order, MIN_ORDER);
    const size_t orders = (size_t)order + 1, whole = system->nq + system->nv;
    taylor self = {
        .system = system,
        .size = size,
        .order = order,
        .highest = order,
        .y0 = zd_arena_doubles(arena, size),
        .start = zd_arena_doubles(arena, whole),
        .end = zd_arena_doubles(arena, whole),
        .own_scale = zd_arena_doubles(arena, whole + 1),
        .p = zd_arena_doubles(arena, orders * (size_t)system->nq),
        .v = zd_arena_doubles(arena, orders * (size_t)system->nv),
        .work = zd_arena_doubles(arena, orders),
        .rate = zd_arena_doubles(arena, 2 * (whole + 1)),
        .scratch = zd_arena_doubles(arena, orders * (size_t)(system->series ? system->series->scratch : 0)),
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

static void set_tolerance(void *memory, double rtol, double atol)
{
    taylor *self = memory;
    const double ten = 2.302585092994045684;    /* its logarithm; C libraries' own natural one ties the library to newer ones */
    const double order = ceil(1 - ten * log10(fmax(rtol, atol)) / 2);
    self->order = (int)fmax(MIN_ORDER, fmin(order, self->highest));
    self->rtol = rtol;
    self->atol = atol;
}

static int has_work(const taylor *self)
{
    return self->size > self->system->nq + self->system->nv;
}

static int find_series(taylor *self, const zd_rate *rate, double t, const double *y)
{
    const zd_system *system = rate->system;
    const size_t bytes = rate->size * sizeof *y;
    const int converts = rate->expand != NULL;      /* a state repeated on another evaluation path may be another set of variables */
    if (self->is_known && t == self->t0 && converts == self->converts && !memcmp(y, self->y0, bytes)) return ZD_DONE;
    self->is_known = 0;
    self->system = system;
    self->converts = converts;
    self->size = system->nq + system->nv + zd_has_input(system);
    int status = self->converts ? rate->expand(rate->context, t, y, self->start) : ZD_DONE;
    if (status) return status;
    const double *p = self->converts ? self->start : y;
    self->found++;
    status = system->series->evaluate(system->data, rate->inputs, self->order, t, p, p + system->nq, self->p, self->v,
                                      has_work(self) ? self->work : NULL, self->scratch);
    if (status) return status;
    memcpy(self->y0, y, bytes);
    self->t0 = t;
    self->is_known = 1;
    return ZD_DONE;
}

/* to <- sum_k x_k h^k, of x (order + 1, n) */
static void sum_up(int order, int n, const double *x, double h, double *to)
{
    for (int i = 0; i < n; i++) to[i] = x[order * n + i];
    for (int k = order - 1; k >= 0; k--)
        for (int i = 0; i < n; i++) to[i] = to[i] * h + x[k * n + i];
}

/* y, whose last entry is the energy input if there is one */
static int evaluate_at(taylor *self, const zd_rate *rate, double t1, double h, double *y)
{
    const int nq = self->system->nq, last = rate->size - 1;
    double *whole = self->converts ? self->end : y;
    sum_up(self->order, nq, self->p, h, whole);
    sum_up(self->order, self->system->nv, self->v, h, whole + nq);
    if (has_work(self)) {
        sum_up(self->order, 1, self->work, h, y + last);
        y[last] += self->y0[last];
    }
    return self->converts ? rate->reduce(rate->context, t1, whole, y) : ZD_DONE;
}

static int step(void *memory, const zd_rate *rate, double t, double h, double *y, zd_statistics *statistics)
{
    taylor *self = memory;
    int status = find_series(self, rate, t, y);
    statistics->evaluations += self->found;
    self->found = 0;
    return status ? status : evaluate_at(self, rate, t + h, h, y);
}

/* ---- its size and error ---- */

static double squares(int n, const double *x, const double *scale)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += x[i] / scale[i] * (x[i] / scale[i]);
    return sum;
}

/* RMS of the coefficients of order k, in units of scale */
static double size_of(const taylor *self, int k, const double *scale)
{
    const int nq = self->system->nq, nv = self->system->nv;
    double sum = squares(nq, self->p + k * nq, scale) + squares(nv, self->v + k * nv, scale + nq);
    if (has_work(self)) sum += squares(1, self->work + k, scale + nq + nv);
    return sqrt(sum / self->size);
}

/* Scales (size,) of p, v and the energy input, as those of the state are. */
static const double *scales_of(taylor *self, const zd_rate *rate, const double *whole, const double *scale)
{
    const int n = self->system->nq + self->system->nv;
    if (!self->converts) return scale;
    for (int i = 0; i < n; i++) self->own_scale[i] = self->atol + self->rtol * fmax(fabs(self->start[i]), fabs(whole[i]));
    if (has_work(self)) self->own_scale[n] = scale[rate->size - 1];
    return self->own_scale;
}

static int predict_step(void *memory, const zd_rate *rate, double t, const double *y, const double *scale, double *h)
{
    taylor *self = memory;
    int status = find_series(self, rate, t, y);
    *h = INFINITY;
    if (!status) scale = scales_of(self, rate, self->start, scale);
    for (int k = self->order - 1; !status && k <= self->order; k++) {
        const double size = size_of(self, k, scale);
        if (!(size < INFINITY)) return ZD_NOT_FINITE;
        if (size > 0) *h = fmin(*h, 1 / zd_root(size, k));
    }
    return status;
}

/* The sum of squares, in units of scale, of h times what the series' rate at h lacks of that found there; x (order + 1, n) */
static double rates_apart(const taylor *self, int n, const double *x, double h, const double *found, const double *scale)
{
    double sum = 0;
    for (int i = 0; i < n; i++) {
        double rate = 0;
        for (int k = self->order; k > 0; k--) rate = rate * h + k * x[k * n + i];
        const double apart = h * (found[i] - rate) / scale[i];
        sum += apart * apart;
    }
    return sum;
}

/* self->rate <- rates of p and v at the end of the step, and the power there. Where the state is converted to (p, v) for the series,
 * they are the first terms of a series that begins there. */
static int rates_at(taylor *self, const zd_rate *rate, double t1, const double *y)
{
    const zd_system *system = self->system;
    const int nq = system->nq, nv = system->nv, n = self->size, is_forced = has_work(self);
    if (!self->converts) return rate->evaluate(rate->context, t1, y, self->rate);
    double *series = self->rate, work[2] = {0};
    int status = system->series->evaluate(system->data, rate->inputs, 1, t1, self->end, self->end + nq, series, series + 2 * nq,
                                          is_forced ? work : NULL, self->scratch);
    if (status) return status;
    memmove(series, series + nq, nq * sizeof *series);
    memmove(series + nq, series + 2 * nq + nv, nv * sizeof *series);
    if (is_forced) series[n - 1] = work[1];
    return ZD_DONE;
}

/* Error estimate: the residual of the rates at the end of the step. The size of the step was chosen by the last coefficients, which may
 * be small by chance. */
static int error(void *memory, const zd_rate *rate, double t1, double h, const double *y, const double *scale, double *norm, double *lambda_h)
{
    taylor *self = memory;
    const int nq = self->system->nq, nv = self->system->nv;
    *lambda_h = 0;
    int status = rates_at(self, rate, t1, y);
    if (status) return status;
    scale = scales_of(self, rate, self->end, scale);
    double sum = rates_apart(self, nq, self->p, h, self->rate, scale) + rates_apart(self, nv, self->v, h, self->rate + nq, scale + nq);
    if (has_work(self)) sum += rates_apart(self, 1, self->work, h, self->rate + nq + nv, scale + nq + nv);
    *norm = sqrt(sum / self->size) / (RESIDUAL * self->order);
    return ZD_DONE;
}

const zd_integrator zd_taylor = {
    .card = {
        .name = "taylor",
        .summary = "Taylor series of any order, for systems whose expressions are known.",
        .equations = "Jorba and Zou, section 3",
        .order = 20, .error_order = 19, .stability = 8.6,
        .description = "Each step sums the Taylor series of the motion at its start, to an order chosen by the tolerance. It is suited for "
                       "errors near rounding, as few steps cause little rounding. In 1 ms it computes the paper's four-bar over 8 s to "
                       "1e-11, where the smallest error of 'dop853' is 5e-11; for errors of 1e-9 and more 'dop853' is faster. It requires a "
                       "built-in system, or expressions that are compiled, without cases that change during the motion.",
        .reference = "A. Jorba, M. Zou, A software package for the numerical integration of ODEs by means of high-order Taylor methods, "
                     "Experimental Mathematics 14 (2005) 99-117",
        .parameters = sizeof parameters / sizeof parameters[0],
        .parameter = parameters,
    },
    .takes_series = 1,
    .decay = 8.8,
    .suits = suits,
    .create = create,
    .step = step,
    .set_tolerance = set_tolerance,
    .predict_step = predict_step,
    .error = error,
};
