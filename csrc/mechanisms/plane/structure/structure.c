/* Storage of free bodies, and the constraint rows that are revolute joints. */
#include "packing.h"

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
    zd_list_ends(revolutes->count, revolutes->between, sizeof *revolutes->between, mechanism->tree.bodies, revolutes->end_at, revolutes->end);
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
    return 1;
}
