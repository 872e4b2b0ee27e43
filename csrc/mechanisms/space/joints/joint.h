/* What joints of mechanisms in space are made of: primitive gauges, of which each joint is a short table.
 *
 * A gauge is a number that is read off two bodies, as in the plane (../../plane/joints/joint.h): a row sets a sum of gauges to zero, a force acts
 * along one. Its rate is told as what it does to the twist of each body, a force and a torque, which are at once what a unit force along
 * the gauge is for that body. So value, row and bias of each primitive are derived once, in ../space/gauge.c, and a joint is data.
 *
 * Plain declarations and nothing else: CFFI reads this very text. SI units, radians.
 */
#ifndef ZD_SPACE_JOINTS_JOINT_H
#define ZD_SPACE_JOINTS_JOINT_H

#include "../../../include/zerodrift/system.h"

/* With P the gauge's point on the first body, Q that on the second, a a direction that turns with the first, and b one that turns with the
 * second. Speeds have no value, only a rate. */
enum zd_space_gauge_kind {
    ZD_SPACE_X,             /* m: x of Q - P */
    ZD_SPACE_Y,             /* m: y of Q - P */
    ZD_SPACE_Z,             /* m: z of Q - P */
    ZD_SPACE_ALONG,         /* m: a . (Q - P) */
    ZD_SPACE_COSINE,        /* a . b */
    ZD_SPACE_ANGLE,         /* rad, in (-pi, pi]: from a to b, about the axis a x o, where o is a second direction of the first */
    ZD_SPACE_DISTANCE,      /* m: |Q - P| */
    ZD_SPACE_CLEARANCE,     /* m: o . (C - P), where C is the point of an ellipsoid about Q that is farthest against o */
    ZD_SPACE_SLIP,          /* m/s: a . (velocity of the second less that of the first, of what is at C of each) */
    ZD_SPACE_GLIDE,         /* m/s: a . velocity of Q. It does nothing to the first body. */
    ZD_SPACE_SPIN,          /* rad/s: a . angular velocity of the second. It does nothing to the first body. */
    ZD_SPACE_TURN,          /* rad/s: a . (angular velocity of the second less that of the first) */
    ZD_SPACE_GAUGES
};

/* Which number of a joint is taken from a gauge's reading. */
enum zd_space_zero { ZD_SPACE_ZERO_NONE, ZD_SPACE_ZERO_ALONG, ZD_SPACE_ZERO_LENGTH };

/* Directions of a joint's frame. Each body has one, and where the joint says zero they coincide. */
enum { ZD_SPACE_AXIS, ZD_SPACE_NORMAL, ZD_SPACE_THIRD, ZD_SPACE_AXES };     /* right-handed, of length 1 */

enum { ZD_SPACE_ROWS = 6, ZD_SPACE_COORDINATES = 2, ZD_SPACE_FREEDOMS = 3 };

typedef struct zd_space_pick {
    enum zd_space_gauge_kind gauge;
    int of_first, of_second;    /* which directions of the frames a and b are; of an angle o is the one after a, in turn */
    enum zd_space_zero zero;
    int is_swapped;             /* whether a, then, is of the joint's second body and b of its first, and o the one before a */
    int is_own;                 /* whether a is of the joint's second body, and the gauge of that body alone */
} zd_space_pick;

typedef struct zd_space_row {
    zd_space_pick pick;
    int advances;               /* whether `length` times the angle of the second body about the axis is taken from it */
    int nonholonomic;
} zd_space_row;

typedef struct zd_space_coordinate {
    const char *name;           /* "angle", "displacement"; NULL: there are no more */
    zd_space_pick pick;
} zd_space_coordinate;

/* What a joint leaves free, one after another from the first body's frame to the second's:
 * a joint that says it can carry a body in a tree. */
enum zd_space_freedom_kind {
    ZD_SPACE_SLIDES,        /* along a direction of the frame */
    ZD_SPACE_TURNS,         /* about it, through the point where the frame is by then */
    ZD_SPACE_ADVANCES,      /* about it, and along by `length` for each rad */
    ZD_SPACE_SWINGS         /* about the point, by a unit quaternion */
};

typedef struct zd_space_freedom {
    enum zd_space_freedom_kind kind;
    int direction;              /* of the frame */
    const char *name;           /* of its coordinate, such as "angle" */
    enum zd_space_zero zero;    /* what the distance along the direction is where the coordinate is zero */
} zd_space_freedom;

/* A kind of joint: a row of the table of joints in space. */
typedef struct zd_space_joint_kind {
    zd_card card;
    int rows;
    zd_space_row row[ZD_SPACE_ROWS];    /* the holonomic ones first */
    zd_space_coordinate coordinate[ZD_SPACE_COORDINATES];
    int axes;                   /* how many directions the user gives: none, an axis, or two that are perpendicular */
    int rolls;                  /* whether it touches at C, where its force acts: o of its gauges is the axis */
    int takes_length;           /* whether the user gives `length`: of a rod, or of a screw m for each rad */
    const char *tension;        /* name of the scalar that its first row's force is, positive where it pulls; or NULL */
    int carries;                /* whether it can carry a body in a tree; else it is rows in all coordinates */
    int freedoms;
    zd_space_freedom freedom[ZD_SPACE_FREEDOMS];
} zd_space_joint_kind;

int zd_space_joint_kinds(void);
const zd_space_joint_kind *zd_space_joint_kind_of(int row);     /* NULL: there is no such row */

#endif
