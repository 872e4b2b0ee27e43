/* Bunch and Kaufman's factorization with rook pivoting (C. Ashcraft, R. G. Grimes, J. G. Lewis, SIAM Journal on Matrix Analysis and
 * Applications 20 (1998) 513-561): half the memory and work of Gaussian elimination. A pivot is a diagonal entry that is not small beside
 * its row, or a block of two rows around an entry that is the largest of both its row and its column. Entries of L are so less than 3.
 *
 * Rows are swapped in what is left to be factored only, so that the solves swap as they go. Diagonal blocks are stored inverted; `order`
 * has the complement of a row, which is negative, where it belongs to a block of two.
 */
#include "dense.h"

#include "small.h"

/* (1 + sqrt 17) / 8: what two steps of one row or one of two let entries grow by is alike */
static const double ALPHA = 0.6403882032022076;

typedef struct pivot {
    int size;               /* 1 or 2; 0: there is none */
    int row[2];             /* to be swapped with the first rows of what is left */
} pivot;

static void swap(double *a, double *b)
{
    double x = *a;
    *a = *b;
    *b = x;
}

/* Rows and columns a <= b of what is left from `first` on. */
static void swap_both(int n, double *A, int first, int a, int b)
{
    if (a == b) return;
    double *row_a = zd_triangle_row(n, A, a), *row_b = zd_triangle_row(n, A, b);
    for (int k = first; k < a; k++) {
        double *row = zd_triangle_row(n, A, k);
        swap(row + a, row + b);
    }
    swap(row_a + a, row_b + b);
    for (int k = a + 1; k < b; k++) swap(row_a + k, zd_triangle_row(n, A, k) + b);
    for (int j = b + 1; j < n; j++) swap(row_a + j, row_b + j);
}

/* Largest off-diagonal entry of row r in the reduced matrix, from `first` on, and its column. */
static double largest_beside(int n, double *A, int first, int r, int *column)
{
    const double *row = zd_triangle_row(n, A, r);
    double largest = 0;
    *column = r;
    for (int k = first; k < r; k++) {
        double size = fabs(zd_triangle_row(n, A, k)[r]);
        if (size > largest) largest = size, *column = k;
    }
    for (int j = r + 1; j < n; j++)
        if (fabs(row[j]) > largest) largest = fabs(row[j]), *column = j;
    return largest;
}

static double diagonal(int n, double *A, int i) { return fabs(zd_triangle_row(n, A, i)[i]); }

/* From row to row, each where the one before has its largest entry, until that is the largest of both, or a diagonal entry will do. */
static pivot find_pivot(int n, double *A, int first, double negligible)
{
    int row = first, next;
    double largest = largest_beside(n, A, first, row, &next);
    if (!(fmax(largest, diagonal(n, A, row)) > negligible)) return (pivot){0, {first, first}};
    if (diagonal(n, A, row) >= ALPHA * largest) return (pivot){1, {row, row}};
    for (;;) {
        int after;
        double there = largest_beside(n, A, first, next, &after);
        if (diagonal(n, A, next) >= ALPHA * there) return (pivot){1, {next, next}};
        if (!(there > largest)) return (pivot){2, {row, next}};
        row = next, next = after, largest = there;
    }
}

static void eliminate_one(int n, double *A, int k)
{
    double *u = zd_triangle_row(n, A, k);
    const double inverse = u[k] = 1 / u[k];
    for (int i = k + 1; i < n; i++) {
        double *row = zd_triangle_row(n, A, i);
        const double factor = u[i] * inverse;
        for (int j = i; j < n; j++) row[j] -= factor * u[j];
        u[i] = factor;
    }
}

static void eliminate_two(int n, double *A, int k)
{
    double *u = zd_triangle_row(n, A, k), *w = zd_triangle_row(n, A, k + 1);
    const double beside = u[k + 1], a = u[k] / beside, c = w[k + 1] / beside, scale = 1 / (beside * (a * c - 1));
    u[k] = scale * c;
    u[k + 1] = -scale;
    w[k + 1] = scale * a;
    for (int i = k + 2; i < n; i++) {
        double *row = zd_triangle_row(n, A, i);
        const double first = u[k] * u[i] + u[k + 1] * w[i], second = u[k + 1] * u[i] + w[k + 1] * w[i];
        for (int j = i; j < n; j++) row[j] -= first * u[j] + second * w[j];
        u[i] = first;
        w[i] = second;
    }
}

int zd_symmetric_factor(int n, double *A, int *order)
{
    const double negligible = n * 0x1p-52 * zd_largest((int)zd_triangle(n), A);
    for (int k = 0; k < n;) {
        const pivot found = find_pivot(n, A, k, negligible);
        if (!found.size) return k;
        for (int i = 0; i < found.size; i++) {
            swap_both(n, A, k, k + i, found.row[i]);
            order[k + i] = found.size == 1 ? found.row[i] : ~found.row[i];
        }
        if (found.size == 1) eliminate_one(n, A, k);
        else eliminate_two(n, A, k);
        k += found.size;
    }
    return n;
}

/* b <- D^-1 L^-1 P b */
static void forward(int n, double *LD, const int *order, double *b)
{
    for (int k = 0; k < n; k++) {
        const double *u = zd_triangle_row(n, LD, k), *w = zd_triangle_row(n, LD, k + 1);
        if (order[k] >= 0) {
            swap(b + k, b + order[k]);
            zd_add_scaled(n - k - 1, b + k + 1, -b[k], u + k + 1);
            b[k] *= u[k];
            continue;
        }
        swap(b + k, b + ~order[k]);
        swap(b + k + 1, b + ~order[k + 1]);
        const double x = b[k], y = b[k + 1];
        for (int i = k + 2; i < n; i++) b[i] -= u[i] * x + w[i] * y;
        b[k] = u[k] * x + u[k + 1] * y;
        b[k + 1] = u[k + 1] * x + w[k + 1] * y;
        k++;
    }
}

/* b <- P^T L^-T b, of the first `steps` rows of L */
static void backward(int n, int steps, double *LD, const int *order, double *b)
{
    for (int k = steps - 1; k >= 0; k--) {
        const double *w = zd_triangle_row(n, LD, k);
        b[k] -= zd_dot(n - k - 1, w + k + 1, b + k + 1);
        if (order[k] >= 0) {
            swap(b + k, b + order[k]);
            continue;
        }
        const double *u = zd_triangle_row(n, LD, k - 1);
        b[k - 1] -= zd_dot(n - k - 1, u + k + 1, b + k + 1);
        swap(b + k, b + ~order[k]);
        swap(b + k - 1, b + ~order[k - 1]);
        k--;
    }
}

void zd_symmetric_solve(int n, double *LD, const int *order, double *b)
{
    forward(n, LD, order, b);
    backward(n, n, LD, order, b);
}

int zd_symmetric_dependent(int n, double *LD, const int *order, int step, double *x)
{
    for (int i = 0; i < n; i++) x[i] = i == step;
    backward(n, step, LD, order, x);        /* A x = 0 */
    const double noticeable = 0x1p-26 * zd_largest(n, x);
    int last = n - 1;
    while (last > 0 && !(fabs(x[last]) > noticeable)) last--;
    return last;
}
