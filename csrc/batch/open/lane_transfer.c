/* Transfer of an open run between its own memory and a lane. The next bits of a motion depend on t, p, v, the energy input, the number of the
 * step and the inputs alone; with them go the schedule of checks and the counts, so that warnings do not depend on where steps were made.
 */
#include "open_lanes.h"

#include <math.h>

#include "../../paths/path.h"
#include "../../step_limits.h"

int zd_lane_may_enter(const zd_open_lanes *self, const zd_run *run)
{
    const zd_step_loop *loop = &run->loop;
    return run->motion.path.closed_form->order == self->order && !run->outcome.status && !loop->parts && !loop->steps_before
        && loop->t_begin == run->settings.t0 && loop->end == INFINITY && !run->held.has_ramp;
}

static void load(const zd_lanes *lanes, int lane, int64_t count, const double *from, double *to)
{
    for (int64_t i = 0; i < count; i++) zd_lane_set(lanes, to, i, lane, from[i]);
}

static void load_checks(zd_lanes *lanes, int lane, const zd_run *run)
{
    const zd_resolution *resolution = &run->safeguards.resolution;
    const zd_guard *guard = &run->safeguards.guard;
    lanes->next_check[lane] = (double)guard->next_check;
    lanes->check_pause[lane] = (double)guard->pause;
    lanes->fastest[lane] = guard->fastest;
    lanes->last_checked[lane] = (double)resolution->step;
    load(lanes, lane, lanes->nv, resolution->error, lanes->error);
    load(lanes, lane, lanes->nv, resolution->path, lanes->path);
    load(lanes, lane, lanes->nv, resolution->lowest, lanes->lowest);
    load(lanes, lane, lanes->nv, resolution->highest, lanes->highest);
    if (resolution->place) load(lanes, lane, lanes->nv, resolution->place, lanes->place);
}

static void store_checks(const zd_lanes *lanes, int lane, double steps, zd_run *run)
{
    zd_resolution *resolution = &run->safeguards.resolution;
    zd_guard *guard = &run->safeguards.guard;
    const double h = lanes->step;
    guard->next_check = (int64_t)lanes->next_check[lane];
    guard->pause = lanes->check_soon[lane] != 0 ? ZD_CHECK_EVERY : (int64_t)lanes->check_pause[lane];
    guard->fastest = lanes->fastest[lane];
    guard->reach = fmin(ZD_LONG_PATH * ZD_LONG_PATH, ZD_FASTER_SPEED * h * h * guard->fastest + guard->nearby);
    guard->streak = 0;
    resolution->step = (int64_t)fmin(steps, lanes->last_checked[lane]);
    zd_lane_store(lanes, lane, lanes->nv, lanes->error, resolution->error);
    zd_lane_store(lanes, lane, lanes->nv, lanes->path, resolution->path);
    zd_lane_store(lanes, lane, lanes->nv, lanes->lowest, resolution->lowest);
    zd_lane_store(lanes, lane, lanes->nv, lanes->highest, resolution->highest);
    if (resolution->place) zd_lane_store(lanes, lane, lanes->nv, lanes->place, resolution->place);
}

void zd_lane_enter(zd_open_lanes *self, int lane, int64_t i)
{
    zd_lanes *lanes = &self->lanes;
    zd_run *run = self->runs->run[i];
    const zd_statistics *statistics = &run->motion.statistics;
    const int is_behind = zd_lane_inputs_enter(self, i);
    zd_lanes_load(lanes, lane, run, self->runs->data[i], self->runs->doubles);
    lanes->t[lane] = lanes->t_before[lane] = lanes->t_sample[lane] = run->stepper.t;
    lanes->next_t[lane] = INFINITY;
    lanes->number[lane] = (double)run->loop.step;
    if (lanes->has_input) zd_lane_set(lanes, lanes->y, lanes->size - 1, lane, zd_motion_input(&run->motion));
    load_checks(lanes, lane, run);
    lanes->unresolved[lane] = (double)statistics->unresolved;
    lanes->unresolved_time[lane] = statistics->unresolved_time;
    lanes->part_error[lane] = statistics->part_error;
    lanes->part[lane] = (double)statistics->part;
    self->runs->status[i] = ZD_DONE;
    self->place[i - self->first] = (zd_lane_slot){.is_in = 1, .is_behind = (unsigned char)is_behind};
}

static void store_statistics(zd_lanes *lanes, int lane, double steps, zd_run *run)
{
    zd_statistics *statistics = &run->motion.statistics;
    const int64_t made = (int64_t)steps - run->loop.step, iterations = (int64_t)lanes->iterations[lane];
    statistics->steps += made;
    statistics->closed_form_steps += made;
    statistics->velocity_corrections += lanes->corrects ? made : 0;
    zd_count_position_iterations(&run->motion, (int)lanes->peak_iterations[lane]);
    statistics->position_iterations += iterations - (int64_t)lanes->peak_iterations[lane];
    statistics->unresolved = (int64_t)lanes->unresolved[lane];
    statistics->unresolved_time = lanes->unresolved_time[lane];
    statistics->part_error = lanes->part_error[lane];
    statistics->part = (int)lanes->part[lane];
    lanes->iterations[lane] = lanes->peak_iterations[lane] = 0;
}

/* Moves the run to the state y of a lane, as the end of a step in closed form does: what the matrix path has kept stays. */
static int move_to(const zd_lanes *lanes, int lane, double t, double steps, const double *y, zd_run *run)
{
    zd_stepper *stepper = &run->stepper;
    zd_motion *motion = &run->motion;
    zd_lane_store(lanes, lane, lanes->size, y, stepper->y);
    stepper->t = t;
    motion->state = stepper->y;
    run->loop.step = (int64_t)steps;
    zd_point_move(motion->point, t, stepper->y, stepper->y + lanes->nq);
    return zd_closed_form_resume(motion) ? zd_guard_begin(&run->safeguards.guard, run->loop.step + 1) : ZD_DONE;
}

int zd_lane_put_back(zd_open_lanes *self, int lane, int64_t i, double t, double steps, const double *y)
{
    zd_lanes *lanes = &self->lanes;
    zd_run *run = self->runs->run[i];
    const int has_moved = (int64_t)steps != run->loop.step;
    zd_lane_inputs_put_back(self, i, has_moved);
    if (!has_moved) return ZD_DONE;         /* it is there, with all that it has kept */
    store_statistics(lanes, lane, steps, run);
    store_checks(lanes, lane, steps, run);
    return move_to(lanes, lane, t, steps, y, run);
}
