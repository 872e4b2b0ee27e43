/* Checks of arguments before a run starts. Users' arguments are checked in Python, by name; these checks ensure that no arguments passed
 * through zerodrift.h make the core crash or run forever.
 */
#include "checks.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>

#include "../../output/reading.h"
#include "../../point/point.h"
#include "../../registry.h"

typedef struct rule {
    int broken;
    const char *sentence;
} rule;

static const char *first_broken(const rule *rules, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (rules[i].broken) return rules[i].sentence;
    return NULL;
}

#define FIRST_BROKEN(rules) first_broken(rules, sizeof(rules) / sizeof(rules)[0])

static int lacks(const zd_system *system, int terms) { return (system->provides & terms) != terms; }

static const char *wrong_system(const zd_system *system)
{
    int nq = system->nq, nv = system->nv, mh = system->mh, mn = system->mn;
    const int largest = system->structure ? ZD_LARGEST_PACKED : ZD_LARGEST;
    const rule rules[] = {
        {!(nq >= 1 && nq <= largest && nv >= 1 && nv <= largest), "a system must have 1 to 8192 coordinates and velocities; up to 1048576 "
         "if it declares its structure"},
        {!(mh >= 0 && mh <= largest && mn >= 0 && mn <= largest), "a system must have at most 8192 constraints of each kind; 1048576 if it "
         "declares its structure"},
        {!lacks(system, ZD_COMPLEMENT) && (double)mh + mn > nv, "a system with a complement D must not have more constraints "
         "than velocities"},
        {system->scratch < 0 || system->scratch > ZD_LARGEST * ZD_LARGEST, "the scratch of a system must be 0 to 8192^2 doubles"},
        {!system->evaluate || lacks(system, ZD_M), "a system must have evaluate() and provide M"},
        {lacks(system, ZD_A) && nq != nv, "a system without kinematic matrix must have as many velocities as coordinates"},
        {mh > 0 && lacks(system, ZD_PHI), "a system with holonomic constraints must provide Phi"},
        {(mh > 0 || mn > 0) && lacks(system, ZD_C | ZD_XI), "a system with constraints must provide C and xi"},
        {lacks(system, ZD_COMPLEMENT) != lacks(system, ZD_GAMMA), "a system must provide both the complement D and gamma, or neither"},
    };
    return FIRST_BROKEN(rules);
}

static const char *wrong_rows(const zd_settings *settings)
{
    const rule rules[] = {
        {!zd_formulation_of(settings->formulation), "there is no such formulation"},
        {!zd_integrator_of(settings->integrator), "there is no such integrator"},
        {!zd_processor_has(settings->vector), "this processor does not have the vector unit"},
    };
    return FIRST_BROKEN(rules);
}

static int refuse(const char *wrong, char *message, int size)
{
    snprintf(message, size, "%s", wrong ? wrong : "");
    return wrong ? ZD_BAD_ARGUMENT : ZD_DONE;
}

/* The first term that the correction requires and the system does not provide; NULL: none. */
static const zd_term_entry *lacking(const zd_system *system, const zd_correction *correction)
{
    for (int row = 0; zd_term_at(row); row++)
        if (correction->requires & zd_term_at(row)->term & ~system->provides) return zd_term_at(row);
    return NULL;
}

static int check_correction(const zd_system *system, int row, const zd_parameter_values *given, char *message, int size)
{
    const zd_correction *correction = zd_correction_of(row);
    const zd_term_entry *lacks = lacking(system, correction);
    if (!lacks) return zd_check_parameter_values(ZD_CORRECTIONS, row, given, message, size);
    snprintf(message, size, "%s correction needs %s (%s)", correction->card.name, lacks->name, lacks->text);
    return ZD_BAD_ARGUMENT;
}

/* Parameters of the chosen formulation, integrator and corrections. */
static int check_given(const zd_system *system, const zd_settings *settings, char *message, int size)
{
    int status = zd_check_parameter_values(ZD_FORMULATIONS, settings->formulation, &settings->of_formulation, message, size);
    if (!status) status = zd_check_parameter_values(ZD_INTEGRATORS, settings->integrator, &settings->of_integrator, message, size);
    for (int row = 0; row < zd_entry_count(ZD_CORRECTIONS) && !status; row++)
        if (settings->correction[row].given) status = check_correction(system, row, &settings->correction[row], message, size);
    return status;
}

