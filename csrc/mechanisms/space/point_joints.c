/* With u and w the vectors from the mass centres of both bodies to their points, and a and b directions of the first and of the second,
 *
 *     Phi = x2 + w - x1 - u,      C v = v2 + omega2 x w - v1 - omega1 x u,        xi = omega1 x (omega1 x u) - omega2 x (omega2 x w)
 *     Phi = a . b,                C v = (omega2 - omega1) . (b x a),              xi = -a" . b - 2 a' . b' - a . b"      (3), (5), (6)
 *
 * with omega in global axes. In the axes of a body, (omega x w)_k = omega . (w x e_k), where e_k is the k-th global axis in body axes. */
#include "plan.h"

void zd_point_joints_create(zd_point_joints *self, zd_arena *arena, size_t bodies, size_t joints, size_t rows)
{
#define TAKE(member, count) self->member = zd_arena_bytes(arena, (count) * sizeof *self->member)
    TAKE(joint, joints);
    TAKE(points, joints);
    TAKE(directions, joints);
    TAKE(entries, joints);
    TAKE(has_row, rows);
    TAKE(end_at, bodies + 2);
    TAKE(end, 2 * joints);
#undef TAKE
}

/* ---- search ---- */

static const zd_space_quantity *quantity_of_row(const zd_space *space,
                                          int row) { return space->quantity + space->elements.term[space->elements.row[row].first].quantity; }

static int is_of_joint(const zd_space *space, int row, int joint)
{
    return row < space->elements.mh && space->elements.owner_of_constraint[row].owner == ZD_OF_JOINT
        && space->elements.owner_of_constraint[row].index == joint;
}

/* Number of rows of the point joint that begins at `row`; 0 if there is none. */
static int count_rows(const zd_space *space, int row)
{
    const int joint = space->elements.owner_of_constraint[row].index;
    int rows = 0;
    while (row + rows < space->elements.m && is_of_joint(space, row + rows, joint)) rows++;
    if (rows < ZD_POINT_CONSTRAINTS || rows > ZD_POINT_JOINT_CONSTRAINTS) return 0;
    for (int k = 0; k < rows; k++) {
        const int kind = k < ZD_POINT_CONSTRAINTS ? ZD_SPACE_X + k : ZD_SPACE_COSINE;
        if (quantity_of_row(space, row + k)->kind != kind || quantity_of_row(space, row + k)->zero != 0) return 0;
    }
    return rows;
}

static void add_socket(zd_point_joints *self, const zd_space *space, int row, int rows)
{
    const zd_space_quantity *point = quantity_of_row(space, row);
    const int term = space->elements.row[row].first, k = self->count++;
    self->joint[k] = (zd_point_joint){point->first, point->second, rows, row, self->turns};
    self->points[k] = (zd_point_joint_points){zd_vector3_of(point->point1), zd_vector3_of(point->point2)};
    self->entries[k] = (zd_point_joint_entries){
        .C = space->packed.at[row], .width = space->packed.at[row + 1] - space->packed.at[row],
        .near = space->packed.near[term], .far = space->packed.far[term],
        .near_turns = space->body[point->first].turns, .far_turns = space->body[point->second].turns};
    for (int i = 0; i < rows - ZD_POINT_CONSTRAINTS; i++) {
        const zd_space_quantity *quantity = quantity_of_row(space, row + ZD_POINT_CONSTRAINTS + i);
        self->directions[k].a[i] = zd_vector3_of(quantity->a);
        self->directions[k].b[i] = zd_vector3_of(quantity->b);
    }
    self->turns += 2 * 3 * rows;
    self->rows = k == 0 || self->rows == rows ? rows : 0;
}

static int do_all_turn(const zd_space *space)
{
    for (int i = 1; i <= space->bodies; i++)
        if (!space->body[i].turns) return 0;
    return 1;
}

void zd_point_joints_plan(zd_point_joints *self, const zd_space *space)
{
    int of_sockets = 0;
    for (int row = 0, rows; row < space->elements.mh; row += rows ? rows : 1) {
        rows = count_rows(space, row);
        if (!rows) continue;
        add_socket(self, space, row, rows);
        for (int i = 0; i < rows; i++) self->has_row[row + i] = 1;
        of_sockets += rows;
    }
    zd_list_ends(self->count, self->joint, sizeof *self->joint, space->bodies, self->end_at, self->end);
    self->are_all = of_sockets == space->elements.m && do_all_turn(space);
}

/* ---- where the points are ---- */

ZD_INLINE void keep(double sign, zd_vector3 a, double *to) { to[0] = sign * a.x, to[1] = sign * a.y, to[2] = sign * a.z; }

/* sign times point x e_k, for each global axis e_k */
ZD_INLINE void turn_point(double sign, const zd_rotation *R, zd_vector3 point, double *to)
{
    keep(sign, zd_cross3(point, (zd_vector3){R->x.x, R->y.x, R->z.x}), to);
    keep(sign, zd_cross3(point, (zd_vector3){R->x.y, R->y.y, R->z.y}), to + 3);
    keep(sign, zd_cross3(point, (zd_vector3){R->x.z, R->y.z, R->z.z}), to + 6);
}

