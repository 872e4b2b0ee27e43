/* Characteristic scales, which make tolerances independent of the units of length, mass and time.
 *
 *     unit_i    characteristic scale of coordinate i: 1 for an angle or any other pure number; L for a length
 *     size_k    max_i |C_ki| unit_i, the size of constraint k; if C_k is rounding, the same of the terms that cancel in it
 *
 * L is the characteristic length of the mechanism: the largest length among its coordinates, and among the lever arms in C, the
 * ratios of derivatives by angle and by length in one row. A tolerance of 1e-12 on Phi / size thus corresponds to errors of
 * 1e-12 rad, or of 1e-12 L, in the coordinates; multiplying Phi by a number has no effect.
 */
#include "point.h"

#include <math.h>

#include "../linalg/small.h"
#include "../workspace.h"

static const double NO_ROW = 0x1p-40;   /* size below which a row is rounding, relative to the largest row, or to the terms of its sum */

static int is_length(const zd_system *system, int i) { return system->lengths && system->lengths[i]; }

static int has_lengths(const zd_system *system)
{
    int any = 0;
    for (int i = 0; system->lengths && i < system->nq + system->nv; i++) any |= system->lengths[i];
    return any;
}

/* Lever arm of a row: ratio of its largest entry for an angle to its largest for a length. */
static double lever(const zd_point *point, int k)
{
    const zd_system *system = point->system;
    zd_row_of_C row = zd_point_row(point, k);
    double turn = 0, shift = 0;
    for (int j = 0; j < row.count; j++) {
        double *largest = is_length(system, system->nq + zd_column(&row, j)) ? &shift : &turn;
        *largest = fmax(*largest, fabs(row.x[j]));
    }
    return shift > 0 ? turn / shift : 0;
}

static double length_of(const zd_point *point)
{
    const zd_system *system = point->system;
    double length = system->length;
    for (int i = 0; i < system->nq; i++)
        if (is_length(system, i)) length = fmax(length, fabs(point->p[i]));
    for (int k = 0; k < zd_constraints(system); k++) length = fmax(length, lever(point, k));
    return length > 0 && length < INFINITY ? length : 1;     /* without any length: its unit */
}

/* Magnitudes (m, 2) of the terms in each row of C, in memory that the caller releases; NULL: not provided, or failed with `status`. */
static double *terms_of_rows(const zd_point *point, int *status)
{
    const zd_system *system = point->system;
    const size_t m = zd_constraints(system);
    *status = ZD_DONE;
    if (!system->magnitudes || !m) return NULL;
    double *memory = zd_allocate((2 * m + (size_t)system->magnitudes_scratch) * sizeof(double));
    *status = memory ? system->magnitudes(system->data, point->t, point->p, point->v, memory, memory + 2 * m) : ZD_NO_MEMORY;
    if (!*status) return memory;
    zd_release(memory);
    return NULL;
}

/* Rows that are the rounding of larger terms get the size of these terms. */
static int compare_with_terms(zd_point *point, double length)
{
    const zd_system *system = point->system;
    int lengths = 0, status;
    for (int i = 0; i < system->nv; i++) lengths += is_length(system, system->nq + i);
    double *magnitude = terms_of_rows(point, &status);
    for (int k = 0; magnitude && k < zd_constraints(system); k++) {
        const double shift = lengths ? magnitude[2 * k] : 0, turn = lengths < system->nv ? magnitude[2 * k + 1] : 0;
        const double largest = fmax(shift * length, turn);
        point->rounding[k] = NO_ROW * fmax(shift, turn);
        if (point->size[k] <= NO_ROW * largest) point->size[k] = largest;
    }
    zd_release(magnitude);
    return status;
}

/* Rows that vanish within rounding at the start get the size of the largest row. */
static void limit_sizes(int m, double *size, double *inverse_size)
{
    double largest = zd_max_abs(m, size);
    for (int k = 0; k < m; k++) {
        if (!(size[k] > NO_ROW * largest)) size[k] = largest;
        if (!(size[k] > 0 && size[k] < INFINITY)) size[k] = 1;
        inverse_size[k] = 1 / size[k];
    }
}

static void set_units(zd_point *point, double length)
{
    const zd_system *system = point->system;
    const double inverse = 1 / length;
    for (int i = 0; i < system->nq; i++) point->inverse_unit_p[i] = is_length(system, i) ? inverse : 1;
    for (int i = 0; i < system->nv; i++) {
        const int has_length = is_length(system, system->nq + i);
        point->unit[i] = has_length ? length : 1;
        point->inverse_unit[i] = has_length ? inverse : 1;
    }
}

ZD_INLINE double largest_share(const int n, const double *row, const double *unit)
{
    double largest = 0;
    for (int i = 0; i < n; i++) {
        const double share = fabs(row[i]) * unit[i];
        largest = share > largest ? share : largest;
    }
    return largest;
}

static double size_of_row(const zd_point *point, int k)
{
    const int nv = point->system->nv;
    if (!point->layout) return ZD_SIZED(largest_share, nv, point->terms.C + k * nv, point->unit);
    zd_row_of_C row = zd_point_row(point, k);
    double size = 0;
    for (int j = 0; j < row.count; j++) {
        const double share = fabs(row.x[j]) * point->unit[zd_column(&row, j)];
        if (share > size) size = share;
    }
    return size;
}

int zd_point_measure(zd_point *point)
{
    const zd_system *system = point->system;
    if (point->measured) return ZD_DONE;
    int status = zd_point_need(point, ZD_C);
    if (status) return status;
    const double length = has_lengths(system) ? length_of(point) : 1;
    set_units(point, length);
    for (int k = 0; k < zd_constraints(system); k++) point->size[k] = size_of_row(point, k);
    status = compare_with_terms(point, length);
    if (status) return status;
    limit_sizes(zd_constraints(system), point->size, point->inverse_size);
    point->measured = 1;
    return ZD_DONE;
}
