/* What joints and elements of mechanisms in the plane are made of.
 *
 * A gauge is a number that can be read off one or two bodies, such as a distance or an angle. All that joints, drives and forces say is
 * said in gauges: a constraint sets a combination of gauges to zero, a force acts along a gauge. A gauge knows bodies only and no
 * coordinates of a mechanism: how fast it changes is told as what it does to the twist of each body, three numbers (x, y, turn) which are
 * at once the force and the torque about the mass centre that a unit force along the gauge is for that body.
 *
 * Plain declarations and nothing else: CFFI reads this very text. SI units, radians.
 */
#ifndef ZD_PLANE_JOINTS_JOINT_H
#define ZD_PLANE_JOINTS_JOINT_H

#include "../../../include/zerodrift/system.h"

/* With P the gauge's point on the first body, Q that on the second, e its axis, which turns with the first body, and n = e turned
 * by a quarter turn counter-clockwise. */
enum zd_plane_gauge_kind {
    ZD_GAUGE_X,             /* m: x of Q - P */
    ZD_GAUGE_Y,             /* m: y of Q - P */
    ZD_GAUGE_ANGLE,         /* rad: angle of the second less that of the first */
    ZD_GAUGE_ALONG,         /* m: e . (Q - P) */
    ZD_GAUGE_ACROSS,        /* m: n . (Q - P) */
    ZD_GAUGE_DISTANCE,      /* m: |Q - P| */
    ZD_GAUGE_GLIDE,         /* m: has no value, only a rate, the velocity of Q along e. It does nothing to the first body. */
    ZD_GAUGE_SKID,          /* m: as that, along n */
    ZD_GAUGE_KINDS
};

/* Which number of a joint is taken from a gauge's reading, so that it is zero where the joint says zero. */
enum zd_zero { ZD_ZERO_NONE, ZD_ZERO_ALONG, ZD_ZERO_ACROSS, ZD_ZERO_ANGLE, ZD_ZERO_LENGTH };

/* How a joint carries one of its bodies in joint coordinates. */
enum zd_carrier {
    ZD_CARRIES_NOTHING,     /* it has no coordinate of its own: its rows are constraints in joint coordinates, too */
    ZD_TURNS,               /* the coordinate is the outer body's angle from the ground's x axis */
    ZD_SLIDES,              /* the coordinate is the displacement along an axis */
    ZD_FIXED                /* there is none */
};

enum { ZD_JOINT_ROWS = 3 };

typedef struct zd_plane_joint_row {
    enum zd_plane_gauge_kind gauge;
    enum zd_zero zero;
    int rolls;              /* whether `length` times the angle of the second body from the first is added */
    int nonholonomic;
} zd_plane_joint_row;

/* A kind of joint: a row of the table of joints. */
typedef struct zd_plane_joint_kind {
    zd_card card;
    enum zd_carrier carrier;
    int rows;
    zd_plane_joint_row row[ZD_JOINT_ROWS];    /* the holonomic ones first */
    const char *coordinate;             /* the name of the gauge that drives, springs and damping act along; NULL: there is none */
    enum zd_plane_gauge_kind gauge;           /* and its kind */
    enum zd_zero zero;
    int takes_axis, takes_length;       /* whether the user gives them */
    int at_contact;                     /* whether its force acts `length` below the second's point, against n, and not at it */
    const char *tension;                /* name of the scalar that its first row's force is, positive where it pulls; or NULL */
} zd_plane_joint_kind;

int zd_plane_joint_kinds(void);
const zd_plane_joint_kind *zd_plane_joint_kind_of(int row);     /* NULL: there is no such row */

/* A kind of force element: a row of the table of elements. It is one effort along each of its gauges. */
enum { ZD_ELEMENT_GAUGES = 3 };

typedef struct zd_plane_element_kind {
    zd_card card;
    int gauges;
    enum zd_plane_gauge_kind gauge[ZD_ELEMENT_GAUGES];
    enum zd_zero zero[ZD_ELEMENT_GAUGES];
    int is_spring;                      /* -stiffness reading - damping rate; else a value that is given */
    const char *effort;                 /* the name of its scalar measure, "force" or "torque"; NULL: it has none */
    int sign;                           /* of that measure: -1 where it is positive in tension, else 1 */
} zd_plane_element_kind;

int zd_plane_element_kinds(void);
const zd_plane_element_kind *zd_plane_element_kind_of(int row);

#endif
