#include "assembly_rows.h"

#include <math.h>
#include <string.h>

#include "../../../linalg/small.h"
#include "../../../point/expand.h"
#include "../plan.h"

static const double SMALLEST = 1e-3;         /* these are as in assembly.py */
static const double LEAST_MASS = 1e-6;

zd_assembly zd_assembly_take(zd_arena *arena, const zd_plane *mechanism, const zd_wanted *wanted)
{
    const zd_system *system = &mechanism->system;
    const size_t n = (size_t)system->nv, m = (size_t)(system->mh + system->mn);
    const size_t most = m + (size_t)wanted->targets + 3;        /* and room for the rows of a vector */
    return (zd_assembly){
        .mechanism = mechanism, .system = system, .length = wanted->length, .n = system->nv, .mh = system->mh, .m = (int)m, .most = (int)most,
        .targets = wanted->targets, .target = wanted->target, .wanted = wanted,
        .terms = {.M = zd_take_doubles(arena, n * n), .C = zd_take_doubles(arena, m * n), .Phi = zd_take_doubles(arena, m),
                  .Phi_t = zd_take_doubles(arena, m), .scratch = zd_take_doubles(arena, (size_t)system->scratch)},
        .scratch = zd_take_doubles(arena, (size_t)mechanism->measures.scratch), .at_rest = zd_take_doubles(arena, n),
        .staying = zd_take_doubles(arena, (size_t)wanted->targets),
        .scale = zd_take_doubles(arena, n), .weight = zd_take_doubles(arena, n),
        .size = {zd_take_doubles(arena, most), zd_take_doubles(arena, most)},
        .dense = zd_take_doubles(arena, m * n), .r = zd_take_doubles(arena, most), .J = zd_take_doubles(arena, most * n),
        .Q = zd_take_doubles(arena, most * n), .L = zd_take_doubles(arena, most * most), .y = zd_take_doubles(arena, most),
        .step = zd_take_doubles(arena, n), .tried = zd_take_doubles(arena, n), .start = zd_take_doubles(arena, most),
    };
}

/* The square root of the mass metric, in scaled coordinates */
void zd_assembly_weigh(zd_assembly *self, const double *p)
{
    double largest = 0;
    self->system->evaluate(self->system->data, ZD_M | ZD_MOVED, 0, p, self->at_rest, &self->terms);
    for (int i = 0; i < self->n; i++) {
        const double mass = self->system->structure ? self->terms.M[i] : self->terms.M[i * (self->n + 1)];
        self->scale[i] = self->mechanism->coordinate[i].kind == ZD_COORDINATE_ANGLE ? 1 : self->length;
        self->weight[i] = mass * (self->scale[i] * self->scale[i]);
        largest = fmax(largest, self->weight[i]);
    }
    for (int i = 0; i < self->n; i++) self->weight[i] = sqrt(fmax(self->weight[i], LEAST_MASS * (largest > 0 ? largest : 1)));
}

double zd_assembly_measure(zd_assembly *self, const zd_target *target, const double *p, double *row)
{
    double value[3] = {0};
    const zd_measured out = {.value = value, .jacobian = row};
    const zd_measures *measures = self->system->measures;
    measures->evaluate(self->system->data, NULL, target->measure, 0, p, self->at_rest, NULL, NULL, &out, self->scratch);
    return value[target->component];
}

/* Adds the row of a target that is a rate or not, and how far it is from met. */
static void add_target(zd_assembly *self, int number, const double *p)
{
    const zd_target *target = self->target + number;
    const int is_kept = target->stays && !target->is_rate;
    if (is_kept && !self->knows_staying) return;
    self->r[self->rows] = zd_assembly_measure(self, target, p, self->Q) - (is_kept ? self->staying[number] : target->value);
    if (!target->stays) self->firm = self->rows + 1;
    memcpy(self->J + self->rows++ * self->n, self->Q + target->component * self->n, (size_t)self->n * sizeof *self->J);
}

