/* Renewal of terms and accelerations at the point, after a change of what is not its state. */
#include "step_loop.h"

int zd_renew(zd_step_loop *loop)
{
    zd_motion *motion = loop->motion;
    zd_guard *guard = &loop->safeguards->guard;
    const int was_accelerated = motion->point->known & ZD_ACCELERATED;
    if (loop->stepper->integrator->forget) loop->stepper->integrator->forget(loop->stepper->memory);
    motion->point->known &= motion->point->constant;
    if (!guard->watches_step && !was_accelerated) return ZD_DONE;
    const int status = zd_motion_accelerate(motion);
    if (!status && guard->watches_step) zd_guard_watch_next(guard);
    return status;
}
