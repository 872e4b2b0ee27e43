/* Contacts of a body with a plane or a sphere of another. C is the point that touches; what pulls at C acts on both bodies there.
 *
 * On a plane with the normal o, C is the point of an ellipsoid about Q that is farthest against o: its way from Q has no part in the rate of
 * the clearance. On a sphere about P, with u the direction from P to Q, C = Q - r u with the radius r of a ball about Q, negative inside.
 * Its tangents are t = a x u, of length one, or o x u where a is nearly along u; and u x t. */
#include "contact_quantity.h"

static const double ALONG = 0.8;        /* cosine of a and u from which o is taken */

/* S x in global axes, with S the shape of the ellipsoid */
static zd_vector3 shaped(const zd_space_quantity *quantity, const zd_space_pose *pose, zd_vector3 x)
{
    const zd_rotation *turned = &pose[quantity->second].turned;
    const zd_vector3 own = zd_rotated_back3(turned, x);
    const double S[] = {zd_inner3(zd_vector3_of(quantity->shape[0]), own), zd_inner3(zd_vector3_of(quantity->shape[1]), own),
                        zd_inner3(zd_vector3_of(quantity->shape[2]), own)};
    return zd_rotated3(turned, zd_vector3_of(S));
}

/* From Q to C of an ellipsoid: -S o over its reach, the root of o . S o. That of a point is zero. */
static zd_vector3 way_to_contact(const zd_space_quantity *quantity, const zd_space_pose *pose, zd_vector3 o, double *reach)
{
    const zd_vector3 So = shaped(quantity, pose, o);
    *reach = sqrt(zd_inner3(o, So));
    return zd_times3(*reach > 0 ? -1 / *reach : 0, So);
}

/* ---- spheres ---- */

static int is_around(const zd_space_quantity *quantity)
{
    return quantity->kind == ZD_SPACE_DISTANCE || quantity->kind == ZD_SPACE_ORBIT || quantity->kind == ZD_SPACE_ORBIT_ACROSS;
}

static double radius_of(const zd_space_quantity *quantity) { return quantity->shape[0][0]; }

/* Direction from P to Q, with its rate where `apart` has one. */
static zd_moving outward(zd_moving apart)
{
    const double size = sqrt(zd_inner3(apart.value, apart.value)), inverse = size > 0 ? 1 / size : 0;
    const zd_vector3 u = zd_times3(inverse, apart.value);
    return (zd_moving){.value = u, .rate = zd_times3(inverse, zd_minus3(apart.rate, zd_times3(zd_inner3(u, apart.rate), u)))};
}

/* The tangent of a quantity, with its rate where u, a and o have one. */
static zd_moving tangent(const zd_space_quantity *quantity, zd_moving u, zd_moving a, zd_moving o)
{
    const zd_moving n = fabs(zd_inner3(a.value, u.value)) > ALONG ? o : a;
    const zd_vector3 c = zd_cross3(n.value, u.value), change = zd_plus3(zd_cross3(n.rate, u.value), zd_cross3(n.value, u.rate));
    const double size = sqrt(zd_inner3(c, c)), inverse = size > 0 ? 1 / size : 0;
    const zd_vector3 t = zd_times3(inverse, c), tdot = zd_times3(inverse, zd_minus3(change, zd_times3(zd_inner3(t, change), t)));
    if (quantity->kind == ZD_SPACE_ORBIT) return (zd_moving){.value = t, .rate = tdot};
    return (zd_moving){.value = zd_cross3(u.value, t), .rate = zd_plus3(zd_cross3(u.rate, t), zd_cross3(u.value, tdot))};
}

static zd_moving still(zd_vector3 value) { return (zd_moving){.value = value}; }

/* ---- both ---- */

