/* From tables to a mechanism in space: joints become rows of marker quantities. */
#include <stdio.h>

#include "../plan.h"
#include "../tables.h"
#include "system.h"

/* Arrays that are filled during creation, and constant afterwards. */
typedef struct parts {
    zd_space *self;
    zd_space_planned_body *body;
    zd_space_joint *joint;
    zd_space_planned_joint *planned;
    zd_space_quantity *quantity;
    zd_element_parts elements;
    int *lengths, *quaternion;
    zd_packed packed;
    zd_point_joints point_joints;
    zd_unwrapped_angles unwrapped;
    double *weight;
    int quantities, quaternions, nq, nv;       /* so many are there by now */
} parts;

static void create_parts(const zd_space_tables *tables, zd_arena *arena, parts *to)
{
    const size_t bodies = tables->bodies, joints = tables->joints, extra = joints * (ZD_SPACE_ROWS + 1);
    const size_t rows = joints * ZD_SPACE_ROWS, relations = tables->elements.relations, terms = tables->elements.terms;
#define TAKE(member, count) to->member = zd_arena_bytes(arena, (count) * sizeof *to->member)
    TAKE(self, 1);
    TAKE(body, bodies + 1);
    TAKE(joint, joints);
    TAKE(planned, joints);
    TAKE(quantity, (size_t)tables->quantities + extra);
    TAKE(lengths, (ZD_BODY_COORDINATES + ZD_BODY_VELOCITIES) * bodies + ZD_SPACE_COORDINATES * joints);
    TAKE(quaternion, bodies);
    TAKE(weight, ZD_BODY_VELOCITIES * bodies);
#undef TAKE
    zd_unwrapped_angles_create(&to->unwrapped, arena, joints);
    zd_point_joints_create(&to->point_joints, arena, bodies, joints, rows + relations);
    zd_elements_create(&to->elements, arena, &tables->elements, extra, rows);
    zd_packed_create(&to->packed, arena, bodies, rows + relations, terms + extra);
}

/* ---- bodies ---- */

static void plan_bodies(const zd_space_tables *tables, parts *to)
{
    int A = 0;
    for (int i = 0; i < tables->bodies; i++) {
        const zd_space_body *given = tables->body + i;
        const int turns = !given->is_particle, nv = turns ? ZD_BODY_VELOCITIES : ZD_POINT_COORDINATES;
        to->body[i + 1] = (zd_space_planned_body){given->mass, zd_vector3_of(given->inertia), turns, to->nq, to->nv, A, to->nv};
        if (turns) to->quaternion[to->quaternions++] = to->nq + ZD_POINT_COORDINATES;
        to->nq += turns ? ZD_BODY_COORDINATES : ZD_POINT_COORDINATES;
        to->nv += nv;
        A += (turns ? ZD_BODY_COORDINATES : ZD_POINT_COORDINATES) * nv;
    }
    zd_unwrapped_angles_plan(&to->unwrapped, tables->joints, tables->joint, to->nq);
    to->nq += to->unwrapped.count;
    for (const zd_space_planned_body *body = to->body + 1; body <= to->body + tables->bodies; body++)
        for (int k = 0; k < ZD_POINT_COORDINATES; k++) {
            to->lengths[body->p + k] = to->lengths[to->nq + body->v + k] = 1;
            to->weight[body->v + k] = body->mass * tables->gravity[k];
        }
}

/* ---- joints, marker quantities, relations ---- */

static void copy(const zd_space_tables *tables, parts *to)
{
    for (int i = 0, angles = 0; i < tables->joints; angles += zd_unwrapped_angles_of(tables->joint + i++)) {
        to->joint[i] = tables->joint[i];
        to->planned[i].angles = angles;
    }
    for (int body = 1; body <= tables->bodies; body++) {
        const int inboard = tables->body[body - 1].inboard;
        if (inboard < 0) continue;
        to->planned[inboard].carried = body;
        to->planned[inboard].sign = tables->joint[inboard].second == body ? 1 : -1;
    }
    for (int i = 0; i < tables->quantities; i++) to->quantity[i] = tables->quantity[i];
    zd_elements_copy(&tables->elements, &to->elements);
    to->quantities = tables->quantities;
}

static void add_term(parts *to, zd_space_quantity quantity, double coefficient)
{
    to->quantity[to->quantities] = quantity;
    zd_elements_add_term(&to->elements, to->quantities++, coefficient);
}

/* Adds a constraint of a joint; on a screw the displacement also contains its angle, the first coordinate, times the pitch. */
static void add_joint_row(parts *to, int j, int component)
{
    const zd_space_joint *joint = to->joint + j;
    const zd_space_row *row = zd_space_joint_kind_of(joint->kind)->row + component;
    const int first = to->elements.terms;
    add_term(to, zd_space_picked_quantity(joint, &row->pick), 1);
    if (row->advances) add_term(to, zd_space_coordinate_quantity(joint, 0, to->planned[j].angles), -joint->length);
    to->planned[j].rows[to->planned[j].row_count++] = to->elements.rows;
    zd_elements_add_joint_row(&to->elements, first, row->nonholonomic, j, component);
}

