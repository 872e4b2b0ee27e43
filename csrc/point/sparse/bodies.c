#include "bodies.h"

#include "../../linalg/small.h"
#include "../../linalg/sparse/blocks.h"

typedef struct plan {
    const zd_layout *layout;
    zd_pattern pattern;
    zd_ordering ordering;
} plan;

static int bodies_of(const zd_layout *layout, int g) { return layout->touched_at[g + 1] - layout->touched_at[g]; }
static int size_of(const zd_layout *layout, int b) { return layout->velocity_at[b + 1] - layout->velocity_at[b]; }

/* ---- symbolic ---- */

static int count_pairs(const zd_layout *layout)
{
    int pairs = 0;
    for (int g = 0; g < layout->groups; g++) pairs += bodies_of(layout, g) * (bodies_of(layout, g) + 1) / 2;
    return pairs;
}

static void fill(zd_bodies *self)
{
    const zd_layout *layout = self->layout;
    int next = 0;
    for (int b = 0; b < layout->blocks; b++) self->at[b] = self->blocks->at[self->blocks->place[b]];
    for (int g = 0; g < layout->groups; g++)
        for (int i = layout->touched_at[g]; i < layout->touched_at[g + 1]; i++)
            for (int j = layout->touched_at[g]; j <= i; j++)
                self->pair[next++] = zd_blocks_find(self->blocks, layout->touched[i], layout->touched[j]);
}

static void *create(zd_arena *arena, const void *of)
{
    const plan *it = of;
    zd_bodies self = {
        .layout = it->layout,
        .blocks = zd_blocks_create(arena, &it->ordering),
        .at = zd_arena_ints(arena, it->layout->blocks),
        .pair = zd_arena_ints(arena, count_pairs(it->layout)),
    };
    if (arena->base) fill(&self);
    return zd_arena_copy(arena, &self, sizeof self);
}

zd_bodies *zd_bodies_create(zd_store *store, const zd_system *system, const zd_layout *layout, const int *order)
{
    plan it = {.layout = layout};
    it.pattern = (zd_pattern){layout->blocks, system->structure->velocities, layout->groups, layout->touched_at, layout->touched};
    if (!zd_ordering_find(&it.pattern, order, &it.ordering)) return NULL;
    zd_bodies *self = zd_store_create(store, create, &it);
    zd_ordering_free(&it.ordering);
    return self;
}

/* ---- numbers ---- */

void zd_bodies_add_mass(zd_bodies *self, const double *M)
{
    const zd_layout *layout = self->layout;
    for (int b = 0; b < layout->blocks; b++) {
        const int n = size_of(layout, b);
        double *to = self->blocks->S + zd_blocks_find(self->blocks, b, b);
        const double *own = M + layout->M_at[b];
        for (int i = 0; i < (layout->is_diagonal[b] ? n : n * n); i++) to[layout->is_diagonal[b] ? i * (n + 1) : i] += own[i];
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
static const int *add_group(zd_bodies *self, int g, const double *C, const double *W, const int *pair)
{
    const zd_layout *layout = self->layout;
    const int rows = layout->row_at[g + 1] - layout->row_at[g], *place = self->blocks->place;
    const double *A = C + layout->C_at[g];
    for (int i = layout->touched_at[g]; i < layout->touched_at[g + 1]; i++) {
        const int one = layout->touched[i], a = size_of(layout, one);
        const double *B = C + layout->C_at[g];
        for (int j = layout->touched_at[g]; j <= i; j++) {
            const int other = layout->touched[j], b = size_of(layout, other);
            add_product(A, a, B, b, W + layout->row_at[g], rows, layout->width[g], place[one] >= place[other], self->blocks->S + *pair++);
            B += b;
        }
        A += a;
    }
    return pair;
}

void zd_bodies_add_rows(zd_bodies *self, const double *C, const double *W)
{
    const int *pair = self->pair;
    for (int g = 0; g < self->layout->groups; g++) pair = add_group(self, g, C, W, pair);
}

int zd_bodies_factor(zd_bodies *self)
{
    self->is_triangular = 1;
    const int failed = zd_triangular_factor(self->blocks);
    return failed < 0 ? -1 : zd_bodies_velocity(self, failed);
}

zd_pivots zd_bodies_leave_out(zd_bodies *self, unsigned char *left_out, double least)
{
    self->is_triangular = 0;
    return zd_blocks_factor(self->blocks, left_out, least, NULL);
}

void zd_bodies_solve(zd_bodies *self, const double *b, double *x)
{
    const zd_layout *layout = self->layout;
    double *y = self->blocks->x;
    for (int i = 0; i < layout->blocks; i++) zd_copy_all(size_of(layout, i), b + layout->velocity_at[i], y + self->at[i]);
    if (self->is_triangular) zd_triangular_solve(self->blocks, y);
    else zd_blocks_solve(self->blocks, y);
    for (int i = 0; i < layout->blocks; i++) zd_copy_all(size_of(layout, i), y + self->at[i], x + layout->velocity_at[i]);
}

int zd_bodies_velocity(const zd_bodies *self, int place)
{
    const zd_layout *layout = self->layout;
    for (int b = 0; b < layout->blocks; b++)
        if (place >= self->at[b] && place < self->at[b] + size_of(layout, b)) return layout->velocity_at[b] + place - self->at[b];
    return 0;
}
