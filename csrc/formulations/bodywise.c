/* Equations (8) with a matrix that bodies couple in,
 *
 *     (M + C^T W C) dx = r + C^T W s,        dlambda = W (C dx - s),        r = force - M x - C^T lambda,  s = rhs - C x
 *
 * again and again from x = 0, lambda = 0 (the method of multipliers: Hestenes, Multiplier and gradient methods, 1969). Each time leaves of s
 * a part that is the smaller the larger W is, and each time the equations are those without W, so that W costs no digits. The matrix is
 * definite where C leaves free nothing that has no mass, whether or not M is, and whether or not rows of C follow from others. Of multipliers
 * that are not determined these are the smallest, sum lambda_k^2 / W_k = min, as they are W times what is in the range of C: with 1 / W_k
 * proportional to C_k M^-1 C_k^T, those of least effect, see constraints/rank.c.
 */
#include "bodywise.h"

#include <math.h>
#include <string.h>

#include "../linalg/small.h"
#include "../point/mass.h"
#include "../point/matrices.h"

enum { MAX_ITERATIONS = 12 };
static const double WEIGHT = 0x1p22;            /* of a row in units of what its bodies have as mass in it */
static const double ROUNDING = 4 * 0x1p-52;     /* of the terms of the equations: nothing to be corrected */

typedef struct plan {
    const zd_layout *layout;
    const zd_system *system;
    zd_pattern pattern;
    zd_ordering ordering;
} plan;

static int bodies_of(const zd_layout *layout, int g) { return layout->touched_at[g + 1] - layout->touched_at[g]; }

static int count_pairs(const zd_layout *layout)
{
    int pairs = 0;
    for (int g = 0; g < layout->groups; g++) pairs += bodies_of(layout, g) * (bodies_of(layout, g) + 1) / 2;
    return pairs;
}

static void fill(zd_bodywise *self)
{
    const zd_layout *layout = self->layout;
    int next = 0;
    for (int b = 0; b < layout->blocks; b++) self->body_at[b] = self->blocks->at[self->blocks->place[b]];
    for (int g = 0; g < layout->groups; g++)
        for (int i = layout->touched_at[g]; i < layout->touched_at[g + 1]; i++)
            for (int j = layout->touched_at[g]; j <= i; j++)
                self->pair[next++] = zd_blocks_find(self->blocks, layout->touched[i], layout->touched[j]);
}

static void *take(zd_arena *arena, const void *of)
{
    const plan *it = of;
    const size_t n = (size_t)it->system->nv, m = (size_t)zd_constraints(it->system);
    zd_bodywise self = {
        .layout = it->layout,
        .blocks = zd_blocks_take(arena, &it->ordering),
        .body_at = zd_take(arena, (size_t)it->layout->blocks * sizeof(int)),
        .pair = zd_take(arena, (size_t)count_pairs(it->layout) * sizeof(int)),
        .weight = zd_take_doubles(arena, m),
        .inverse = zd_take_doubles(arena, (size_t)zd_size_of_M(it->system)),
        .unbalanced = zd_take_doubles(arena, n),
        .step = zd_take_doubles(arena, n),
        .rest = zd_take_doubles(arena, m),
        .lambda = zd_take_doubles(arena, m),
    };
    if (arena->base) fill(&self);
    return zd_take_filled(arena, &self, sizeof self);
}

zd_bodywise *zd_bodywise_create(zd_store *store, const zd_point *point)
{
    const zd_layout *layout = point->layout;
    plan it = {.layout = layout, .system = point->system};
    it.pattern = (zd_pattern){layout->blocks, point->system->structure->velocities, layout->groups, layout->touched_at, layout->touched};
    if (!zd_ordering_find(&it.pattern, &it.ordering)) return NULL;
    zd_bodywise *self = zd_store_take(store, take, &it);
    zd_ordering_free(&it.ordering);
    return self;
}

/* ---- factors ---- */

/* C_k M^-1 C_k^T; or where M has no inverse, the squared length of the row over the largest mass. */
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

static void set_weights(zd_bodywise *self, const zd_point *point)
{
    const int n = point->system->nv, has_inverse = zd_mass_factor(point, self->inverse) == n;
    double mass = 0;
    for (int i = 0; i < n; i++) mass = fmax(mass, zd_entry_of_M(point, i, i));
    for (int k = 0; k < zd_constraints(point->system); k++) {
        const zd_row_of_C row = zd_point_row(point, k);
        const double square = effect(self, &row, has_inverse, mass > 0 ? mass : 1);
        self->weight[k] = square > 0 ? WEIGHT / square : 0;
    }
}

static void add_mass(zd_bodywise *self, const double *M)
{
    const zd_layout *layout = self->layout;
    for (int b = 0; b < layout->blocks; b++) {
        const int n = layout->velocity_at[b + 1] - layout->velocity_at[b];
        double *to = self->blocks->S + zd_blocks_find(self->blocks, b, b);
        const double *own = M + layout->M_at[b];
        for (int i = 0; i < (layout->is_diagonal[b] ? n : n * n); i++) to[layout->is_diagonal[b] ? i * (n + 1) : i] = own[i];
    }
}

/* to (a, b) <- to + A^T W B of `rows` rows that are `stride` apart; the other way round where the first is eliminated first. */
static void add_product(const double *A, int a, const double *B, int b, const double *W, int rows, int stride, int is_later, double *to)
{
    for (int k = 0; k < rows; k++, A += stride, B += stride)
        for (int i = 0; i < a; i++) {
            const double weighted = W[k] * A[i];
            for (int j = 0; j < b; j++) to[is_later ? i * b + j : j * a + i] += weighted * B[j];
        }
}

