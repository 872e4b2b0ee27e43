/* A mechanism in space as the core keeps it: joints turned into rows of gauges, and where their entries are stored. */
#ifndef ZD_SPACE_PLAN_H
#define ZD_SPACE_PLAN_H

#include "../common/packed.h"
#include "../common/readings.h"
#include "gauge.h"
#include "point_joint_tables.h"
#include "tables.h"

typedef struct zd_space_planned_joint {
    int rows[ZD_SPACE_ROWS];    /* which rows of C are its own */
    int row_count;
    int carried;                    /* the body that it carries, and then it has no rows; 0: none */
    int sign;                       /* 1: that is its second body, -1: its first */
    int angles;                     /* how many the joints before it have */
} zd_space_planned_joint;

struct zd_space_frame;

/* How bodies move that joints carry, in the place of free ones. */
typedef struct zd_carrying {
    void (*place)(const zd_space *self, const struct zd_space_frame *frame, const double *p);
    void (*move)(const zd_space *self, const struct zd_space_frame *frame, const double *v);     /* and frame->bias */
    /* row += what `scale` times a unit force along a gauge does to the velocities */
    void (*act)(const zd_space *self, const struct zd_space_frame *frame, const zd_space_gauge *gauge, double scale, const zd_space_reading *reading,
                double *row);
    /* reaction += what a joint that carries a body does to its second one, about a point. Returns ZD_DONE or ZD_CALLBACK. */
    int (*transmit)(const zd_space *self, const struct zd_space_frame *frame, int joint, zd_vector3 point, double t, const double *vdot,
                    const double *lambda, zd_space_wrench *reaction);
    int scratch;                    /* doubles that it keeps behind all else of the frame */
    void *tree;                     /* what it knows; released with the mechanism */
} zd_carrying;

/* Angles of joints that count turns: see unwrapped_angles.h. */
typedef struct zd_unwrapped_angles {
    int count;
    zd_space_gauge *angle;          /* (count,) what reads it */
    zd_vector3 *axis;               /* (count,) in the axes of the gauge's first body */
    int *joint, *place;             /* (count,) of which joint it is, and which entry of p has it */
} zd_unwrapped_angles;

struct zd_space {
    const double *numbers;          /* of functions that were written out from the plan; NULL: there are none */
    zd_vector3 gravity;
    int bodies, joints;
    zd_planned_elements elements;
    const zd_space_planned_body *body;           /* (bodies + 1,) the first one, of the ground, unused */
    const zd_space_joint *joint;
    const zd_space_planned_joint *planned;   /* (joints,) */
    const zd_space_gauge *gauge;    /* those given, then those of the joints' rows */
    zd_packed packed;
    const double *weight;           /* (nv,) of the bodies, as generalized force */
    zd_point_joints point_joints;
    zd_carrying carrying;           /* its functions are NULL where all bodies are free */
    zd_unwrapped_angles unwrapped;
    zd_system system;               /* its data is the mechanism */
    zd_measures measures;
};

/* What a mechanism keeps in a system's scratch while (t, p) stays; then what is made anew for each call. */
typedef struct zd_space_frame {
    zd_space_pose *pose;
    zd_space_twist *twist;
    zd_space_wrench *wrench;
    double *quaternion;             /* (bodies + 1, 4), of the ground and of particles unused */
    double *angle;                  /* (turns,) of joints */
    zd_arms *arms;                  /* (sockets,), and so are these: */
    zd_directions *directions;
    double *turns;                  /* of the sockets' rows, see point_joints.h */
    double *is_placed, *is_moving;  /* of measures alone: whether poses and twists are those of the state */
    double *row;                    /* (nv,) of measures alone */
    double *x, *xdot, *out;         /* what a law is told, (longest,), and what it says, (longest + 3,) */
    zd_space_twist *bias;                /* of carried bodies: their accelerations where vdot is zero; NULL: all are free, and have none */
    double *carried;                /* (carrying.scratch,) */
} zd_space_frame;

zd_space_frame zd_space_frame_of(const zd_space *space, double *scratch);
int zd_space_frame_size(const zd_space *space);      /* doubles */
/* From coordinates to poses, and from velocities to twists. */
void zd_space_frame_place(const zd_space *space, const zd_space_frame *frame, const double *p);
void zd_space_frame_move(const zd_space *space, const zd_space_frame *frame, const double *v);
/* The gauges of a frame that is placed, and moving where their rates are asked for. */
zd_readings zd_space_frame_readings(const zd_space *space, const zd_space_frame *frame);

#endif
