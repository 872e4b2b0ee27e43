/* q are k = nv - mh entries of p. The others follow from Phi(p) = 0 by Newton's iteration in the velocities' directions,
 *
 *     [C_H] delta = [-Phi          ],        p <- p + A delta,
 *     [A_q]         [q - p at index]
 *
 * so that A need not be the identity. Where there are unit quaternions, increments take the place of entries: increments.c. The iteration
 * starts from where the velocity of the point before leads, whose branch it stays on.
 */
#include "embedding.h"

#include <math.h>
#include <string.h>

#include "../constraints/rows.h"
#include "../linalg/lu.h"
#include "../linalg/newton.h"
#include "../linalg/norms.h"
#include "../point/matrices.h"
#include "../point/quaternions.h"
#include "../point/units.h"

enum { MAX_ITERATIONS = 40 };     /* near a bifurcation they halve the distance, rather than square it */
static const double NEARLY = 64;      /* units of rounding: a residual of so many that no longer halves is all that there can be */
static const double FARTHEST = 0.5;   /* in natural units: a longer prediction is not used as the first iterate */
static const double MOST_RESPONSE = 16;   /* of p to the q of the system's own embedding: with more, q is chosen numerically */
static const double WORSE = 1.1;      /* q is chosen anew when the response of p to it has grown by more than this factor */

