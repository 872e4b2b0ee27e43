/* A jump of speeds: the velocities nearest to the present ones in the mass metric that satisfy (5) with the new speeds,
 *
 *     v+ = v- - solve(0, Psi),        M (v+ - v-) = -C^T impulses                                 (25b)
 *
 * A moving constraint, C v = -Phi_t, does the work impulse * (Phi_t- + Phi_t+) / 2, the impulse times the mean speed. The sum of these is
 * the change of the kinetic energy, which enters the energy balance (28).
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../constraints/limits.h"
#include "../paths/path.h"
#include "../point/point.h"
#include "../safeguards/safeguards.h"
#include "run.h"

const zd_jump *zd_run_jump(const zd_run *run) { return &run->held.jump; }

int zd_jump_begin(zd_run *run)
{
    const zd_point *point = run->motion.point;
    zd_jump *jump = &run->held.jump;
    zd_closed_form_leave(&run->motion);
    const int status = zd_point_need(run->motion.point, ZD_PHI_T);
    for (int k = 0; !status && k < zd_constraints(point->system); k++) jump->works[k] = point->terms.Phi_t ? point->terms.Phi_t[k] / 2 : 0;
    zd_stepper_save_state(&run->stepper, &run->held.start);
    return status;
}

/* x, of v+ = v- - x, and the impulses */
static int project(zd_run *run)
{
    zd_motion *motion = &run->motion;
    zd_held_inputs *held = &run->held;
    zd_point *point = motion->point;
    const int m = zd_constraints(point->system);
    int status = zd_point_need(point, motion->matrices | ZD_M | ZD_PHI_T);
    if (!status) status = zd_point_need_times_C(point);
    if (!status) status = zd_motion_factor(motion);
    if (status) return status;
    zd_point_velocity_violation(point, held->rhs);
    status = zd_limits_replace(point, ZD_LIMIT_PSI, held->rhs);
    if (status) return status;
    zd_motion_solve(motion, NULL, held->rhs, held->x, point->lambda);
    zd_rank_find_multipliers(point);
    for (int k = 0; k < m; k++) held->jump.impulses[k] = -point->lambda[k];
    motion->statistics.solves++;
    motion->statistics.velocity_corrections++;
    return ZD_DONE;
}

int zd_jump_finish(zd_run *run)
{
    zd_motion *motion = &run->motion;
    zd_held_inputs *held = &run->held;
    zd_jump *jump = &held->jump;
    const double *Phi_t = motion->point->terms.Phi_t;
    motion->point->known &= motion->point->constant;
    int status = project(run);
    if (status) return status;
    double work = 0;
    for (int k = 0; k < zd_constraints(&motion->system); k++)
        work += jump->works[k] = jump->impulses[k] * (jump->works[k] + (Phi_t ? Phi_t[k] / 2 : 0));
    zd_correct_velocity(&motion->system, held->start.v, held->x, held->start.v);       /* (25b) */
    if (motion->balance.input) held->start.extra[motion->rate.size - motion->formulation_size - 1] += work;
    jump->t = run->stepper.t;
    jump->count++;
    status = zd_stepper_return_to(&run->stepper, &held->start);
    return status ? status : zd_safeguards_begin(&run->safeguards, run->loop.step + 1);
}

/* ---- speeds that fit a start ---- */

static int is_speed_of(const zd_input_slot *place, int input) { return place->is_speed && place->input == input; }

static int violation_at(zd_run *run, int input, double speed, double *Psi)
{
    const zd_inputs *inputs = run->settings.inputs;
    zd_point *point = run->motion.point;
    for (int k = 0; k < inputs->places; k++) {
        const zd_input_slot *place = inputs->place + k;
        if (!is_speed_of(place, input)) continue;
        place->place[0] = speed;
        place->place[1] = place->place[2] = 0;
    }
    zd_inputs_derive(inputs);
    point->known &= point->constant;
    int status = zd_point_need(point, ZD_C | ZD_PHI_T);
    if (!status) status = zd_point_need_times_C(point);
    if (!status) zd_point_velocity_violation(point, Psi);
    return status;
}

/* The constraint whose residual changes most by 1 of the speed, which it is linear in, is made zero. */
static int fit_speed(zd_run *run, int input, double *Psi)
{
    const int m = zd_constraints(&run->motion.system);
    double *at_zero = run->motion.point->rhs, largest = 0, speed = run->held.value[input];
    int status = violation_at(run, input, 0, at_zero);
    if (!status) status = violation_at(run, input, 1, Psi);
    for (int k = 0; !status && k < m; k++) {
        const double slope = Psi[k] - at_zero[k];
        if (!(fabs(slope) > largest)) continue;
        largest = fabs(slope);
        speed = -at_zero[k] / slope;
    }
    if (!status) status = violation_at(run, input, speed, Psi);
    run->held.value[input] = speed;
    return status;
}

void zd_speeds_say(const zd_run *run, char *to, size_t size)
{
    const zd_inputs *inputs = run->settings.inputs;
    int worst = 0;
    for (int i = 1; i < inputs->count; i++)
        if (fabs(run->held.value[i] - inputs->value[i]) > fabs(run->held.value[worst] - inputs->value[worst])) worst = i;
    snprintf(to, size, "the start violates the constraints: input %d must begin with %.9g, which fits the velocities of the start, not with "
             "%.9g", worst, run->held.value[worst], inputs->value[worst]);
    const size_t said = strlen(to);
    if (inputs->name) snprintf(to + said, size - said, "; it is '%s', and hold=True makes the difference an impulse", inputs->name[worst]);
}

int zd_speeds_fit(zd_run *run, double *Psi)
{
    const zd_inputs *inputs = run->settings.inputs;
    int status = ZD_DONE;
    for (int input = 0; !status && input < inputs->count; input++)
        for (int k = 0; !status && k < inputs->places; k++) {
            if (!is_speed_of(inputs->place + k, input)) continue;
            status = fit_speed(run, input, Psi);
            break;
        }
    return status;
}
