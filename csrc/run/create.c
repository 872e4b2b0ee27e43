/* A run from its creation to its end: all its memory, and the checks of its start. */
#include <stdio.h>

#include "../core.h"
#include "../linalg/small.h"
#include "../constraints/rank.h"
#include "../registry.h"

static const double START_TOLERANCE = 1e-10;    /* violation allowed at the start, in natural units, if the corrections' own is tighter */
static const double SYMMETRY_TOLERANCE = 1e-12;     /* of the largest entry of M */
static const double NEGATIVE_MASS = 1e-12;      /* of that on the diagonal, is rounding */

/* ---- memory ---- */

static int enable_corrections(zd_run *run, zd_arena *arena, int size)
{
    for (int row = 0; row < zd_rows(ZD_CORRECTIONS); row++) {
        const zd_correction *correction = zd_correction_of(row);
        if (!correction->enabled(&run->settings)) continue;
        int extra = correction->extra_size ? correction->extra_size(&run->system, &run->settings) : 0;
        void *self = correction->take(arena, &run->system, &run->settings);
        run->active[run->corrections++] = (zd_active){correction, self, size, extra};
        run->acceleration_needs |= correction->needs;
        size += extra;
    }
    return size;
}

static zd_control take_control(zd_arena *arena, size_t size)
{
    return (zd_control){
        .scale = zd_take_doubles(arena, size),
        .y1 = zd_take_doubles(arena, size),
        .f0 = zd_take_doubles(arena, size),
        .f1 = zd_take_doubles(arena, size),
    };
}

static zd_place take_place(zd_arena *arena, const zd_system *system, size_t extras)
{
    return (zd_place){
        .p = zd_take_doubles(arena, (size_t)system->nq),
        .v = zd_take_doubles(arena, (size_t)system->nv),
        .extra = zd_take_doubles(arena, extras),
    };
}

static zd_watch take_watch(zd_arena *arena, size_t events)
{
    return (zd_watch){
        .before = zd_take_doubles(arena, events),
        .now = zd_take_doubles(arena, events),
        .time = zd_take_doubles(arena, events),
        .found = zd_take(arena, events * sizeof(int)),
    };
}

/* Lays out everything a run has; `independent` has the system's sizes with as many constraints as count. Done twice: with an empty
 * arena to learn the size, then for good. */
