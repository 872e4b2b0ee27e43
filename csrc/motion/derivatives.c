#include "derivatives.h"

#include <math.h>
#include <string.h>

#include "../linalg/norms.h"
#include "../linalg/small.h"
#include "../point/matrices.h"

enum { POINTS = 4, ORDERS = 3, STEPS = 3 };
/* Weights of f(k h) - f(-k h), k = 1 ... 4, over h: of eighth, sixth and fourth order */
static const double WEIGHT[ORDERS][POINTS] = {
    {4. / 5, -1. / 5, 4. / 105, -1. / 280}, {3. / 4, -3. / 20, 1. / 60, 0}, {2. / 3, -1. / 12, 0, 0}};
static const double STEP[STEPS] = {2e-2, 2e-3, 5e-4};      /* characteristic scales: a shorter one where the orders disagree */
static const double CENTRAL_STEP = 1e-4;
static const double AGREE = 1e-10;      /* difference of the orders relative to the derivative that is accepted */

zd_residual_state zd_residual_state_take(zd_arena *arena, const zd_system *system, zd_statistics *statistics, enum zd_accuracy accuracy)
{
    const size_t width = (size_t)(system->nq + system->nv + 2 * zd_constraints(system) + 1);
    return (zd_residual_state){
        .varied = zd_point_take(arena, system, statistics),
        .here = zd_take_doubles(arena, width),
        .there = zd_take_doubles(arena, width),
        .x = zd_take_doubles(arena, (size_t)(system->nq + system->nv)),
        .sums = accuracy == ZD_ACCURATE ? zd_take_doubles(arena, ORDERS * width) : NULL,
        .scratch = system->residuals ? zd_take_doubles(arena, (size_t)system->residuals->scratch) : NULL,
    };
}

void zd_residual_state_begin(zd_residual_state *self, int parts, zd_point *point, const double *vdot, const double *lambda)
{
    const zd_system *system = self->varied->system;
    const int m = zd_constraints(system);
    self->parts = parts;
    self->width = (parts & ZD_RESIDUAL_R ? system->nv : 0) + (parts & ZD_RESIDUAL_S ? m : 0) + (parts & ZD_RESIDUAL_PSI ? m : 0)
                + (parts & ZD_RESIDUAL_PDOT ? system->nq : 0) + (parts & ZD_RESIDUAL_POWER ? 1 : 0);
    self->point = point, self->vdot = vdot, self->lambda = lambda;
    self->moves = vdot && zd_max_abs(system->nv, vdot) != 0;
    self->knows_here = 0;
    self->varied->known &= self->varied->constant;      /* inputs may have been set */
    self->varied->terms.inputs = point->terms.inputs;
}

/* ---- residuals ---- */

/* The parts in an array, those that are not requested as NULL */
static zd_derivatives places(const zd_residual_state *self, double *x)
{
    const zd_system *system = self->varied->system;
    const int m = zd_constraints(system), sizes[] = {system->nv, m, m, system->nq, 1};
    double *at[5];
    for (int i = 0; i < 5; i++) {
        at[i] = self->parts >> i & 1 ? x : NULL;
        x += at[i] ? sizes[i] : 0;
    }
    return (zd_derivatives){.dynamics = at[0], .accelerations = at[1], .velocities = at[2], .rates = at[3], .power = at[4]};
}

static void write_dynamics(const zd_residual_state *self, const zd_point *point, double *r)
{
    const int n = point->system->nv;
    zd_point_force(point, point->force);
    if (self->moves) zd_times_M(point, point->terms.M, self->vdot, r);
    else memset(r, 0, (size_t)n * sizeof *r);
    for (int i = 0; i < n; i++) r[i] -= point->force[i];
    for (int k = 0; k < zd_constraints(point->system); k++) {
        const zd_row_of_C row = zd_point_row(point, k);
        for (int j = 0; j < row.count; j++) r[zd_column(&row, j)] += self->lambda[k] * row.x[j];
    }
}

/* y (m,) <- C x + sign times the term, which may be absent */
static void write_rows(const zd_point *point, const double *x, double sign, const double *term, double *y)
{
    for (int k = 0; k < zd_constraints(point->system); k++) {
        const zd_row_of_C row = zd_point_row(point, k);
        y[k] = (x ? zd_row_times(&row, x) : 0) + (term ? sign * term[k] : 0);
    }
}

static double power_of(const zd_point *point, const double *lambda)
{
    double sum = point->terms.power ? *point->terms.power : 0;
    for (int k = 0; point->terms.Phi_t && k < zd_constraints(point->system); k++) sum += lambda[k] * point->terms.Phi_t[k];
    return sum;
}