zd_embedding zd_embedding_take(zd_arena *arena, const zd_system *system)
{
    size_t nq = (size_t)system->nq, nv = (size_t)system->nv, mh = (size_t)system->mh, k = nv - mh;
    /* Entries of p are only chosen where nq is nv. K is made anew once q is chosen. */
    double *choice = zd_take_doubles(arena, nv * (nv + (size_t)zd_constraints(system)));
    return (zd_embedding){
        .nq = (int)nq,
        .nv = (int)nv,
        .mh = (int)mh,
        .k = (int)k,
        .embed = system->quaternions ? NULL : system->embed,
        .index = zd_take(arena, k * sizeof(int)),
        .increments = zd_increments_take(arena, system),
        .order = zd_take(arena, (mh + nq) * sizeof(int)),
        .memory = zd_take_dense(arena, system, (size_t)zd_constraints(system) * nv),
        .K = choice,
        .pivots = zd_take(arena, nv * sizeof(int)),
        .choice = choice,
        .delta = zd_take_doubles(arena, nv),
        .p = zd_take_doubles(arena, nq),
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

/* 1 / the natural size of q_k */
static double inverse_unit(const zd_embedding *self, const zd_point *point, int k)
{
    return has_increments(self) ? point->inverse_unit[self->index[k]] : point->inverse_unit_p[self->index[k]];
}

/* By how much q_k is off at the point: an entry of p by nothing or too much, an increment in units of its rounding. */
static double mismatch(const zd_embedding *self, const zd_point *point, const double *q, int k)
{
    const int i = self->index[k];
    if (!has_increments(self)) return point->p[i] == q[k] ? 0 : 2 * NEARLY;
    return fabs(zd_increments_value(&self->increments, point, point->p, i) - q[k]) / self->increments.rounding[i];
}

/* C and A at the point, where as many rows of C_H have to count as q was made for. */
static int need_rows(zd_embedding *self, zd_point *point)
{
    int status = zd_point_need(point, ZD_C | ZD_A);
    if (status || !self->mh) return status;
    status = zd_rows_find(point);
    if (!status) self->C = zd_dense_C(point, self->memory);
    return !status && point->holonomic != self->mh ? ZD_BIFURCATION : status;
}

/* [C_H; A_q] at the point, factored; and what rounding makes of Phi there, in units of its size. Phi is a sum of terms that may be as
 * large as one natural unit makes them, even where all of p is zero. */
static int factor(zd_embedding *self, zd_point *point)
{
    int nv = self->nv;
    int status = need_rows(self, point);
    if (status) return status;
    double gradient = 0;
    for (int k = 0; k < self->mh; k++) {
        double sum = 0;
        for (int j = 0; j < nv; j++) sum += fabs(self->K[k * nv + j] = self->C[k * nv + j]) * point->unit[j];
        gradient = fmax(gradient, sum * point->inverse_size[zd_rank_row(point, k)]);
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

/* What cannot be told from zero: where a row is lost, Phi is of second order in what the others leave open. */
static int find_resolution(const zd_embedding *self, zd_point *point, double *resolution)
{
    *resolution = self->rounding;
    if (!point->rank->was_doubtful) return ZD_DONE;
    int status = zd_rows_find(point);
    if (!status && point->rank->lost) *resolution = fmax(self->rounding, ZD_RANK_TOLERANCE * ZD_RANK_TOLERANCE);
    return status;
}

/* size <- the largest |Phi| of the rows that the iteration solves, over what cannot be told from zero. Rows that follow from these need only
 * be below the tolerance by which they were found to follow: their gradients may be so small that rounding is large beside them. */
static int find_violation(const zd_embedding *self, zd_point *point, double *size)
{
    double resolution = 0, Phi = self->mh ? zd_point_violation(point) : 0, others = 0;
    int status = find_resolution(self, point, &resolution);
    if (!status && point->system->mh > self->mh) {
        status = zd_rows_find(point);
        others = Phi;
        Phi = 0;
        for (int k = 0; k < self->mh; k++) {
            const int row = zd_rank_row(point, k);
            Phi = fmax(Phi, fabs(point->terms.Phi[row]) * point->inverse_size[row]);
        }
    }
    *size = fmax(Phi > 0 ? Phi / resolution : 0, others > ZD_RANK_TOLERANCE ? NEARLY * others / ZD_RANK_TOLERANCE : 0);
    return status;
}

/* In units of rounding; too many as long as q is not what it should be. */
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
    for (int k = 0; k < self->mh; k++) self->delta[k] = k < self->mh - point->rank->lost ? -point->terms.Phi[zd_rank_row(point, k)] : 0;
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

/* self->p <- where the point's velocity leads: near a bifurcation that is what tells one branch from another. Where that is too far to
 * be an estimate, where the point is. */
static void predict(zd_embedding *self, zd_point *point, double t)
{
    double h = t - point->t;
    if (point->terms.A && !(point->known & ZD_A)) h = 0;
    else zd_point_rate(point, point->v, self->p);
    int far = h == 0 || !(fabs(h) * zd_max_scaled(self->nq, self->p, point->inverse_unit_p) <= FARTHEST);
    for (int i = 0; i < self->nq; i++) self->p[i] = far ? point->p[i] : point->p[i] + h * self->p[i];
}

/* The system's own g has its own q, which does not determine p everywhere: where a crank turns back it does not, and near a bifurcation
 * not with all digits. */
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

int zd_embedding_tangents(zd_embedding *self, zd_point *point, int width, double *T)
{
    int status = factor(self, point);
    if (status) return status;
    for (int k = 0; k < self->k; k++) {
        memset(self->delta, 0, (size_t)self->nv * sizeof(double));
        self->delta[self->mh + k] = 1;
        zd_lu_solve(self->nv, self->K, self->pivots, self->delta);
        zd_point_rate(point, self->delta, T + k * width);       /* (18): Phi_p dp = 0 */
    }
    return ZD_DONE;
}

/* ---- the choice of q ---- */

/* Largest entry of the response of the velocities to the rates of q, in natural units: grows beyond bounds where q ceases to
 * determine p. */
static double response(zd_embedding *self, const zd_point *point)
{
    double largest = 0;
    for (int k = 0; k < self->k; k++) {
        memset(self->delta, 0, (size_t)self->nv * sizeof(double));
        self->delta[self->mh + k] = 1;
        zd_lu_solve(self->nv, self->K, self->pivots, self->delta);
        largest = fmax(largest, zd_max_scaled(self->nv, self->delta, point->inverse_unit) / inverse_unit(self, point, k));
    }
    return largest;
}

/* Velocities that C_H leaves independent, by pivoting in natural units: their increments are q. */
static int choose_increments(zd_embedding *self, zd_point *point)
{
    int nv = self->nv, mh = self->mh;
    for (int i = 0; i < mh; i++)
        for (int j = 0; j < nv; j++)
            self->choice[i * nv + j] = self->C[i * nv + j] * point->unit[j] * point->inverse_size[zd_rank_row(point, i)];
    point->failed_index = zd_choose_columns(mh, nv, 0, self->choice, self->order);
    if (point->failed_index < mh) return ZD_DEPENDENT_ROWS;
    for (int k = 0; k < self->k; k++) self->index[k] = self->order[mh + k];
    return ZD_DONE;
}

/* Rows of A that complete those of C_H, by pivoting in natural units. */
static int choose(zd_embedding *self, zd_point *point)
{
    int nv = self->nv, mh = self->mh, columns = mh + self->nq;
    for (int j = 0; j < nv; j++)
        for (int i = 0; i < columns; i++)
            self->choice[j * columns + i] = point->unit[j] * (i < mh ? self->C[i * nv + j] * point->inverse_size[zd_rank_row(point, i)]
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
    if (self->embed && system->independent) memcpy(self->index, system->independent, (size_t)self->k * sizeof(int));
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

/* Increments begin anew in any case. */
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
    if (self->chosen && self->embed && self->mh && (status || point->rank->was_ill_conditioned || !(response(self, point) <= MOST_RESPONSE)))
        give_up_own(self);
    if (self->chosen && (self->embed || !self->mh || response(self, point) <= WORSE * self->reference)) return ZD_DONE;
    return choose_anew(self, point, changed);
}

double zd_embedding_steepest(const zd_embedding *self)
{
    if (!self->chosen) return 0;
    return !self->mh ? INFINITY : self->embed ? MOST_RESPONSE : WORSE * self->reference;
}
