/* Motion of a system by prescribed quantities, without forces and masses.
 *
 * Positions are tracked from sample to sample on one assembly branch. A linear predictor follows the rates that the change of the
 * prescribed quantities determines; its deviation from what Newton's method has found is extrapolated from the samples before, so that one
 * iteration mostly suffices. A part of the way is refused, and halved, where the deviation exceeds a fifth of the predictor's step, as it
 * does where the branch is left, and where the quantities have no position any more. What remains after that is a dead point, which is not
 * passed: later samples are tracked from the last one before it. Velocities and accelerations follow from (5) and (6) with the rows of the
 * prescribed quantities.
 */
#include <math.h>
#include <string.h>

#include "../linalg/small.h"
#include "prescribed_rows.h"

static const double LARGEST_STEP = 0.25;        /* step of the linear predictor, in characteristic scales */
static const double LARGEST_DEVIATION = 0.2;    /* deviation from the linear predictor, relative to its step */
static const double SMALLEST_PART = 1e-9;       /* smallest part of the way between two samples */
static const double SINGULAR = 1e-6;            /* relative pivot next to a dead point */
static const double NEAR_SINGULAR = 1e-3;       /* relative pivot below which a dead point, not a contradiction, may end the way */
static const double CONTRADICTION = 1e-10;      /* residual of a redundant row, in characteristic scales */
static const double OF_CHANGES = 1e-3;          /* residual relative to changes of prescribed quantities that contradict each other */
static const double OF_RATES = 1e-9;            /* residual relative to rates */
static const double CONVERGED = 1e-13;          /* last iteration, in characteristic scales */
static const double STAGNATED = 1e-9;           /* last iteration where the next ones are not smaller */
static const double DIVERGED = 1e3;             /* iteration, in characteristic scales */
enum { MAX_ITERATIONS = 30, ORDERS = 5 };

typedef struct tracker {
    const zd_prescribed_motion *motion;
    int nq, mh, quantities, time;   /* offset of the time below */
    zd_prescribed_rows rows;
    /* (nq + quantities + 1,): position, prescribed values and time of the last sample, of the last target that was reached after it, and of
     * the one to be reached */
    double *sample, *reached, *next;
    int is_factored;        /* true if the rows are those of `reached` */
    int is_determined;      /* true if the quantities determine all positions where the tracking begins */
    double *x, *change;     /* (nv,), (nq,): a displacement, and a change of position */
    double *linear;         /* (nq,): position of the linear predictor */
    double iteration;       /* size of the last iteration */
    int known;              /* number of known deviations */
    double *deviation;      /* (ORDERS, nq): of the last parts from the linear predictor, over the squares of their lengths, last first */
} tracker;

static void *create(zd_arena *arena, const void *of)
{
    const zd_prescribed_motion *motion = of;
    const int nq = motion->system->nq, time = nq + motion->quantities;
    const size_t all = (size_t)time + 1;
    const tracker self = {
        .motion = motion, .nq = nq, .mh = motion->system->mh, .quantities = motion->quantities, .time = time,
        .rows = zd_prescribed_rows_create(arena, motion), .sample = zd_arena_doubles(arena, all),
        .reached = zd_arena_doubles(arena, all), .next = zd_arena_doubles(arena, all),
        .x = zd_arena_doubles(arena, (size_t)motion->system->nv), .change = zd_arena_doubles(arena, all),
        .linear = zd_arena_doubles(arena, all), .deviation = zd_arena_doubles(arena, ORDERS * all)};
    return zd_arena_copy(arena, &self, sizeof self);
}

static void copy(const tracker *self, const double *from, double *to) { zd_copy_all(self->time + 1, from, to); }

static int factor(tracker *self, const double *at) { return zd_prescribed_rows_factor(&self->rows, at[self->time], at); }

/* Right-hand side: `by` times the terms of the first constraints, and the differences a - b of the prescribed quantities; b NULL: a. */
static void set_right(tracker *self, double by, const double *terms, int constraints, const double *a, const double *b)
{
    double *right = self->rows.right;
    for (int k = 0; k < constraints; k++) right[k < self->mh ? k : k + self->quantities] = terms ? by * terms[k] : 0;
    for (int i = 0; i < self->quantities; i++) right[self->mh + i] = b ? a[i] - b[i] : a[i];
}

/* Size of the change in characteristic scales. */
static double size_of_change(const tracker *self)
{
    return zd_max_scaled(self->nq, self->change, self->motion->inverse_scale_p);
}

