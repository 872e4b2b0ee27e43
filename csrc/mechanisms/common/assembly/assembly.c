#include "given.h"

#include <math.h>
#include <string.h>

#include "../../../linalg/small.h"
#include "problem.h"

static const double MET = 1e-9;         /* relative to the largest prescribed or computed velocity: tolerance of velocities */
static const double ZERO_ROW = 1e-9;    /* relative to the mechanism's length: length of a row of rounding errors */

/* ---- positions ---- */

/* Copies the residuals of the conditions last evaluated, and the sizes by which they are divided, to the caller. */
static void report(const zd_assembly *self, int roles)
{
    for (int k = 0; self->given->residual && k < self->rows; k++) {
        self->given->residual[k] = self->r[k];
        self->given->size[k] = self->size[roles][k];
    }
}

/* Reports the residuals in positions as near to the targets as closed joints allow; with drives, those in self->begun. */
static int report_unmet(zd_assembly *self, int roles, double *p)
{
    const zd_conditions all = {.choice = ZD_OF_ALL, .roles = roles}, none = {.choice = ZD_OF_ALL};
    int others = 0;
    zd_assembly_find(self, &none, p);
    const int rows = self->rows;
    for (int k = 0; k < rows; k++) others |= !zd_assembly_is_joint(self, k);
    zd_assembly_find(self, &all, self->begun);
    if (!others && self->rows > rows && self->given->nudge) {
        zd_assembly_perturb(self, p);
        zd_assembly_approach(self, 0, roles, p);
        zd_assembly_find(self, &all, p);
    }
    report(self, roles);
    return ZD_TARGETS_UNMET;
}

static int is_closed(zd_assembly *self, const double *p)
{
    const zd_conditions all = {.choice = ZD_OF_ALL, .roles = ZD_HELD | ZD_DRAWN};
    if (!zd_assembly_has(self, ZD_TARGET_HELD, 0) && zd_assembly_gap(self, p) <= ZD_CLOSED * ZD_SMALLEST_SIZE * self->given->length)
        return 1;           /* for any sizes of the constraints, whose computation requires the Jacobian */
    return zd_assembly_find(self, &all, p) <= ZD_CLOSED;
}

/* Assembles with the held targets met and with the values of the staying targets fixed to those of the drawing with its joints closed.
 * Returns 1 if that is possible, 0 otherwise. p (nq,): closed positions on entry, changed on success only. */
static int meet_staying(zd_assembly *self, double *p)
{
    const zd_conditions drawing = {.choice = ZD_OF_DRAWING, .roles = ZD_DRAWN};
    const zd_conditions all = {.choice = ZD_OF_ALL, .roles = ZD_HELD | ZD_STAYING | ZD_DRAWN};
    const size_t nq = self->system->nq;
    memcpy(self->found, p, nq * sizeof *p);
    if (!zd_assembly_newton(self, &drawing, self->found)) return 0;
    zd_assembly_approach_drawing(self, &drawing, self->found);
    zd_assembly_save(self, self->found);
    memcpy(self->as_drawn, self->found, nq * sizeof *p);
    if (!zd_assembly_track(self, all.roles, self->found)) return 0;
    double *kept = self->drawn;
    self->drawn = self->as_drawn;
    zd_assembly_approach_drawing(self, &all, self->found);
    self->drawn = kept;
    memcpy(p, self->found, nq * sizeof *p);
    return 1;
}

/* Closes the joints, and meets constraints and held targets from there; roles <- roles of the targets that are met. */
static int meet(zd_assembly *self, double *p, int *roles)
{
    const zd_conditions joints = {.choice = ZD_OF_JOINTS, .roles = ZD_DRAWN}, all = {.choice = ZD_OF_ALL, .roles = ZD_HELD | ZD_DRAWN};
    zd_copy_all(self->system->nq, p, self->drawn);
    if (!(zd_assembly_least_squares(self, &joints, p) <= 1e3 * ZD_CLOSED)) return ZD_JOINTS_OPEN;
    *roles = ZD_HELD | ZD_STAYING | ZD_DRAWN;
    if (zd_assembly_has(self, ZD_TARGET_STAYS, 0) && meet_staying(self, p)) return ZD_ASSEMBLED;
    *roles = ZD_HELD | ZD_DRAWN;
    if (!zd_assembly_track(self, *roles, p)) return report_unmet(self, *roles, p);
    zd_assembly_approach_drawing(self, &all, p);
    return ZD_ASSEMBLED;
}

int zd_assemble_positions(const zd_assembly_problem *given, double *p)
{
    zd_assembly self;
    int roles = ZD_HELD | ZD_STAYING | ZD_DRAWN, outcome = zd_assembly_open(&self, given, p);
    if (outcome) return outcome;
    if (!is_closed(&self, p)) outcome = meet(&self, p, &roles);
    else zd_assembly_save(&self, p);
    if (!outcome && zd_assembly_has(&self, ZD_TARGET_WISHED, 0)) zd_assembly_approach(&self, roles, ZD_WISHED, p);
    return zd_assembly_close(&self, outcome);
}

