/* Bodies are the blocks, with a constant diagonal mass; the rows of a joint, and each relation, are a group. */
#include "structure.h"

void zd_packing_take(zd_packing *self, zd_arena *arena, size_t bodies, size_t rows, size_t terms)
{
#define TAKE(member, count) self->member = zd_take(arena, (count) * sizeof *self->member)
    TAKE(weight, 3 * bodies);
    TAKE(row, rows);
    TAKE(near, terms);
    TAKE(far, terms);
    TAKE(coordinates, bodies);
    TAKE(mass, bodies);
    TAKE(rows, rows);
    TAKE(first, rows + 1);
    TAKE(block, 2 * terms);
    TAKE(pins.pin, rows / 2);
    TAKE(pins.end_at, bodies + 2);
    TAKE(pins.end, rows);
    TAKE(is_of_pin, rows);
#undef TAKE
}

/* Adds a body to those that a group touches, which stay in order. */
static void touch(const zd_packing *self, int first, int *end, int body)
{
    int i = first, block = body - 1;
    while (i < *end && self->block[i] < block) i++;
    if (!body || (i < *end && self->block[i] == block)) return;
    for (int k = (*end)++; k > i; k--) self->block[k] = self->block[k - 1];
    self->block[i] = block;
}

/* Where a body's entries begin in a row of the group whose blocks begin at `first`. */
static int offset_of(const zd_packing *self, int first, int body)
{
    int offset = 0;
    for (int i = first; body && self->block[i] != body - 1; i++) offset += self->coordinates[self->block[i]];
    return body ? offset : -1;
}

static int is_in_group(const zd_mechanism *mechanism, int before, int row)
{
    const zd_row_owner *a = mechanism->owner_of_row + before, *b = mechanism->owner_of_row + row;
    return a->owner == b->owner && a->index == b->index && (before < mechanism->mh) == (row < mechanism->mh);
}

/* The group of rows from `row` on; returns how many rows it has. */
static int plan_group(zd_packing *self, const zd_mechanism *mechanism, int row)
{
    int group = self->structure.groups++, first = self->first[group], end = first, count = 0, width = 0;
    for (; row + count < mechanism->m && (count == 0 || is_in_group(mechanism, row, row + count)); count++) {
        const zd_relation *one = mechanism->row + row + count;
        for (int i = one->first; i < one->first + one->terms; i++) {
            touch(self, first, &end, mechanism->gauge[mechanism->term[i].gauge].first);
            touch(self, first, &end, mechanism->gauge[mechanism->term[i].gauge].second);
        }
    }
    for (int i = first; i < end; i++) width += self->coordinates[self->block[i]];
    for (int k = row; k < row + count; k++) {
        const zd_relation *one = mechanism->row + k;
        for (int i = one->first; i < one->first + one->terms; i++) {
            self->near[i] = offset_of(self, first, mechanism->gauge[mechanism->term[i].gauge].first);
            self->far[i] = offset_of(self, first, mechanism->gauge[mechanism->term[i].gauge].second);
        }
        self->row[k] = self->size_of_C;
        self->size_of_C += width;
    }
    self->first[group + 1] = end;
    self->rows[group] = count;
    return count;
}

static int has_angle(const zd_mechanism *mechanism, int body) { return mechanism->tree.link[body].hang == ZD_HANGS_FREE; }

/* The pins among the rows, which are packed by then. */
static void plan_pins(zd_packing *self, const zd_mechanism *mechanism)
{
    zd_pins *pins = &self->pins;
    for (int row = 0; row < mechanism->m; row++) {
        if (!zd_pin_is_at(mechanism, row)) continue;
        const int term = mechanism->row[row].first, next = mechanism->row[row + 1].first;
        const zd_gauge *x = mechanism->gauge + mechanism->term[term].gauge, *y = mechanism->gauge + mechanism->term[next].gauge;
        pins->pin[pins->count++] = (zd_pin){
            x->first, x->second, {x->point1[0], x->point1[1]}, {x->point2[0], x->point2[1]}, {x->zero, y->zero},
            row, self->row[row], self->row[row + 1] - self->row[row], self->near[term], self->far[term],
            has_angle(mechanism, x->first), has_angle(mechanism, x->second)};
        self->is_of_pin[row] = self->is_of_pin[row + 1] = 1;
        row++;
    }
    zd_pins_list(pins, mechanism->tree.bodies);
    pins->are_all = 2 * pins->count == mechanism->m && pins->count == self->structure.groups;
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

int zd_packing_plan(zd_packing *self, const zd_mechanism *mechanism)
{
    int bodies = mechanism->tree.bodies;
    for (int b = 0; b < bodies; b++) {
        self->coordinates[b] = mechanism->tree.link[b + 1].hang == ZD_HANGS_FREE ? 3 : 2;
        self->mass[b] = ZD_CONSTANT | ZD_DIAGONAL;
    }
    self->first[0] = self->size_of_C = 0;
    self->structure = (zd_structure){
        .blocks = bodies, .coordinates = self->coordinates, .velocities = self->coordinates, .mass = self->mass,
        .rows = self->rows, .first = self->first, .block = self->block};
    for (int row = 0; row < mechanism->m;) {
        row += plan_group(self, mechanism, row);
        int group = self->structure.groups - 1;
        if (self->first[group] == self->first[group + 1]) return 0;
    }
    plan_pins(self, mechanism);
    plan_weight(self, mechanism);
    return 1;
}
