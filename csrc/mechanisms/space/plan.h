/* Planned form of a spatial mechanism: joints converted to rows of marker quantities, and the storage of their entries. */
#ifndef ZD_SPACE_PLAN_H
#define ZD_SPACE_PLAN_H

#include "../common/output_spec.h"
#include "../common/packed.h"
#include "../common/readings.h"
#include "marker_quantity.h"
#include "point_joint_tables.h"
#include "tables.h"

typedef struct zd_space_planned_joint {
    int rows[ZD_SPACE_ROWS];    /* indices of its rows of C */
    int row_count;
    int carried;                    /* the body of which it is the inboard joint, and then it has no rows; 0: none */
    int sign;                       /* 1: that is its second body, -1: its first */
    int angles;                     /* number of angles of the joints before it */
} zd_space_planned_joint;

struct zd_space_frame;

/* Kinematics and forces of a tree of bodies, used instead of those of free bodies. */
typedef struct zd_carrying {
    void (*place)(const zd_space *self, const struct zd_space_frame *frame, const double *p);
    void (*move)(const zd_space *self, const struct zd_space_frame *frame, const double *v);     /* and frame->bias */
    /* row (nv,) += scale times the generalized force of a unit force along a marker quantity */
    void (*act)(const zd_space *self, const struct zd_space_frame *frame, const zd_space_quantity *quantity, double scale,
                const zd_space_reading *reading,
                double *row);
    /* reaction += wrench of an inboard joint on its second body, about a point. Returns ZD_DONE or ZD_CALLBACK. */
    int (*transmit)(const zd_space *self, const struct zd_space_frame *frame, int joint, zd_vector3 point,
                    const zd_measured_state *at, zd_space_wrench *reaction);
    int scratch;                    /* number of doubles of the tree at the end of the frame */
    void *tree;                     /* the tree's own data; released with the mechanism */
} zd_carrying;

/* Angles of joints that count turns: see unwrapped_angles.h. */
typedef struct zd_unwrapped_angles {
    int count;
    zd_space_quantity *angle;          /* (count,) marker quantity of each angle */
    zd_vector3 *axis;               /* (count,) in the axes of the marker quantity's first body */
    int *joint, *place;             /* (count,) its joint, and its index in p */
} zd_unwrapped_angles;

struct zd_space {
    const double *numbers;          /* inputs of generated functions; NULL: there are none */
    zd_vector3 gravity;
    int bodies, joints;
    zd_planned_elements elements;
    const zd_space_planned_body *body;           /* (bodies + 1,) the first one, of the ground, unused */
    const zd_space_joint *joint;
    const zd_space_planned_joint *planned;   /* (joints,) */
    const zd_space_quantity *quantity;    /* the given marker quantities, then those of the joints' rows */
    zd_packed packed;
    const double *weight;           /* (nv,) of the bodies, as generalized force */
    zd_point_joints point_joints;
    zd_carrying carrying;           /* its functions are NULL where all bodies are free */
    zd_unwrapped_angles unwrapped;
    zd_system system;               /* its data is the mechanism */
    zd_measures measures;
};

/* Quantities kept in a system's scratch while (t, p) is unchanged, followed by those computed anew at each call. */
typedef struct zd_space_frame {
    zd_space_pose *pose;
    zd_space_twist *twist;
    zd_space_wrench *wrench;
    double *quaternion;             /* (bodies + 1, 4), of the ground and of particles unused */
    double *angle;                  /* (turns,) of joints */
    zd_arms *arms;                  /* (point joints,), as the next */
    zd_directions *directions;
    double *turns;                  /* angular entries of the point joints' rows, see point_joints.h */
    double *is_placed, *is_moving;  /* used by measures only: 1 if poses and twists belong to the current state */
    double *is_least, *least;       /* used by measures only: 1 if (m,) multipliers of the least reactions belong to the current state */
    double *row;                    /* (nv,) of measures alone */
    const double *inputs;           /* values of user functions of forces, if some of these read reactions; else NULL */
    double *x, *xdot, *out;         /* inputs of user functions, (longest,) each, and their output, (longest + 3,) */
    zd_space_twist *bias;                /* accelerations of bodies of a tree at vdot = 0; NULL: all bodies are free, and have none */
    double *carried;                /* (carrying.scratch,) */
} zd_space_frame;

zd_space_frame zd_space_frame_of(const zd_space *space, double *scratch);
int zd_space_frame_size(const zd_space *space);      /* doubles */
/* From coordinates to poses, and from velocities to twists. */
void zd_space_frame_place(const zd_space *space, const zd_space_frame *frame, const double *p);
void zd_space_frame_move(const zd_space *space, const zd_space_frame *frame, const double *v);
/* Marker quantities of a placed frame; their rates need a moving one. */
zd_readings zd_space_frame_readings(const zd_space *space, const zd_space_frame *frame);

#endif