static zd_run *take_run(zd_arena *arena, const zd_system *system, const zd_settings *settings, const zd_system *independent)
{
    zd_run *here = zd_take(arena, sizeof *here);
    if (here) here->system = *system;       /* the point refers to it */
    zd_run run = {
        .settings = *settings,
        .system = *system,
        .formulation = zd_formulation_of(settings->formulation),
        .integrator = zd_integrator_of(settings->integrator),
        .acceleration_needs = ZD_M | ZD_C | ZD_BIAS | ZD_FORCE | ZD_XI,
    };
    run.own_size = run.formulation->state_size(independent);
    int size = enable_corrections(&run, arena, run.own_size);
    run.extras = size - run.own_size;
    if (zd_has_input(system)) {
        run.acceleration_needs |= ZD_POWER | ZD_PHI_T;
        size++;
    }
    run.violates = run.formulation->violates;
    run.solver = run.formulation->take(arena, independent);
    const zd_system *its = here ? &here->system : system;
    run.stepper = run.integrator->take(arena, run.integrator->table, its, size);
    run.point = zd_point_take(arena, its, here ? &here->statistics : NULL);
    run.state = run.y = zd_take_doubles(arena, (size_t)size);
    run.Psi = zd_take_doubles(arena, (size_t)zd_constraints(system));
    run.factor = zd_take_doubles(arena, (size_t)(system->nv * system->nv));
    run.rate = (zd_rate){zd_run_rate, here, size};
    run.last.y = zd_take_doubles(arena, (size_t)size);
    run.last.p = zd_take_doubles(arena, (size_t)system->nq);
    run.last.v = zd_take_doubles(arena, (size_t)system->nv);
    run.guard = zd_guard_take(&run, arena);
    run.crossing = zd_crossing_take(arena, system);
    if (!(settings->step > 0)) run.control = take_control(arena, (size_t)size);
    run.whole = take_place(arena, system, (size_t)(size - run.own_size));
    if (settings->events) run.watch = take_watch(arena, (size_t)settings->events->count);
    if (settings->t_eval || settings->events) {
        run.output.before = take_place(arena, system, (size_t)(size - run.own_size));
        run.output.after = take_place(arena, system, (size_t)(size - run.own_size));
    }
    if (here) {
        *here = run;
        here->input = zd_has_input(system) ? here->y + size - 1 : &here->no_input;
    }
    return here;
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* The system with so many constraints and no more. What it brings itself is for all of them, and for where all of them count. */
static zd_system with_rows(const zd_system *system, enum zd_on_singular on_singular, int rows, int holonomic)
{
    if (rows == zd_constraints(system) && on_singular == ZD_STOP) return *system;
    zd_system independent = *system;
    independent.mh = holonomic;
    independent.mn = rows - holonomic;
    independent.provides &= ~ZD_COMPLEMENT;
    independent.embed = NULL;
    return independent;
}

static zd_run *lay_out(const zd_system *system, const zd_settings *settings, int rows, int holonomic, char *message, int size)
{
    zd_system independent = with_rows(system, settings->on_singular, rows, holonomic);
    zd_arena counting = {NULL, 0};
    take_run(&counting, system, settings, &independent);
    zd_arena arena = {zd_allocate(counting.used), 0};
    if (arena.base) return take_run(&arena, system, settings, &independent);
    snprintf(message, (size_t)size, "there is no memory for this: %.3g MiB", (double)counting.used / 0x1p20);
    return NULL;
}

/* Laid out as if all constraints counted; and where some turn out to be redundant, again for those that are not. */
zd_run *zd_run_open(const zd_system *system, const zd_settings *settings, double t, const double *p, const double *v, int *status,
                    char *message, int size)
{
    int rows = least(zd_constraints(system), system->nv), holonomic = least(system->mh, rows);
    for (;;) {
        zd_run *run = lay_out(system, settings, rows, holonomic, message, size);
        *status = run ? ZD_DONE : ZD_NO_MEMORY;
        if (!run) return NULL;
        run->t = t;
        zd_point_move(run->point, t, p, v);
        *status = zd_point_measure(run->point);
        if (!*status) *status = zd_rank_start(run->point, settings);
        const zd_rank *rank = run->point->rank;
        int laid = rows, laid_holonomic = holonomic;
        run->statistics.rank = rows = least(rank->limit, system->nv);
        holonomic = least(rank->holonomic_limit, rows);
        if (*status || (rows == laid && holonomic == laid_holonomic)) return run;
        zd_run_free(run);
    }
}

void zd_run_free(zd_run *run)
{
    zd_release(run);    /* it stands first in its own arena */
}

/* ---- the start ---- */

int zd_run_place(zd_run *run, double t, const double *p, const double *v)
{
    run->t = t;
    zd_point_move(run->point, t, p, v);
    int status = zd_point_measure(run->point);
    return status ? status : run->formulation->leave(run->solver, run->point, run->y);
}

/* Largest |Psi|, in units of what the fastest velocity makes of its row, or what would move over the whole run by a row's size. */
static double velocity_violation(const zd_run *run)
{
    const zd_point *point = run->point;
    double speed = zd_max_scaled(run->system.nv, point->v, point->per_unit) + 1 / (run->settings.t1 - run->settings.t0);
    double largest = 0;
    for (int k = 0; k < zd_constraints(&run->system); k++) {
        double size = point->size[k] * speed + (point->terms.Phi_t ? fabs(point->terms.Phi_t[k]) : 0);
        largest = fmax(largest, fabs(run->Psi[k]) / size);
    }
    return largest;
}

/* Refuses a violation of the constraints beyond the tolerance. */
static int check_constraints(zd_run *run)
{
    zd_point *point = run->point;
    int mh = run->system.mh, m = zd_constraints(&run->system);
    double allowed = fmax(run->settings.projection.tolerance, START_TOLERANCE);
    int status = zd_point_need(point, ZD_PHI | ZD_C | ZD_PHI_T);
    if (status || !m) return status;
    zd_point_velocity_violation(point, run->Psi);
    double position = mh ? zd_point_violation(point) : 0, velocity = velocity_violation(run);
    if (position <= allowed && velocity <= allowed) return ZD_DONE;
    if (zd_first_not_finite(&run->system, ZD_PHI | ZD_C | ZD_PHI_T, &point->terms)) return ZD_NOT_FINITE;
    snprintf(run->message, sizeof run->message,
             "the start violates the constraints: max |Phi| = %.3g, max |Psi| = %.3g of their sizes (allowed: %.3g); "
             "zd.assemble finds a consistent start nearby", position, velocity, allowed);
    return ZD_BAD_START;
}

/* Refuses a tolerance that the rounding of p alone keeps Phi from reaching. */
static int check_tolerance(zd_run *run)
{
    const zd_projection *projection = &run->settings.projection;
    const zd_point *point = run->point;
    int n = run->system.nq < run->system.nv ? run->system.nq : run->system.nv;
    if (!projection->every || !projection->positions || !run->system.mh) return ZD_DONE;
    double reachable = 0;
    for (int k = 0; k < run->system.mh; k++) {
        double rounding = 0;
        for (int i = 0; i < n; i++) rounding += 0x1p-53 * fabs(point->terms.C[k * run->system.nv + i] * point->p[i]);
        reachable = fmax(reachable, rounding * point->per_size[k]);
    }
    if (projection->tolerance > reachable) return ZD_DONE;
    snprintf(run->message, sizeof run->message,
             "tol = %.3g is below what doubles can reach here: the rounding of p alone leaves |Phi| near %.2g of its size",
             projection->tolerance, reachable);
    return ZD_UNREACHABLE;
}

static int check_symmetry(zd_point *point)
{
    int n = point->system->nv;
    const double *M = point->terms.M;
    double largest = zd_max_abs(n * n, M);
    for (int i = 0; i < n; i++)
        for (int j = 0; j < i; j++) {
            point->culprit = i;
            if (!(fabs(M[i * n + j] - M[j * n + i]) <= SYMMETRY_TOLERANCE * largest)) return ZD_NOT_SYMMETRIC;
        }
    return ZD_DONE;
}

static double unit(int n, const double *M, int i)
{
    return M[i * n + i] > 0 ? sqrt(M[i * n + i]) : 1;
}

/* factor <- M in units that make its diagonal one where there is any mass, + the sum of `rows` rows of C in these units, each of length
 * one, times itself */
static void weigh(const zd_run *run, int rows, double *factor)
{
    int n = run->system.nv;
    const double *M = run->point->terms.M;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) factor[i * n + j] = M[i * n + j] / (unit(n, M, i) * unit(n, M, j));
    for (int k = 0; k < rows; k++) {
        const double *c = run->point->C + k * n;
        double length = 0;
        for (int i = 0; i < n; i++) length += c[i] * c[i] / (unit(n, M, i) * unit(n, M, i));
        for (int i = 0; i < n; i++)
            for (int j = 0; j < n; j++) factor[i * n + j] += c[i] * c[j] / (unit(n, M, i) * unit(n, M, j) * length);
    }
}

