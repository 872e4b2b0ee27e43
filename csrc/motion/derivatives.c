#include "derivatives.h"

#include <math.h>
#include <string.h>

#include "../linalg/small.h"
#include "../point/point.h"

enum { POINTS = 4, ORDERS = 3, STEPS = 5 };
/* Weights of f(k h) - f(-k h), k = 1 ... 4, over h: of eighth, sixth and fourth order */
static const double WEIGHT[ORDERS][POINTS] = {
    {4. / 5, -1. / 5, 4. / 105, -1. / 280}, {3. / 4, -3. / 20, 1. / 60, 0}, {2. / 3, -1. / 12, 0, 0}};
static const double STEP[STEPS] = {2e-2, 2e-3, 5e-4, 2e-5, 1e-6};      /* characteristic scales: a shorter one where the orders disagree */
static const double CENTRAL_STEP = 1e-4;
static const double AGREE = 1e-10;      /* difference of the orders relative to the derivative that is accepted */

zd_residual_state zd_residual_state_create(zd_arena *arena, const zd_system *system, zd_statistics *statistics, enum zd_accuracy accuracy)
{
    const size_t width = system->nq + system->nv + 2 * zd_constraints(system) + 1;
    return (zd_residual_state){
        .varied = zd_point_create(arena, system, statistics),
        .here = zd_arena_doubles(arena, width),
        .there = zd_arena_doubles(arena, width),
        .x = zd_arena_doubles(arena, system->nq + system->nv),
        .sums = accuracy == ZD_ACCURATE ? zd_arena_doubles(arena, ORDERS * width) : NULL,
        .scratch = system->residuals ? zd_arena_doubles(arena, system->residuals->scratch) : NULL,
    };
}

/* Terms that the requested parts need besides A */
static int find_needs(const zd_residual_state *self)
{
    const int parts = self->parts, uses_C = ZD_RESIDUAL_R | ZD_RESIDUAL_S | ZD_RESIDUAL_PSI;
    return (parts & ZD_RESIDUAL_R ? ZD_BIAS | ZD_FORCE | (self->moves ? ZD_M : 0) : 0) | (parts & ZD_RESIDUAL_S ? ZD_XI : 0)
           | (parts & uses_C ? ZD_C : 0) | (parts & (ZD_RESIDUAL_PSI | ZD_RESIDUAL_POWER) ? ZD_PHI_T : 0)
           | (parts & ZD_RESIDUAL_POWER ? ZD_POWER : 0);
}

void zd_residual_state_begin(zd_residual_state *self, int parts, zd_point *point, const double *vdot, const double *lambda)
{
    const zd_system *system = self->varied->system;
    const int m = zd_constraints(system);
    self->parts = parts;
    self->s_at = parts & ZD_RESIDUAL_R ? system->nv : 0;
    self->Psi_at = self->s_at + (parts & ZD_RESIDUAL_S ? m : 0);
    self->pdot_at = self->Psi_at + (parts & ZD_RESIDUAL_PSI ? m : 0);
    self->power_at = self->pdot_at + (parts & ZD_RESIDUAL_PDOT ? system->nq : 0);
    self->width = self->power_at + (parts & ZD_RESIDUAL_POWER ? 1 : 0);
    self->point = point, self->vdot = vdot, self->lambda = lambda;
    self->moves = vdot && zd_max_abs(system->nv, vdot) != 0;
    self->needs = find_needs(self);
    self->knows_here = 0;
    self->varied->known &= self->varied->constant;      /* inputs may have been set */
    self->varied->terms.inputs = point->terms.inputs;
}

/* ---- residuals ---- */

/* r (n,) <- M vdot - force + C^T lambda of dense matrices; vdot NULL: 0 */
ZD_INLINE void write_dense_dynamics(const int n, const int m, const zd_terms *terms, const double *vdot, const double *lambda,
                                    const double *force, double *r)
{
    for (int i = 0; i < n; i++) r[i] = (vdot ? zd_dot(n, terms->M + i * n, vdot) : 0) - force[i];
    for (int k = 0; k < m; k++) zd_add_scaled(n, r, lambda[k], terms->C + k * n);
}

static void write_dynamics(const zd_residual_state *self, const zd_point *point, double *r)
{
    const int n = point->system->nv, m = zd_constraints(point->system);
    zd_point_force(point, point->force);
    if (!point->layout) {
        ZD_SIZED(write_dense_dynamics, n, m, &point->terms, self->moves ? self->vdot : NULL, self->lambda, point->force, r);
        return;
    }
    if (self->moves) zd_times_M(point, point->terms.M, self->vdot, r);
    else zd_clear(n, r);
    for (int i = 0; i < n; i++) r[i] -= point->force[i];
    for (int k = 0; k < m; k++) {
        const zd_row_of_C row = zd_point_row(point, k);
        for (int j = 0; j < row.count; j++) r[zd_column(&row, j)] += self->lambda[k] * row.x[j];
    }
}

