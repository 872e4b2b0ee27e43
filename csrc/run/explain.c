/* Explanation of a failed run, in one sentence with numbers. */
#include "run.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "../constraints/rank.h"
#include "../integrators/integrator.h"
#include "../linalg/small.h"
#include "../point/point.h"

#define ON_SINGULAR "on_singular=\"continue\" takes the branch of least acceleration"

static void describe_asymmetry(const zd_point *point, char *to, size_t size)
{
    const int i = point->failed_index, j = point->failed_column;
    snprintf(to, size, "%s: M[%d, %d] = %.9g, and M[%d, %d] = %.9g", zd_sentence(ZD_NOT_SYMMETRIC), i, j, zd_entry_of_M(point, i, j),
             j, i, zd_entry_of_M(point, j, i));
}

static void describe_jacobian(const zd_run *run, char *to, size_t size)
{
    const zd_consistency *found = &run->safeguards.consistency;
    char of[48] = "Phi_t";
    if (found->column < run->motion.system.nv) snprintf(of, sizeof of, "the Jacobian, for velocity %d,", found->column);
    char row[ZD_CONSTRAINT_NAME];
    snprintf(to, size, "row %s of %s must be the derivative of the constraint: it is %.6g, and differences of the constraint give %.6g",
             zd_name_constraint(&run->motion.system, found->row, row), of, found->given, found->found);
}

/* Describes a failure of the mass matrix or the constraints; returns false for other statuses. */
static int describe_matrices(const zd_run *run, int status, const char *rows, char *to, size_t size)
{
    const zd_point *point = run->motion.point;
    const int failed_index = point->failed_index;
    char row[ZD_CONSTRAINT_NAME];
    switch (status) {
    case ZD_NOT_DEFINITE:
        snprintf(to, size, "%s (first seen at velocity %d)%s", zd_sentence(status), failed_index,
                 run->motion.formulation->inverts_mass ? ", and 'schur' inverts it; 'augmented' and 'nullspace' require only that "
                                                  "constraints determine the motion of massless parts"
                                                : "");
        break;
    case ZD_NOT_SYMMETRIC: describe_asymmetry(run->motion.point, to, size); break;
    case ZD_NOT_JACOBIAN: describe_jacobian(run, to, size); break;
    case ZD_DEPENDENT_ROWS:
        snprintf(to, size, "the constraints are dependent (row %s follows from those before it)",
                 zd_name_constraint(point->system, zd_independent_constraint(point, failed_index), row));
        break;
    case ZD_BIFURCATION:
        snprintf(to, size, "the constraints do not determine the motion here (a bifurcation: %s from the others); %s", rows,
                 run->motion.point->rank->is_large
                 ? "branches of so many constraints are not computed; start beside the bifurcation"
                 : run->settings.on_singular == ZD_STOP ? ON_SINGULAR
                 : "independent velocities require the branch of the motion, and none was found; 'schur' does not");
        break;
    case ZD_BIFURCATION_PASSED:
        snprintf(to, size, "%s; a smaller step shows which, " ON_SINGULAR, zd_sentence(status));
        break;
    case ZD_CONTRADICTION:
        snprintf(to, size, "the constraints contradict each other (%s from the others, but row %s requires another acceleration at this "
                 "velocity)", rows, zd_name_constraint(point->system, failed_index, row));
        break;
    case ZD_SINGULAR:
        snprintf(to, size, "the leading matrix of '%s' is singular (no pivot for velocity %d)", run->motion.formulation->card.name,
                 failed_index);
        break;
    default: return 0;
    }
    return 1;
}

/* Appends the cause: instability if omega h exceeded the method's limit, else `otherwise`. After an overflow omega h itself proves
 * nothing, so that `unstable` then requires several steps that were too long. */
static void add_cause(const zd_run *run, int unstable, const char *otherwise, char *to, size_t size)
{
    const zd_card *card = &run->stepper.integrator->card;
    double omega_h = zd_run_omega_h(run);
    size_t length = strlen(to);
    if (unstable && card->stability > 0 && omega_h > card->stability)
        snprintf(to + length, size - length, ": the step is too long for '%s' to be stable (omega h = %.3g, stable below %.3g); "
                 "try a smaller step, or an implicit method", card->name, omega_h, card->stability);
    else snprintf(to + length, size - length, "%s", otherwise);
}

