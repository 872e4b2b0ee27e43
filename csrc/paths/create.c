/* Closed-form functions for a run, and memory for the closed-form path. */
#include "path.h"

const zd_closed_form *zd_closed_form_of(const zd_system *system, const zd_formulation *formulation, enum zd_unit unit)
{
    if (zd_own_constraints(system) > system->nv || (formulation->update && !formulation->may_have_entries(system))) return NULL;
    const zd_closed_form *found = NULL;
    for (int i = 0; i < system->closed_forms; i++) {
        const zd_closed_form *closed_form = &system->closed_form[i];
        if (!(formulation->update ? closed_form->embeddings : closed_form->orders)) continue;
        if (closed_form->lanes == 1 && closed_form->unit <= unit && (!found || closed_form->unit > found->unit)) found = closed_form;
    }
    return found;
}

void zd_closed_form_create(zd_motion *motion, zd_arena *arena, enum zd_unit unit)
{
    const zd_system *system = &motion->system;
    const zd_closed_form *closed_form = zd_closed_form_of(system, motion->formulation, unit);
    if (!closed_form) return;
    const int embeds = motion->formulation->update != NULL, orders = embeds ? closed_form->embeddings : closed_form->orders;
    motion->path = (zd_path){
        .closed_form = closed_form,
        .equations = embeds ? &zd_equations_of_independent : &zd_equations_in_closed_form,
        .first = embeds ? closed_form->embedding : closed_form->order,
        .orders = orders,
        .order = -1,
        .scale = zd_arena_doubles(arena, orders * system->nv),
        .pivots = zd_arena_doubles(arena, system->nv),
        .before = zd_arena_doubles(arena, system->nv),
        .pdot = zd_arena_doubles(arena, system->nq),
        .range = zd_arena_bytes(arena, system->nv * sizeof(zd_range)),
        .dp = zd_arena_doubles(arena, system->nq),
        .dv = zd_arena_doubles(arena, system->nv),
        .allowed = zd_arena_doubles(arena, system->mh),
    };
    if (embeds) zd_embed_create(motion, arena);
}
