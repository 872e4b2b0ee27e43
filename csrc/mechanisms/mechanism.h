/* Mechanisms from bodies and joints, in the plane: the tables that describe one, and the system that is made from them.
 *
 * Body 0 is the ground; bodies given have the numbers from 1 on. All points are in the axes of their body and from its mass centre (on
 * the ground: in the drawing's axes, from its origin). In joint coordinates each body is carried by a joint of the tree, and has that joint's
 * coordinate; a body that no joint carries has coordinates x, y of its mass centre, and its angle unless it is a particle. Absolute
 * coordinates are the same with an empty tree: then all bodies are free, and all joints are constraints.
 *
 * Plain declarations and nothing else: CFFI reads this very text. SI units, radians.
 */
#ifndef ZD_MECHANISM_H
#define ZD_MECHANISM_H

#include "../joints/joint.h"
#include "link.h"

typedef struct zd_body {
    double mass, inertia;       /* kg, kg m^2 about the mass centre */
    int is_particle;            /* has no angle */
    int carrier;                /* the joint of the tree that carries it; -1: it is free */
} zd_body;

typedef struct zd_joint {
    int kind;                   /* row of the table of joints */
    int first, second;          /* bodies */
    double point1[2], point2[2];
    double axis[2];             /* of length 1, in the first body's axes; where the kind takes none, whatever */
    double along, across;       /* m: what the distances along and across the axis are where the joint says zero */
    double angle;               /* rad: the second's less the first's angle where the joint says zero */
    double length;              /* m: of a rod; the radius of a rolling wheel */
} zd_joint;

typedef struct zd_gauge {
    int kind;                   /* enum zd_gauge_kind */
    int first, second;          /* bodies */
    double point1[2], point2[2];
    double axis[2];             /* of length 1, in the first body's axes */
    double zero;                /* m or rad: taken from the reading */
} zd_gauge;

/* A number that a relation or an effort depends on: a gauge times a coefficient. */
typedef struct zd_gauge_term {
    int gauge;
    double coefficient;         /* of relations without a law; else not looked at */
} zd_gauge_term;

/* One row: a drive by a law of time, a gear, a cam, a constraint or nonholonomic constraint of the user's own. With x_i its gauges:
 *
 *     without a law:  sum_i coefficient_i x_i - constant - slope t = 0
 *     with a law:     g(t, x) = 0, or nonholonomic a_i(t, x) xdot_i + a_0(t, x) = 0 */
typedef struct zd_relation {
    int first, terms;           /* its gauges: from where in the table of terms, and how many */
    int nonholonomic;
    int law;                    /* number that the law function is called with; -1: none */
    double constant, slope;
    int joint;                  /* the joint to whose force and torque it contributes, as its drive; -1: none. Its first gauge is
                                 * then that of the joint's coordinate, and the coefficient of it 1. */
} zd_relation;

enum zd_effort_kind {
    ZD_EFFORT_SPRING,           /* -stiffness x - damping xdot */
    ZD_EFFORT_CONSTANT,         /* value */
    ZD_EFFORT_LAW               /* law(t, x of its terms, xdot of its terms) */
};

/* A force along a gauge: it acts with +effort on the second body and the opposite on the first. */
typedef struct zd_effort {
    int kind;                   /* enum zd_effort_kind */
    int gauge;
    double stiffness, damping;  /* N/m, N s/m; N m/rad, N m s/rad */
    double value;               /* N; N m */
    int law;
    int first, terms;           /* what the law depends on */
    int joint;                  /* the joint to whose force and torque it contributes: its damping, its drive; -1: none */
} zd_effort;

/* What a measure is of. Those of accelerations need vdot and the multipliers. */
enum zd_quantity {
    ZD_VALUES,                  /* of `size` gauges from `index` on: of positions */
    ZD_RATES,                   /* their rates: of velocities */
    ZD_ACCELERATIONS,           /* and their rates */
    ZD_JOINT_FORCE,             /* (2,) N: what the first body does to the second at the joint's point, in the drawing's axes */
    ZD_JOINT_TORQUE,            /* N m */
    ZD_JOINT_TENSION,           /* N: of joint `index`: the force of its first row, positive where it pulls */
    ZD_EFFORT_VALUE,            /* of effort `index`: of accelerations, though it needs none */
    ZD_EFFORT_POWER,            /* W: that it puts in */
    ZD_DRIVE_VALUE,             /* of relation `index`: the effort along the gauge of its term `term`, positive where it drives it up */
    ZD_DRIVE_POWER,
    ZD_EFFORT_FORCE             /* (2,) N: what `size` efforts from `index` on do to their second body, in the drawing's axes */
};

