/* q are k = nv - mh entries of p. The others follow from Phi(p) = 0 by Newton's iteration in the directions of the velocities,
 *
 *     [C_H] delta = [-Phi          ],        p <- p + A delta,
 *     [A_q]         [q - p at index]
 *
 * so that A need not be the identity. With unit quaternions, increments take the place of entries: increments.c. The iteration starts
 * from the prediction by the velocity of the point before, whose branch it stays on.
 */
#include "embedding.h"

#include <math.h>
#include <string.h>

#include "../constraints/rank.h"
#include "../linalg/dense.h"
#include "../linalg/iteration.h"
#include "../linalg/small.h"
#include "../point/point.h"

enum { MAX_ITERATIONS = 40 };     /* near a bifurcation convergence is linear, by halves, rather than quadratic */
static const double NEARLY = 64;      /* residual, units of rounding, that is accepted if it no longer halves */
static const double FARTHEST = 0.5;   /* displacement, characteristic scales: a longer prediction is not used as the first iterate */
static const double MAX_RESPONSE = 16;   /* derivative of p with respect to the system's own q: beyond, q is selected numerically */
static const double WORSE = 1.1;      /* growth of the derivative of p with respect to q after which q is selected anew */

zd_embedding zd_embedding_create(zd_arena *arena, const zd_system *system)
{
    size_t nq = system->nq, nv = system->nv, mh = system->mh, k = nv - mh;
    /* Entries of p can be selected only if nq is nv. K is formed again after q is selected. */
    double *choice = zd_arena_doubles(arena, nv * (nv + (size_t)zd_constraints(system)));
    return (zd_embedding){
        .nq = (int)nq,
        .nv = (int)nv,
        .mh = (int)mh,
        .k = (int)k,
        .embed = system->quaternions ? NULL : system->embed,
        .index = zd_arena_ints(arena, k),
        .increments = zd_increments_create(arena, system),
        .order = zd_arena_ints(arena, (mh + nq)),
        .memory = zd_create_dense(arena, system, (size_t)zd_constraints(system) * nv),
        .K = choice,
        .pivots = zd_arena_ints(arena, nv),
        .choice = choice,
        .delta = zd_arena_doubles(arena, nv),
        .p = zd_arena_doubles(arena, nq),
    };
}

double *zd_embedding_workspace(const zd_embedding *self)
{
    return self->K ? self->K + self->nv * self->nv : NULL;
}

/* ---- q ---- */

static int has_increments(const zd_embedding *self) { return self->increments.nq > 0; }

void zd_embedding_coordinates(const zd_embedding *self, const zd_point *point, double *q)
{
    for (int k = 0; k < self->k; k++)
        q[k] = has_increments(self) ? zd_increments_value(&self->increments, point, point->p, self->index[k]) : point->p[self->index[k]];
}

void zd_embedding_rates(const zd_embedding *self, const double *pdot, double *qdot)
{
    for (int k = 0; k < self->k; k++)
        qdot[k] = has_increments(self) ? zd_increments_rate(&self->increments, pdot, self->index[k]) : pdot[self->index[k]];
}

/* row (nv,) of A_q: qdot_k = row . v */
static void fill_row(const zd_embedding *self, const zd_point *point, int k, double *row)
{
    if (has_increments(self)) zd_increments_row(&self->increments, point, self->index[k], row);
    else
        for (int j = 0; j < self->nv; j++) row[j] = zd_entry_of_A(point, self->index[k], j);
}

/* 1 / characteristic scale of q_k */
static double inverse_unit(const zd_embedding *self, const zd_point *point, int k)
{
    return has_increments(self) ? point->inverse_unit[self->index[k]] : point->inverse_unit_p[self->index[k]];
}

/* Error of q_k at the point: of an entry of p, which must be equal, 0 or 2 NEARLY; of an increment, in units of its rounding. */
static double mismatch(const zd_embedding *self, const zd_point *point, const double *q, int k)
{
    const int i = self->index[k];
    if (!has_increments(self)) return point->p[i] == q[k] ? 0 : 2 * NEARLY;
    return fabs(zd_increments_value(&self->increments, point, point->p, i) - q[k]) / self->increments.rounding[i];
}

