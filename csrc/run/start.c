/* Checks of the start of a run: it must satisfy the constraints, the system must be consistent, and the tolerance reachable. Memory that
 * only these checks need is freed after them.
 */
#include "run.h"

#include <math.h>
#include <stdio.h>

#include "../constraints/rank.h"
#include "../linalg/small.h"
#include "../paths/path.h"
#include "../point/point.h"
#include "../step/step_loop.h"

static const double START_TOLERANCE = 1e-10;    /* violation allowed at the start relative to sizes, if the corrections' own is tighter */
static const double CONSTRAINT_ROUNDING = 0x1p-46;  /* rounding of Phi relative to the largest size: tens of roundings of its terms */
static const double NEGATIVE_MASS = 1e-12;      /* negative eigenvalue of the scaled M that may be rounding */

typedef struct workspace {
    double *Psi;        /* (m,) */
    double *factor;     /* stored as M is: its Cholesky factor, if M is positive definite */
    double *states;     /* (3, size): states for the choice of the first step */
} workspace;

typedef struct violation {  /* the largest violation relative to a constraint's size, and that constraint */
    double size;
    int row;
} violation;

static void note(violation *largest, double size, int row)
{
    if (!(size <= largest->size)) *largest = (violation){size, row};
}

/* Largest |Phi| relative to the sizes of constraints. A nearly vanishing gradient, as of links drawn in line, would magnify rounding: a
 * residual within the rounding of the largest constraint is not counted as a violation. */
static violation position_violation(const zd_point *point)
{
    const int mh = point->system->mh;
    const double rounding = CONSTRAINT_ROUNDING * zd_max_abs(mh, point->size);
    violation largest = {0, 0};
    for (int k = 0; k < mh; k++) {
        const double size = fabs(point->terms.Phi[k]);
        if (!(size < INFINITY)) return (violation){INFINITY, k};
        if (size > rounding) note(&largest, size * point->inverse_size[k], k);
    }
    return largest;
}

/* Largest |Psi|, relative to the constraint's size times the speed: the largest velocity in characteristic scales, plus one per run. */
static violation velocity_violation(const zd_run *run, const double *Psi)
{
    const zd_point *point = run->motion.point;
    const double speed = zd_max_scaled(run->motion.system.nv, point->v, point->inverse_unit) + 1 / (run->settings.t1 - run->settings.t0);
    violation largest = {0, 0};
    for (int k = 0; k < zd_constraints(&run->motion.system); k++) {
        const double size = point->size[k] * speed + (point->terms.Phi_t ? fabs(point->terms.Phi_t[k]) : 0);
        note(&largest, fabs(Psi[k]) / size, k);
    }
    return largest;
}

static double allowed_violation(const zd_run *run) { return fmax(run->motion.target.tolerance, START_TOLERANCE); }

int zd_start_measure(zd_run *run, double *largest, int *is_allowed)
{
    zd_point *point = run->motion.point;
    point->measured = 0;
    int status = zd_point_need(point, ZD_PHI | ZD_C);
    if (!status) status = zd_point_measure(point);
    *largest = status ? INFINITY : position_violation(point).size;
    *is_allowed = *largest <= allowed_violation(run);
    return status;
}

int zd_start_check(zd_run *run, double *Psi)
{
    zd_point *point = run->motion.point;
    const zd_system *system = &run->motion.system;
    const double allowed = allowed_violation(run);
    int status = zd_point_need(point, ZD_PHI | ZD_C | ZD_PHI_T);
    if (status || !zd_constraints(system)) return status;
    zd_point_velocity_violation(point, Psi);
    const violation position = position_violation(point), velocity = velocity_violation(run, Psi);
    if (position.size <= allowed && velocity.size <= allowed) return ZD_DONE;
    if (zd_first_not_finite(system, ZD_PHI | ZD_C | ZD_PHI_T, &point->terms)) return ZD_NOT_FINITE;
    char row[ZD_CONSTRAINT_NAME];
    snprintf(run->outcome.message, sizeof run->outcome.message,
             "the start violates the constraints: max |Phi| = %.3g, max |Psi| = %.3g of their sizes (allowed: %.3g), most in row %s; "
             "zd.assemble finds a consistent start nearby", position.size, velocity.size, allowed,
             zd_name_constraint(system, position.size > allowed ? position.row : velocity.row, row));
    return ZD_BAD_START;
}

