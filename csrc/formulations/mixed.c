/* (17): dependent coordinates p and independent velocities u. The velocities satisfy (5) by v = D u; only (3) is violated.
 * Near a bifurcation, where D loses digits, a run integrates (p, v) instead: state/variables.c. */

#include "../linalg/small.h"
#include "../point/point.h"
#include "formulation.h"
#include "minimal.h"

static void *create(zd_arena *arena, const zd_system *system, const void *given)
{
    (void)given;
    const int are_many = zd_rank_is_of_many(system);
    double *workspace = are_many ? NULL : zd_arena_doubles(arena, zd_constraints(system) * system->nv);
    zd_minimal self = are_many ? zd_minimal_create_many(arena, system) : zd_minimal_create(arena, system, workspace);
    return zd_arena_copy(arena, &self, sizeof self);
}

static int state_size(const zd_system *system)
{
    return system->nq + system->nv - zd_constraints(system);
}

static int unpack(void *self, zd_point *point, double t, const double *y)
{
    zd_minimal_note_lead_time(self, point, t);
    zd_point_move(point, t, y, point->v);
    return zd_minimal_unpack(self, point, y + point->system->nq);
}

static int pack(void *self, zd_point *point, double *y)
{
    zd_copy_all(point->system->nq, point->p, y);
    return zd_minimal_pack(self, point, y + point->system->nq);
}

static int express(void *self, zd_point *point, double *y)
{
    zd_copy_all(point->system->nq, point->p, y);
    return zd_minimal_express(self, point, y + point->system->nq);
}

static int rate(void *memory, zd_point *point, double *ydot)
{
    zd_minimal *self = memory;
    int status = zd_point_need(point, ZD_A);
    if (status) return status;
    zd_point_rate(point, point->v, ydot);                               /* (17): pdot = A D u */
    return zd_minimal_rate(self, point, ydot + point->system->nq);
}

static int tangents_of_p(void *self, zd_point *point, double *T, int *positions)
{
    (void)self;
    const int nq = point->system->nq, width = nq + point->system->nv;
    for (int i = 0; i < nq; i++)
        for (int j = 0; j < nq; j++) T[i * width + j] = i == j;
    *positions = nq;
    return ZD_DONE;
}

static int tangents_of_v(void *self, zd_point *point, const double *Psi_along, double *T)
{
    return zd_minimal_tangents(self, point, Psi_along, point->system->nq, T);
}

static void pick(const void *memory, const zd_point *point, const double *pdot, const double *vdot, double *ydot)
{
    const zd_minimal *self = memory;
    const int nq = point->system->nq;
    zd_copy_all(nq, pdot, ydot);
    zd_complement_pick(&self->complement, vdot, ydot + nq);
}

const zd_formulation zd_mixed = {
    .card = {
        .name = "mixed",
        .summary = "Dependent coordinates, independent velocities: only position constraints can be violated.",
        .equations = "(17)",
        .description = "All coordinates p and as many velocities u as there are degrees of freedom are integrated, and v = D u "
                       "satisfies the velocity constraints identically; only positions drift and are corrected. Nonholonomic "
                       "constraints, which restrict velocities alone, thus cannot be violated at all. The independent velocities "
                       "are chosen anew when they become badly conditioned.",
        .reference = "W. Blajer, Elimination of constraint violation and accuracy aspects in numerical simulation of multibody "
                     "systems, Multibody System Dynamics 7 (2002) 265-284, section 2.3",
    },
    .drifts_from = ZD_PHI,
    .many_constraints = ZD_MANY_CONSTRAINTS,
    .state_size = state_size,
    .create = create,
    .factor = zd_minimal_factor,
    .solve = zd_minimal_solve,
    .unpack = unpack,
    .pack = pack,
    .express = express,
    .update = zd_minimal_update,
    .may_have_entries = zd_minimal_may_have_entries,
    .entries = zd_minimal_entries,
    .rate = rate,
    .tangents_of_p = tangents_of_p,
    .tangents_of_v = tangents_of_v,
    .pick = pick,
};
