/* Equations (8) with a matrix whose blocks couple bodies,
 *
 *     (M + C^T W C) dx = r + C^T W s,        dlambda = W (C dx - s),        r = force - M x - C^T lambda,  s = rhs - C x
 *
 * repeated from x = 0, lambda = 0 (the method of multipliers: Hestenes, Multiplier and gradient methods, 1969). Each iteration reduces s
 * by a factor that is the smaller the larger W is, and its fixed point does not depend on W, so that W costs no digits. The matrix is
 * definite if C leaves no massless direction free, even if M is singular or constraints are redundant. Of multipliers that are not
 * unique these are the smallest, sum lambda_k^2 / W_k = min, as they are W times a vector in the range of C: with 1 / W_k proportional
 * to C_k M^-1 C_k^T, those of minimum effect, see constraints/rank.c. As such weights may reduce s slowly, if M has a light direction
 * within a block, x is found with weights by its diagonal.
 *
 * Near a bifurcation, s decreases slowly along the smallest singular values of C: there W is raised. It is not larger everywhere, as the
 * solutions of an iteration lose the digits of W. Redundant constraints may have a part of s that no x removes, and which stays: so the
 * decrease is that of C dx.
 */
#include "structured.h"

#include <math.h>

#include "../../constraints/rank.h"
#include "../../linalg/small.h"
#include "../../point/point.h"

enum { MAX_ITERATIONS = 40, MAX_FOR_MULTIPLIERS = 240 };     /* reductions of s by a tenth each: the latter leave BALANCED of it */
static const double WEIGHT = 0x1p25;            /* weight of a constraint relative to the mass its bodies have along it */
static const double RAISE = 0x1p8;              /* factor by which it is raised where the iterations converge slowly, */
static const double MAX_RAISED = 0x1p16;        /* and by which it can be altogether */
static const double SLOW = 0.25;                /* decrease of C dx in an iteration that is slow */
/* C dx relative to the terms of C x, or of x without constraints, with which x has converged */
static const double CONVERGED = 0x1p-40;
static const double BALANCED = 0x1p-36;         /* residual relative to the terms of the equations with which the reactions have converged */
static const double RESIDUAL_ROUNDING = 4 * 0x1p-52;     /* residual relative to these terms that needs no refinement */

