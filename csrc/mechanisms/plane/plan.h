/* Planned form of a planar mechanism: bodies renumbered so that parents come before children, joints converted to rows of marker quantities.
 * */
#pragma once

#include "../common/planned.h"
#include "hinged.h"
#include "tables.h"
#include "tree.h"

typedef struct zd_plane_planned_joint {
    int carried;            /* the body of which it is the inboard joint; 0: none */
    int sign;               /* 1: that is the second body, -1: the first */
    int rows[ZD_JOINT_ROWS];    /* indices of its rows of C */
    int row_count;
} zd_plane_planned_joint;

enum { ZD_PLANE_ARRAYS = 19, ZD_PLANE_OF_MEASURES = 14 };   /* number of arrays of a frame, and the first that measures alone use */

struct zd_packing;

/* Body numbers in all of these are those of the tree. */
struct zd_plane {
    const double *numbers;          /* inputs of generated functions; must be the first member, as they read it there */
    zd_vector gravity;
    zd_plane_tree tree;
    int joints;
    zd_planned_elements elements;
    const int *number;              /* (bodies + 1,): of each body as given, in the tree */
    const zd_plane_joint *joint;
    const zd_plane_planned_joint *planned;    /* (joints,) */
    const zd_plane_quantity *quantity;          /* the given marker quantities, then those of the joints' rows */
    const zd_plane_coordinate_owner *coordinate;      /* (nq,) */
    zd_hinged hinged;             /* used if all bodies turn about revolute joints and nothing is packed */
    const struct zd_packing *packing;   /* in absolute coordinates, where its matrices are stored packed; else NULL */
    int revolutes, lines;           /* in absolute coordinates, their numbers: see structure/packing.h */
    size_t frame_at[ZD_PLANE_ARRAYS + 1];       /* bytes before each array of a frame, and their sum */
    zd_system system;               /* its data is the mechanism */
    zd_measures measures;
};

/* Wrenches of a row of C on its two bodies along one marker quantity, in global axes. */
typedef struct zd_plane_pull {
    zd_vector along;                /* to the second body, and the opposite to the first */
    double near, far;               /* torque on the first, and on the second */
} zd_plane_pull;

/* Arrays in a system's scratch: those of one (bodies + 1,) have an entry for each body. */
typedef struct zd_plane_frame {
    zd_vector *arm;                 /* (2 revolutes,) of each revolute joint; this array and the next are first: see products.c */
    double *spread;                 /* (3 bodies + 3,) where matrices are packed: a vector over the coordinates */
    zd_plane_pull *pull;            /* (lines,): see lines.c */
    double *place;                  /* (3 bodies + 3,) where there are lines: the coordinates */
    zd_vector *axis;                /* (bodies + 1,) where matrices are packed: x axis of each body */
    zd_plane_pose *pose;
    zd_plane_twist *twist;
    zd_plane_wrench *wrench;
    zd_plane_composite *composite;  /* (bodies + 1,) unless matrices are packed */
    double *sines;                  /* 3 for each body, see zd_plane_tree_turn() */
    double *is_placed;              /* 1 if the poses belong to the current (t, p), otherwise 0 */
    double *x, *xdot, *out;         /* inputs of user functions, (longest,) each, and their output, (longest + 3,) */
    double *is_moving;              /* for measures, as those that follow: 1 if the twists belong to the current v, otherwise 0 */
    zd_spin *spin;
    double *is_least, *least;       /* 1 if (m,) multipliers of the least reactions belong to the current state */
    double *row;                    /* (nv,) */
    const double *inputs;           /* values of user functions of forces, if some of these read reactions; else NULL */
} zd_plane_frame;

void zd_plane_frame_of(const zd_plane *mechanism, double *scratch, zd_plane_frame *frame);
void zd_plane_frame_divide(zd_plane *mechanism);     /* sets frame_at, and the sizes of scratch */
/* Marker quantities of a placed frame; their rates need a moving one. */
zd_readings zd_plane_frame_readings(const zd_plane *mechanism, const zd_plane_frame *frame);

/* Magnitudes before cancellation: see zd_system. Those of the gradients of constraints are for joint coordinates of the plane. */

int zd_plane_magnitudes(const void *data, double t, const double *p, const double *v, double *magnitude, double *scratch);
int zd_plane_force_magnitudes(const void *data, const double *inputs, double t, const double *p, const double *v, double *magnitude,
                              double *scratch);
