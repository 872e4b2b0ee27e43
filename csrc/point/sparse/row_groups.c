/* Kernels are for bodies of the plane and of space, one or two of them, and groups of as many rows as common joints have. */
#include "row_groups.h"

#include "../../linalg/small.h"

static int is_known(int n, int rows)
{
    return n == 3 ? rows <= 3 : n == 6 && (rows == 1 || rows == 3 || rows == 5 || rows == 6);
}

static int kernel_of(const zd_layout *layout, int g)
{
    const int first = layout->touched_at[g], bodies = layout->touched_at[g + 1] - first, rows = layout->row_at[g + 1] - layout->row_at[g];
    const int n = layout->width[g] / bodies;
    if (bodies > 2 || !is_known(n, rows)) return 0;
    for (int i = first; i < first + bodies; i++) {
        const int b = layout->touched[i];
        if (layout->velocity_at[b + 1] - layout->velocity_at[b] != n) return 0;
    }
    return 100 * bodies + 10 * n + rows;
}

static zd_row_group row_group_of(const zd_layout *layout, int g, int y)
{
    zd_row_group group = {
        .kernel = kernel_of(layout, g),
        .C = layout->C_at[g],
        .rows = layout->row_at[g + 1] - layout->row_at[g],
        .width = layout->width[g],
        .row = layout->row_at[g],
        .y = y,
        .column = layout->column_at[g],
    };
    for (int i = 0; group.kernel && i < layout->touched_at[g + 1] - layout->touched_at[g]; i++) {
        const int b = layout->touched[layout->touched_at[g] + i];
        group.x[i] = layout->velocity_at[b];
        group.W[i] = layout->M_at[b];
    }
    return group;
}

zd_row_groups zd_row_groups_create(zd_arena *arena, const zd_layout *layout, const int *y)
{
    const int rows = layout->row_at[layout->groups];
    zd_row_groups self = {
        .count = layout->groups,
        .group = zd_arena_bytes(arena, layout->groups * sizeof(zd_row_group)),
        .column = layout->column,
        .rows = rows,
        .place = zd_arena_ints(arena, rows),
        .are_pairs = 1,
    };
    for (int g = 0; arena->base && g < layout->groups; g++) {
        self.group[g] = row_group_of(layout, g, y[g]);
        self.are_pairs &= self.group[g].rows == 2;
        for (int k = layout->row_at[g]; k < layout->row_at[g + 1]; k++) self.place[k] = y[g] + k - layout->row_at[g];
    }
    return self;
}

#define CASE(step, bodies, n, rows, ...) \
    case 100 * bodies + 10 * n + rows: step(bodies, n, rows, __VA_ARGS__); break;
#define CASES(step, bodies, ...)          \
    CASE(step, bodies, 3, 1, __VA_ARGS__) \
    CASE(step, bodies, 3, 2, __VA_ARGS__) \
    CASE(step, bodies, 3, 3, __VA_ARGS__) \
    CASE(step, bodies, 6, 1, __VA_ARGS__) \
    CASE(step, bodies, 6, 3, __VA_ARGS__) \
    CASE(step, bodies, 6, 5, __VA_ARGS__) \
    CASE(step, bodies, 6, 6, __VA_ARGS__)
#define FOR_SIZES(step, any, ...)         \
    switch (group->kernel) {              \
        CASES(step, 1, __VA_ARGS__)      \
        CASES(step, 2, __VA_ARGS__)      \
    default: any;                         \
    }

/* ---- y <- C x - rhs ---- */

ZD_INLINE void times(const int bodies, const int n, const int rows, const zd_row_group *group, const double *C, const double *x,
                     const double *rhs, double *y)
{
    const double *x1 = x + group->x[0], *x2 = x + group->x[1];
    C += group->C;
    y += group->y;
    for (int i = 0; i < rows; i++) {
        const double *row = C + i * bodies * n;
        double sum = (rhs ? -rhs[group->row + i] : 0) + zd_dot(n, row, x1);
        if (bodies == 2) sum += zd_dot(n, row + n, x2);
        y[i] = sum;
    }
}

static void begin(const zd_row_group *group, const double *rhs, double *y)
{
    for (int i = 0; i < group->rows; i++) y[group->y + i] = rhs ? -rhs[group->row + i] : 0;
}

