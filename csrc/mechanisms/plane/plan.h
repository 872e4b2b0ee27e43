/* A mechanism as the core keeps it: bodies renumbered so that inner ones come first, joints turned into rows of gauges. */
#ifndef ZD_PLANE_PLAN_H
#define ZD_PLANE_PLAN_H

#include "../common/planned.h"
#include "../common/readings.h"
#include "tables.h"
#include "tree.h"
#include "hinged.h"

typedef struct zd_plane_planned_joint {
    int carried;            /* the body that it carries, 0: none */
    int sign;               /* 1: that is the second body, -1: the first */
    int rows[ZD_JOINT_ROWS];    /* which rows of C are its own */
    int row_count;
} zd_plane_planned_joint;

/* Where each part of a frame begins in the scratch, in bytes */
typedef struct zd_plane_frame_at {
    size_t pose, twist, wrench, composite, spin, axis, arm, spread, pull, place, sines, is_placed, is_moving, row, x, xdot, out;
} zd_plane_frame_at;

struct zd_packing;

/* Body numbers in all of these are those of the tree. */
struct zd_plane {
    const double *numbers;          /* of functions that were written out from this; first, as they look for it here */
    zd_vector gravity;
    zd_plane_tree tree;
    int joints;
    zd_planned_elements elements;
    const int *number;              /* (bodies + 1,): of each body as given, in the tree */
    const zd_plane_joint *joint;
    const zd_plane_planned_joint *planned;    /* (joints,) */
    const zd_plane_gauge *gauge;          /* those given, then those of the joints' rows */
    const zd_plane_coordinate_owner *coordinate;      /* (nq,) */
    zd_hinged hinged;             /* where all bodies turn and nothing is packed */
    const struct zd_packing *packing;   /* in absolute coordinates, where its matrices are stored packed; else NULL */
    int revolutes, lines;                /* in absolute coordinates, how many of these rows come down to: see revolute_joints.h, lines.h */
    zd_plane_frame_at frame_at;
    zd_system system;               /* its data is the mechanism */
    zd_measures measures;
};

/* What a row of C does to two bodies by one of its gauges, in the drawing's axes. */
typedef struct zd_plane_pull {
    zd_vector along;                /* to the second body, and the opposite to the first */
    double near, far;               /* torque on the first, and on the second */
} zd_plane_pull;

/* What a mechanism keeps in a system's scratch while (t, p) stays; then what is made anew for each call. */
typedef struct zd_plane_frame {
    zd_plane_pose *pose;
    zd_plane_twist *twist;
    zd_plane_wrench *wrench;
    zd_plane_composite *composite;
    zd_spin *spin;                  /* of measures alone */
    zd_vector *axis, *arm;          /* (bodies + 1,), (2 pins,): of each body its x, and of each pin the ways to it, see revolute_joints.c */
    double *spread;                 /* (3 bodies + 3,): a vector over the coordinates */
    zd_plane_pull *pull;                  /* (lines,): see lines.c */
    double *place;                  /* (3 bodies + 3,) where there are lines: the coordinates */
    double *sines;                  /* 3 for each body, see zd_plane_tree_turn() */
    double *is_placed;              /* whether the poses are those of this (t, p), 0 or 1 */
    double *is_moving;              /* of measures alone: whether the twists are those of this v, 0 or 1 */
    double *row;                    /* (nv,) of measures alone */
    double *x, *xdot, *out;         /* what a law is told, (longest,), and what it says, (longest + 3,) */
} zd_plane_frame;

zd_plane_frame zd_plane_frame_of(const zd_plane *mechanism, double *scratch);
int zd_plane_frame_divide(const zd_plane *mechanism, zd_plane_frame_at *to);    /* returns how many doubles that takes */
/* The gauges of a frame that is placed, and moving where their rates are asked for. */
zd_readings zd_plane_frame_readings(const zd_plane *mechanism, const zd_plane_frame *frame);

#endif
