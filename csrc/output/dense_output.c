/* Dense output within the last step, by the method's polynomial of the integrated state.
 *
 * A state in independent velocities may change its variables at the end of a step, or restart them there, as increments are. So the
 * formulation's choice at the start of the step is copied, and restored while values within the step are computed. On the closed-form path
 * the variables do not change within a step.
 */
#include "within_step.h"

#include <string.h>

#include "../paths/path.h"

static void *take_chosen(zd_arena *arena, const void *of)
{
    const zd_motion *motion = of;
    return zd_arena_copy(arena, motion->memory_of_chosen.at, motion->memory_of_chosen.bytes);
}

int zd_dense_output_create(zd_stepper *stepper)
{
    zd_motion *motion = stepper->motion;
    if (stepper->last.chosen || !stepper->integrator->prepare_dense || !motion->formulation->update) return ZD_DONE;
    stepper->last.chosen = zd_store_create(&motion->store, take_chosen, motion);
    return stepper->last.chosen ? ZD_DONE : ZD_NO_MEMORY;
}

static void take_variables_back(zd_stepper *stepper)
{
    zd_motion *motion = stepper->motion;
    memcpy(motion->memory_of_chosen.at, stepper->last.chosen, motion->memory_of_chosen.bytes);
    motion->point->known &= ~(ZD_COMPLEMENTED | ZD_FACTORED | ZD_ACCELERATED);
}

int zd_has_dense_output(const zd_stepper *stepper, double t0)
{
    const zd_last *last = &stepper->last;
    if (!stepper->integrator->prepare_dense || last->t != t0 || last->h != stepper->t - t0) return 0;
    return !zd_motion_updates(stepper->motion) || last->chosen;
}

int zd_dense_output_prepare(zd_stepper *stepper)
{
    zd_motion *motion = stepper->motion;
    const zd_last *last = &stepper->last;
    int status = ZD_DONE;
    if (zd_motion_updates(motion)) {
        take_variables_back(stepper);
        status = motion->formulation->express(motion->solver, motion->point, stepper->y);
    }
    /* The point is where the step has ended. */
    return status ? status : stepper->integrator->prepare_dense(stepper->memory, &motion->rate, last->t, last->h, last->y, stepper->y);
}

int zd_dense_output_move(zd_stepper *stepper, double t)
{
    const zd_last *last = &stepper->last;
    if (zd_motion_updates(stepper->motion)) take_variables_back(stepper);
    stepper->integrator->dense_output(stepper->memory, (t - last->t) / last->h, last->y, stepper->y);
    stepper->motion->statistics.output_steps++;
    return zd_path_end(stepper, t, 1);
}
