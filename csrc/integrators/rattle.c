/* RATTLE: a symplectic and symmetric step of second order for holonomic systems with pdot = v. Energy errors stay bounded over long
 * times, where explicit methods drift; (3) and (5) hold at the end of every step by the method itself.
 *
 *     M0 v0 = N w - h/2 (F(t0, p0, w) - C0^T lambda),     p1 = p0 + h w,    Phi(t1, p1) = 0
 *     M1 v1 = N w + h/2 (F(t1, p1, w) - C1^T mu),                           C1 v1 + Phi_t(t1, p1) = 0
 *
 * with N = (M0 + M1) / 2 and F = f + dT/dp. These are the discrete Euler-Lagrange equations of the trapezoidal discrete Lagrangian
 * h/2 (L(p0, w) + L(p1, w)): Marsden and West, Discrete mechanics and variational integrators, Acta Numerica 10 (2001), sections
 * 2.6.1 and 3.5. For constant M they are RATTLE, H. C. Andersen, J. Comput. Phys. 52 (1983) 24. If f is not a
 * gradient, the step is still symmetric and of second order.
 *
 * (2) has d = Mdot v - dT/dp, so that F = f - d + Mdot v: Mdot, along the motion, comes from differences of M. Their error,
 * (RESOLUTION h w)^4, is far below what it is needed for. For constant M, F = f and N = M.
 *
 * w is found by Newton's iteration with the leading matrix of the formulation at p0, that of the acceleration there,
 *
 *     M0 x + C0^T (h/2 lambda) = M0 v0 + h/2 F(t0, p0, w) - N w,    C0 x = -Phi(t1, p0 + h w) / h,    w <- w + H x
 *
 * and H, the identity at first, learns from what each change did to x what that matrix leaves out: C. G. Broyden, Math. Comp. 19
 * (1965) 577. H is kept as the product of what it has learnt, I + u s^T each time, so that its cost and memory follow the velocities:
 * C. T. Kelley, Iterative Methods for Linear and Nonlinear Equations, SIAM, 1995, section 7.3.
 */
#include <math.h>
#include <string.h>

#include "../constraints/limits.h"
#include "../linalg/iteration.h"
#include "../linalg/small.h"
#include "../point/point.h"
#include "integrator.h"

enum { MAX_ITERATIONS = 60, MAX_LEARNT = 16 };
static const double RESOLUTION = 1.0 / 64;      /* distance of the points for Mdot, relative to the step */
static const double MIN_CURVATURE = 0.1;      /* ratio of s^T H y to s^T s: below, the update is skipped */
static const double CHANGE_ROUNDING = 2 * 0x1p-52; /* change relative to w below which the iteration has converged */
static const double STALLED_CHANGE = 1e-12;     /* change relative to w + p / h: a smaller one that no longer shrinks is rounding error */

typedef struct rattle {
    int n, m, varies;
    zd_point *probe;        /* point for terms elsewhere than at p0, where the leading matrix is in use */
    double *p0, *p, *moved; /* (n,) */
    double *v0, *w, *x;     /* (n,) */
    double *s, *y;          /* (n,), (n,): last change of w, and by how much it reduced x */
    int learnt;             /* number of factors I + u s^T of H */
    double *u_of_H, *s_of_H;    /* (MAX_LEARNT, n) each: u and s of these factors */
    double *start, *mean;   /* (n,): M0 v0 and N w */
    double *F, *Mdot;       /* (n,), stored as M is */
    int stored;             /* number of stored entries of M */
    double *product;        /* (n,) */
    double *rhs;            /* (m,) */
    double *rate0, *rate1;  /* (size,): rates at both ends, for entries after the formulation's */
    zd_motion *motion;
    double *state;          /* (size,) */
    double t0, t1, h;       /* start, end and size of the step */
    double before;          /* the last iteration's change */
} rattle;

static int suits(const zd_system *system)
{
    return !system->mn && !(system->provides & ZD_A);
}

