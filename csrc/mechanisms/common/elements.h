/* What gauges are used for, in mechanisms of the plane and of space alike: rows, forces, measures, and the laws that somebody else computes.
 *
 * A gauge is a number that is read off one or two bodies. Which there are and how they are read is known to the room of each kind of
 * mechanism; here a gauge is its number in the table of these.
 *
 * Plain declarations and nothing else: CFFI reads this very text. SI units, radians.
 */
#ifndef ZD_COMMON_ELEMENTS_H
#define ZD_COMMON_ELEMENTS_H

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

/* What a measure is of. Those of accelerations need vdot and the multipliers. Forces and torques have as many components as there are of
 * them, in the drawing's axes. */
enum zd_quantity {
    ZD_VALUES,                  /* of `size` gauges from `index` on: of positions */
    ZD_RATES,                   /* their rates: of velocities */
    ZD_ACCELERATIONS,           /* and their rates */
    ZD_JOINT_FORCE,             /* N: what the first body does to the second at the joint's point */
    ZD_JOINT_TORQUE,            /* N m */
    ZD_JOINT_TENSION,           /* N: of joint `index`: the force of its first row, positive where it pulls */
    ZD_EFFORT_VALUE,            /* of effort `index`: of accelerations, though it needs none */
    ZD_EFFORT_POWER,            /* W: that it puts in */
    ZD_DRIVE_VALUE,             /* of relation `index`: the effort along the gauge of its term `term`, positive where it drives it up */
    ZD_DRIVE_POWER,
    ZD_EFFORT_FORCE,            /* N: what `size` efforts from `index` on do to their second body */
    ZD_EFFORT_TORQUE            /* N m: in space, the moments of such efforts, about the mass centre */
};

typedef struct zd_output_spec {
    const char *name, *unit;
    int quantity;               /* enum zd_quantity */
    int index;
    int size;                   /* of values, rates and accelerations: how many gauges; of effort forces and torques: how many efforts */
    double scale;               /* what it is multiplied with: -1 for tensions of springs */
    int term;                   /* of drive values: which of the relation's terms; else 0 */
} zd_output_spec;

/* A law that somebody else computes; k is the number of its terms. For an effort it writes out[0] alone. For a relation: g, dg/dx_i (k),
 * dg/dt, and d(dg/dx_i)/dt xdot_i + d(dg/dt)/dt; for a nonholonomic one: 0, a_i (k), a_0, and da_i/dt xdot_i + da_0/dt.
 * Returns ZD_DONE, or ZD_CALLBACK where it failed. */
typedef int zd_law(void *owner, int law, double t, const double *x, const double *xdot, double *out);

/* The same, compiled, of numbers that are its own. */
typedef void zd_law_function(const double *numbers, double t, const double *x, const double *xdot, double *out);

typedef struct zd_compiled_law {
    zd_law_function *function;  /* NULL: there is none */
    const double *numbers;
} zd_compiled_law;

typedef struct zd_elements {
    int terms, relations, efforts, measures;
    const zd_gauge_term *term;
    const zd_relation *relation;
    const zd_effort *effort;
    const zd_output_spec *measure;
    zd_law *law;                /* NULL: there is none */
    void *owner;                /* what it is called with */
    int laws_know_time;         /* whether a law depends on t but through positions and velocities */
} zd_elements;

/* What a row of C is. */
enum zd_owner { ZD_OF_JOINT, ZD_OF_RELATION };

typedef struct zd_row_owner {
    enum zd_owner owner;
    int index;                  /* of the joint or relation */
    int component;              /* which row of the joint's kind */
} zd_row_owner;

#endif
