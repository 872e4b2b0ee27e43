/* A force may jump across the state that it leads to, as dry friction written as the sign of a speed does at rest. Then each step crosses the
 * jump, and none may be longer than the tolerance allows across one: the run goes on for ever without getting anywhere.
 *
 * A step counts if two things hold together. With steps of its size the run would need ten times as many as it may take. And it changes each
 * entry of the state by a few tolerances only, which a step that resolves a fast but smooth motion does not: it changes them by about the
 * inverse of the accuracy, in a power of one over the order. Steps that stability limits are not counted: zd_stiffness. Bounds from
 * steps of dry friction, stiff dampers, stiff impacts and steep smooth laws, by three methods and tolerances from 1e-3 to 1e-9: at a jump
 * whose steps are that short at least a quarter of them count, in any other run at most 16.
 */
#include "step_loop.h"

#include <math.h>

#include "../linalg/small.h"

static const double SPARE = 10;             /* ratio of the steps needed to those that are allowed */
static const double MIN_ALLOWED = 1e6;    /* steps that are assumed to be allowed, at least */
static const double LITTLE = 16;            /* change of the state in a step, in units of its tolerance */

zd_collapse zd_collapse_create(zd_arena *arena, int nv)
{
    return (zd_collapse){
        .rate = zd_arena_doubles(arena, nv),
        .change = zd_arena_doubles(arena, nv),
    };
}

void zd_collapse_begin(zd_collapse *self, int64_t most)
{
    self->share = most ? 1 / (SPARE * fmax(MIN_ALLOWED, (double)most)) : 0;
}

/* True if the step has changed an entry of the state by more than a few tolerances. */
static int is_far(const zd_stepper *stepper, const double *scale)
{
    const double *y = stepper->y, *y0 = stepper->last.y;
    for (int i = 0; i < stepper->motion->rate.size; i++)
        if (fabs(y[i] - y0[i]) > LITTLE * scale[i]) return 1;
    return 0;
}

static void add_changes(zd_collapse *self, const zd_point *point, const double *v0, double h)
{
    for (int i = 0; i < point->system->nv; i++) {
        const double rate = (point->v[i] - v0[i]) / h;
        self->change[i] += self->count ? fabs(rate - self->rate[i]) * point->inverse_unit[i] : 0;
        self->rate[i] = rate;
    }
}

int zd_collapse_count(zd_collapse *self, const zd_stepper *stepper, double h, const double *scale)
{
    const zd_point *point = stepper->motion->point;
    if (scale && is_far(stepper, scale)) return ZD_DONE;
    if (!self->count) {
        self->t = stepper->last.t;
        zd_clear(point->system->nv, self->change);
    }
    add_changes(self, point, stepper->last.v, h);
    self->h = h;
    return ++self->count < ZD_COLLAPSES ? ZD_DONE : ZD_COLLAPSED;
}

int zd_collapse_velocity(const zd_collapse *self, int nv)
{
    int largest = 0;
    for (int i = 1; i < nv; i++)
        if (self->change[i] > self->change[largest]) largest = i;
    return largest;
}
