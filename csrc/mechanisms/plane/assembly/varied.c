/* One of many mechanisms: made from its own tables, and assembled where its start is not known. */
#include "varied.h"

#include <math.h>
#include <string.h>

#include "../../../linalg/small.h"
#include "../../../workspace.h"
#include "../plan.h"

static zd_plane_tables tables_of(const zd_plane_tables *first, const double *gravity, int64_t run)
{
    zd_plane_tables tables = *first;
    tables.gravity[0] = gravity[2 * run];
    tables.gravity[1] = gravity[2 * run + 1];
    tables.body += run * tables.bodies;
    tables.joint += run * tables.joints;
    tables.quantity += run * tables.quantities;
    tables.elements.term += run * tables.elements.terms;
    tables.elements.relation += run * tables.elements.relations;
    tables.elements.force += run * tables.elements.forces;
    return tables;
}

/* Drives of constant speed begin at these places; NULL: at 0. */
static zd_plane *create(const zd_varied *self, const zd_plane_tables *first, int64_t run, const double *places)
{
    char message[200];
    zd_plane_tables tables = tables_of(first, self->gravity, run);
    if (!places || !self->drives) return zd_plane_create(&tables, message, sizeof message);
    const size_t size = tables.elements.relations * sizeof(zd_relation);
    zd_relation *relation = zd_allocate(size);
    if (!relation) return NULL;
    memcpy(relation, tables.elements.relation, size);
    for (int i = 0; i < self->drives; i++) relation[self->drive[i]].constant = places[i];
    tables.elements.relation = relation;
    zd_plane *made = zd_plane_create(&tables, message, sizeof message);
    zd_release(relation);
    return made;
}

typedef struct found {      /* start of one mechanism */
    double *poses, *rates, *places;     /* (bodies, 3) both; (drives,) */
    double *p, *v, *scratch;            /* state of the mechanism in absolute coordinates, and its scratch */
    double *Phi;                        /* (mh,) */
    int *role;                          /* (mh,), as an assembly requires it */
} found;

static found allocate(zd_arena *arena, const zd_varied *self, const zd_plane *drawn)
{
    const zd_system *system = zd_plane_system(drawn);
    const size_t bodies = 3 * (size_t)drawn->tree.bodies;
    return (found){
        .poses = zd_arena_doubles(arena, bodies), .rates = zd_arena_doubles(arena, bodies),
            .places = zd_arena_doubles(arena, self->drives),
        .p = zd_arena_doubles(arena, system->nv), .v = zd_arena_doubles(arena, system->nv),
        .scratch = zd_arena_doubles(arena, system->scratch), .Phi = zd_arena_doubles(arena, system->mh),
        .role = zd_arena_ints(arena, system->mh),
    };
}

/* Index of the drive of constant speed to which a row of C belongs, by the owner of the row; -1: it belongs to something else. */
static int drive_of(const zd_varied *self, const zd_constraint_owner *owner)
{
    for (int i = 0; owner->owner == ZD_OF_RELATION && i < self->drives; i++)
        if (self->drive[i] == owner->index) return i;
    return -1;
}

static enum zd_constraint_role role_of(const zd_varied *self, const zd_plane *drawn, int row)
{
    const zd_constraint_owner *owner = zd_plane_rows(drawn) + row;
    const zd_relation *relation = zd_plane_planned(drawn).row + row;
    if (owner->owner == ZD_OF_JOINT) return ZD_ROLE_JOINT;
    if (drive_of(self, owner) >= 0) return ZD_ROLE_IGNORED;
    return relation->law < 0 && relation->slope == 0 && relation->terms > 1 ? ZD_ROLE_COUPLING : ZD_ROLE_DRIVE;
}

/* Values of the driven coordinates, where the constants of these relations are 0 */
static void find_places(const zd_varied *self, const zd_plane *drawn, const found *to)
{
    const zd_system *system = zd_plane_system(drawn);
    const zd_terms terms = {.Phi = to->Phi, .scratch = to->scratch};
    system->evaluate(system->data, ZD_PHI | ZD_MOVED, 0, to->p, to->v, &terms);
    for (int k = 0; k < system->mh; k++) {
        const int drive = drive_of(self, zd_plane_rows(drawn) + k);
        if (drive >= 0) to->places[drive] = to->Phi[k];
    }
}

static int assemble(const zd_varied *self, int64_t run, const zd_plane *drawn, const found *to)
{
    const zd_system *system = zd_plane_system(drawn);
    const zd_assembly_problem given = {.system = system, .length = self->length[run], .role = to->role,
                                     .targets = self->targets, .target = self->target};
    for (int k = 0; k < system->mh; k++) to->role[k] = role_of(self, drawn, k);
    zd_plane_state(drawn, self->poses + run * 3 * drawn->tree.bodies, NULL, to->p, NULL);
    if (zd_assemble_positions(&given, to->p) || zd_assemble_velocities(&given, to->p, to->v)) return 0;
    if (!(zd_largest(system->nv, to->p) < INFINITY && zd_largest(system->nv, to->v) < INFINITY)) return 0;
    if (self->drives) find_places(self, drawn, to);
    zd_plane_poses(drawn, to->p, to->v, to->poses, to->rates, to->scratch);
    return 1;
}

/* The mechanism that moves, and its p and v; NULL: it does not start so. */
static zd_plane *start(const zd_varied *self, int64_t run, const zd_plane *drawn, double *p, double *v)
{
    zd_arena arena = {0};
    allocate(&arena, self, drawn);
    if (!zd_arena_allocate(&arena)) return NULL;
    const found at = allocate(&arena, self, drawn);
    zd_plane *moving = assemble(self, run, drawn, &at) ? create(self, &self->moving, run, at.places) : NULL;
    if (moving) zd_plane_state(moving, at.poses, at.rates, p, v);
    zd_release(arena.base);
    return moving;
}

const zd_system *zd_varied_make(const void *of, int64_t run, double *p, double *v, void **made)
{
    const zd_varied *self = of;
    zd_plane *drawn = self->poses ? create(self, &self->drawn, run, NULL) : NULL;
    zd_plane *moving = !self->poses ? create(self, &self->moving, run, NULL) : drawn ? start(self, run, drawn, p, v) : NULL;
    if (drawn) zd_plane_free(drawn);
    *made = moving;
    return moving ? zd_plane_system(moving) : NULL;
}

void zd_varied_free(void *made)
{
    if (made) zd_plane_free(made);
}

double zd_varied_place(const void *of, const void *made, int drive)
{
    const zd_varied *self = of;
    const zd_planned_elements *elements = &((const zd_plane *)made)->elements;
    return elements->row[elements->constraint_of_relation[self->drive[drive]]].constant;
}