/* to (width,) <- residuals at a point */
static int evaluate(const zd_residual_state *self, zd_point *point, double *to)
{
    const zd_derivatives of = places(self, to);
    const int want = (of.dynamics ? ZD_BIAS | ZD_FORCE | (self->moves ? ZD_M : 0) : 0) | (of.accelerations ? ZD_XI : 0)
                   | (of.dynamics || of.accelerations || of.velocities ? ZD_C : 0)
                   | (of.velocities || of.power ? ZD_PHI_T : 0) | (of.power ? ZD_POWER : 0);
    int status = of.rates ? zd_point_need_times_A(point, want) : zd_point_need(point, want);
    if (status) return status;
    if (of.dynamics) write_dynamics(self, point, of.dynamics);
    if (of.accelerations) write_rows(point, self->moves ? self->vdot : NULL, -1, point->terms.xi, of.accelerations);
    if (of.velocities) write_rows(point, point->v, 1, point->terms.Phi_t, of.velocities);
    if (of.rates) zd_point_rate(point, point->v, of.rates);
    if (of.power) *of.power = power_of(point, self->lambda);
    return ZD_DONE;
}

/* The same at distance h along a direction */
static int evaluate_along(zd_residual_state *self, const zd_direction *direction, double h, double *to)
{
    const zd_point *from = self->point;
    const int nq = from->system->nq, nv = from->system->nv;
    double *p = self->x, *v = p + nq;
    for (int i = 0; i < nq; i++) p[i] = from->p[i] + (direction->p ? h * direction->p[i] : 0);
    for (int i = 0; i < nv; i++) v[i] = from->v[i] + (direction->v ? h * direction->v[i] : 0);
    zd_point_move(self->varied, from->t + h * direction->t, p, v);
    return evaluate(self, self->varied, to);
}

/* ---- differences ---- */

static int difference_once(zd_residual_state *self, const zd_direction *direction, double step, double *to)
{
    int status = self->knows_here ? ZD_DONE : evaluate(self, self->point, self->here);
    self->knows_here = !status;
    if (!status) status = evaluate_along(self, direction, step, to);
    for (int i = 0; i < self->width && !status; i++) to[i] = (to[i] - self->here[i]) / step;
    return status;
}

/* to <- to + weight (f(h) - f(-h)) for each of `orders` weights, to (orders, width) */
static int add_central(zd_residual_state *self, const zd_direction *direction, double h, int orders, const double *weight, double *to)
{
    double *plus = self->here, *minus = self->there;
    int status = evaluate_along(self, direction, h, plus);
    if (!status) status = evaluate_along(self, direction, -h, minus);
    for (int k = 0; k < orders && !status; k++)
        for (int i = 0; i < self->width; i++) to[k * self->width + i] += weight[k] * (plus[i] - minus[i]);
    return status;
}

static int difference_centrally(zd_residual_state *self, const zd_direction *direction, double step, double *to)
{
    const double h = CENTRAL_STEP * step;
    memset(to, 0, (size_t)self->width * sizeof *to);
    return add_central(self, direction, h, 1, &(double){1 / (2 * h)}, to);
}

static int sum_orders(zd_residual_state *self, const zd_direction *direction, double h)
{
    int status = ZD_DONE;
    memset(self->sums, 0, (size_t)(ORDERS * self->width) * sizeof *self->sums);
    for (int k = 0; k < POINTS && !status; k++) {
        double weight[ORDERS];
        for (int order = 0; order < ORDERS; order++) weight[order] = WEIGHT[order][k] / h;
        status = add_central(self, direction, (k + 1) * h, ORDERS, weight, self->sums);
    }
    return status;
}

/* Largest difference of the two higher orders; NaN if one of them is. */
static double largest_disagreement(const zd_residual_state *self)
{
    double largest = 0;
    for (int i = 0; i < self->width; i++) {
        const double apart = fabs(self->sums[i] - self->sums[self->width + i]);
        if (!(apart <= largest)) largest = apart;
        if (isnan(apart)) return apart;
    }
    return largest;
}

/* With shorter steps while the orders disagree, as they do near kinks and for functions that vary on a short scale; where none gives a
 * number, the difference of fourth order with the shortest stands, whose points are nearer. */
static int difference_accurately(zd_residual_state *self, const zd_direction *direction, double step, double *to)
{
    double error = INFINITY;
    const size_t bytes = (size_t)self->width * sizeof *to;
    for (int k = 0; k < STEPS; k++) {
        int status = sum_orders(self, direction, STEP[k] * step);
        if (status) return status;
        const double found = largest_disagreement(self), size = zd_max_abs(self->width, self->sums);
        if (found < error) {
            memcpy(to, self->sums, bytes);
            error = found;
        }
        if (found <= AGREE * size) break;
    }
    if (isinf(error)) memcpy(to, self->sums + 2 * self->width, bytes);
    return ZD_DONE;
}

int zd_residual_derivatives(zd_residual_state *self, const zd_direction *direction, double step, enum zd_accuracy accuracy, double *to)
{
    const zd_system *system = self->varied->system;
    if (system->residuals) {
        const zd_derivatives of = places(self, to);
        const zd_point *point = self->point;
        self->varied->statistics->evaluations++;
        const int status = system->residuals->evaluate(system->data, point->terms.inputs, point->t, point->p, point->v, self->vdot,
                                                       self->lambda, 1, direction, &of, self->scratch);
        if (!status) return ZD_DONE;
    }
    if (accuracy == ZD_FOR_ITERATIONS) return difference_once(self, direction, step, to);
    return accuracy == ZD_CENTRAL ? difference_centrally(self, direction, step, to) : difference_accurately(self, direction, step, to);
}
