/* Projection onto the constraint manifold after a step: positions by iteration, then velocities in one solve.
 *
 *     p <- p - A solve(0, [Phi; 0])       (25a), (26a), (27a)     until every |Phi| <= tolerance, in units of its size
 *     v <- v - solve(0, Psi)              (25b), (26b), (27b)
 *
 * `solve` is the formulation's own, whose metric is the mass matrix: the correction is M-orthogonal to the manifold and leaves
 * the motion along it alone. For comparison there is the identity metric of the paper's reference [20], (13) with M = I.
 *
 * Where the iteration does not converge it is tried once more from its start, with steps shortened until each one helps.
 */

#include "../constraints/limits.h"
#include "../constraints/rank.h"
#include "../linalg/iteration.h"
#include "../linalg/small.h"
#include "../motion/motion.h"
#include "../point/point.h"

typedef struct given_projection {
    double tol, max_iterations, every, metric, positions, velocities;
} given_projection;

enum metric { MASS, IDENTITY };

static const zd_parameter parameters[] = {
    {"tol", "", "Positions are iterated until every ``|Phi|`` is at most this, in units of its size `Solution.position_size`: the largest "
     "``|C_ki|`` times one radian of an angle or the mechanism's own length, at the start. The tolerance so means the same in any unit: "
     "angles are off by about that many rad, and lengths by that part of the mechanism's length.", 1, ZD_POSITIVE,
     (const double[]){1e-12}},
    {"max_iterations", "", "The largest number of iterations. A correction that needs more is tried again with shortened iterations, then "
     "with the step in up to eight parts (or shorter, with adaptive steps); `Solution.stats` counts all of them. Where none of this "
     "helps, the run fails.", 1, ZD_COUNT, (const double[]){10}},
    {"every", "", "Steps between corrections; the last step is always corrected.", 1, ZD_COUNT, (const double[]){1}},
    {"metric", "", "mass identity: Metric in which the correction is orthogonal: the mass matrix, or (for comparison) the identity of the "
     "paper's reference [20].", 1, ZD_CHOICE, (const double[]){MASS}},
    {"positions", "", "True: positions are corrected.", 1, ZD_SWITCH, (const double[]){1}},
    {"velocities", "", "True: velocities are corrected.", 1, ZD_SWITCH, (const double[]){1}},
};

typedef struct projection {
    double *p, *v;      /* (nq,), (nv,): corrected p and v */
    double *landed;     /* (nq,): p before its correction */
    double *rhs, *x;    /* (m,), (nv,) */
    double *from, *change;  /* (nq,), (nq,): p before an iteration, and its change so far, where iterations are shortened */
    double *identity;   /* M of the identity metric, stored as the system's M */
    void *plain;        /* solver of (13) with it */
} projection;

extern const zd_formulation zd_schur;

typedef struct position_problem {   /* context of Newton's iteration */
    projection *self;
    zd_motion *motion;
    int has_moved;          /* true if an iteration has changed p */
} position_problem;

static int every(const void *memory)
{
    const given_projection *given = memory;
    return (int)given->every;
}

static zd_constraint_target target(const void *memory)
{
    const given_projection *given = memory;
    return (zd_constraint_target){given->positions != 0, given->velocities != 0, (int)given->every,
                                  (int)given->metric == MASS, given->tol, (int)given->max_iterations};
}

static void *create(zd_arena *arena, const zd_system *system, const void *memory)
{
    const given_projection *given = memory;
    size_t nq = system->nq, nv = system->nv;
    int identity = (int)given->metric == IDENTITY;
    projection self = {
        .p = zd_arena_doubles(arena, nq),
        .v = zd_arena_doubles(arena, nv),
        .landed = zd_arena_doubles(arena, nq),
        .from = zd_arena_doubles(arena, nq),
        .change = zd_arena_doubles(arena, nq),
        .rhs = zd_arena_doubles(arena, zd_constraints(system)),
        .x = zd_arena_doubles(arena, nv),
        .identity = identity ? zd_arena_doubles(arena, zd_size_of_M(system)) : NULL,
        .plain = identity ? zd_schur.create(arena, system, NULL) : NULL,
    };
    if (self.identity) zd_set_identity(system, self.identity);
    return zd_arena_copy(arena, &self, sizeof self);
}

/* M and C are needed at this point in any case, here or for the velocities, so they are evaluated together with Phi. */
static int position_residual(void *context, double *size)
{
    const zd_motion *motion = ((position_problem *)context)->motion;
    zd_point *point = motion->point;
    int status = zd_point_need(point, ZD_PHI | motion->matrices);
    if (!status) *size = zd_point_violation(point);
    return status;
}

static int solve_with_identity(projection *self, zd_motion *motion, enum zd_limit what, double *x)
{
    int status = zd_motion_find_independent(motion);
    if (!status) status = zd_limits_replace(motion->point, what, self->rhs);
    if (status) return status;
    zd_point unit = *motion->point;
    unit.terms.M = self->identity;
    unit.known |= ZD_M;
    motion->statistics.factorizations++;
    status = zd_schur.factor(self->plain, &unit);
    motion->point->failed_index = unit.failed_index;
    if (!status) zd_solve_with(&unit, &zd_schur, self->plain, NULL, self->rhs, x, NULL);
    return status;
}

/* x with C x = rhs, that of Phi or of Psi, orthogonal to the manifold in the chosen metric */
static int solve(projection *self, zd_motion *motion, enum zd_limit what, double *x)
{
    motion->statistics.solves++;
    if (self->plain) return solve_with_identity(self, motion, what, x);
    int status = zd_motion_factor_for(motion, NULL, self->rhs, x);
    if (!status) status = zd_limits_replace(motion->point, what, self->rhs);
    if (!status) zd_motion_solve(motion, NULL, self->rhs, x, NULL);
    return status;
}