static int are_alike(const zd_system *one, const zd_system *other)
{
    return one->nq == other->nq && one->nv == other->nv && one->mh == other->mh && one->mn == other->mn;
}

static int switches_exist(const zd_system *system, int input)
{
    const int group = ZD_SWITCHES - input;
    return group >= 0 && group < system->groups && system->group[group].kind == ZD_TWO_SIDED;
}

static int actions_exist(const zd_system *system, const zd_events *events, const zd_inputs *inputs)
{
    int do_exist = 1, count = inputs ? inputs->count : 0;
    for (int i = 0; i < events->actions; i++) {
        const zd_action *action = events->action + i;
        do_exist &= action->event >= 0 && action->event < events->count && action->input < count
                    && (action->input >= ZD_CALLER_ACTS || switches_exist(system, action->input));
    }
    return do_exist;
}

static const char *wrong_events(const zd_system *system, const zd_events *events, const zd_inputs *inputs)
{
    if (!events) return NULL;
    const rule rules[] = {
        {events->count < 0 || events->count > ZD_LARGEST, "a run must have at most 8192 events"},
        {events->count > 0 && (!events->direction || !events->terminal), "events must have the arrays direction and terminal"},
        {events->of && !are_alike(events->of, system),
         "events must read measures of a system with the same numbers of coordinates, velocities and constraints"},
        {!events->evaluate && !events->known, "events must have the function evaluate(), or be known to the core"},
        {!actions_exist(system, events, inputs), "actions must be at existing events, and set existing inputs or joints"},
    };
    const char *wrong = FIRST_BROKEN(rules);
    return wrong ? wrong : zd_wrong_readings(events, system);
}

static const char *wrong_outputs(const zd_system *system, const zd_outputs *outputs)
{
    if (!outputs) return NULL;
    const zd_system *of = outputs->of ? outputs->of : system;
    const zd_measures *measures = of->measures;
    if (!are_alike(of, system))
        return "outputs must be measures of a system with the same numbers of coordinates, velocities and constraints";
    if (!measures || outputs->count < 1 || outputs->count > ZD_LARGEST || !outputs->measure) return "outputs must be 1 to 8192 measures";
    for (int i = 0; i < outputs->count; i++)
        if (outputs->measure[i] < 0 || outputs->measure[i] >= measures->count) return "every output must be the index of a measure";
    return NULL;
}

static int is_bad(double tolerance) { return !(tolerance >= 0 && tolerance < INFINITY); }

static double latest(const zd_settings *settings) { return fmax(fabs(settings->t0), fabs(settings->t1)); }

static int is_increasing_within(const double *t, int64_t count, double t0, double t1)
{
    for (int64_t i = 0; i < count; i++)
        if (!(t[i] >= (i ? nextafter(t[i - 1], INFINITY) : t0) && t[i] <= t1)) return 0;
    return count > 0;
}

static const char *wrong_course(const zd_settings *settings)
{
    double step = settings->step, resolved = 16 * 0x1p-52 * latest(settings);
    const int adaptive = settings->steps == ZD_ADAPTIVE_STEPS;
    const rule times[] = {
        {!isfinite(settings->t1 - settings->t0) || !(settings->t1 > settings->t0), "t1 must be after t0, both finite"},
        {settings->steps != ZD_FIXED_STEPS && !adaptive, "steps must be fixed or adaptive"},
        {!adaptive && !(step >= resolved && step < INFINITY), "step must be finite, and at least 16 times the rounding error of the time"},
        {settings->t_eval && !is_increasing_within(settings->t_eval, settings->t_evals, settings->t0, settings->t1),
         "t_eval must increase, from t0 to t1"},
        {!settings->t_eval && settings->save_every < 1, "save_every must be at least 1"},
        {adaptive && !zd_integrator_of(settings->integrator)->card.error_order,
         "this integrator must be given a step: it estimates no error"},
        {adaptive && (is_bad(settings->rtol) || is_bad(settings->atol) || settings->rtol > 1 || settings->atol == 0),
         "rtol and atol must be finite, rtol at most 1, atol positive"},
        {adaptive && (!(settings->first_step >= 0) || !(settings->max_step >= 0)), "first_step and max_step must be at least 0"},
        {adaptive && !(settings->max_move >= 0), "max_move must be at least 0"},
        {settings->max_steps < 0, "max_steps must be at least 0"},
    };
    const char *wrong = FIRST_BROKEN(times);
    if (wrong) return wrong;
    return adaptive || zd_count_steps(settings->t0, settings->t1, step) < (double)INT64_MAX ? NULL : "the number of steps must be below 2^63";
}