/* Evaluates C and A at the point, and checks that C_H has as many independent constraints as q was selected for. */
static int need_rows(zd_embedding *self, zd_point *point)
{
    int status = zd_point_need(point, ZD_C | ZD_A);
    if (status || !self->mh) return status;
    status = zd_find_independent(point);
    if (!status) self->C = zd_dense_C(point, self->memory);
    return !status && point->holonomic != self->mh ? ZD_BIFURCATION : status;
}

/* Factors [C_H; A_q] at the point, and finds the rounding of Phi there, relative to its size. Phi is a sum of terms of at least one
 * characteristic scale, even if all of p is zero. */
static int factor(zd_embedding *self, zd_point *point)
{
    int nv = self->nv;
    int status = need_rows(self, point);
    if (status) return status;
    double gradient = 0;
    for (int k = 0; k < self->mh; k++) {
        double sum = 0;
        for (int j = 0; j < nv; j++) sum += fabs(self->K[k * nv + j] = self->C[k * nv + j]) * point->unit[j];
        gradient = fmax(gradient, sum * point->inverse_size[zd_independent_constraint(point, k)]);
    }
    for (int k = 0; k < self->k; k++) fill_row(self, point, k, self->K + (self->mh + k) * nv);
    self->rounding = 16 * 0x1p-52 * gradient * fmax(1, zd_max_scaled(self->nq, point->p, point->inverse_unit_p));
    point->failed_index = zd_lu_factor(nv, self->K, self->pivots);
    return point->failed_index < nv ? ZD_SINGULAR : ZD_DONE;
}

/* ---- Newton's iteration ---- */

typedef struct problem {
    zd_embedding *self;
    zd_point *point;
    const double *q;
} problem;

/* Smallest significant |Phi|: at a bifurcation, Phi of a lost constraint is of second order in the directions that the others leave
 * free. */
static int find_resolution(const zd_embedding *self, zd_point *point, double *resolution)
{
    *resolution = self->rounding;
    if (!point->rank->was_doubtful) return ZD_DONE;
    int status = zd_find_independent(point);
    if (!status && point->rank->lost) *resolution = fmax(self->rounding, ZD_RANK_TOLERANCE * ZD_RANK_TOLERANCE);
    return status;
}

/* size <- largest |Phi| of the constraints that the iteration solves, relative to the smallest significant one. Redundant constraints
 * must only be below the tolerance with which they were found redundant: their gradients may be so small that rounding is large relative
 * to them. */
static int find_violation(const zd_embedding *self, zd_point *point, double *size)
{
    double resolution = 0, Phi = self->mh ? zd_point_violation(point) : 0, others = 0;
    int status = find_resolution(self, point, &resolution);
    if (!status && point->system->mh > self->mh) {
        status = zd_find_independent(point);
        others = Phi;
        Phi = 0;
        for (int k = 0; k < self->mh; k++) {
            const int row = zd_independent_constraint(point, k);
            Phi = fmax(Phi, fabs(point->terms.Phi[row]) * point->inverse_size[row]);
        }
    }
    *size = fmax(Phi > 0 ? Phi / resolution : 0, others > ZD_RANK_TOLERANCE ? NEARLY * others / ZD_RANK_TOLERANCE : 0);
    return status;
}

/* Residual: the largest of |Phi|, in units of rounding, and of the errors of q. */
static int residual(void *context, double *size)
{
    problem *it = context;
    zd_point *point = it->point;
    int status = zd_point_need(point, ZD_PHI | ZD_C | ZD_A);   /* C and A for the next iterate, or else for (14) */
    if (!status) status = find_violation(it->self, point, size);
    if (status) return status;
    for (int k = 0; k < it->self->k; k++) *size = fmax(*size, mismatch(it->self, point, it->q, k));
    return ZD_DONE;
}

