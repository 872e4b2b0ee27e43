/* The rows of each point joint are those of point_joints.c: for the velocities of its bodies' mass centres 1 and -1 in the three rows of the
 * point, for their angular velocities the entries in the scratch. So C W C^T has products of three entries instead of six. */
#include "plan.h"

/* ---- A ---- */

/* Half of q times (0, omega) */
ZD_INLINE void turn(const double *q, const double *omega, double *rate)
{
    const double w = q[0] / 2, x = q[1] / 2, y = q[2] / 2, z = q[3] / 2;
    rate[0] = -x * omega[0] - y * omega[1] - z * omega[2];
    rate[1] = w * omega[0] - z * omega[1] + y * omega[2];
    rate[2] = z * omega[0] + w * omega[1] - x * omega[2];
    rate[3] = -y * omega[0] + x * omega[1] + w * omega[2];
}

static void times_A(const void *data, const zd_terms *terms, const double *x, double *restrict y)
{
    const zd_space *self = data;
    zd_space_frame frame;
    zd_space_frame_of(self, terms->scratch, &frame);
    const double *q = frame.quaternion + 4;
    for (const zd_space_planned_body *body = self->body + 1; body <= self->body + self->bodies; body++, q += 4) {
        const double *own = x + body->v;
        double *rate = y + body->p;
        for (int i = 0; i < ZD_POINT_COORDINATES; i++) rate[i] = own[i];
        if (body->turns) turn(q, own + 3, rate + ZD_POINT_COORDINATES);                     /* (1) */
    }
    if (self->unwrapped.count) zd_unwrapped_angles_rate(self, &frame, x, y);
}

const zd_operations zd_space_products = {.times_A = times_A};

/* ---- C: all bodies turn, so that body i has the velocities from 6 (i - 1) on ---- */

enum { N = ZD_BODY_VELOCITIES };

static const double AT_REST[N] = {0};

static const double *velocities_of(const double *x, int body) { return body ? x + N * (body - 1) : AT_REST; }

