/* Conditions of a start: owners of the constraints, targets, and the outcome of an assembly.
 *
 * Plain declarations only: CFFI parses this text. SI units, radians.
 */
#ifndef ZD_ASSEMBLY_GIVEN_H
#define ZD_ASSEMBLY_GIVEN_H

#include "../../../include/zerodrift/system.h"

/* Owner of a holonomic constraint */
enum zd_assembly_row {
    ZD_ROW_OF_JOINT,
    ZD_ROW_OF_COUPLING,     /* without a user function, as of gears: part of the reference configuration, as joints are */
    ZD_ROW_OF_DRIVE,        /* or of a user's constraint: led from where it is to where it must be */
    ZD_ROW_LEFT_OUT         /* drive whose value at the start is not known yet: ignored in positions */
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

typedef struct zd_assembly_given {
    const zd_system *system;    /* in absolute coordinates, with the measures of the targets */
    const double *inputs;       /* (2 inputs + 1,) or NULL */
    double t, length;           /* s; m: characteristic length */
    const int *is_angle;        /* (nv,): 1 for rates of angles */
    const int *row;             /* (mh,) enum zd_assembly_row */
    int targets;
    const zd_target *target;    /* (targets,) */
    const double *nudge;        /* (nv,) random displacement of about one: at a dead centre no step leads away from it; NULL: none */
    const zd_many_bodies *many; /* NULL: dense matrices */
    int (*interrupted)(void *owner);    /* nonzero: the assembly ends with ZD_CALLBACK; NULL: it is not interrupted */
    void *owner;
    double *residual, *size;    /* (m + targets,): of the conditions that are not met, by sizes, and these sizes; NULL: not wanted */
} zd_assembly_given;

enum zd_assembly_outcome {
    ZD_ASSEMBLED,
    ZD_JOINTS_OPEN,             /* the joints do not close */
    ZD_TARGETS_UNMET            /* drives, couplings and held targets are not met, or contradict each other */
};

#endif
