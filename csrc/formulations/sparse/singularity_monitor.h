/* Distance of a structure with redundant constraints from a bifurcation. Such a structure is solved by bodywise.c, which has no pivots
 * of constraints; so C M^-1 C^T of the independent constraints alone is factored here for its smallest pivot. */
#ifndef ZD_SINGULARITY_MONITOR_H
#define ZD_SINGULARITY_MONITOR_H

#include "../../constraints/rank.h"
#include "../../point/sparse/weighted.h"

typedef struct zd_singularity_monitor {
    zd_weighted *weighted;      /* S(M^-1) */
    double *W;                  /* stored as M: factors of M^-1 */
    unsigned char *without;     /* (rows of S,): 1 for constraints left out */
    double share;               /* smallest pivot relative to its diagonal entry, at the last update */
    int smallest;               /* index of that pivot in the order of S */
} zd_singularity_monitor;

/* Returns NULL without memory. */
zd_singularity_monitor *zd_singularity_monitor_create(zd_store *store, const zd_point *point);
/* Updates the smallest pivot; M and C are known at the point. Returns 0, without an update, if M is not definite. */
int zd_singularity_monitor_update(zd_singularity_monitor *self, const zd_point *point);

#endif
