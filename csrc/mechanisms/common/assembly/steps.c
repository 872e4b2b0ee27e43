#include "problem.h"

#include <math.h>
#include <string.h>

#include "../../../linalg/small.h"
#include "given.h"

static const double TRACKED = 0.1;          /* step of a target, at most, in rad or parts of the mechanism's length */
static const double LONGEST = 0.4;          /* step of any coordinate, at most, in the same units */
static const double NUDGE = 1e-3;           /* length of a perturbation, in the same units */
static const double FIRST_DAMPING = 1e-2, MIN_DAMPING = 1e-12, MAX_DAMPING = 1e12;
static const double SOLVED = 1e-12;         /* sum of squares below which Newton's method goes on */
static const double MIN_GAIN = 1e-14;     /* relative to the sum of squares: gain below which a minimization ends */
enum { ATTEMPTS = 200, HALVINGS = 20, NEARER = 50, ITERATIONS = 40, PARTS = 200 };

int zd_assembly_newton(zd_assembly *self, const zd_conditions *of, double *p)
{
    double best = zd_assembly_find(self, of, p);
    for (int i = 0; i < ITERATIONS && best >= 1e-15 && best < INFINITY; i++) {
        zd_assembly_solve(self, self->rows, self->r, self->metric, self->step);
        for (int j = 0; j < self->n; j++) self->step[j] = -self->step[j];
        zd_assembly_move(self, p, LONGEST, self->step, self->tried);
        const double error = zd_assembly_find(self, of, self->tried);
        if (!(error < best)) break;
        zd_copy_all(self->system->nq, self->tried, p);
        best = error;
    }
    return best <= ZD_CLOSED;
}

/* ---- least squares ---- */

/* A damped step from p to self->tried with a smaller sum of squares, which is returned; INFINITY: there is none. */
static double find_damped(zd_assembly *self, const zd_conditions *of, const double *p, double size, double *damping)
{
    const double unit = self->solver->prepare(self);
    for (; *damping < MAX_DAMPING && !self->status; *damping *= 4) {
        if (!self->solver->damp(self, *damping * unit)) continue;
        zd_assembly_move(self, p, LONGEST, self->step, self->tried);
        zd_assembly_find(self, of, self->tried);
        const double tried = zd_dot(self->rows, self->r, self->r);
        if (tried < size) return tried;
        zd_assembly_find(self, of, p);
    }
    return INFINITY;
}

double zd_assembly_least_squares(zd_assembly *self, const zd_conditions *of, double *p)
{
    double damping = FIRST_DAMPING;
    zd_assembly_find(self, of, p);
    double size = zd_dot(self->rows, self->r, self->r);
    for (int i = 0; i < ATTEMPTS && size >= SOLVED; i++) {
        const double tried = find_damped(self, of, p, size, &damping), gain = size - tried;
        if (!(tried < size)) break;
        zd_copy_all(self->system->nq, self->tried, p);
        damping = fmax(damping / 5, MIN_DAMPING);
        const int is_least = gain < MIN_GAIN * size;
        size = tried;
        if (is_least) break;
    }
    double *polished = self->polished;
    zd_copy_all(self->system->nq, p, polished);
    if (zd_assembly_newton(self, of, polished)) zd_copy_all(self->system->nq, polished, p);
    return zd_assembly_find(self, of, p);
}

/* ---- nearest positions ---- */

/* Distance to the drawing in the mass metric; step <- the displacement there */
static double find_way(zd_assembly *self, const double *p, double *step)
{
    double sum = 0;
    zd_displacement(self->system, self->drawn, p, step);
    for (int i = 0; i < self->n; i++) {
        step[i] /= self->scale[i];
        sum += step[i] * self->weight[i] * (step[i] * self->weight[i]);
    }
    return sqrt(sum);
}

void zd_assembly_approach_drawing(zd_assembly *self, const zd_conditions *of, double *p)
{
    double *step = self->x, *nearer = self->polished, distance = find_way(self, p, step);
    for (int i = 0; i < NEARER; i++) {
        zd_assembly_find(self, of, p);
        for (int k = 0; k < self->rows; k++) self->r[k] += zd_assembly_row_times(self, k, step);
        zd_assembly_solve(self, self->rows, self->r, self->weight, self->step);
        for (int j = 0; j < self->n; j++) self->step[j] = step[j] - self->step[j];
        zd_assembly_move(self, p, TRACKED, self->step, nearer);
        if (!zd_assembly_newton(self, of, nearer)) return;
        const double left = find_way(self, nearer, step);
        if (!(left < distance * (1 - 1e-6))) return;
        zd_copy_all(self->system->nq, nearer, p);
        distance = left;
    }
}

