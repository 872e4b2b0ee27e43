/* Elements of mechanisms, common to plane and space: constraint rows, generalized forces and measures, all in terms of
 * marker quantities, with or without user functions.
 *
 * A marker quantity is a distance, an angle, a displacement along an axis or a velocity between markers on one or two bodies. The rooms of
 * plane and space define their kinds; here a marker quantity is an index in the mechanism's table of them.
 *
 * Plain declarations only: CFFI parses this text. SI units, radians.
 */
#pragma once

#include "../../laws/program.h"
#include "../../include/zerodrift/system.h"

/* Input of a relation or a generalized force: a marker quantity times a coefficient. */
typedef struct zd_quantity_term {
    int quantity;
    double coefficient;         /* factor of the marker quantity in a relation without a user function; otherwise ignored */
} zd_quantity_term;

/* Driving, coupling or user constraint, one row of C: a drive, a gear, a cam, a nonholonomic constraint. With x_i its marker quantities:
 *
 *     without a user function:  sum_i coefficient_i x_i - constant - slope t = 0
 *     with a user function:     g(t, x) = 0, or nonholonomic a_i(t, x) xdot_i + a_0(t, x) = 0 */
typedef struct zd_relation {
    int first, terms;           /* its inputs: first entry in the table of terms, and their number */
    int nonholonomic;
    int law;                    /* index of its user function; -1: none */
    double constant, slope;
    int joint;                  /* the joint that it drives, whose reaction includes its force; -1: none. Its first marker quantity is then
                                 * that of the joint's coordinate, with coefficient 1. */
} zd_relation;

enum zd_force_kind {
    ZD_FORCE_SPRING,           /* -stiffness x, with x of its term, if it has one; each kind less damping xdot */
    ZD_FORCE_CONSTANT,         /* value */
    ZD_FORCE_LAW,              /* user function of t, and of x and xdot of its terms */
    ZD_FORCE_SEPARATION        /* stiffness times the size of the force of relation `first` along its value: between teeth. It does no
                                * work, so the reaction of `joint` contains it, and nothing else. */
};

/* Generalized force along a marker quantity: it acts on the second body, and its opposite on the first. */
typedef struct zd_generalized_force {
    int kind;                   /* enum zd_force_kind */
    int quantity;
    double stiffness, damping;  /* N/m, N s/m; N m/rad, N m s/rad */
    double value;               /* N; N m */
    int law;
    int first, terms;           /* inputs of the user function: first entry in the table of terms, and their number */
    int joint;                  /* the joint whose reaction includes it, as its damping, drive or torsion spring; -1: none */
} zd_generalized_force;

/* Kinds of measures. Those of accelerations need vdot and the multipliers. Forces and torques have two or three components and one or
 * three, in global axes. */
enum zd_output_kind {
    ZD_VALUES,                  /* values of `size` marker quantities from `index` on; depends on positions */
    ZD_RATES,                   /* their rates; depends on velocities */
    ZD_ACCELERATIONS,           /* their second derivatives; depends on accelerations */
    ZD_JOINT_FORCE,             /* N: force of the first body on the second at the joint's point; with those of the `term` joints that follow,
                                 * the parts of one contact */
    ZD_JOINT_TORQUE,            /* N m */
    ZD_JOINT_TENSION,           /* N: force of the first row of joint `index`, positive in tension */
    ZD_FORCE_VALUE,            /* value of generalized force `index`; evaluated with the accelerations, although it does not depend on them */
    ZD_FORCE_POWER,            /* W: power of generalized force `index`, positive if it adds energy */
    ZD_DRIVE_VALUE,             /* N or N m: force of relation `index` along the marker quantity of its term `term`, positive where it
                                 * drives the value up */
    ZD_DRIVE_POWER,
    ZD_FORCE_SUM,            /* N: sum of the forces of `size` generalized forces from `index` on, on their second body */
    ZD_TORQUE_SUM,           /* N m: sum of their moments about that body's mass centre, in space */
    ZD_FORMULA,              /* user function `index` of t and of components of other measures: `size` entries of the table of terms from
                              * `term` on, whose quantity is the measure and whose coefficient the component */
    ZD_SUM,                  /* sums of marker quantities times coefficients: of the `size` entries of the table of terms from `term` on,
                              * each `index` are a component. A quantity -1 has the value 1. */
    ZD_SUM_OF_RATES,
    ZD_SUM_OF_ACCELERATIONS,
    ZD_ANGULAR_MOMENTUM,     /* about the origin, of bodies with `index` terms each, `size` in all: positions of the mass centre with the
                              * mass, and angles or spins about principal axes with the moments of inertia; 0: no such body */
    ZD_INERTIA_TORQUE        /* its rate less the moment of gravity, whose components are the last terms, with the quantity -1 */
};

