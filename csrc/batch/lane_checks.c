/* Full checks of the steps of lanes, in the lanes in which they are due; and the corrections of energy. */
#include "../step_limits.h"

#include <math.h>

#include "../point/point.h"
#include "group.h"

void zd_lane_group_check_closely(zd_lane_group *self)
{
    zd_lanes *lanes = &self->lanes;
    int any = 0;
    for (int lane = 0; lane < lanes->lanes; lane++) {
        const int checks = zd_lane_has_run(self, lane) && lanes->number[lane] >= lanes->next_check[lane];
        lanes->is_wanted[lane] = checks;
        any |= checks;
    }
    if (!any) return;
    self->functions->check(lanes);
    for (int lane = 0; lane < lanes->lanes; lane++)
        if (lanes->is_wanted[lane] != 0 && lanes->number[lane] >= (double)ZD_CHECK_EVERY)
            self->run_of[lane].is_off |= !zd_lane_group_keeps_energy(self, lane);
}

/* Corrections after the projection, (29), lane by lane, as in motion/motion.c. */

/* Corrects one lane; returns 0 on failure. */
static int correct(zd_lane_group *self, int lane, double t, double *y, int forced)
{
    zd_lanes *lanes = &self->lanes;
    zd_motion *motion = &self->run->motion;
    zd_lane_run *run = &self->run_of[lane];
    zd_lane_energy *energy = &run->of_energy;
    zd_statistics *statistics = &motion->statistics;
    zd_lane_group_stand(self, lane, t, y);
    motion->tally->energy_skipped = 0;
    statistics->energy_corrections = energy->corrections;
    statistics->energy_skipped = energy->skipped;
    statistics->energy_corrected = energy->corrected;
    if (zd_motion_correct_rest(motion, (int64_t)lanes->number[lane] + 1, forced || t == lanes->end)) return 0;
    energy->corrections = statistics->energy_corrections;
    energy->skipped = statistics->energy_skipped;
    energy->corrected = statistics->energy_corrected;
    energy->skipped_since_sample += motion->tally->energy_skipped;
    if (motion->point->known & ZD_M) run->kinetic = fmax(run->kinetic, zd_point_kinetic(motion->point));
    for (int i = 0; i < lanes->nv; i++) zd_lane_set(lanes, y, lanes->nq + i, lane, motion->point->v[i]);
    return 1;
}

void zd_lane_group_correct_rest(void *group, const double *t, double *y, int forced)
{
    zd_lane_group *self = group;
    for (int lane = 0; lane < self->lanes.lanes; lane++)
        if (self->lanes.is_corrected[lane] != 0 && !correct(self, lane, t[lane], y, forced)) self->lanes.leaves[lane] = 1;
}
