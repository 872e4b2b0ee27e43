/* Gaussian elimination with complete pivoting. */
#include "equations.h"

#include <math.h>
#include <string.h>

#include "../linalg/small.h"
#include "problem.h"

static const double PIVOT_SHARE = 1e-11;    /* relative pivot below which a row depends on others */
static const double SIGN_SHARE = 1e-9;      /* share of the largest value below which a contradiction is rounding */

static void swap(double *a, double *b)
{
    const double moved = *a;
    *a = *b, *b = moved;
}

/* Moves the largest entry of the rows and columns from k on to the diagonal. */
static void choose_pivot(int n, double *A, double *x, int *column, int k)
{
    int pi = k, pj = k;
    for (int i = k; i < n; i++)
        for (int j = k; j < n; j++)
            if (fabs(A[i * n + j]) > fabs(A[pi * n + pj])) pi = i, pj = j;
    for (int j = 0; j < n; j++) swap(A + k * n + j, A + pi * n + j);
    for (int i = 0; i < n; i++) swap(A + i * n + k, A + i * n + pj);
    swap(x + k, x + pi);
    const int moved = column[k];
    column[k] = column[pj], column[pj] = moved;
}

int zd_equations_eliminate(int n, double *A, double *x, int *column, int *rank)
{
    double contradiction = 0, size = 0;
    for (int i = 0; i < n; i++) column[i] = i, size = fmax(size, fabs(x[i]));
    for (*rank = 0; *rank < n; (*rank)++) {
        const int k = *rank;
        choose_pivot(n, A, x, column, k);
        if (!(fabs(A[k * n + k]) > PIVOT_SHARE * fabs(A[0]))) break;
        for (int i = k + 1; i < n; i++) {
            const double factor = A[i * n + k] / A[k * n + k];
            for (int j = k; j < n; j++) A[i * n + j] -= factor * A[k * n + j];
            x[i] -= factor * x[k];
        }
    }
    for (int i = *rank; i < n; i++) contradiction = fmax(contradiction, fabs(x[i])), x[i] = 0;
    for (int k = *rank - 1; k >= 0; k--) {
        for (int j = k + 1; j < *rank; j++) x[k] -= A[k * n + j] * x[j];
        x[k] /= A[k * n + k];
    }
    return contradiction <= SIGN_SHARE * size;
}

int zd_equations_null_space(int n, double *A, double *null)
{
    int column[ZD_MAX_CANDIDATES], rank;
    double x[ZD_MAX_CANDIDATES] = {0};
    zd_equations_eliminate(n, A, x, column, &rank);
    for (int j = rank; j < n; j++, null += n) {
        memset(x, 0, sizeof x);
        memset(null, 0, n * sizeof *null);
        for (int k = rank - 1; k >= 0; k--) {
            x[k] = -A[k * n + j];
            for (int i = k + 1; i < rank; i++) x[k] -= A[k * n + i] * x[i];
            x[k] /= A[k * n + k];
            null[column[k]] = x[k];
        }
        null[column[j]] = 1;
    }
    return n - rank;
}

int zd_equations_solve(int n, double *A, double *x)
{
    int column[ZD_MAX_CANDIDATES], rank;
    double solution[ZD_MAX_CANDIDATES];
    const int is_solved = zd_equations_eliminate(n, A, x, column, &rank);
    for (int i = 0; i < n; i++) solution[column[i]] = x[i];
    zd_copy_all(n, solution, x);
    return is_solved;
}