/* r and J of rows 0 ... count - 1 of C, and of the targets that are rates or not; in scaled coordinates */
void zd_assembly_write_rows(zd_assembly *self, const double *p, int count, int targets, int rates)
{
    const int terms = (self->m ? ZD_C : 0) | (self->mh ? ZD_PHI : 0) | (self->system->provides & ZD_PHI_T);
    self->rows = self->firm = count;
    if (terms) self->system->evaluate(self->system->data, terms | ZD_MOVED, 0, p, self->at_rest, &self->terms);
    if (self->m && self->system->structure) zd_expand(self->system, ZD_C, self->terms.C, self->dense);
    const double *C = self->system->structure ? self->dense : self->terms.C;
    for (int k = 0; k < count; k++) self->r[k] = rates ? (self->system->provides & ZD_PHI_T ? self->terms.Phi_t[k] : 0) : self->terms.Phi[k];
    zd_copy(count * self->n, C, self->J);
    for (int i = 0; targets && i < self->targets; i++)
        if (self->target[i].is_rate == rates) add_target(self, i, p);
    for (int k = 0; k < self->rows; k++)
        for (int i = 0; i < self->n; i++) self->J[k * self->n + i] *= self->scale[i];
}

double zd_assembly_length_of(const zd_assembly *self, int row)
{
    return sqrt(zd_dot(self->n, self->J + row * self->n, self->J + row * self->n));
}

void zd_assembly_divide_row(zd_assembly *self, int row, double by)
{
    self->r[row] /= by;
    for (int i = 0; i < self->n; i++) self->J[row * self->n + i] /= by;
}

/* In units of their sizes where they were first met: these must not change while squares are made least. */
void zd_assembly_divide_by_sizes(zd_assembly *self, int which)
{
    double *size = self->size[which], largest = self->length;
    for (int k = 0; !self->is_known[which] && k < self->rows; k++) {
        size[k] = zd_assembly_length_of(self, k);
        largest = fmax(largest, size[k]);
    }
    for (int k = 0; !self->is_known[which] && k < self->rows; k++) size[k] = fmax(size[k], SMALLEST * largest);
    self->is_known[which] = 1;
    for (int k = 0; k < self->rows; k++) zd_assembly_divide_row(self, k, size[k]);
}

int zd_assembly_is_of_joint(const zd_assembly *self, int row)
{
    return row < self->mh && zd_plane_rows(self->mechanism)[row].owner == ZD_OF_JOINT;
}

/* The drive of constant speed that a row of C is, of those wanted; -1: it is none. */
int zd_assembly_drive_of(const zd_assembly *self, int row)
{
    if (row >= self->mh) return -1;
    const zd_row_owner *owner = zd_plane_rows(self->mechanism) + row;
    for (int i = 0; owner->owner == ZD_OF_RELATION && i < self->wanted->drives; i++)
        if (self->wanted->drive[i] == owner->index) return i;
    return -1;
}

static int is_chosen(const zd_assembly *self, enum zd_assembly_choice choice, int row)
{
    if (choice == ZD_OF_ALL || zd_assembly_is_of_joint(self, row)) return 1;
    if (choice == ZD_OF_JOINTS || row >= self->mh) return 0;
    const zd_relation *relation = zd_plane_planned(self->mechanism).row + row;
    return relation->law < 0 && relation->slope == 0 && relation->terms > 1;
}

/* r and J of the problem at p, without such drives; returns the largest |r| */
double zd_assembly_find(zd_assembly *self, const zd_assembly_problem *of, const double *p)
{
    zd_assembly_write_rows(self, p, self->mh, of->held, 0);
    zd_assembly_divide_by_sizes(self, self->rows > self->mh);
    int count = 0, firm = 0;
    for (int k = 0; k < self->rows; k++) {
        if (zd_assembly_drive_of(self, k) >= 0 || !is_chosen(self, of->choice, k)) continue;
        self->r[count] = self->r[k] - of->left * self->start[k];
        zd_copy(self->n, self->J + k * self->n, self->J + count++ * self->n);
        if (k < self->firm) firm = count;
    }
    self->rows = count;
    self->firm = firm;
    return zd_largest(count, self->r);
}
