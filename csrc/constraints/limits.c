/* Limits, along the motion, of the constraints that become dependent at a bifurcation.
 *
 * If the row C_d becomes linearly dependent, C_d = T C_r, its remainder w = C_d - T C_r vanishes, but not its rate along the motion: the
 * velocity is that of a branch, and the nearer the motion comes along this branch, the better w aligns with wdot. With phi = Phi_d - T
 * Phi_r, T constant, all derivatives of phi along the motion vanish, as everywhere; since w does, too, the second derivative contains no
 * acceleration, and the third no jerk:
 *
 *     c(v) := wdot v + ... = T xi_r - xi_d = 0,        so v + dv is on the branch if  wdot dv = -c(v) / 2
 *     3 wdot vdot = d/dt (xi_d - T xi_r)  at this v
 *
 * The factors 1/2 and 3 come from the derivatives of a function of p and t, so that only holonomic constraints have such limits. With
 * wdot in place of w there are as many independent constraints as elsewhere, and every formulation works as it does elsewhere: it finds
 * the accelerations that the motion has before and after. Only lambda_d has no limit, as it grows beyond bounds, and is left out.
 *
 * At a distance s from the bifurcation, along the path, w differs from s wdot by terms of order s^2. A rounding error e of Phi moves p
 * by e / s and turns the velocity by e / s^2, so that both can be found with w almost down to the bifurcation. Accelerations err by e /
 * s^3 with w, and by s with its limit; so the limit is better within the fourth root of the rounding. If w is not aligned with wdot
 * there, the mechanism only comes near a bifurcation.
 *
 * Rates are found by differences over a short path, and are taken per unit of path (characteristic scales) rather than of time.
 */
#include "limits.h"

#include <math.h>
#include <string.h>

#include "../linalg/dense.h"
#include "../linalg/small.h"
#include "../point/point.h"

enum { MAX_ITERATIONS = 100, MAX_STALLS = 8 };    /* iteration for the acceleration from rest */

static const double PATH = 0x1p-17;     /* path of differences, characteristic scales: their errors, PATH^2 and rounding / PATH, are equal */
static const double MIN_RATE = 0x1p-22;    /* rate of a row per unit of path, relative to its size: a smaller one may be rounding */
static const double SETTLED = 0x1p-36;  /* relative change of an acceleration with which it has converged to that of a branch */
static const double FALLING = 0.99;     /* ratio to the smallest change so far: a larger change is a stall */
static const double PARALLEL = 0x1p-10; /* the largest sine of the angle between w and wdot on a branch */

