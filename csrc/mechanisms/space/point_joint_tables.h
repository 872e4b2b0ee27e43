/* Joints whose points coincide: three rows that hold a point of one body on a point of another, and up to three more that each keep a
 * direction of one perpendicular to one of the other. These are spherical, universal and revolute joints and welds. Of velocities of mass
 * centres their rows have 1 and -1; what they have of angular velocities is kept in the scratch,
 * so that C is not stored for products with it. */
#ifndef ZD_SPACE_POINT_JOINT_TABLES_H
#define ZD_SPACE_POINT_JOINT_TABLES_H

#include "bodies.h"

enum { ZD_POINT_ROWS = 3, ZD_POINT_JOINT_ROWS = 6 };   /* rows of the point, and at most of all */

/* Their data lie in four arrays: most loops over all sockets read one or two of them, and large mechanisms wait for memory. */
typedef struct zd_point_joint {
    int first, second;      /* bodies */
    int rows;               /* how many it has */
    int row;                /* the first of them */
    int turns;              /* where what they have of angular velocities begins: (2, rows, 3), of the first body and the second */
} zd_point_joint;

typedef struct zd_point_joint_points {
    zd_vector3 first, second;   /* in the axes of each body */
} zd_point_joint_points;

typedef struct zd_directions {
    zd_vector3 a[ZD_POINT_JOINT_ROWS - ZD_POINT_ROWS], b[ZD_POINT_JOINT_ROWS - ZD_POINT_ROWS];    /* of the first, and of the second */
} zd_directions;

typedef struct zd_point_joint_entries {  /* of C */
    int C, width;           /* where the first row begins in C, and how long each is */
    int near, far;          /* where in a row the entries of each body begin; -1: it is the ground */
    int near_turns, far_turns;  /* whether the body has an angular velocity */
} zd_point_joint_entries;

typedef struct zd_point_joints {
    int count;
    zd_point_joint *joint;      /* (count,), and so are these: */
    zd_point_joint_points *points;
    zd_directions *directions;
    zd_point_joint_entries *entries;
    unsigned char *has_row; /* (m,) whether a row is of one */
    int *end_at;            /* (bodies + 2,) where the sockets of each body begin in */
    int *end;               /* (2 count,) 2 * socket, or 1 more where the body is its second */
    int rows;               /* of each of them; 0: they differ */
    int turns;              /* how many numbers they have of angular velocities */
    int are_all;            /* whether there are no other rows, and all bodies turn */
} zd_point_joints;

/* What a move leaves of each socket, besides its directions: in the drawing's axes, as these then are, but for `turns`,
 * which are in the body's own. */
typedef struct zd_arms {
    zd_vector3 first, second;   /* from the mass centres to the points */
} zd_arms;

#endif