enum { ZD_MAX_READS = 32, ZD_MAX_COMPONENTS = 9 };     /* largest number of components that a formula reads, and of a measure that it reads */

typedef struct zd_output_spec {
    const char *name, *unit;
    int kind;                   /* enum zd_output_kind */
    int index;
    int size;                   /* number of marker quantities (values, rates, accelerations), of generalized forces (sums of them), of
                                 * what a formula reads, or of the terms of sums of marker quantities */
    double scale;               /* factor of the measured value: -1 for tensions of springs */
    int term;                   /* for drive values: term of the relation, or their number, for the value; for forces of joints the number of
                                 * further joints; for joint torques 1: about the point of the first body; otherwise 0 */
} zd_output_spec;

/* User function, computed outside the core; k is the number of its terms. Reactions that it reads follow its terms in x. For a generalized
 * force it writes out[0] alone. For a holonomic relation: g, dg/dx_i (k), dg/dt, and d(dg/dx_i)/dt xdot_i + d(dg/dt)/dt; for a nonholonomic
 * one: 0, a_i (k), a_0, and da_i/dt xdot_i + da_0/dt. Returns ZD_DONE; ZD_NOT_FINITE if a number is not finite at this state, or ZD_CALLBACK
 * if it failed. */
typedef int zd_law(void *owner, int law, double t, const double *x, const double *xdot, double *out);

/* User function as expressions, with its own parameters `numbers`. */
typedef struct zd_law_program {
    const zd_expressions *expressions;      /* NULL: there are none */
    const double *numbers;
    int has_ends;               /* 1 if it may have a table whose ends are an error */
    const zd_expressions *differences;      /* Differences of the sides of comparisons at which it jumps; NULL: none */
    const double *numbers_of_differences;   /* their own parameters */
    int first_difference;       /* index of the first among those of all user functions */
} zd_law_program;

/* Origin of a row of C: a joint, or a relation (drive, coupling, user constraint). */
enum zd_owner { ZD_OF_JOINT, ZD_OF_RELATION };

/* A zd_group by the owner of its rows, with the same members. */
typedef struct zd_element_group {
    const char *name;
    int owner, index;           /* enum zd_owner, and index of the joint or relation */
    int component, rows;        /* first row of the joint, in the order of its kind, and their number */
    int kind, sign, is_active, normal;
    int load_joint, load_component, loads;      /* joint of the rows of the load, the first of them, and their number */
    double load_factor[4];
    int at_ends;
    double scale, value, restitution;
    double friction[2];
    int range, opposite;        /* range: 1 + relation of the coordinate along a bounded shape */
    double lower, upper;        /* limits of that coordinate */
} zd_element_group;

enum { ZD_MAX_LEAST = 200 };       /* largest number of constraints for which reactions are the least ones: work grows with its cube */

typedef struct zd_elements {
    int terms, relations, forces, measures;
    const zd_quantity_term *term;
    const zd_relation *relation;
    const zd_generalized_force *force;
    const zd_output_spec *measure;
    zd_law *law;                /* NULL: there is none */
    void *owner;                /* first argument of `law` */
    const zd_law_program *program;      /* by index of the user function: expressions, used instead of `law`. NULL: there are none */
    double length;              /* m: that moments are divided by in the sum that the least reactions minimize; 0: 1 m */
    int laws_know_time;         /* 1 if a user function depends on t explicitly, not only through positions and velocities */
    const zd_reading *reading;  /* without evaluate(); NULL: no user function reads reactions */
    int groups;
    const zd_element_group *group;
} zd_elements;

typedef struct zd_constraint_owner {
    enum zd_owner owner;
    int index;                  /* index of the joint or relation */
    int component;              /* row of the joint, in the order of its kind */
} zd_constraint_owner;
