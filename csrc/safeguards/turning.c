/* A body that turns steadily has no acceleration, and velocities say nothing of how well steps follow its attitude. Its quaternion does, by
 * Hermite's formula as in resolution.c,
 *
 *     q1 - q0 = h (qdot0 + qdot1) / 2 - h^2 (qddot1 - qddot0) / 12 + O(h^5),        qddot = A_q vdot - |qdot|^2 q,
 *
 * where the last term is what Adot v is for a q whose length is kept. Half an angle is what it is of a quaternion.
 */
#include "turning.h"

#include <math.h>

#include "../linalg/small.h"

enum { ENTRIES = 4 };

zd_turning zd_turning_take(zd_arena *arena, zd_motion *motion, const zd_last *last, const double *vdot0, const double *pdot0,
                           const double *pdot1)
{
    const zd_system *system = &motion->system;
    if (!system->quaternions) return (zd_turning){.motion = motion};
    return (zd_turning){
        .motion = motion,
        .last = last,
        .vdot0 = vdot0,
        .pdot0 = pdot0,
        .pdot1 = pdot1,
        .A0 = zd_take_doubles(arena, (size_t)system->nq * (size_t)system->nv),
        .scratch = zd_take_doubles(arena, (size_t)system->scratch),
    };
}

/* On its own memory: the point stays where it is. */
int zd_turning_begin(zd_turning *self)
{
    const zd_system *system = &self->motion->system;
    zd_terms terms = self->motion->point->terms;
    terms.A = self->A0;
    terms.scratch = self->scratch;
    self->motion->statistics.evaluations++;
    return system->evaluate(system->data, ZD_A | ZD_MOVED, self->last->t, self->last->p, self->last->v, &terms) ? ZD_CALLBACK : ZD_DONE;
}

/* qddot (4,) of the quaternion that begins at `first` */
static void accelerate(int first, int nv, const double *A, const double *vdot, const double *p, const double *pdot, double *qddot)
{
    double squared = zd_dot(ENTRIES, pdot + first, pdot + first);
    for (int i = 0; i < ENTRIES; i++) qddot[i] = zd_dot(nv, A + (first + i) * nv, vdot) - squared * p[first + i];
}

void zd_turning_compare(const zd_turning *self, int k, double h, double *missed, double *turned)
{
    const zd_point *point = self->motion->point;
    const int nv = self->motion->system.nv, first = self->motion->system.quaternion[k];
    double before[ENTRIES], after[ENTRIES], squared = 0;
    accelerate(first, nv, self->A0, self->vdot0, self->last->p, self->pdot0, before);
    accelerate(first, nv, point->terms.A, point->vdot, point->p, self->pdot1, after);
    for (int i = 0; i < ENTRIES; i++) {
        const int at = first + i;
        double off = point->p[at] - self->last->p[at] - h / 2 * (self->pdot0[at] + self->pdot1[at]) + h * h / 12 * (after[i] - before[i]);
        squared += off * off;
    }
    *missed = 2 * sqrt(squared);
    *turned = 2 * h * sqrt(zd_dot(ENTRIES, self->pdot1 + first, self->pdot1 + first));
}
