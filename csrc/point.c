/* A point of the motion. Whoever moves it clears what the move made stale; whoever needs a term gets it computed once.
 * So the leading matrix of a velocity correction serves the first stage of the next step, and the multipliers that are
 * recorded cost nothing where that stage needs them anyway. Comparing values instead of trusting flags keeps this right
 * whatever integrator or correction is plugged in.
 */
#include "core.h"

zd_point *zd_point_take(zd_arena *arena, const zd_system *system, zd_statistics *statistics)
{
    size_t nq = (size_t)system->nq, nv = (size_t)system->nv, m = (size_t)zd_constraints(system);
    int has = system->provides;
#define TAKE(term, count) ((has & (term)) ? zd_take_doubles(arena, (count)) : NULL)
    zd_point point = {
        .system = system,
        .statistics = statistics,
        .p = zd_take_doubles(arena, nq),
        .v = zd_take_doubles(arena, nv),
        .terms = {
            .A = TAKE(ZD_A, nq * nv),
            .M = TAKE(ZD_M, nv * nv),
            .d = TAKE(ZD_BIAS, nv),
            .f = TAKE(ZD_FORCE, nv),
            .Phi = TAKE(ZD_PHI, (size_t)system->mh),
            .C = TAKE(ZD_C, m * nv),
            .Phi_t = TAKE(ZD_PHI_T, m),
            .xi = TAKE(ZD_XI, m),
            .V = TAKE(ZD_POTENTIAL, 1),
            .power = TAKE(ZD_POWER, 1),
            .D = TAKE(ZD_COMPLEMENT, nv * (nv - m)),
            .gamma = TAKE(ZD_GAMMA, nv),
            .scratch = zd_take_doubles(arena, (size_t)system->scratch),
        },
        .vdot = zd_take_doubles(arena, nv),
        .lambda = zd_take_doubles(arena, m),
        .force = zd_take_doubles(arena, nv),
        .rhs = zd_take_doubles(arena, m),
    };
#undef TAKE
    return zd_take_filled(arena, &point, sizeof point);
}

static int same(int n, const double *a, const double *b)
{
    for (int i = 0; i < n; i++)
        if (!(a[i] == b[i])) return 0;
    return 1;
}

void zd_point_move(zd_point *point, double t, const double *p, const double *v)
{
    int nq = point->system->nq;
    if (!(t == point->t) || !same(nq, p, point->p)) {
        memcpy(point->p, p, (size_t)nq * sizeof *p);
        point->t = t;
        point->known = 0;
    }
    zd_point_move_velocity(point, v);
}

void zd_point_move_velocity(zd_point *point, const double *v)
{
    int nv = point->system->nv;
    if (same(nv, v, point->v)) return;
    memcpy(point->v, v, (size_t)nv * sizeof *v);
    point->known &= ~ZD_OF_VELOCITY;
}

int zd_point_need_missing(zd_point *point, int missing)
{
    int moved = ~point->known & ZD_MOVED;
    const zd_system *system = point->system;
    point->statistics->evaluations++;
    int status = system->evaluate(system->data, missing | moved, point->t, point->p, point->v, &point->terms);
    if (status == ZD_DONE) point->known |= missing | moved;
    return status;
}

void zd_point_force(const zd_point *point, double *force)
{
    int nv = point->system->nv;
    const double *f = point->terms.f, *d = point->terms.d;
    for (int i = 0; i < nv; i++) force[i] = (f ? f[i] : 0) - (d ? d[i] : 0);
}

void zd_point_velocity_violation(const zd_point *point, double *Psi)
{
    int m = zd_constraints(point->system), nv = point->system->nv;
    const double *C = point->terms.C, *Phi_t = point->terms.Phi_t;
    for (int k = 0; k < m; k++) {
        double sum = Phi_t ? Phi_t[k] : 0;
        for (int i = 0; i < nv; i++) sum += C[k * nv + i] * point->v[i];    /* (5) */
        Psi[k] = sum;
    }
}

void zd_point_rate(const zd_point *point, const double *v, double *pdot)
{
    int nq = point->system->nq, nv = point->system->nv;
    const double *A = point->terms.A;
    if (!A) {
        memcpy(pdot, v, (size_t)nq * sizeof *v);
        return;
    }
    for (int i = 0; i < nq; i++) {
        double sum = 0;
        for (int j = 0; j < nv; j++) sum += A[i * nv + j] * v[j];           /* (1) */
        pdot[i] = sum;
    }
}

double zd_point_kinetic(const zd_point *point)
{
    int nv = point->system->nv;
    const double *M = point->terms.M, *v = point->v;
    double sum = 0;
    for (int i = 0; i < nv; i++) {
        double row = 0;
        for (int j = 0; j < nv; j++) row += M[i * nv + j] * v[j];
        sum += v[i] * row;
    }
    return 0.5 * sum;
}

double zd_point_potential(const zd_point *point)
{
    return point->terms.V ? *point->terms.V : 0;
}

double zd_max_abs(int n, const double *x)
{
    double largest = 0;
    for (int i = 0; i < n; i++) {
        double size = fabs(x[i]);
        if (!(size <= largest)) largest = isnan(size) ? INFINITY : size;
    }
    return largest;
}

int zd_all_finite(const double *x, int count)
{
    return isfinite(zd_max_abs(count, x));
}