static void times_any(const zd_row_group *group, const int *column, const double *C, const double *x, const double *rhs, double *y)
{
    begin(group, rhs, y);
    column += group->column;
    for (int i = 0; i < group->rows; i++)
        for (int j = 0; j < group->width; j++) y[group->y + i] += C[group->C + i * group->width + j] * x[column[j]];
}

void zd_row_groups_times(const zd_row_groups *self, const double *C, const double *x, const double *rhs, double *y)
{
    const zd_row_group *group = self->group, *end = group + self->count;
    for (; x && rhs && group < end; group++) FOR_SIZES(times, times_any(group, self->column, C, x, rhs, y), group, C, x, rhs, y)
    for (; x && group < end; group++) FOR_SIZES(times, times_any(group, self->column, C, x, NULL, y), group, C, x, NULL, y)
    for (; group < end; group++) begin(group, rhs, y);
}

/* ---- x <- x - C^T y ---- */

ZD_INLINE void subtract_from(const int n, const int rows, const double *C, int width, const double *W, const double *y, double *x)
{
    for (int j = 0; j + 1 < n; j += 2) {
        zd_two sum = zd_scaled_two(y[0], zd_two_at(C + j));
        for (int i = 1; i < rows; i++) sum = zd_plus_two(sum, zd_scaled_two(y[i], zd_two_at(C + i * width + j)));
        if (W) sum = zd_times_two(zd_two_at(W + j), sum);
        zd_store_two(zd_minus_two(zd_two_at(x + j), sum), x + j);
    }
    if (n % 2) {
        double sum = C[n - 1] * y[0];
        for (int i = 1; i < rows; i++) sum += C[i * width + n - 1] * y[i];
        x[n - 1] -= W ? W[n - 1] * sum : sum;
    }
}

ZD_INLINE void subtract(const int bodies, const int n, const int rows, const zd_row_group *group, const double *C, const double *W,
                        const double *y, double *x)
{
    C += group->C;
    y += group->y;
    subtract_from(n, rows, C, bodies * n, W ? W + group->W[0] : NULL, y, x + group->x[0]);
    if (bodies == 2) subtract_from(n, rows, C + n, bodies * n, W ? W + group->W[1] : NULL, y, x + group->x[1]);
}

/* W has an entry for each velocity, where it is all in its diagonal. */
static void subtract_any(const zd_row_group *group, const int *column, const double *C, const double *W, const double *y, double *x)
{
    column += group->column;
    for (int i = 0; i < group->rows; i++)
        for (int j = 0; j < group->width; j++) x[column[j]] -= C[group->C + i * group->width + j] * y[group->y + i] * (W ? W[column[j]] : 1);
}

void zd_row_groups_subtract(const zd_row_groups *self, const double *C, const double *W, const double *y, double *x)
{
    const zd_row_group *group = self->group, *end = group + self->count;
    for (; W && group < end; group++) FOR_SIZES(subtract, subtract_any(group, self->column, C, W, y, x), group, C, W, y, x)
    for (; group < end; group++) FOR_SIZES(subtract, subtract_any(group, self->column, C, NULL, y, x), group, C, NULL, y, x)
}

/* `step` rows at once, contiguous on both sides */
ZD_INLINE void gather(const int step, const zd_row_groups *self, const double *a, const double *b, double *y)
{
    const int rows = self->rows, *place = self->place;
    for (int k = 0; k < rows; k += step)
        for (int i = 0; i < step; i++) y[place[k] + i] = a ? a[k + i] - b[k + i] : -b[k + i];
}

ZD_INLINE void scatter(const int step, const zd_row_groups *self, const double *y, double *rows)
{
    const int count = self->rows, *place = self->place;
    for (int k = 0; k < count; k += step) zd_copy(step, y + place[k], rows + k);
}

void zd_row_groups_gather(const zd_row_groups *self, const double *a, const double *b, double *y)
{
    if (!self->are_pairs) gather(1, self, a, b, y);
    else if (a) gather(2, self, a, b, y);
    else gather(2, self, NULL, b, y);
}

void zd_row_groups_scatter(const zd_row_groups *self, const double *y, double *rows)
{
    if (self->are_pairs) scatter(2, self, y, rows);
    else scatter(1, self, y, rows);
}