/* Number of digits that distinguishes the two ends of the span. */
static int digits_of(double from, double to)
{
    double apart = fmax(fabs(from), fabs(to)) / (to - from);
    return (int)fmin(17, 4 + fmax(0, ceil(log10(apart))));
}

/* Cause of many steps. */
static void describe_shortness(const zd_run *run, char *to, size_t size)
{
    if (run->loop.control.is_by_move) snprintf(to, size, "max_move = %.3g sets the size of the last of them; a larger value takes "
                                               "fewer steps", run->settings.max_move);
    else snprintf(to, size, "the motion changes quickly there, %s", run->stepper.integrator->decay == 0
                  ? "for example by a force that jumps; a smooth force, or events at its jumps, takes fewer steps"
                  : "or the problem is stiff and needs an implicit method, such as 'radau'");
}

static void describe_steps(const zd_run *run, char *to, size_t size)
{
    char why[160];
    double a, b;
    describe_shortness(run, why, sizeof why);
    zd_step_histogram_half(&run->loop.control.histogram, &a, &b);
    int digits = digits_of(a, b);
    snprintf(to, size, "max_steps = %" PRId64 " steps were taken; half of the steps lie between t = %.*g and %.*g: %s; "
             "max_steps=None removes the limit", run->settings.max_steps, digits, a, digits, b, why);
}

static void describe_underflow(const zd_run *run, char *to, size_t size)
{
    const zd_settings *settings = &run->settings;
    if (run->loop.control.is_by_move) snprintf(to, size, "step size underflow: max_move = %.3g requires steps below the rounding of the time",
                                               settings->max_move);
    else snprintf(to, size, "step size underflow: rtol = %.3g, atol = %.3g require steps below the rounding of the time", settings->rtol,
                  settings->atol);
}

static void describe_collapse(const zd_run *run, char *to, size_t size)
{
    const zd_collapse *collapse = &run->loop.control.collapse;
    const double t = run->motion.point->t;
    const int digits = digits_of(collapse->t, t);
    char where[160] = "a force law jumps back immediately: on both sides of its jump it drives the motion to the jump";
    if (collapse->count)
        snprintf(where, sizeof where, "the step size has collapsed %d times between t = %.*g and %.*g, now to %.3g s", ZD_COLLAPSES, digits,
                 collapse->t, digits, t, collapse->h);
    snprintf(to, size, "%s: the rate of velocity %d jumps back and forth there, as under a friction force that jumps when its speed "
             "changes sign; a smooth force, or friction that sticks, takes fewer steps; max_steps=None continues", where,
             (int)run->motion.statistics.part);
}

static void describe_surplus(const zd_system *system, const char *formulation, char *to, size_t size)
{
    char quaternions[96] = "";
    if (system->quaternions) snprintf(quaternions, sizeof quaternions, ", besides one for each of %d unit quaternions", system->quaternions);
    snprintf(to, size, "'%s' must have as many coordinates as velocities%s, not %d and %d", formulation, quaternions, system->nq, system->nv);
}

/* Describes a method that does not apply to this system, or cannot reach the tolerance; returns false for other statuses. */
static int describe_method(const zd_run *run, int status, char *to, size_t size)
{
    const zd_system *system = &run->motion.system;
    const char *formulation = run->motion.formulation->card.name, *integrator = run->stepper.integrator->card.name;
    switch (status) {
    case ZD_NO_STEP:
        snprintf(to, size, "the equations of the implicit '%s' step were not solved; try a smaller step", integrator);
        break;
    case ZD_UNSUITED:
        describe_surplus(system, formulation, to, size);
        break;
    case ZD_UNSUITED_INTEGRATOR:
        if (zd_is_too_large(system) && !run->stepper.integrator->step_of_motion)
            snprintf(to, size, "'%s' solves its steps with dense matrices: a system that declares its structure must have at most %d "
                     "velocities, not %d", integrator, ZD_MAX_IMPLICIT, system->nv);
        else snprintf(to, size, "'%s' must have a holonomic system whose velocities are the rates of its coordinates; here there %s",
                 integrator, system->mn ? "are nonholonomic constraints" : "is a kinematic matrix");
        break;
    case ZD_TINY_STEP: describe_underflow(run, to, size); break;
    case ZD_TOO_MANY_STEPS: describe_steps(run, to, size); break;
    case ZD_COLLAPSED: describe_collapse(run, to, size); break;
    default: return 0;
    }
    return 1;
}

