/* Corrections after a step. */
#include "../linalg/small.h"
#include "motion.h"

enum which { ALL, PROJECTION, REST };

ZD_INLINE int correct(zd_motion *motion, int64_t step, int forced, const enum which which)
{
    for (int i = 0; i < motion->corrections; i++) {
        const zd_active *active = &motion->active[i];
        if (!active->row->after_step || !(forced || zd_is_one_of(active->every, step))) continue;
        if (which != ALL && (active->row->target != NULL) != (which == PROJECTION)) continue;
        int status = active->row->after_step(active->self, motion);
        if (status) return status;
    }
    return ZD_DONE;
}

int zd_motion_correct(zd_motion *motion, int64_t step, int forced)
{
    return correct(motion, step, forced, ALL);
}

int zd_motion_project(zd_motion *motion, int64_t step, int forced)
{
    return correct(motion, step, forced, PROJECTION);
}

int zd_motion_correct_rest(zd_motion *motion, int64_t step, int forced)
{
    return correct(motion, step, forced, REST);
}

int zd_motion_is_corrected(const zd_motion *motion, int64_t step)
{
    for (int i = 0; i < motion->corrections; i++)
        if (motion->active[i].row->after_step && !zd_is_one_of(motion->active[i].every, step)) return 0;
    return 1;
}
