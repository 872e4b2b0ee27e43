#include "dense.h"

#include <math.h>
#include <string.h>

#include "small.h"

static const double REGULAR = 1e-3;     /* relative pivot above which rows are far from redundant */
enum { TOGETHER = 4 };

zd_row_space zd_row_space_create(zd_arena *arena, int most, int n)
{
    const size_t rows = most, columns = n;
    return (zd_row_space){
        .n = n, .most = most, .A = zd_arena_doubles(arena, rows * columns), .diagonal = zd_arena_doubles(arena, columns),
        .factor = zd_arena_doubles(arena, columns), .norm = zd_arena_doubles(arena, rows), .order = zd_arena_ints(arena, rows),
        .T = zd_arena_doubles(arena, columns * rows), .y = zd_arena_doubles(arena, columns), .c = zd_arena_doubles(arena, rows),
    };
}

/* Makes the reflection v, in place of x (n,), that turns x into a multiple of the first unit vector, which is returned. */
static double make_reflection(int n, double *x, double norm, double *factor)
{
    const double sign = x[0] < 0 ? -1 : 1;
    x[0] += sign * norm;
    *factor = 2 / zd_dot(n, x, x);
    return -sign * norm;
}

/* Reflects `count` rows of n columns, `stride` apart. */
static void reflect(int n, const double *v, double factor, int count, int stride, double *rows)
{
    double dots[TOGETHER];
    int k = 0;
    for (; k + TOGETHER <= count; k += TOGETHER, rows += TOGETHER * stride) {
        zd_four_dots(n, rows, stride, v, dots);
        for (int r = 0; r < TOGETHER; r++) zd_add_scaled(n, rows + r * stride, -factor * dots[r], v);
    }
    for (; k < count; k++, rows += stride) zd_add_scaled(n, rows, -factor * zd_dot(n, v, rows), v);
}

static double norm_of(int n, const double *x)
{
    return sqrt(zd_dot(n, x, x));
}

/* Exchanges row k with the row of the largest remaining norm. */
static void bring_longest(zd_row_space *self, int k)
{
    int longest = k;
    for (int i = k + 1; i < self->rows; i++)
        if (self->norm[i] > self->norm[longest]) longest = i;
    if (longest == k) return;
    const int number = self->order[k];
    const double norm = self->norm[k];
    double *row = self->A + k * self->n, *other = self->A + longest * self->n;
    self->order[k] = self->order[longest], self->order[longest] = number;
    self->norm[k] = self->norm[longest], self->norm[longest] = norm;
    for (int i = 0; i < self->n; i++) {
        const double kept = row[i];
        row[i] = other[i], other[i] = kept;
    }
}

void zd_row_space_factor(zd_row_space *self, int rows, double share, double least)
{
    const int n = self->n;
    self->rows = rows;
    self->rank = self->is_square = 0;
    for (int i = 0; i < rows; i++) {
        self->order[i] = i;
        self->norm[i] = norm_of(n, self->A + i * n);
    }
    double bound = least;
    for (int k = 0; k < rows && k < n; k++) {
        double *row = self->A + k * n;
        bring_longest(self, k);
        if (k == 0) bound = fmax(least, share * self->norm[0]);
        if (!(self->norm[k] > bound) || !(self->norm[k] < INFINITY)) return;
        self->diagonal[k] = make_reflection(n - k, row + k, self->norm[k], self->factor + k);
        reflect(n - k, row + k, self->factor[k], rows - k - 1, n, row + n + k);
        for (int i = k + 1; i < rows; i++) self->norm[i] = norm_of(n - k - 1, self->A + i * n + k + 1);
        self->rank = k + 1;
    }
}

void zd_row_space_prepare(zd_row_space *self, int rows, double share, double least)
{
    const int n = self->n;
    double first = INFINITY, last = 0;      /* smallest and largest reciprocal of a pivot */
    if (rows == n && zd_lu_factor(n, memcpy(self->T, self->A, n * n * sizeof *self->T), self->order) == n)
        for (int k = 0; k < n; k++) {
            const double size = fabs(self->T[k * n + k]);
            if (size < first) first = size;
            if (size > last) last = size;
        }
    self->pivot = last > 0 ? first / last : 0;
    if (self->pivot > REGULAR && last * least < 1) {
        self->rows = self->rank = n;
        self->is_square = 1;
        return;
    }
    zd_row_space_factor(self, rows, share, least);
    self->pivot = self->rank < n ? 0 : fabs(self->diagonal[n - 1] / self->diagonal[0]);
}

void zd_row_space_turn(const zd_row_space *self, double *x)
{
    for (int k = 0; k < self->rank; k++) reflect(self->n - k, self->A + k * self->n + k, self->factor[k], 1, self->n, x + k);
}

void zd_row_space_turn_back(const zd_row_space *self, double *x)
{
    for (int k = self->rank - 1; k >= 0; k--) reflect(self->n - k, self->A + k * self->n + k, self->factor[k], 1, self->n, x + k);
}

/* y <- solution of L y = c */
static void solve_triangle(const zd_row_space *self, const double *c, double *y)
{
    for (int k = 0; k < self->rank; k++) y[k] = (c[k] - zd_dot(k, self->A + k * self->n, y)) / self->diagonal[k];
}

/* y <- least-squares solution of [L; B] y = c, by reflections of its columns */
static void solve_trapezoid(zd_row_space *self, double *c, double *y)
{
    const int rows = self->rows, rank = self->rank;
    double *T = self->T;
    for (int i = 0; i < rank; i++)
        for (int j = 0; j < rows; j++) T[i * rows + j] = j < i ? 0 : j == i ? self->diagonal[i] : self->A[j * self->n + i];
    for (int i = 0; i < rank; i++) {
        double *column = T + i * rows + i, factor, norm = norm_of(rows - i, column);
        const double pivot = make_reflection(rows - i, column, norm, &factor);
        reflect(rows - i, column, factor, rank - i - 1, rows, column + rows);
        reflect(rows - i, column, factor, 1, rows, c + i);
        y[i] = pivot;
    }
    for (int i = rank - 1; i >= 0; i--) {
        double sum = c[i];
        for (int k = i + 1; k < rank; k++) sum -= T[k * rows + i] * y[k];
        y[i] = sum / y[i];
    }
}

void zd_row_space_solve(zd_row_space *self, const double *right, double *x)
{
    if (self->is_square) {
        zd_lu_solve(self->n, self->T, self->order, memcpy(x, right, self->n * sizeof *x));
        return;
    }
    for (int i = 0; i < self->rows; i++) self->c[i] = right[self->order[i]];
    if (self->rank == self->rows) solve_triangle(self, self->c, self->y);
    else solve_trapezoid(self, self->c, self->y);
    for (int i = 0; i < self->n; i++) x[i] = i < self->rank ? self->y[i] : 0;
    zd_row_space_turn_back(self, x);
}
