/* Groups follow each other as rows do, and each one's bodies are in order. */
#include "planned.h"

void zd_packed_create(zd_packed *self, zd_arena *arena, size_t bodies, size_t rows, size_t terms)
{
#define TAKE(member, count) self->member = zd_arena_bytes(arena, (count) * sizeof *self->member)
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
static void touch(const zd_packed *self, int first, int *end, int body)
{
    const int block = body - 1;
    int i = first;
    while (i < *end && self->block[i] < block) i++;
    if (!body || (i < *end && self->block[i] == block)) return;
    for (int k = (*end)++; k > i; k--) self->block[k] = self->block[k - 1];
    self->block[i] = block;
}

/* Offset of a body's entries in a row of the group whose blocks begin at `first`; -1 for the ground. */
static int offset_of(const zd_packed *self, int first, int body)
{
    int offset = 0;
    for (int i = first; body && self->block[i] != body - 1; i++) offset += self->velocities[self->block[i]];
    return body ? offset : -1;
}

static int is_in_group(const zd_planned_elements *elements, int before, int row)
{
    const zd_constraint_owner *a = elements->owner_of_constraint + before, *b = elements->owner_of_constraint + row;
    return a->owner == b->owner && a->index == b->index && (before < elements->mh) == (row < elements->mh);
}

/* Number of rows of the group that begins at `row`. */
static int rows_of_group(const zd_planned_elements *elements, int row)
{
    int count = 1;
    while (row + count < elements->m && is_in_group(elements, row, row + count)) count++;
    return count;
}

typedef struct ends {
    zd_bodies_of *of;
    const void *quantities;
} ends;

/* Lists the blocks, one for each body, in which `count` rows from `row` on have entries; *end: end of the list, which grows. */
static void touch_all(zd_packed *self, const zd_planned_elements *elements, ends bodies, int row, int count, int *end)
{
    const int first = *end;
    for (const zd_relation *one = elements->row + row; one < elements->row + row + count; one++)
        for (int i = one->first; i < one->first + one->terms; i++) {
            int body[2];
            bodies.of(bodies.quantities, elements->term[i].quantity, body);
            touch(self, first, end, body[0]);
            touch(self, first, end, body[1]);
        }
}

static void place_rows(zd_packed *self, const zd_planned_elements *elements, ends bodies, int row, int count, int first, int end)
{
    int width = 0;
    for (int i = first; i < end; i++) width += self->velocities[self->block[i]];
    for (int k = row; k < row + count; k++) {
        const zd_relation *one = elements->row + k;
        for (int i = one->first; i < one->first + one->terms; i++) {
            int body[2];
            bodies.of(bodies.quantities, elements->term[i].quantity, body);
            self->near[i] = offset_of(self, first, body[0]);
            self->far[i] = offset_of(self, first, body[1]);
        }
        self->at[k] = self->size_of_C;
        self->size_of_C += width;
    }
}

int zd_packed_plan(zd_packed *self, const zd_planned_elements *elements, int bodies, zd_bodies_of *bodies_of, const void *quantities)
{
    const ends those = {bodies_of, quantities};
    for (int b = 0; b < bodies; b++) self->mass[b] = ZD_CONSTANT | ZD_DIAGONAL;
    self->first[0] = self->size_of_C = 0;
    self->structure = (zd_structure){
        .blocks = bodies, .coordinates = self->coordinates, .velocities = self->velocities, .mass = self->mass,
        .rows = self->rows, .first = self->first, .block = self->block};
    for (int row = 0, count; row < elements->m; row += count) {
        const int group = self->structure.groups++, first = self->first[group];
        int end = first;
        count = self->rows[group] = rows_of_group(elements, row);
        touch_all(self, elements, those, row, count, &end);
        if (end == first) return row;
        place_rows(self, elements, those, row, count, first, end);
        self->first[group + 1] = end;
    }
    return -1;
}

static const int *bodies_at(const void *joints, size_t size, int k) { return (const int *)((const char *)joints + (size_t)k * size); }

void zd_list_ends(int count, const void *joints, size_t size, int bodies, int *at, int *end)
{
    for (int k = 0; k < count; k++)
        for (int side = 0; side < 2; side++) at[bodies_at(joints, size, k)[side] + 1]++;
    for (int body = 0; body <= bodies; body++) at[body + 1] += at[body];
    for (int k = count - 1; k >= 0; k--)        /* each one's place is where the next one's end is, from the back */
        for (int side = 1; side >= 0; side--) end[--at[bodies_at(joints, size, k)[side] + 1]] = 2 * k + side;
    for (int body = 0; body <= bodies; body++) at[body] = at[body + 1];
    at[bodies + 1] = 2 * count;
}
