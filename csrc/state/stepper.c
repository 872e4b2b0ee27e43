#include "stepper.h"

#include <string.h>

#include "../constraints/rank.h"
#include "../linalg/small.h"
#include "../point/point.h"

void zd_stepper_create(zd_stepper *self, zd_arena *arena, zd_motion *motion, const zd_integrator *integrator, const void *given,
                     zd_variables dependent, const zd_system *independent)
{
    const zd_system *system = &motion->system;
    int own = motion->formulation_size, more = dependent.size > own ? dependent.size - own : 0;
    size_t size = motion->rate.size + more;
    double *y = zd_arena_doubles(arena, size), *last = zd_arena_doubles(arena, size);
    const size_t used = arena->used;
    void *memory = integrator->create(arena, integrator->table, motion, y, (int)size, given);
    const zd_span memory_of_integrator = zd_span_since(arena, used);
    if (dependent.formulation) dependent.solver = dependent.formulation->create(arena, independent, NULL);
    const int is_complete = !motion->formulation->update;     /* then the state begins with p and v */
    *self = (zd_stepper){
        .motion = motion,
        .chosen = {motion->formulation, motion->solver, own},
        .dependent = dependent,
        .capacity = (int)size,
        .integrator = integrator,
        .memory = memory,
        .memory_of_integrator = memory_of_integrator,
        .y = y,
        .last = {
            .y = last,
            .p = is_complete ? last : zd_arena_doubles(arena, system->nq),
            .v = !is_complete ? zd_arena_doubles(arena, system->nv) : last ? last + system->nq : NULL,
        },
    };
    zd_motion_attach(motion, self->y);
}

/* ---- a step ---- */

void zd_stepper_save_start(zd_stepper *self, double h)
{
    const zd_motion *motion = self->motion;
    const zd_point *point = motion->point;
    self->last.t = self->t;
    self->last.h = h;
    point->rank->was_ill_conditioned = 0;
    if (self->last.chosen) memcpy(self->last.chosen, motion->memory_of_chosen.at, motion->memory_of_chosen.bytes);
    zd_copy_few(motion->rate.size, self->y, self->last.y);
    if (self->last.p == self->last.y) return;
    zd_copy_few(point->system->nq, point->p, self->last.p);
    zd_copy_few(point->system->nv, point->v, self->last.v);
}

int zd_stepper_make(zd_stepper *self, double h)
{
    const zd_integrator *integrator = self->integrator;
    zd_motion *motion = self->motion;
    return integrator->step_of_motion ? integrator->step_of_motion(self->memory, motion, self->t, h, self->y)
         : integrator->step(self->memory, &motion->rate, self->t, h, self->y, &motion->statistics);
}

int zd_stepper_return(zd_stepper *self)
{
    zd_motion *motion = self->motion;
    self->t = self->last.t;
    motion->state = self->y;
    zd_copy(motion->rate.size, self->last.y, self->y);
    zd_point_move(motion->point, self->last.t, self->last.p, self->last.v);
    /* The variables of the state may be chosen anew; on the closed-form path they do not change. */
    return zd_motion_updates(motion) ? motion->equations->pack(motion, self->y) : ZD_DONE;
}

int zd_stepper_rates(const zd_stepper *self, double *pdot, double *vdot)
{
    zd_motion *motion = self->motion;
    zd_point *point = motion->point;
    int status = zd_motion_accelerate(motion);
    if (!status && zd_has_A(point->system)) status = zd_point_need_times_A(point, 0);
    if (status) return status;
    if (zd_has_A(point->system)) zd_point_rate(point, point->v, pdot);
    else zd_copy_all(point->system->nv, point->v, pdot);
    zd_copy_all(point->system->nv, point->vdot, vdot);
    return ZD_DONE;
}

/* ---- places ---- */

int zd_stepper_set_state(zd_stepper *self, double t, const double *p, const double *v)
{
    zd_motion *motion = self->motion;
    self->t = t;
    motion->state = self->y;
    zd_point_move(motion->point, t, p, v);
    zd_point_normalise(motion->point);
    int status = zd_point_measure(motion->point);
    if (status) return status;
    return motion->equations->pack(motion, self->y);
}

static size_t extras(const zd_motion *motion)
{
    return motion->rate.size - motion->formulation_size;
}

zd_state zd_state_create(zd_arena *arena, const zd_motion *motion)
{
    return (zd_state){
        .p = zd_arena_doubles(arena, motion->system.nq),
        .v = zd_arena_doubles(arena, motion->system.nv),
        .extra = zd_arena_doubles(arena, extras(motion)),
    };
}

void zd_stepper_save_state(const zd_stepper *self, zd_state *place)
{
    const zd_motion *motion = self->motion;
    place->t = self->t;
    zd_copy_few(motion->system.nq, motion->point->p, place->p);
    zd_copy_few(motion->system.nv, motion->point->v, place->v);
    if (extras(motion)) memcpy(place->extra, self->y + motion->formulation_size, extras(motion) * sizeof(double));
}

int zd_stepper_return_to(zd_stepper *self, const zd_state *place)
{
    const zd_motion *motion = self->motion;
    memcpy(self->y + motion->formulation_size, place->extra, extras(motion) * sizeof(double));
    return zd_stepper_set_state(self, place->t, place->p, place->v);
}
