/* Contacts in lanes: steps in which none of them can close, so that no event has to be located. */
#include <math.h>

#include "../contact/phase_system.h"
#include "group.h"

zd_lane_gaps zd_lane_gaps_create(zd_arena *arena, int groups)
{
    return (zd_lane_gaps){.gap = zd_arena_doubles(arena, groups), .rate = zd_arena_doubles(arena, groups)};
}

/* Gaps and their rates at the state y of a lane; nonzero on failure. */
static int evaluate(zd_lane_group *self, int lane, double t, const double *y, zd_lane_gaps *to)
{
    const zd_phase_system *phase = self->run->motion.point->phase;
    zd_lane_group_gather(self, lane, y);
    zd_lane_group_data(self, lane);
    const int status = zd_phase_need(phase, ZD_PHI | ZD_C | ZD_PHI_T, t, self->p, self->v);
    for (int g = 0; !status && g < phase->full->groups; g++) {
        const zd_group *group = phase->full->group + g;
        double rate;
        if (group->kind != ZD_ONE_SIDED) continue;
        zd_phase_slip(phase, g, self->v, &rate);
        to->gap[g] = zd_phase_gap(phase, g);
        to->rate[g] = group->sign * rate;
    }
    return status;
}

/* True if the cubic Hermite polynomial of a gap, over a step of size h, stays positive. */
static int stays_positive(double h, double gap0, double rate0, double gap1, double rate1)
{
    const double change = gap1 - gap0;
    return fmin(gap0, gap1) > fabs(h * rate0 - change) + fabs(h * rate1 - change);
}

/* True if the margin of a group is its gap, or never changes. */
static int is_simple(const zd_phase_system *phase, int g)
{
    const enum zd_group_kind kind = phase->full->group[g].kind;
    return kind != ZD_ONE_WAY && (kind != ZD_ONE_SIDED || phase->state[g] == ZD_OPEN);
}

int zd_lane_contacts_stay_open(zd_lane_group *self, int lane)
{
    const zd_lanes *lanes = &self->lanes;
    zd_lane_run *run = &self->run_of[lane];
    if (!self->run->phases || zd_lane_group_own_events(self)) return 0;
    const zd_phase_system *phase = self->run->motion.point->phase;
    const zd_lane_gaps before = run->gaps;
    int stay = before.number == lanes->number[lane] - 1 || !evaluate(self, lane, lanes->t_before[lane], lanes->y0, &run->gaps);
    run->gaps = run->spare_gaps, run->spare_gaps = before;
    stay = stay && !evaluate(self, lane, lanes->t[lane], lanes->y, &run->gaps);
    run->gaps.number = lanes->number[lane];
    for (int g = 0; stay && g < phase->full->groups; g++)
        stay = is_simple(phase, g) && (phase->full->group[g].kind != ZD_ONE_SIDED
                                       || stays_positive(lanes->t[lane] - lanes->t_before[lane], before.gap[g], before.rate[g],
                                                         run->gaps.gap[g], run->gaps.rate[g]));
    return stay;
}

int zd_lane_contact_leaves(zd_lane_group *self, int lane)
{
    const int leaves = self->run_of[lane].search.event >= zd_lane_group_own_events(self);
    if (leaves) self->lanes.leaves[lane] = 1;
    return leaves;
}
