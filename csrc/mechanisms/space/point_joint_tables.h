/* Joints with coinciding points: three rows for the coincidence of a point of one body and a point of another, and up to three more that
 * each keep a direction of one perpendicular to a direction of the other. These are spherical, universal and revolute joints and welds.
 * Their entries of C are 1 and -1 for velocities of mass centres; those for angular velocities are kept in the scratch, so that products
 * with C do not need its stored entries. */
#pragma once

#include "bodies.h"

enum { ZD_POINT_CONSTRAINTS = 3, ZD_POINT_JOINT_CONSTRAINTS = 6 };   /* rows of the point, and maximum of all rows */

/* The data are split into four arrays: most loops read one or two of them, and large mechanisms are bound by memory bandwidth. */
typedef struct zd_point_joint {
    int first, second;      /* bodies */
    int rows;               /* number of its rows */
    int row;                /* index of its first row */
    int turns;              /* offset of its angular entries of C: (2, rows, 3), of the first body and the second */
} zd_point_joint;

typedef struct zd_point_joint_points {
    zd_vector3 first, second;   /* in the axes of each body */
} zd_point_joint_points;

typedef struct zd_directions {
    /* unit vectors of the first and the second body */
    zd_vector3 a[ZD_POINT_JOINT_CONSTRAINTS - ZD_POINT_CONSTRAINTS], b[ZD_POINT_JOINT_CONSTRAINTS - ZD_POINT_CONSTRAINTS];
} zd_directions;

typedef struct zd_point_joint_entries {  /* entries of C */
    int C, width;           /* offset of the first row in C, and length of each row */
    int near, far;          /* offsets of the bodies' entries in a row; -1: the body is the ground */
    int near_turns, far_turns;  /* 1 if the body has an angular velocity */
} zd_point_joint_entries;

typedef struct zd_point_joints {
    int count;
    zd_point_joint *joint;      /* (count,), as the next three */
    zd_point_joint_points *points;
    zd_directions *directions;
    zd_point_joint_entries *entries;
    int *has_row;           /* (m,) 1 if the row is a point joint's */
    int *end_at;            /* (bodies + 2,) offsets of each body's joints in `end` */
    int *end;               /* (2 count,) 2 * joint, plus 1 where the body is its second */
    int rows;               /* number of rows of each joint; 0: they differ */
    int turns;              /* number of angular entries of all joints */
    int are_all;            /* 1 if there are no other rows, and all bodies have an orientation */
} zd_point_joints;

/* Moment arms of a point joint in global axes. Like its directions and angular entries (these in body axes) they are kept while p is
 * unchanged. */
typedef struct zd_arms {
    zd_vector3 first, second;   /* from the mass centres to the points */
} zd_arms;
