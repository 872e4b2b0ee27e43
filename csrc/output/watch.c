/* Values of event functions, and their rounding. */
#include "watch.h"

#include <math.h>

#include "../constraints/rank.h"
#include "../step_limits.h"

static const double STATE_ROUNDING = 64 * 0x1p-52;  /* relative rounding of coordinates and velocities within a step */

int zd_watch_evaluate_at(zd_watch *self, int event, const zd_state *state, double *value)
{
    const zd_events *events = self->events;
    const zd_system *system = &self->output->stepper->motion->system;
    const int reads = events->known && events->known[event].readings;
    int status = reads ? zd_read_event(&self->reader, system->data, event, state->t, state->p, state->v, value)
                       : events->evaluate(events->data, event, state->t, state->p, state->v, NULL, value);
    if (status) self->failed = event + 1;
    return status;
}

int zd_watch_reads_accelerations(const zd_watch *self, int event)
{
    const zd_motion *motion = self->output->stepper->motion;
    return zd_reads_accelerations(self->events, &motion->system, motion->point->phase, event);
}

int zd_watch_evaluate(zd_watch *self, int event, double *value)
{
    const zd_stepper *stepper = self->output->stepper;
    const zd_point *point = stepper->motion->point;
    const int is_dynamic = zd_watch_reads_accelerations(self, event);
    const int status = is_dynamic ? zd_motion_accelerate(stepper->motion) : ZD_DONE;
    if (status) return status;
    if (is_dynamic) zd_rank_find_multipliers(point);
    return zd_watch_evaluate_at(self, event, &(zd_state){.t = stepper->t, .p = point->p, .v = point->v}, value);
}

int zd_watch_evaluate_all(zd_watch *self, double *values)
{
    int status = ZD_DONE;
    for (int i = 0; !status && i < self->events->count; i++) status = zd_watch_evaluate(self, i, &values[i]);
    return status;
}

/* Signs that look random, so that differences of entries do not cancel. */
void zd_perturb(int n, const double *x, unsigned seed, double *perturbed)
{
    for (int i = 0; i < n; i++) {
        const unsigned mixed = ((unsigned)i + 1) * 2654435769u + seed * 2246822519u;
        perturbed[i] = x[i] * (1 + (mixed >> 16 & 1 ? STATE_ROUNDING : -STATE_ROUNDING));
    }
}

int zd_watch_rounding(zd_watch *self, int event, double value, double *rounding)
{
    const zd_stepper *stepper = self->output->stepper;
    const zd_motion *motion = stepper->motion;
    int status = ZD_DONE;
    *rounding = 0;
    for (unsigned seed = 1; !status && seed <= 2; seed++) {
        double g = value;
        self->mixed.t = stepper->t * (1 + (seed > 1 ? ZD_TIME_RESOLUTION : -ZD_TIME_RESOLUTION));
        zd_perturb(motion->system.nq, motion->point->p, seed, self->mixed.p);
        zd_perturb(motion->system.nv, motion->point->v, seed + 2, self->mixed.v);
        status = zd_watch_evaluate_at(self, event, &self->mixed, &g);
        *rounding += fabs(g - value);
    }
    return status;
}
