/* Primitive marker quantities: value, wrenches of a unit force on both bodies, and bias of each.
 *
 * All are made of points and directions that move with bodies; those of contacts are in contact_quantity.c. With omega and the acceleration
 * of mass centres in global axes, a direction a has the rate omega x a and, where no velocity changes, the second rate omega x (omega x a);
 * so has the way from the mass centre to a point. The derivative of omega is there what the turned derivative of its own components is, as
 * omega x omega vanishes.
 */
#include "bodies.h"
#include "contact_quantity.h"

/* Part of the second derivative of a . b without angular accelerations. */
static double bias_of_product(zd_moving a, zd_moving b)
{
    return zd_inner3(a.second, b.value) + 2 * zd_inner3(a.rate, b.rate) + zd_inner3(a.value, b.second);
}

/* ---- values, and what a unit force is ---- */

/* A unit force along u on Q, and its opposite on P. */
static void pull(const zd_space_quantity *quantity, const zd_space_pose *pose, zd_vector3 u, zd_space_reading *to)
{
    to->second = (zd_space_wrench){u, zd_cross3(zd_direction_of(pose + quantity->second, quantity->point2), u)};
    to->first = (zd_space_wrench){zd_times3(-1, u), zd_cross3(u, zd_direction_of(pose + quantity->first, quantity->point1))};
}

/* A torque on the second body, and its opposite on the first. */
static void twist_both(zd_vector3 torque, zd_space_reading *to)
{
    to->second.torque = torque;
    to->first.torque = zd_times3(-1, torque);
}

static void read_place(const zd_space_quantity *quantity, const zd_space_pose *pose, zd_vector3 apart, zd_space_reading *to)
{
    const zd_vector3 u = {quantity->kind == ZD_SPACE_X, quantity->kind == ZD_SPACE_Y, quantity->kind == ZD_SPACE_Z};
    to->value = zd_inner3(u, apart);
    pull(quantity, pose, u, to);
}

/* Displacement along an axis a that turns with the first body: the reaction to the force at Q acts on the first body at Q, too, which the
 * torque a x apart adds. */
static void read_along(const zd_space_quantity *quantity, const zd_space_pose *pose, zd_vector3 a, zd_vector3 apart, zd_space_reading *to)
{
    to->value = zd_inner3(a, apart);
    pull(quantity, pose, a, to);
    to->first.torque = zd_plus3(to->first.torque, zd_cross3(a, apart));
}

/* Coincident points have no direction: a force along their distance is zero there, as that of a spring without free length is. */
static void read_distance(const zd_space_quantity *quantity, const zd_space_pose *pose, zd_vector3 apart, zd_space_reading *to)
{
    to->value = sqrt(zd_inner3(apart, apart));
    pull(quantity, pose, zd_times3(to->value > 0 ? 1 / to->value : 0, apart), to);
}

/* The angle of (a . b, o . b): see enum zd_space_quantity_kind. */
static void read_angle(const zd_space_quantity *quantity, const zd_space_pose *pose, zd_vector3 a, int has_value, zd_space_reading *to)
{
    const zd_vector3 o = zd_direction_of(pose + quantity->first, quantity->o), b = zd_direction_of(pose + quantity->second, quantity->b);
    const double x = zd_inner3(a, b), y = zd_inner3(o, b);
    if (has_value) to->value = atan2(y, x);
    twist_both(zd_times3(1 / (x * x + y * y), zd_cross3(b, zd_minus3(zd_times3(x, o), zd_times3(y, a)))), to);
}

/* The rotation vector in global axes: with u = sin theta times its direction, the axial vector of the rotation that takes axes of the
 * first body to those of the second, theta u / sin theta. */
static zd_vector3 rotation_vector(const zd_space_quantity *quantity, const zd_space_pose *pose)
{
    const zd_rotation *turned = &pose[quantity->first].turned;
    const zd_vector3 axis[] = {turned->x, turned->y, turned->z};
    zd_vector3 u = {0, 0, 0};
    double cosine = -0.5;
    for (int i = 0; i < 3; i++) {
        const zd_vector3 to = zd_direction_of(pose + quantity->second, quantity->shape[i]);
        u = zd_plus3(u, zd_times3(0.5, zd_cross3(axis[i], to)));
        cosine += 0.5 * zd_inner3(axis[i], to);
    }
    const double sine = sqrt(zd_inner3(u, u));
    return zd_times3(sine > 0 ? atan2(sine, cosine) / sine : 1, u);
}

/* c = (1 - theta / 2 cot(theta / 2)) / theta^2, and its slope by theta^2, from square = theta^2. With w the angular velocity of the second
 * body relative to the first, phi' = w - phi x w / 2 + c phi x (phi x w). */
static double rotation_factor(double square, double *slope)
{
    static const double series[] = {1.0 / 12, 1.0 / 720, 1.0 / 30240, 1.0 / 1209600, 1.0 / 47900160, 691.0 / 1307674368000,
                                    1.0 / 74724249600};
    double c = 0;
    *slope = 0;
    if (square < 0.25) {
        for (int k = (int)(sizeof series / sizeof series[0]) - 1; k >= 0; k--) {
            *slope = *slope * square + c;
            c = c * square + series[k];
        }
        return c;
    }
    const double half = sqrt(square) / 2, sine = sin(half), cot = cos(half) / sine;
    c = (1 - half * cot) / square;
    *slope = ((1 / (sine * sine) - cot / half) / 8 - c) / square;
    return c;
}