static void describe_reading(const zd_reactions *reactions, char *to, size_t size)
{
    snprintf(to, size, "reactions have no unique solution: %s must depend less on those that it reads; det(I - G du/dr) must be "
             "positive, and is %.3g (condition %.3g)", reactions->reading->name[reactions->strongest], reactions->determinant,
             reactions->condition);
}

static void describe_correction(const zd_run *run, const char *rows, char *to, size_t size)
{
    const zd_constraint_target *target = &run->motion.target;
    snprintf(to, size, "the position correction left max |Phi| = %.3g of its size after %d iterations, full and shortened "
             "(tolerance %.3g)%s%s%s", run->motion.point->residual_left, target->max_iterations, target->tolerance,
             *rows ? "; " : "", rows, *rows ? " from the others, and may contradict them" : "");
    add_cause(run, 1, "", to, size);
}

size_t zd_say_where(char *to, size_t size, double t, int64_t step, int64_t steps)
{
    char of_steps[32] = "";
    if (steps) snprintf(of_steps, sizeof of_steps, " of %" PRId64, steps);
    const int said = snprintf(to, size, "at t = %.9g (step %" PRId64 "%s): ", t, step, of_steps);
    return (size_t)said < size ? (size_t)said : size - 1;
}

void zd_say_event(char *to, size_t size, int event)
{
    snprintf(to, size, "ended by event %d", event);
}

static void describe_event(const zd_watch *watch, char *to, size_t size)
{
    const int event = watch->failed - 1;
    if (zd_is_known(watch->events, event)) snprintf(to, size, "event %d must have a finite value", event);
    else snprintf(to, size, "the evaluation of an event failed");
}

static void describe(const zd_run *run, int status, char *to, size_t size)
{
    const zd_point *point = run->motion.point;
    const char *failure = run->motion.system.failure;
    char rows[192] = "";
    const int are_fewer = point->rank->selection && point->rows < zd_constraints(point->system);
    if (are_fewer || point->rank->left_out) zd_rank_name_rows(point, rows, sizeof rows);
    if (describe_matrices(run, status, rows, to, size) || describe_method(run, status, to, size)) return;
    switch (status) {
    case ZD_NOT_FINITE:
        snprintf(to, size, "%s", zd_sentence(status));
        add_cause(run, run->motion.statistics.too_long > 0, "; try a smaller step or another stabilization", to, size);
        break;
    case ZD_NO_CONVERGENCE: describe_correction(run, rows, to, size); break;
    case ZD_BRANCH:
        snprintf(to, size, "%s", zd_sentence(status));
        add_cause(run, 1, "; try a smaller step", to, size);
        break;
    case ZD_NO_EMBEDDING:
        snprintf(to, size, "the independent coordinates do not determine the others here (|Phi| = %.3g is left)%s", point->residual_left,
                 point->system->quaternions ? ", or the step turns a body by more than 120 degrees" : "");
        add_cause(run, 1, "; try a smaller step", to, size);
        break;
    case ZD_CALLBACK:
        if (run->watch.failed) describe_event(&run->watch, to, size);
        else snprintf(to, size, "%s", failure ? failure : zd_sentence(status));
        break;
    case ZD_SEVERAL_MOTIONS: describe_reading(&run->motion.reactions, to, size); break;
    case ZD_EVENT: zd_say_event(to, size, run->watch.ended - 1); break;
    case ZD_BAD_TERM: snprintf(to, size, "the system's %s must be finite", zd_term_name(point->failed_index)); break;
    default: snprintf(to, size, "%s", zd_sentence(status)); break;
    }
}

/* Search for the non-finite term after a failure. Terms are not checked during a run, at no cost to it: after a failure the last step is
 * repeated with checks of every evaluation.
 */