typedef struct zd_observed {
    const char *name, *unit;
    int quantity;               /* enum zd_quantity */
    int index;
    int size;                   /* of values, rates and accelerations: how many gauges; of effort forces: how many efforts */
    double scale;               /* what it is multiplied with: -1 for tensions of springs */
    int term;                   /* of drive values: which of the relation's terms; else 0 */
} zd_observed;

/* A law that somebody else computes; k is the number of its terms. For an effort it writes out[0] alone. For a relation: g, dg/dx_i (k),
 * dg/dt, and d(dg/dx_i)/dt xdot_i + d(dg/dt)/dt; for a nonholonomic one: 0, a_i (k), a_0, and da_i/dt xdot_i + da_0/dt.
 * Returns ZD_DONE, or ZD_CALLBACK where it failed. */
typedef int zd_law(void *owner, int law, double t, const double *x, const double *xdot, double *out);

typedef struct zd_tables {
    double gravity[2];          /* m/s^2 */
    int bodies, joints, gauges, terms, relations, efforts, measures;
    const zd_body *body;        /* (bodies,) from number 1 on */
    const zd_joint *joint;
    const zd_gauge *gauge;
    const zd_gauge_term *term;
    const zd_relation *relation;
    const zd_effort *effort;
    const zd_observed *measure;
    zd_law *law;                /* NULL: there is none */
    void *owner;                /* what it is called with */
    int laws_know_time;         /* whether a law depends on t but through positions and velocities */
} zd_tables;

/* What a row or a coordinate of the system is. */
enum zd_owner { ZD_OF_JOINT, ZD_OF_RELATION };
enum zd_coordinate_kind { ZD_COORDINATE_X, ZD_COORDINATE_Y, ZD_COORDINATE_ANGLE, ZD_COORDINATE_DISPLACEMENT };

typedef struct zd_row_owner {
    enum zd_owner owner;
    int index;                  /* of the joint or relation */
    int component;              /* which row of the joint's kind */
} zd_row_owner;

typedef struct zd_coordinate_owner {
    int body;
    enum zd_coordinate_kind kind;
} zd_coordinate_owner;

typedef struct zd_mechanism zd_mechanism;

/* All memory is taken here, and the tables are copied but for names, which have to stay. On failure returns NULL and says why. */
zd_mechanism *zd_mechanism_create(const zd_tables *tables, char *message, int message_size);
void zd_mechanism_free(zd_mechanism *mechanism);
/* The system; it refers to the mechanism. */
const zd_system *zd_mechanism_system(const zd_mechanism *mechanism);
const zd_row_owner *zd_mechanism_rows(const zd_mechanism *mechanism);                       /* (m,) */
const zd_coordinate_owner *zd_mechanism_coordinates(const zd_mechanism *mechanism);         /* (nq,) */
/* Size in bytes of the data of the system, for a copy of it: see zd_mechanism_with(). */
int zd_mechanism_data_size(void);
/* Writes into `data` what the system's data is, but for the owner of the laws, as each run may have its own, and for the numbers of
 * functions that were written out from the plan: the pointer to these is what the data begins with. */
void zd_mechanism_with(const zd_mechanism *mechanism, void *owner, const double *numbers, void *data);

/* What all joints and elements come down to: links of a tree, rows of gauges, and efforts along gauges. Bodies have the tree's numbers
 * here, in which inner ones come first. */
typedef struct zd_plan {
    const zd_link *link;        /* (bodies + 1,) the first one, of the ground, unused */
    const zd_gauge *gauge;
    const zd_gauge_term *term;
    const zd_relation *row;     /* (m,) holonomic ones first */
    const zd_effort *effort;    /* (efforts,) */
} zd_plan;

zd_plan zd_mechanism_plan(const zd_mechanism *mechanism);

/* Poses (bodies, 3) of mass centres, x, y, angle, and their rates, from the state and back. What joints of the tree forbid is not looked
 * at. `rates` and `v` may be NULL; `scratch` holds system->scratch doubles. */
void zd_mechanism_poses(const zd_mechanism *mechanism, const double *p, const double *v, double *poses, double *rates, double *scratch);
void zd_mechanism_state(const zd_mechanism *mechanism, const double *poses, const double *rates, double *p, double *v);

#endif
