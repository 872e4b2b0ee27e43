/* One of many mechanisms: made from its own tables, and assembled where its start is not known. */
#include "varied.h"

#include "../workspace.h"
#include "assembly.h"
#include "plan.h"

static zd_tables tables_of(const zd_tables *first, const double *gravity, int64_t run)
{
    zd_tables tables = *first;
    tables.gravity[0] = gravity[2 * run];
    tables.gravity[1] = gravity[2 * run + 1];
    tables.body += run * tables.bodies;
    tables.joint += run * tables.joints;
    tables.gauge += run * tables.gauges;
    tables.uses.term += run * tables.uses.terms;
    tables.uses.relation += run * tables.uses.relations;
    tables.uses.effort += run * tables.uses.efforts;
    return tables;
}

static zd_mechanism *create(const zd_tables *first, const double *gravity, int64_t run)
{
    char message[200];
    const zd_tables tables = tables_of(first, gravity, run);
    return zd_mechanism_create(&tables, message, sizeof message);
}

/* poses and rates (2, bodies, 3) <- those of the start; what these bodies are in absolute coordinates is (p, v), one behind the other */
static int assemble(const zd_varied *self, int64_t run, const zd_mechanism *drawn, double *poses, double *p)
{
    const zd_system *system = zd_mechanism_system(drawn);
    const int bodies = drawn->tree.bodies;
    double *v = p + system->nv, *scratch = v + system->nv;
    zd_mechanism_state(drawn, self->poses + run * 3 * bodies, NULL, p, NULL);
    if (!zd_assemble(drawn, self->length[run], self->targets, self->target, p, v)) return 0;
    zd_mechanism_poses(drawn, p, v, poses, poses + 3 * bodies, scratch);
    return 1;
}

/* p and v of the mechanism that moves */
static int find_start(const zd_varied *self, int64_t run, const zd_mechanism *moving, double *p, double *v)
{
    zd_mechanism *drawn = create(&self->drawn, self->gravity, run);
    if (!drawn) return 0;
    const zd_system *system = zd_mechanism_system(drawn);
    const size_t poses = 6 * (size_t)drawn->tree.bodies;
    double *memory = zd_allocate((poses + 2 * (size_t)system->nv + (size_t)system->scratch) * sizeof *memory);
    const int found = memory && assemble(self, run, drawn, memory, memory + poses);
    if (found) zd_mechanism_state(moving, memory, memory + poses / 2, p, v);
    zd_release(memory);
    zd_mechanism_free(drawn);
    return found;
}

const zd_system *zd_varied_make(const void *of, int64_t run, double *p, double *v, void **made)
{
    const zd_varied *self = of;
    zd_mechanism *moving = *made = create(&self->moving, self->gravity, run);
    if (!moving || (self->poses && !find_start(self, run, moving, p, v))) return NULL;
    return zd_mechanism_system(moving);
}

void zd_varied_free(void *made)
{
    if (made) zd_mechanism_free(made);
}
