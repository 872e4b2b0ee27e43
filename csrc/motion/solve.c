#include <string.h>

#include "../constraints/rows.h"
#include "motion.h"

int zd_motion_factor_anew(zd_motion *motion)
{
    zd_point *point = motion->point;
    int status = zd_point_need(point, motion->matrices);
    if (status) return status;
    motion->statistics.factorizations++;
    status = motion->formulation->factor(motion->solver, point);
    if (!status) point->known |= ZD_FACTORED;
    return status;
}

int zd_motion_find_rows(zd_motion *motion)
{
    zd_point *point = motion->point;
    const zd_formulation *formulation = motion->formulation;
    if (point->known & ZD_RANKED) return ZD_DONE;
    const int selects_rows = formulation->finds_rows && formulation->finds_rows(&motion->system);
    /* A failed factorization gives no selection; its error is reported by the caller that needs the factors. */
    if (selects_rows && zd_motion_factor(motion) == ZD_CALLBACK) return ZD_CALLBACK;
    return zd_rows_find(point);
}

static void solve_reduced(const zd_point *point, const zd_formulation *formulation, void *solver, const double *force,
                          const double *rhs, double *x, double *lambda)
{
    zd_selection *selection = point->rank->selection;
    int holonomic = point->holonomic - point->rank->lost, others = selection->independent - holonomic;
    for (int a = 0; a < point->rows; a++) selection->rhs[a] = rhs[selection->row_at[a]];
    formulation->solve(solver, force, selection->rhs, x, lambda ? selection->lambda : NULL);
    if (!lambda) return;
    selection->are_awaited = !selection->is_expressed;
    if (selection->are_awaited) {
        memcpy(selection->lambda_r, selection->lambda, (size_t)selection->independent * sizeof *selection->lambda);
        return;
    }
    memmove(selection->lambda + holonomic, selection->lambda + point->holonomic, (size_t)others * sizeof(double));
    zd_rank_share_out(point, lambda);
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
