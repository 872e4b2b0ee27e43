/* Kinds of joints of planar mechanisms, and the marker quantities in which joints and force elements are stated.
 *
 * A marker quantity belongs to one or two bodies, such as a distance or an angle. Joints, drives and forces are stated in marker quantities:
 * a constraint sets a combination of marker quantities to zero, a force acts along a marker quantity. The rate of a marker quantity is linear
 * in the twists of its bodies; the three coefficients (x, y, turn) for a body are also the force and the torque about its mass centre of a
 * unit force along the marker quantity.
 *
 * Plain declarations only: CFFI parses this text. SI units, radians.
 */
#pragma once

#include "../../include/zerodrift/system.h"

/* Connection of a body to its parent in a tree of bodies, as determined by its inboard joint. */

typedef struct zd_vector {
    double x, y;
} zd_vector;

enum zd_plane_hang {
    ZD_HANGS_FREE,          /* coordinates x, y, angle */
    ZD_HANGS_FREE_POINT,    /* a free particle: x, y */
    ZD_HANGS_TURNING,       /* its angle */
    ZD_HANGS_SLIDING,       /* its displacement */
    ZD_HANGS_FIXED,
    ZD_HANGS_PINNED         /* a particle at a point of the inner body */
};

typedef struct zd_plane_link {
    enum zd_plane_hang hang;
    int inner;              /* its parent */
    int coordinate;         /* index of its first coordinate */
    zd_vector near;         /* from the inner mass centre to the joint, in the inner body's axes */
    zd_vector far;          /* from the joint to its own mass centre, in its own axes */
    zd_vector axis;         /* along which it slides, in the inner body's axes */
    double along;           /* m: position along the axis at displacement 0 */
    double angle, cosine, sine;     /* angle relative to the parent, where it slides or is fixed */
    double mass, inertia;
    double carried;         /* kg: mass of the body and all its descendants */
} zd_plane_link;

/* With P the marker quantity's point on the first body, Q that on the second, e its axis, which turns with the first body, and n = e turned
 * by a quarter turn counter-clockwise. */
enum zd_plane_quantity_kind {
    ZD_PLANE_X,             /* m: x of Q - P */
    ZD_PLANE_Y,             /* m: y of Q - P */
    ZD_PLANE_ANGLE,         /* rad: angle of the second body minus that of the first */
    ZD_PLANE_ALONG,         /* m: e . (Q - P) */
    ZD_PLANE_ACROSS,        /* m: n . (Q - P) */
    ZD_PLANE_DISTANCE,      /* m: |Q - P| */
    ZD_PLANE_GLIDE,         /* m: no value, only a rate, the velocity of Q along e. No force on the first body. */
    ZD_PLANE_SKID,          /* m: the same along n */
    /* m: only a rate, along e, which is fixed in global axes: the velocity of Q minus that of the first body there. */
    ZD_PLANE_SHEAR,
    ZD_PLANE_ORBIT,         /* m: the same with n along Q - P: how fast Q runs around P, clockwise, as seen from the first body */
    ZD_PLANE_QUANTITIES
};

/* Offset of a joint that is subtracted from a marker quantity's value, so that it is zero in the joint's zero position. */
enum zd_zero { ZD_ZERO_NONE, ZD_ZERO_ALONG, ZD_ZERO_ACROSS, ZD_ZERO_ANGLE, ZD_ZERO_LENGTH };

/* Inboard joint types: how a joint connects a body to its parent in joint coordinates. */
enum zd_inboard {
    ZD_NOT_INBOARD,         /* never an inboard joint: it is constraint rows in joint coordinates, too */
    ZD_TURNS,               /* the coordinate is the outer body's angle from the ground's x axis */
    ZD_SLIDES,              /* the coordinate is the displacement along an axis */
    ZD_FIXED                /* no coordinate */
};

enum { ZD_JOINT_ROWS = 3 };

typedef struct zd_plane_joint_row {
    enum zd_plane_quantity_kind quantity;
    enum zd_zero zero;
    int rolls;              /* 1 if `length` times the relative angle of the second body is added, as for rolling */
    int nonholonomic;
} zd_plane_joint_row;

/* A kind of joint: an entry of the table of joints. */
typedef struct zd_plane_joint_kind {
    zd_card card;
    enum zd_inboard inboard;
    int rows;
    zd_plane_joint_row row[ZD_JOINT_ROWS];    /* the holonomic ones first */
    const char *coordinate;             /* "angle" or "displacement", along which drives, springs and damping act; NULL: none */
    enum zd_plane_quantity_kind quantity;           /* its kind */
    enum zd_zero zero;
    int takes_axis, takes_length;       /* 1 if the user gives an axis, a length */
    int at_contact;                     /* 1 if its force acts at the contact, `length` below the second body's point against n of its last
                                         * row; 0: at that point */
    const char *tension;                /* name of the measure of its force along the line of its points, positive in tension; NULL: none */
} zd_plane_joint_kind;

int zd_plane_joint_kinds(void);
const zd_plane_joint_kind *zd_plane_joint_kind_of(int row);     /* NULL: out of range */

/* A kind of force element: one generalized force along each of its marker quantities. */
enum { ZD_ELEMENT_QUANTITIES = 3 };

typedef struct zd_plane_element_kind {
    zd_card card;
    int quantities;                     /* their number; lengths stand before angles */
    enum zd_plane_quantity_kind quantity[ZD_ELEMENT_QUANTITIES];
    enum zd_zero zero[ZD_ELEMENT_QUANTITIES];
    int is_spring;                      /* 1: -stiffness value - damping rate; 0: a given force */
    int axes;                           /* 1 if the user gives an axis; 0: the x axis of the first body is taken */
    int at_joint;                       /* 1 if it acts along the angle of a joint that the user gives, from an angle where it is slack */
    const char *measure;                /* name of its scalar measure, "force" or "torque"; NULL: it has both as vectors */
    int sign;                           /* sign of that measure: -1 if it is positive in tension, otherwise 1 */
} zd_plane_element_kind;

int zd_plane_element_kinds(void);
const zd_plane_element_kind *zd_plane_element_kind_of(int row);
