/* State (p, v) of the dependent formulations (8), (9), (13), which drifts from (3) and (5). */
#ifndef ZD_DEPENDENT_H
#define ZD_DEPENDENT_H

#include "formulation.h"

int zd_dependent_state_size(const zd_system *system);
int zd_dependent_unpack(void *self, zd_point *point, double t, const double *y);
int zd_dependent_pack(void *self, zd_point *point, double *y);
int zd_dependent_rate(void *self, zd_point *point, double *ydot);

#define ZD_DEPENDENT_STATE                         \
    .drifts_from = ZD_PHI | ZD_C,                     \
    .state_size = zd_dependent_state_size,         \
    .unpack = zd_dependent_unpack,                   \
    .pack = zd_dependent_pack,                   \
    .rate = zd_dependent_rate

#endif
