/* Consistency of a system during a run: M of (2) must be symmetric, and C and Phi_t of (5) must be the derivatives of Phi.
 *
 * Both are checked at intervals, M whenever its value is available. Derivatives are compared only if they are written by hand; those
 * derived symbolically cannot be wrong. Each check uses another direction (s, w) of time and velocities:
 *
 *     C w + Phi_t s = (Phi(t + e s, p + e A w) - Phi(t - e s, p - e A w)) / 2e + O(e^2).
 *
 * If this fails, the error is reported only if other difference quotients, one-sided and with other e, agree with the first: the
 * quotients of a Phi with kinks or coarse rounding prove nothing.
 */
#include "safeguards.h"

#include <math.h>
#include <stdint.h>

#include "../linalg/small.h"
#include "../point/point.h"

static const double ASYMMETRY_OF_M = 1e-12;  /* |M_ij - M_ji| allowed, relative to the largest entry of M */
static const double ASYMMETRY_OF_ENTRY = 1e-9;  /* the same, relative to sqrt(M_ii M_jj), the bound of |M_ij|; either tolerance suffices */
static const double OFFSET = 0x1p-17;       /* e, in characteristic scales */
static const double WRONG = 1e-3;           /* error reported, relative to the size of a constraint; Jacobians by differences are closer */
static const double AGREEMENT = 0.1;        /* difference allowed between quotients that agree, relative to the error found */
enum { COMPARE_EVERY = 64 };                /* steps between checks of C; also checked after 0, 1, 2, 4, 8 ... steps */

/* ---- M ---- */

static int is_symmetric(const zd_point *point, int i, int j)
{
    double off = fabs(zd_entry_of_M(point, i, j) - zd_entry_of_M(point, j, i));
    return off <= ASYMMETRY_OF_M * zd_max_abs(zd_size_of_M(point->system), point->terms.M)
        || off <= ASYMMETRY_OF_ENTRY * sqrt(fabs(zd_entry_of_M(point, i, i) * zd_entry_of_M(point, j, j)));
}

int zd_consistency_mass(zd_point *point)
{
    const int n = point->system->nv;
    for (int i = 0; i < n; i++)
        for (int j = zd_first_in_M(point, i); j < i; j++) {
            if (zd_entry_of_M(point, i, j) == zd_entry_of_M(point, j, i) || is_symmetric(point, i, j)) continue;
            point->failed_index = i;
            point->failed_column = j;
            return ZD_NOT_SYMMETRIC;
        }
    return ZD_DONE;
}

/* ---- C and Phi_t ---- */

zd_consistency zd_consistency_create(zd_arena *arena, zd_motion *motion, const zd_settings *settings)
{
    const zd_system *system = &motion->system;
    size_t nq = system->nq, nv = system->nv, mh = system->mh;
    if (!settings->given_jacobian || !mh) return (zd_consistency){.motion = motion, .compares = 0};
    return (zd_consistency){
        .motion = motion,
        .compares = 1,
        .slowest = 1 / (settings->t1 - settings->t0),
        .direction = zd_arena_doubles(arena, nv + 1),
        .pdot = zd_arena_doubles(arena, nq),
        .p = zd_arena_doubles(arena, nq),
        .scratch = zd_arena_doubles(arena, system->scratch),
        .Phi = zd_arena_doubles(arena, mh),
        .quotient = zd_arena_doubles(arena, mh),
        .central = zd_arena_doubles(arena, mh),
    };
}

/* Entry of a fixed pseudo-random sequence in [-1, 1). */
static double scattered(uint64_t place)
{
    uint64_t bits = (place + 1) * UINT64_C(0x9E3779B97F4A7C15);
    bits = (bits ^ (bits >> 29)) * UINT64_C(0xBF58476D1CE4E5B9);
    return (double)(bits >> 11) * 0x1p-52 - 1;
}

/* Characteristic scale of direction i: velocity i, or time for i = nv. In these scales all directions have equal weight. */
static double unit(const zd_consistency *self, int i)
{
    return i < self->motion->system.nv ? self->motion->point->unit[i] : self->of_time;
}

/* self->Phi <- Phi at the point displaced by e times the direction; the point itself is not changed. */
static int evaluate(zd_consistency *self, double e)
{
    const zd_point *point = self->motion->point;
    zd_terms terms = point->terms;
    terms.Phi = self->Phi;
    terms.scratch = self->scratch;
    for (int i = 0; i < self->motion->system.nq; i++) self->p[i] = point->p[i] + e * self->pdot[i];
    self->motion->statistics.evaluations++;
    double t = point->t + e * self->direction[self->motion->system.nv];
    return self->motion->system.evaluate(self->motion->system.data, ZD_PHI | ZD_MOVED, t, self->p, point->v, &terms) ? ZD_CALLBACK : ZD_DONE;
}

