/* From tables to a mechanism: bodies are renumbered so that inner ones come first, and joints outside the tree become rows. */
#include <stdio.h>

#include "../../../include/zerodrift/sines.h"
#include "../../../workspace.h"
#include "../plan.h"
#include "../structure/packing.h"
#include "../tables.h"
#include "system.h"

/* Arrays that are filled during creation, and constant afterwards. */
typedef struct parts {
    int *number, *angle;
    zd_plane_link *link;
    zd_plane_joint *joint;
    zd_plane_planned_joint *planned;
    zd_plane_quantity *quantity;
    zd_plane_coordinate_owner *coordinate;
    int *lengths;
    zd_packing *packing;
    zd_hinged hinged;
    zd_element_parts elements;
    int quantities, angles;     /* so many are there by now */
} parts;

/* ---- memory ---- */

static int has_tree(const zd_plane_tables *tables)
{
    for (int i = 0; i < tables->bodies; i++)
        if (tables->body[i].inboard >= 0) return 1;
    return 0;
}

/* Maximum number of rows: joints outside the tree, and relations. */
static size_t max_rank(const zd_plane_tables *tables)
{
    int joints = tables->joints;
    for (int i = 0; i < tables->bodies; i++) joints -= tables->body[i].inboard >= 0;
    return (size_t)(joints > 0 ? joints : 0) * ZD_JOINT_ROWS + (size_t)tables->elements.relations;
}

/* Maximum number of lines: marker quantities of rows that are not of revolute joints, which have x and y of the same points. */
static size_t max_lines(const zd_plane_tables *tables)
{
    size_t lines = tables->elements.terms;
    for (int j = 0; j < tables->joints; j++) {
        const zd_plane_joint_kind *kind = zd_plane_joint_kind_of(tables->joint[j].kind);
        for (const zd_plane_joint_row *row = kind->row; row < kind->row + kind->rows; row++)
            lines += (row->quantity != ZD_PLANE_X && row->quantity != ZD_PLANE_Y) + (row->rolls != 0);
    }
    return has_tree(tables) ? 0 : lines;
}

static void create_parts(const zd_plane_tables *tables, zd_arena *arena, parts *to)
{
    size_t bodies = tables->bodies, joints = tables->joints;
    size_t extra = joints * (ZD_JOINT_ROWS + 1), rows = joints * ZD_JOINT_ROWS;
#define TAKE(member, count) to->member = zd_arena_bytes(arena, (count) * sizeof *to->member)
    TAKE(number, bodies + 1);
    TAKE(link, bodies + 1);
    TAKE(angle, bodies);
    TAKE(joint, joints);
    TAKE(planned, joints);
    TAKE(quantity, (size_t)tables->quantities + extra);
    TAKE(coordinate, 3 * bodies);
    TAKE(lengths, 6 * bodies);
    TAKE(packing, 1);
#undef TAKE
    zd_elements_create(&to->elements, arena, &tables->elements, extra, rows);
    zd_packing none = {.weight = NULL};
    zd_hinged_create(&to->hinged, arena, has_tree(tables) ? bodies : 0, max_rank(tables));
    zd_packing_create(to->packing ? to->packing : &none, arena, bodies, rows + (size_t)tables->elements.relations,
                    (size_t)tables->elements.terms + extra,
                    max_lines(tables));
}

/* ---- the tree ---- */

static int inner_of(const zd_plane_tables *tables, int body)
{
    int inboard = tables->body[body - 1].inboard;
    if (inboard < 0) return 0;
    const zd_plane_joint *joint = tables->joint + inboard;
    return joint->first == body ? joint->second : joint->first;
}

/* Numbers bodies so that parents come before children. Returns 0 if not all of them are connected to the ground by the tree. */
static int number_bodies(const zd_plane_tables *tables, int *number)
{
    int numbered = 0, before = -1;
    while (numbered > before) {
        before = numbered;
        for (int body = 1; body <= tables->bodies; body++) {
            int inner = inner_of(tables, body);
            if (!number[body] && (inner == 0 || number[inner])) number[body] = ++numbered;
        }
    }
    return numbered == tables->bodies;
}

static zd_vector vector_of(const double *x) { return (zd_vector){x[0], x[1]}; }

/* Connection of a body to its parent by its inboard joint, of which it is the second body, or the first if `is_second` is 0. */
static zd_plane_link hang_on(const zd_plane_joint *joint, const zd_plane_body *body, int is_second)
{
    static const enum zd_plane_hang hang[] = {[ZD_TURNS] = ZD_HANGS_TURNING, [ZD_SLIDES] = ZD_HANGS_SLIDING, [ZD_FIXED] = ZD_HANGS_FIXED};
    const zd_plane_joint_kind *kind = zd_plane_joint_kind_of(joint->kind);
    double angle = is_second ? joint->angle : -joint->angle, sign = is_second ? 1 : -1;
    double cosine = zd_cos(angle), sine = zd_sin(angle);
    zd_plane_link link = {
        .hang = body->is_particle ? ZD_HANGS_PINNED : hang[kind->inboard],
        .near = vector_of(is_second ? joint->point1 : joint->point2),
        .far = zd_times(-1, vector_of(is_second ? joint->point2 : joint->point1)),
        .angle = angle, .cosine = cosine, .sine = sine,
    };
    if (kind->inboard != ZD_SLIDES) return link;
    zd_vector axis = zd_times(sign, vector_of(joint->axis));
    link.axis = is_second ? axis : zd_rotated(cosine, sine, axis);
    link.along = joint->along;
    link.near = zd_plus(link.near, zd_turned(joint->across, link.axis));
    return link;
}

