/* Bodies in space: from coordinates to poses and twists, and from wrenches to generalized forces. */
#pragma once

#include "tables.h"
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

/* Values, rates and unit forces of marker quantities in space. */

typedef struct zd_space_reading {
    double value;
    zd_space_wrench first, second;   /* value's rate = first . twist of the first body + second . twist of the second */
} zd_space_reading;

zd_space_reading zd_space_quantity_read(const zd_space_quantity *quantity, const zd_space_pose *pose);
/* The same with any value, as an angle's takes long. */
zd_space_reading zd_space_quantity_wrenches(const zd_space_quantity *quantity, const zd_space_pose *pose);
/* Value of a marker quantity; one that counts turns takes them from angle (angles,), the joint angles. */
double zd_space_quantity_value(const zd_space_quantity *quantity, const zd_space_pose *pose, const double *angle);
/* The same from its value without turns. */
double zd_space_quantity_counted(const zd_space_quantity *quantity, double value, const double *angle);
/* The angle plus the multiple of 2 pi that is nearest to `near`. */
double zd_with_turns(double angle, double near);
double zd_space_quantity_rate(const zd_space_quantity *quantity, const zd_space_pose *pose, const zd_space_twist *twist);
/* Derivative of the rate with respect to time at vdot = 0, where bodies have the accelerations `bias`; NULL: zero. */
double zd_space_quantity_bias(const zd_space_quantity *quantity, const zd_space_pose *pose, const zd_space_twist *twist,
                              const zd_space_twist *bias);
/* True if a force along it acts on both bodies with opposite force and opposite torque about any point. */
int zd_space_quantity_is_mutual(const zd_space_quantity *quantity);
/* C of enum zd_space_quantity_kind. */
zd_vector3 zd_space_contact(const zd_space_quantity *quantity, const zd_space_pose *pose);
/* Point of a body, from the global origin. */
zd_vector3 zd_space_point_of(const zd_space_pose *pose, const double *point);
