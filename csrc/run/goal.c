/* Open runs advance from goal to goal. Fixed steps stay at t_begin + k step, so that chained advances have the bits of one; t_begin and the
 * count begin anew only where a step was shortened, to a time between two of these or to a terminal event.
 */
#include "run.h"

#include <math.h>

#include "../constraints/rank.h"
#include "../linalg/small.h"
#include "../paths/path.h"
#include "../state/stepper.h"
#include "../step_limits.h"

static int is_fixed(const zd_run *run) { return run->settings.steps == ZD_FIXED_STEPS; }

void zd_run_remove_end(zd_run *run)
{
    run->loop.end = INFINITY;
    run->loop.steps = 0;
}

/* Counts steps from the present state if the last one ended elsewhere than where it is counted. */
static void begin_anew(zd_run *run)
{
    zd_step_loop *loop = &run->loop;
    if (!isfinite(loop->end) || run->stepper.t != loop->end) return;
    loop->t_begin = run->stepper.t;
    loop->steps_before = loop->step;
}

/* Steps to time t; the last one is shortened if t is between the ends of two. */
static void set_goal_time(zd_run *run, double t)
{
    zd_step_loop *loop = &run->loop;
    const double size = run->settings.step, steps = zd_count_steps(loop->t_begin, t, size), ratio = (t - loop->t_begin) / size;
    const int64_t last = loop->steps_before + (int64_t)steps;
    if (is_fixed(run) && last < run->goal.step) run->goal.step = last;
    if (!run->settings.is_open && is_fixed(run)) return;
    if (is_fixed(run) && (fabs(ratio - steps) <= 1e-9 * steps || last > run->goal.step)) return;
    loop->end = run->settings.is_open ? t : fmin(t, run->settings.t1);
    loop->steps = is_fixed(run) ? last : 0;
}

int zd_run_set_goal(zd_run *run, int64_t steps, double t)
{
    if (!(t >= run->stepper.t) || steps < 0) return ZD_BAD_ARGUMENT;
    if (run->settings.is_open) {
        if (!run->outcome.status) run->outcome.message[0] = '\0';
        begin_anew(run);
        zd_run_remove_end(run);
    }
    if (run->outcome.status == ZD_EVENT) run->outcome = (zd_outcome){.status = ZD_DONE};
    if (zd_watch_ends(&run->watch)) run->watch.found[run->watch.ended - 1] = 0;      /* it is terminal again */
    zd_run_leave_event(run);
    const int64_t made = run->loop.step;
    run->goal.step = steps < INT64_MAX - made ? made + steps : INT64_MAX;
    if (t < INFINITY) set_goal_time(run, t);
    return ZD_DONE;
}

static void save_good(zd_run *run)
{
    zd_stepper_save_state(&run->stepper, &run->goal.good);
    run->goal.good_step = run->loop.step;
    run->goal.good_h = run->loop.control.h;
}

int zd_run_begin_step(zd_run *run)
{
    if (run->settings.is_open) save_good(run);
    const int status = run->settings.inputs ? zd_inputs_begin_step(run) : ZD_DONE;
    return status || !run->watch.disarmed ? status : zd_watch_arm(&run->watch);
}

static int return_to_good(zd_run *run)
{
    zd_step_loop *loop = &run->loop;
    zd_motion *motion = &run->motion;
    zd_closed_form_leave(motion);
    loop->parts = 0;
    loop->step = run->goal.good_step;
    loop->control.h = run->goal.good_h;
    run->output.is_within = run->output.is_prepared = run->watch.failed = 0;
    motion->point->known = 0;
    motion->point->rank->was_deficient = motion->point->rank->was_doubtful = 0;
    zd_inputs_return(run);
    int status = zd_variables_use_chosen(&run->stepper);
    if (!status) status = zd_stepper_return_to(&run->stepper, &run->goal.good);
    if (!status && run->watch.ended) status = zd_watch_start(&run->watch);
    zd_run_leave_event(run);
    return status ? status : zd_safeguards_begin(&run->safeguards, loop->step + 1);
}

int zd_run_finish(zd_run *run, int status)
{
    zd_outcome *outcome = &run->outcome;
    if (!status && run->watch.ended) status = ZD_EVENT;
    if (!status || outcome->status) return outcome->status;
    status = outcome->status = zd_explain(run, status);
    if (run->settings.is_open && status < 0 && !return_to_good(run)) outcome->status = ZD_DONE;
    return status;
}

double zd_run_time(const zd_run *run) { return run->stepper.t; }
const double *zd_run_p(const zd_run *run) { return run->motion.point->p; }
const double *zd_run_v(const zd_run *run) { return run->motion.point->v; }
int zd_run_ended_by(const zd_run *run) { return run->watch.ended - 1; }
int64_t zd_run_step_number(const zd_run *run) { return run->loop.step; }

int zd_run_accelerations(zd_run *run, double *vdot, double *multipliers)
{
    zd_motion *motion = &run->motion;
    const int status = zd_motion_accelerate(motion);
    if (status) return status;
    zd_rank_find_multipliers(motion->point);
    zd_copy(motion->system.nv, motion->point->vdot, vdot);
    zd_copy(zd_point_constraints(motion->point), zd_point_multipliers(motion->point), multipliers);
    return ZD_DONE;
}

int zd_run_measure(zd_run *run, const zd_system *system, int measure, double t, const double *p, const double *v, double *value,
                   double *scratch)
{
    const zd_measures *all = system->measures;
    const int is_dynamic = all->measure[measure].depends == ZD_OF_ACCELERATIONS;
    double *vdot = is_dynamic ? scratch + all->scratch : NULL, *multipliers = is_dynamic ? vdot + system->nv : NULL;
    const int status = is_dynamic ? zd_run_accelerations(run, vdot, multipliers) : ZD_DONE;
    if (status) return status;
    zd_measured at = {.value = value, .is_least = is_dynamic && !zd_rank_is_deficient(run->motion.point)};
    const double *functions = run->motion.system.reading ? run->motion.point->inputs : NULL;
    return all->evaluate(system->data, functions, measure, t, p, v, vdot, multipliers, &at, scratch);
}

int zd_run_position_violation(zd_run *run, double *violation)
{
    zd_point *point = run->motion.point;
    const int mh = run->motion.system.mh, status = mh ? zd_point_need(point, ZD_PHI) : ZD_DONE;
    *violation = zd_max_abs(mh, point->terms.Phi);
    return status;
}

int zd_run_energy_violation(zd_run *run, double *violation)
{
    zd_motion *motion = &run->motion;
    double kinetic;
    if (!zd_has_energy(&motion->system)) return ZD_NOT_FINITE;
    const int status = zd_motion_accelerate(motion);
    return status ? status : zd_motion_energy_violation(motion, violation, &kinetic);
}
