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
