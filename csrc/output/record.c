#include "reading.h"

#include <math.h>

#include "../constraints/rank.h"
#include "../linalg/small.h"
#include "../point/point.h"

static void copy_sample(double *table, int64_t sample, int width, const double *values)
{
    double *to = table + sample * width;
    zd_copy_few(width, values, to);
}

/* Violations of the constraints that are active, and multipliers of all. */
static int record_phase(zd_motion *motion, zd_record *record, int64_t sample)
{
    zd_point *point = motion->point;
    const zd_phase_system *phase = point->phase;
    const int mh = phase->full->mh, m = zd_constraints(phase->full);
    double *of_position = record->position_violation + sample * mh, *of_velocity = record->velocity_violation + sample * m;
    const int status = zd_constraints(point->system) ? zd_point_need_times_C(point) : ZD_DONE;
    if (status) return status;
    zd_clear(mh, of_position);
    zd_clear(m, of_velocity);
    if (zd_constraints(point->system)) zd_point_velocity_violation(point, point->rhs);
    for (int k = 0; k < zd_constraints(point->system); k++) {
        if (k < point->system->mh) of_position[phase->row[k]] = point->terms.Phi[k];            /* (3) */
        of_velocity[phase->row[k]] = point->rhs[k];                                             /* (5) */
    }
    zd_rank_find_multipliers(point);
    copy_sample(record->multipliers, sample, m, zd_point_multipliers(point));                  /* (7) */
    return ZD_DONE;
}

static int record_constraints(zd_motion *motion, zd_record *record, int64_t sample)
{
    zd_point *point = motion->point;
    const int m = zd_point_constraints(point);
    if (point->phase) return record_phase(motion, record, sample);
    if (!m) return ZD_DONE;
    int status = zd_point_need_times_C(point);
    if (status) return status;
    copy_sample(record->position_violation, sample, point->system->mh, point->terms.Phi);     /* (3) */
    zd_point_velocity_violation(point, record->velocity_violation + sample * m);            /* (5) */
    zd_rank_find_multipliers(point);
    copy_sample(record->multipliers, sample, m, point->lambda);                                /* (7) */
    return ZD_DONE;
}

static void note_energy_error(zd_tally *tally, double error)
{
    if (!(error <= tally->energy_error) && !isnan(tally->energy_error)) tally->energy_error = error;
}

static int record_energy(zd_motion *motion, zd_record *record, int64_t sample)
{
    double violation, kinetic;
    if (!zd_has_energy(&motion->system)) {
        record->kinetic[sample] = zd_point_kinetic(motion->point);
        return ZD_DONE;
    }
    int status = zd_motion_energy_violation(motion, &violation, &kinetic);
    if (status) return status;
    record->kinetic[sample] = kinetic;
    record->potential[sample] = zd_point_potential(motion->point);
    record->input[sample] = zd_motion_input(motion);
    record->energy_violation[sample] = violation;                                           /* (28) */
    note_energy_error(motion->tally, fabs(violation));
    return ZD_DONE;
}

zd_recorder zd_recorder_create(zd_arena *arena, const zd_settings *settings, zd_motion *motion)
{
    const int terms = ZD_PHI | ZD_PHI_T | ZD_M | ZD_POTENTIAL;
    zd_recorder self = {
        .motion = motion,
        .outputs = settings->outputs,
        .needs = zd_needs_no_C(&motion->system) ? terms : terms | ZD_C,
    };
    if (!self.outputs) return self;
    self.measured = self.outputs->of ? self.outputs->of : &motion->system;
    const zd_measures *measures = self.measured->measures;
    for (int i = 0; i < self.outputs->count; i++) self.width += measures->measure[self.outputs->measure[i]].size;
    self.scratch = zd_arena_doubles(arena, measures->scratch);
    return self;
}

/* Requires the accelerations and multipliers at the point. */
static int record_outputs(const zd_recorder *self, zd_record *record, int64_t sample)
{
    const zd_point *point = self->motion->point;
    zd_rank_find_multipliers(point);
    zd_measured out = {.value = record->outputs + sample * self->width, .is_least = !zd_rank_is_deficient(point)};
    return zd_measure_states(self->measured, point->terms.inputs, self->outputs->count, self->outputs->measure, 1, &point->t, point->p,
                             point->v, point->vdot, zd_point_multipliers(point), &out, self->scratch);
}

int zd_recorder_add(zd_recorder *self, zd_record *record)
{
    if (!zd_record_has_room(record)) return ZD_FULL;
    zd_motion *motion = self->motion;
    int64_t sample = record->samples;
    zd_point *point = motion->point;
    /* All terms of the sample and of the acceleration come from one evaluation. */
    int status = zd_point_need(point, self->needs | zd_motion_acceleration_terms(motion));
    if (!status) status = zd_motion_accelerate(motion);
    if (!status) status = record_constraints(motion, record, sample);
    if (!status) status = record_energy(motion, record, sample);
    if (!status && self->outputs) status = record_outputs(self, record, sample);
    if (status) return status;
    record->t[sample] = point->t;
    copy_sample(record->p, sample, point->system->nq, point->p);
    copy_sample(record->v, sample, point->system->nv, point->v);
    record->iterations[sample] = motion->tally->iterations;
    record->energy_skipped[sample] = motion->tally->energy_skipped;
    motion->tally->iterations = motion->tally->energy_skipped = 0;
    record->samples = sample + 1;
    return ZD_DONE;
}