static void read_rotation(const zd_space_quantity *quantity, const zd_space_pose *pose, zd_vector3 a, zd_space_reading *to)
{
    double slope;
    const zd_vector3 phi = rotation_vector(quantity, pose), across = zd_cross3(phi, a);
    const double c = rotation_factor(zd_inner3(phi, phi), &slope);
    to->value = zd_inner3(a, phi);
    twist_both(zd_plus3(a, zd_plus3(zd_times3(0.5, across), zd_times3(c, zd_cross3(phi, across)))), to);
}

static void read_cosine(const zd_space_quantity *quantity, const zd_space_pose *pose, zd_vector3 a, zd_space_reading *to)
{
    const zd_vector3 b = zd_direction_of(pose + quantity->second, quantity->b);
    to->value = zd_inner3(a, b);
    twist_both(zd_cross3(b, a), to);
}

/* From P to Q. */
static zd_vector3 apart_of(const zd_space_quantity *quantity, const zd_space_pose *pose)
{
    return zd_minus3(zd_space_point_of(pose + quantity->second, quantity->point2),
                     zd_space_point_of(pose + quantity->first, quantity->point1));
}

static zd_space_reading read(const zd_space_quantity *quantity, const zd_space_pose *pose, int has_value)
{
    zd_space_reading to = {.value = 0};
    if (quantity->kind <= ZD_SPACE_Z) {
        read_place(quantity, pose, apart_of(quantity, pose), &to);
        to.value -= quantity->zero;
        return to;
    }
    const zd_vector3 a = zd_direction_of(pose + quantity->first, quantity->a);
    switch (quantity->kind) {
    case ZD_SPACE_ALONG: read_along(quantity, pose, a, apart_of(quantity, pose), &to); break;
    case ZD_SPACE_COSINE: read_cosine(quantity, pose, a, &to); break;
    case ZD_SPACE_ANGLE: read_angle(quantity, pose, a, has_value, &to); break;
    case ZD_SPACE_ROTATION: read_rotation(quantity, pose, a, &to); break;
    case ZD_SPACE_DISTANCE: read_distance(quantity, pose, apart_of(quantity, pose), &to); break;
    case ZD_SPACE_GLIDE: to.second = (zd_space_wrench){a, zd_cross3(zd_direction_of(pose + quantity->second, quantity->point2), a)}; break;
    case ZD_SPACE_SPIN: to.second.torque = a; break;
    case ZD_SPACE_TURN: twist_both(a, &to); break;
    case ZD_SPACE_SHEAR: read_along(quantity, pose, zd_vector3_of(quantity->a), apart_of(quantity, pose), &to), to.value = 0; break;
    default: zd_read_contact(quantity, pose, apart_of(quantity, pose), &to);
    }
    to.value -= quantity->zero;
    return to;
}

zd_space_reading zd_space_quantity_read(const zd_space_quantity *quantity, const zd_space_pose *pose) { return read(quantity, pose, 1); }

zd_space_reading zd_space_quantity_wrenches(const zd_space_quantity *quantity, const zd_space_pose *pose) { return read(quantity, pose, 0); }

int zd_space_quantity_is_mutual(const zd_space_quantity *quantity)
{
    return quantity->kind != ZD_SPACE_GLIDE && quantity->kind != ZD_SPACE_SPIN;
}

/* ---- turns ---- */

double zd_with_turns(double angle, double near)
{
    static const double TURN = 6.283185307179586;
    return angle + TURN * nearbyint((near - angle) / TURN);
}

double zd_space_quantity_counted(const zd_space_quantity *quantity, double value, const double *angle)
{
    return quantity->counted ? zd_with_turns(value, angle[quantity->counted - 1] - quantity->zero) : value;
}

double zd_space_quantity_value(const zd_space_quantity *quantity, const zd_space_pose *pose, const double *angle)
{
    return zd_space_quantity_counted(quantity, zd_space_quantity_read(quantity, pose).value, angle);
}

/* ---- rates and biases ---- */

static double work(zd_space_wrench what, const zd_space_twist *twist)
{
    return zd_inner3(what.force, twist->speed) + zd_inner3(what.torque, twist->spin);
}

static double bias_of_place(const zd_space_quantity *quantity, zd_moving apart)
{
    return quantity->kind == ZD_SPACE_X ? apart.second.x : quantity->kind == ZD_SPACE_Y ? apart.second.y : apart.second.z;
}

static double bias_of_distance(zd_moving apart, double rate)
{
    const double length = sqrt(zd_inner3(apart.value, apart.value));
    return length > 0 ? (zd_inner3(apart.rate, apart.rate) + zd_inner3(apart.value, apart.second) - rate * rate) / length : 0;
}