static int improve(void *context)
{
    problem *it = context;
    zd_embedding *self = it->self;
    zd_point *point = it->point;
    int status = factor(self, point);
    if (status) return status;
    for (int k = 0; k < self->mh; k++)
        self->delta[k] = k < self->mh - point->rank->lost ? -point->terms.Phi[zd_independent_constraint(point, k)] : 0;
    zd_embedding_coordinates(self, point, self->delta + self->mh);
    for (int k = 0; k < self->k; k++) self->delta[self->mh + k] = it->q[k] - self->delta[self->mh + k];
    zd_lu_solve(self->nv, self->K, self->pivots, self->delta);
    zd_point_rate(point, self->delta, self->p);
    for (int i = 0; i < self->nq; i++) self->p[i] += point->p[i];
    for (int k = 0; k < self->k && !has_increments(self); k++) self->p[self->index[k]] = it->q[k];
    zd_quaternions_normalise(point->system, self->p);
    zd_point_move(point, point->t, self->p, point->v);
    return ZD_DONE;
}

static int place_numerically(zd_embedding *self, zd_point *point, double t, const double *q)
{
    static const zd_newton newton = {residual, improve, 1, MAX_ITERATIONS, 0, NULL, NEARLY};
    problem it = {self, point, q};
    int iterations;
    double left;
    zd_quaternions_normalise(point->system, self->p);
    zd_point_move(point, t, self->p, point->v);
    int status = zd_newton_solve(&newton, &it, &iterations, &left);
    point->statistics->embedding_iterations += iterations;
    point->residual_left = left * self->rounding;
    return status == ZD_NO_CONVERGENCE ? ZD_NO_EMBEDDING : status;
}

static int place_by_increments(zd_embedding *self, zd_point *point, double t, const double *q)
{
    int status = place_numerically(self, point, t, q);
    if (status || zd_increments_are_within_reach(&self->increments, point->system, point->p)) return status;
    return ZD_NO_EMBEDDING;
}

/* self->p <- prediction of p by the point's velocity, which distinguishes the branches near a bifurcation; or if that is too far, the
 * point's p. */
static void predict(zd_embedding *self, zd_point *point, double t)
{
    double h = t - point->t;
    if (point->terms.A && !(point->known & ZD_A)) h = 0;
    else zd_point_rate(point, point->v, self->p);
    int far = h == 0 || !(fabs(h) * zd_max_scaled(self->nq, self->p, point->inverse_unit_p) <= FARTHEST);
    for (int i = 0; i < self->nq; i++) self->p[i] = far ? point->p[i] : point->p[i] + h * self->p[i];
}

/* Abandons the system's own g, whose q does not determine p everywhere: not at a turning point of a crank, and with few digits near a
 * bifurcation. */
static void give_up_own(zd_embedding *self)
{
    self->embed = NULL;
    self->chosen = 0;
}

int zd_embedding_place(zd_embedding *self, zd_point *point, double t, const double *q)
{
    const zd_system *system = point->system;
    if (self->k == self->nq) {                                          /* no constraint on p: q is all of it */
        for (int k = 0; k < self->k; k++) self->p[self->index[k]] = q[k];
        zd_point_move(point, t, self->p, point->v);
        return ZD_DONE;
    }
    predict(self, point, t);
    if (self->embed && point->rank->was_ill_conditioned) give_up_own(self);
    if (has_increments(self)) return place_by_increments(self, point, t, q);
    if (!self->embed) return place_numerically(self, point, t, q);
    int status = self->embed(system->data, t, q, self->p);            /* (18) */
    if (status) give_up_own(self);
    else zd_point_move(point, t, self->p, point->v);
    return status;
}

/* Velocities (nv,) at unit rate of q_k */
static const double *tangent_of(zd_embedding *self, int k)
{
    zd_clear(self->nv, self->delta);
    self->delta[self->mh + k] = 1;
    zd_lu_solve(self->nv, self->K, self->pivots, self->delta);
    return self->delta;
}

int zd_embedding_tangents(zd_embedding *self, zd_point *point, int width, double *T)
{
    int status = factor(self, point);
    if (status) return status;
    for (int k = 0; k < self->k; k++) zd_point_rate(point, tangent_of(self, k), T + k * width);     /* (18): Phi_p dp = 0 */
    return ZD_DONE;
}

