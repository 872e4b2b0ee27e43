/* The kinds of marker quantities. Each is a component of Q - P along a direction, its length, or an angle; the direction is a global axis, or
 * rotates with the first body. */
#include "tree.h"

typedef struct direction {
    zd_vector unit;
    int turns;              /* with the first body */
} direction;

static zd_vector arm_of(const zd_plane_pose *pose, const double *point)
{
    return zd_rotated(pose->cosine, pose->sine, (zd_vector){point[0], point[1]});
}

zd_vector zd_point_of(const zd_plane_pose *pose, const double *point)
{
    return zd_plus(pose->at, arm_of(pose, point));
}

static direction direction_of(const zd_plane_quantity *quantity, const zd_plane_pose *first)
{
    zd_vector axis = {quantity->axis[0], quantity->axis[1]};
    switch (quantity->kind) {
    case ZD_PLANE_X: return (direction){{1, 0}, 0};
    case ZD_PLANE_Y: return (direction){{0, 1}, 0};
    case ZD_PLANE_SHEAR: return (direction){axis, 0};
    case ZD_PLANE_ACROSS:
    case ZD_PLANE_SKID: axis = zd_turned(1, axis);      /* fall through */
    default: return (direction){zd_rotated(first->cosine, first->sine, axis), 1};
    }
}

static int is_angle(const zd_plane_quantity *quantity) { return quantity->kind == ZD_PLANE_ANGLE; }
static int is_distance(const zd_plane_quantity *quantity) { return quantity->kind == ZD_PLANE_DISTANCE; }
static int is_orbit(const zd_plane_quantity *quantity) { return quantity->kind == ZD_PLANE_ORBIT; }
/* True of velocities relative to the first body at Q. */
static int is_relative(const zd_plane_quantity *quantity) { return quantity->kind == ZD_PLANE_SHEAR || is_orbit(quantity); }
/* e of an orbit: perpendicular to Q - P, so that this is e turned by a quarter turn. */
static zd_vector around(zd_vector apart)
{
    const double length = sqrt(zd_inner(apart, apart));
    return zd_turned(length > 0 ? -1 / length : 0, apart);
}

static int is_of_second_alone(const zd_plane_quantity *quantity)
{
    return quantity->kind == ZD_PLANE_GLIDE || quantity->kind == ZD_PLANE_SKID;
}

zd_plane_reading zd_plane_quantity_read(const zd_plane_quantity *quantity, const zd_plane_pose *pose)
{
    const zd_plane_pose *first = pose + quantity->first, *second = pose + quantity->second;
    if (is_angle(quantity))
        return (zd_plane_reading){second->angle - first->angle - quantity->zero, {.torque = -1}, {.torque = 1}};
    zd_vector arm1 = arm_of(first, quantity->point1), arm2 = arm_of(second, quantity->point2);
    if (is_of_second_alone(quantity)) {
        zd_vector unit = direction_of(quantity, first).unit;
        return (zd_plane_reading){.second = {unit, zd_cross(arm2, unit)}};
    }
    zd_vector apart = zd_minus(zd_plus(second->at, arm2), zd_plus(first->at, arm1));
    double length = is_distance(quantity) ? sqrt(zd_inner(apart, apart)) : 0;
    /* Coincident points have no direction: a force along their distance is zero there, as that of a spring without free length is. */
    direction along = is_distance(quantity) ? (direction){zd_times(length > 0 ? 1 / length : 0, apart), 0}
                      : is_orbit(quantity)  ? (direction){around(apart), 0}
                                            : direction_of(quantity, first);
    /* moment arm of the opposite force, from the first mass centre */
    zd_vector on_first = along.turns || is_relative(quantity) ? zd_plus(arm1, apart) : arm1;
    return (zd_plane_reading){
        .value = is_relative(quantity) ? 0 : (is_distance(quantity) ? length : zd_inner(along.unit, apart)) - quantity->zero,
        .first = {zd_times(-1, along.unit), -zd_cross(on_first, along.unit)},
        .second = {along.unit, zd_cross(arm2, along.unit)},
    };
}

static zd_vector speed_of(const zd_plane_twist *twist, zd_vector arm) { return zd_plus(twist->speed, zd_turned(twist->turn, arm)); }

static zd_vector bias_of(const zd_plane_twist *twist, zd_vector arm)
{
    return zd_minus(twist->bias, zd_times(twist->turn * twist->turn, arm));
}

/* d/dt of e . v, with e turning at `turn`, and for what is read off the first body itself of (turn x e) . apart as well */
double zd_plane_quantity_rate(const zd_plane_quantity *quantity, const zd_plane_pose *pose, const zd_plane_twist *twist, double *bias)
{
    const zd_plane_pose *first = pose + quantity->first, *second = pose + quantity->second;
    const zd_plane_twist *twist1 = twist + quantity->first, *twist2 = twist + quantity->second;
    *bias = 0;
    if (is_angle(quantity)) return twist2->turn - twist1->turn;
    zd_vector arm1 = arm_of(first, quantity->point1), arm2 = arm_of(second, quantity->point2);
    zd_vector speed = speed_of(twist2, arm2), change = bias_of(twist2, arm2);
    if (is_of_second_alone(quantity)) {
        zd_vector unit = direction_of(quantity, first).unit;
        *bias = zd_inner(unit, change) + zd_inner(zd_turned(twist1->turn, unit), speed);
        return zd_inner(unit, speed);
    }
    zd_vector apart = zd_minus(zd_plus(second->at, arm2), zd_plus(first->at, arm1));
    if (is_relative(quantity)) {
        zd_vector unit = is_orbit(quantity) ? around(apart) : direction_of(quantity, first).unit;
        zd_vector relative = zd_minus(speed, speed_of(twist1, zd_plus(arm1, apart)));
        *bias = zd_inner(unit, zd_minus(change, zd_plus(twist1->bias, zd_turned(twist1->turn, zd_minus(speed, twist1->speed)))));
        /* e turns with Q - P, at -e . (velocity of Q minus that of P) / |Q - P| */
        if (is_orbit(quantity) && (unit.x != 0 || unit.y != 0))
            *bias -= zd_inner(unit, zd_minus(speed, speed_of(twist1, arm1))) * zd_inner(apart, relative) / zd_inner(apart, apart);
        return zd_inner(unit, relative);
    }
    speed = zd_minus(speed, speed_of(twist1, arm1));
    change = zd_minus(change, bias_of(twist1, arm1));
    if (is_distance(quantity)) {
        double length = sqrt(zd_inner(apart, apart));
        if (!(length > 0)) return 0;
        double across = zd_cross(apart, speed) / length;
        *bias = (zd_inner(apart, change) + across * across) / length;
        return zd_inner(apart, speed) / length;
    }
    direction along = direction_of(quantity, first);
    double turn = along.turns ? twist1->turn : 0;
    zd_vector quarter = zd_turned(turn, along.unit);
    *bias = zd_inner(along.unit, change) + 2 * zd_inner(quarter, speed) - turn * turn * zd_inner(along.unit, apart);
    return zd_inner(along.unit, speed) + zd_inner(quarter, apart);
}