int zd_assembly_lead(const zd_assembly_problem *given, double *p)
{
    zd_assembly self;
    int outcome = zd_assembly_open(&self, given, p);
    if (outcome) return outcome;
    zd_assembly_save(&self, p);
    if (!zd_assembly_track(&self, ZD_HELD | ZD_STAYING, p)) outcome = report_unmet(&self, ZD_HELD | ZD_STAYING, p);
    return zd_assembly_close(&self, outcome);
}

int zd_assembly_project(const zd_assembly_problem *given, double *p)
{
    const zd_conditions all = {.choice = ZD_OF_ALL};
    zd_assembly self;
    int outcome = zd_assembly_open(&self, given, p);
    if (outcome) return outcome;
    zd_copy_all(self.system->nq, p, self.found);
    if (zd_assembly_newton(&self, &all, self.found)) zd_copy_all(self.system->nq, self.found, p);
    else outcome = ZD_TARGETS_UNMET;
    return zd_assembly_close(&self, outcome);
}

int zd_assembly_minimize(const zd_assembly_problem *given, double *p)
{
    const zd_conditions all = {.choice = ZD_OF_ALL};
    zd_assembly self;
    const int outcome = zd_assembly_open(&self, given, p);
    if (outcome) return outcome;
    for (int k = 0; k < self.most; k++) self.size[all.roles][k] = given->length;
    self.is_known[all.roles] = 1;
    zd_assembly_least_squares(&self, &all, p);
    return zd_assembly_close(&self, outcome);
}

int zd_assembly_check(const zd_assembly_problem *given, const double *p)
{
    zd_assembly self;
    const int outcome = zd_assembly_open(&self, given, p);
    if (outcome) return outcome;
    return zd_assembly_close(&self, is_closed(&self, p) ? ZD_ASSEMBLED : ZD_TARGETS_UNMET);
}

/* ---- velocities ---- */

/* Rows of length one; size <- their lengths, or the mechanism's length for those of rounding errors */
static void normalize_rates(zd_assembly *self, int count)
{
    for (int k = 0; k < count; k++) {
        const double length = zd_assembly_length_of(self, k);
        self->size[0][k] = length < ZERO_ROW * self->given->length ? self->given->length : length;
        zd_assembly_divide_row(self, k, self->size[0][k]);
    }
}

/* Largest |J x + r| of the first rows, which are left in self->right */
static double find_left(zd_assembly *self, int count, const double *x)
{
    for (int k = 0; k < count; k++) self->right[k] = zd_assembly_row_times(self, k, x) + self->r[k];
    return zd_largest(count, self->right);
}

/* Reports the residuals of contradictory velocities: weights with which the rows sum to zero, and their right sides do not. */
static int report_contradiction(zd_assembly *self)
{
    for (int k = 0; k < self->rows; k++) {
        const double unit = zd_assembly_unit_of(self, k, self->weight);
        self->r[k] = self->right[k] * unit;
        self->size[0][k] /= unit;
    }
    report(self, 0);
    return ZD_TARGETS_UNMET;
}

/* v <- velocities with the targets of these roles, and the wished ones */
static int find_velocities(zd_assembly *self, int roles, const double *p, double *v)
{
    zd_clear(self->n, v);
    zd_assembly_find_rates(self, roles, p);
    const int required = self->rows;
    zd_assembly_find_rates(self, roles | ZD_WISHED, p);
    if (zd_largest(required, self->r) == 0 && required == self->rows) return ZD_ASSEMBLED;
    normalize_rates(self, required);
    for (int k = 0; k < self->rows; k++) self->start[k] = -self->r[k];
    const int rows = self->rows;
    self->rows = required;
    zd_assembly_solve(self, required, self->start, self->weight, v);
    const double left = find_left(self, required, v), largest = fmax(zd_largest(required, self->r), zd_largest(self->n, v));
    if (!(left <= MET * largest)) return report_contradiction(self);
    self->rows = rows;
    if (required < rows) zd_assembly_solve(self, required, self->start, self->weight, v);
    for (int i = 0; i < self->n; i++) v[i] *= self->scale[i];
    return ZD_ASSEMBLED;
}

int zd_assemble_velocities(const zd_assembly_problem *given, const double *p, double *v)
{
    zd_assembly self;
    int outcome = zd_assembly_open(&self, given, p);
    if (outcome) return outcome;
    outcome = ZD_TARGETS_UNMET;
    if (zd_assembly_has(&self, ZD_TARGET_STAYS, 1)) outcome = find_velocities(&self, ZD_HELD | ZD_STAYING, p, v);
    if (outcome) outcome = find_velocities(&self, ZD_HELD, p, v);
    return zd_assembly_close(&self, outcome);
}