zd_vector3 zd_space_contact(const zd_space_quantity *quantity, const zd_space_pose *pose)
{
    double reach;
    const zd_vector3 Q = zd_space_point_of(pose + quantity->second, quantity->point2);
    if (is_around(quantity)) {
        const zd_vector3 apart = zd_minus3(Q, zd_space_point_of(pose + quantity->first, quantity->point1));
        return zd_minus3(Q, zd_times3(radius_of(quantity), outward(still(apart)).value));
    }
    return zd_plus3(Q, way_to_contact(quantity, pose, zd_direction_of(pose + quantity->first, quantity->o), &reach));
}

void zd_read_contact(const zd_space_quantity *quantity, const zd_space_pose *pose, zd_vector3 apart, zd_space_reading *to)
{
    double reach;
    const zd_space_pose *first = pose + quantity->first, *second = pose + quantity->second;
    const zd_vector3 a = zd_direction_of(first, quantity->a), o = zd_direction_of(first, quantity->o);
    zd_vector3 way, along = quantity->kind == ZD_SPACE_CLEARANCE ? o : a;
    if (is_around(quantity)) {
        const zd_moving u = outward(still(apart));
        along = tangent(quantity, u, still(a), still(o)).value;
        way = zd_times3(-radius_of(quantity), u.value);
    } else way = way_to_contact(quantity, pose, o, &reach);
    const zd_vector3 arm1 = zd_direction_of(first, quantity->point1), arm2 = zd_direction_of(second, quantity->point2);
    const zd_vector3 to_C = zd_plus3(apart, way);
    to->value = quantity->kind == ZD_SPACE_CLEARANCE ? zd_inner3(o, to_C) : 0;
    to->second = (zd_space_wrench){along, zd_cross3(arm2, along)};
    to->second.torque = zd_plus3(to->second.torque, zd_cross3(way, along));
    to->first = (zd_space_wrench){zd_times3(-1, along), zd_plus3(zd_cross3(along, arm1), zd_cross3(along, to_C))};
}

/* The rate of this way: o turns with the first body, and the ellipsoid with the second. */
static zd_vector3 rate_of_way(const zd_space_quantity *quantity, const zd_space_pose *pose, zd_moving o, zd_vector3 spin)
{
    double reach;
    const zd_vector3 way = way_to_contact(quantity, pose, o.value, &reach);
    const zd_vector3 relative = zd_minus3(o.rate, zd_cross3(spin, o.value));        /* rate of o as seen from the second body */
    const zd_vector3 change = zd_minus3(zd_times3(zd_inner3(way, relative), way), shaped(quantity, pose, relative));
    return zd_plus3(zd_cross3(spin, way), zd_times3(reach > 0 ? 1 / reach : 0, change));
}

double zd_bias_of_contact(const zd_space_quantity *quantity, const zd_space_pose *pose, const zd_space_twist *twist, zd_moving a, zd_moving o,
                          zd_moving apart)
{
    double reach;
    const zd_vector3 first = twist[quantity->first].spin, second = twist[quantity->second].spin;
    zd_moving along = quantity->kind == ZD_SPACE_CLEARANCE ? o : a;
    zd_vector3 way, change;
    if (is_around(quantity)) {
        const zd_moving u = outward(apart);
        along = tangent(quantity, u, a, o);
        way = zd_times3(-radius_of(quantity), u.value), change = zd_times3(-radius_of(quantity), u.rate);
    } else way = way_to_contact(quantity, pose, o.value, &reach), change = rate_of_way(quantity, pose, o, second);
    const zd_vector3 to_C = zd_plus3(apart.value, way), change_of_C = zd_plus3(apart.rate, change);
    const zd_vector3 w = zd_minus3(zd_plus3(apart.rate, zd_cross3(second, way)), zd_cross3(first, to_C));
    const zd_vector3 wdot = zd_minus3(zd_plus3(apart.second, zd_cross3(second, change)), zd_cross3(first, change_of_C));
    return zd_inner3(along.rate, w) + zd_inner3(along.value, wdot);
}
