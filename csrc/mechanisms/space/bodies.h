/* Bodies in space: from coordinates to poses and twists, and from wrenches to generalized forces. */
#ifndef ZD_SPACE_BODIES_H
#define ZD_SPACE_BODIES_H

#include "vectors.h"

typedef struct zd_space_planned_body {
    double mass;
    zd_vector3 inertia;
    int turns;
    int p, v;               /* offsets of its coordinates in p and of its velocities in v */
    int A, M;               /* and what is stored of A and M */
} zd_space_planned_body;

typedef struct zd_space_pose {   /* pose of a mass centre */
    zd_vector3 at;
    zd_rotation turned;
} zd_space_pose;

typedef struct zd_space_twist {
    zd_vector3 speed, spin; /* m/s of the mass centre, and rad/s: in the drawing's axes */
} zd_space_twist;

enum { ZD_BODY_COORDINATES = 7, ZD_BODY_VELOCITIES = 6, ZD_POINT_COORDINATES = 3 };

/* The axes of a body with the attitude q (4,); within a step, whose stages leave the length of q, that of q / |q|. */
zd_rotation zd_rotation_of(const double *q);
/* Half of q times (0, omega), (4, 3) with the columns of omega, in a matrix of so many columns. */
void zd_write_turns(const double *q, int columns, double *A);

/* Arrays (bodies + 1,) begin with the ground. */
void zd_bodies_place(int bodies, const zd_space_planned_body *body, const double *p, zd_space_pose *pose, double *quaternion);
void zd_bodies_move(int bodies, const zd_space_planned_body *body, const zd_space_pose *pose, const double *v, zd_space_twist *twist);
void zd_bodies_write_A(int bodies, const zd_space_planned_body *body, const double *p, double *A);       /* (1), block after block */
void zd_bodies_write_M(int bodies, const zd_space_planned_body *body, double *M);        /* the diagonals, one after another */
void zd_bodies_write_bias(int bodies, const zd_space_planned_body *body, const double *v, double *d);    /* omega x (inertia omega) */
void zd_bodies_gather(int bodies, const zd_space_planned_body *body, const zd_space_pose *pose, const zd_space_wrench *wrench, double *f);
/* own += what `scale` times the wrench on a body does to its velocities. */
void zd_body_act(const zd_space_planned_body *body, const zd_space_pose *pose, double scale, zd_space_wrench what, double *own);

#endif