#define MECHANISM zd_space
#define OF(name) zd_space_##name

#include "../../common/create_of_dimension.h"

/* ---- the system ---- */

/* Characteristic length in m: the largest distance from a mass centre to a joint's point, or length of a joint; 1 if there is none. */
static double length_of(const zd_space_tables *tables)
{
    double largest = 0;
    for (const zd_space_joint *joint = tables->joint; joint < tables->joint + tables->joints; joint++) {
        const zd_vector3 point1 = zd_vector3_of(joint->point1), point2 = zd_vector3_of(joint->point2);
        if (joint->first) largest = fmax(largest, sqrt(zd_inner3(point1, point1)));
        if (joint->second) largest = fmax(largest, sqrt(zd_inner3(point2, point2)));
        largest = fmax(largest, fabs(joint->length));
    }
    return largest > 0 ? largest : 1;
}

static void make_system(const zd_space_tables *tables, const parts *from)
{
    zd_space *self = from->self;
    self->system = (zd_system){
        .nq = from->nq, .nv = from->nv, .mh = self->elements.mh, .mn = self->elements.m - self->elements.mh,
        .provides = ZD_A | ZD_M | ZD_BIAS | ZD_POTENTIAL | ZD_FORCE | zd_elements_terms(&tables->elements, &self->elements),
        .force_magnitudes = zd_space_force_magnitudes,
        .evaluate = zd_space_evaluate,
        .check_domain = tables->elements.law ? zd_space_check_domain : NULL,
        .data = self,
        .lengths = from->lengths,
        .length = length_of(tables),
        .failure = "a user function of the mechanism failed",
        .measures = &self->measures,
        .structure = &self->packed.structure,
        .operations = self->point_joints.are_all && self->elements.m ? &zd_point_joint_products : &zd_space_products,
        .quaternions = from->quaternions, .quaternion = from->quaternion,
        .followers = from->unwrapped.count, .follow = from->unwrapped.count ? zd_space_follow : NULL,
    };
    self->measures.count = tables->elements.measures;
    zd_elements_set_groups(&tables->elements, &from->elements, &self->system);
    self->measures = zd_space_measures(self, from->elements.measure);
    zd_space_frame_divide(self);
    self->elements.reading.evaluate = zd_space_read;
    if (self->elements.reading.count) self->system.reading = &self->elements.reading;
}

static void write_bodies_of(const void *quantities, int quantity, int body[2])
{
    const zd_space_quantity *of = quantities;
    body[0] = of[quantity].first;
    body[1] = of[quantity].second;
}

/* Returns -1, or a row that touches the ground alone. */
static int plan(const zd_space_tables *tables, parts *all)
{
    plan_bodies(tables, all);
    copy(tables, all);
    plan_constraints(tables, 0, all);
    const int mh = all->elements.rows;
    plan_constraints(tables, 1, all);
    zd_space *self = all->self;
    *self = (zd_space){
        .gravity = zd_vector3_of(tables->gravity),
        .bodies = tables->bodies, .joints = tables->joints, .elements = zd_elements_plan(&tables->elements, &all->elements, mh),
        .body = all->body, .joint = all->joint, .planned = all->planned, .quantity = all->quantity,
        .weight = all->weight, .unwrapped = all->unwrapped,
    };
    for (int b = 0; b < tables->bodies; b++) {
        const int turns = all->body[b + 1].turns;
        all->packed.coordinates[b] = turns ? ZD_BODY_COORDINATES : ZD_POINT_COORDINATES;
        all->packed.velocities[b] = turns ? ZD_BODY_VELOCITIES : ZD_POINT_COORDINATES;
    }
    const int alone = zd_packed_plan(&all->packed, &self->elements, tables->bodies, write_bodies_of, all->quantity);
    self->packed = all->packed;
    zd_point_joints_plan(&all->point_joints, self);
    self->point_joints = all->point_joints;
    make_system(tables, all);
    return alone;
}

zd_space *zd_space_create(const zd_space_tables *tables, char *message, int message_size)
{
    if (!zd_space_tables_are_right(tables, message, message_size)) return NULL;
    zd_arena arena = {0};
    parts all = {.quantities = 0};
    create_parts(tables, &arena, &all);
    if (!zd_arena_allocate(&arena)) {
        snprintf(message, message_size, "there is no memory for the mechanism");
        return NULL;
    }
    create_parts(tables, &arena, &all);
    const int alone = plan(tables, &all);
    if (alone < 0) return all.self;
    snprintf(message, message_size, "row %d: it must depend on a body, not on the ground alone", alone);
    zd_release(arena.base);
    return NULL;
}

void zd_space_free(zd_space *space)
{
    if (space) zd_release(space->carrying.tree);
    zd_release(space);
}

int zd_space_angles(const zd_space *space, int *place)
{
    if (place) memcpy(place, space->unwrapped.place, space->unwrapped.count * sizeof *place);
    return space->unwrapped.count;
}

zd_space_plan zd_space_planned(const zd_space *space)
{
    return (zd_space_plan){space->quantity, space->elements.term, space->elements.row, space->elements.force};
}