static int coordinates_of(enum zd_plane_hang hang)
{
    static const int count[] = {[ZD_HANGS_FREE] = 3, [ZD_HANGS_FREE_POINT] = 2, [ZD_HANGS_TURNING] = 1, [ZD_HANGS_SLIDING] = 1};
    return hang <= ZD_HANGS_SLIDING ? count[hang] : 0;
}

static void name_coordinates(const zd_plane_link *link, int body, zd_plane_coordinate_owner *to)
{
    enum zd_plane_coordinate_kind first = link->hang == ZD_HANGS_TURNING   ? ZD_COORDINATE_ANGLE
                                    : link->hang == ZD_HANGS_SLIDING ? ZD_COORDINATE_DISPLACEMENT
                                                                     : ZD_COORDINATE_X;
    for (int i = 0; i < coordinates_of(link->hang); i++) to[i] = (zd_plane_coordinate_owner){body, first + (unsigned)i};
}

/* Links, in the tree's order; coordinates, in that of the bodies as given. Returns how many coordinates there are. */
static int plan_tree(const zd_plane_tables *tables, parts *to)
{
    int coordinates = 0;
    for (int body = 1; body <= tables->bodies; body++) {
        const zd_plane_body *given = tables->body + body - 1;
        zd_plane_link link = {.hang = given->is_particle ? ZD_HANGS_FREE_POINT : ZD_HANGS_FREE};
        if (given->inboard >= 0) link = hang_on(tables->joint + given->inboard, given, tables->joint[given->inboard].second == body);
        link.inner = to->number[inner_of(tables, body)];
        link.coordinate = coordinates;
        link.mass = link.carried = given->mass;
        link.inertia = given->inertia;
        name_coordinates(&link, body, to->coordinate + coordinates);
        coordinates += coordinates_of(link.hang);
        to->link[to->number[body]] = link;
    }
    for (int i = 1; i <= tables->bodies; i++) {
        int hang = (int)to->link[i].hang, angle = to->link[i].coordinate + (hang == ZD_HANGS_FREE ? 2 : 0);
        if (hang == ZD_HANGS_FREE || hang == ZD_HANGS_TURNING) to->angle[to->angles++] = angle;
    }
    for (int i = tables->bodies; i; i--) to->link[to->link[i].inner].carried += to->link[i].carried;
    for (int i = 0; i < coordinates; i++)
        to->lengths[i] = to->lengths[coordinates + i] = to->coordinate[i].kind != ZD_COORDINATE_ANGLE;
    return coordinates;
}

/* ---- joints, marker quantities, relations ---- */

static void plan_joints(const zd_plane_tables *tables, parts *to)
{
    for (int i = 0; i < tables->joints; i++) {
        to->joint[i] = tables->joint[i];
        to->joint[i].first = to->number[tables->joint[i].first];
        to->joint[i].second = to->number[tables->joint[i].second];
    }
    for (int body = 1; body <= tables->bodies; body++) {
        int inboard = tables->body[body - 1].inboard;
        if (inboard < 0) continue;
        to->planned[inboard].carried = to->number[body];
        to->planned[inboard].sign = tables->joint[inboard].second == body ? 1 : -1;
    }
}

static void copy_quantities(const zd_plane_tables *tables, parts *to)
{
    for (int i = 0; i < tables->quantities; i++) {
        to->quantity[i] = tables->quantity[i];
        to->quantity[i].first = to->number[tables->quantity[i].first];
        to->quantity[i].second = to->number[tables->quantity[i].second];
    }
    to->quantities = tables->quantities;
}

static double zero_of(const zd_plane_joint *joint, enum zd_zero zero)
{
    switch (zero) {
    case ZD_ZERO_ALONG: return joint->along;
    case ZD_ZERO_ACROSS: return joint->across;
    case ZD_ZERO_ANGLE: return joint->angle;
    case ZD_ZERO_LENGTH: return joint->length;
    default: return 0;
    }
}

static void add_term(const zd_plane_joint *joint, int kind, enum zd_zero zero, double coefficient, parts *to)
{
    to->quantity[to->quantities] = (zd_plane_quantity){
        kind, joint->first, joint->second, {joint->point1[0], joint->point1[1]}, {joint->point2[0], joint->point2[1]},
        {joint->axis[0], joint->axis[1]}, zero_of(joint, zero)};
    zd_elements_add_term(&to->elements, to->quantities++, coefficient);
}

