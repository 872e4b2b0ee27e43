/* A mechanism in space as the core keeps it: joints turned into rows of gauges, and where their entries are stored. */
#ifndef ZD_SPACE_PLAN_H
#define ZD_SPACE_PLAN_H

#include "../gauges/packed.h"
#include "../gauges/readings.h"
#include "socket.h"
#include "tables.h"

typedef struct zd_planned_joint3 {
    int rows[ZD_SPACE_ROWS];    /* which rows of C are its own */
    int row_count;
} zd_planned_joint3;

struct zd_space {
    zd_vector3 gravity;
    int bodies, joints;
    zd_planned_uses uses;
    const zd_body3 *body;           /* (bodies + 1,) the first one, of the ground, unused */
    const zd_space_joint *joint;
    const zd_planned_joint3 *planned;   /* (joints,) */
    const zd_space_gauge *gauge;    /* those given, then those of the joints' rows */
    const double *period;           /* (m,) */
    zd_packed packed;
    const double *weight;           /* (nv,) of the bodies, as generalized force */
    zd_sockets sockets;
    zd_system system;               /* its data is the mechanism */
    zd_measures measures;
};

/* What a mechanism keeps in a system's scratch while (t, p) stays; then what is made anew for each call. */
typedef struct zd_frame3 {
    zd_pose3 *pose;
    zd_twist3 *twist;
    zd_wrench3 *wrench;
    double *quaternion;             /* (bodies + 1, 4), of the ground and of particles unused */
    zd_sighted *sighted;            /* (sockets,) */
    double *turns;                  /* of the sockets' rows, see sockets.h */
    double *row;                    /* (nv,) of measures alone */
    double *x, *xdot, *out;         /* what a law is told, (longest,), and what it says, (longest + 3,) */
} zd_frame3;

zd_frame3 zd_frame3_of(const zd_space *space, double *scratch);
int zd_frame3_size(const zd_space *space);      /* doubles */
/* The gauges of a frame that is placed, and moving where their rates are asked for. */
zd_readings zd_frame3_readings(const zd_space *space, const zd_frame3 *frame);

#endif
