/* Planned form of a spatial mechanism: joints converted to rows of marker quantities, and the storage of their entries. */
#pragma once

#include "../../workspace.h"
#include "../common/output_spec.h"
#include "../common/planned.h"
#include "bodies.h"
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

/* Angles of joints that count turns: see unwrapped_angles.c. */
typedef struct zd_unwrapped_angles {
    int count;
    zd_space_quantity *angle;          /* (count,) marker quantity of each angle */
    zd_vector3 *axis;               /* (count,) in the axes of the marker quantity's first body; zero of a skew universal joint */
    int *joint, *place;             /* (count,) its joint, and its index in p */
} zd_unwrapped_angles;

enum { ZD_SPACE_ARRAYS = 18, ZD_SPACE_OF_MEASURES = 13 };   /* number of arrays of a frame, and the first that measures alone use */

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
    size_t frame_at[ZD_SPACE_ARRAYS + 1];       /* bytes before each array of a frame, and their sum */
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
    double *turns;                  /* angular entries of the point joints' rows, see point_joints.c */
    double *x, *xdot, *out;         /* inputs of user functions, (longest,) each, and their output, (longest + 3,) */
    zd_space_twist *bias;                /* accelerations of bodies of a tree at vdot = 0; NULL: all bodies are free, and have none */
    double *carried;                /* (carrying.scratch,) */
    double *is_placed, *is_moving;  /* for measures, as those that follow: 1 if poses and twists belong to the current state */
    double *is_least, *least;       /* 1 if (m,) multipliers of the least reactions belong to the current state */
    double *row;                    /* (nv,) */
    const double *inputs;           /* values of user functions of forces, if some of these read reactions; else NULL */
} zd_space_frame;

void zd_space_frame_of(const zd_space *space, double *scratch, zd_space_frame *frame);
void zd_space_frame_divide(zd_space *space);     /* sets frame_at, and the sizes of scratch */
/* From coordinates to poses, and from velocities to twists. */
void zd_space_frame_place(const zd_space *space, const zd_space_frame *frame, const double *p);
void zd_space_frame_move(const zd_space *space, const zd_space_frame *frame, const double *v);
/* Marker quantities of a placed frame; their rates need a moving one. */
zd_readings zd_space_frame_readings(const zd_space *space, const zd_space_frame *frame);

/* Unwrapped angles of joints. An attitude determines an angle only up to full turns, so each joint angle is a coordinate of its own. Where
 * bodies are free, and for joints that close loops of a tree, it is a dependent coordinate: integrated by its rate, and after each step set
 * to the angle between both attitudes plus the nearest multiple of 2 pi. Of an inboard joint it is an independent coordinate. */

/* Number of angles among the coordinates of a joint. */
int zd_unwrapped_angles_of(const zd_space_joint *joint);
/* Allocates memory for the given number of joints. */
void zd_unwrapped_angles_create(zd_unwrapped_angles *self, zd_arena *arena, size_t joints);
/* Lists all angles of the joints; the coordinates of dependent ones begin at p[at]. */
void zd_unwrapped_angles_plan(zd_unwrapped_angles *self, int joints, const zd_space_joint *joint, int at);
/* frame->angle <- all joint angles. */
void zd_unwrapped_angles_read(const zd_space *space, const zd_space_frame *frame, const double *p);
/* Direction in global axes along which the relative angular velocity is the rate of angle k. */
zd_vector3 zd_unwrapped_angle_axis(const zd_space *space, const zd_space_frame *frame, int k);
/* pdot (nq,) <- rates of all dependent angles at the velocities x (nv,), from placed bodies. */
void zd_unwrapped_angles_rate(const zd_space *space, const zd_space_frame *frame, const double *x, double *pdot);
/* Updates the dependent angles in p from the attitudes, keeping their full turns. */
void zd_space_follow(const void *data, double *p);

/* The marker quantities of joints. */

/* The marker quantity that a pick of a joint's kind is; an angle counts no turns. */
zd_space_quantity zd_space_picked_quantity(const zd_space_joint *joint, const zd_space_pick *pick);

/* Rows of point joints. */

/* Allocates memory for the given numbers of bodies, joints and rows. */
void zd_point_joints_create(zd_point_joints *self, zd_arena *arena, size_t bodies, size_t joints, size_t rows);
/* Finds the point joints among the rows, after their storage was planned. */
void zd_point_joints_plan(zd_point_joints *self, const zd_space *space);
/* Arms, directions and angular entries of all point joints, from placed bodies. */
void zd_point_joints_turn(const zd_point_joints *self, const zd_space_frame *frame);
/* Phi, C, Phi_t and xi of all point joints, as far as wanted. */
void zd_point_joints_write(const zd_point_joints *self, const zd_space_frame *frame, int want, const zd_terms *out);

/* Products with A and, if all constraints are point joints, with C, without their stored entries. */

extern const zd_operations zd_space_products;       /* products with A only, for any spatial mechanism */
extern const zd_operations zd_point_joint_products;      /* products with A and C, if self->point_joints.are_all */
