/* Values of user functions, and of rows and generalized forces without one, from the marker quantities at one state. */
#include <math.h>

#include "planned.h"

static int all_finite(const double *values, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(values[i])) return 0;
    return 1;
}

/* Evaluates the expressions; returns 0 if there are none, or if their values are not all finite. */
static int has_said(const zd_law_program *program, const zd_readings *at, double t, int count)
{
    if (!program->expressions) return 0;
    zd_expressions_evaluate(program->expressions, program->numbers, t, at->x, at->xdot, at->out);
    return all_finite(at->out, count);
}

static void read_terms(const zd_planned_elements *elements, const zd_readings *at, int first, int terms)
{
    for (int i = 0; i < terms; i++) {
        const int quantity = elements->term[first + i].quantity;
        at->x[i] = zd_value_of(at, quantity);
        at->xdot[i] = zd_rate_of(at, quantity);
    }
}

static int call(const zd_planned_elements *elements, const zd_readings *at, int law, double t)
{
    const int status = elements->law(elements->owner, law, t, at->x, at->xdot, at->out);
    return !status || status == ZD_NOT_FINITE ? status : ZD_CALLBACK;
}

/* out (count,) <- values of user function `law` of x and xdot. If its expressions have values that are not finite, the function is called,
 * as it reports the reason. */
static int answer(const zd_planned_elements *elements, const zd_readings *at, int law, double t, int count)
{
    if (elements->program && has_said(elements->program + law, at, t, count)) return ZD_DONE;
    return call(elements, at, law, t);
}

static int ask(const zd_planned_elements *elements, const zd_readings *at, int law, int first, int terms, double t, int count)
{
    read_terms(elements, at, first, terms);
    return answer(elements, at, law, t, count);
}

int zd_law_evaluate(const zd_planned_elements *elements, const zd_readings *at, int law, int count, const double *x, double t, double *value)
{
    for (int i = 0; i < count; i++) at->x[i] = x[i];
    const int status = answer(elements, at, law, t, 1);
    *value = at->out[0];
    return status;
}

/* ---- domain ---- */

/* Calls the function where its expressions are not defined: it reports the reason, or is defined after all. */
static int check(const zd_planned_elements *elements, const zd_readings *at, int law, int first, int terms, double rtol, double atol,
                 double t)
{
    const zd_law_program *program = elements->program + law;
    if (law < 0 || !elements->program || !program->has_ends) return ZD_DONE;
    if (!at) return zd_expressions_are_within(program->expressions, program->numbers, t) ? ZD_DONE : ZD_NOT_FINITE;
    read_terms(elements, at, first, terms);
    if (zd_expressions_are_defined(program->expressions, program->numbers, rtol, atol, t, at->x, at->xdot)) return ZD_DONE;
    return call(elements, at, law, t);
}

int zd_laws_check(const zd_planned_elements *elements, const zd_readings *at, double rtol, double atol, double t)
{
    int status = ZD_DONE;
    for (const zd_relation *row = elements->row; row < elements->row + elements->m && !status; row++)
        status = check(elements, at, row->law, row->first, row->terms, rtol, atol, t);
    for (const zd_generalized_force *force = elements->force; force < elements->force + elements->forces && !status; force++)
        if (force->kind == ZD_FORCE_LAW && !elements->reading.functions)        /* else zd_force_read() checks it */
            status = check(elements, at, force->law, force->first, force->terms, rtol, atol, t);
    return status;
}

void zd_laws_compare(const zd_planned_elements *elements, const zd_readings *at, double t, double *difference)
{
    for (const zd_generalized_force *force = elements->force; force < elements->force + elements->forces; force++) {
        const zd_law_program *program = force->kind == ZD_FORCE_LAW ? elements->program + force->law : NULL;
        if (!program || !program->differences) continue;
        read_terms(elements, at, force->first, force->terms);
        zd_expressions_evaluate(program->differences, program->numbers_of_differences, t, at->x, at->xdot,
                                difference + program->first_difference);
    }
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

int zd_force_evaluate(const zd_planned_elements *elements, const zd_readings *at, const zd_generalized_force *force, double t,
                      double *value, double *rate)
{
    const double speed = rate || force->damping != 0 ? zd_rate_of(at, force->quantity) : 0;
    int status = ZD_DONE;
    if (rate) *rate = speed;
    *value = force->value;
    if (force->kind == ZD_FORCE_LAW && elements->reading.functions) {
        *value = at->inputs ? at->inputs[force->law] : NAN;
    } else if (force->kind == ZD_FORCE_LAW) {
        status = ask(elements, at, force->law, force->first, force->terms, t, 1);
        *value = at->out[0];
    } else if (force->kind == ZD_FORCE_SPRING) {
        *value = -force->stiffness * zd_value_of(at, force->terms ? elements->term[force->first].quantity : force->quantity);
    }
    *value -= force->damping * speed;
    return status;
}

int zd_force_read(const zd_planned_elements *elements, const zd_readings *at, int law, double t, const double *r, double *u)
{
    const zd_reading *reading = &elements->reading;
    const zd_generalized_force *force = elements->force, *end = force + elements->forces;
    *u = 0;
    while (force < end && (force->kind != ZD_FORCE_LAW || force->law != law)) force++;
    if (force == end) return ZD_DONE;
    double *x = at->x + force->terms;
    for (const zd_read *read = reading->read; read < reading->read + reading->reads; read++)
        if (read->function == law) *x++ = r[read->reaction];
    const int status = ask(elements, at, law, force->first, force->terms, t, 1);
    *u = at->out[0];
    return status ? status : check(elements, at, law, force->first, force->terms, 0, 0, t);
}

int zd_forces_power(const zd_planned_elements *elements, const zd_readings *at, double t, double *power)
{
    *power = 0;
    for (const zd_generalized_force *force = elements->force; force < elements->force + elements->forces; force++) {
        double value, rate;
        if (force->kind == ZD_FORCE_SPRING) {
            if (force->damping == 0) continue;
            rate = zd_rate_of(at, force->quantity);
            value = -force->damping * rate;
        } else {
            const int status = zd_force_evaluate(elements, at, force, t, &value, &rate);
            if (status) return status;
        }
        *power += value * rate;
    }
    return ZD_DONE;
}

double zd_springs_potential(const zd_planned_elements *elements, const zd_readings *at, double V)
{
    for (const zd_generalized_force *force = elements->force; force < elements->force + elements->forces; force++) {
        if (force->kind != ZD_FORCE_SPRING || force->stiffness == 0) continue;
        const double x = zd_value_of(at, force->quantity);
        V += 0.5 * force->stiffness * x * (force->terms ? zd_value_of(at, elements->term[force->first].quantity) : x);
    }
    return V;
}
