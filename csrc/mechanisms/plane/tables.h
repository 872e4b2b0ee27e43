/* Planar mechanisms of bodies and joints: the tables that describe one, and the system that is created from them.
 *
 * Body 0 is the ground; bodies given have the numbers from 1 on. All points are in the axes of their body and from its mass centre (on
 * the ground: in global axes, from the global origin). In joint coordinates each body has the coordinate
 * of its inboard joint; a body without one is free and has coordinates x, y of its mass centre, and its angle unless it is a particle.
 * Absolute coordinates are the same with an empty tree: all bodies are free, and all joints are constraints.
 *
 * Plain declarations only: CFFI parses this text. SI units, radians.
 */
#pragma once

#include "../common/elements.h"
#include "elements.h"

typedef struct zd_plane_body {
    double mass, inertia;       /* kg, kg m^2 about the mass centre */
    int is_particle;            /* has no angle */
    int inboard;                /* its inboard joint; -1: it is free */
} zd_plane_body;

typedef struct zd_plane_joint {
    int kind;                   /* index in the table of joints */
    int first, second;          /* bodies */
    double point1[2], point2[2];
    double axis[2];             /* unit vector in the first body's axes; ignored where the kind takes none */
    double along, across;       /* m: distances along and across the axis in the joint's zero position */
    double angle;               /* rad: angle of the second body minus that of the first in the zero position */
    double length;              /* m: of a rod; the radius of a rolling wheel */
} zd_plane_joint;

typedef struct zd_plane_quantity {
    int kind;                   /* enum zd_plane_quantity_kind */
    int first, second;          /* bodies */
    double point1[2], point2[2];
    double axis[2];             /* unit vector in the first body's axes */
    double zero;                /* m or rad: subtracted from the value */
} zd_plane_quantity;

typedef struct zd_plane_tables {
    double gravity[2];          /* m/s^2 */
    int bodies, joints, quantities;
    const zd_plane_body *body;        /* (bodies,) from number 1 on */
    const zd_plane_joint *joint;
    const zd_plane_quantity *quantity;
    zd_elements elements;
} zd_plane_tables;

/* Kinds of coordinates of the system. */
enum zd_plane_coordinate_kind { ZD_COORDINATE_X, ZD_COORDINATE_Y, ZD_COORDINATE_ANGLE, ZD_COORDINATE_DISPLACEMENT };

typedef struct zd_plane_coordinate_owner {
    int body;
    enum zd_plane_coordinate_kind kind;
} zd_plane_coordinate_owner;

typedef struct zd_plane zd_plane;

/* Allocates all memory and copies the tables, except names, which must outlive the mechanism. Returns NULL on failure, with the reason in
 * `message`. */
zd_plane *zd_plane_create(const zd_plane_tables *tables, char *message, int message_size);
void zd_plane_free(zd_plane *mechanism);
/* The system; it refers to the mechanism. */
const zd_system *zd_plane_system(const zd_plane *mechanism);
const zd_constraint_owner *zd_plane_rows(const zd_plane *mechanism);                       /* (m,) */
const zd_plane_coordinate_owner *zd_plane_coordinates(const zd_plane *mechanism);         /* (nq,) */
/* Size in bytes of the data of the system, for a copy of it: see zd_plane_with(). */
int zd_plane_data_size(void);
/* Copies the system's data into `data`, with the run's own owner of user functions, user functions as expressions (NULL: none), and inputs of
 * generated functions. The pointer to these inputs is the first member of the data. */
void zd_plane_with(const zd_plane *mechanism, void *owner, const zd_law_program *program, const double *numbers, void *data);
/* zd_switches.evaluate() */
void zd_plane_compare(const void *data, double t, const double *p, const double *v, double *value, double *scratch);

/* Planned form of all joints and elements: links of a tree, rows, and generalized forces along marker quantities. Bodies are numbered as in
 * the tree, parents before children. */
typedef struct zd_plane_plan {
    const zd_plane_link *link;        /* (bodies + 1,) the first one, of the ground, unused */
    const zd_plane_quantity *quantity;
    const zd_quantity_term *term;
    const zd_relation *row;     /* (m,) holonomic ones first */
    const zd_generalized_force *force;    /* (generalized forces,) */
} zd_plane_plan;

zd_plane_plan zd_plane_planned(const zd_plane *mechanism);

/* Poses (bodies, 3) of mass centres, x, y, angle, and their rates, from the state and back. Motion that joints of the tree do not allow is
 * ignored. `rates` and `v` may be NULL; `scratch` holds system->scratch doubles. */
void zd_plane_poses(const zd_plane *mechanism, const double *p, const double *v, double *poses, double *rates, double *scratch);
void zd_plane_state(const zd_plane *mechanism, const double *poses, const double *rates, double *p, double *v);

/* Components of measures of positions and velocities, which (count, 2) <- measure and component, all at one state in absolute coordinates:
 * value (count,); where the velocities of the two bodies begin that each touches, at (count, 2), or -1 for the ground; and what zd_measured
 * has as its row at these, row (count, 2, 3). The cost is in proportion to bodies and components;
 * `scratch` holds measures->scratch doubles. */
void zd_plane_components(const void *mechanism, const double *p, const double *v, int count, const int *which, double *value,
                             int *at, double *row, double *scratch);

/* Consistency of the tables of a planar mechanism. */

/* Returns 1, or 0 with the violated rule in `message`. */
int zd_plane_tables_are_right(const zd_plane_tables *tables, char *message, int message_size);

/* Characteristic length of a mechanism. */

double zd_plane_tables_length(const zd_plane_tables *tables);     /* m */