void zd_point_joints_turn(const zd_point_joints *self, const zd_space_frame *frame)
{
    for (int k = 0; k < self->count; k++) {
        const zd_point_joint *joint = self->joint + k;
        const zd_rotation *R1 = &frame->pose[joint->first].turned, *R2 = &frame->pose[joint->second].turned;
        const int rows = joint->rows;
        double *first = frame->turns + joint->turns, *second = first + 3 * rows;
        const zd_point_joint_points *points = self->points + k;
        frame->arms[k] = (zd_arms){zd_rotated3(R1, points->first), zd_rotated3(R2, points->second)};
        turn_point(-1, R1, points->first, first);
        turn_point(1, R2, points->second, second);
        for (int i = 0; i < rows - ZD_POINT_CONSTRAINTS; i++) {
            const zd_directions *own = self->directions + k;
            zd_directions *now = frame->directions + k;
            now->a[i] = zd_rotated3(R1, own->a[i]);
            now->b[i] = zd_rotated3(R2, own->b[i]);
            const zd_vector3 torque = zd_cross3(now->b[i], now->a[i]);
            keep(-1, zd_rotated_back3(R1, torque), first + 3 * (ZD_POINT_CONSTRAINTS + i));
            keep(1, zd_rotated_back3(R2, torque), second + 3 * (ZD_POINT_CONSTRAINTS + i));
        }
    }
}

/* ---- terms ---- */

static void write_Phi(const zd_point_joints *self, const zd_space_frame *frame, double *Phi)
{
    for (int k = 0; k < self->count; k++) {
        const zd_point_joint *joint = self->joint + k;
        const zd_arms *arms = frame->arms + k;
        const zd_directions *now = frame->directions + k;
        const zd_vector3 Q = zd_plus3(frame->pose[joint->second].at, arms->second), P = zd_plus3(frame->pose[joint->first].at, arms->first);
        double *own = Phi + joint->row;
        keep(1, zd_minus3(Q, P), own);
        for (int i = 0; i < joint->rows - ZD_POINT_CONSTRAINTS; i++) own[ZD_POINT_CONSTRAINTS + i] = zd_inner3(now->a[i], now->b[i]);
    }
}

/* omega x (omega x a) */
ZD_INLINE zd_vector3 turned_twice(zd_vector3 spin, zd_vector3 a) { return zd_cross3(spin, zd_cross3(spin, a)); }

static double bias_of_directions(zd_vector3 spin1, zd_vector3 spin2, zd_vector3 a, zd_vector3 b)
{
    const zd_vector3 rate_of_a = zd_cross3(spin1, a), rate_of_b = zd_cross3(spin2, b);
    return zd_inner3(zd_cross3(spin1, rate_of_a), b) + 2 * zd_inner3(rate_of_a, rate_of_b) + zd_inner3(a, zd_cross3(spin2, rate_of_b));
}

static void write_xi(const zd_point_joints *self, const zd_space_frame *frame, double *xi)
{
    for (int k = 0; k < self->count; k++) {
        const zd_point_joint *joint = self->joint + k;
        const zd_arms *arms = frame->arms + k;
        const zd_directions *now = frame->directions + k;
        const zd_vector3 spin1 = frame->twist[joint->first].spin, spin2 = frame->twist[joint->second].spin;
        double *own = xi + joint->row;
        keep(1, zd_minus3(turned_twice(spin1, arms->first), turned_twice(spin2, arms->second)), own);
        for (int i = 0; i < joint->rows - ZD_POINT_CONSTRAINTS; i++)
            own[ZD_POINT_CONSTRAINTS + i] = -bias_of_directions(spin1, spin2, now->a[i], now->b[i]);
    }
}

/* The rows of one body; what is not written is zero already. */
static void write_body(int rows, int width, double sign, const double *turns, int has_turns, double *C)
{
    for (int i = 0; i < rows; i++, C += width, turns += 3) {
        if (i < ZD_POINT_CONSTRAINTS) C[i] = sign;
        for (int j = 0; has_turns && j < 3; j++) C[3 + j] = turns[j];
    }
}

static void write_C(const zd_point_joints *self, const zd_space_frame *frame, double *C)
{
    for (int k = 0; k < self->count; k++) {
        const int rows = self->joint[k].rows;
        const zd_point_joint_entries *at = self->entries + k;
        const double *first = frame->turns + self->joint[k].turns, *second = first + 3 * rows;
        if (at->near >= 0) write_body(rows, at->width, -1, first, at->near_turns, C + at->C + at->near);
        if (at->far >= 0) write_body(rows, at->width, 1, second, at->far_turns, C + at->C + at->far);
    }
}

void zd_point_joints_write(const zd_point_joints *self, const zd_space_frame *frame, int want, const zd_terms *out)
{
    if (want & ZD_PHI) write_Phi(self, frame, out->Phi);
    if (want & ZD_C) write_C(self, frame, out->C);
    if (want & ZD_XI) write_xi(self, frame, out->xi);
    for (int k = 0; (want & ZD_PHI_T) && k < self->count; k++)
        for (int i = 0; i < self->joint[k].rows; i++) out->Phi_t[self->joint[k].row + i] = 0;
}