zd_limits *zd_limits_create(zd_arena *arena, const zd_system *system)
{
    size_t nq = system->nq, n = system->nv, m = zd_constraints(system);
    zd_limits self = {
        .distance = zd_arena_doubles(arena, m),
        .p = zd_arena_doubles(arena, nq),
        .v = zd_arena_doubles(arena, n),
        .pdot = zd_arena_doubles(arena, nq),
        .moved = zd_arena_doubles(arena, nq),
        .Cdot = zd_arena_doubles(arena, m * n),
        .xidot = zd_arena_doubles(arena, m),
        .T = zd_arena_doubles(arena, m * m),
        .K_rate = zd_arena_doubles(arena, m * m),
        .w = zd_arena_doubles(arena, m * n),
        .wdot = zd_arena_doubles(arena, m * n),
        .e = zd_arena_doubles(arena, n),
        .x = zd_arena_doubles(arena, n),
        .force = zd_arena_doubles(arena, n),
        .K = zd_arena_doubles(arena, (n + m) * (n + m)),
        .y = zd_arena_doubles(arena, n + m),
        .order = zd_arena_ints(arena, (n + m)),
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

/* Adds `weight` times C and xi, evaluated `s` further along the motion, to Cdot and xidot. */
static int add_ahead(zd_point *point, double s, double weight)
{
    zd_limits *self = point->rank->selection->limits;
    const int m = point->rank->m;
    for (int i = 0; i < point->system->nq; i++) self->moved[i] = self->p[i] + s * self->pdot[i];
    zd_point_move(point, self->t + (self->is_at_rest ? 0 : s), self->moved, self->v);
    int status = zd_point_need(point, ZD_C | ZD_XI);
    if (status) return status;
    zd_add_C(point, weight, self->Cdot);
    zd_add_scaled(m, self->xidot, weight, point->terms.xi);
    return ZD_DONE;
}

/* Cdot and the acceleration-free part of xidot, per unit of path. The point is restored. */
static int differentiate(zd_point *point)
{
    zd_limits *self = point->rank->selection->limits;
    const size_t nq = point->system->nq, n = point->rank->n, m = point->rank->m;
    const int known = point->known;
    memcpy(self->p, point->p, nq * sizeof(double));
    memcpy(self->v, point->v, n * sizeof(double));
    memset(self->Cdot, 0, m * n * sizeof(double));
    memset(self->xidot, 0, m * sizeof(double));
    self->t = point->t;
    double s = PATH / self->speed;
    int status = add_ahead(point, s, 0.5 / PATH);
    if (!status) status = add_ahead(point, -s, -0.5 / PATH);
    zd_point_move(point, self->t, self->p, self->v);
    return status ? status : zd_point_need(point, known);
}

/* x <- remainder of x, a gradient of this constraint in characteristic scales, after the independent rows are projected out; share
 * (independent,) <- its coefficients in these. */
static void split(const zd_point *point, int row, double *x, double *share)
{
    const zd_selection *self = point->rank->selection;
    int n = self->n, rank = self->independent;
    for (int a = 0; a < rank; a++) {
        share[a] = zd_dot(n, x, self->Q + a * n);
        zd_add_scaled(n, x, -share[a], self->Q + a * n);
    }
    for (int a = rank - 1; a >= 0; a--) {
        for (int b = a + 1; b < rank; b++) share[a] -= share[b] * self->R[b * self->m + a];
        share[a] /= self->R[a * self->m + a];
    }
    for (int a = 0; a < rank; a++) share[a] *= point->inverse_size[self->row[a]] * point->size[row];
}

/* Sets w = C_d - T C_r and wdot - K C_r of all dependent holonomic constraints, the latter also in Q after the basis. */
static void set_rates(const zd_point *point)
{
    zd_selection *self = point->rank->selection;
    const zd_limits *limits = self->limits;
    int n = self->n, m = self->m;
    zd_rank_set_basis(point);
    for (int d = self->independent; d < m; d++) {
        int row = self->row[d];
        double *w = limits->w + row * n, *wdot = limits->wdot + row * n;
        zd_clear(n, wdot);
        if (row < self->mh) {
            zd_row_of_C own = zd_point_row(point, row);
            zd_row_expand(&own, n, w);
            zd_rank_scale(point, row, w);
            split(point, row, w, limits->T + row * m);
            for (int i = 0; i < n; i++) wdot[i] = zd_limits_own_part(self, row, limits->Cdot + i, n);
            zd_rank_scale(point, row, wdot);
            split(point, row, wdot, limits->K_rate + row * m);
        }
        zd_copy(n, wdot, self->Q + d * n);
    }
}

/* Moves the constraint whose rate has the largest residual to the front of the dependent ones; returns 0 if it is below MIN_RATE. */
static int choose_next(zd_selection *self, int chosen)
{
    int n = self->n, best = -1;
    double most = MIN_RATE * MIN_RATE;
    for (int d = chosen; d < self->m; d++) {
        double left = zd_dot(n, self->Q + d * n, self->Q + d * n);
        if (left > most) best = d, most = left;
    }
    if (best < 0) return 0;
    int row = self->row[best];
    self->row[best] = self->row[chosen];
    self->row[chosen] = row;
    double *q = self->Q + chosen * n, *other = self->Q + best * n;
    for (int i = 0; i < n; i++) {
        double swapped = other[i];
        other[i] = q[i];
        q[i] = swapped / sqrt(most);
    }
    for (int d = chosen + 1; d < self->m; d++) zd_add_scaled(n, self->Q + d * n, -zd_dot(n, q, self->Q + d * n), q);
    return 1;
}

/* Path length to the bifurcation of this lost constraint, from w = s wdot; infinite if w is resolved but not aligned with wdot. */
static double distance(const zd_selection *self, int row)
{
    const double *w = self->limits->w + row * self->n, *wdot = self->limits->wdot + row * self->n;
    double own = zd_dot(self->n, w, w), along = zd_dot(self->n, w, wdot), rate = zd_dot(self->n, wdot, wdot);
    double across = own - along / rate * along;
    int resolved = own > ZD_RANK_TOLERANCE * ZD_RANK_TOLERANCE;
    return resolved && !(across <= PARALLEL * PARALLEL * own) ? INFINITY : along / rate;
}

static double limit(const zd_point *point, int row, int i)
{
    const zd_selection *self = point->rank->selection;
    return self->limits->wdot[row * self->n + i] * point->inverse_unit[i] * point->size[row];
}

static double of_limit(const zd_point *point, int row, const double *x)
{
    double sum = 0;
    for (int i = 0; i < point->rank->n; i++) sum += limit(point, row, i) * x[i];
    return sum;
}

/* Inserts the limits into C, after its holonomic rows. */
static void insert(zd_point *point, int wanted)
{
    zd_selection *self = point->rank->selection;
    int n = self->n, before = point->holonomic, behind = self->independent - before;
    memmove(self->C + (before + wanted) * n, self->C + before * n, behind * n * sizeof(double));
    memmove(self->row_at + before + wanted, self->row_at + before, behind * sizeof(int));
    for (int j = 0; j < wanted; j++) {
        int row = self->row_at[before + j] = self->row[self->independent + j];
        for (int i = 0; i < n; i++) self->C[(before + j) * n + i] = limit(point, row, i);
    }
    self->rank->lost = wanted;
    point->rows += wanted;
    point->holonomic += wanted;
}

/* Finds w and wdot along pdot and selects `wanted` constraints with independent rates; *found = 0 if there are fewer. */
static int find_rates(zd_point *point, int wanted, int *found)
{
    zd_selection *self = point->rank->selection;
    *found = 0;
    self->limits->speed = zd_max_scaled(point->system->nq, self->limits->pdot, point->inverse_unit_p);
    if (!(self->limits->speed > 0 && self->limits->speed < INFINITY)) return ZD_DONE;
    int status = differentiate(point);
    if (status) return status;
    set_rates(point);
    for (int j = 0; j < wanted; j++)
        if (!choose_next(self, self->independent + j)) return ZD_DONE;
    *found = 1;
    return ZD_DONE;
}

/* ---- at rest ---- */

/* Solves M x + C^T lambda = force, C x = rhs, with the independent constraints and `wanted` limits, in characteristic scales, M relative
 * to its largest entry. Returns 0 if the matrix is singular. */
static int solve(zd_point *point, int wanted, const double *force, const double *rhs, double *x)
{
    zd_selection *self = point->rank->selection;
    const int n = self->n, rows = self->independent + wanted, size = n + rows;
    double *K = self->limits->K, *y = self->limits->y, largest = 0;
    zd_clear(size * size, K);
    for (int i = 0; i < n; i++) largest = fmax(largest, fabs(zd_entry_of_M(point, i, i)) * point->unit[i] * point->unit[i]);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) K[i * size + j] = zd_entry_of_M(point, i, j) * point->unit[i] * point->unit[j] / largest;
        y[i] = force ? force[i] * point->unit[i] / largest : 0;
    }
    for (int a = 0; a < rows; a++) {
        int row = self->row[a];
        zd_row_of_C own = zd_point_row(point, row);
        if (a >= self->independent) own = (zd_row_of_C){self->limits->wdot + row * n, n, NULL};
        for (int j = 0; j < own.count; j++) {
            int i = zd_column(&own, j);
            K[(n + a) * size + i] = K[i * size + n + a] =
                a < self->independent ? own.x[j] * point->unit[i] * point->inverse_size[row] : own.x[j];
        }
        y[n + a] = rhs[a] * point->inverse_size[row];
    }
    if (zd_lu_factor(size, K, self->limits->order) < size) return 0;
    zd_lu_solve(size, K, self->limits->order, y);
    for (int i = 0; i < n; i++) x[i] = y[i] * point->unit[i];
    return 1;
}

