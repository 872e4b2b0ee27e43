#include "equations.h"

#include <math.h>

#include "../small.h"
#include "../small.h"

enum { SWEEPS = 30 };
static const double ORTHOGONAL = 0x1p-50;       /* cosine of the angle between columns */

void zd_reflect_column(int rows, int columns, int stride, double *A, double *work)
{
    double square = 0;
    for (int i = 1; i < rows; i++) square += A[i * stride] * A[i * stride];
    if (!(square > 0)) return;
    const double norm = copysign(sqrt(square + A[0] * A[0]), A[0]);
    A[0] += norm;
    const double factor = 1 / (norm * A[0]);    /* 2 / v^T v */
    zd_clear(columns, work);
    for (int i = 0; i < rows; i++) zd_add_scaled(columns - 1, work + 1, A[i * stride], A + i * stride + 1);
    for (int i = 0; i < rows; i++) {
        zd_add_scaled(columns - 1, A + i * stride + 1, -factor * A[i * stride], work + 1);
        A[i * stride] = i ? 0 : -norm;
    }
}

int zd_triangulate(int rows, int columns, int stride, double *A, double *work)
{
    for (int k = 0; k < rows && k < columns; k++) zd_reflect_column(rows - k, columns - k, stride, A + k * (stride + 1), work);
    return rows < columns ? rows : columns;
}

/* Rotates two columns by an angle. */
static void rotate(int rows, int stride, double c, double s, double *a, double *b)
{
    for (int i = 0; i < rows; i++) {
        const double x = a[i * stride], y = b[i * stride];
        a[i * stride] = c * x - s * y;
        b[i * stride] = s * x + c * y;
    }
}

/* Makes columns i and j orthogonal; returns whether they were not. */
static int separate(int rows, int n, int stride, double *A, double *V, int i, int j)
{
    double a = 0, b = 0, product = 0;
    for (int k = 0; k < rows; k++) {
        const double x = A[k * stride + i], y = A[k * stride + j];
        a += x * x;
        b += y * y;
        product += x * y;
    }
    if (!(fabs(product) > ORTHOGONAL * sqrt(a * b)) || !(fabs(product) > 0)) return 0;
    const double cotangent = (b - a) / (2 * product), tangent = copysign(1, cotangent) / (fabs(cotangent) + sqrt(1 + cotangent * cotangent));
    const double c = 1 / sqrt(1 + tangent * tangent);
    rotate(rows, stride, c, c * tangent, A + i, A + j);
    rotate(n, n, c, c * tangent, V + i, V + j);
    return 1;
}

static void exchange_columns(int rows, int stride, double *A, int i, int j)
{
    for (int k = 0; k < rows; k++) {
        const double kept = A[k * stride + i];
        A[k * stride + i] = A[k * stride + j];
        A[k * stride + j] = kept;
    }
}

/* Columns in the order of decreasing norms */
static void sort_columns(int rows, int n, int stride, double *A, double *V, double *norm)
{
    for (int i = 0; i < n; i++) {
        int longest = i;
        for (int j = i + 1; j < n; j++) longest = norm[j] > norm[longest] ? j : longest;
        if (longest == i) continue;
        const double kept = norm[i];
        norm[i] = norm[longest];
        norm[longest] = kept;
        exchange_columns(rows, stride, A, i, longest);
        exchange_columns(n, n, V, i, longest);
    }
}

void zd_orthogonalize_columns(int rows, int n, int stride, double *A, double *V, double *norm)
{
    zd_clear(n * n, V);
    for (int i = 0; i < n; i++) V[i * (n + 1)] = 1;
    for (int sweep = 0, any = 1; any && sweep < SWEEPS; sweep++) {
        any = 0;
        for (int i = 0; i < n; i++)
            for (int j = i + 1; j < n; j++) any |= separate(rows, n, stride, A, V, i, j);
    }
    for (int i = 0; i < n; i++) {
        norm[i] = 0;
        for (int k = 0; k < rows; k++) norm[i] += A[k * stride + i] * A[k * stride + i];
        norm[i] = sqrt(norm[i]);
    }
    sort_columns(rows, n, stride, A, V, norm);
}
