/* User functions u(r) of forces that read reactions and accelerations r. These are affine in vdot and lambda, as these are in the forces:
 *
 *     r = R(u(r)),     R(u) = r0 + G u: measured at the vdot and lambda of (8), (9), (13) with the forces u
 *
 * The columns of G are exact differences, each of one solve with the factors at the state. So a user function is evaluated for Newton's
 * method alone, which starts at r0 of the same state, so that no number depends on earlier evaluations; and those that read no reaction are
 * evaluated once. Derivatives du/dr are differences away from r = 0, where friction has a kink. The ratio of two corrections with one
 * matrix tells by how much that has changed between them: while it is small, the matrix is kept. Friction proportional to a reaction needs
 * one.
 *
 * The motion is unique if det(I - G du/dr) > 0 from r0 to r. Beyond that (Painleve) there are several accelerations, or none.
 */
#include "motion.h"

#include <math.h>
#include <string.h>

#include "../constraints/rank.h"
#include "../linalg/dense.h"
#include "../linalg/small.h"

static const double INCREMENT = 1e-6;       /* difference, in scales of a reaction */
static const double FLOOR = 1e-3;           /* least scale of a reaction, in units of the largest force, against rounding */
static const double LEFT = 1e-13;           /* error that is left, in scales of a reaction */
static const double ALIKE = 0.03;           /* ratio of two corrections with one matrix, with which that matrix is kept */
static const double CONDITION = 1e10;       /* largest condition of I - G du/dr, in the scales of the reactions */
enum { ITERATIONS = 30 };
/* Matrices between r0 and r, for functions that are not affine there: friction of a reaction with one change of sign has two. */
enum { BETWEEN = 3 };

/* A state, and the way in which vdot and lambda are found there: solved for with the forces u, or given. */
typedef struct zd_state_read {
    const zd_system *system;
    zd_motion *motion;      /* NULL: vdot and lambda are given */
    double t;
    const double *p, *v, *vdot, *lambda;
    const zd_efforts *efforts;
} zd_state_read;

/* ---- R(u) ---- */

/* vdot and lambda at the point, with the forces u */
static int solve_with(zd_motion *motion)
{
    zd_point *point = motion->point;
    const zd_reactions *self = &motion->reactions;
    zd_copy_all(self->reading->functions, self->u, point->inputs);
    point->known &= ~(ZD_FORCE | ZD_POWER | ZD_ACCELERATED);
    return zd_equations_by_matrices.accelerate(motion);
}

/* R <- R(u) */
static int measure(zd_reactions *self, const zd_state_read *at)
{
    const zd_measures *measures = at->system->measures;
    const int status = at->motion ? solve_with(at->motion) : ZD_DONE;
    if (status) return status;
    if (at->motion) zd_rank_find_multipliers(at->motion->point);
    for (int i = 0; i < self->reading->count; i++) {
        const zd_read_reaction *of = self->reading->reaction + i;
        const zd_measured out = {.value = self->measured, .is_least = 1, .efforts = at->efforts};
        const int failed = measures->evaluate(at->system->data, self->u, of->measure, at->t, at->p, at->v, at->vdot, at->lambda, &out,
                                              self->scratch);
        if (failed) return ZD_CALLBACK;
        self->R[i] = self->measured[of->component];
    }
    return ZD_DONE;
}

/* Largest force at r0 */
static double largest_force(const zd_reactions *self, const zd_state_read *at)
{
    const double of_lambda = zd_max_abs(zd_constraints(at->system), at->lambda);
    const double largest = fmax(of_lambda, zd_max_abs(self->reading->count, self->r0));
    return at->motion && at->motion->point->terms.f ? fmax(largest, zd_max_abs(at->system->nv, at->motion->point->terms.f)) : largest;
}

/* Scale of a reaction or a force */
static double size_of(const zd_reactions *self, double value)
{
    const double size = fmax(fabs(value), FLOOR * self->force);
    return size > 0 ? size : 1;
}

/* Column of G of a user function, from the difference for a change of it as large as its value. */
static int find_column(zd_reactions *self, const zd_state_read *at, int function)
{
    const int n = self->reading->count;
    const double size = size_of(self, self->u1[function]);
    double *column = self->G + function * n;
    zd_copy_all(self->reading->functions, self->u0, self->u);
    self->u[function] = size;
    const int status = measure(self, at);
    for (int i = 0; i < n; i++) column[i] = (self->R[i] - self->r0[i]) / size;
    return status;
}

/* ---- u(r) ---- */

static int evaluate(zd_reactions *self, const zd_state_read *at, int function, int is_same_state, double *u)
{
    return self->reading->evaluate(at->system->data, function, at->t, at->p, at->v, self->r, is_same_state, u, self->scratch);
}

static int reads(const zd_reading *reading, int function)
{
    for (int i = 0; i < reading->reads; i++)
        if (reading->read[i].function == function) return 1;
    return 0;
}

