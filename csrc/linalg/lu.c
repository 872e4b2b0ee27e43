/* Gaussian elimination with partial pivoting. Row scaling is the caller's business: it knows the units. */
#include "lu.h"

#include <math.h>

static int largest_below(int n, const double *A, int column)
{
    int best = column;
    for (int i = column + 1; i < n; i++)
        if (fabs(A[i * n + column]) > fabs(A[best * n + column])) best = i;
    return best;
}

static void swap_rows(int n, double *A, int a, int b)
{
    for (int j = 0; j < n; j++) {
        double x = A[a * n + j];
        A[a * n + j] = A[b * n + j];
        A[b * n + j] = x;
    }
}

static double largest_entry(int n, const double *A)
{
    double largest = 0;
    for (int i = 0; i < n * n; i++) largest = fmax(largest, fabs(A[i]));
    return largest;
}

int zd_lu_factor(int n, double *A, int *order)
{
    double negligible = n * 0x1p-52 * largest_entry(n, A);
    for (int k = 0; k < n; k++) {
        int pivot_row = largest_below(n, A, k);
        order[k] = pivot_row;
        if (pivot_row != k) swap_rows(n, A, k, pivot_row);
        double pivot = A[k * n + k];
        if (!(fabs(pivot) > negligible)) return k;
        for (int i = k + 1; i < n; i++) {
            double factor = A[i * n + k] / pivot;
            A[i * n + k] = factor;
            for (int j = k + 1; j < n; j++) A[i * n + j] -= factor * A[k * n + j];
        }
    }
    return n;
}

void zd_lu_solve(int n, const double *LU, const int *order, double *b)
{
    for (int k = 0; k < n; k++) {
        double x = b[order[k]];
        b[order[k]] = b[k];
        b[k] = x;
    }
    for (int i = 1; i < n; i++)
        for (int j = 0; j < i; j++) b[i] -= LU[i * n + j] * b[j];
    for (int i = n - 1; i >= 0; i--) {
        for (int j = i + 1; j < n; j++) b[i] -= LU[i * n + j] * b[j];
        b[i] /= LU[i * n + i];
    }
}
