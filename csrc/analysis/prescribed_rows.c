#include "prescribed_rows.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "../linalg/small.h"

static const double DEPENDENT = 1e-9;   /* remaining norm relative to the largest at which a row is redundant; rounding leaves 1e-13 */
static const double SHORT_ROW = 1e-3;   /* norm of a row relative to the longest: smaller ones are divided by that */

zd_prescribed_rows zd_prescribed_rows_create(zd_arena *arena, const zd_prescribed_motion *motion)
{
    const zd_system *system = motion->system;
    const zd_measures *measures = motion->measured->measures;
    const int rows = zd_constraints(system) + motion->quantities, positions = rows - system->mn;
    const size_t all = (size_t)rows, nv = (size_t)system->nv, components = (size_t)motion->components;
    zd_statistics *statistics = zd_arena_bytes(arena, sizeof *statistics);
    double *of_measures = zd_arena_doubles(arena, components);
    return (zd_prescribed_rows){
        .motion = motion, .point = zd_point_create(arena, system, statistics), .positions = positions, .rows = rows,
        .unit = zd_arena_doubles(arena, all * nv), .inverse_length = zd_arena_doubles(arena, all), .value = zd_arena_doubles(arena, all),
        .bias = zd_arena_doubles(arena, all), .space = zd_row_space_create(arena, positions, system->nv),
        .right = zd_arena_doubles(arena, all), .y = zd_arena_doubles(arena, nv),
        .values = {.value = of_measures, .jacobian = zd_arena_doubles(arena, components * nv)},
        .biases = {.bias = of_measures, .is_same_state = 2},
        .scratch = zd_arena_doubles(arena, measures ? (size_t)measures->scratch : 0),
        .residuals = zd_residual_state_create(arena, system, statistics, ZD_ACCURATE),
        .rates = zd_arena_doubles(arena, 2 * (size_t)system->nq)};
}

/* ---- prescribed quantities ---- */

/* change (nq,) <- the derivative of A along the motion, times v. */
static int find_biases_of_coordinates(zd_prescribed_rows *self, double *change)
{
    zd_point *point = self->point;
    double *pdot = self->rates;
    zd_point_rate(point, point->v, pdot);
    const double size = fmax(zd_max_scaled(point->system->nq, pdot, self->motion->inverse_scale_p), DBL_MIN);
    zd_residual_state_begin(&self->residuals, ZD_RESIDUAL_PDOT, point, NULL, NULL);
    return zd_residual_derivatives(&self->residuals, &(zd_direction){.p = pdot}, 1 / size, ZD_ACCURATE, change);
}

/* Values of all quantities with their derivatives, or their biases. */
static int read_quantities(zd_prescribed_rows *self, int is_bias)
{
    const zd_prescribed_motion *motion = self->motion;
    zd_point *at = self->point;
    const zd_measured *read = is_bias ? &self->biases : &self->values;
    const int nv = at->system->nv;
    double *row = self->unit + at->system->mh * nv, *to = is_bias ? self->bias : self->value, *biases = NULL;
    int status = zd_measure_states(motion->measured, at->inputs, motion->measures, motion->measure, 1, &at->t, at->p, at->v, NULL, NULL,
                                   read, self->scratch);
    for (int i = 0; i < motion->quantities && !status; i++, row += nv) {
        const int k = motion->which[i], coordinate = -1 - k;
        if (k >= 0) to[i] = self->values.value[k];
        else if (!is_bias) status = zd_point_need(at, ZD_A), to[i] = at->p[coordinate];
        else {
            if (!biases) status = find_biases_of_coordinates(self, biases = self->rates + at->system->nq);
            to[i] = biases[coordinate];
        }
        if (is_bias || status) continue;
        for (int j = 0; j < nv; j++) row[j] = motion->scale_v[j] * (k < 0 ? zd_entry_of_A(at, coordinate, j) : read->jacobian[k * nv + j]);
        self->inverse_length[at->system->mh + i] = sqrt(zd_dot(nv, row, row));
    }
    return status > 0 ? ZD_CALLBACK : status;
}

/* ---- rows ---- */

/* Writes the rows of constraints, and divides all by their lengths. */
static void normalize(zd_prescribed_rows *self)
{
    const int nv = self->point->system->nv, mh = self->point->system->mh;
    double *inverse = self->inverse_length;
    for (int k = 0; k < zd_constraints(self->point->system); k++) {
        const int i = k < mh ? k : k + self->motion->quantities;
        inverse[i] = zd_point_scaled_row(self->point, k, self->motion->scale_v, self->unit + i * nv);
    }
    const double least = fmax(SHORT_ROW * zd_largest(self->rows, inverse), DBL_MIN);
    for (int k = 0; k < self->rows; k++) {
        inverse[k] = 1 / fmax(inverse[k], least);
        for (int i = k * nv; i < (k + 1) * nv; i++) self->unit[i] *= inverse[k];
    }
}

static void factor(zd_prescribed_rows *self)
{
    zd_row_space *space = &self->space;
    memcpy(space->A, self->unit, (size_t)(self->positions * space->n) * sizeof *self->unit);
    zd_row_space_prepare(space, self->positions, DEPENDENT, 0);
    space->rows = space->rank;      /* the redundant ones are not solved */
}

int zd_prescribed_rows_factor(zd_prescribed_rows *self, double t, const double *p)
{
    zd_point *point = self->point;
    zd_point_move(point, t, p, point->v);
    int status = zd_point_check_domain(point, 0, 0);
    if (!status) status = zd_point_measure(point);
    if (!status) status = zd_point_need_times_A(point, ZD_PHI | ZD_C | ZD_PHI_T);
    if (!status) status = read_quantities(self, 0);
    if (status) return status;
    normalize(self);
    factor(self);
    return ZD_DONE;
}

int zd_prescribed_rows_move(zd_prescribed_rows *self, const double *v)
{
    zd_point_move_velocity(self->point, v);
    const int status = zd_point_need(self->point, ZD_XI);
    return status ? status : read_quantities(self, 1);
}

void zd_prescribed_rows_solve(zd_prescribed_rows *self, double *x)
{
    const int n = self->space.n;
    for (int k = 0; k < self->rows; k++) self->right[k] *= self->inverse_length[k];
    zd_row_space_solve(&self->space, self->right, self->y);
    for (int i = 0; i < n; i++) x[i] = self->motion->scale_v[i] * self->y[i];
}

double zd_prescribed_rows_residual(const zd_prescribed_rows *self, int rows)
{
    const int nv = self->space.n;
    double largest = 0;
    for (int i = self->space.rank; i < rows; i++) {
        const int k = i < self->positions ? self->space.order[i] : i;
        largest = fmax(largest, fabs(zd_dot(nv, self->unit + k * nv, self->y) - self->right[k]));
    }
    return largest;
}
