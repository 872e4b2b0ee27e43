/* Whether a step can be believed, from what is known at both of its ends anyway.
 *
 * Its displacement has to be that of its velocities: a correction that goes to another assembly branch moves p where they do not
 * lead, and the velocities found there lead elsewhere again. With all of it in natural units,
 *
 *     |p1 - p0 - h (pdot0 + pdot1) / 2|^2  <=  ASTRAY^2 h^2 (|pdot0|^2 + |pdot1|^2) / 2.
 *
 * The left side is of order h^6 as long as steps resolve the motion. Methods of order one miss that mean where velocities change a
 * lot, as they do near rest; so where it fails, the nearest of all means of the two velocities decides.
 *
 * And it has to be short enough for the method: where the fastest part of the motion outgrows all others, as in an instability it
 * does, vdot1 - vdot0 = -omega^2 (p1 - p0) shows its omega. A look now and then is enough, and costs less: until there is suspicion.
 */
#include "../core.h"
#include "../linalg/small.h"

static const double ASTRAY = 0.5;
static const double NEARBY = 1e-8;      /* detours this small, in natural units, are rounding and tolerances */
static const double LONG = 0.25;        /* steps, in natural units, that may turn a constraint noticeably */
static const double RESOLVED = 2;       /* omega h of a motion that steps show somehow: a turn is a bit more than three of them */
enum {
    STREAK = 3,             /* steps looked at in succession: a single one may have come to where p1 - p0 happens to vanish */
    LOOK_EVERY = 8,
};

zd_guard zd_guard_take(const zd_run *run, zd_arena *arena)
{
    const zd_system *system = &run->system;
    const zd_settings *settings = &run->settings;
    const zd_projection *projection = &settings->projection;
    int held = !(run->violates & ZD_PHI) || (projection->every && projection->positions);
    int own = (system->provides & ZD_A) != 0;
    double least = NEARBY + 4 * projection->tolerance, limit = run->integrator->card.stability;
    return (zd_guard){
        .branch = system->mh && held,
        .stability = settings->step > 0,
        .astray = 0.5 * pow(ASTRAY * fmax(1, projection->every), 2),
        .nearby = least * least,
        .limit = pow(limit > 0 ? limit : RESOLVED, 4),
        .pdot = own ? zd_take_doubles(arena, (size_t)system->nq) : run->last.v,
        .rate = own ? zd_take_doubles(arena, (size_t)system->nq) : run->point ? run->point->v : NULL,
        .p = zd_take_doubles(arena, (size_t)system->nq),
        .v = zd_take_doubles(arena, (size_t)system->nv),
        .C = zd_take_doubles(arena, (size_t)(system->mh * system->nv)),
        .vdot = zd_take_doubles(arena, (size_t)system->nv),
    };
}

typedef struct sums {       /* of squares, in natural units */
    double moved, detour, speed;
} sums;

ZD_INLINE sums compare(const int n, const zd_guard *guard, const double *p0, const double *p, double h, const double *per_unit)
{
    sums sum = {0, 0, 0};
    for (int i = 0; i < n; i++) {
        double moved = (p[i] - p0[i]) * per_unit[i], rate = guard->rate[i] * per_unit[i];
        double detour = moved - 0.5 * h * (guard->pdot[i] * per_unit[i] + rate);
        sum.moved += moved * moved;
        sum.detour += detour * detour;
        sum.speed += rate * rate;
    }
    return sum;
}

/* The squared distance of p1 - p0 from h (1 - s) pdot0 + h s pdot1, at the nearest s of 0 ... 1 */
static double least_detour(const zd_run *run, double h)
{
    const zd_guard *guard = &run->guard;
    const double *per_unit = run->point->per_unit_p;
    double rest = 0, along = 0, turn = 0;
    for (int i = 0; i < run->system.nq; i++) {
        double a = (run->point->p[i] - run->last.p[i] - h * guard->pdot[i]) * per_unit[i];
        double b = h * (guard->rate[i] - guard->pdot[i]) * per_unit[i];
        rest += a * a, along += a * b, turn += b * b;
    }
    double s = turn > 0 ? fmin(1, fmax(0, along / turn)) : 0;
    return rest - 2 * s * along + s * s * turn;
}

