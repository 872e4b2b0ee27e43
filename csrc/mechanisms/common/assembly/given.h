/* Conditions of a start: roles of the constraints, targets, and the outcome of an assembly.
 *
 * Plain declarations only: CFFI parses this text. SI units, radians.
 */
#pragma once

#include "../../../include/zerodrift/system.h"

/* Role of a holonomic constraint in an assembly */
enum zd_constraint_role {
    ZD_ROLE_JOINT,
    ZD_ROLE_COUPLING,       /* without a user function, as of gears: part of the reference configuration, as joints are */
    ZD_ROLE_DRIVE,          /* or constraint of a user: led from its present value to the prescribed one */
    ZD_ROLE_IGNORED         /* in positions: a drive whose value at the start is not known yet, a joint that may stay open */
};

enum zd_target_role {
    ZD_TARGET_HELD,
    ZD_TARGET_STAYS,        /* met if possible; of positions the value is that of the assembled reference configuration */
    ZD_TARGET_WISHED,       /* approached as nearly as all others allow */
    ZD_TARGET_DRAWN         /* coordinate of the reference configuration that keeps its value while joints close, as driven ones do */
};

/* Component of a measure of positions or velocities, and the value that the start prescribes. In the order of their roles. */
typedef struct zd_target {
    int measure, component, is_rate;
    double value;
    int role;
} zd_target;

/* Components of measures of positions, which (count, 2) <- measure and component, as zd_plane_components() finds them */
typedef void (*zd_components)(const void *mechanism, const double *p, const double *v, int count, const int *which, double *value, int *at,
                              double *row, double *scratch);

/* Mechanism of many free bodies with mass, which is assembled without dense matrices */
typedef struct zd_many_bodies {
    const void *mechanism;
    zd_components components;
    int width;                  /* velocities of a body, at most */
} zd_many_bodies;

typedef struct zd_assembly_problem {
    const zd_system *system;    /* in absolute coordinates, with the measures of the targets */
    const double *inputs;       /* (2 inputs + 1,) or NULL */
    double t, length;           /* s; m: characteristic length */
    const int *role;            /* (mh,) enum zd_constraint_role */
    int targets;
    const zd_target *target;    /* (targets,) */
    const double *nudge;        /* (nv,) random displacement of about one: at a dead centre no step leads away from it; NULL: none */
    const zd_many_bodies *many; /* NULL: dense matrices */
    int (*interrupted)(void *owner);    /* nonzero: the assembly ends with ZD_CALLBACK; NULL: it is not interrupted */
    void *owner;
    double *residual, *size;    /* (m + targets,): of the conditions that are not met, by sizes, and these sizes; NULL: not wanted */
} zd_assembly_problem;

enum zd_assembly_outcome {
    ZD_ASSEMBLED,
    ZD_JOINTS_OPEN,             /* the joints do not close */
    ZD_TARGETS_UNMET            /* drives, couplings and held targets are not met, or contradict each other */
};

/* Displacements (nv,): places move, and bodies turn about an axis of their own by the length of a rotation vector. */

/* Absolute coordinates: those of M are rates of p, except that quaternions (scalar first) change by angular velocities in body axes.
 * to (nq,) <- p after the displacement x; not p itself. Dependent angles stay on their turns. */
void zd_displace(const zd_system *system, const double *p, const double *x, double *to);
/* x (nv,) <- displacement from `other` to p, by the shorter rotation of each body */
void zd_displacement(const zd_system *system, const double *p, const double *other, double *x);

/* Assembly: from a reference configuration to positions in which all joints are closed, and velocities that they allow.
 *
 * The unknowns are absolute coordinates, of the mass centres, so that the start is the same whatever coordinates a simulation takes. Steps
 * are measured in rad and parts of the mechanism's length, and have minimum norm in the mass metric. Rows may be redundant. */

/* Each returns an outcome, or a negative status of the core: no memory, or a failed evaluation of the system. p (nq,). */

/* Nearest positions that satisfy all constraints and held targets, and approach wished ones; p: the reference configuration on entry */
int zd_assemble_positions(const zd_assembly_problem *given, double *p);
/* Positions that satisfy drives and held targets, led there from closed ones, while staying targets keep their values. */
int zd_assembly_lead(const zd_assembly_problem *given, double *p);
/* Nearest positions that satisfy all constraints, by Newton's method; p is unchanged without these. */
int zd_assembly_project(const zd_assembly_problem *given, double *p);
/* Positions in which the sum of squares of the residuals of all constraints, in m and rad, is least */
int zd_assembly_minimize(const zd_assembly_problem *given, double *p);
/* ZD_ASSEMBLED if p satisfies all constraints and held targets */
int zd_assembly_check(const zd_assembly_problem *given, const double *p);
/* v (nv,) <- minimum-norm velocities that satisfy all constraints and held targets and approach wished ones */
int zd_assemble_velocities(const zd_assembly_problem *given, const double *p, double *v);
/* message <- sentence on the drives that bring a motion at p to a dead point within a time `ahead` in s; otherwise it is unchanged.
 * measure (mh,): of the coordinate that each constraint drives; -1: none, or it is not known. given->role is ignored. */
int zd_assembly_explain_reach(const zd_assembly_problem *given, const double *p, const int *measure, double ahead, char *message,
                              int message_size);
