/* A mechanism in space as the core keeps it: joints turned into rows of gauges, and where their entries are stored. */
#ifndef ZD_SPACE_PLAN_H
#define ZD_SPACE_PLAN_H

#include "bodies.h"
#include "tables.h"

typedef struct zd_planned_joint3 {
    int rows[ZD_SPACE_ROWS];    /* which rows of C are its own */
    int row_count;
} zd_planned_joint3;

struct zd_space {
    zd_vector3 gravity;
    int bodies, joints, relations, efforts, mh, m, longest;     /* `longest`: most terms of any row or effort */
    const zd_body3 *body;           /* (bodies + 1,) the first one, of the ground, unused */
    const zd_space_joint *joint;
    const zd_planned_joint3 *planned;   /* (joints,) */
    const zd_space_gauge *gauge;    /* those given, then those of the joints' rows */
    const zd_gauge_term *term;
    const double *coefficient;      /* those of the terms, one after another */
    const zd_relation *row;         /* (m,) of the joints and the relations given, holonomic ones first */
    const double *period;           /* (m,) */
    const zd_row_owner *owner_of_row;   /* (m,) */
    const int *row_of_relation;     /* (relations,) */
    const zd_effort *effort;
    const zd_observed *observed;
    zd_law *law;
    void *owner;
    const int *at;                  /* (m,) where each row begins in C */
    const int *near, *far;          /* (terms,) where in a row the entries of its first and second body begin; -1: it is the ground */
    int size_of_C;                  /* entries that are stored */
    int has_velocity_forces;        /* whether an effort depends on velocities, and is to be told them */
    zd_structure structure;
    zd_system system;               /* its data is the mechanism */
    zd_measures measures;
};

/* What a mechanism keeps in a system's scratch while (t, p) stays; then what is made anew for each call. */
typedef struct zd_frame3 {
    zd_pose3 *pose;
    zd_twist3 *twist;
    zd_wrench3 *wrench;
    double *row;                    /* (nv,) of measures alone */
    double *x, *xdot, *out;         /* what a law is told, (longest,), and what it says, (longest + 3,) */
} zd_frame3;

zd_frame3 zd_frame3_of(const zd_space *space, double *scratch);
int zd_frame3_size(const zd_space *space);      /* doubles */

#endif
