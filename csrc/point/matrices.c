#include "point.h"

#include <math.h>

#include "../linalg/small.h"

/* ---- rows of C ---- */

zd_row_of_C zd_row_in(const zd_point *point, const double *C, int k)
{
    const int n = point->system->nv;
    return point->layout ? zd_packed_row(point->layout, C, k) : (zd_row_of_C){C + k * n, n, NULL};
}

double zd_point_scaled_row(const zd_point *point, int k, const double *scale, double *to)
{
    const int nv = point->system->nv;
    const zd_row_of_C row = zd_point_row(point, k);
    zd_row_expand(&row, nv, to);
    if (zd_largest(nv, to) <= point->rounding[k]) zd_clear(nv, to);
    for (int i = 0; i < nv; i++) to[i] *= scale[i];
    return sqrt(zd_dot(nv, to, to));
}

zd_row_of_C zd_counted_row(const zd_point *point, int k)
{
    const int n = point->system->nv;
    return point->C == point->terms.C ? zd_point_row(point, k) : (zd_row_of_C){point->C + k * n, n, NULL};
}

double zd_row_times(const zd_row_of_C *row, const double *x)
{
    if (!row->column) return zd_dot(row->count, row->x, x);
    double sum = 0;
    for (int j = 0; j < row->count; j++) sum += row->x[j] * x[row->column[j]];
    return sum;
}

void zd_row_expand(const zd_row_of_C *row, int n, double *x)
{
    if (row->column) zd_clear(n, x);
    for (int j = 0; j < row->count; j++) x[zd_column(row, j)] = row->x[j];
}

/* Columns increase in both. */
static double sparse_product(const zd_row_of_C *a, const zd_row_of_C *b)
{
    double sum = 0;
    for (int i = 0, j = 0; i < a->count && j < b->count;) {
        int of_a = a->column[i], of_b = b->column[j];
        if (of_a == of_b) sum += a->x[i] * b->x[j];
        i += of_a <= of_b;
        j += of_b <= of_a;
    }
    return sum;
}

double zd_packed_row_residual(const zd_layout *layout, const double *C, int k, const double *rhs, const double *x, double *size)
{
    const zd_row_of_C row = zd_packed_row(layout, C, k);
    double sum = rhs[k];
    *size = fabs(sum);
    for (int j = 0; j < row.count; j++) {
        const double term = row.x[j] * x[row.column[j]];
        sum -= term;
        *size += fabs(term);
    }
    return sum;
}

double zd_packed_residual(const zd_layout *layout, const double *C, int rows, const double *rhs, const double *x, const double *weight,
                          double *residual, double *square)
{
    double worst = 0, largest = 0, size;
    for (int k = 0; k < rows; k++) {
        const double sum = residual[k] = zd_packed_row_residual(layout, C, k, rhs, x, &size);
        worst = fmax(worst, sum * sum * weight[k]);
        largest = fmax(largest, size * size * weight[k]);
    }
    *square = largest;
    return worst > 0 ? sqrt(worst / largest) : 0;
}

double zd_row_product(const zd_row_of_C *a, const zd_row_of_C *b)
{
    return !a->column ? zd_row_times(b, a->x) : !b->column ? zd_row_times(a, b->x) : sparse_product(a, b);
}

void zd_add_C(const zd_point *point, double weight, double *C)
{
    const int n = point->system->nv, m = zd_constraints(point->system);
    if (!point->layout) zd_add_scaled(m * n, C, weight, point->terms.C);
    for (int k = 0; point->layout && k < m; k++) {
        zd_row_of_C row = zd_point_row(point, k);
        for (int j = 0; j < row.count; j++) C[k * n + row.column[j]] += weight * row.x[j];
    }
}

/* ---- products ---- */

/* y <- A x, A (rows, n) */
ZD_INLINE void multiply_rows(const int n, const int rows, const double *A, const double *x, double *y)
{
    for (int i = 0; i < rows; i++) y[i] = zd_dot(n, A + i * n, x);
}

ZD_INLINE void multiply(const int n, int rows, const double *A, const double *x, double *y)
{
    ZD_ROWS(multiply_rows, n, rows, A, x, y);
}

/* y <- C x, the rows of a group after one another, which touch the same blocks */
static void packed_times(const zd_point *point, const double *x, double *y)
{
    const zd_layout *layout = point->layout;
    const double *c = point->terms.C;
    for (int g = 0; g < layout->groups; g++) {
        const int *column = layout->column + layout->column_at[g];
        for (int k = layout->row_at[g]; k < layout->row_at[g + 1]; k++, c += layout->width[g]) {
            double sum = 0;
            for (int j = 0; j < layout->width[g]; j++) sum += c[j] * x[column[j]];
            y[k] = sum;
        }
    }
}