/* M may be singular where constraints hold what has no mass: x^T M x > 0 for all other x that C x = 0 allows, and never negative. */
static int check_mass(zd_run *run)
{
    zd_point *point = run->point;
    int n = run->system.nv, status = zd_point_need(point, ZD_M);
    if (!status) status = check_symmetry(point);
    if (status) return status;
    double *factor = run->factor;
    point->culprit = zd_cholesky(n, point->terms.M, factor);
    if (point->culprit == n) return ZD_DONE;
    if (run->formulation->inverts_mass) return ZD_NOT_DEFINITE;
    status = zd_rank_find(point);
    if (status) return status;
    weigh(run, 0, factor);
    for (int i = 0; i < n; i++) factor[i * n + i] += NEGATIVE_MASS;
    point->culprit = zd_cholesky(n, factor, factor);
    if (point->culprit < n) return ZD_NOT_DEFINITE;
    weigh(run, point->rows, factor);
    int free = zd_cholesky(n, factor, factor);
    if (free == n) return ZD_DONE;
    snprintf(run->message, sizeof run->message, "the mass matrix is singular, and no constraint holds what has no mass "
             "(first seen at velocity %d)", free);
    return ZD_NOT_DEFINITE;
}

int zd_run_start_energy(zd_run *run)
{
    double kinetic;
    if (!zd_has_energy(&run->system)) return ZD_DONE;
    return zd_run_energy_violation(run, &run->energy0, &kinetic);    /* E0 of (28), as it stands at 0 */
}

