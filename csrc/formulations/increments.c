/* Increments. With unit quaternions no nv entries of p determine it everywhere. Instead, relative to the p0 at the start of a step,
 *
 *     q = A(p0)^+ (p - p0),        A^+ A = I,
 *
 * which is linear in p: so qdot = A(p0)^+ A(p) v, without rates of a rotation vector, and an integrator keeps its order. At p0, qdot =
 * v. For a rotation by the angle a from p0, q is 2 sin(a / 2) along the axis, which is not unique beyond half a turn: a step that turns
 * a body by more than a third of a turn is divided.
 *
 * A^+ is that of least squares in characteristic scales. One characteristic scale is added to each increment: relative errors of
 * adaptive steps then refer to it, as for coordinates p, and not to the increment, which is zero at the start of a step.
 */
#include "embedding.h"

#include <math.h>

#include "../linalg/small.h"
#include "../point/point.h"

static const double INCREMENT_ROUNDING = 4 * 0x1p-52;
static const double REACH = 0.5;    /* cos(a / 2) of the largest rotation angle a of a step */

zd_increments zd_increments_create(zd_arena *arena, const zd_system *system)
{
    if (!system->quaternions && !system->followers) return (zd_increments){.nq = 0};
    size_t nq = system->nq, nv = system->nv;
    return (zd_increments){
        .nq = (int)nq,
        .nv = (int)nv,
        .base = zd_arena_doubles(arena, nq),
        .inverse = zd_arena_doubles(arena, nv * nq),
        .gram = zd_arena_doubles(arena, nv * nv),
        .rounding = zd_arena_doubles(arena, nv),
    };
}

/* inverse <- (W A U)^T, gram <- its product with W A U: W, U the characteristic scales of p and v. Coordinates that follow others are
 * left out, as they add no information. */
static void weigh(zd_increments *self, const zd_point *point)
{
    const int nq = self->nq, nv = self->nv, leading = nq - point->system->followers;
    for (int j = 0; j < nv; j++)
        for (int i = 0; i < leading; i++)
            self->inverse[j * nq + i] = point->inverse_unit_p[i] * zd_entry_of_A(point, i, j) * point->unit[j];
    for (int j = 0; j < nv; j++) zd_clear(nq - leading, self->inverse + j * nq + leading);
    for (int j = 0; j < nv; j++)
        for (int l = 0; l <= j; l++)
            self->gram[j * nv + l] = self->gram[l * nv + j] = zd_dot(nq, self->inverse + j * nq, self->inverse + l * nq);
}

/* Column i of the inverse: gram^-1 times its present entries, with the scales. `column` (nv,): work space */
static void invert_column(zd_increments *self, const zd_point *point, int i, double *column)
{
    const int nq = self->nq, nv = self->nv;
    for (int j = 0; j < nv; j++) column[j] = self->inverse[j * nq + i];
    zd_forward(nv, self->gram, column, column);
    zd_backward(nv, self->gram, column, column);
    for (int j = 0; j < nv; j++) self->inverse[j * nq + i] = point->unit[j] * column[j] * point->inverse_unit_p[i];
}

static double row_rounding(const zd_increments *self, const zd_point *point, int j)
{
    double sum = point->unit[j];
    for (int i = 0; i < self->nq; i++)
        sum += fabs(self->inverse[j * self->nq + i]) * fmax(1 / point->inverse_unit_p[i], fabs(point->p[i]));
    return INCREMENT_ROUNDING * sum;
}

int zd_increments_begin(zd_increments *self, zd_point *point)
{
    int status = zd_point_need(point, ZD_A);
    if (status) return status;
    zd_copy_all(self->nq, point->p, self->base);
    weigh(self, point);
    point->failed_index = zd_cholesky(self->nv, self->gram, self->gram);
    if (point->failed_index < self->nv) return ZD_SINGULAR;
    for (int i = 0; i < self->nq; i++) invert_column(self, point, i, self->rounding);
    for (int j = 0; j < self->nv; j++) self->rounding[j] = row_rounding(self, point, j);
    return ZD_DONE;
}

int zd_increments_are_within_reach(const zd_increments *self, const zd_system *system, const double *p)
{
    for (int k = 0; k < system->quaternions; k++) {
        const int first = system->quaternion[k];
        if (!(zd_dot(4, self->base + first, p + first) >= REACH)) return 0;
    }
    return 1;
}

double zd_increments_value(const zd_increments *self, const zd_point *point, const double *p, int j)
{
    const double *row = self->inverse + j * self->nq;
    double sum = 0;
    for (int i = 0; i < self->nq; i++) sum += row[i] * (p[i] - self->base[i]);
    return point->unit[j] + sum;
}

double zd_increments_rate(const zd_increments *self, const double *pdot, int j)
{
    return zd_dot(self->nq, self->inverse + j * self->nq, pdot);
}

void zd_increments_row(const zd_increments *self, const zd_point *point, int j, double *row)
{
    const double *inverse = self->inverse + j * self->nq;
    zd_clear(self->nv, row);
    for (int i = 0; i < self->nq; i++)
        for (int l = 0; l < self->nv; l++) row[l] += inverse[i] * zd_entry_of_A(point, i, l);
}
