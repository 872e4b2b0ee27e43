/* Unit quaternions. Their length is not a constraint in C, since pdot = A v preserves it; steps of finite size change it by their error.
 * Normalization removes a component along the quaternion, which is not a rotation: so the order of a method stays.
 *
 * A length within rounding of one is not changed. So normalization is idempotent, and a run continued from a saved state has the same bits
 * as an uninterrupted one.
 */
#include "point.h"

#include <math.h>

static const double LENGTH_ROUNDING = 4 * 0x1p-52; /* deviation of the squared length from 1 that is rounding */
static const double WRITTEN = 1e-6;     /* deviation of a start's length from 1 that is accepted: numbers written with seven digits */
static const double KEPT = 1e-9;        /* allowed rate of the length, relative to the largest entry of a column of A */
enum { ENTRIES = 4, TRIES = 4 };        /* one normalization is nearly always enough, more remove the rounding of the first */

static double squared_length(const double *q)
{
    return (q[0] * q[0] + q[1] * q[1]) + (q[2] * q[2] + q[3] * q[3]);
}

static int is_off(double squared)
{
    return fabs(squared - 1) > LENGTH_ROUNDING && squared > 0 && squared < INFINITY;
}

int zd_quaternions_bring_back(const zd_system *system, double *p)
{
    int changed = 0;
    for (int k = 0; k < system->quaternions; k++) {
        double *q = p + system->quaternion[k];
        double squared = squared_length(q);
        for (int i = 0; i < TRIES && is_off(squared); i++) {
            double factor = 1 / sqrt(squared);
            for (int j = 0; j < ENTRIES; j++) q[j] *= factor;
            squared = squared_length(q);
            changed = 1;
        }
    }
    return changed;
}

int zd_quaternions_wrong_length(const zd_system *system, const double *p, int any_length, double *length)
{
    for (int k = 0; k < system->quaternions; k++) {
        *length = sqrt(squared_length(p + system->quaternion[k]));
        int wrong = any_length ? *length == 0 : fabs(*length - 1) > WRITTEN;
        if (wrong) return k;
    }
    return -1;
}

static int block_of_coordinate(const zd_layout *layout, int coordinate)
{
    int low = 0, high = layout->blocks - 1;
    while (low < high) {
        const int middle = low + (high - low + 1) / 2;
        if (layout->coordinate_at[middle] <= coordinate) low = middle;
        else high = middle - 1;
    }
    return low;
}

int zd_quaternion_off_unit(const zd_point *point, int *velocity)
{
    const zd_system *system = point->system;
    const zd_layout *layout = point->layout;
    for (int k = 0; k < system->quaternions; k++) {
        const int first = system->quaternion[k];
        const int begin = layout ? layout->velocity_at[block_of_coordinate(layout, first)] : 0;
        const int end = layout ? layout->velocity_at[block_of_coordinate(layout, first + ENTRIES - 1) + 1] : system->nv;
        for (int j = begin; j < end; j++) {     /* velocities of its block: no others change it */
            double along = 0, largest = 0;
            for (int i = first; i < first + ENTRIES; i++) {
                along += point->p[i] * zd_entry_of_A(point, i, j);
                largest = fmax(largest, fabs(zd_entry_of_A(point, i, j)));
            }
            *velocity = j;
            if (fabs(along) > KEPT * largest) return k;
        }
    }
    return -1;
}
