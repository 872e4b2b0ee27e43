/* Rank monitor: shows that the constraints are still independent, from the change of C since the last full check. */
#pragma once

#include "../linalg/dense.h"
#include "../point/sparse/weighted.h"
#include "rank.h"

struct zd_rank_monitor {
    int m;                  /* number of rows of C; `close` has fewer for a selection */
    int *row;               /* (m,): selected constraints, then the others; NULL: all constraints are monitored */
    int is_known;           /* 1: C holds the rows of the last full check, which were well conditioned */
    float *C;               /* (m, n): rows at the last full check */
    double *weight;         /* (m,): 1 / residual norm of each row after all others are projected out; 0 of those not monitored */
    double *share;          /* stored as C: weight of each entry's squared change in the bound by bodies; NULL: no structure declared */
    zd_orthogonal close;    /* full check, by orthogonalization; its memory may serve others in between */
    zd_weighted *weighted;  /* full check of a declared structure: C C^T in blocks; NULL until first needed */
    double *identity;       /* stored as M is */
    double *inverse;        /* blocks of (C C^T)^-1 */
};

/* Allocates a monitor of all constraints; `selects`: of a selection, if some are redundant. `Q` (m, n) and `G` (m, m) are work space, free
 * during a full check; NULL: allocated here. For a declared structure the rest is allocated from the rank's store at the first full check. */
zd_rank_monitor *zd_rank_monitor_create(zd_arena *arena, const zd_system *system, int selects, double *Q, double *G);
/* Stores the selected rows of C at the point, if they are well conditioned. */
void zd_rank_monitor_keep_selection(zd_rank_monitor *self, zd_point *point);
/* True if the stored rows have changed by less than NEAR; C is known at the point. */
int zd_rank_monitor_is_unchanged(const zd_rank_monitor *self, const zd_point *point);
/* True if some constraint may be dependent at the point; C is known there. */
int zd_rank_monitor_is_doubtful(zd_rank_monitor *self, zd_point *point);
/* Updates was_turned for a structure whose pivots have shown all constraints independent. */
static inline void zd_rank_monitor_compare(zd_point *point)
{
    const zd_rank *rank = point->rank;
    if (point->layout && rank->monitor && rank->max_rank == rank->m && rank->m <= rank->n)
        (void)zd_rank_monitor_is_doubtful(rank->monitor, point);
}