int zd_check_system(const zd_system *system, char *message, int size)
{
    const char *wrong = wrong_system(system);
    snprintf(message, size, "%s", wrong ? wrong : "");
    return wrong ? ZD_BAD_ARGUMENT : zd_check_interface(system, message, size);
}

/* A Taylor series of the motion is that with unstabilized constraints. */
int zd_check_methods_agree(const zd_settings *settings, char *message, int size)
{
    const zd_integrator *integrator = zd_integrator_of(settings->integrator);
    const size_t room = size;
    int said = 0;
    if (!integrator || !integrator->takes_series) return ZD_DONE;
    for (int row = 0; row < zd_entry_count(ZD_CORRECTIONS) && !said; row++)
        if (settings->correction[row].given && zd_correction_of(row)->stabilize)
            said = snprintf(message, room, "'%s' must be run without '%s', which changes the constraints of its series; 'projection' does "
                            "not", integrator->card.name, zd_correction_of(row)->card.name);
    return said ? ZD_UNSUITED_INTEGRATOR : ZD_DONE;
}

static int check_series(const zd_system *system, const zd_settings *settings, char *message, int size)
{
    const zd_integrator *integrator = zd_integrator_of(settings->integrator);
    if (!integrator->takes_series || system->series) return zd_check_methods_agree(settings, message, size);
    snprintf(message, size, "'%s' must have a system that provides Taylor series, as compiled ones of expressions do",
             integrator->card.name);
    return ZD_UNSUITED_INTEGRATOR;
}

static int check_reactions(const zd_system *system, const zd_settings *settings, char *message, int size)
{
    const zd_integrator *integrator = zd_integrator_of(settings->integrator);
    if (!system->reading || zd_evaluates_accelerations(integrator)) return ZD_DONE;
    snprintf(message, size, "'%s' must have forces that depend on t, positions and velocities only, and a user function reads a reaction or "
             "an acceleration; explicit methods, 'trapezoidal' and 'radau' accept it", integrator->card.name);
    return ZD_UNSUITED_INTEGRATOR;
}

int zd_check_method(const zd_system *system, const zd_settings *settings, char *message, int size)
{
    int status = zd_check_system(system, message, size);
    if (!status) status = refuse(wrong_rows(settings), message, size);
    if (!status) status = check_given(system, settings, message, size);
    if (!status) status = check_reactions(system, settings, message, size);
    if (!status) status = check_series(system, settings, message, size);
    const zd_formulation *formulation = status ? NULL : zd_formulation_of(settings->formulation);
    if (!status && zd_is_too_large(system) && zd_rank_is_of_many(system) && !zd_has_many_constraints(formulation, system)) {
        snprintf(message, size, "'%s' uses dense matrices for a system with a kinematic matrix, which must have at most %d "
                 "velocities, not %d; the cost of 'schur', 'augmented', 'nullspace' and 'mixed' is "
                 "proportional to the number of bodies", formulation->card.name, ZD_MAX_IMPLICIT, system->nv);
        return ZD_UNSUITED;
    }
    return status ? status : refuse(wrong_events(system, settings->events, settings->inputs), message, size);
}

int zd_check_quaternions(const zd_system *system, const double *p, int any_length, char *message, int size)
{
    double length;
    int wrong = zd_quaternions_wrong_length(system, p, any_length, &length);
    if (wrong < 0) return ZD_DONE;
    const int first = system->quaternion[wrong];
    snprintf(message, size, "p[%d] to p[%d] must be a quaternion of %s, not %.7g%s", first, first + 3,
             any_length ? "positive length" : "length 1 (to 1e-06)", length, any_length ? "" : ": divide it by its length");
    return ZD_BAD_START;
}

int zd_check_run(const zd_system *system, const zd_settings *settings, char *message, int size)
{
    int status = zd_check_method(system, settings, message, size);
    const char *wrong = status ? NULL : wrong_course(settings);
    if (!wrong && !status) wrong = wrong_outputs(system, settings->outputs);
    if (wrong) snprintf(message, size, "%s", wrong);
    return wrong ? ZD_BAD_ARGUMENT : status;
}