static double bias_of_angle(zd_moving a, zd_moving o, zd_moving b, double rate)
{
    const double x = zd_inner3(a.value, b.value), y = zd_inner3(o.value, b.value), size = x * x + y * y;
    const double xdot = zd_inner3(a.rate, b.value) + zd_inner3(a.value, b.rate),
        ydot = zd_inner3(o.rate, b.value) + zd_inner3(o.value, b.rate);
    return (x * bias_of_product(o, b) - y * bias_of_product(a, b) - 2 * rate * (x * xdot + y * ydot)) / size;
}

/* Rate of the torque of read_rotation(), times the relative angular velocity w. */
static double bias_of_rotation(const zd_space_quantity *quantity, const zd_space_pose *pose, const zd_space_twist *twist)
{
    double slope;
    const zd_vector3 a = zd_direction_of(pose + quantity->first, quantity->a), phi = rotation_vector(quantity, pose);
    const double c = rotation_factor(zd_inner3(phi, phi), &slope);
    const zd_vector3 spin = twist[quantity->first].spin, w = zd_minus3(twist[quantity->second].spin, spin);
    const zd_vector3 across = zd_cross3(phi, a), twice = zd_cross3(phi, across), phi_w = zd_cross3(phi, w);
    const zd_vector3 rate = zd_plus3(w, zd_plus3(zd_times3(-0.5, phi_w), zd_times3(c, zd_cross3(phi, phi_w))));   /* in axes of the first */
    const zd_vector3 rate_a = zd_cross3(rate, a), of_twice = zd_plus3(zd_cross3(rate, across), zd_cross3(phi, rate_a));
    const zd_vector3 torque = zd_plus3(a, zd_plus3(zd_times3(0.5, across), zd_times3(c, twice)));
    return zd_inner3(w, zd_cross3(spin, torque)) + 0.5 * zd_inner3(w, rate_a) + c * zd_inner3(w, of_twice) +
           2 * slope * zd_inner3(phi, rate) * zd_inner3(w, twice);
}

double zd_space_quantity_rate(const zd_space_quantity *quantity, const zd_space_pose *pose, const zd_space_twist *twist)
{
    const zd_space_reading reading = zd_space_quantity_wrenches(quantity, pose);
    return work(reading.first, twist + quantity->first) + work(reading.second, twist + quantity->second);
}

static double bias_of_glide(zd_moving a, zd_moving Q) { return zd_inner3(a.rate, Q.rate) + zd_inner3(a.value, Q.second); }

/* Bias where the bodies' accelerations are zero. */
static double own_bias(const zd_space_quantity *quantity, const zd_space_pose *pose, const zd_space_twist *twist)
{
    const zd_space_pose *first = pose + quantity->first, *second = pose + quantity->second;
    const zd_space_twist *first_twist = twist + quantity->first, *second_twist = twist + quantity->second;
#define TURNING_FIRST(which) zd_turning(first, first_twist, quantity->which)
#define TURNING_B zd_turning(second, second_twist, quantity->b)
#define POINT_Q zd_point_moving(second, second_twist, quantity->point2)
#define APART zd_difference(POINT_Q, zd_point_moving(first, first_twist, quantity->point1))
    switch (quantity->kind) {
    case ZD_SPACE_ALONG: return bias_of_product(TURNING_FIRST(a), APART);
    case ZD_SPACE_COSINE: return bias_of_product(TURNING_FIRST(a), TURNING_B);
    case ZD_SPACE_ANGLE:
        return bias_of_angle(TURNING_FIRST(a), TURNING_FIRST(o), TURNING_B, zd_space_quantity_rate(quantity, pose, twist));
    case ZD_SPACE_ROTATION: return bias_of_rotation(quantity, pose, twist);
    case ZD_SPACE_DISTANCE: return bias_of_distance(APART, zd_space_quantity_rate(quantity, pose, twist));
    case ZD_SPACE_CLEARANCE:
    case ZD_SPACE_SLIP:
    case ZD_SPACE_ORBIT:
    case ZD_SPACE_ORBIT_ACROSS: return zd_bias_of_contact(quantity, pose, twist, TURNING_FIRST(a), TURNING_FIRST(o), APART);
    case ZD_SPACE_GLIDE: return bias_of_glide(TURNING_FIRST(a), POINT_Q);
    case ZD_SPACE_SHEAR: return zd_inner3(zd_vector3_of(quantity->a), zd_minus3(POINT_Q.second,
                                       zd_cross3(first_twist->spin, zd_minus3(POINT_Q.rate, first_twist->speed))));
    case ZD_SPACE_SPIN:     /* same for a turn, as the rate of a is perpendicular to the first body's own angular velocity */
    case ZD_SPACE_TURN: return zd_inner3(TURNING_FIRST(a).rate, second_twist->spin);
    default: return bias_of_place(quantity, APART);
    }
#undef TURNING_FIRST
#undef TURNING_B
#undef POINT_Q
#undef APART
}

double zd_space_quantity_bias(const zd_space_quantity *quantity, const zd_space_pose *pose, const zd_space_twist *twist,
                              const zd_space_twist *bias)
{
    const double own = own_bias(quantity, pose, twist);
    return bias ? own + zd_space_quantity_rate(quantity, pose, bias) : own;
}