/* Phi is known. */
static int improve_position(void *context)
{
    position_problem *problem = context;
    projection *self = problem->self;
    zd_point *point = problem->motion->point;
    const zd_system *system = point->system;
    if (!problem->has_moved) zd_copy_few(system->nq, point->p, self->landed);
    problem->has_moved = 1;
    zd_copy_few(system->mh, point->terms.Phi, self->rhs);
    for (int k = system->mh; k < zd_constraints(system); k++) self->rhs[k] = 0;
    int status = solve(self, problem->motion, ZD_LIMIT_PHI, self->x);
    const int has_A = zd_has_A(system);
    if (!status && has_A) status = zd_point_need_times_A(point, 0);
    if (status) return status;
    if (has_A) zd_point_rate(point, self->x, self->p);
    zd_correct_position(system, point->p, has_A ? self->p : self->x, self->p);     /* (25a), (26a), (27a) */
    zd_point_move_position(point, self->p);
    return ZD_DONE;
}

static int improve_and_save(void *context)
{
    position_problem *problem = context;
    projection *self = problem->self;
    const zd_point *point = problem->motion->point;
    zd_copy_all(point->system->nq, point->p, self->from);
    int status = improve_position(context);
    ZD_SIZED(zd_subtract, point->system->nq, point->p, self->from, self->change);
    return status;
}

static int retreat(void *context)
{
    position_problem *problem = context;
    projection *self = problem->self;
    zd_point *point = problem->motion->point;
    for (int i = 0; i < point->system->nq; i++) {
        self->change[i] *= 0.5;
        self->p[i] = self->from[i] + self->change[i];
    }
    zd_quaternions_normalise(point->system, self->p);
    zd_point_move_position(point, self->p);
    return ZD_DONE;
}

static int iterate(const zd_newton *newton, position_problem *problem)
{
    zd_motion *motion = problem->motion;
    int iterations;
    int status = zd_newton_solve(newton, problem, &iterations, &motion->point->residual_left);
    zd_count_position_iterations(motion, iterations);
    return status;
}

static int correct_positions(projection *self, zd_motion *motion)
{
    zd_newton newton = {position_residual, improve_position, motion->target.tolerance, motion->target.max_iterations,
                        motion->in_run ? ZD_TRUSTED_SHARE : 0, NULL, 0};
    position_problem problem = {self, motion, 0};
    int status = iterate(&newton, &problem);
    /* Near a bifurcation C is small, so that a violation within the tolerance may belong to a p far from the constraints: one more
     * iteration is made there. */
    const zd_rank *rank = motion->point->rank;
    if (!status && rank->was_ill_conditioned && rank->max_rank == rank->m) return improve_position(&problem);
    if (!status || status == ZD_CALLBACK || status == ZD_NO_MEMORY || !problem.has_moved) return status;
    newton.improve = improve_and_save;
    newton.contraction = 0;
    newton.retreat = retreat;
    zd_point_move_position(motion->point, self->landed);    /* again from the start */
    status = iterate(&newton, &problem);
    if (!status) motion->statistics.damped++;
    return status;
}

static int correct_velocities(projection *self, zd_motion *motion)
{
    zd_point *point = motion->point;
    int status = zd_point_need(point, motion->matrices | ZD_PHI_T);
    if (!status) status = zd_point_need_times_C(point);
    if (status) return status;
    zd_point_velocity_violation(point, self->rhs);
    status = solve(self, motion, ZD_LIMIT_PSI, self->x);
    if (status) return status;
    zd_correct_velocity(point->system, point->v, self->x, self->v);         /* (25b), (26b), (27b) */
    zd_point_move_velocity(point, self->v);
    motion->statistics.velocity_corrections++;
    return ZD_DONE;
}

static int has_positions(const zd_motion *motion) { return motion->target.positions && (motion->corrects & ZD_PHI); }
static int has_velocities(const zd_motion *motion) { return motion->target.velocities && (motion->corrects & ZD_C); }

static int after_step(void *self, zd_motion *motion)
{
    int status = ZD_DONE;
    if (has_positions(motion) && (motion->drifts_from & ZD_PHI) && motion->system.mh) status = correct_positions(self, motion);
    if (status || !zd_constraints(&motion->system)) return status;
    if (motion->drifts_from & ZD_C) return has_velocities(motion) ? correct_velocities(self, motion) : ZD_DONE;
    return zd_motion_updates(motion) ? motion->formulation->update(motion->solver, motion->point) : ZD_DONE;
}

const zd_correction zd_projection_row = {
    .card = {
        .name = "projection",
        .summary = "Positions and velocities are projected onto the constraints after the step, orthogonally in the mass metric.",
        .equations = "(25), (26), (27)",
        .description = "Positions are iterated onto the constraints (3) to the tolerance, then velocities onto (5) in one solve, with the "
                       "leading matrix that the formulation has factored already. In the mass metric the correction is orthogonal to the "
                       "manifold of the constraints and does not change the motion along it, so that the order of the integrator is "
                       "unchanged.",
        .reference = "W. Blajer, Elimination of constraint violation and accuracy aspects in numerical simulation of multibody systems, "
                     "Multibody System Dynamics 7 (2002) 265-284, section 3.1",
        .parameters = sizeof parameters / sizeof parameters[0],
        .parameter = parameters,
    },
    .every = every,
    .target = target,
    .create = create,
    .after_step = after_step,
};
