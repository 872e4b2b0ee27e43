/* Natural sizes, so that tolerances mean the same in any unit of length, mass and time.
 *
 *     unit_i    of an angle, or any other pure number: 1; of a length: L
 *     size_k    max_i |C_ki| unit_i, the size of row k of Phi; where C_k is rounding, the same of the terms that cancel in it
 *
 * L is the mechanism's own length: the largest there is among its coordinates, and in C wherever an angle and a length meet in a
 * row, whose ratio is a lever arm. A tolerance of 1e-12 on Phi in units of its size thus says that the error is as if coordinates
 * were off by 1e-12 rad, or by 1e-12 of the mechanism's length; multiplying Phi by a number changes nothing.
 */
#include "units.h"

#include <math.h>

#include "../linalg/norms.h"
#include "../linalg/small.h"
#include "../workspace.h"
#include "matrices.h"

static const double NO_ROW = 0x1p-40;   /* of the largest row, or of the terms that a row is the sum of: a smaller row is rounding */

static int is_length(const zd_system *system, int i) { return system->lengths && system->lengths[i]; }

static int has_lengths(const zd_system *system)
{
    int any = 0;
    for (int i = 0; system->lengths && i < system->nq + system->nv; i++) any |= system->lengths[i];
    return any;
}

/* The lever arm of a row: its largest entry for an angle, over the largest for a length */
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
    return length > 0 && length < INFINITY ? length : 1;     /* nothing has a length here: the unit itself */
}

/* The magnitudes (m, 2) of the terms of all rows, in memory that is released by the caller; NULL: there are none, or `status` says why. */
static double *terms_of_rows(const zd_point *point, int *status)
{
    const zd_system *system = point->system;
    const size_t m = (size_t)zd_constraints(system);
    *status = ZD_DONE;
    if (!system->magnitudes || !m) return NULL;
    double *memory = zd_allocate((2 * m + (size_t)system->magnitudes_scratch) * sizeof(double));
    *status = memory ? system->magnitudes(system->data, point->t, point->p, point->v, memory, memory + 2 * m) : ZD_NO_MEMORY;
    if (!*status) return memory;
    zd_release(memory);
    return NULL;
}

/* Rows that are the rounding of larger terms are as large as these. */
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

/* A row that is nothing at the start, but for rounding, is as large as the largest. */
static void settle_sizes(int m, double *size, double *inverse_size)
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
    settle_sizes(zd_constraints(system), point->size, point->inverse_size);
    point->measured = 1;
    return ZD_DONE;
}

double zd_point_violation(const zd_point *point)
{
    return zd_max_scaled(point->system->mh, point->terms.Phi, point->inverse_size);
}
