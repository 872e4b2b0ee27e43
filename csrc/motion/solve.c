#include <string.h>

#include "../constraints/rank.h"
#include "motion.h"

int zd_motion_factor_anew(zd_motion *motion)
{
    zd_point *point = motion->point;
    int status = zd_point_need(point, ZD_M | ZD_C);
    if (status) return status;
    motion->statistics.factorizations++;
    status = motion->formulation->factor(motion->solver, point);
    if (!status) point->known |= ZD_FACTORED;
    return status;
}

static void solve_reduced(const zd_point *point, const zd_formulation *formulation, void *solver, const double *force,
                          const double *rhs, double *x, double *lambda)
{
    zd_rank *rank = point->rank;
    int holonomic = point->holonomic - rank->lost, others = rank->independent - holonomic;
    for (int a = 0; a < point->rows; a++) rank->rhs[a] = rhs[rank->row_at[a]];
    formulation->solve(solver, force, rank->rhs, x, lambda ? rank->lambda : NULL);
    if (!lambda) return;
    memmove(rank->lambda + holonomic, rank->lambda + point->holonomic, (size_t)others * sizeof(double));
    zd_rank_share_out(rank, lambda);
}

void zd_solve_with(const zd_point *point, const zd_formulation *formulation, void *solver, const double *force, const double *rhs,
                   double *x, double *lambda)
{
    if (zd_rank_is_full(point)) formulation->solve(solver, force, rhs, x, lambda);
    else solve_reduced(point, formulation, solver, force, rhs, x, lambda);
}

void zd_motion_solve(zd_motion *motion, const double *force, const double *rhs, double *x, double *lambda)
{
    if (zd_rank_is_full(motion->point)) motion->formulation->solve(motion->solver, force, rhs, x, lambda);
    else solve_reduced(motion->point, motion->formulation, motion->solver, force, rhs, x, lambda);
}