ZD_INLINE double dot3(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

ZD_INLINE void times_joint(const int rows, const zd_point_joint *joint, const double *first, const double *x, double *y)
{
    const double *a = velocities_of(x, joint->first), *b = velocities_of(x, joint->second), *second = first + 3 * rows;
    for (int i = 0; i < ZD_POINT_CONSTRAINTS; i++) y[i] = b[i] - a[i] + (dot3(second + 3 * i, b + 3) + dot3(first + 3 * i, a + 3));
    for (int i = ZD_POINT_CONSTRAINTS; i < rows; i++) y[i] = dot3(second + 3 * i, b + 3) + dot3(first + 3 * i, a + 3);
}

ZD_INLINE void times_all(const int rows, const zd_point_joints *self, const double *turns, const double *x, double *restrict y)
{
    for (const zd_point_joint *joint = self->joint; joint < self->joint + self->count; joint++) {
        const int own = rows ? rows : joint->rows;
        times_joint(own, joint, turns + joint->turns, x, y + joint->row);
    }
}

/* kernel(rows, ...), with a constant number of rows if all joints have the same */
#define FOR_ROWS(kernel, rows, ...)                 \
    switch (rows) {                                 \
    case 3: kernel(3, __VA_ARGS__); break;          \
    case 4: kernel(4, __VA_ARGS__); break;          \
    case 5: kernel(5, __VA_ARGS__); break;          \
    case 6: kernel(6, __VA_ARGS__); break;          \
    default: kernel(0, __VA_ARGS__);                \
    }

static const double *turns_in(const zd_space *self, const zd_terms *terms)
{
    zd_space_frame frame;
    zd_space_frame_of(self, terms->scratch, &frame);
    return frame.turns;
}

static void times_C(const void *data, const zd_terms *terms, const double *x, double *y)
{
    const zd_space *self = data;
    FOR_ROWS(times_all, self->point_joints.rows, &self->point_joints, turns_in(self, terms), x, y)
}

/* Angular entries of C of a point joint for one of its bodies; `end` is numbered as in zd_point_joints. */
ZD_INLINE const double *turns_of(const int rows, const zd_point_joints *self, const double *turns, int end)
{
    const zd_point_joint *joint = self->joint + (end >> 1);
    return rows ? turns + 3 * rows * end : turns + joint->turns + (end & 1) * 3 * joint->rows;
}

ZD_INLINE int rows_of(const int rows, const zd_point_joints *self, int end) { return rows ? rows : self->joint[end >> 1].rows; }

/* Sign of C for the first and second body of a joint */
static const double SIGN[] = {-1, 1};

/* Body by body, so that nothing is added up in memory. */
ZD_INLINE void subtract_all(const int rows, const zd_space *space, const double *turns, const double *W, const double *restrict y,
                            const int *place, double *restrict x)
{
    const zd_point_joints *self = &space->point_joints;
    const int *end_at = self->end_at, *ends = self->end;
    for (int i = 0, k = end_at[1]; i < space->bodies; i++, W += N, x += N) {
        double force[3] = {0, 0, 0}, torque[3] = {0, 0, 0};
        for (const int last = end_at[i + 2]; k < last; k++) {
            const int end = ends[k], own = rows_of(rows, self, end);
            const double *G = turns_of(rows, self, turns, end), sign = SIGN[end & 1], *of = y + place[self->joint[end >> 1].row];
            for (int c = 0; c < 3; c++) force[c] += sign * of[c];
            for (int r = 0; r < own; r++)
                for (int c = 0; c < 3; c++) torque[c] += G[3 * r + c] * of[r];
        }
        for (int c = 0; c < 3; c++) x[c] -= W[c] * force[c], x[3 + c] -= W[3 + c] * torque[c];
    }
}

static void subtract_weighted(const void *data, const zd_terms *terms, const double *W, const double *y, const int *place, double *x)
{
    const zd_space *self = data;
    FOR_ROWS(subtract_all, self->point_joints.rows, self, turns_in(self, terms), W, y, place, x)
}

/* to (a, b) <- to + A B^T of so many rows of three, and in the first three of each the sign times w; turned: the transpose */
ZD_INLINE void add_product(const int a, const int b, const double *A, const double *B, double sign, const double *w, int turned, double *to)
{
    const int down = turned ? 1 : b, along = turned ? a : 1;
    for (int i = 0; i < a; i++)
        for (int j = 0; j < b; j++) to[i * down + j * along] += dot3(A + 3 * i, B + 3 * j);
    for (int i = 0; i < ZD_POINT_CONSTRAINTS; i++) to[i * (down + along)] += sign * w[i];
}

/* The same of one end with itself, of which the lower triangle is read. */
ZD_INLINE void add_square(const int a, const double *A, const double *B, const double *w, double *to)
{
    for (int i = 0; i < a; i++)
        for (int j = 0; j <= i; j++) to[i * a + j] += dot3(A + 3 * i, B + 3 * j);
    for (int i = 0; i < ZD_POINT_CONSTRAINTS; i++) to[i * (a + 1)] += w[i];
}

ZD_INLINE void add_all(const int rows, const zd_space *space, const double *turns, const double *W, const int *at, double *restrict S)
{
    const zd_point_joints *self = &space->point_joints;
    const int *end_at = self->end_at, *ends = self->end;
    for (int i = 0, k = end_at[1]; i < space->bodies; i++, W += N)
        for (const int first = k, last = end_at[i + 2]; k < last; k++) {
            const int end = ends[k], own = rows_of(rows, self, end);
            const double *G = turns_of(rows, self, turns, end);
            double weighted[3 * ZD_POINT_JOINT_CONSTRAINTS];
            for (int r = 0; r < own; r++)
                for (int c = 0; c < 3; c++) weighted[3 * r + c] = G[3 * r + c] * W[3 + c];
            for (int j = first; j < k; j++, at++) {
                const int other = ends[j], is_turned = *at & 1;
                const double *B = turns_of(rows, self, turns, other), sign = SIGN[!((end ^ other) & 1)];
                if (is_turned) add_product(own, rows_of(rows, self, other), weighted, B, sign, W, 1, S + (*at >> 1));
                else add_product(own, rows_of(rows, self, other), weighted, B, sign, W, 0, S + (*at >> 1));
            }
            add_square(own, weighted, G, W, S + (*at++ >> 1));
        }
}

static void add_weighted(const void *data, const zd_terms *terms, const double *W, const int *at, double *S)
{
    const zd_space *self = data;
    FOR_ROWS(add_all, self->point_joints.rows, self, turns_in(self, terms), W, at, S)
}

const zd_operations zd_point_joint_products = {
    .times_A = times_A, .times_C = times_C, .subtract_weighted = subtract_weighted, .add_weighted = add_weighted};