/* change <- solution for the right-hand side; returns its size. */
static double find_change(tracker *self)
{
    zd_prescribed_rows_solve(&self->rows, self->x);
    zd_point_rate(self->rows.point, self->x, self->change);
    return size_of_change(self);
}

/* to <- from, displaced by the change, with unit quaternions and dependent coordinates restored; `to` may be `from` */
static void displace(const tracker *self, const double *from, double *to)
{
    const zd_system *system = self->motion->system;
    for (int i = 0; i < self->nq; i++) to[i] = from[i] + self->change[i];
    zd_quaternions_normalise(system, to);
    if (system->followers) system->follow(system->data, to);
}

/* ---- one part of the way ---- */

/* Factors the rows at the reached target, and sets the right-hand side to the changes from there to the next one. */
static int set_changes(tracker *self)
{
    const int status = self->is_factored ? ZD_DONE : factor(self, self->reached);
    self->is_factored = !status;
    set_right(self, self->reached[self->time] - self->next[self->time], self->rows.point->terms.Phi_t, self->mh, self->next + self->nq,
              self->reached + self->nq);
    return status;
}

/* True at a dead point, or next to it: positions are inaccurate there, and rates may be those of another branch. */
static int is_singular(const tracker *self) { return self->is_determined && !(self->rows.space.pivot > SINGULAR); }

/* linear <- position of the linear predictor, *step <- its size; next <- the same with the deviation extrapolated from those of earlier
 * parts, unless that is large. `h`: length of the part */
static int predict(tracker *self, double h, double *step)
{
    const int status = set_changes(self);
    if (status) return status;
    *step = find_change(self);
    if (is_singular(self)) return ZD_NO_CONVERGENCE;
    if (!(*step <= LARGEST_STEP)) return ZD_NO_CONVERGENCE;
    displace(self, self->reached, self->linear);
    memset(self->change, 0, (size_t)self->nq * sizeof *self->change);
    double weight = h * h * self->known;
    for (int k = 0; k < self->known; k++) {
        zd_add_scaled(self->nq, self->change, weight, self->deviation + k * self->nq);
        weight *= (double)(k + 1 - self->known) / (k + 2);
    }
    if (size_of_change(self) <= LARGEST_DEVIATION * *step) displace(self, self->linear, self->next);
    else zd_copy_all(self->nq, self->linear, self->next);
    return ZD_DONE;
}

/* Newton's method from the next position. Rows that contradict each other are met as nearly as can be, and do not converge. */
static int correct(tracker *self)
{
    double last = self->iteration = INFINITY;
    self->is_factored = 0;
    for (int i = 0; i < MAX_ITERATIONS; i++, last = self->iteration) {
        const int status = factor(self, self->next);
        if (status) return status;
        set_right(self, -1, self->rows.point->terms.Phi, self->mh, self->next + self->nq, self->rows.value);
        const double size = self->iteration = find_change(self), residual = zd_prescribed_rows_residual(&self->rows, self->rows.positions);
        if (!(size <= DIVERGED) || (size < STAGNATED && residual > CONTRADICTION + 1e3 * size)) return ZD_NO_CONVERGENCE;
        displace(self, self->next, self->next);
        if (size < CONVERGED || (size < STAGNATED && size > last / 4)) return ZD_DONE;
    }
    return ZD_NO_CONVERGENCE;
}

/* From the reached target to the next one; ZD_NO_CONVERGENCE: that is too far to be sure of it. */
static int go(tracker *self, double h)
{
    const int nq = self->nq;
    double step;
    int status = predict(self, h, &step);
    if (!status) status = correct(self);
    if (status) return status;
    if (is_singular(self)) return ZD_NO_CONVERGENCE;
    for (int i = 0; i < nq; i++) self->change[i] = self->next[i] - self->linear[i];
    if (!(size_of_change(self) <= LARGEST_DEVIATION * step + 1e-9)) return ZD_NO_CONVERGENCE;
    copy(self, self->next, self->reached);
    self->is_factored = 1;
    if (h == 0) return ZD_DONE;
    memmove(self->deviation + nq, self->deviation, (size_t)((ORDERS - 1) * nq) * sizeof *self->deviation);
    for (int i = 0; i < nq; i++) self->deviation[i] = self->change[i] / (h * h);
    self->known += self->known < ORDERS;
    return ZD_DONE;
}

/* ---- samples ---- */

/* Values and time of the next target <- those at a share of the way from the last sample to sample i */
static void set_target(tracker *self, int64_t i, double share)
{
    const double *from = self->sample + self->nq, *to = self->motion->value + i * (self->quantities + 1);
    for (int j = 0; j <= self->quantities; j++) self->next[self->nq + j] = share < 1 ? from[j] + share * (to[j] - from[j]) : to[j];
}