static void *create(zd_arena *arena, const void *of)
{
    const zd_system *system = of;
    const size_t n = system->nv, m = zd_constraints(system);
    zd_bodywise self = {
        .weight = zd_arena_doubles(arena, m),
        .least_weight = zd_arena_doubles(arena, m),
        .inverse = zd_arena_doubles(arena, zd_size_of_M(system)),
        .unbalanced = zd_arena_doubles(arena, n),
        .step = zd_arena_doubles(arena, n),
        .residual = zd_arena_doubles(arena, m),
        .lambda = zd_arena_doubles(arena, m),
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

/* True if M is diagonal, so that effect() and effect_by_diagonal() agree. */
static int is_diagonal(const zd_layout *layout)
{
    int is = 1;
    for (int b = 0; b < layout->blocks; b++) is &= layout->is_diagonal[b];
    return is;
}

zd_bodywise *zd_bodywise_create(zd_store *store, const zd_point *point)
{
    const zd_rank *rank = point->rank;
    const int are_determined = rank->max_rank == rank->m && rank->m <= rank->n, has_other = !are_determined && !is_diagonal(point->layout);
    zd_bodies *bodies = zd_bodies_create(store, point->system, point->layout, NULL);
    zd_bodies *other = has_other ? zd_bodies_create(store, point->system, point->layout, NULL) : NULL;
    zd_bodywise *self = bodies && (other || !has_other) ? zd_store_create(store, create, point->system) : NULL;
    if (!self) return NULL;
    self->layout = point->layout;
    self->bodies = bodies;
    self->for_least = other;
    return self;
}

/* ---- factors ---- */

/* Effect C_k M^-1 C_k^T of a constraint; if M is singular, the squared norm of the row over the largest mass. */
static double effect(const zd_bodywise *self, const zd_row_of_C *row, int has_inverse, double mass)
{
    const zd_layout *layout = self->layout;
    double sum = 0;
    if (!has_inverse) return zd_dot(row->count, row->x, row->x) / mass;
    for (int j = 0; j < row->count;) {
        const int b = layout->block_of[row->column[j]], n = layout->velocity_at[b + 1] - layout->velocity_at[b];
        const double *L = self->inverse + layout->M_at[b], *c = row->x + j;
        for (int i = 0; layout->is_diagonal[b] && i < n; i++) sum += c[i] * L[i] * c[i];
        if (!layout->is_diagonal[b]) zd_forward(n, L, c, self->step);
        if (!layout->is_diagonal[b]) sum += zd_metric_dot(n, L, self->step, self->step);
        j += n;
    }
    return sum;
}

/* Diagonal entry of M. Massless directions get the largest mass. */
static double mass_along(const zd_point *point, int i, double mass)
{
    const double own = zd_entry_of_M(point, i, i);
    return own > ZD_MIN_PIVOT * mass ? own : mass;
}

/* The same with the diagonal of M: then W is not much smaller than M in any direction. */
static double effect_by_diagonal(const zd_point *point, const zd_row_of_C *row, double mass)
{
    double sum = 0;
    for (int j = 0; j < row->count; j++) sum += row->x[j] * row->x[j] / mass_along(point, row->column[j], mass);
    return sum;
}

static double largest_mass(const zd_point *point)
{
    double mass = 0;
    for (int i = 0; i < point->system->nv; i++) mass = fmax(mass, zd_entry_of_M(point, i, i));
    return mass > 0 ? mass : 1;
}

/* Forms and factors M + C^T W C at the point; returns as zd_bodies_factor(). */
static int factor(const zd_bodywise *self, zd_bodies *bodies, const double *weight)
{
    zd_blocks_clear(bodies->blocks);
    zd_bodies_add_mass(bodies, self->point->terms.M);
    zd_bodies_add_rows(bodies, self->C, weight);
    return zd_bodies_factor(bodies);
}

int zd_bodywise_factor(zd_bodywise *self, zd_point *point)
{
    const double mass = largest_mass(point);
    self->point = point;
    self->C = point->terms.C;
    self->is_least_known = 0;
    self->raised = 1;
    for (int k = 0; k < zd_constraints(point->system); k++) {
        const zd_row_of_C row = zd_point_row(point, k);
        const double square = effect_by_diagonal(point, &row, mass);
        self->weight[k] = square > 0 ? WEIGHT / square : 0;
    }
    const int failed = factor(self, self->bodies, self->weight);
    if (failed >= 0) point->failed_index = failed;
    return failed < 0 ? ZD_DONE : ZD_NOT_DEFINITE;
}

/* Factors with larger weights; returns 0 if there are none, and the factors are as before. */
static int raise_weights(zd_bodywise *self)
{
    const int m = zd_constraints(self->point->system);
    if (self->raised >= MAX_RAISED) return 0;
    for (int k = 0; k < m; k++) self->weight[k] *= RAISE;
    if (factor(self, self->bodies, self->weight) < 0) {
        self->raised *= RAISE;
        return 1;
    }
    for (int k = 0; k < m; k++) self->weight[k] /= RAISE;
    (void)factor(self, self->bodies, self->weight);
    return 0;
}

/* Factors with the weights of minimum effect, if required; returns 0 if there are no such factors. */
static int need_least(zd_bodywise *self)
{
    const zd_point *point = self->point;
    if (!self->for_least || self->is_least_known) return self->for_least != NULL;
    const int has_inverse = zd_mass_factor(point, self->inverse) == point->system->nv;
    const double mass = largest_mass(point);
    for (int k = 0; k < zd_constraints(point->system); k++) {
        const zd_row_of_C row = zd_point_row(point, k);
        const double square = effect(self, &row, has_inverse, mass);
        self->least_weight[k] = square > 0 ? WEIGHT / square : 0;
    }
    return self->is_least_known = factor(self, self->for_least, self->least_weight) < 0;
}

/* ---- solution ---- */

/* unbalanced <- force - M x - C^T lambda. Returns its largest entry relative to the largest of its terms. */
static double find_unbalanced(zd_bodywise *self, const double *force, const double *x)
{
    const int n = self->point->system->nv, m = zd_constraints(self->point->system);
    double *b = self->unbalanced, *size = self->step, largest = 0, worst = 0;
    zd_times_M(self->point, self->point->terms.M, x, b);
    for (int i = 0; i < n; i++) {
        const double given = force ? force[i] : 0;
        size[i] = fabs(given) + fabs(b[i]);
        b[i] = given - b[i];
    }
    for (int k = 0; k < m; k++) {
        const zd_row_of_C row = zd_packed_row(self->layout, self->C, k);
        for (int j = 0; j < row.count; j++) {
            const double reaction = row.x[j] * self->lambda[k];
            b[row.column[j]] -= reaction, size[row.column[j]] += fabs(reaction);
        }
    }
    for (int i = 0; i < n; i++) largest = fmax(largest, size[i]), worst = fmax(worst, fabs(b[i]));
    return worst > 0 ? worst / largest : 0;
}

/* step <- (M + C^T W C)^-1 (unbalanced + C^T W residual), lambda <- lambda + W (C step - residual); residual NULL: zero. Returns the
 * square of the largest entry of C step in the metric W. */
static double improve(zd_bodywise *self, zd_bodies *bodies, const double *weight, const double *residual)
{
    const int m = zd_constraints(self->point->system);
    double largest = 0;
    for (int k = 0; residual && k < m; k++) {
        const zd_row_of_C row = zd_packed_row(self->layout, self->C, k);
        for (int j = 0; j < row.count; j++) self->unbalanced[row.column[j]] += weight[k] * residual[k] * row.x[j];
    }
    zd_bodies_solve(bodies, self->unbalanced, self->step);
    for (int k = 0; k < m; k++) {
        const zd_row_of_C row = zd_packed_row(self->layout, self->C, k);
        const double along = zd_row_times(&row, self->step);
        self->lambda[k] += weight[k] * (along - (residual ? residual[k] : 0));       /* (8) */
        largest = fmax(largest, weight[k] * along * along);
    }
    return largest;
}

/* Multipliers from C^T lambda = force - M x alone, once C x = rhs: they then contain neither W times the rounding of rhs - C x nor its
 * part outside the range of C. Returns the relative residual. */
static double find_multipliers(zd_bodywise *self, zd_bodies *bodies, const double *weight, const double *force, const double *x)
{
    double before = INFINITY, left = INFINITY;
    zd_clear(zd_constraints(self->point->system), self->lambda);
    for (int i = 0; i < MAX_FOR_MULTIPLIERS; i++) {
        left = find_unbalanced(self, force, x);
        if (!(left > RESIDUAL_ROUNDING) || (i > 1 && !(left < 0.9 * before))) break;
        before = left;
        (void)improve(self, bodies, weight, NULL);
    }
    return left;
}

/* Square of the largest acceleration without constraints, in the metric W before it was raised. */
static double square_without_constraints(const zd_bodywise *self, const double *force)
{
    const zd_point *point = self->point;
    const double mass = largest_mass(point);
    double square = 0;
    for (int i = 0; force && i < point->system->nv; i++) square = fmax(square, WEIGHT * force[i] * force[i] / mass_along(point, i, mass));
    return square;
}

/* x, from zero, and self->lambda with it. `change`: of C dx in the last iteration, in the metric W before it was raised, squared. Where
 * nothing can move, x consists of the rounding of accelerations without constraints. The second iteration takes back what W has yielded
 * to the force in the first: so decreases are those from the third on. */
static void iterate(zd_bodywise *self, const double *force, const double *rhs, double *x)
{
    const int n = self->point->system->nv;
    double before = INFINITY, change = INFINITY, change_before = INFINITY, square;
    for (int i = 0; i < MAX_ITERATIONS; i++) {
        const double residual = zd_packed_residual(self->layout, self->C, zd_constraints(self->point->system), rhs, x, self->weight,
                                                   self->residual, &square);
        const double left = fmax(find_unbalanced(self, force, x), residual);
        if (!(left > RESIDUAL_ROUNDING)) break;
        const int is_slow = i > 1 && !(left < 0.5 * before);
        if (is_slow) {
            const double scale = fmax(square / self->raised, square_without_constraints(self, force));
            if (!(change > CONVERGED * CONVERGED * scale)) break;
            const int is_raised = i > 2 && change > SLOW * SLOW * change_before && raise_weights(self);
            if (i > 2 && !is_raised && !(change < change_before)) break;
        }
        before = left;
        change_before = change;
        change = improve(self, self->bodies, self->weight, self->residual) / self->raised;
        for (int j = 0; j < n; j++) x[j] += self->step[j];
    }
}

void zd_bodywise_solve(zd_bodywise *self, const double *force, const double *rhs, double *x, double *lambda)
{
    const int n = self->point->system->nv, m = zd_constraints(self->point->system);
    zd_clear(n, x);
    zd_clear(m, self->lambda);
    iterate(self, force, rhs, x);
    if (!lambda) return;
    const int is_least = need_least(self) && find_multipliers(self, self->for_least, self->least_weight, force, x) < BALANCED;
    if (!is_least) (void)find_multipliers(self, self->bodies, self->weight, force, x);
    zd_copy_all(m, self->lambda, lambda);
}