/* The same with speeds of inputs that fit the velocities of the start: they jump to their inputs in the first step, or are reported. */
static int check_fitting_speeds(zd_run *run, double *Psi)
{
    int status = zd_speeds_fit(run, Psi);
    if (!status) status = zd_start_check(run, Psi);
    if (status) return status;
    run->outcome.message[0] = '\0';
    if (run->settings.inputs->jumps) return ZD_DONE;
    zd_speeds_say(run, run->outcome.message, sizeof run->outcome.message);
    return ZD_BAD_START;
}

static int check_state(zd_run *run, double *Psi)
{
    const int status = zd_start_check(run, Psi);
    return status == ZD_BAD_START && zd_inputs_have_speeds(run->settings.inputs) ? check_fitting_speeds(run, Psi) : status;
}

/* Checks that the tolerance of positions is above the rounding of Phi that follows from the rounding of p. */
static int check_tolerance(zd_run *run)
{
    const zd_constraint_target *target = &run->motion.target;
    const zd_point *point = run->motion.point;
    int n = run->motion.system.nq < run->motion.system.nv ? run->motion.system.nq : run->motion.system.nv;
    if (!target->positions || !run->motion.system.mh) return ZD_DONE;
    double reachable = 0;
    for (int k = 0; k < run->motion.system.mh; k++) {
        zd_row_of_C row = zd_point_row(point, k);
        double rounding = 0;
        for (int j = 0; j < row.count; j++)
            if (zd_column(&row, j) < n) rounding += 0x1p-53 * fabs(row.x[j] * point->p[zd_column(&row, j)]);
        reachable = fmax(reachable, rounding * point->inverse_size[k]);
    }
    if (target->tolerance > reachable) return ZD_DONE;
    snprintf(run->outcome.message, sizeof run->outcome.message,
             "tol = %.3g is below what doubles can reach here: the rounding of p alone leaves |Phi| near %.2g of its size",
             target->tolerance, reachable);
    return ZD_UNREACHABLE;
}

static double unit(const zd_point *point, int i)
{
    double M = zd_entry_of_M(point, i, i);
    return M > 0 ? sqrt(M) : 1;
}

/* factor <- M scaled to a unit diagonal (where it is positive) + sum c_k^T c_k over `rows` independent rows of C, scaled alike and
 * normalized to length one */
static void weigh(const zd_run *run, int rows, double *factor)
{
    const zd_point *point = run->motion.point;
    int n = run->motion.system.nv;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) factor[i * n + j] = zd_entry_of_M(point, i, j) / (unit(point, i) * unit(point, j));
    for (int k = 0; k < rows; k++) {
        zd_row_of_C row = zd_counted_row(point, k);
        double length = 0;
        for (int a = 0; a < row.count; a++) {
            double u = unit(point, zd_column(&row, a));
            length += row.x[a] * row.x[a] / (u * u);
        }
        for (int a = 0; a < row.count; a++)
            for (int b = 0; b < row.count; b++) {
                int i = zd_column(&row, a), j = zd_column(&row, b);
                factor[i * n + j] += row.x[a] * row.x[b] / (unit(point, i) * unit(point, j) * length);
            }
    }
}

/* Checks a singular M: it must be positive semidefinite, and x^T M x > 0 for all x != 0 with C x = 0. */
static int check_singular_mass(zd_run *run, double *factor)
{
    zd_point *point = run->motion.point;
    int n = run->motion.system.nv, status = zd_find_independent(point);
    if (status) return status;
    weigh(run, 0, factor);
    for (int i = 0; i < n; i++) factor[i * n + i] += NEGATIVE_MASS;
    point->failed_index = zd_cholesky(n, factor, factor);
    if (point->failed_index < n) return ZD_NOT_DEFINITE;
    weigh(run, point->rows, factor);
    int free = zd_cholesky(n, factor, factor);
    if (free == n) return ZD_DONE;
    snprintf(run->outcome.message, sizeof run->outcome.message, "the mass matrix is singular, and no constraint holds what has no mass "
             "(first seen at velocity %d)", free);
    return ZD_NOT_DEFINITE;
}