/* ---- selection of q ---- */

/* Largest derivative of the velocities with respect to qdot, characteristic scales: unbounded where q ceases to determine p. */
static double response(zd_embedding *self, const zd_point *point)
{
    double largest = 0;
    for (int k = 0; k < self->k; k++)
        largest = fmax(largest, zd_max_scaled(self->nv, tangent_of(self, k), point->inverse_unit) / inverse_unit(self, point, k));
    return largest;
}

/* Selects velocities that C_H leaves independent, by pivoting in characteristic scales: their increments are q. */
static int choose_increments(zd_embedding *self, zd_point *point)
{
    int nv = self->nv, mh = self->mh;
    for (int i = 0; i < mh; i++)
        for (int j = 0; j < nv; j++)
            self->choice[i * nv + j] = self->C[i * nv + j] * point->unit[j] * point->inverse_size[zd_independent_constraint(point, i)];
    point->failed_index = zd_choose_columns(mh, nv, 0, self->choice, self->order);
    if (point->failed_index < mh) return ZD_DEPENDENT_ROWS;
    for (int k = 0; k < self->k; k++) self->index[k] = self->order[mh + k];
    return ZD_DONE;
}

/* Selects rows of A that complete those of C_H to a regular matrix, by pivoting in characteristic scales. */
static int choose(zd_embedding *self, zd_point *point)
{
    int nv = self->nv, mh = self->mh, columns = mh + self->nq;
    for (int j = 0; j < nv; j++)
        for (int i = 0; i < columns; i++)
            self->choice[j * columns + i] = point->unit[j] * (
                i < mh ? self->C[i * nv + j] * point->inverse_size[zd_independent_constraint(point, i)]
                       : zd_entry_of_A(point, i - mh, j) * point->inverse_unit_p[i - mh]);
    point->failed_index = zd_choose_columns(nv, columns, mh, self->choice, self->order);
    if (point->failed_index < nv) return ZD_DEPENDENT_ROWS;
    for (int k = 0; k < self->k; k++) self->index[k] = self->order[mh + k] - mh;
    return ZD_DONE;
}

static int choose_anew(zd_embedding *self, zd_point *point, int *changed)
{
    const zd_system *system = point->system;
    int status = need_rows(self, point);
    if (status) return status;
    if (self->embed && system->independent) memcpy(self->index, system->independent, self->k * sizeof(int));
    else status = has_increments(self) ? choose_increments(self, point) : choose(self, point);
    const int was_chosen = self->chosen;
    self->chosen = 0;       /* K is lost */
    if (!status) status = factor(self, point);
    if (status) return status;
    if (was_chosen) point->statistics->repartitions++;
    self->reference = response(self, point);
    self->chosen = *changed = 1;
    return ZD_DONE;
}

/* Increments always get a new base. */
static int review_increments(zd_embedding *self, zd_point *point, int *changed)
{
    int status = zd_increments_begin(&self->increments, point);
    if (status) return status;
    if (self->chosen && self->mh) status = factor(self, point);
    if (status && status != ZD_SINGULAR) return status;
    int serves = self->chosen && !status && (!self->mh || response(self, point) <= WORSE * self->reference);
    return serves ? ZD_DONE : choose_anew(self, point, changed);
}

int zd_embedding_review(zd_embedding *self, zd_point *point, int *changed)
{
    *changed = 0;
    if (has_increments(self)) return review_increments(self, point, changed);
    int status = self->chosen && self->embed && self->mh ? factor(self, point) : ZD_DONE;
    if (status && status != ZD_SINGULAR) return status;
    if (self->chosen && self->embed && self->mh && (status || point->rank->was_ill_conditioned || !(response(self, point) <= MAX_RESPONSE)))
        give_up_own(self);
    if (self->chosen && (self->embed || !self->mh || response(self, point) <= WORSE * self->reference)) return ZD_DONE;
    return choose_anew(self, point, changed);
}

double zd_embedding_steepest(const zd_embedding *self)
{
    if (!self->chosen) return 0;
    return !self->mh ? INFINITY : self->embed ? MAX_RESPONSE : WORSE * self->reference;
}