/* C^T W C of one group; returns the next of its pairs. */
static const int *add_group(zd_bodywise *self, int g, const int *pair)
{
    const zd_layout *layout = self->layout;
    const int rows = layout->row_at[g + 1] - layout->row_at[g], *velocity_at = layout->velocity_at, *place = self->blocks->place;
    const double *W = self->weight + layout->row_at[g], *A = self->C + layout->C_at[g];
    for (int i = layout->touched_at[g]; i < layout->touched_at[g + 1]; i++) {
        const int one = layout->touched[i], a = velocity_at[one + 1] - velocity_at[one];
        const double *B = self->C + layout->C_at[g];
        for (int j = layout->touched_at[g]; j <= i; j++) {
            const int other = layout->touched[j], b = velocity_at[other + 1] - velocity_at[other];
            add_product(A, a, B, b, W, rows, layout->width[g], place[one] >= place[other], self->blocks->S + *pair++);
            B += b;
        }
        A += a;
    }
    return pair;
}

int zd_bodywise_factor(zd_bodywise *self, zd_point *point)
{
    self->point = point;
    self->C = point->terms.C;
    set_weights(self, point);
    zd_blocks_clear(self->blocks);
    add_mass(self, point->terms.M);
    const int *pair = self->pair;
    for (int g = 0; g < self->layout->groups; g++) pair = add_group(self, g, pair);
    const zd_pivots pivots = zd_blocks_factor(self->blocks, NULL, 0);
    if (pivots.failed < 0) return ZD_DONE;
    for (int b = 0; b < self->layout->blocks; b++) {
        const int n = self->layout->velocity_at[b + 1] - self->layout->velocity_at[b], off = pivots.failed - self->body_at[b];
        if (off >= 0 && off < n) point->failed_index = self->layout->velocity_at[b] + off;
    }
    return ZD_NOT_DEFINITE;
}

/* ---- solution ---- */

/* x <- (M + C^T W C)^-1 b */
static void eliminate(zd_bodywise *self, const double *b, double *x)
{
    const zd_layout *layout = self->layout;
    double *y = self->blocks->x;
    for (int i = 0; i < layout->blocks; i++)
        memcpy(y + self->body_at[i], b + layout->velocity_at[i], (size_t)(layout->velocity_at[i + 1] - layout->velocity_at[i]) * sizeof *y);
    zd_blocks_solve(self->blocks, y);
    for (int i = 0; i < layout->blocks; i++)
        memcpy(x + layout->velocity_at[i], y + self->body_at[i], (size_t)(layout->velocity_at[i + 1] - layout->velocity_at[i]) * sizeof *y);
}

/* unbalanced <- force - M x - C^T lambda + C^T W rest, rest <- rhs - C x. Returns how much of them is left, in units of what their terms are;
 * of the former without W. */
static double find_rest(zd_bodywise *self, const double *force, const double *rhs, const double *x)
{
    const int n = self->point->system->nv, m = zd_constraints(self->point->system);
    double left = 0, *b = self->unbalanced, *size = self->step;
    zd_times_M(self->point, self->point->terms.M, x, b);
    for (int i = 0; i < n; i++) {
        const double given = force ? force[i] : 0;
        size[i] = fabs(given) + fabs(b[i]);
        b[i] = given - b[i];
    }
    for (int k = 0; k < m; k++) {
        const zd_row_of_C row = zd_packed_row(self->layout, self->C, k);
        double sum = rhs[k], terms = fabs(rhs[k]);
        for (int j = 0; j < row.count; j++) {
            const double term = row.x[j] * x[row.column[j]], reaction = row.x[j] * self->lambda[k];
            sum -= term, terms += fabs(term);
            b[row.column[j]] -= reaction, size[row.column[j]] += fabs(reaction);
        }
        self->rest[k] = sum;
        if (fabs(sum) > left * terms) left = fabs(sum) / terms;
    }
    double largest = 0, worst = 0;
    for (int i = 0; i < n; i++) largest = fmax(largest, size[i]), worst = fmax(worst, fabs(b[i]));
    for (int k = 0; k < m; k++) {
        const zd_row_of_C row = zd_packed_row(self->layout, self->C, k);
        for (int j = 0; j < row.count; j++) b[row.column[j]] += self->weight[k] * self->rest[k] * row.x[j];
    }
    return worst > left * largest ? worst / largest : left;
}

void zd_bodywise_solve(zd_bodywise *self, const double *force, const double *rhs, double *x, double *lambda)
{
    const int n = self->point->system->nv, m = zd_constraints(self->point->system);
    memset(x, 0, (size_t)n * sizeof *x);
    memset(self->lambda, 0, (size_t)m * sizeof *x);
    double before = INFINITY;
    for (int i = 0; i < MAX_ITERATIONS; i++) {
        const double left = find_rest(self, force, rhs, x);
        if (!(left > ROUNDING) || (i > 1 && !(left < 0.25 * before))) break;
        before = left;
        eliminate(self, self->unbalanced, self->step);
        for (int k = 0; k < m; k++) {
            const zd_row_of_C row = zd_packed_row(self->layout, self->C, k);
            self->lambda[k] += self->weight[k] * (zd_row_times(&row, self->step) - self->rest[k]);      /* (8) */
        }
        for (int j = 0; j < n; j++) x[j] += self->step[j];
    }
    if (lambda) memcpy(lambda, self->lambda, (size_t)m * sizeof *lambda);
}