/* Norm of the residuals of rows from `first` on */
static double norm_from(const zd_assembly *self, int first)
{
    return sqrt(zd_dot(self->rows - first, self->r + first, self->r + first));
}

/* Takes the longest of a step and its halves that reduces the residuals of the wished targets; returns whether there is one. */
static int approach_by(zd_assembly *self, const zd_conditions *required, const zd_conditions *all, int first, double before, double *p)
{
    double *nearer = self->polished, *step = self->x;
    for (int i = 0; i < HALVINGS; i++) {
        zd_assembly_move(self, p, INFINITY, step, nearer);
        if (zd_assembly_newton(self, required, nearer)) {
            zd_assembly_find(self, all, nearer);
            if (norm_from(self, first) < before * (1 - 1e-9)) {
                zd_copy_all(self->system->nq, nearer, p);
                return 1;
            }
        }
        for (int j = 0; j < self->n; j++) step[j] /= 2;
    }
    return 0;
}

void zd_assembly_approach(zd_assembly *self, int required, int wished, double *p)
{
    const zd_conditions others = {.choice = ZD_OF_ALL, .roles = required}, all = {.choice = ZD_OF_ALL, .roles = required | wished};
    for (int i = 0; i < ATTEMPTS && !self->status; i++) {
        zd_assembly_find(self, &others, p);
        const int first = self->rows;
        zd_assembly_find(self, &all, p);
        const double before = norm_from(self, first);
        for (int k = 0; k < self->rows; k++) self->r[k] = k < first ? 0 : -self->r[k];
        zd_assembly_solve(self, first, self->r, NULL, self->x);
        const double most = zd_largest(self->n, self->x), share = most > TRACKED ? TRACKED / most : 1;
        for (int j = 0; j < self->n; j++) self->x[j] *= share;
        if (!approach_by(self, &others, &all, first, before, p)) return;
    }
}

/* ---- continuation ---- */

/* self->start <- residuals at p of drives, couplings and targets, zero for joints; returns the largest */
static double find_start(zd_assembly *self, int roles, const double *p)
{
    const zd_conditions all = {.choice = ZD_OF_ALL, .roles = roles};
    zd_assembly_find(self, &all, p);
    for (int k = 0; k < self->rows; k++) self->start[k] = zd_assembly_is_joint(self, k) ? 0 : self->r[k];
    return self->status ? INFINITY : zd_largest(self->rows, self->start);
}

static int lead(zd_assembly *self, int roles, double *p)
{
    zd_conditions all = {.choice = ZD_OF_ALL, .roles = roles};
    const double way = find_start(self, roles, p);
    const int parts = (int)fmin(PARTS, fmax(1, ceil(way / TRACKED)));
    for (int part = 1; part <= parts; part++) {
        all.left = 1.0 - (double)part / parts;
        zd_copy_all(self->system->nq, p, self->led);
        if (!zd_assembly_newton(self, &all, self->led)) return 0;
        zd_copy_all(self->system->nq, self->led, p);
    }
    return 1;
}

void zd_assembly_perturb(zd_assembly *self, double *p)
{
    const zd_conditions joints = {.choice = ZD_OF_JOINTS};
    for (int i = 0; i < self->n; i++) self->x[i] = NUDGE * self->given->nudge[i];
    zd_assembly_move(self, p, INFINITY, self->x, self->led);
    if (zd_assembly_newton(self, &joints, self->led)) zd_copy_all(self->system->nq, self->led, p);
}

int zd_assembly_track(zd_assembly *self, int roles, double *p)
{
    const zd_conditions all = {.choice = ZD_OF_ALL, .roles = roles};
    if (lead(self, roles, p)) return 1;
    for (int i = 0; i < (self->given->nudge ? 2 : 1) && !self->status; i++) {
        zd_copy_all(self->system->nq, p, self->begun);
        if (i) zd_assembly_perturb(self, self->begun);
        if (zd_assembly_least_squares(self, &all, self->begun) > 1e3 * ZD_CLOSED) continue;
        zd_copy_all(self->system->nq, self->begun, p);
        return 1;
    }
    return 0;
}