static void *create(zd_arena *arena, const void *table, zd_motion *motion, double *y, int size, const void *given)
{
    (void)table, (void)given;
    const zd_system *system = &motion->system;
    size_t n = system->nv, m = zd_constraints(system);
    rattle self = {
        .n = (int)n,
        .m = (int)m,
        .varies = (system->provides & ZD_BIAS) != 0,
        .probe = zd_point_create(arena, system, &motion->statistics),
        .p0 = zd_arena_doubles(arena, n),
        .p = zd_arena_doubles(arena, n),
        .moved = zd_arena_doubles(arena, n),
        .v0 = zd_arena_doubles(arena, n),
        .w = zd_arena_doubles(arena, n),
        .x = zd_arena_doubles(arena, n),
        .s = zd_arena_doubles(arena, n),
        .y = zd_arena_doubles(arena, n),
        .u_of_H = zd_arena_doubles(arena, MAX_LEARNT * n),
        .s_of_H = zd_arena_doubles(arena, MAX_LEARNT * n),
        .start = zd_arena_doubles(arena, n),
        .mean = zd_arena_doubles(arena, n),
        .F = zd_arena_doubles(arena, n),
        .Mdot = zd_arena_doubles(arena, zd_size_of_M(system)),
        .stored = zd_size_of_M(system),
        .product = zd_arena_doubles(arena, n),
        .rhs = zd_arena_doubles(arena, m),
        .rate0 = zd_arena_doubles(arena, size),
        .rate1 = zd_arena_doubles(arena, size),
        .motion = motion,
        .state = y,
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

/* to <- H x */
static void multiply(const rattle *self, const double *x, double *to)
{
    const int n = self->n;
    zd_copy(n, x, to);
    for (int k = 0; k < self->learnt; k++) zd_add_scaled(n, to, zd_dot(n, self->s_of_H + k * n, to), self->u_of_H + k * n);
}

/* to <- s M x, or where `add` is set to + s M x; M is stored as that of the motion */
static void times_mass(const rattle *self, double s, const double *M, const double *x, int add, double *to)
{
    zd_times_M(self->probe, M, x, self->product);
    for (int i = 0; i < self->n; i++) to[i] = (add ? to[i] : 0) + s * self->product[i];
}

/* Mdot at (t, p), by five points along the motion with w */
static int differentiate_mass(rattle *self, double t, const double *p)
{
    static const double weight[4] = {-1.0 / 12, 8.0 / 12, -8.0 / 12, 1.0 / 12};
    static const int place[4] = {2, 1, -1, -2};
    int n = self->n;
    double s = RESOLUTION * self->h;
    zd_clear(self->stored, self->Mdot);
    for (int k = 0; k < 4; k++) {
        for (int i = 0; i < n; i++) self->moved[i] = p[i] + place[k] * s * self->w[i];
        zd_point_move(self->probe, t + place[k] * s, self->moved, self->w);
        int status = zd_point_need(self->probe, ZD_M);
        if (status) return status;
        zd_add_scaled(self->stored, self->Mdot, weight[k] / s, self->probe->terms.M);
    }
    return ZD_DONE;
}

/* F = f - d + Mdot w at (t, p, w) */
static int find_force(rattle *self, double t, const double *p)
{
    int status = self->varies ? differentiate_mass(self, t, p) : ZD_DONE;
    zd_point_move(self->probe, t, p, self->w);
    if (!status) status = zd_point_need(self->probe, ZD_FORCE | ZD_BIAS);
    if (status) return status;
    zd_point_force(self->probe, self->F);
    if (self->varies) times_mass(self, 1, self->Mdot, self->w, 1, self->F);
    return ZD_DONE;
}

/* ---- w, p1 ---- */

/* The change that Newton's iteration would make of w, in units of w; nothing where it is rounding. */
static int residual(void *context, double *size)
{
    rattle *self = context;
    zd_motion *motion = self->motion;
    int n = self->n, status = find_force(self, self->t0, self->p0);
    for (int i = 0; i < n; i++) self->p[i] = self->p0[i] + self->h * self->w[i];
    zd_point_move(self->probe, self->t1, self->p, self->w);
    if (!status) status = zd_point_need(self->probe, ZD_PHI | (self->varies ? ZD_M : 0));
    if (status) return status;
    times_mass(self, self->varies ? 0.5 : 1, motion->point->terms.M, self->w, 0, self->mean);
    if (self->varies) times_mass(self, 0.5, self->probe->terms.M, self->w, 1, self->mean);
    for (int i = 0; i < n; i++) self->F[i] = self->start[i] + self->h / 2 * self->F[i] - self->mean[i];
    for (int k = 0; k < self->m; k++) self->rhs[k] = -self->probe->terms.Phi[k] / self->h;
    status = zd_limits_replace(motion->point, ZD_LIMIT_PHI, self->rhs);
    if (status) return status;
    motion->statistics.solves++;
    zd_motion_solve(motion, self->F, self->rhs, self->x, NULL);

    double change = zd_max_abs(n, self->x), speed = zd_max_abs(n, self->w);
    int rounding = change >= self->before / 2 && change <= STALLED_CHANGE * (speed + zd_max_abs(n, self->p) / fabs(self->h));
    self->before = change;
    *size = change > 0 && !rounding ? change / fmax(change, speed) : 0;
    return ZD_DONE;
}

/* H <- H + (s - H y) s^T H / s^T H y = (I + u s^T) H, u = (s - H y) / s^T H y; nothing more is learnt by an H that is full */
static void learn(rattle *self)
{
    const int n = self->n;
    double *y = self->y, *Hy = self->F;     /* which is free now */
    zd_subtract(n, self->y, self->x, y);
    multiply(self, y, Hy);
    const double denominator = zd_dot(n, self->s, Hy);
    if (self->learnt == MAX_LEARNT || !(fabs(denominator) > MIN_CURVATURE * zd_dot(n, self->s, self->s))) return;
    double *u = self->u_of_H + self->learnt * n;
    for (int i = 0; i < n; i++) u[i] = (self->s[i] - Hy[i]) / denominator;
    zd_copy(n, self->s, self->s_of_H + self->learnt++ * n);
}

static int improve(void *context)
{
    rattle *self = context;
    int n = self->n;
    learn(self);
    multiply(self, self->x, self->s);
    zd_add_scaled(n, self->w, 1, self->s);
    zd_copy(n, self->x, self->y);
    return ZD_DONE;
}

static int find_positions(rattle *self)
{
    const zd_newton newton = {residual, improve, CHANGE_ROUNDING, MAX_ITERATIONS, 0, NULL, 0};
    zd_motion *motion = self->motion;
    int iterations, status = zd_motion_accelerate(motion);    /* for samples, and for the first estimate of w */
    double left;
    if (!status) status = zd_motion_factor(motion);     /* a restored acceleration may come without its factors */
    if (status) return status;
    times_mass(self, 1, motion->point->terms.M, self->v0, 0, self->start);
    for (int i = 0; i < self->n; i++) self->w[i] = self->v0[i] + self->h / 2 * motion->point->vdot[i];
    self->before = INFINITY;
    self->learnt = 0;
    zd_clear(self->n, self->s);      /* no change yet to learn from */
    status = zd_newton_solve(&newton, self, &iterations, &left);
    motion->statistics.implicit_iterations += iterations;
    return status == ZD_NO_CONVERGENCE ? ZD_NO_STEP : status;
}

/* ---- v1 ---- */

static int find_velocities(rattle *self)
{
    zd_motion *motion = self->motion;
    zd_point *point = motion->point;
    int n = self->n, status = find_force(self, self->t1, self->p);
    zd_point_move(point, self->t1, self->p, self->w);
    if (!status) status = zd_motion_factor(motion);
    if (!status) status = zd_point_need(point, ZD_PHI_T);
    if (status) return status;
    if (!self->varies) times_mass(self, 1, point->terms.M, self->w, 0, self->mean);
    for (int i = 0; i < n; i++) self->F[i] = self->mean[i] + self->h / 2 * self->F[i];
    for (int k = 0; k < self->m; k++) self->rhs[k] = point->terms.Phi_t ? -point->terms.Phi_t[k] : 0;
    status = zd_limits_replace(point, ZD_LIMIT_ENFORCED, self->rhs);
    if (status) return status;
    motion->statistics.solves++;
    zd_motion_solve(motion, self->F, self->rhs, self->x, NULL);
    zd_point_move_velocity(point, self->x);
    return motion->formulation->pack(motion->solver, point, self->state);
}

/* A system may also have its Mdot v in f and no d: then M shows it. */
static int notice_variation(rattle *self, int *varies)
{
    zd_point_move(self->probe, self->t1, self->p, self->w);
    int status = zd_point_need(self->probe, ZD_M);
    *varies = memcmp(self->probe->terms.M, self->motion->point->terms.M, self->stored * sizeof(double)) != 0;
    return status;
}

static int solve_step(rattle *self)
{
    int status = find_positions(self);
    if (!status && !self->varies) {
        status = notice_variation(self, &self->varies);
        if (!status && self->varies) status = find_positions(self);
    }
    return status ? status : find_velocities(self);
}

/* Entries of the state for corrections and (28) are integrated by the trapezoidal rule. */
static int step_of_motion(void *memory, zd_motion *motion, double t, double h, double *y)
{
    rattle *self = memory;
    int status, own = motion->formulation_size, along = motion->rate.size - own;
    self->h = h;
    self->t0 = t;
    self->t1 = t + h;
    self->probe->known = 0;     /* the step may be a repeated one */
    motion->state = y;
    status = motion->formulation->unpack(motion->solver, motion->point, t, y);
    if (!status && along) status = zd_motion_rate(motion, t, y, self->rate0);
    if (status) return status;
    zd_copy_all(self->n, motion->point->p, self->p0);
    zd_copy_all(self->n, motion->point->v, self->v0);
    status = solve_step(self);
    if (status || !along) return status;
    status = zd_motion_rate(motion, self->t1, y, self->rate1);
    for (int i = own; i < motion->rate.size; i++) y[i] += h / 2 * (self->rate0[i] + self->rate1[i]);
    return status;
}

const zd_integrator zd_rattle = {
    .card = {
        .name = "rattle",
        .summary = "RATTLE: symplectic and symmetric, for long runs of holonomic systems; the energy error stays bounded.",
        .equations = "Andersen, 1983; Marsden and West, 2001",
        .order = 2, .stability = 2,
        .description = "The discrete equations of motion of the trapezoidal discrete Lagrangian: symplectic and symmetric, of "
                       "order two, with positions and velocities on their constraints at the end of each step by the method "
                       "itself. Errors of the energy oscillate but do not grow over long times. It takes holonomic systems whose "
                       "velocities are the rates of their coordinates, of any size where a structure is declared.",
        .reference = "H. C. Andersen, Journal of Computational Physics 52 (1983) 24-34; J. E. Marsden, M. West, Discrete "
                     "mechanics and variational integrators, Acta Numerica 10 (2001) 357-514",
    },
    .suits = suits,
    .create = create,
    .step_of_motion = step_of_motion,
};
