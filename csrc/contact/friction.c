/* Loads and bounds of friction. */
#include <math.h>

#include "phase_system.h"

double zd_friction_load(const zd_system *full, const zd_group *group, const double *lambda)
{
    const int half = group->loads / 2, ends = group->at_ends ? 2 : 1, count = group->at_ends ? half : group->loads;
    double sum = 0;
    if (group->normal) return fmax(0, -full->group[group->normal - 1].sign * lambda[0]);
    for (int end = 0; end < ends; end++) {
        double square = 0;
        for (int i = 0; i < count; i++) {
            const double of_moment = ends == 2 ? group->load_factor[half + i] * lambda[half + i] : 0;
            const double load = group->load_factor[i] * lambda[i] + (end ? -of_moment : of_moment);
            square += load * load;
        }
        sum += sqrt(square);
    }
    return group->loads ? sum : 1;
}

double zd_friction_bound(const zd_system *full, int index, int which, const double *lambda)
{
    const zd_group *group = full->group + index;
    return group->friction[which] * zd_friction_load(full, group, lambda + zd_first_load(full, group));
}

/* True of idle friction in whose place a parallel one sticks. */
static int is_tied(const zd_phase_system *self, int g, int to)
{
    return self->full->group[g].kind == ZD_FRICTION && self->state[g] == ZD_IDLE && self->tie[g] == to;
}

/* Sum of f (bound - share |force|) over a group and those tied to it, with the lengths f of their rows in units of its own. */
static double sum_up(const zd_phase_system *self, int to, double share, const double *lambda)
{
    double sum = 0;
    for (int g = 0; g < self->full->groups; g++) {
        if (g != to && !is_tied(self, g, to)) continue;
        const double factor = g == to ? 1 : fabs(self->tie_factor[g]);
        sum += factor * (zd_friction_bound(self->full, g, 0, lambda) - share * fabs(lambda[self->full->group[g].first]));
    }
    return sum;
}

double zd_friction_room(const zd_phase_system *self, int index, const double *lambda) { return sum_up(self, index, 1, lambda); }

void zd_friction_distribute(const zd_phase_system *self, double *lambda)
{
    const zd_system *full = self->full;
    for (int to = 0; to < full->groups; to++) {
        const double whole = lambda[full->group[to].first];
        if (full->group[to].kind != ZD_FRICTION || self->state[to] != ZD_CLOSED) continue;
        const double total = sum_up(self, to, 0, lambda);
        for (int g = 0; total > 0 && g < full->groups; g++) {
            if (g != to && !is_tied(self, g, to)) continue;
            const double share = zd_friction_bound(full, g, 0, lambda) / total;
            lambda[full->group[g].first] = g == to || self->tie_factor[g] > 0 ? share * whole : -share * whole;
        }
    }
}
