/* Gaussian elimination with partial pivoting. Row scaling is the caller's business: it knows the units. */
#include "dense.h"

#include "small.h"

ZD_INLINE int largest_below(const int n, const double *A, int column)
{
    int best = column;
    for (int i = column + 1; i < n; i++)
        if (fabs(A[i * n + column]) > fabs(A[best * n + column])) best = i;
    return best;
}

ZD_INLINE void swap(double *a, double *b)
{
    double x = *a;
    *a = *b;
    *b = x;
}

ZD_INLINE void swap_rows(const int n, double *A, int a, int b)
{
    for (int j = 0; j < n; j++) swap(A + a * n + j, A + b * n + j);
}

ZD_INLINE int factor(const int n, double *A, int *order)
{
    double negligible = n * 0x1p-52 * zd_largest(n * n, A);
    for (int k = 0; k < n; k++) {
        int pivot_row = largest_below(n, A, k);
        order[k] = pivot_row;
        if (pivot_row != k) swap_rows(n, A, k, pivot_row);
        double pivot = A[k * n + k];
        if (!(fabs(pivot) > negligible)) return k;
        double inverse = A[k * n + k] = 1 / pivot;
        for (int i = k + 1; i < n; i++) {
            double factor = A[i * n + k] * inverse;
            A[i * n + k] = factor;
            for (int j = k + 1; j < n; j++) A[i * n + j] -= factor * A[k * n + j];
        }
    }
    return n;
}

int zd_lu_factor(int n, double *A, int *order)
{
    return ZD_SIZED(factor, n, A, order);
}

ZD_INLINE void solve(const int n, const double *LU, const int *order, double *b)
{
    for (int k = 0; k < n; k++) swap(b + k, b + order[k]);
    zd_forward(n, LU, b, b);
    for (int i = n - 1; i >= 0; i--) {
        double sum = b[i];
        for (int j = i + 1; j < n; j++) sum -= LU[i * n + j] * b[j];
        b[i] = sum * LU[i * n + i];
    }
}

void zd_lu_solve(int n, const double *LU, const int *order, double *b)
{
    ZD_SIZED(solve, n, LU, order, b);
}

void zd_lu_solve_transposed(int n, const double *LU, const int *order, double *b)
{
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < i; j++) b[i] -= LU[j * n + i] * b[j];
        b[i] *= LU[i * n + i];
    }
    for (int i = n - 2; i >= 0; i--)
        for (int j = i + 1; j < n; j++) b[i] -= LU[j * n + i] * b[j];
    for (int k = n - 1; k >= 0; k--) swap(b + k, b + order[k]);
}

double zd_lu_determinant(int n, const double *LU, const int *order)
{
    double inverse = 1;
    for (int k = 0; k < n; k++) inverse *= order[k] == k ? LU[k * n + k] : -LU[k * n + k];
    return 1 / inverse;
}

static void swap_columns(int rows, int columns, double *A, int a, int b)
{
    for (int i = 0; i < rows; i++) swap(A + i * columns + a, A + i * columns + b);
}

/* Brings the largest entry of what is left, in columns before `end`, to (k, k). */
static void bring_pivot(int rows, int columns, int end, double *A, int *order, int k)
{
    int row = k, column = k;
    for (int i = k; i < rows; i++)
        for (int j = k; j < end; j++)
            if (fabs(A[i * columns + j]) > fabs(A[row * columns + column])) row = i, column = j;
    for (int j = 0; row != k && j < columns; j++) swap(A + row * columns + j, A + k * columns + j);
    if (column == k) return;
    swap_columns(rows, columns, A, column, k);
    int chosen = order[column];
    order[column] = order[k];
    order[k] = chosen;
}

int zd_choose_columns(int rows, int columns, int leading, double *A, int *order)
{
    double negligible = columns * 0x1p-52 * zd_largest(rows * columns, A);
    for (int j = 0; j < columns; j++) order[j] = j;
    for (int k = 0; k < rows; k++) {
        bring_pivot(rows, columns, k < leading ? leading : columns, A, order, k);
        double pivot = A[k * columns + k];
        if (!(fabs(pivot) > negligible)) return k;
        for (int i = k + 1; i < rows; i++) {
            double factor = A[i * columns + k] / pivot;
            for (int j = k; j < columns; j++) A[i * columns + j] -= factor * A[k * columns + j];
        }
    }
    return rows;
}
