/* How near a structure with redundant rows is to a bifurcation. Such a structure is solved by bodywise.c, which has no pivots of rows; so
 * C M^-1 C^T of its independent rows alone is factored here, and a small pivot tells. */
#ifndef ZD_SINGULARITY_MONITOR_H
#define ZD_SINGULARITY_MONITOR_H

#include "../constraints/rank.h"
#include "../point/weighted.h"

typedef struct zd_singularity_monitor {
    zd_weighted *weighted;      /* S(M^-1) */
    double *W;                  /* stored as M is: M^-1, by its factors */
    unsigned char *without;     /* (rows of S,): those that are left out */
    double share;               /* of its diagonal entry: the smallest pivot where it was last looked */
    int smallest;               /* where that is in the order of S */
} zd_singularity_monitor;

/* NULL where there is no memory. */
zd_singularity_monitor *zd_singularity_monitor_create(zd_store *store, const zd_point *point);
/* M and C are known at the point. Returns whether M is definite: else nothing is seen. */
int zd_singularity_monitor_update(zd_singularity_monitor *self, const zd_point *point);

#endif
