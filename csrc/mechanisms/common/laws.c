/* Values of user functions, and of rows and efforts without one, from the gauges at one state. */
#include <math.h>

#include "laws.h"

static int all_finite(const double *values, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(values[i])) return 0;
    return 1;
}

/* Evaluates the compiled user function; returns 0 if there is none, or if its values are not all finite. */
static int has_said(const zd_compiled_law *compiled, const zd_readings *at, double t, int count)
{
    if (!compiled->function) return 0;
    compiled->function(compiled->numbers, t, at->x, at->xdot, at->out);
    return all_finite(at->out, count);
}

/* out (count,) <- values of user function `law`. If the compiled function has values that are not finite, the original one is called, as
 * it reports the reason. */
static int ask(const zd_planned_elements *elements, const zd_readings *at, int law, int first, int terms, double t, int count)
{
    for (int i = 0; i < terms; i++) {
        const int gauge = elements->term[first + i].gauge;
        at->x[i] = zd_value_of(at, gauge);
        at->xdot[i] = zd_rate_of(at, gauge);
    }
    if (elements->compiled && has_said(elements->compiled + law, at, t, count)) return ZD_DONE;
    return elements->law(elements->owner, law, t, at->x, at->xdot, at->out) ? ZD_CALLBACK : ZD_DONE;
}

/* Without a law: sum of factors x - constant - slope t; of a nonholonomic one with xdot in place of x. */
static zd_combined combine_linearly(const zd_planned_elements *elements, const zd_relation *row, double t)
{
    const double target = row->constant + row->slope * t, *factors = elements->coefficient + row->first;
    return row->nonholonomic ? (zd_combined){0, -target, -row->slope, factors} : (zd_combined){-target, -row->slope, 0, factors};
}

int zd_combine(const zd_planned_elements *elements, const zd_readings *at, const zd_relation *row, double t, zd_combined *all)
{
    if (row->law < 0) {
        *all = combine_linearly(elements, row, t);
        return ZD_DONE;
    }
    const int k = row->terms, status = ask(elements, at, row->law, row->first, k, t, k + 3);
    *all = (zd_combined){at->out[0], at->out[k + 1], at->out[k + 2], at->out + 1};
    return status;
}

int zd_effort_say(const zd_planned_elements *elements, const zd_readings *at, const zd_effort *effort, double t, double *value, double *rate)
{
    const double speed = rate || effort->damping != 0 ? zd_rate_of(at, effort->gauge) : 0;
    int status = ZD_DONE;
    if (rate) *rate = speed;
    *value = effort->value;
    if (effort->kind == ZD_EFFORT_LAW) {
        status = ask(elements, at, effort->law, effort->first, effort->terms, t, 1);
        *value = at->out[0];
    } else if (effort->kind == ZD_EFFORT_SPRING) {
        *value = -effort->stiffness * zd_value_of(at, effort->gauge) - effort->damping * speed;
    }
    return status;
}

int zd_efforts_power(const zd_planned_elements *elements, const zd_readings *at, double t, double *power)
{
    *power = 0;
    for (const zd_effort *effort = elements->effort; effort < elements->effort + elements->efforts; effort++) {
        double value, rate;
        if (effort->kind == ZD_EFFORT_SPRING) {
            if (effort->damping == 0) continue;
            rate = zd_rate_of(at, effort->gauge);
            value = -effort->damping * rate;
        } else if (zd_effort_say(elements, at, effort, t, &value, &rate)) {
            return ZD_CALLBACK;
        }
        *power += value * rate;
    }
    return ZD_DONE;
}

double zd_springs_potential(const zd_planned_elements *elements, const zd_readings *at, double V)
{
    for (const zd_effort *effort = elements->effort; effort < elements->effort + elements->efforts; effort++) {
        if (effort->kind != ZD_EFFORT_SPRING || effort->stiffness == 0) continue;
        const double x = zd_value_of(at, effort->gauge);
        V += 0.5 * effort->stiffness * x * x;
    }
    return V;
}
