/* Full checks of the steps of lanes: selection of the lanes in which they are due, and their energy. */
#include "../step_limits.h"
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
