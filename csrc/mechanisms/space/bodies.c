/* The attitude of a body is a unit quaternion q = (w, x, y, z), whose rate is half of q times its angular velocity in its own axes. */
#include "bodies.h"

#include "../../linalg/small.h"

zd_rotation zd_rotation_of(const double *q)
{
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double ww = w * w, xx = x * x, yy = y * y, zz = z * z, size = 1 / (ww + xx + yy + zz), twice = 2 * size;
    const double xy = x * y, xz = x * z, yz = y * z, wx = w * x, wy = w * y, wz = w * z;
    return (zd_rotation){
        {size * (ww + xx - yy - zz), twice * (xy + wz), twice * (xz - wy)},
        {twice * (xy - wz), size * (ww - xx + yy - zz), twice * (yz + wx)},
        {twice * (xz + wy), twice * (yz - wx), size * (ww - xx - yy + zz)},
    };
}

static const zd_rotation AS_DRAWN = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

void zd_bodies_place(int bodies, const zd_space_planned_body *body, const double *p, zd_space_pose *pose, double *quaternion)
{
    pose[0] = (zd_space_pose){{0, 0, 0}, AS_DRAWN};
    for (int i = 1; i <= bodies; i++) {
        const double *own = p + body[i].p;
        pose[i].at = zd_vector3_of(own);
        pose[i].turned = AS_DRAWN;
        if (!body[i].turns) continue;
        pose[i].turned = zd_rotation_of(own + 3);
        for (int k = 0; k < 4; k++) quaternion[4 * i + k] = own[3 + k];
    }
}

void zd_bodies_move(int bodies, const zd_space_planned_body *body, const zd_space_pose *pose, const double *v, zd_space_twist *twist)
{
    const zd_vector3 none = {0, 0, 0};
    twist[0] = (zd_space_twist){none, none};
    for (int i = 1; i <= bodies; i++) {
        const double *own = v + body[i].v;
        twist[i].speed = zd_vector3_of(own);
        twist[i].spin = body[i].turns ? zd_rotated3(&pose[i].turned, zd_vector3_of(own + 3)) : none;
    }
}

void zd_write_turns(const double *q, int columns, double *A)
{
    const double w = q[0] / 2, x = q[1] / 2, y = q[2] / 2, z = q[3] / 2;
    const double rows[4][3] = {{-x, -y, -z}, {w, -z, y}, {z, w, -x}, {-y, x, w}};
    for (int i = 0; i < 4; i++, A += columns)
        for (int j = 0; j < 3; j++) A[j] = rows[i][j];
}

void zd_bodies_write_A(int bodies, const zd_space_planned_body *body, const double *p, double *A)
{
    for (int i = 1; i <= bodies; i++) {
        double *own = A + body[i].A;
        const int turns = body[i].turns, width = turns ? ZD_BODY_VELOCITIES : ZD_POINT_COORDINATES;
        zd_clear((turns ? ZD_BODY_COORDINATES : ZD_POINT_COORDINATES) * width, own);
        for (int k = 0; k < 3; k++) own[k * width + k] = 1;
        if (turns) zd_write_turns(p + body[i].p + 3, width, own + 3 * width + 3);
    }
}

void zd_bodies_write_M(int bodies, const zd_space_planned_body *body, double *M)
{
    for (int i = 1; i <= bodies; i++) {
        double *own = M + body[i].M;
        own[0] = own[1] = own[2] = body[i].mass;
        if (body[i].turns) own[3] = body[i].inertia.x, own[4] = body[i].inertia.y, own[5] = body[i].inertia.z;
    }
}

void zd_bodies_write_bias(int bodies, const zd_space_planned_body *body, const double *v, double *d)
{
    for (int i = 1; i <= bodies; i++) {
        double *own = d + body[i].v;
        own[0] = own[1] = own[2] = 0;
        if (!body[i].turns) continue;
        const zd_vector3 spin = zd_vector3_of(v + body[i].v + 3), I = body[i].inertia;
        const zd_vector3 torque = zd_cross3(spin, (zd_vector3){I.x * spin.x, I.y * spin.y, I.z * spin.z});
        own[3] = torque.x, own[4] = torque.y, own[5] = torque.z;
    }
}

void zd_body_act(const zd_space_planned_body *body, const zd_space_pose *pose, double scale, zd_space_wrench what, double *own)
{
    own[0] += scale * what.force.x;
    own[1] += scale * what.force.y;
    own[2] += scale * what.force.z;
    if (!body->turns) return;
    const zd_vector3 torque = zd_rotated_back3(&pose->turned, what.torque);
    own[3] += scale * torque.x;
    own[4] += scale * torque.y;
    own[5] += scale * torque.z;
}

void zd_bodies_gather(int bodies, const zd_space_planned_body *body, const zd_space_pose *pose, const zd_space_wrench *wrench, double *f)
{
    for (int i = 1; i <= bodies; i++) {
        double *own = f + body[i].v;
        for (int k = 0; k < (body[i].turns ? ZD_BODY_VELOCITIES : ZD_POINT_COORDINATES); k++) own[k] = 0;
        zd_body_act(body + i, pose + i, 1, wrench[i], own);
    }
}

zd_vector3 zd_space_point_of(const zd_space_pose *pose, const double *point)
{
    return zd_plus3(pose->at, zd_rotated3(&pose->turned, zd_vector3_of(point)));
}
