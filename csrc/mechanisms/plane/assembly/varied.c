/* One of many mechanisms: made from its own tables, and assembled where its start is not known. */
#include "varied.h"

#include <string.h>

#include "../../../workspace.h"
#include "../plan.h"
#include "assembly.h"

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
    const size_t size = (size_t)tables.elements.relations * sizeof(zd_relation);
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
} found;

static found take(zd_arena *arena, const zd_varied *self, const zd_plane *drawn)
{
    const zd_system *system = zd_plane_system(drawn);
    const size_t bodies = 3 * (size_t)drawn->tree.bodies;
    return (found){
        .poses = zd_take_doubles(arena, bodies), .rates = zd_take_doubles(arena, bodies),
            .places = zd_take_doubles(arena, (size_t)self->drives),
        .p = zd_take_doubles(arena, (size_t)system->nv), .v = zd_take_doubles(arena, (size_t)system->nv),
        .scratch = zd_take_doubles(arena, (size_t)system->scratch),
    };
}

static int assemble(const zd_varied *self, int64_t run, const zd_plane *drawn, const found *to)
{
    const zd_wanted wanted = {self->length[run], self->targets, self->target, self->drives, self->drive};
    zd_plane_state(drawn, self->poses + run * 3 * drawn->tree.bodies, NULL, to->p, NULL);
    if (!zd_assemble(drawn, &wanted, to->p, to->v, to->places)) return 0;
    zd_plane_poses(drawn, to->p, to->v, to->poses, to->rates, to->scratch);
    return 1;
}

/* The mechanism that moves, and its p and v; NULL: it does not start so. */
static zd_plane *start(const zd_varied *self, int64_t run, const zd_plane *drawn, double *p, double *v)
{
    zd_arena arena = {0};
    take(&arena, self, drawn);
    arena = (zd_arena){.base = zd_allocate(arena.used)};
    if (!arena.base) return NULL;
    const found at = take(&arena, self, drawn);
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
    return elements->row[elements->row_of_relation[self->drive[drive]]].constant;
}