/* c of the limits at the acceleration e in place of a velocity, per unit of path. */
static int find_curvature(zd_point *point, int wanted, const double *e, double *c)
{
    zd_selection *self = point->rank->selection;
    int status = zd_point_need(point, ZD_XI), rank = self->independent;
    for (int j = 0; j < wanted; j++) c[j] = zd_limits_own_part(self, self->row[rank + j], point->terms.xi, 1);
    zd_copy_all(self->n, point->v, self->limits->v);
    zd_point_move_velocity(point, e);
    if (!status) status = zd_point_need(point, ZD_XI);
    for (int j = 0; j < wanted; j++) c[j] = (c[j] - zd_limits_own_part(self, self->row[rank + j], point->terms.xi, 1)) / self->limits->speed;
    zd_point_move_velocity(point, self->limits->v);
    return status;
}

/* Acceleration from rest. It takes the role that the velocity has otherwise: c(vdot) = 0. Of those that lie on a branch, the one is
 * taken that differs least, in the metric of M, from the unconstrained one (Gauss). Iteration: minimize subject to c linearized at the
 * last iterate. */
static int find_from_rest(zd_point *point, int wanted, int *found)
{
    zd_selection *self = point->rank->selection;
    double *e = self->limits->e, *x = self->limits->x, *rhs = self->rhs, *limits = rhs + self->independent;
    int n = self->n, status = zd_point_need(point, ZD_M | ZD_BIAS | ZD_FORCE | ZD_XI | ZD_PHI_T);
    *found = 0;
    if (status || (point->terms.Phi_t && zd_max_abs(self->m, point->terms.Phi_t) > 0)) return status;
    zd_point_force(point, self->limits->force);
    for (int a = 0; a < self->independent; a++) rhs[a] = point->terms.xi[self->row[a]];
    if (!solve(point, 0, self->limits->force, rhs, e)) return ZD_DONE;
    double best = INFINITY;
    for (int i = 0, stalls = 0; i < MAX_ITERATIONS && stalls < MAX_STALLS; i++) {
        zd_point_rate(point, e, self->limits->pdot);
        status = find_rates(point, wanted, found);
        if (status || !*found) return status;
        *found = 0;
        status = find_curvature(point, wanted, e, limits);
        if (status) return status;
        for (int j = 0; j < wanted; j++) limits[j] = of_limit(point, self->row[self->independent + j], e) - limits[j] / 2;
        if (!solve(point, wanted, self->limits->force, rhs, x)) return ZD_DONE;
        zd_subtract(n, x, e, e);
        double change = zd_max_scaled(n, e, point->inverse_unit) / self->limits->speed;
        *found = change <= SETTLED;
        if (*found) return ZD_DONE;
        stalls += change > FALLING * best;
        best = fmin(best, change);
        zd_copy(n, x, e);
    }
    return ZD_DONE;
}

/* ---- limits, in motion or at rest ---- */

int zd_limits_find(zd_point *point)
{
    zd_selection *self = point->rank->selection;
    int wanted = self->rank->max_rank - self->independent, found;
    if (!(point->system->provides & ZD_XI)) return ZD_DONE;
    int status = zd_point_need(point, ZD_A);
    if (status) return status;
    zd_point_rate(point, point->v, self->limits->pdot);
    self->limits->is_at_rest = zd_max_abs(point->system->nq, self->limits->pdot) == 0;
    status = self->limits->is_at_rest ? find_from_rest(point, wanted, &found) : find_rates(point, wanted, &found);
    if (status || !found) return status;
    for (int j = 0; j < wanted; j++) {
        self->limits->distance[j] = distance(self, self->row[self->independent + j]);
        if (!(fabs(self->limits->distance[j]) < INFINITY)) return ZD_DONE;
    }
    insert(point, wanted);
    return ZD_DONE;
}