/* u, u0 <- values of the user functions that read no reaction, zero for the others */
static int evaluate_others(zd_reactions *self, const zd_state_read *at)
{
    int status = ZD_DONE;
    for (int i = 0, count = 0; i < self->reading->functions && !status; i++) {
        self->u0[i] = 0;
        if (!reads(self->reading, i)) status = evaluate(self, at, i, count++ > 0, self->u0 + i);
    }
    zd_copy_all(self->reading->functions, self->u0, self->u);
    return status;
}

/* u <- values of those that read reactions, at r */
static int evaluate_readers(zd_reactions *self, const zd_state_read *at)
{
    int status = ZD_DONE, before = -1;
    for (const zd_read *read = self->reading->read; read < self->reading->read + self->reading->reads && !status; read++) {
        if (read->function != before) status = evaluate(self, at, read->function, before >= 0, self->u + read->function);
        before = read->function;
    }
    return status;
}

/* u_r at r, where u is known */
static int differentiate(zd_reactions *self, const zd_state_read *at)
{
    int status = ZD_DONE;
    for (int k = 0; k < self->reading->reads && !status; k++) {
        const zd_read read = self->reading->read[k];
        const double r = self->r[read.reaction];
        double u = 0;
        self->r[read.reaction] = r + copysign(INCREMENT * self->scale[read.reaction], r);
        status = evaluate(self, at, read.function, 1, &u);
        self->u_r[k] = (u - self->u[read.function]) / (self->r[read.reaction] - r);
        self->r[read.reaction] = r;
    }
    return status;
}

/* ---- Newton's method ---- */

/* Sum of magnitudes in the row of the (n, n) matrix where it is largest */
static double largest_row(int n, const double *A)
{
    double largest = 0;
    for (int i = 0; i < n; i++) {
        double sum = 0;
        for (int j = 0; j < n; j++) sum += fabs(A[i * n + j]);
        largest = fmax(largest, sum);
    }
    return largest;
}

/* matrix <- factors of I - G du/dr at r; ZD_SEVERAL_MOTIONS unless its determinant is positive, and its condition small. */
static int factor(zd_reactions *self)
{
    const int n = self->reading->count;
    double largest = 0;
    for (int i = 0; i < n * n; i++) self->matrix[i] = i % (n + 1) == 0;
    for (int k = 0; k < self->reading->reads; k++) {
        const zd_read read = self->reading->read[k];
        const double slope = self->u_r[k] * self->scale[read.reaction], *column = self->G + read.function * n;
        for (int i = 0; i < n; i++) {
            const double entry = column[i] * slope / self->scale[i];
            self->matrix[i * n + read.reaction] -= entry;
            if (fabs(entry) > largest) largest = fabs(entry), self->strongest = read.function;
        }
    }
    if (!zd_is_finite(n * n, self->matrix)) return ZD_NOT_FINITE;
    const double size = largest_row(n, self->matrix);
    self->determinant = self->condition = 0;
    if (zd_lu_factor(n, self->matrix, self->order) < n) return ZD_SEVERAL_MOTIONS;
    self->determinant = zd_lu_determinant(n, self->matrix, self->order);
    for (int j = 0; j < n; j++) {
        double *row = self->inverse + j * n;
        for (int i = 0; i < n; i++) row[i] = i == j;
        zd_lu_solve_transposed(n, self->matrix, self->order, row);
    }
    self->condition = size * largest_row(n, self->inverse);
    return self->determinant > 0 && self->condition <= CONDITION ? ZD_DONE : ZD_SEVERAL_MOTIONS;
}

/* The same at r, where u is known */
static int linearize(zd_reactions *self, const zd_state_read *at)
{
    for (int i = 0; i < self->reading->count; i++) self->scale[i] = size_of(self, self->r[i]);
    const int status = differentiate(self, at);
    return status ? status : factor(self);
}

/* change <- matrix^-1 (r - r0 - G (u - u0)); returns the largest */
static double find_change(const zd_reactions *self)
{
    const int n = self->reading->count;
    for (int i = 0; i < n; i++) self->change[i] = self->r[i] - self->r0[i];
    for (int k = 0; k < self->reading->functions; k++)
        if (reads(self->reading, k)) zd_add_scaled(n, self->change, -self->u[k], self->G + k * n);
    for (int i = 0; i < n; i++) self->change[i] /= self->scale[i];
    zd_lu_solve(n, self->matrix, self->order, self->change);
    return zd_max_abs(n, self->change);
}

/* r, and u along its derivatives, which is its value where the correction is small */
static void correct(zd_reactions *self)
{
    for (int k = 0; k < self->reading->reads; k++) {
        const zd_read read = self->reading->read[k];
        self->u[read.function] -= self->u_r[k] * self->change[read.reaction] * self->scale[read.reaction];
    }
    for (int i = 0; i < self->reading->count; i++) self->r[i] -= self->change[i] * self->scale[i];
}