/* quotient <- (Phi at b - Phi at a) / (b - a), along the direction */
static int differentiate(zd_consistency *self, double a, double b)
{
    int status = evaluate(self, a);
    if (status) return status;
    for (int k = 0; k < self->motion->system.mh; k++) self->quotient[k] = -self->Phi[k];
    status = evaluate(self, b);
    for (int k = 0; k < self->motion->system.mh; k++) self->quotient[k] = (self->quotient[k] + self->Phi[k]) / (b - a);
    return status;
}

static double entry(const zd_consistency *self, int k, int i)
{
    const zd_terms *terms = &self->motion->point->terms;
    if (i == self->motion->system.nv) return terms->Phi_t ? terms->Phi_t[k] : 0;
    zd_row_of_C row = zd_point_row(self->motion->point, k);
    if (!row.column) return row.x[i];
    for (int j = 0; j < row.count; j++)
        if (row.column[j] == i) return row.x[j];
    return 0;
}

/* Adds the term of one Jacobian entry to the directional derivative; *size <- the largest |entry * characteristic scale|. */
static void add_given(const zd_consistency *self, int i, double x, double *sum, double *size)
{
    *sum += x * self->direction[i];
    *size = fmax(*size, fabs(x) * unit(self, i));
}

/* Directional derivative C w + Phi_t s of constraint k by the given Jacobian; *size <- its size, at least the constraint's own. */
static double given(const zd_consistency *self, int k, double *size)
{
    const int n = self->motion->system.nv;
    zd_row_of_C row = zd_point_row(self->motion->point, k);
    double sum = 0;
    *size = self->motion->point->size[k];
    for (int j = 0; j < row.count; j++) add_given(self, zd_column(&row, j), row.x[j], &sum, size);
    add_given(self, n, entry(self, k, n), &sum, size);
    return sum;
}

/* pdot <- A w, the rates of the coordinates in the direction. (1) */
static void set_rates(zd_consistency *self)
{
    zd_point_rate(self->motion->point, self->direction, self->pdot);
}

/* True if difference quotients with other ends agree with this one, which differs by `off` from the given derivative. */
static int is_sure(zd_consistency *self, int k, double quotient, double off, int *status)
{
    static const double ends[][2] = {{0, OFFSET}, {-OFFSET, 0}, {0, OFFSET / 16}, {-OFFSET / 16, 0}, {-16 * OFFSET, 16 * OFFSET}};
    for (size_t i = 0; i < sizeof ends / sizeof ends[0]; i++) {
        *status = differentiate(self, ends[i][0], ends[i][1]);
        if (*status || !(fabs(self->quotient[k] - quotient) <= AGREEMENT * fabs(off))) return 0;
    }
    return 1;
}

/* Finds the entry of constraint k with the largest error, for the message. */
static int name_entry(zd_consistency *self, int k)
{
    double worst = 0;
    for (int i = 0; i <= self->motion->system.nv; i++) {
        for (int j = 0; j <= self->motion->system.nv; j++) self->direction[j] = j == i ? unit(self, i) : 0;
        set_rates(self);
        int status = differentiate(self, -OFFSET, OFFSET);
        if (status) return status;
        double off = fabs(self->quotient[k] - entry(self, k, i) * unit(self, i));
        if (!(off > worst)) continue;
        worst = off;
        self->row = k;
        self->column = i;
        self->given = entry(self, k, i);
        self->found = self->quotient[k] / unit(self, i);
    }
    return ZD_NOT_JACOBIAN;
}

int zd_consistency_jacobian(zd_consistency *self, int64_t step)
{
    if (!self->compares) return ZD_DONE;
    int n = self->motion->system.nv, status = zd_point_need(self->motion->point, ZD_A | ZD_C | ZD_PHI_T);
    if (status) return status;
    self->of_time = 1 / (zd_max_scaled(n, self->motion->point->v, self->motion->point->inverse_unit) + self->slowest);
    for (int i = 0; i <= n; i++) self->direction[i] = unit(self, i) * scattered((uint64_t)step * (uint64_t)(n + 1) + (uint64_t)i);
    set_rates(self);
    status = differentiate(self, -OFFSET, OFFSET);
    zd_copy_all(self->motion->system.mh, self->quotient, self->central);
    for (int k = 0; !status && k < self->motion->system.mh; k++) {
        double size, quotient = self->central[k], off = given(self, k, &size) - quotient;
        if (fabs(off) > WRONG * fmax(size, fabs(quotient)) && is_sure(self, k, quotient, off, &status)) status = name_entry(self, k);
    }
    return status;
}

/* ---- after a step ---- */

int zd_consistency_check(zd_consistency *self, int64_t step)
{
    int status = (self->motion->point->known & ZD_M) ? zd_consistency_mass(self->motion->point) : ZD_DONE;
    if (status || !self->compares) return status;
    int due = step % COMPARE_EVERY == 0 || (step & (step - 1)) == 0;
    return due ? zd_consistency_jacobian(self, step) : ZD_DONE;
}