/* The same for a structure with many constraints: its leading matrix is definite exactly if massless motions are constrained. */
static int check_blocks(zd_run *run)
{
    const zd_point *point = run->motion.point;
    for (int i = 0; i < run->motion.system.nv; i++) {
        if (zd_entry_of_M(point, i, i) >= 0) continue;
        run->motion.point->failed_index = i;
        return ZD_NOT_DEFINITE;
    }
    const int status = zd_motion_factor(&run->motion);
    if (status == ZD_NOT_DEFINITE)
        snprintf(run->outcome.message, sizeof run->outcome.message, "the mass matrix is singular, and no constraint holds what has no mass "
                 "(first seen at velocity %d)", point->failed_index);
    return status;
}

static int check_mass(zd_run *run, double *factor)
{
    zd_point *point = run->motion.point;
    int n = run->motion.system.nv, status = zd_point_need(point, ZD_M);
    if (!status) status = zd_consistency_mass(point);
    if (status) return status;
    point->failed_index = zd_mass_factor(point, factor);
    if (point->failed_index == n) return ZD_DONE;
    if (run->motion.formulation->inverts_mass) return ZD_NOT_DEFINITE;
    if (point->rank->is_large) return check_blocks(run);
    double *dense = zd_allocate((size_t)n * n * sizeof *dense);
    status = dense ? check_singular_mass(run, dense) : ZD_NO_MEMORY;
    zd_release(dense);
    return status;
}

/* Checks that the kinematics preserve the length of unit quaternions: normalization after each step would hide an error in them. */
static int check_quaternions(zd_run *run)
{
    zd_point *point = run->motion.point;
    int velocity, status = point->system->quaternions ? zd_point_need(point, ZD_A) : ZD_DONE;
    int wrong = status ? -1 : zd_quaternion_off_unit(point, &velocity);
    if (wrong < 0) return status;
    const int first = point->system->quaternion[wrong];
    snprintf(run->outcome.message, sizeof run->outcome.message,
             "the kinematic matrix must keep the length of the unit quaternion p[%d] to p[%d], and velocity %d changes it", first,
             first + 3, velocity);
    return ZD_NOT_KEPT;
}

/* First size of adaptive steps. */
static int choose_step(zd_run *run, double *states, const double *p0, const double *v0)
{
    if (!zd_is_adaptive(&run->loop)) return ZD_DONE;
    int status = zd_adaptive_start(&run->loop, states);
    return status ? status : zd_stepper_set_state(&run->stepper, run->settings.t0, p0, v0);     /* it has evaluated other points */
}

static int check(zd_run *run, const workspace *work, const double *p0, const double *v0)
{
    zd_motion *motion = &run->motion;
    int status = !zd_suits(&motion->system, run->settings.integrator) ? ZD_UNSUITED_INTEGRATOR
               : zd_point_is_finite(motion->point) ? check_state(run, work->Psi) : ZD_NOT_FINITE;
    if (!status) status = check_quaternions(run);
    if (!status) status = check_mass(run, work->factor);
    if (!status) status = zd_consistency_jacobian(&run->safeguards.consistency, 0);
    if (!status) status = zd_point_check_domain(motion->point, 0, 0);
    if (!status) status = zd_motion_accelerate(motion);
    if (!status) status = check_tolerance(run);
    if (!status) status = zd_motion_start_energy(motion);
    if (!status && run->settings.events) status = zd_watch_start(&run->watch);
    if (!status) status = choose_step(run, work->states, p0, v0);
    return status;
}