/* Newton's method from r = r0, where u is known; *matrices <- their number */
static int iterate(zd_reactions *self, const zd_state_read *at, int *matrices)
{
    double before = 0, now = INFINITY;
    int status = ZD_DONE;
    *matrices = 0;
    for (int k = 0; k < ITERATIONS && !status; k++) {
        if (k) status = evaluate_readers(self, at);
        if (k && !status) now = find_change(self);
        const int is_last = now <= LEFT || now * now <= LEFT * before;
        if (!status && !is_last && !(now <= ALIKE * before)) {
            status = linearize(self, at);
            if (!status) now = find_change(self);
            ++*matrices;
        }
        if (!status) correct(self);
        if (is_last) return status;
        before = now;
    }
    return status ? status : ZD_SEVERAL_MOTIONS;
}

/* Checks the matrices between r0 and r; u remains. */
static int check_between(zd_reactions *self, const zd_state_read *at)
{
    const size_t n = self->reading->count, k = self->reading->functions;
    int status = ZD_DONE;
    memcpy(self->r1, self->r, n * sizeof *self->r);
    memcpy(self->u1, self->u, k * sizeof *self->u);
    for (int i = 1; i <= BETWEEN && !status; i++) {
        const double share = (double)i / (BETWEEN + 1);
        for (size_t j = 0; j < n; j++) self->r[j] = self->r0[j] + share * (self->r1[j] - self->r0[j]);
        status = evaluate_readers(self, at);
        if (!status) status = linearize(self, at);
    }
    memcpy(self->u, self->u1, k * sizeof *self->u);
    return status;
}

/* G, where u is known; u remains */
static int find_columns(zd_reactions *self, const zd_state_read *at)
{
    int status = ZD_DONE;
    zd_copy_all(self->reading->functions, self->u, self->u1);
    for (int i = 0; i < self->reading->functions && !status; i++)
        if (reads(self->reading, i)) status = find_column(self, at, i);
    zd_copy_all(self->reading->functions, self->u1, self->u);
    return status;
}

/* u <- the values with which r = R(u(r)) */
static int solve(zd_reactions *self, const zd_state_read *at)
{
    const size_t n = self->reading->count;
    int matrices, status = evaluate_others(self, at);
    if (!status) status = measure(self, at);
    if (!status && !zd_is_finite((int)n, self->R)) status = ZD_NOT_FINITE;
    if (status) return status;
    memcpy(self->r, self->R, n * sizeof *self->r);
    memcpy(self->r0, self->R, n * sizeof *self->r);
    self->force = largest_force(self, at);
    status = evaluate_readers(self, at);
    if (!status) status = find_columns(self, at);
    if (!status) status = iterate(self, at, &matrices);
    return !status && matrices > 1 ? check_between(self, at) : status;
}

/* ---- in a motion ---- */

static int accelerate(zd_motion *motion)
{
    zd_point *point = motion->point;
    const zd_state_read at = {&motion->system, motion, point->t, point->p, point->v, point->vdot, point->lambda, NULL};
    int status = solve(&motion->reactions, &at);
    if (!status) status = solve_with(motion);
    if (status) point->known &= ~(ZD_FORCE | ZD_POWER | ZD_ACCELERATED);
    return status;
}

static const zd_equations equations = {
    accelerate, zd_motion_rate, zd_motion_unpack, zd_motion_pack, zd_motion_finish, zd_motion_expand, zd_motion_reduce,
    ~(ZD_FORCE | ZD_POWER), 1};

static zd_reactions create(zd_arena *arena, const zd_system *system)
{
    const size_t n = system->reading->count, k = system->reading->functions;
    return (zd_reactions){
        .reading = system->reading,
        .r = zd_arena_doubles(arena, n), .r0 = zd_arena_doubles(arena, n), .r1 = zd_arena_doubles(arena, n),
        .u = zd_arena_doubles(arena, k), .u0 = zd_arena_doubles(arena, k), .u1 = zd_arena_doubles(arena, k),
        .u_r = zd_arena_doubles(arena, system->reading->reads),
        .G = zd_arena_doubles(arena, k * n),
        .R = zd_arena_doubles(arena, n), .change = zd_arena_doubles(arena, n), .scale = zd_arena_doubles(arena, n),
        .matrix = zd_arena_doubles(arena, n * n), .inverse = zd_arena_doubles(arena, n * n),
        .order = zd_arena_ints(arena, n),
        .measured = zd_arena_doubles(arena, zd_largest_measure(system->measures)),
        .scratch = zd_arena_doubles(arena, system->measures->scratch),
    };
}

void zd_reactions_create(zd_motion *motion, zd_arena *arena)
{
    if (!motion->system.reading) return;
    motion->reactions = create(arena, &motion->system);
    motion->equations = &equations;
}

/* ---- at given vdot and lambda ---- */

int zd_reactions_at(const zd_system *system, double t, const double *p, const double *v, const double *vdot, const double *lambda,
                       const zd_efforts *efforts, double *u)
{
    zd_arena counting = {0};
    create(&counting, system);
    zd_memory *memory = zd_memory_create(counting.used);
    if (!memory) return ZD_NO_MEMORY;
    zd_arena arena = zd_arena_in(memory);
    zd_reactions self = create(&arena, system);
    const zd_state_read at = {system, NULL, t, p, v, vdot, lambda, efforts};
    const int status = solve(&self, &at);
    zd_copy_all(system->reading->functions, self.u, u);
    zd_memory_free(memory);
    return status;
}
