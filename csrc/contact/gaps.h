/* Gaps of open contacts at both ends of a step, by which most steps are seen to have no change of phase. */
#pragma once

#include "phase_system.h"

typedef struct zd_gaps {    /* at one state */
    double t, *p, *v;       /* s, (nq,), (nv,); t is NAN before the first */
    double *gap, *rate;     /* (groups,) of one-sided groups */
} zd_gaps;

zd_gaps zd_gaps_create(zd_arena *arena, const zd_system *system, int groups);
/* Finds the gaps at a state, unless they are known there. */
int zd_gaps_find(zd_gaps *self, const zd_phase_system *phase, double t, const double *p, const double *v);
/* Displacement between two states, the largest of any velocity in its unit: 1 rad, or the characteristic length. */
double zd_gaps_distance(const zd_gaps *before, const zd_gaps *after, int nv, const double *inverse_unit);
/* True if the margin of a group stays positive between two states: it is constant, or a gap whose cubic Hermite polynomial is positive. */
int zd_gap_stays_open(const zd_phase_system *phase, const zd_gaps *before, const zd_gaps *after, int group);
