/* What the core refuses before it starts. People's arguments are checked in Python, by name; here it is made sure that nothing a
 * caller of zerodrift.h hands in makes the core crash or run for ever.
 */
#include "arguments.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>

#include "../point/quaternions.h"
#include "../registry.h"
#include "interface.h"

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
    const rule rules[] = {
        {!(nq >= 1 && nq <= ZD_LARGEST && nv >= 1 && nv <= ZD_LARGEST), "a system has 1 to 8192 coordinates, and as many velocities"},
        {!(mh >= 0 && mh <= ZD_LARGEST && mn >= 0 && mn <= ZD_LARGEST), "a system has at most 8192 constraints of each kind"},
        {!lacks(system, ZD_COMPLEMENT) && (double)mh + mn > nv, "a complement is for at most as many constraints as velocities"},
        {system->scratch < 0 || system->scratch > ZD_LARGEST * ZD_LARGEST, "the scratch of a system is no size"},
        {!system->evaluate || lacks(system, ZD_M), "a system has a function that evaluates it, and a mass matrix"},
        {lacks(system, ZD_A) && nq != nv, "a system without kinematic matrix has as many velocities as coordinates"},
        {mh > 0 && lacks(system, ZD_PHI), "a system with holonomic constraints provides Phi"},
        {(mh > 0 || mn > 0) && lacks(system, ZD_C | ZD_XI), "a system with constraints provides C and xi"},
        {lacks(system, ZD_COMPLEMENT) != lacks(system, ZD_GAMMA), "a complement D and gamma come together"},
    };
    return FIRST_BROKEN(rules);
}

static const char *wrong_rows(const zd_settings *settings)
{
    const rule rules[] = {
        {!zd_formulation_of(settings->formulation), "there is no such formulation"},
        {!zd_integrator_of(settings->integrator), "there is no such integrator"},
    };
    return FIRST_BROKEN(rules);
}

static int is_bad(double gain) { return !(gain >= 0 && gain < INFINITY); }

static const char *wrong_corrections(const zd_system *system, const zd_settings *settings)
{
    const zd_projection *projection = &settings->projection;
    const zd_baumgarte *baumgarte = &settings->baumgarte;
    int projects = projection->every != 0;
    const rule rules[] = {
        {projection->every < 0 || settings->energy.every < 0, "corrections are made every so many steps"},
        {projects && !(projection->tolerance > 0), "the tolerance of the position correction is greater than 0"},
        {projects && projection->max_iterations < 0, "the iterations of the position correction are at least 0"},
        {projects && projection->metric != ZD_MASS_METRIC && projection->metric != ZD_IDENTITY_METRIC, "there is no such metric"},
        {baumgarte->on && (is_bad(baumgarte->alpha) || is_bad(baumgarte->beta) || is_bad(baumgarte->integral)),
         "the gains of Baumgarte's stabilization are finite and at least 0"},
        {settings->energy.every && lacks(system, ZD_POTENTIAL), "an energy correction needs a system that provides its potential"},
    };
    return FIRST_BROKEN(rules);
}

static const char *wrong_events(const zd_events *events)
{
    if (!events) return NULL;
    const rule rules[] = {
        {events->count < 0 || events->count > ZD_LARGEST, "a run has at most 8192 events"},
        {!events->evaluate || !events->found, "events have a function that evaluates them and one that is told of them"},
        {events->count > 0 && (!events->direction || !events->terminal), "each event has a direction, and whether it is terminal"},
    };
    return FIRST_BROKEN(rules);
}

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
    int chosen = step == 0;
    const rule times[] = {
        {!isfinite(settings->t1 - settings->t0) || !(settings->t1 > settings->t0), "a run ends after it starts, both finite"},
        {!chosen && !(step >= resolved && step < INFINITY), "the step is finite, and long enough to be seen in the time"},
        {settings->t_eval && !is_increasing_within(settings->t_eval, settings->t_evals, settings->t0, settings->t1),
         "the times to save at increase, within the run"},
        {!settings->t_eval && settings->save_every < 1, "rows are saved every so many steps"},
        {chosen && !zd_integrator_of(settings->integrator)->card.error_order, "this integrator needs a step: it estimates no error"},
        {chosen && (is_bad(settings->rtol) || is_bad(settings->atol) || settings->atol == 0), "rtol and atol are finite, atol not 0"},
        {chosen && (!(settings->first_step >= 0) || !(settings->max_step >= 0)), "first_step and max_step are at least 0"},
        {settings->max_steps < 0, "max_steps is at least 0"},
    };
    const char *wrong = FIRST_BROKEN(times);
    if (wrong) return wrong;
    return zd_count_steps(settings->t0, settings->t1, step) < (double)LONG_MAX ? NULL : "there are more steps than can be counted";
}

int zd_check_system(const zd_system *system, char *message, int size)
{
    const char *wrong = wrong_system(system);
    snprintf(message, (size_t)size, "%s", wrong ? wrong : "");
    return wrong ? ZD_BAD_ARGUMENT : zd_check_interface(system, message, size);
}

int zd_check_method(const zd_system *system, const zd_settings *settings, char *message, int size)
{
    int status = zd_check_system(system, message, size);
    if (status) return status;
    const char *wrong = wrong_rows(settings);
    if (!wrong) wrong = wrong_corrections(system, settings);
    if (!wrong) wrong = wrong_events(settings->events);
    snprintf(message, (size_t)size, "%s", wrong ? wrong : "");
    return wrong ? ZD_BAD_ARGUMENT : ZD_DONE;
}

int zd_check_quaternions(const zd_system *system, const double *p, int any_length, char *message, int size)
{
    double length;
    int wrong = zd_quaternions_wrong_length(system, p, any_length, &length);
    if (wrong < 0) return ZD_DONE;
    const int first = system->quaternion[wrong];
    snprintf(message, (size_t)size, "p[%d] to p[%d] are a quaternion of length %.7g, and %s", first, first + 3, length,
             any_length ? "no rotation has that" : "that of a rotation is 1 (to 1e-06): divide it by its length");
    return ZD_BAD_START;
}

int zd_check_run(const zd_system *system, const zd_settings *settings, char *message, int size)
{
    int status = zd_check_method(system, settings, message, size);
    const char *wrong = status ? NULL : wrong_course(settings);
    if (wrong) snprintf(message, (size_t)size, "%s", wrong);
    return wrong ? ZD_BAD_ARGUMENT : status;
}
