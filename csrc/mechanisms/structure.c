/* How bodies that are free are stored, and which of their rows are pins. */
#include "structure.h"

void zd_packing_take(zd_packing *self, zd_arena *arena, size_t bodies, size_t rows, size_t terms)
{
    zd_packed_take(&self->packed, arena, bodies, rows, terms);
#define TAKE(member, count) self->member = zd_take(arena, (count) * sizeof *self->member)
    TAKE(weight, 3 * bodies);
    TAKE(pins.pin, rows / 2);
    TAKE(pins.end_at, bodies + 2);
    TAKE(pins.end, rows);
    TAKE(is_of_pin, rows);
#undef TAKE
}

static int has_angle(const zd_mechanism *mechanism, int body) { return mechanism->tree.link[body].hang == ZD_HANGS_FREE; }

/* The pins among the rows, which are packed by then. */
static void plan_pins(zd_packing *self, const zd_mechanism *mechanism)
{
    const zd_packed *packed = &self->packed;
    zd_pins *pins = &self->pins;
    for (int row = 0; row < mechanism->uses.m; row++) {
        if (!zd_pin_is_at(mechanism, row)) continue;
        const int term = mechanism->uses.row[row].first, next = mechanism->uses.row[row + 1].first;
        const zd_gauge *x = mechanism->gauge + mechanism->uses.term[term].gauge, *y = mechanism->gauge + mechanism->uses.term[next].gauge;
        pins->pin[pins->count++] = (zd_pin){
            x->first, x->second, {x->point1[0], x->point1[1]}, {x->point2[0], x->point2[1]}, {x->zero, y->zero},
            row, packed->at[row], packed->at[row + 1] - packed->at[row], packed->near[term], packed->far[term],
            has_angle(mechanism, x->first), has_angle(mechanism, x->second)};
        self->is_of_pin[row] = self->is_of_pin[row + 1] = 1;
        row++;
    }
    zd_pins_list(pins, mechanism->tree.bodies);
    pins->are_all = 2 * pins->count == mechanism->uses.m && pins->count == packed->structure.groups;
    pins->have_angles = mechanism->tree.angles == mechanism->tree.bodies;
}

static void plan_weight(zd_packing *self, const zd_mechanism *mechanism)
{
    double *f = self->weight;
    for (const zd_link *link = mechanism->tree.link + 1; link <= mechanism->tree.link + mechanism->tree.bodies; link++) {
        *f++ = link->mass * mechanism->gravity.x;
        *f++ = link->mass * mechanism->gravity.y;
        if (link->hang == ZD_HANGS_FREE) *f++ = 0;
    }
}

static void write_bodies_of(const void *gauges, int gauge, int body[2])
{
    const zd_gauge *of = gauges;
    body[0] = of[gauge].first;
    body[1] = of[gauge].second;
}

int zd_packing_plan(zd_packing *self, const zd_mechanism *mechanism)
{
    const int bodies = mechanism->tree.bodies;
    for (int b = 0; b < bodies; b++)
        self->packed.coordinates[b] = self->packed.velocities[b] = mechanism->tree.link[b + 1].hang == ZD_HANGS_FREE ? 3 : 2;
    if (zd_packed_plan(&self->packed, &mechanism->uses, bodies, write_bodies_of, mechanism->gauge) >= 0) return 0;
    plan_pins(self, mechanism);
    plan_weight(self, mechanism);
    return 1;
}
