/* The kinematics of a tree of bodies in the plane: from coordinates outward to bodies, from forces on bodies inward to coordinates.
 *
 * Bodies are numbered so that parents come before children; 0 is the ground. Angles of bodies that turn are their
 * own coordinates, measured from the ground, so that a torque on such a body reaches its own coordinate alone, while a force goes on to the
 * bodies further in. Constraints, springs and drives are not used here.
 */
#pragma once

#include "../../linalg/small.h"
#include "elements.h"
#include "tables.h"

/* Vectors of the plane. */

/* Force at a body's mass centre, and torque. */
typedef struct zd_plane_wrench {
    zd_vector force;
    double torque;
} zd_plane_wrench;

ZD_INLINE zd_vector zd_plus(zd_vector a, zd_vector b) { return (zd_vector){a.x + b.x, a.y + b.y}; }
ZD_INLINE zd_vector zd_minus(zd_vector a, zd_vector b) { return (zd_vector){a.x - b.x, a.y - b.y}; }
ZD_INLINE zd_vector zd_times(double s, zd_vector a) { return (zd_vector){s * a.x, s * a.y}; }
ZD_INLINE double zd_inner(zd_vector a, zd_vector b) { return a.x * b.x + a.y * b.y; }
ZD_INLINE double zd_cross(zd_vector a, zd_vector b) { return a.x * b.y - a.y * b.x; }

/* turn x a, of a rotation about the axis that points out of the plane */
ZD_INLINE zd_vector zd_turned(double turn, zd_vector a) { return (zd_vector){-turn * a.y, turn * a.x}; }

ZD_INLINE zd_vector zd_rotated(double cosine, double sine, zd_vector a)
{
    return (zd_vector){cosine * a.x - sine * a.y, sine * a.x + cosine * a.y};
}

ZD_INLINE void zd_plane_add_wrench(zd_plane_wrench *to, double s, zd_plane_wrench what)
{
    to->force = zd_plus(to->force, zd_times(s, what.force));
    to->torque += s * what.torque;
}

typedef struct zd_plane_tree {
    int bodies;             /* without the ground */
    int nv;
    const zd_plane_link *link;    /* (bodies + 1,) the first one unused */
    int angles;             /* number of bodies that have an angle among the coordinates */
    const int *angle;       /* (angles,) which coordinates these are, in the order of bodies */
} zd_plane_tree;

typedef struct zd_plane_pose {    /* pose of a mass centre */
    zd_vector at;
    double angle, cosine, sine;
    zd_vector near, far;    /* vectors `near` and `far` of the link in global axes; `near` includes the displacement */
    zd_vector axis;
} zd_plane_pose;

typedef struct zd_plane_twist {
    zd_vector speed, bias;  /* m/s of the mass centre, and its acceleration where vdot is zero; the angle's is always zero then */
    double turn;            /* rad/s */
} zd_plane_twist;

typedef struct zd_spin {    /* an acceleration */
    zd_vector speed;
    double turn;
} zd_spin;

typedef struct zd_plane_composite {   /* a body with all that hangs on it, as it moves with the body's own joint */
    zd_vector first;        /* kg m: its mass times the way from the body's mass centre to its own */
    double inertia;         /* kg m^2 about the body's mass centre */
} zd_plane_composite;

/* memory <- all angles, their sines and their cosines, (3, angles), which are computed side by side. */
void zd_plane_tree_turn(const zd_plane_tree *tree, const double *p, double *memory);
/* Poses, with what zd_plane_tree_turn() wrote. */
void zd_plane_tree_place(const zd_plane_tree *tree, const double *p, const double *memory, zd_plane_pose *pose);
void zd_plane_tree_move(const zd_plane_tree *tree, const zd_plane_pose *pose, const double *v, zd_plane_twist *twist);
void zd_plane_tree_accelerate(const zd_plane_tree *tree, const zd_plane_pose *pose, const zd_plane_twist *twist, const double *vdot,
                              zd_spin *spin);
/* row += what `scale` times the wrench on one body does to the coordinates. */
void zd_plane_tree_inward(const zd_plane_tree *tree, const zd_plane_pose *pose, int body, double scale, zd_plane_wrench what, double *row);
/* own += what that does to the coordinates of a body that is free. */
void zd_plane_tree_act_on_free(const zd_plane_link *link, double scale, zd_plane_wrench what, double *own);
/* to (nv,) += what the wrenches on all bodies do to the coordinates; the wrenches are used up. */
void zd_plane_tree_gather(const zd_plane_tree *tree, const zd_plane_pose *pose, zd_plane_wrench *wrench, double *to);
/* wrench <- what has to come through each body's own joint, where it is what each body needs by itself. */
void zd_plane_tree_transmit(const zd_plane_tree *tree, const zd_plane_pose *pose, zd_plane_wrench *wrench);
/* M (nv, nv), which is zero before */
void zd_plane_tree_mass(const zd_plane_tree *tree, const zd_plane_pose *pose, zd_plane_composite *composite, double *M);

/* Values, rates and unit forces of marker quantities in the plane. */

typedef struct zd_plane_reading {
    double value;
    zd_plane_wrench first, second;    /* value's rate = first . twist of the first body + second . twist of the second */
} zd_plane_reading;

zd_plane_reading zd_plane_quantity_read(const zd_plane_quantity *quantity, const zd_plane_pose *pose);
/* Returns the rate; bias <- its derivative by time at vdot = 0. */
double zd_plane_quantity_rate(const zd_plane_quantity *quantity, const zd_plane_pose *pose, const zd_plane_twist *twist, double *bias);
/* Point of a marker quantity or joint on one of its bodies, from the global origin. */
zd_vector zd_point_of(const zd_plane_pose *pose, const double *point);
