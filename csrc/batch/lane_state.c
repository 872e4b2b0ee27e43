/* State of one lane in the checking run: rotation of C in long steps, and energy. */
#include <math.h>

#include "../point/point.h"
#include "../step_limits.h"
#include "group.h"

void zd_lane_group_gather(const zd_lane_group *self, int lane, const double *y)
{
    const zd_lanes *lanes = &self->lanes;
    for (int i = 0; i < lanes->nq; i++) self->p[i] = zd_lane_number(lanes, y, i, lane);
    for (int i = 0; i < lanes->nv; i++) self->v[i] = zd_lane_number(lanes, y, lanes->nq + i, lane);
}

const void *zd_lane_group_data_of(const zd_lane_group *self, const void *numbers)
{
    if (!self->run->phases) return numbers;
    if (self->system->data != numbers || self->numbers) zd_phase_forget(self->run->motion.point->phase);
    self->system->data = numbers;
    return self->run->motion.system.data;
}

const void *zd_lane_group_data(const zd_lane_group *self, int lane)
{
    if (!self->numbers) return zd_lane_group_data_of(self, zd_single_run_data(self->batch, self->run_of[lane].number));
    zd_lane_store(&self->lanes, lane, self->batch->doubles, self->lanes.data, self->numbers);
    return zd_lane_group_data_of(self, self->numbers);
}

/* C (mh, nv) in characteristic scales at y; returns 0 if the evaluation failed. */
static int evaluate_rows(zd_lane_group *self, int lane, double t, const double *y, double *C)
{
    const zd_lanes *lanes = &self->lanes;
    const zd_system *system = &self->run->motion.system;
    zd_lane_group_gather(self, lane, y);
    self->terms.C = C;
    if (system->evaluate(zd_lane_group_data(self, lane), ZD_C | ZD_MOVED, t, self->p, self->v, &self->terms)) return 0;
    for (int k = 0; k < lanes->mh; k++)
        for (int i = 0; i < lanes->nv; i++) C[k * lanes->nv + i] /= zd_lane_number(lanes, lanes->inverse_unit, i, lane);
    return 1;
}

/* True if a row has turned by more than about 60 degrees: see guard.c. */
static int is_turned(int n, const double *before, const double *after)
{
    double turned = 0, a = 0, b = 0;
    for (int i = 0; i < n; i++) {
        turned += (after[i] - before[i]) * (after[i] - before[i]);
        a += before[i] * before[i];
        b += after[i] * after[i];
    }
    return !(turned <= fmax(a, b));
}

int zd_lane_group_is_turned(zd_lane_group *self, int lane)
{
    const zd_lanes *lanes = &self->lanes;
    zd_lane_run *run = &self->run_of[lane];
    int known = run->number_of_C == lanes->number[lane] - 1 || evaluate_rows(self, lane, lanes->t_before[lane], lanes->y0, run->C);
    known = known && evaluate_rows(self, lane, lanes->t[lane], lanes->y, self->C);
    int turned = !known;
    for (int k = 0; k < lanes->mh; k++) turned |= is_turned(lanes->nv, run->C + k * lanes->nv, self->C + k * lanes->nv);
    double *now = self->C;
    self->C = run->C;
    run->C = now;
    run->number_of_C = lanes->number[lane];
    return turned;
}

void zd_lane_group_note_start(zd_lane_group *self, int lane)
{
    zd_motion *motion = &self->run->motion;
    zd_lane_run *run = &self->run_of[lane];
    run->number_of_C = run->search.number_of_now = -1;
    run->gaps[1].t = NAN;
    run->search.ended = run->search.is_cut = run->search.is_at_end = run->is_complete = run->is_off = 0;
    run->kinetic = run->kinetic_at_start = zd_has_energy(&motion->system) ? zd_point_kinetic(motion->point) : 0;
    run->energy = motion->balance.initial;
    run->of_energy = (zd_lane_energy){0};
}

void zd_lane_group_stand(zd_lane_group *self, int lane, double t, const double *y)
{
    zd_motion *motion = &self->run->motion;
    const zd_lanes *lanes = &self->lanes;
    zd_lane_group_gather(self, lane, y);
    motion->system.data = zd_lane_group_data(self, lane);
    motion->point->known = 0;
    zd_point_move(motion->point, t, self->p, self->v);
    motion->balance.initial = self->run_of[lane].energy;
    self->run->stepper.y[lanes->size - 1] = zd_lane_number(lanes, y, lanes->size - 1, lane);
}

int zd_lane_group_keeps_energy(zd_lane_group *self, int lane)
{
    const zd_lanes *lanes = &self->lanes;
    zd_lane_run *run = &self->run_of[lane];
    zd_motion *motion = &self->run->motion;
    double violation, kinetic;
    if (!zd_has_energy(&motion->system)) return 1;
    zd_lane_group_stand(self, lane, lanes->t[lane], lanes->y);
    if (zd_motion_energy_violation(motion, &violation, &kinetic)) return 0;
    const double potential = zd_point_potential(motion->point), exchanged = fabs(potential - (run->energy - run->kinetic_at_start));
    run->kinetic = fmax(run->kinetic, kinetic);
    const double largest = fmax(run->kinetic, exchanged);
    self->batch->kinetic[run->number] = largest;
    self->batch->energy_error[run->number] = fabs(violation);
    return fabs(violation) < fmax(ZD_LARGEST_ENERGY_ERROR * largest, ZD_ENERGY_ROUNDING * (largest + fabs(potential))) || violation == 0;
}
