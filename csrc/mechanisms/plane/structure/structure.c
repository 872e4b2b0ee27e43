/* Storage of free bodies, and the constraint rows that are revolute joints. */
#include "structure.h"

#include <string.h>

void zd_packing_create(zd_packing *self, zd_arena *arena, size_t bodies, size_t rows, size_t terms, size_t lines)
{
    zd_packed_create(&self->packed, arena, bodies, rows, terms);
#define TAKE(member, count) self->member = zd_arena_bytes(arena, (count) * sizeof *self->member)
    TAKE(weight, 3 * bodies);
    TAKE(revolutes.between, rows / 2);
    TAKE(revolutes.points, rows / 2);
    TAKE(revolutes.joint, rows / 2);
    TAKE(revolutes.end_at, bodies + 2);
    TAKE(revolutes.end, rows);
    TAKE(lines.line, lines);
    TAKE(is_known, rows);
    TAKE(at, bodies + 1);
    TAKE(pin_first, rows / 2);
    TAKE(pin_second, rows / 2);
    TAKE(numbers, 2 * bodies + 3 * rows + 2);
#undef TAKE
}

static int has_angle(const zd_plane *mechanism, int body) { return mechanism->tree.link[body].hang == ZD_HANGS_FREE; }

/* Finds the revolute joints among the packed rows. */
static void plan_revolute_joints(zd_packing *self, const zd_plane *mechanism)
{
    const zd_packed *packed = &self->packed;
    zd_revolute_joints *revolutes = &self->revolutes;
    for (int row = 0; row < mechanism->elements.m; row++) {
        if (!zd_is_revolute_joint_at(mechanism, row)) continue;
        const int term = mechanism->elements.row[row].first, next = mechanism->elements.row[row + 1].first;
        const zd_plane_quantity *x = mechanism->quantity + mechanism->elements.term[term].quantity,
            *y = mechanism->quantity + mechanism->elements.term[next].quantity;
        revolutes->between[revolutes->count] = (zd_revolute_bodies){x->first, x->second, row};
        revolutes->points[revolutes->count] = (zd_points){{x->point1[0], x->point1[1]}, {x->point2[0], x->point2[1]}};
        revolutes->joint[revolutes->count++] = (zd_revolute_joint){
            {x->zero, y->zero}, packed->at[row], packed->at[row + 1] - packed->at[row], packed->near[term], packed->far[term],
            has_angle(mechanism, x->first), has_angle(mechanism, x->second)};
        self->is_known[row] = self->is_known[row + 1] = 1;
        row++;
    }
    zd_revolute_joints_list(revolutes, mechanism->tree.bodies);
    revolutes->are_all = 2 * revolutes->count == mechanism->elements.m && revolutes->count == packed->structure.groups;
    revolutes->have_angles = mechanism->tree.angles == mechanism->tree.bodies;
}

/* Plans the lines of all rows except revolute joints and user functions. */
static void plan_lines(zd_packing *self, const zd_plane *mechanism)
{
    const zd_packed *packed = &self->packed;
    zd_lines *lines = &self->lines;
    self->is_complete = 1;
    for (int row = 0; row < mechanism->elements.m; row++) {
        const zd_relation *one = mechanism->elements.row + row;
        if (self->is_known[row]) continue;
        self->is_known[row] = one->law < 0;
        self->is_complete &= one->law < 0;
        for (int i = one->first; one->law < 0 && i < one->first + one->terms; i++)
            lines->line[lines->count++] = zd_line_of(mechanism, row, i, packed->at[row], packed->near[i], packed->far[i]);
    }
}

static void plan_weight(zd_packing *self, const zd_plane *mechanism)
{
    double *f = self->weight;
    for (const zd_plane_link *link = mechanism->tree.link + 1; link <= mechanism->tree.link + mechanism->tree.bodies; link++) {
        *f++ = link->mass * mechanism->gravity.x;
        *f++ = link->mass * mechanism->gravity.y;
        if (link->hang == ZD_HANGS_FREE) *f++ = 0;
    }
}

static int has_mass(const zd_plane *mechanism, int body)
{
    const zd_plane_link *link = mechanism->tree.link + body;
    return link->mass > 0 && (link->hang != ZD_HANGS_FREE || link->inertia > 0);
}

/* Fills in the description for SIMD lanes, if revolute joints and weight are all there is and all bodies have mass. */
static void plan_pinned(zd_packing *self, const zd_plane *mechanism)
{
    const zd_revolute_joints *revolutes = &self->revolutes;
    const int bodies = mechanism->tree.bodies;
    int is_all = revolutes->are_all && revolutes->count && !mechanism->elements.forces;
    for (int b = 1; b <= bodies; b++) is_all &= has_mass(mechanism, b);
    if (!is_all) return;
    double *numbers = self->numbers;
    for (int b = 1; b <= bodies; b++) {
        const zd_plane_link *link = mechanism->tree.link + b;
        self->at[b] = self->at[b - 1] + self->packed.coordinates[b - 1];
        *numbers++ = 1 / link->mass;
        *numbers++ = link->hang == ZD_HANGS_FREE ? 1 / link->inertia : 0;
    }
    for (int k = 0; k < revolutes->count; k++, numbers += 6) {
        const zd_vector a = revolutes->points[k].first, b = revolutes->points[k].second, zero = revolutes->joint[k].zero;
        self->pin_first[k] = revolutes->between[k].first - 1;
        self->pin_second[k] = revolutes->between[k].second - 1;
        const double of_pin[] = {a.x, a.y, b.x, b.y, zero.x, zero.y};
        memcpy(numbers, of_pin, sizeof of_pin);
    }
    numbers[0] = mechanism->gravity.x;
    numbers[1] = mechanism->gravity.y;
    self->pinned = (zd_pinned){bodies, revolutes->count, self->at, self->pin_first, self->pin_second, self->numbers};
}

static void write_bodies_of(const void *quantities, int quantity, int body[2])
{
    const zd_plane_quantity *of = quantities;
    body[0] = of[quantity].first;
    body[1] = of[quantity].second;
}

int zd_packing_plan(zd_packing *self, const zd_plane *mechanism)
{
    const int bodies = mechanism->tree.bodies;
    for (int b = 0; b < bodies; b++)
        self->packed.coordinates[b] = self->packed.velocities[b] = mechanism->tree.link[b + 1].hang == ZD_HANGS_FREE ? 3 : 2;
    if (zd_packed_plan(&self->packed, &mechanism->elements, bodies, write_bodies_of, mechanism->quantity) >= 0) return 0;
    plan_revolute_joints(self, mechanism);
    plan_lines(self, mechanism);
    plan_weight(self, mechanism);
    plan_pinned(self, mechanism);
    return 1;
}