/* From the last sample to sample i; ZD_NO_CONVERGENCE: that is beyond a dead point, next to `reached`. */
static int follow(tracker *self, int64_t i)
{
    double done = 0, part = 1;
    while (done < 1) {
        part = fmin(part, 1 - done);
        set_target(self, i, done + part);
        const int status = go(self, self->motion->rate ? self->next[self->time] - self->reached[self->time] : part);
        if (status && status != ZD_NO_CONVERGENCE) return status;
        if (!status) done += part, part *= 2;
        else if ((part /= 2) < SMALLEST_PART) return status;
    }
    return ZD_DONE;
}

/* Notes the first sample at which redundant rows contradict the others by more than a share of the right-hand side, whose size
 * is at least `least`. */
static void note_contradiction(const zd_prescribed_rows *rows, int count, double share, double least, int64_t i, zd_tracked *found)
{
    const double size = fmax(zd_largest(count, rows->right), least), residual = zd_prescribed_rows_residual(rows, count);
    if (found->contradicting >= 0 || !(residual > share * size + CONTRADICTION)) return;
    found->contradicting = i;
    found->contradiction = residual / size;
}

/* Saves the first dead point, with a contradiction of the changes from there to sample i, and returns to the last sample. */
static int note_dead_point(tracker *self, int64_t i, zd_tracked *found)
{
    int status = ZD_DONE;
    if (found->dead < 0) {
        found->dead = i;
        zd_copy_all(self->quantities + 1, self->reached + self->nq, found->reached);
        set_target(self, i, 1);
        status = set_changes(self);
        find_change(self);
        if (self->rows.space.pivot > NEAR_SINGULAR)
            note_contradiction(&self->rows, self->rows.positions, OF_CHANGES, 0, i, found);
    }
    copy(self, self->sample, self->reached);
    self->is_factored = 0;
    return status;
}

/* Velocities and accelerations at sample i, from (5) and (6). */
static int find_rates(tracker *self, int64_t i, zd_tracked *found)
{
    const zd_prescribed_motion *motion = self->motion;
    zd_prescribed_rows *rows = &self->rows;
    const zd_terms *terms = &rows->point->terms;
    const int nv = motion->system->nv, m = zd_constraints(motion->system);
    set_right(self, -1, terms->Phi_t, m, motion->rate + i * self->quantities, NULL);
    zd_prescribed_rows_solve(rows, found->v + i * nv);
    note_contradiction(rows, rows->rows, OF_RATES, 0, i, found);
    const double speed = zd_largest(nv, rows->y);
    const int status = zd_prescribed_rows_move(rows, found->v + i * nv);
    set_right(self, 1, terms->xi, m, motion->second + i * self->quantities, rows->bias);
    zd_prescribed_rows_solve(rows, found->vdot + i * nv);
    note_contradiction(rows, rows->rows, OF_RATES, speed * speed, i, found);      /* accelerations of a steady turn are differences */
    return status;
}

int zd_find_position(const zd_prescribed_motion *motion, double *p, double *iteration)
{
    zd_store store = {NULL};
    tracker *self = zd_store_create(&store, create, motion);
    if (!self) return ZD_NO_MEMORY;
    displace(self, p, self->next);
    set_target(self, 0, 1);
    const int status = correct(self);
    zd_copy_all(self->nq, self->next, p);
    *iteration = self->iteration;
    zd_store_release(&store);
    return status;
}

int zd_kinematics(const zd_prescribed_motion *motion, const double *p, zd_tracked *found)
{
    zd_store store = {NULL};
    tracker *self = zd_store_create(&store, create, motion);
    if (!self) return ZD_NO_MEMORY;
    found->dead = found->contradicting = -1;
    set_target(self, 0, 1);
    zd_copy_all(self->nq, p, self->next);
    int status = factor(self, self->next);
    self->is_determined = found->is_determined = self->rows.space.pivot > SINGULAR;
    zd_copy_all(self->quantities, self->rows.value, self->next + self->nq);
    copy(self, self->next, self->sample);
    copy(self, self->next, self->reached);
    for (int64_t i = 0; i < motion->samples && !status; i++) {
        status = follow(self, i);
        if (status == ZD_NO_CONVERGENCE) {
            status = note_dead_point(self, i, found);
            continue;
        }
        copy(self, self->reached, self->sample);
        zd_copy_all(self->nq, self->sample, found->p + i * self->nq);
        if (motion->rate && !status) status = find_rates(self, i, found);
    }
    zd_store_release(&store);
    return status;
}
