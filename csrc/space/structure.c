/* Bodies are the blocks, with a constant diagonal mass; the rows of a joint, and each relation, are a group. */
#include "structure.h"

void zd_packing3_take(zd_packing3 *self, zd_arena *arena, size_t bodies, size_t rows, size_t terms)
{
#define TAKE(member, count) self->member = zd_take(arena, (count) * sizeof *self->member)
    TAKE(at, rows);
    TAKE(near, terms);
    TAKE(far, terms);
    TAKE(coordinates, bodies);
    TAKE(velocities, bodies);
    TAKE(mass, bodies);
    TAKE(rows, rows);
    TAKE(first, rows + 1);
    TAKE(block, 2 * terms);
#undef TAKE
}

/* Adds a body to those that a group touches, which stay in order. */
static void touch(const zd_packing3 *self, int first, int *end, int body)
{
    int i = first;
    const int block = body - 1;
    while (i < *end && self->block[i] < block) i++;
    if (!body || (i < *end && self->block[i] == block)) return;
    for (int k = (*end)++; k > i; k--) self->block[k] = self->block[k - 1];
    self->block[i] = block;
}

/* Where a body's entries begin in a row of the group whose blocks begin at `first`. */
static int offset_of(const zd_packing3 *self, int first, int body)
{
    int offset = 0;
    for (int i = first; body && self->block[i] != body - 1; i++) offset += self->velocities[self->block[i]];
    return body ? offset : -1;
}

static int is_in_group(const zd_space *space, int before, int row)
{
    const zd_row_owner *a = space->owner_of_row + before, *b = space->owner_of_row + row;
    return a->owner == b->owner && a->index == b->index && (before < space->mh) == (row < space->mh);
}

/* The bodies of the group of rows from `row` on; returns how many rows it has. */
static int touch_all(const zd_packing3 *self, const zd_space *space, int row, int first, int *end)
{
    int count = 0;
    for (; row + count < space->m && (count == 0 || is_in_group(space, row, row + count)); count++) {
        const zd_relation *one = space->row + row + count;
        for (int i = one->first; i < one->first + one->terms; i++) {
            touch(self, first, end, space->gauge[space->term[i].gauge].first);
            touch(self, first, end, space->gauge[space->term[i].gauge].second);
        }
    }
    return count;
}

static int plan_group(zd_packing3 *self, const zd_space *space, int row)
{
    const int group = self->structure.groups++, first = self->first[group];
    int end = first, width = 0, count = touch_all(self, space, row, first, &end);
    for (int i = first; i < end; i++) width += self->velocities[self->block[i]];
    for (int k = row; k < row + count; k++) {
        const zd_relation *one = space->row + k;
        for (int i = one->first; i < one->first + one->terms; i++) {
            self->near[i] = offset_of(self, first, space->gauge[space->term[i].gauge].first);
            self->far[i] = offset_of(self, first, space->gauge[space->term[i].gauge].second);
        }
        self->at[k] = self->size_of_C;
        self->size_of_C += width;
    }
    self->first[group + 1] = end;
    self->rows[group] = count;
    return count;
}

int zd_packing3_plan(zd_packing3 *self, const zd_space *space)
{
    for (int b = 0; b < space->bodies; b++) {
        const int turns = space->body[b + 1].turns;
        self->coordinates[b] = turns ? ZD_BODY_COORDINATES : ZD_POINT_COORDINATES;
        self->velocities[b] = turns ? ZD_BODY_VELOCITIES : ZD_POINT_COORDINATES;
        self->mass[b] = ZD_CONSTANT | ZD_DIAGONAL;
    }
    self->first[0] = self->size_of_C = 0;
    self->structure = (zd_structure){
        .blocks = space->bodies, .coordinates = self->coordinates, .velocities = self->velocities, .mass = self->mass,
        .rows = self->rows, .first = self->first, .block = self->block};
    for (int row = 0, count; row < space->m; row += count) {
        count = plan_group(self, space, row);
        const int group = self->structure.groups - 1;
        if (self->first[group] == self->first[group + 1]) return row;
    }
    return -1;
}
