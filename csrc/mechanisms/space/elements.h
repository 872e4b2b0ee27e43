/* Kinds of joints of spatial mechanisms: each is a short table of primitive marker quantities.
 *
 * A marker quantity belongs to one or two bodies, as in the plane (../plane/elements.h): a row sets a sum of marker quantities to
 * zero, a force acts along one. Its rate is linear in the twists of its bodies; the coefficients for a body are also the force and the torque
 * of a unit force along the marker quantity. So value, row and bias of each primitive are derived once, in marker_quantity.c, and a joint
 * is data.
 *
 * Plain declarations only: CFFI parses this text. SI units, radians.
 */
#pragma once

#include "../../include/zerodrift/system.h"

/* With P the marker quantity's point on the first body, Q that on the second, a a direction that turns with the first, and b one that turns
 * with the second. Speeds have no value, only a rate. */
enum zd_space_quantity_kind {
    ZD_SPACE_X,             /* m: x of Q - P */
    ZD_SPACE_Y,             /* m: y of Q - P */
    ZD_SPACE_Z,             /* m: z of Q - P */
    ZD_SPACE_ALONG,         /* m: a . (Q - P) */
    ZD_SPACE_COSINE,        /* a . b */
    ZD_SPACE_ANGLE,         /* rad, in (-pi, pi]: from a to b, about the axis a x o, where o is a second direction of the first */
    ZD_SPACE_DISTANCE,      /* m: |Q - P| */
    ZD_SPACE_CLEARANCE,     /* m: o . (C - P), where C is the point of an ellipsoid about Q that is farthest against o */
    ZD_SPACE_SLIP,          /* m/s: a . (velocity at C of the second body minus that of the first) */
    ZD_SPACE_GLIDE,         /* m/s: a . velocity of Q. No force on the first body. */
    ZD_SPACE_SPIN,          /* rad/s: a . angular velocity of the second. No force on the first body. */
    ZD_SPACE_TURN,          /* rad/s: a . (angular velocity of the second minus that of the first) */
    ZD_SPACE_ROTATION,      /* rad: a . phi, where phi is the rotation vector of the second body against the first, of length below pi */
    ZD_SPACE_SHEAR,         /* m/s: a . (velocity at Q of the second body minus that of the first), where a is fixed in global axes */
    /* m/s: t . (velocity at C of the second body minus that of the first), where C is the point of a ball about Q, of the radius
     * shape[0][0], that is nearest to P or, with a negative one, farthest from it; a x u is along t, or o x u, and u from P to Q */
    ZD_SPACE_ORBIT,
    ZD_SPACE_ORBIT_ACROSS,  /* m/s: the same along u x t */
    ZD_SPACE_QUANTITIES
};

/* Offset of a joint that is subtracted from a marker quantity's value. */
enum zd_space_zero { ZD_SPACE_ZERO_NONE, ZD_SPACE_ZERO_ALONG, ZD_SPACE_ZERO_LENGTH };

/* Directions of a joint's frame. Each body has one; they coincide in the joint's zero position. */
enum { ZD_SPACE_AXIS, ZD_SPACE_NORMAL, ZD_SPACE_THIRD, ZD_SPACE_AXES };     /* right-handed, of length 1 */

enum { ZD_SPACE_ROWS = 6, ZD_SPACE_COORDINATES = 2, ZD_SPACE_FREEDOMS = 3 };

typedef struct zd_space_pick {
    enum zd_space_quantity_kind quantity;
    int of_first, of_second;    /* directions of the frames for a and b; o of an angle is the direction after a, cyclically */
    enum zd_space_zero zero;
    /* 1 if a is a direction of the joint's second body and b one of its first; o is then the direction before a */
    int is_swapped;
    int is_own;                 /* 1 if a is a direction of the joint's second body, and both bodies of the marker quantity are that body */
} zd_space_pick;

typedef struct zd_space_row {
    zd_space_pick pick;
    int advances;               /* 1 if `length` times the relative angle of the second body about the axis is subtracted, as for a screw */
    int nonholonomic;
} zd_space_row;

typedef struct zd_space_coordinate {
    const char *name;           /* "angle", "displacement"; NULL: end of the list */
    zd_space_pick pick;
} zd_space_coordinate;

/* Kinds of freedom of an inboard joint. They are applied one after another to a frame that moves from the first body to the second. */
enum zd_space_freedom_kind {
    ZD_SPACE_SLIDES,        /* along a direction of the frame */
    ZD_SPACE_TURNS,         /* about it, through the frame's current origin */
    ZD_SPACE_ADVANCES,      /* about it, and along by `length` for each rad */
    ZD_SPACE_SWINGS         /* about the point, by a unit quaternion */
};

typedef struct zd_space_freedom {
    enum zd_space_freedom_kind kind;
    int direction;              /* index of the direction in the moving frame */
    const char *name;           /* name of its coordinate, such as "angle" */
    enum zd_space_zero zero;    /* distance along the direction at coordinate zero */
} zd_space_freedom;

/* A kind of joint: an entry of the table of joints in space. */
typedef struct zd_space_joint_kind {
    zd_card card;
    int rows;
    zd_space_row row[ZD_SPACE_ROWS];    /* the holonomic ones first */
    zd_space_coordinate coordinate[ZD_SPACE_COORDINATES];
    int axes;                   /* number of directions that the user gives: 0, 1 (an axis), or 2 (perpendicular) */
    int rolls;                  /* 1 if it is a contact at C, where its force acts; o of its marker quantities is the axis */
    int takes_length;           /* 1 if the user gives `length`: m of a rod, m/rad of a screw */
    const char *tension;        /* name of the measure of its force along the line of its points, positive in tension; NULL: none */
    int is_inboard;             /* 1 if it can be an inboard joint; otherwise it is constraint rows in all coordinates */
    int freedoms;
    zd_space_freedom freedom[ZD_SPACE_FREEDOMS];
} zd_space_joint_kind;

int zd_space_joint_kinds(void);
const zd_space_joint_kind *zd_space_joint_kind_of(int row);     /* NULL: out of range */

/* A kind of force element: one generalized force along each of its marker quantities. */
enum { ZD_SPACE_ELEMENT_QUANTITIES = 6 };

typedef struct zd_space_element_kind {
    zd_card card;
    int quantities;             /* their number; lengths stand before angles */
    zd_space_pick pick[ZD_SPACE_ELEMENT_QUANTITIES];
    int is_spring;              /* 1: -stiffness value - damping rate; 0: a given force */
    int axes;                   /* 0; 1: the user gives the axis; 3: an axis and a normal are optional, by default those of the first body */
    int at_joint;               /* 1 if it acts along the angle of a joint that the user gives, from an angle where it is slack */
    const char *measure;        /* name of its scalar measure, "force" or "torque"; NULL: it has both as vectors */
    int sign;                   /* sign of that measure: -1 if it is positive in tension, otherwise 1 */
} zd_space_element_kind;

int zd_space_element_kinds(void);
const zd_space_element_kind *zd_space_element_kind_of(int row); /* NULL: out of range */