/* Whether a row of C, in natural units, has turned by more than 60 degrees or so. Only asked of long steps: it moves the point. */
static int is_unresolved(zd_run *run, int *status)
{
    zd_point *point = run->point;
    zd_guard *guard = &run->guard;
    int nq = run->system.nq, nv = run->system.nv, unresolved = 0;
    const double t = point->t;
    memcpy(guard->p, point->p, (size_t)nq * sizeof(double));
    memcpy(guard->v, point->v, (size_t)nv * sizeof(double));
    *status = zd_point_need(point, ZD_C);
    if (*status) return 0;
    memcpy(guard->C, point->terms.C, (size_t)(run->system.mh * nv) * sizeof(double));
    zd_point_move(point, run->last.t, run->last.p, run->last.v);
    *status = zd_point_need(point, ZD_C);
    for (int k = 0; !*status && k < run->system.mh; k++) {
        double turned = 0, before = 0, after = 0;
        for (int i = 0; i < nv; i++) {
            double a = point->terms.C[k * nv + i] * point->unit[i], b = guard->C[k * nv + i] * point->unit[i];
            turned += (b - a) * (b - a), before += a * a, after += b * b;
        }
        unresolved |= !(turned <= fmax(before, after));
    }
    zd_point_move(point, t, guard->p, guard->v);
    return unresolved;
}

ZD_INLINE double squared_difference(const int n, const double *a, const double *b, const double *per_unit)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += ((a[i] - b[i]) * per_unit[i]) * ((a[i] - b[i]) * per_unit[i]);
    return sum;
}

static void see_energy(zd_run *run)
{
    double kinetic = (run->point->known & ZD_M) ? zd_point_kinetic(run->point) : 0;
    run->guard.kinetic = fmax(run->guard.kinetic, kinetic);
}

ZD_INLINE void estimate_omega(zd_run *run, double moved, double h)
{
    zd_guard *guard = &run->guard;
    const zd_point *point = run->point;
    double changed = ZD_SIZED(squared_difference, run->system.nv, point->vdot, guard->vdot, point->per_unit);
    double power = h * h * h * h * changed;                 /* (omega h)^4 moved; a division would cost as much as all of this */
    if (!(moved > 0)) return;
    if (power > guard->fourth * moved && power < INFINITY) guard->fourth = power / moved;
    guard->streak = power > guard->limit * moved ? guard->streak + 1 : 0;
    if (guard->streak >= STREAK) run->statistics.too_long += guard->streak == STREAK ? STREAK : 1;
}

static int is_looked_at(const zd_run *run, long step)
{
    return run->guard.stability && (step <= LOOK_EVERY || step % LOOK_EVERY == 0 || run->guard.streak);
}

ZD_INLINE int look(zd_run *run)
{
    int status = zd_point_need(run->point, ZD_A);
    if (!status && (run->guard.looking || is_looked_at(run, run->step + 1))) status = zd_run_accelerate(run);   /* the next step begins with it */
    if (!status && run->point->terms.A) zd_point_rate(run->point, run->point->v, run->guard.rate);
    return status;
}

ZD_INLINE void keep(zd_run *run, double speed)
{
    zd_guard *guard = &run->guard;
    if (run->point->terms.A) zd_copy(run->system.nq, guard->rate, guard->pdot);
    guard->looking = is_looked_at(run, run->step + 1);
    if (guard->looking) ZD_SIZED(zd_copy, run->system.nv, run->point->vdot, guard->vdot);
    guard->speed = speed;
    guard->kept = 1;
}

int zd_guard_begin(zd_run *run)
{
    int status = look(run);
    if (status) return status;
    keep(run, ZD_SIZED(compare, run->system.nq, &run->guard, run->last.p, run->point->p, 0, run->point->per_unit_p).speed);
    return zd_crossing_begin(run);
}

int zd_guard_step(zd_run *run, double h)
{
    const zd_guard *guard = &run->guard;
    if (!guard->kept || run->output.between) return ZD_DONE;
    int status = look(run);
    if (status) return status;
    const sums sum = ZD_SIZED(compare, run->system.nq, guard, run->last.p, run->point->p, h, run->point->per_unit_p);
    double allowed = guard->astray * h * h * (guard->speed + sum.speed) + guard->nearby;
    if (guard->branch && !(sum.detour <= allowed) && !(least_detour(run, h) <= allowed)) return ZD_BRANCH;
    if (guard->branch && !(sum.moved <= LONG * LONG)) {
        int unresolved = is_unresolved(run, &status);
        if (status || unresolved) return status ? status : ZD_BRANCH;
        status = look(run);
        if (status) return status;
    }
    status = zd_crossing_step(run, h, sum.moved);
    if (status) return status;
    if (guard->looking && !run->parts) {        /* parts may be given up yet */
        estimate_omega(run, sum.moved, h);
        if (zd_has_energy(&run->system)) see_energy(run);
    }
    keep(run, sum.speed);
    return ZD_DONE;
}

double zd_run_omega_h(const zd_run *run)
{
    return sqrt(sqrt(run->guard.fourth));
}

double zd_run_kinetic(const zd_run *run)
{
    return run->guard.kinetic;
}
