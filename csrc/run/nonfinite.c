/* Search for the non-finite term after a failure. Terms are not checked during a run, at no cost to it: after a failure the last step is
 * repeated with checks of every evaluation.
 */
#include "run.h"

#include "../linalg/small.h"

static const double IMMENSE = 1e75;     /* larger states overflow by themselves: terms have up to their fourth power */

static int is_moderate(const zd_system *system, const double *p, const double *v)
{
    return zd_max_abs(system->nq, p) < IMMENSE && zd_max_abs(system->nv, v) < IMMENSE;
}

/* ---- a system with checked evaluations ---- */

typedef struct watched {
    zd_system system;
    int term;       /* bit of the first non-finite term of a moderate state; 0: none */
    double t;       /* s: time of that evaluation */
} watched;

static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    watched *self = (watched *)data;
    int status = self->system.evaluate(self->system.data, want, t, p, v, out);
    if (status || !is_moderate(&self->system, p, v)) return ZD_CALLBACK;
    self->term = zd_first_not_finite(&self->system, want, out);
    self->t = t;
    return self->term ? ZD_CALLBACK : ZD_DONE;
}

/* Repeats the last step from its start; returns the term found. */
static int watch_step(zd_run *run, double *t)
{
    zd_motion *motion = &run->motion;
    watched self = {.system = motion->system};
    zd_statistics statistics = motion->statistics;
    zd_stepper_return(&run->stepper);
    motion->system.evaluate = evaluate;
    motion->system.data = &self;
    motion->system.operations = NULL;
    motion->point->known = 0;
    zd_stepper_make(&run->stepper, run->stepper.last.h);
    motion->system = self.system;
    motion->statistics = statistics;
    if (self.term) *t = self.t;
    return self.term;
}

int zd_run_not_finite(zd_run *run, int status, double *t)
{
    const zd_point *point = run->motion.point;
    const zd_system *system = point->system;
    *t = point->t;
    int term = is_moderate(system, point->p, point->v) ? zd_first_not_finite(system, point->known, &point->terms) : 0;
    return term || status != ZD_NOT_FINITE || run->stepper.last.h == 0 ? term : watch_step(run, t);
}