int zd_point_need_times_C(zd_point *point)
{
    if (!zd_needs_no_C(point->system)) return zd_point_need(point, ZD_C);
    return point->known & ZD_MOVED ? ZD_DONE : zd_point_need_missing(point, 0);
}

void zd_point_velocity_violation(const zd_point *point, double *Psi)
{
    int m = zd_constraints(point->system);
    const double *Phi_t = point->terms.Phi_t;
    const zd_operations *own = point->system->operations;
    if (own && own->times_C) own->times_C(point->system->data, &point->terms, point->v, Psi);
    else if (point->layout) packed_times(point, point->v, Psi);
    else ZD_SIZED(multiply, point->system->nv, m, point->terms.C, point->v, Psi);   /* (5) */
    for (int k = 0; Phi_t && k < m; k++) Psi[k] += Phi_t[k];
}

int zd_point_need_times_A(zd_point *point, int want)
{
    if (!zd_brings_times_A(point->system)) return zd_point_need(point, want | ZD_A);
    const int status = zd_point_need(point, want);
    return status || point->known & ZD_MOVED ? status : zd_point_need_missing(point, 0);
}

void zd_point_rate(const zd_point *point, const double *v, double *pdot)
{
    const zd_layout *layout = point->layout;
    const double *A = point->terms.A;
    if (zd_brings_times_A(point->system)) {
        point->system->operations->times_A(point->system->data, &point->terms, v, pdot);    /* (1) */
        return;
    }
    if (!A) zd_copy_few(point->system->nq, v, pdot);
    else if (!layout) ZD_SIZED(multiply, point->system->nv, point->system->nq, A, v, pdot);     /* (1) */
    for (int b = 0; A && layout && b < layout->blocks; b++)
        ZD_SIZED(multiply, layout->velocity_at[b + 1] - layout->velocity_at[b], layout->coordinate_at[b + 1] - layout->coordinate_at[b],
                 A + layout->A_at[b], v + layout->velocity_at[b], pdot + layout->coordinate_at[b]);
    /* these times_A alone knows */
    for (int i = point->system->nq - point->system->followers; A && layout && i < point->system->nq; i++) pdot[i] = 0;
}

static void times_block(const zd_layout *layout, int b, const double *M, const double *x, double *y)
{
    int first = layout->velocity_at[b], n = layout->velocity_at[b + 1] - first;
    if (layout->is_diagonal[b])
        for (int i = 0; i < n; i++) y[first + i] = M[layout->M_at[b] + i] * x[first + i];
    else ZD_SIZED(multiply, n, n, M + layout->M_at[b], x + first, y + first);
}

void zd_times_M(const zd_point *point, const double *M, const double *x, double *y)
{
    const zd_layout *layout = point->layout;
    const zd_operations *own = point->system->operations;
    const int n = point->system->nv;
    if (own && own->times_M && M == point->terms.M) {
        own->times_M(point->system->data, &point->terms, x, y);
        return;
    }
    if (!layout) ZD_SIZED(multiply, n, n, M, x, y);
    for (int b = 0; layout && b < layout->blocks; b++) times_block(layout, b, M, x, y);
}

/* x^T A x, A (n, n) */
ZD_INLINE double quadratic(const int n, const double *A, const double *x)
{
    double sum = 0;
    for (int i = 0; i < n; i++) sum += x[i] * zd_dot(n, A + i * n, x);
    return sum;
}

static double quadratic_of_block(const zd_layout *layout, int b, const double *M, const double *x)
{
    int first = layout->velocity_at[b], n = layout->velocity_at[b + 1] - first;
    double sum = 0;
    if (!layout->is_diagonal[b]) return ZD_SIZED(quadratic, n, M + layout->M_at[b], x + first);
    for (int i = 0; i < n; i++) sum += x[first + i] * (M[layout->M_at[b] + i] * x[first + i]);
    return sum;
}

/* x^T M x */
static double times_M_times(const zd_point *point, const double *M, const double *x)
{
    const zd_layout *layout = point->layout;
    double sum = 0;
    if (!layout) return ZD_SIZED(quadratic, point->system->nv, M, x);
    for (int b = 0; b < layout->blocks; b++) sum += quadratic_of_block(layout, b, M, x);
    return sum;
}

double zd_point_kinetic(const zd_point *point)
{
    return 0.5 * times_M_times(point, point->terms.M, point->v);
}

/* ---- entries ---- */

double zd_packed_entry_of_M(const zd_layout *layout, const double *M, int i, int j)
{
    int b = layout->block_of[i], first = layout->velocity_at[b];
    if (layout->block_of[j] != b) return 0;
    M += layout->M_at[b];
    if (layout->is_diagonal[b]) return i == j ? M[i - first] : 0;
    return M[(i - first) * (layout->velocity_at[b + 1] - first) + j - first];
}