static const double IMMENSE = 1e75;     /* larger states overflow by themselves: terms have up to their fourth power */

static int is_moderate(const zd_system *system, const double *p, const double *v)
{
    return zd_max_abs(system->nq, p) < IMMENSE && zd_max_abs(system->nv, v) < IMMENSE;
}

/* ---- a system with checked evaluations ---- */

typedef struct watched {
    zd_system system;
    int term;       /* bit of the first non-finite term of a moderate state; 0: none */
    double t;       /* s: time of that evaluation */
} watched;

static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    watched *self = (watched *)data;
    int status = self->system.evaluate(self->system.data, want, t, p, v, out);
    if (status || !is_moderate(&self->system, p, v)) return ZD_CALLBACK;
    self->term = zd_first_not_finite(&self->system, want, out);
    self->t = t;
    return self->term ? ZD_CALLBACK : ZD_DONE;
}

/* Repeats the last step from its start; returns the term found. */
static int watch_step(zd_run *run, double *t)
{
    zd_motion *motion = &run->motion;
    watched self = {.system = motion->system};
    zd_statistics statistics = motion->statistics;
    zd_stepper_return(&run->stepper);
    motion->system.evaluate = evaluate;
    motion->system.data = &self;
    motion->system.operations = NULL;
    motion->point->known = 0;
    zd_stepper_make(&run->stepper, run->stepper.last.h);
    motion->system = self.system;
    motion->statistics = statistics;
    if (self.term) *t = self.t;
    return self.term;
}

/* Bit of the non-finite term that caused a failure, and *t <- its time; 0: there is none. */
static int find_not_finite(zd_run *run, int status, double *t)
{
    const zd_point *point = run->motion.point;
    const zd_system *system = point->system;
    *t = point->t;
    int term = is_moderate(system, point->p, point->v) ? zd_first_not_finite(system, point->known, &point->terms) : 0;
    return term || status != ZD_NOT_FINITE || run->stepper.last.h == 0 ? term : watch_step(run, t);
}

/* ---- the sentence ---- */

/* True if an iteration has failed and the Jacobian is found wrong, at the present point or at the start of the step. */
static int is_for_jacobians(zd_run *run, int status)
{
    zd_consistency *consistency = &run->safeguards.consistency;
    const zd_last *last = &run->stepper.last;
    if (status != ZD_NO_CONVERGENCE && status != ZD_NO_STEP && status != ZD_NO_EMBEDDING) return 0;
    if (!consistency->compares || last->h == 0) return 0;
    if (zd_consistency_jacobian(consistency, run->loop.step) == ZD_NOT_JACOBIAN) return 1;
    zd_point_move(run->motion.point, last->t, last->p, last->v);
    return zd_consistency_jacobian(consistency, run->loop.step) == ZD_NOT_JACOBIAN;
}

/* The status to report, at *t: terms that are not finite often cause a failed factorization first; then the term is reported. */
static int cause_of(zd_run *run, int status, double *t)
{
    zd_point *point = run->motion.point;
    *t = point->t;
    if (status == ZD_CALLBACK || status == ZD_BAD_START || status == ZD_UNREACHABLE) return status;
    int finite = zd_point_is_finite(point);
    int term = find_not_finite(run, finite ? status : ZD_NOT_FINITE, t);
    if (term) point->failed_index = term;
    if (!term && finite && is_for_jacobians(run, status)) return ZD_NOT_JACOBIAN;
    return term ? ZD_BAD_TERM : finite ? status : ZD_NOT_FINITE;
}

int zd_explain(zd_run *run, int status)
{
    char what[ZD_MESSAGE - 64];
    if (run->outcome.message[0]) return status;
    double t;
    status = cause_of(run, status, &t);
    describe(run, status, what, sizeof what);
    const size_t said = zd_say_where(run->outcome.message, sizeof run->outcome.message, t, run->loop.step, run->loop.steps);
    snprintf(run->outcome.message + said, sizeof run->outcome.message - said, "%s", what);
    if (run->loop.parts && status != ZD_BIFURCATION && strlen(run->outcome.message) < sizeof run->outcome.message - 48)
        strcat(run->outcome.message, ", also when the step is divided");
    return status;
}
