/* (19) and (22): independent coordinates q and independent velocities. Nothing can be violated.
 * Near a bifurcation, where q and u lose digits, a run integrates (p, v) instead: state/variables.c.
 *
 * Where all constraints are holonomic and pdot = v, the velocities are qdot and this is (19); otherwise they are the u' of (22). With unit
 * quaternions, q are increments about where the step begins, and the velocities are their rates there.
 */
#include "../point/point.h"
#include "embedding.h"
#include "formulation.h"
#include "minimal.h"

typedef struct independent {
    zd_minimal minimal;         /* first: its factor() and solve() are this one's */
    zd_embedding embedding;
    double *pdot;               /* (nq,) */
} independent;

extern const zd_formulation zd_independent;

/* True if the relations of surplus coordinates are known: each unit quaternion has one, and each coordinate that follows others is one. */
static int suits(const zd_system *system) { return system->nq == system->nv + system->quaternions + system->followers; }

static void *create(zd_arena *arena, const zd_system *system, const void *given)
{
    (void)given;
    if (zd_has_many_constraints(&zd_independent, system)) {
        independent self = {.minimal = zd_minimal_create_many(arena, system)};
        return zd_arena_copy(arena, &self, sizeof self);
    }
    zd_embedding embedding = zd_embedding_create(arena, system);
    independent self = {
        .minimal = zd_minimal_create(arena, system, zd_embedding_workspace(&embedding)),
        .embedding = embedding,
        .pdot = zd_arena_doubles(arena, system->nq),
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

static int state_size(const zd_system *system)
{
    return (system->nv - system->mh) + (system->nv - zd_constraints(system));
}

static int unpack(void *memory, zd_point *point, double t, const double *y)
{
    independent *self = memory;
    zd_partition_sparse *many = self->minimal.many;
    if (many) {
        int status = zd_partition_sparse_place(many, point, t, y);
        return status ? status : zd_minimal_unpack(&self->minimal, point, y + many->k);
    }
    zd_minimal_note_lead_time(&self->minimal, point, t);
    int status = zd_embedding_place(&self->embedding, point, t, y);
    return status ? status : zd_minimal_unpack(&self->minimal, point, y + self->embedding.k);
}

static int pack_many(zd_minimal *minimal, zd_point *point, double *y)
{
    int status = zd_partition_sparse_coordinates(minimal->many, point, y);
    return status ? status : zd_minimal_pack(minimal, point, y + minimal->many->k);
}

static int pack(void *memory, zd_point *point, double *y)
{
    independent *self = memory;
    const zd_embedding *embedding = &self->embedding;
    if (!suits(point->system)) return ZD_UNSUITED;
    if (self->minimal.many) return pack_many(&self->minimal, point, y);
    int changed, status = zd_embedding_review(&self->embedding, point, &changed);
    if (status) return status;
    /* (19): u is qdot */
    if (changed && !point->system->mn && (!point->terms.A || point->system->quaternions || point->system->followers)) {
        zd_complement_prefer(&self->minimal.complement, embedding->index);
        point->known &= ~(ZD_COMPLEMENTED | ZD_FACTORED | ZD_ACCELERATED);
    }
    zd_embedding_coordinates(embedding, point, y);
    return zd_minimal_pack(&self->minimal, point, y + embedding->k);
}

static int express(void *memory, zd_point *point, double *y)
{
    independent *self = memory;
    const int k = self->minimal.many ? self->minimal.many->k : self->embedding.k;
    if (self->minimal.many) zd_partition_sparse_pick_coordinates(self->minimal.many, point->p, y);
    else zd_embedding_coordinates(&self->embedding, point, y);
    return zd_minimal_express(&self->minimal, point, y + k);
}

static int rate(void *memory, zd_point *point, double *ydot)
{
    independent *self = memory;
    const zd_embedding *embedding = &self->embedding;
    if (self->minimal.many) {
        zd_partition_sparse_pick_coordinates(self->minimal.many, point->v, ydot);               /* (21) */
        return zd_minimal_rate(&self->minimal, point, ydot + self->minimal.many->k);       /* (19), (22) */
    }
    int status = zd_point_need(point, ZD_A);
    if (status) return status;
    zd_point_rate(point, point->v, self->pdot);
    zd_embedding_rates(embedding, self->pdot, ydot);                                       /* (21) */
    return zd_minimal_rate(&self->minimal, point, ydot + embedding->k);      /* (19), (22) */
}

static int tangents_of_p(void *memory, zd_point *point, double *T, int *positions)
{
    independent *self = memory;
    *positions = self->embedding.k;
    return self->minimal.many ? ZD_SINGULAR : zd_embedding_tangents(&self->embedding, point, point->system->nq + point->system->nv, T);
}

static int tangents_of_v(void *memory, zd_point *point, const double *Psi_along, double *T)
{
    independent *self = memory;
    return zd_minimal_tangents(&self->minimal, point, Psi_along, self->embedding.k, T);
}

static void pick(const void *memory, const zd_point *point, const double *pdot, const double *vdot, double *ydot)
{
    (void)point;
    const independent *self = memory;
    zd_embedding_rates(&self->embedding, pdot, ydot);
    zd_complement_pick(&self->minimal.complement, vdot, ydot + self->embedding.k);
}

static int have_same(int count, const int *a, const int *b)
{
    int same = 0;
    for (int i = 0; i < count; i++)
        for (int j = 0; j < count; j++) same += a[i] == b[j];
    return same == count;
}

/* True for (19), and for nonholonomic constraints alone, where q is p. */
static int may_have_entries(const zd_system *system)
{
    return zd_minimal_may_have_entries(system) && !(system->provides & ZD_A) && !(system->mh && system->mn);
}

static int entries(const void *memory, zd_entries *entries)
{
    const independent *self = memory;
    const zd_embedding *embedding = &self->embedding;
    const int has_u = zd_minimal_entries(&self->minimal, entries);
    const double steepest = zd_embedding_steepest(embedding);
    entries->q = embedding->index;
    if (!has_u) return 0;
    if (steepest < entries->steepest) entries->steepest = steepest;
    return embedding->k == embedding->nq || have_same(embedding->k, entries->q, entries->u);
}

const zd_formulation zd_independent = {
    .card = {
        .name = "independent",
        .summary = "Independent coordinates and velocities: no constraint can be violated.",
        .equations = "(19), (22)",
        .description = "As many coordinates q as there are degrees of freedom are integrated, and all others follow from p = "
                       "g(q), which is solved at each evaluation, or is known in closed form. Nothing can be violated and "
                       "nothing has to be corrected, but each evaluation requires an iteration. The independent coordinates are "
                       "chosen anew when they become badly conditioned. Systems must have as many coordinates as velocities, plus "
                       "one for each unit quaternion.",
        .reference = "R. A. Wehage, E. J. Haug, Generalized coordinate partitioning for dimension reduction in analysis of "
                     "constrained dynamic systems, Journal of Mechanical Design 104 (1982) 247-255",
    },
    .drifts_from = 0,
    .many_constraints = ZD_MANY_CONSTRAINTS_WITHOUT_A,
    .suits = suits,
    .state_size = state_size,
    .create = create,
    .factor = zd_minimal_factor,
    .solve = zd_minimal_solve,
    .unpack = unpack,
    .pack = pack,
    .express = express,
    .update = zd_minimal_update,
    .may_have_entries = may_have_entries,
    .entries = entries,
    .rate = rate,
    .tangents_of_p = tangents_of_p,
    .tangents_of_v = tangents_of_v,
    .pick = pick,
};