static workspace lay_out(zd_arena *arena, const zd_run *run)
{
    const zd_motion *motion = &run->motion;
    return (workspace){
        .Psi = zd_arena_doubles(arena, zd_constraints(&motion->system)),
        .factor = zd_arena_doubles(arena, zd_size_of_M(&motion->system)),
        .states = zd_arena_doubles(arena, zd_is_adaptive(&run->loop) ? 3 * (size_t)motion->rate.size : 0),
    };
}

static int start(zd_run *run, int status, const workspace *work, const double *p0, const double *v0)
{
    if (status == ZD_BIFURCATION || status == ZD_CONTRADICTION) {       /* an inconsistent start is reported first */
        int violated = zd_start_check(run, work->Psi);
        return violated ? violated : status;
    }
    if (!status) status = zd_stepper_set_state(&run->stepper, run->settings.t0, p0, v0);
    if (!status) status = check(run, work, p0, v0);
    if (!status) status = zd_safeguards_begin(&run->safeguards, 1);
    run->motion.in_run = 1;
    return status;
}

/* True if pivots alone prove that the constraints independent at the creation of the run are independent at this start, too: those of
 * redundant constraints are much smaller than the ones that are reported. */
static int are_independent(const zd_motion *motion)
{
    return motion->point->rank->is_large && motion->statistics.smallest_pivot > ZD_REPORTED_PIVOT;
}

static int choose_step_directly(zd_run *run, double *states, const double *p0, const double *v0)
{
    if (!zd_is_adaptive(&run->loop)) return ZD_DONE;
    return zd_closed_form_choose(&run->motion) ? choose_step(run, states, p0, v0) : ZD_SINGULAR;
}

/* Checks of another start; the remaining ones are implied by large pivots. */
static int check_elsewhere(zd_run *run, const workspace *work, const double *p0, const double *v0)
{
    zd_motion *motion = &run->motion;
    int status = zd_point_is_finite(motion->point) ? zd_start_check(run, work->Psi) : ZD_NOT_FINITE;
    if (!status) status = zd_point_check_domain(motion->point, 0, 0);
    if (!status) status = check_mass(run, work->factor);
    if (!status) status = check_tolerance(run);
    if (!status) status = zd_motion_start_energy(motion);
    if (status) return status;
    if (zd_has_closed_form(motion)) return choose_step_directly(run, work->states, p0, v0);
    status = zd_motion_accelerate(motion);
    if (status || !are_independent(motion)) return ZD_SINGULAR;
    status = choose_step(run, work->states, p0, v0);
    return status ? status : zd_motion_accelerate(motion);
}

static void discard(zd_run *run, const void *data)
{
    zd_motion *motion = &run->motion;
    zd_closed_form_discard(motion);
    motion->system.data = data;
    motion->point->known = motion->point->measured = motion->in_run = 0;
    motion->balance.initial = motion->statistics.smallest_pivot = 0;
    for (int i = motion->formulation_size; i < motion->rate.size; i++) run->stepper.y[i] = 0;
}

size_t zd_run_start_memory(const zd_run *run)
{
    zd_arena arena = {0};
    lay_out(&arena, run);
    return arena.used;
}

int zd_run_start_elsewhere(zd_run *run, void *memory, const void *data, const double *p0, const double *v0)
{
    zd_arena arena = {.base = memory};
    const workspace work = lay_out(&arena, run);
    zd_point *point = run->motion.point;
    discard(run, data);
    zd_point_move(point, run->settings.t0, p0, v0);
    int status = zd_point_need(point, ZD_PHI | ZD_C | ZD_PHI_T | ZD_M | ZD_POTENTIAL);      /* all terms needed below, in one call */
    if (!status) status = zd_stepper_set_state(&run->stepper, run->settings.t0, p0, v0);
    return status ? status : check_elsewhere(run, &work, p0, v0);
}

int zd_run_start(zd_run *run, int status, const double *p0, const double *v0)
{
    zd_arena arena = {0};
    lay_out(&arena, run);
    if (!zd_arena_allocate(&arena)) return ZD_NO_MEMORY;
    const workspace work = lay_out(&arena, run);
    status = start(run, status, &work, p0, v0);
    zd_release(arena.base);
    return status;
}