static int start(zd_run *run, const double *p0, const double *v0)
{
    int status = !zd_suits(&run->system, run->settings.integrator) ? ZD_UNSUITED_INTEGRATOR
               : zd_point_is_finite(run->point) ? check_constraints(run) : ZD_NOT_FINITE;
    if (!status) status = check_mass(run);
    if (!status) status = zd_run_accelerate(run);
    if (!status) status = check_tolerance(run);
    if (!status) status = zd_run_start_energy(run);
    if (!status && run->settings.events) status = zd_events_start(run);
    if (!status && !(run->settings.step > 0)) {
        status = zd_control_start(run);
        if (!status) status = zd_run_place(run, run->settings.t0, p0, v0);  /* wherever that has looked */
    }
    return status ? status : zd_guard_begin(run);
}

static zd_run *refuse(zd_run *run, int why, int *status, char *message, int size)
{
    *status = zd_explain(run, why);
    snprintf(message, (size_t)size, "%s", run->message);
    zd_run_free(run);
    return NULL;
}

zd_run *zd_run_create(const zd_system *system, const zd_settings *settings, const double *p0, const double *v0,
                      int *status, char *message, int message_size)
{
    *status = zd_check_run(system, settings, message, message_size);
    if (*status) return NULL;
    int why;
    zd_run *run = zd_run_open(system, settings, settings->t0, p0, v0, &why, message, message_size);
    *status = why;
    if (!run) return NULL;
    run->steps = (long)zd_count_steps(settings->t0, settings->t1, settings->step);
    if (why == ZD_BIFURCATION || why == ZD_CONTRADICTION) {     /* of a start that is none */
        int violated = check_constraints(run);
        why = violated ? violated : why;
    }
    if (!why) why = zd_run_place(run, settings->t0, p0, v0);
    if (!why) why = start(run, p0, v0);
    return why ? refuse(run, why, status, message, message_size) : run;
}

/* ---- time ---- */

double zd_count_steps(double t0, double t1, double step)
{
    if (!(step > 0)) return 0;
    double ratio = (t1 - t0) / step, whole = round(ratio);
    return fabs(ratio - whole) <= 1e-9 * whole ? whole : ceil(ratio);
}

/* Never accumulated, so that slicing a run changes nothing. */
double zd_run_time(const zd_run *run, long step)
{
    return step == run->steps ? run->settings.t1 : run->settings.t0 + (double)step * run->settings.step;
}

double zd_run_progress(const zd_run *run)
{
    double span = run->settings.t1 - run->settings.t0;
    return span > 0 ? (run->t - run->settings.t0) / span : 1;
}

const char *zd_run_message(const zd_run *run) { return run->message; }
const zd_statistics *zd_run_statistics(const zd_run *run) { return &run->statistics; }
int zd_run_redundant(const zd_run *run, int *rows) { return zd_rank_redundant(run->point->rank, rows); }
const double *zd_run_sizes(const zd_run *run) { return run->point->size; }
