/* Numbers of S(W): its blocks from C and W, its factors, and products with C. The blocks are laid out in weighted_structure.c.
 */
#include "weighted.h"

#include <math.h>

#include "../../linalg/iteration.h"
#include "../../linalg/small.h"

/* product (rows, n) <- A W of a body */
ZD_INLINE void weigh(const int rows, const int n, const double *A, int stride, const double *W, double *product)
{
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < n; j++) product[i * n + j] = A[i * stride + j] * W[j];
}

static void weigh_any(const zd_piece *a, const double *A, const double *W, double *product)
{
    const int n = a->n;
    if (a->is_diagonal) weigh(a->rows, n, A, a->stride, W, product);
    for (int i = 0; !a->is_diagonal && i < a->rows; i++) {
        zd_forward(n, W, A + i * a->stride, product + i * n);
        zd_backward(n, W, product + i * n, product + i * n);
    }
    for (int i = 0; a->copies > 1 && i < a->rows * n; i++) product[i] *= a->copies;
}

/* to (rows, columns) <- to + A B^T, A (rows, n) */
ZD_INLINE void add_product(const int rows, const int columns, const int n, const double *A, const double *B, int stride, double *to)
{
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < columns; j++) to[i * columns + j] += zd_dot(n, A + i * n, B + j * stride);
}

/* to (columns,) <- to + a W B^T, of a row a (n,) */
ZD_INLINE void add_row(const int columns, const int n, const double *restrict a, const double *restrict W, const double *restrict B,
                       int stride, double *restrict to)
{
    double weighted[ZD_UNROLLED];
    for (int i = 0; i < n; i++) weighted[i] = a[i] * W[i];
    for (int j = 0; j < columns; j++) to[j] += zd_dot(n, weighted, B + j * stride);
}

/* to <- to + A W B^T; for a piece with itself the lower triangle only, as no more is read of a diagonal block. */
ZD_INLINE void add_weighted(const int is_square, const int rows, const int n, const double *A, int stride, const double *W, const double *B,
                            int stride_of_B, double *to)
{
    for (int i = 0; i < rows; i++) add_row(is_square ? i + 1 : rows, n, A + i * stride, W, B, stride_of_B, to + i * rows);
}

static const double *entries(const zd_weighted *self, const zd_piece *piece, const double *C)
{
    return (piece->is_weld ? self->weld : C) + piece->C;
}

static void add_any(zd_weighted *self, const zd_piece *a, const zd_piece *b, const double *C, const double *W, double *to)
{
    weigh_any(a, entries(self, a, C), W + a->W, self->product);
    add_product(a->rows, b->rows, a->n, self->product, entries(self, b, C), b->stride, to);
}

/* Pairs of one kernel, mostly many in succession; returns the first of another. */
ZD_INLINE const zd_pair *add_pairs(const int square, const int n, const int rows, const zd_weighted *self, const zd_pair *pair,
                                   const double *C, const double *W)
{
    const zd_pair *end = self->pair + self->pairs;
    double *S = self->blocks->S;
    do {
        const double *A = C + pair->a, *B = square ? A : C + pair->b;
        add_weighted(square, rows, n, A, pair->stride_of_a, W + pair->W, B, square ? pair->stride_of_a : pair->stride_of_b, S + pair->to);
    } while (++pair < end && pair->kernel == square + 10 * n + rows);
    return pair;
}

static void fill_S(zd_weighted *self, const double *C, const double *W)
{
    zd_blocks_clear(self->blocks);
#define KERNEL(n, rows)                                                                             \
    case 10 * n + rows: pair = add_pairs(0, n, rows, self, pair, C, W); break;                      \
    case ZD_SQUARE + 10 * n + rows: pair = add_pairs(ZD_SQUARE, n, rows, self, pair, C, W); break;
    for (const zd_pair *pair = self->pair; pair < self->pair + self->pairs;) switch (pair->kernel) {
        KERNEL(3, 1)
        KERNEL(3, 2)
        KERNEL(3, 3)
        KERNEL(6, 1)
        KERNEL(6, 3)
        KERNEL(6, 5)
        KERNEL(6, 6)
        default:
            add_any(self, self->piece + pair->a, self->piece + pair->b, C, W, self->blocks->S + pair->to);
            pair++;
        }
#undef KERNEL
}

