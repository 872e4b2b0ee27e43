#include "partition.h"

#include <math.h>

#include "../../linalg/iteration.h"
#include "../../linalg/small.h"
#include "../../point/point.h"

enum { MAX_ITERATIONS = 40 };
static const double NEARLY = 64;        /* residual, units of rounding, that is accepted if it no longer halves */
static const double FARTHEST = 0.5;     /* displacement, characteristic scales: a longer prediction is not used as the first iterate */

zd_partition_sparse *zd_partition_sparse_create(zd_arena *arena, const zd_system *system)
{
    if (!zd_rank_is_of_many(system)) return NULL;
    int rows = 0, size = system->nv - zd_constraints(system), k = system->nv - system->mh;
    for (int g = 0; g < system->structure->groups; g++) rows += system->structure->rows[g];
    zd_partition *of_v = zd_partition_create(arena, system->nv, rows, size);
    zd_partition_sparse self = {
        .structured = zd_structured_create(arena, system),
        .of_v = of_v,
        .of_p = system->mn ? zd_partition_create(arena, system->nv, rows, k) : of_v,
        .size = size,
        .k = k,
        .u = zd_arena_doubles(arena, system->nv),
        .rhs = zd_arena_doubles(arena, rows),
        .x = zd_arena_doubles(arena, system->nv),
        .p = zd_arena_doubles(arena, system->nq),
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

/* ---- v = D u ---- */

/* Partition of all constraints at the point. */
static int need_speeds(zd_partition_sparse *self, zd_point *point)
{
    int status = zd_point_need(point, ZD_C | ZD_PHI_T);
    const int begins = !status && !self->of_v->bodies;
    return begins ? zd_partition_begin(self->of_v, point->rank->store, point, zd_constraints(point->system)) : status;
}

/* Flags v = D u as ill-conditioned if a pivot is small: see state/variables.c. */
static void note_condition(const zd_partition *of, const zd_point *point)
{
    point->rank->was_ill_conditioned |= !(of->share > ZD_ILL_CONDITIONED * ZD_ILL_CONDITIONED);
}

int zd_partition_sparse_update(zd_partition_sparse *self, zd_point *point)
{
    int status = need_speeds(self, point);
    if (!status && !(point->known & ZD_COMPLEMENTED)) status = zd_partition_factor(self->of_v, point);
    if (!status || status == ZD_SINGULAR) note_condition(self->of_v, point);
    if (status) return status;
    point->known |= ZD_COMPLEMENTED;
    const double *Phi_t = point->terms.Phi_t;
    zd_clear(point->system->nv, self->x);
    for (int j = 0; j < self->size; j++) self->x[self->of_v->index[j]] = self->u[j];
    for (int k = 0; k < zd_constraints(point->system); k++) self->rhs[k] = Phi_t ? -Phi_t[k] : 0;
    status = zd_partition_solve(self->of_v, self->rhs, self->x);        /* (14) */
    if (!status) zd_point_move_velocity(point, self->x);
    return status;
}

void zd_partition_sparse_express_speeds(zd_partition_sparse *self, const zd_point *point, double *u)
{
    zd_partition_sparse_pick_speeds(self, point->v, self->u);
    zd_copy_all(self->size, self->u, u);
}

int zd_partition_sparse_speeds(zd_partition_sparse *self, zd_point *point, double *u)
{
    int status = need_speeds(self, point);
    if (!status) status = zd_partition_review(self->of_v, point, point->known & ZD_COMPLEMENTED);
    if (status) return status;
    point->known |= ZD_COMPLEMENTED;
    zd_partition_sparse_express_speeds(self, point, u);
    return ZD_DONE;
}

static void pick(const zd_partition *of, const double *x, double *to)
{
    for (int j = 0; j < of->independents; j++) to[j] = x[of->index[j]];
}

void zd_partition_sparse_pick_speeds(const zd_partition_sparse *self, const double *x, double *of_u) { pick(self->of_v, x, of_u); }
void zd_partition_sparse_pick_coordinates(const zd_partition_sparse *self, const double *x, double *of_q) { pick(self->of_p, x, of_q); }

/* ---- p = g(q) ---- */

static int need_coordinates(zd_partition_sparse *self, zd_point *point)
{
    int status = need_speeds(self, point);
    const int begins = !status && !self->of_p->bodies;
    return begins ? zd_partition_begin(self->of_p, point->rank->store, point, point->system->mh) : status;
}

int zd_partition_sparse_coordinates(zd_partition_sparse *self, zd_point *point, double *q)
{
    int status = need_coordinates(self, point);
    const int is_same = self->of_p == self->of_v;
    if (!status) status = zd_partition_review(self->of_p, point, is_same && (point->known & ZD_COMPLEMENTED));
    if (status) return status;
    if (is_same) point->known |= ZD_COMPLEMENTED;
    zd_partition_sparse_pick_coordinates(self, point->p, q);
    return ZD_DONE;
}

/* Rounding of Phi, relative to its size: a sum of terms of at least one characteristic scale. */
static double rounding_of(const zd_point *point)
{
    double gradient = 0;
    for (int k = 0; k < point->system->mh; k++) {
        const zd_row_of_C row = zd_point_row(point, k);
        double sum = 0;
        for (int j = 0; j < row.count; j++) sum += fabs(row.x[j]) * point->unit[row.column[j]];
        gradient = fmax(gradient, sum * point->inverse_size[k]);
    }
    return 16 * 0x1p-52 * gradient * fmax(1, zd_max_scaled(point->system->nq, point->p, point->inverse_unit_p));
}

typedef struct problem {
    zd_partition_sparse *self;
    zd_point *point;
} problem;

static int residual(void *context, double *size)
{
    const problem *it = context;
    int status = zd_point_need(it->point, ZD_PHI | ZD_C);       /* C for the next iterate, or for (14) */
    if (status) return status;
    if (!(it->self->rounding > 0)) it->self->rounding = rounding_of(it->point);
    *size = it->point->system->mh ? zd_point_violation(it->point) / it->self->rounding : 0;
    return ZD_DONE;
}

static int improve(void *context)
{
    const problem *it = context;
    zd_partition_sparse *self = it->self;
    zd_point *point = it->point;
    int status = zd_partition_factor(self->of_p, point);
    if (!status || status == ZD_SINGULAR) note_condition(self->of_p, point);
    if (status) return status;
    zd_clear(point->system->nv, self->x);
    for (int k = 0; k < point->system->mh; k++) self->rhs[k] = -point->terms.Phi[k];
    status = zd_partition_solve(self->of_p, self->rhs, self->x);
    for (int i = 0; i < point->system->nq; i++) self->p[i] = point->p[i] + self->x[i];
    if (!status) zd_point_move(point, point->t, self->p, point->v);
    return status;
}

/* self->p <- prediction of p by the point's velocity, or if that is too far, the point's p; with q inserted. */
static void predict(zd_partition_sparse *self, const zd_point *point, double t, const double *q)
{
    const double h = t - point->t;
    const int nq = point->system->nq, is_near = fabs(h) * zd_max_scaled(nq, point->v, point->inverse_unit_p) <= FARTHEST;
    for (int i = 0; i < nq; i++) self->p[i] = is_near ? point->p[i] + h * point->v[i] : point->p[i];
    for (int j = 0; j < self->k; j++) self->p[self->of_p->index[j]] = q[j];
}

int zd_partition_sparse_place(zd_partition_sparse *self, zd_point *point, double t, const double *q)
{
    static const zd_newton newton = {residual, improve, 1, MAX_ITERATIONS, 0, NULL, NEARLY};
    problem it = {self, point};
    int iterations, status = need_coordinates(self, point);
    double left;
    if (status) return status;
    predict(self, point, t, q);
    zd_point_move(point, t, self->p, point->v);
    self->rounding = 0;
    status = zd_newton_solve(&newton, &it, &iterations, &left);                           /* (18) */
    point->statistics->embedding_iterations += iterations;
    point->residual_left = left * self->rounding;
    return status == ZD_NO_CONVERGENCE ? ZD_NO_EMBEDDING : status;
}
