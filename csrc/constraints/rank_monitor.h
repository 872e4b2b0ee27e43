/* Whether all rows count, from how little they have changed since it was last looked at closely. */
#ifndef ZD_RANK_MONITOR_H
#define ZD_RANK_MONITOR_H

#include "../linalg/orthogonal.h"
#include "../point/weighted.h"
#include "rank.h"

struct zd_rank_monitor {
    int m;                  /* rows of C; of a choice, `close` has fewer */
    int *row;               /* (m,): that choice and behind it the others; NULL: all rows are looked at */
    int is_known;           /* whether rows are kept, far enough from dependent ones */
    float *C;               /* (m, n): the rows then */
    double *weight;         /* (m,): 1 / the length that was left of each once all others were taken out; 0 of those not looked at */
    double *share;          /* as stored: of each entry's change, squared, in the bound by bodies; NULL where no structure is declared */
    zd_orthogonal close;    /* the closer monitor, in memory that may serve others between */
    zd_weighted *weighted;  /* in its place where the structure is declared, C C^T in blocks; NULL until it is first wanted */
    double *identity;       /* stored as M is */
    double *inverse;        /* blocks of (C C^T)^-1 */
};

/* `Q` (m, n) and `G` (m, m) are free whenever it is not known which rows count; NULL: there is no such memory. Where the structure is
 * declared, the rank's store has the rest once it is first looked closely. */
zd_rank_monitor *zd_rank_monitor_take(zd_arena *arena, const zd_system *system, double *Q, double *G);
/* Of a choice among rows of which some are redundant */
zd_rank_monitor *zd_rank_monitor_take_selection(zd_arena *arena, const zd_system *system);
/* Keeps the rows that count at the point, if they are far enough from dependent ones. */
void zd_rank_monitor_keep_selection(zd_rank_monitor *self, zd_point *point);
/* Whether rows that are kept are as near to what they were as NEAR says; C is known at the point. */
int zd_rank_monitor_is_unchanged(const zd_rank_monitor *self, const zd_point *point);
/* Whether any row at the point might follow from those before it; C is known there. */
int zd_rank_monitor_is_doubtful(zd_rank_monitor *self, zd_point *point);
/* Whether rows may have come to lie reversed, of a structure whose pivots have told that all of them count. */
static inline void zd_rank_monitor_compare(zd_point *point)
{
    const zd_rank *rank = point->rank;
    if (point->layout && rank->monitor && rank->most_rows == rank->m && rank->m <= rank->n)
        (void)zd_rank_monitor_is_doubtful(rank->monitor, point);
}

#endif
