/* Contacts in lanes: a step in which all stay open needs no search for events, and a run in which one closes leaves. */
#include <math.h>

#include "../step_limits.h"
#include "group.h"

int zd_lane_contacts_stay_open(zd_lane_group *self, int lane)
{
    const zd_lanes *lanes = &self->lanes;
    zd_lane_run *run = &self->run_of[lane];
    const zd_phase_system *phase = self->run->motion.point->phase;
    if (!phase) return 0;
    const zd_gaps after = run->gaps[0];
    run->gaps[0] = run->gaps[1], run->gaps[1] = after;
    zd_lane_group_data(self, lane);
    zd_lane_group_gather(self, lane, lanes->y0);
    int status = zd_gaps_find(&run->gaps[0], phase, lanes->t_before[lane], self->p, self->v);
    zd_lane_group_gather(self, lane, lanes->y);
    if (!status) status = zd_gaps_find(&run->gaps[1], phase, lanes->t[lane], self->p, self->v);
    zd_lane_store(lanes, lane, lanes->nv, lanes->inverse_unit, self->v);
    const double distance = status ? INFINITY : zd_gaps_distance(&run->gaps[0], &run->gaps[1], lanes->nv, self->v);
    if (!(distance < ZD_LARGEST_TURN)) self->lanes.leaves[lane] = 1;
    int stay = distance < ZD_SMALL_DISPLACEMENT && !zd_lane_group_own_events(self);
    for (int g = 0; stay && g < phase->full->groups; g++) stay = zd_gap_stays_open(phase, &run->gaps[0], &run->gaps[1], g);
    return stay;
}

int zd_lane_contact_leaves(zd_lane_group *self, int lane)
{
    const int leaves = self->run_of[lane].search.event >= zd_lane_group_own_events(self);
    if (leaves) self->lanes.leaves[lane] = 1;
    return leaves;
}
