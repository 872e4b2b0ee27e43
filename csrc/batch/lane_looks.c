/* What is looked at now and then in the steps of a lane, as often as in any other run: see guard.c and resolution.c. */
#include <math.h>

#include "../safeguards/resolution.h"
#include "group.h"

enum { LOOK_EVERY = 8, LOOK_SELDOM = 64 };  /* steps: as guard.c has them */
static const double AMPLE = 0x1p-8;

zd_lane_look zd_lane_look_take(zd_arena *arena, zd_lane_group *self)
{
    zd_run *run = self->run;
    const zd_point *point = run->motion.point;
    const int order = run->stepper.integrator->card.order;
    if (!self->lanes.is_fixed) return (zd_lane_look){.pause = LOOK_SELDOM};
    return (zd_lane_look){
        .resolution = zd_resolution_take(arena, &run->motion, order, &self->last, self->vdot0, self->last.v, point ? point->v : NULL),
    };
}

static void clear(int n, double *numbers)
{
    for (int i = 0; numbers && i < n; i++) numbers[i] = 0;
}

void zd_lane_group_begin_looks(zd_lane_group *self, int lane)
{
    zd_lanes *lanes = &self->lanes;
    zd_lane_look *look = &self->run_of[lane].look;
    zd_resolution *resolution = &look->resolution;
    lanes->next_look[lane] = lanes->is_fixed ? 1 : LOOK_SELDOM;
    look->found = (zd_statistics){.steps = 0};
    look->is_off = 0;
    look->pause = lanes->is_fixed ? LOOK_EVERY : LOOK_SELDOM;
    resolution->last = &self->last;
    resolution->step = 0;
    double *const numbers[] = {resolution->error, resolution->path, resolution->place, resolution->lowest, resolution->highest};
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) clear(lanes->nv, numbers[i]);
}

/* The run that looks is taken to the end of the lane's step, and is told where that began. */
static void stand(zd_lane_group *self, int lane)
{
    const zd_lanes *lanes = &self->lanes;
    zd_point *point = self->run->motion.point;
    zd_lane_group_gather(self, lane, lanes->y0);
    for (int i = 0; i < lanes->nq; i++) self->last.p[i] = self->p[i];
    for (int i = 0; i < lanes->nv; i++) self->last.v[i] = self->v[i];
    for (int i = 0; i < lanes->nv; i++) self->vdot0[i] = zd_lane_number(lanes, lanes->k, lanes->nq + i, lane);
    self->last.t = lanes->t_before[lane];
    self->last.h = lanes->t[lane] - self->last.t;
    zd_lane_group_stand(self, lane, lanes->t[lane], lanes->y);
    for (int i = 0; i < lanes->nv; i++) {
        point->vdot[i] = zd_lane_number(lanes, lanes->vdot, i, lane);
        point->inverse_unit[i] = zd_lane_number(lanes, lanes->inverse_unit, i, lane);
    }
}

/* Whether the step was far from too long, (omega h)^4 being what guard.c has it from */
static int is_ample(const zd_lane_group *self, int lane)
{
    const zd_lanes *lanes = &self->lanes;
    const zd_point *point = self->run->motion.point;
    const double square = self->last.h * self->last.h;
    double changed = 0, moved = 0;
    for (int i = 0; i < lanes->nv; i++) changed += pow((point->vdot[i] - self->vdot0[i]) * point->inverse_unit[i], 2);
    for (int i = 0; i < lanes->nq; i++)
        moved += pow((point->p[i] - self->last.p[i]) * zd_lane_number(lanes, lanes->inverse_unit_p, i, lane), 2);
    return square * square * changed <= AMPLE * lanes->limit * moved;
}

/* Each part of the motion by itself; whether all are far from what is told of. */
static int look_at_parts(zd_lane_group *self, int lane)
{
    zd_statistics *statistics = &self->run->motion.statistics;
    zd_lane_look *look = &self->run_of[lane].look;
    const zd_statistics own = *statistics;
    stand(self, lane);
    statistics->unresolved = look->found.unresolved;
    statistics->unresolved_time = look->found.unresolved_time;
    statistics->part_error = look->found.part_error;
    statistics->part = look->found.part;
    if (zd_resolution_look(&look->resolution, self->last.h, (int64_t)self->lanes.number[lane])) self->lanes.leaves[lane] = 1;
    look->found = *statistics;
    *statistics = own;
    return look->resolution.is_ample && is_ample(self, lane);
}

/* The next look, as guard.c has it. */
static void pause(zd_lane_group *self, int lane, int ample)
{
    zd_lanes *lanes = &self->lanes;
    zd_lane_look *look = &self->run_of[lane].look;
    const int64_t step = (int64_t)lanes->number[lane];
    if (!ample) look->pause = LOOK_EVERY;
    else if (look->pause < LOOK_SELDOM && step % look->pause == 0) look->pause *= 2;
    lanes->next_look[lane] = (double)(step < LOOK_EVERY ? 2 * step : (step / look->pause + 1) * look->pause);
}

void zd_lane_group_look_closely(zd_lane_group *self, int lane)
{
    zd_lanes *lanes = &self->lanes;
    zd_lane_look *look = &self->run_of[lane].look;
    if (lanes->number[lane] < lanes->next_look[lane]) return;
    if (lanes->look_soon[lane] != 0) look->pause = LOOK_EVERY;
    lanes->look_soon[lane] = 0;
    lanes->fastest[lane] = fmax(lanes->fastest[lane], lanes->speed[lane]);
    pause(self, lane, lanes->is_fixed ? look_at_parts(self, lane) : 1);
    if (lanes->number[lane] >= (double)LOOK_EVERY) look->is_off |= !zd_lane_group_keeps_energy(self, lane);
}