zd_pivots zd_weighted_factor(zd_weighted *self, const double *C, const double *W, double *y)
{
    fill_S(self, C, W);
    return zd_blocks_factor(self->blocks, NULL, 0, y);
}

/* The system's own products do not know split bodies. */
const zd_operations *zd_weighted_products(const zd_weighted *self, const zd_system *system)
{
    const zd_operations *products = system->operations;
    return products && products->add_weighted && !zd_weighted_has_welds(self) ? products : NULL;
}

zd_pivots zd_weighted_factor_by(zd_weighted *self, const zd_operations *products, const void *data, const zd_terms *terms, const double *W,
                               double *y)
{
    zd_blocks_clear(self->blocks);
    products->add_weighted(data, terms, W, self->at, self->blocks->S);
    return zd_blocks_factor(self->blocks, NULL, 0, y);
}

zd_pivots zd_weighted_factor_without(zd_weighted *self, const double *C, const double *W, unsigned char *without)
{
    fill_S(self, C, W);
    return zd_blocks_factor(self->blocks, without, -1, NULL);
}

int zd_weighted_leave_out(zd_weighted *self, const double *C, const double *W, double least, unsigned char *left_out)
{
    const zd_layout *layout = self->layout;
    unsigned char *in_order = zd_allocate(self->blocks->rows);
    int of_welds = 0;
    if (!in_order) return -1;
    fill_S(self, C, W);
    (void)zd_blocks_factor(self->blocks, in_order, least, NULL);
    for (int i = 0; i < self->blocks->rows; i++) of_welds += in_order[i];
    for (int g = 0; g < layout->groups; g++)
        for (int k = layout->row_at[g], i = self->row[g]; k < layout->row_at[g + 1]; k++, i++) of_welds -= left_out[k] = in_order[i];
    zd_release(in_order);
    return of_welds;
}

void zd_weighted_times(const zd_weighted *self, const double *C, const double *x, const double *rhs, double *y)
{
    if (zd_weighted_has_welds(self)) zd_clear(self->blocks->rows, y);
    zd_row_groups_times(&self->row_groups, C, x, rhs, y);
}

int zd_weighted_row(const zd_weighted *self, int place)
{
    const zd_layout *layout = self->layout;
    for (int g = 0; g < layout->groups; g++)
        if (place >= self->row[g] && place < self->row[g] + layout->row_at[g + 1] - layout->row_at[g])
            return layout->row_at[g] + place - self->row[g];
    return 0;
}

/* Contribution c W c^T of a body to a diagonal entry of S; W is diagonal. */
static double contribution(const zd_piece *piece, int row, const double *C, const double *W)
{
    const double *c = C + piece->C + row * piece->stride, *w = W + piece->W;
    double sum = 0;
    for (int i = 0; i < piece->n; i++) sum += c[i] * w[i] * c[i];
    return sum;
}

int zd_weighted_is_alike(const zd_weighted *self, const double *C, const double *W, double *least, double *most)
{
    const int m = self->layout->row_at[self->layout->groups];
    if (zd_weighted_has_welds(self)) return 0;
    for (int k = 0; k < m; k++) least[k] = INFINITY, most[k] = 0;
    for (const zd_piece *piece = self->piece; piece < self->piece + self->pieces; piece++)
        for (int i = 0; i < piece->rows; i++) {
            if (!piece->is_diagonal) return 0;
            const int k = piece->row + i;
            const double share = contribution(piece, i, C, W);
            if (!(share > 0)) continue;
            least[k] = fmin(least[k], share);
            most[k] = fmax(most[k], share);
        }
    for (int k = 0; k < m; k++)
        if (most[k] > ZD_UNEQUAL_SHARES * least[k]) return 0;
    return 1;
}