double zd_packed_entry_of_A(const zd_layout *layout, const double *A, int i, int j)
{
    int b = layout->block_of[j], row = i - layout->coordinate_at[b], first = layout->velocity_at[b];
    if (row < 0 || i >= layout->coordinate_at[b + 1]) return 0;
    return A[layout->A_at[b] + row * (layout->velocity_at[b + 1] - first) + j - first];
}

/* ---- dense ---- */

const double *zd_dense_M(const zd_point *point, double *memory)
{
    if (!point->layout) return point->terms.M;
    zd_expand(point->system, ZD_M, point->terms.M, memory);
    return memory;
}

const double *zd_dense_C(const zd_point *point, double *memory)
{
    if (!point->layout || point->C != point->terms.C) return point->C;
    zd_expand(point->system, ZD_C, point->terms.C, memory);
    return memory;
}

/* Factors a diagonal M: the reciprocals of D. Returns n, or the index of an entry that is not positive. */
static int invert_diagonal(int n, const double *M, double *L)
{
    for (int i = 0; i < n; i++) {
        if (!(M[i] > 0) || !(M[i] < INFINITY)) return i;
        L[i] = 1 / M[i];
    }
    return n;
}

static int factor_block(const zd_layout *layout, int b, const double *M, double *L)
{
    int n = layout->velocity_at[b + 1] - layout->velocity_at[b], at = layout->M_at[b];
    return layout->is_diagonal[b] ? invert_diagonal(n, M + at, L + at) : ZD_SIZED(zd_cholesky, n, M + at, L + at);
}

int zd_mass_factor(const zd_point *point, double *L)
{
    const zd_layout *layout = point->layout;
    const int n = point->system->nv;
    if (!layout) return ZD_SIZED(zd_cholesky, n, point->terms.M, L);
    for (int b = 0; b < layout->blocks; b++) {
        int first = layout->velocity_at[b], found = first + factor_block(layout, b, point->terms.M, L);
        if (found < layout->velocity_at[b + 1]) return found;
    }
    return n;
}

void zd_mass_solve(const zd_layout *layout, const double *L, const double *y, double *x)
{
    for (int b = 0; b < layout->blocks; b++) {
        const int first = layout->velocity_at[b], n = layout->velocity_at[b + 1] - first;
        const double *own = L + layout->M_at[b];
        for (int i = 0; layout->is_diagonal[b] && i < n; i++) x[first + i] = own[i] * y[first + i];
        if (layout->is_diagonal[b]) continue;
        ZD_SIZED(zd_forward, n, own, y + first, x + first);
        ZD_SIZED(zd_backward, n, own, x + first, x + first);
    }
}

/* Copies a matrix (rows, columns) into one with rows of length `stride`. Returns the end of the source. */
static const double *copy_block(int rows, int columns, const double *from, double *to, int stride)
{
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < columns; j++) to[i * stride + j] = from[i * columns + j];
    return from + rows * columns;
}

static const double *copy_diagonal(int n, const double *from, double *to, int stride)
{
    for (int i = 0; i < n; i++) to[i * (stride + 1)] = from[i];
    return from + n;
}

static void expand_blocks(const zd_system *system, int term, const double *packed, double *dense)
{
    const zd_structure *structure = system->structure;
    const int stride = system->nv;
    for (int b = 0, p = 0, v = 0; b < structure->blocks; b++) {
        int rows = structure->coordinates[b], n = structure->velocities[b];
        int is_diagonal = term == ZD_M && structure->mass && (structure->mass[b] & ZD_DIAGONAL);
        double *to = dense + (term == ZD_A ? p : v) * stride + v;
        packed = is_diagonal ? copy_diagonal(n, packed, to, stride) : copy_block(term == ZD_A ? rows : n, n, packed, to, stride);
        p += rows, v += n;
    }
}

/* First velocity of a block. */
static int velocity_at(const zd_structure *structure, int block)
{
    int at = 0;
    for (int b = 0; b < block; b++) at += structure->velocities[b];
    return at;
}

static void expand_rows(const zd_system *system, const double *packed, double *dense)
{
    const zd_structure *structure = system->structure;
    const int stride = system->nv;
    for (int g = 0; g < structure->groups; g++)
        for (int k = 0; k < structure->rows[g]; k++, dense += stride)
            for (int i = structure->first[g]; i < structure->first[g + 1]; i++) {
                int b = structure->block[i];
                packed = copy_block(1, structure->velocities[b], packed, dense + velocity_at(structure, b), stride);
            }
}

void zd_expand(const zd_system *system, int term, const double *packed, double *dense)
{
    const int rows = term == ZD_A ? system->nq : term == ZD_M ? system->nv : zd_constraints(system);
    zd_clear(rows * system->nv, dense);
    if (term == ZD_C) expand_rows(system, packed, dense);
    else expand_blocks(system, term, packed, dense);
}