/* y (m,) <- C x of a dense C */
ZD_INLINE void multiply_dense(const int n, const int m, const double *C, const double *x, double *y)
{
    for (int k = 0; k < m; k++) y[k] = zd_dot(n, C + k * n, x);
}

/* y (m,) <- C x; x NULL: 0 */
static void multiply_by_C(const zd_point *point, const double *x, double *y)
{
    const int n = point->system->nv, m = zd_constraints(point->system);
    if (x && !point->layout) {
        ZD_SIZED(multiply_dense, n, m, point->terms.C, x, y);
        return;
    }
    for (int k = 0; k < m; k++) {
        const zd_row_of_C row = x ? zd_point_row(point, k) : (zd_row_of_C){0};
        y[k] = x ? zd_row_times(&row, x) : 0;
    }
}

static void write_accelerations(const zd_residual_state *self, const zd_point *point, double *s)
{
    multiply_by_C(point, self->moves ? self->vdot : NULL, s);
    for (int k = 0; point->terms.xi && k < zd_constraints(point->system); k++) s[k] -= point->terms.xi[k];
}

static void write_velocities(const zd_point *point, double *Psi)
{
    multiply_by_C(point, point->v, Psi);
    for (int k = 0; point->terms.Phi_t && k < zd_constraints(point->system); k++) Psi[k] += point->terms.Phi_t[k];
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
    const int parts = self->parts, needs_A = parts & ZD_RESIDUAL_PDOT;
    int status = needs_A ? zd_point_need_times_A(point, self->needs) : zd_point_need(point, self->needs);
    if (status) return status;
    if (parts & ZD_RESIDUAL_R) write_dynamics(self, point, to);
    if (parts & ZD_RESIDUAL_S) write_accelerations(self, point, to + self->s_at);
    if (parts & ZD_RESIDUAL_PSI) write_velocities(point, to + self->Psi_at);
    if (needs_A) zd_point_rate(point, point->v, to + self->pdot_at);
    if (parts & ZD_RESIDUAL_POWER) to[self->power_at] = power_of(point, self->lambda);
    return ZD_DONE;
}

/* The same at distance h along a direction */
static int evaluate_along(zd_residual_state *self, const zd_direction *direction, double h, double *to)
{
    const zd_point *from = self->point;
    const int nq = from->system->nq, nv = from->system->nv;
    double *p = self->x, *v = p + nq;
    zd_copy_all(nq, from->p, p);
    zd_copy_all(nv, from->v, v);
    if (direction->p) ZD_SIZED(zd_add_scaled, nq, p, h, direction->p);
    if (direction->v) ZD_SIZED(zd_add_scaled, nv, v, h, direction->v);
    zd_point_move(self->varied, from->t + h * direction->t, p, v);
    return evaluate(self, self->varied, to);
}

/* ---- differences ---- */

static int difference_once(zd_residual_state *self, const zd_direction *direction, double step, double *to)
{
    int status = self->knows_here ? ZD_DONE : evaluate(self, self->point, self->here);
    self->knows_here = !status;
    if (!status) status = evaluate_along(self, direction, step, to);
    const double inverse = 1 / step;
    for (int i = 0; i < self->width && !status; i++) to[i] = (to[i] - self->here[i]) * inverse;
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
    zd_clear(self->width, to);
    return add_central(self, direction, h, 1, &(double){1 / (2 * h)}, to);
}

static int sum_orders(zd_residual_state *self, const zd_direction *direction, double h)
{
    int status = ZD_DONE;
    zd_clear(ORDERS * self->width, self->sums);
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
    const size_t bytes = self->width * sizeof *to;
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

/* The system's own; nonzero: not available there */
static int evaluate_own(const zd_residual_state *self, const zd_direction *direction, double *to)
{
    const zd_system *system = self->varied->system;
    const zd_point *point = self->point;
    const int parts = self->parts;
    const zd_derivatives of = {
        .dynamics = parts & ZD_RESIDUAL_R ? to : NULL,
        .accelerations = parts & ZD_RESIDUAL_S ? to + self->s_at : NULL,
        .velocities = parts & ZD_RESIDUAL_PSI ? to + self->Psi_at : NULL,
        .rates = parts & ZD_RESIDUAL_PDOT ? to + self->pdot_at : NULL,
        .power = parts & ZD_RESIDUAL_POWER ? to + self->power_at : NULL,
    };
    self->varied->statistics->evaluations++;
    return system->residuals->evaluate(system->data, point->terms.inputs, point->t, point->p, point->v, self->vdot, self->lambda, 1,
                                       direction, &of, self->scratch);
}

int zd_residual_derivatives(zd_residual_state *self, const zd_direction *direction, double step, enum zd_accuracy accuracy, double *to)
{
    if (self->varied->system->residuals && !evaluate_own(self, direction, to)) return ZD_DONE;
    if (accuracy == ZD_FOR_ITERATIONS) return difference_once(self, direction, step, to);
    return accuracy == ZD_CENTRAL ? difference_centrally(self, direction, step, to) : difference_accurately(self, direction, step, to);
}
