/* Error of a step in the attitude of a body. In a steady rotation the acceleration is zero, and velocities do not show how well steps follow
 * the attitude. The quaternion shows it, by Hermite's formula as in resolution.c,
 *
 *     q1 - q0 = h (qdot0 + qdot1) / 2 - h^2 (qddot1 - qddot0) / 12 + O(h^5),        qddot = A_q vdot - |qdot|^2 q,
 *
 * where the last term is Adot v of a quaternion of constant length. Distances of quaternions are half the angles of rotation.
 */
#include "safeguards.h"

#include <math.h>

#include "../linalg/small.h"
#include "../point/point.h"

enum { ENTRIES = 4 };

/* Number of stored entries of A; 0 if the system provides products with A instead. */
static size_t size_of_A(const zd_system *system)
{
    if (zd_brings_times_A(system)) return 0;
    return system->structure ? (size_t)zd_packed_size(system, ZD_A) : (size_t)system->nq * system->nv;
}

zd_turning zd_turning_create(zd_arena *arena, zd_motion *motion, const zd_last *last, const double *vdot0, const double *pdot0,
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
        .A0 = zd_arena_doubles(arena, size_of_A(system)),
        .scratch = zd_arena_doubles(arena, system->scratch),
        .before = zd_arena_doubles(arena, system->nq),
        .after = zd_arena_doubles(arena, system->nq),
    };
}

/* The start of the step is evaluated in separate memory: the point is not moved. */
int zd_turning_evaluate(zd_turning *self)
{
    const zd_system *system = &self->motion->system;
    zd_point *point = self->motion->point, there = *point;
    there.terms.A = self->A0;
    there.terms.scratch = self->scratch;
    const int want = ZD_MOVED | (zd_brings_times_A(system) ? 0 : ZD_A);
    int status = zd_point_need_times_A(point, 0);
    if (status) return status;
    self->motion->statistics.evaluations++;
    if (system->evaluate(system->data, want, self->last->t, self->last->p, self->last->v, &there.terms)) return ZD_CALLBACK;
    zd_point_rate(&there, self->vdot0, self->before);
    zd_point_rate(point, point->vdot, self->after);
    return ZD_DONE;
}

/* qddot (4,) of a quaternion q, from its part of A vdot. */
static void accelerate(const double *Avdot, const double *q, const double *qdot, double *qddot)
{
    double squared = zd_dot(ENTRIES, qdot, qdot);
    for (int i = 0; i < ENTRIES; i++) qddot[i] = Avdot[i] - squared * q[i];
}

void zd_turning_compare(const zd_turning *self, int k, double h, double *missed, double *turned)
{
    const zd_point *point = self->motion->point;
    const int first = self->motion->system.quaternion[k];
    double before[ENTRIES], after[ENTRIES], squared = 0;
    accelerate(self->before + first, self->last->p + first, self->pdot0 + first, before);
    accelerate(self->after + first, point->p + first, self->pdot1 + first, after);
    for (int i = 0; i < ENTRIES; i++) {
        const int at = first + i;
        double off = point->p[at] - self->last->p[at] - h / 2 * (self->pdot0[at] + self->pdot1[at]) + h * h / 12 * (after[i] - before[i]);
        squared += off * off;
    }
    *missed = 2 * sqrt(squared);
    *turned = 2 * h * sqrt(zd_dot(ENTRIES, self->pdot1 + first, self->pdot1 + first));
}