/* Adds a constraint of a joint; a rolling one also contains its angle times the radius. */
static void add_joint_row(parts *to, int j, int component)
{
    const zd_plane_joint *joint = to->joint + j;
    const zd_plane_joint_row *row = zd_plane_joint_kind_of(joint->kind)->row + component;
    const int first = to->elements.terms;
    add_term(joint, (int)row->quantity, row->zero, 1, to);
    if (row->rolls) add_term(joint, ZD_PLANE_ANGLE, ZD_ZERO_ANGLE, joint->length, to);
    to->planned[j].rows[to->planned[j].row_count++] = to->elements.rows;
    zd_elements_add_joint_row(&to->elements, first, row->nonholonomic, j, component);
}

#define MECHANISM zd_plane
#define OF(name) zd_plane_##name

#include "../../common/create_of_dimension.h"

/* ---- the system ---- */

static int terms_of(const zd_plane_tables *tables, const zd_plane *self, int is_tree)
{
    const int has_gravity = self->gravity.x != 0 || self->gravity.y != 0;
    int terms = ZD_M | ZD_POTENTIAL | zd_elements_terms(&tables->elements, &self->elements);
    if (is_tree) terms |= ZD_BIAS;
    if (has_gravity || self->elements.forces) terms |= ZD_FORCE;
    return terms;
}

static void make_system(const zd_plane_tables *tables, const parts *from, int coordinates, zd_plane *self)
{
    self->system = (zd_system){
        .nq = coordinates, .nv = coordinates, .mh = self->elements.mh, .mn = self->elements.m - self->elements.mh,
        .provides = terms_of(tables, self, has_tree(tables)),
        .evaluate = zd_plane_evaluate,
        .check_domain = tables->elements.law ? zd_plane_check_domain : NULL,
        .data = self,
        .lengths = from->lengths,
        .length = zd_plane_tables_length(tables),
        .failure = "a user function of the mechanism failed",
        .measures = &self->measures,
        .structure = self->packing ? &self->packing->packed.structure : NULL,
        .operations = self->packing && self->packing->revolutes.are_all ? &zd_plane_products : NULL,
        .magnitudes = has_tree(tables) ? zd_plane_magnitudes : NULL,
        .force_magnitudes = zd_plane_force_magnitudes,
    };
    zd_elements_set_groups(&tables->elements, &from->elements, &self->system);
    self->measures = zd_plane_measures(self, from->elements.measure);
    zd_plane_frame_divide(self);
    self->system.magnitudes_scratch = self->system.scratch;
    self->elements.reading.evaluate = zd_plane_read;
    if (self->elements.reading.count) self->system.reading = &self->elements.reading;
}

static void plan(const zd_plane_tables *tables, parts *all, zd_plane *self)
{
    int coordinates = plan_tree(tables, all);
    plan_joints(tables, all);
    copy_quantities(tables, all);
    zd_elements_copy(&tables->elements, &all->elements);
    plan_constraints(tables, 0, all);
    const int mh = all->elements.rows;
    plan_constraints(tables, 1, all);
    *self = (zd_plane){
        .gravity = {tables->gravity[0], tables->gravity[1]},
        .tree = {tables->bodies, coordinates, all->link, all->angles, all->angle},
        .joints = tables->joints, .elements = zd_elements_plan(&tables->elements, &all->elements, mh),
        .number = all->number, .joint = all->joint, .planned = all->planned, .quantity = all->quantity,
        .coordinate = all->coordinate,
    };
    self->measures.count = tables->elements.measures;
    if (!has_tree(tables) && zd_packing_plan(all->packing, self)) self->packing = all->packing;
    self->revolutes = self->packing ? self->packing->revolutes.count : 0;
    self->lines = self->packing ? self->packing->lines.count : 0;
    zd_hinged_plan(&all->hinged, &self->tree, &self->elements, self->quantity);
    self->hinged = all->hinged;
    make_system(tables, all, coordinates, self);
}

zd_plane *zd_plane_create(const zd_plane_tables *tables, char *message, int message_size)
{
    if (!zd_plane_tables_are_right(tables, message, message_size)) return NULL;
    zd_arena arena = {0};
    parts all = {.quantities = 0};
    zd_arena_bytes(&arena, sizeof(zd_plane));
    create_parts(tables, &arena, &all);
    if (!zd_arena_allocate(&arena)) {
        snprintf(message, message_size, "there is no memory for the mechanism");
        return NULL;
    }
    zd_plane *self = zd_arena_bytes(&arena, sizeof *self);
    create_parts(tables, &arena, &all);
    if (!number_bodies(tables, all.number)) {
        snprintf(message, message_size, "the tree of inboard joints must have no loop");
        zd_release(self);
        return NULL;
    }
    plan(tables, &all, self);
    return self;
}

void zd_plane_free(zd_plane *mechanism)
{
    zd_release(mechanism);
}

const zd_plane_coordinate_owner *zd_plane_coordinates(const zd_plane *mechanism) { return mechanism->coordinate; }

zd_plane_plan zd_plane_planned(const zd_plane *mechanism)
{
    return (zd_plane_plan){mechanism->tree.link, mechanism->quantity, mechanism->elements.term, mechanism->elements.row,
                           mechanism->elements.force};
}
