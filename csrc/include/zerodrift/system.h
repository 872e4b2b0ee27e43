/* The system interface: all declarations shared by the core and separately compiled systems. Statuses and terms stand in terms.h, optional
 * members of a system in structure.h, closed_form.h, derivatives.h and here.
 *
 *     #include <zerodrift/system.h>           in the folder returned by zerodrift.get_include()
 *     const int zd_interface_version = ZD_INTERFACE_VERSION;
 *
 *     int pendulum(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
 *     {
 *         const double *q = data;             the parameters, in the order of their names in Python
 *         if (want & ZD_M) ...                out->M[...]
 *         return ZD_DONE;
 *     }
 *
 * A shared library with both is loaded by zerodrift.native("library.so", symbol="pendulum", ...), which declares sizes and terms.
 * One with a `const zd_kind zd_kind_pendulum` instead declares all of it itself, as the built-in systems do.
 *
 * Declarations only: CFFI reads this text after the preprocessor. Equation numbers are those of W. Blajer,
 * "Elimination of Constraint Violation and Accuracy Aspects in Numerical Simulation of Multibody Systems", Multibody System Dynamics 7 (2002)
 * 265-284. Matrices are row-major; SI units throughout.
 *
 *     nq  coordinates p       mh  holonomic rows of Phi         m = mh + mn  rows of C
 *     nv  velocities v        mn  nonholonomic rows             r = nv - m   columns of D
 */
#ifndef ZERODRIFT_SYSTEM_H
#define ZERODRIFT_SYSTEM_H

#include <stdint.h>

#include "closed_form.h"
#include "derivatives.h"
#include "structure.h"
#include "terms.h"

/* Changes with any declaration here and in these headers that compiled code depends on. */
enum { ZD_INTERFACE_VERSION = 12 };

/* ---- measures, inputs, groups ---- */

/* Named functions of the motion, such as the position of a point or the force in a joint. */
typedef struct zd_measure {
    const char *name;       /* "crank.angle" */
    const char *unit;       /* unit of each component */
    int size;               /* number of components */
    enum zd_depends depends;
} zd_measure;

/* Constant forces and torques along measures of positions or velocities, besides the forces of the system, which do not contain them */
typedef struct zd_efforts {
    int count;
    const int *along;       /* (count, 3) index and component of a measure, and the joint whose coordinate that is, -1: none */
    const double *effort;   /* (count,) N or N m, conjugate to its rate */
} zd_efforts;

typedef struct zd_measured {    /* memory for the results; NULL: not requested */
    double *value;          /* (size,) */
    double *rate;           /* (size,) time derivative of a measure of positions: jacobian v + explicit time derivative */
    double *jacobian;       /* (size, nv) for a measure of positions: d rate / d v; of velocities: d value / d v */
    double *bias;           /* (size,) second (positions) or first (velocities) time derivative minus jacobian vdot */
    double *least;          /* (m,) multipliers of the least reactions, alone: for a measure of accelerations */
    double *redundant;      /* (size, m) changes by redundant multipliers, a column each, relative to the norm of those of all wrenches */
    int is_least;           /* 1: the multipliers given are taken for those of the least reactions */
    int is_same_state;      /* 1: all but measure and results as in the previous call, so that values in scratch may be reused; 2: t and p */
    const zd_efforts *efforts;      /* efforts that act at the state, for a measure of accelerations; NULL: none */
} zd_measured;

typedef struct zd_measures {
    int count;
    const zd_measure *measure;      /* (count,) */
    int scratch;            /* doubles that a call needs */
    /* vdot and lambda may be NULL if the measure does not depend on them */
    int (*evaluate)(const void *data, const double *inputs, int measure, double t, const double *p, const double *v, const double *vdot,
                    const double *lambda, const zd_measured *out, double *scratch);
} zd_measures;

/* An input: a number that the caller sets between steps, such as a control. It is not a parameter. Functions of the system receive the
 * values of all n inputs as an array, inputs (2 n + 1,), that is constant in a step and NULL without inputs:
 *
 *     inputs[i]       value at the time inputs[2 n], at which the step begins
 *     inputs[n + i]   rate; of an effort 0
 *
 * So the value at t is inputs[i] + inputs[n + i] * (t - inputs[2 n]), and that of an effort inputs[i] itself. Efforts may occur in f and
 * power only, speeds also in Phi_t and xi; no other term depends on inputs. */
enum zd_input_kind {
    ZD_EFFORT,              /* force or torque: constant in a step */
    ZD_SPEED                /* prescribed speed: linear in time in a step */
};

typedef struct zd_input {
    const char *name;       /* "motor.torque" */
    const char *unit;
    enum zd_input_kind kind;
    double initial;
} zd_input;

/* Generalized forces by user functions u (functions,), some of which read reactions and accelerations r (count,): components of measures.
 * A system that has them gets u as `inputs`, in place of the array above. At a state f, power and measures are affine in u, and no other
 * term depends on it; the core solves r = R(u(r)) with the accelerations. */
typedef struct zd_read_reaction {
    int measure, component;
} zd_read_reaction;

typedef struct zd_read {
    int function, reaction; /* indices of a user function, and of a reaction that it reads */
} zd_read;

typedef struct zd_reading {
    int functions, count, reads;
    const zd_read_reaction *reaction;   /* (count,) */
    const zd_read *read;    /* (reads,) in the order of the user functions */
    const char *const *name;    /* (functions,) for messages: "torque of motor 'drive'" */
    /* u <- user function at a state, with r (count,); 0 if it is that of a constraint. `scratch` is that of the measures; is_same_state:
     * as in zd_measured. Returns as evaluate() does. */
    int (*evaluate)(const void *data, int function, double t, const double *p, const double *v, const double *r, int is_same_state,
                    double *u, double *scratch);
} zd_reading;

/* Constraints that are switched on and off together, such as those of a latch, a stop or a contact. Rows outside all groups are always
 * active. With g = sign (Phi - value) the gap of a one-sided row, its force on g is N = -sign lambda. */
enum zd_group_kind {
    ZD_TWO_SIDED,           /* rows of a joint that is released and joined, all holonomic or all nonholonomic */
    ZD_ONE_SIDED,           /* one holonomic row: g >= 0, N >= 0, and one of them zero; within a range, where it has one */
    ZD_FRICTION,            /* one row, or two along perpendicular directions, a slip velocity C v + Phi_t: zero, or a force against it.
                             * Its Phi is not read. */
    ZD_ONE_WAY              /* one row: as one-sided, with the rate C v + Phi_t in the place of Phi, which is not read; no restitution */
};

typedef struct zd_group {
    const char *name;
    int first, rows;        /* first row of C, and number of rows */
    enum zd_group_kind kind;
    int sign;               /* ZD_ONE_SIDED, ZD_ONE_WAY: 1 or -1 */
    double scale;           /* ZD_ONE_SIDED, ZD_FRICTION: unit of Phi, as 1 rad of an angle; 0: the characteristic length */
    double value;           /* ZD_ONE_SIDED, ZD_ONE_WAY: Phi or rate at which it is closed; groups may share a row, as the ends of a stop */
    int is_active;          /* ZD_TWO_SIDED: 1 if it is joined at the start */
    int normal;             /* ZD_FRICTION: 1 + index of the ZD_ONE_SIDED group whose force bounds the friction; 0: another bound */
    int load, loads;        /* ZD_FRICTION without a normal: first of the rows whose multipliers are the load that bounds it, and their
                             * number, at most 4; 0: a fixed bound */
    double load_factor[4];  /* factors of these multipliers */
    int at_ends;            /* 0: the load is their norm; 1: with half of them F, the others M, it is |F + M| + |F - M|, of a guide's ends */
    int range;              /* ZD_ONE_SIDED: 1 + holonomic row, of a group that is not active, whose Phi is the coordinate along a bounded
                             * shape; 0: the shape is unbounded */
    double lower, upper;    /* limits of this coordinate: out of them, and behind the shape, a body is not in contact */
    int opposite;           /* ZD_ONE_SIDED with a range: 1 + group of the opposite side of the same shape; 0: none */
    double restitution;     /* ZD_ONE_SIDED: coefficient of restitution, 0 to 1 */
    double friction[2];     /* ZD_FRICTION: static and sliding: coefficients of the load, or with a fixed bound N or N m */
} zd_group;

/* Times at which user functions of t alone jump or bend, at which adaptive steps end: those of a group repeat with its period. */
typedef struct zd_break_group {
    double period;          /* s; 0: they do not repeat */
    int count;
    const double *t;        /* (count,) s, increasing; less than a period after the first */
} zd_break_group;

typedef struct zd_breaks {
    int groups;
    const zd_break_group *group;    /* (groups,) */
} zd_breaks;

/* Comparisons at which user functions jump: adaptive steps end where one changes. */
typedef struct zd_switches {
    int count;
    double *const *place;           /* (count,) number in the data of the system, of this run: 0: the comparison decides; otherwise the
                                     * difference of its sides is taken to have this sign */
    /* value (count,) <- differences of their sides. `scratch` is that of zd_system.evaluate(). */
    void (*evaluate)(const void *data, double t, const double *p, const double *v, double *value, double *scratch);
} zd_switches;

/* ---- a system; optional members that are not provided are NULL ---- */

typedef struct zd_system {
    int nq, nv, mh, mn;
    int provides;       /* bits of its terms, always M; others are never computed nor stored */
    int scratch;        /* doubles of scratch memory per run */
    zd_evaluate *evaluate;
    const void *data;   /* its parameters, or any data passed to its functions */
    zd_embed *embed;    /* may be NULL: then g is computed numerically */
    const int *independent;     /* (nv - mh,): indices of the entries of p that are q; NULL: chosen from C; provided together with `embed` */
    const int *lengths;     /* (nq + nv,): nonzero for entries of p that are lengths, and of v that are lengths per time; NULL: all are pure
                             * numbers such as angles */
    double length;          /* m: lower bound of the characteristic length; 0: by coordinates and constraints at the start alone */
    const char *failure;    /* meaning of ZD_CALLBACK from evaluate(), in one sentence; may be NULL */
    /* Writes the name of a row of C into `to` (size,), "" without a name; NULL: no row has one. Used in messages only. */
    void (*name_constraint)(const void *names, int row, char *to, int size);
    const void *names;
    const zd_structure *structure;  /* NULL: one block, one group, matrices dense */
    const zd_operations *operations;
    const zd_closed_form *closed_form;  /* (closed_forms,) at most one for each unit and number of lanes; those for one lane serve single
                                         * runs */
    int closed_forms;
    const zd_series *series;
    const zd_jacobian *jacobian;    /* for implicit integrators; NULL: differences */
    const zd_measures *measures;
    int inputs;
    const zd_input *input;          /* (inputs,) */
    int groups;
    const zd_group *group;          /* (groups,) at most 64 */
    const zd_residuals *residuals;
    int quaternions;
    const int *quaternion;          /* (quaternions,) offsets of unit quaternions (w, x, y, z) in p: they are normalized in each step, and
                                     * pdot = A v must preserve their length */
    int followers;                  /* number of entries of p that are functions of the others, as an unwrapped relative angle: the last
                                     * entries, outside the blocks, without stored rows of A, so that times_A must be provided */
    void (*follow)(const void *data, double *p);    /* updates these entries, keeping their turns, on which terms must not depend */
    /* magnitude (m, 2) <- for each row of C, the largest sum of magnitudes of terms that may cancel in an entry: among entries of velocities
     * that are lengths per time, and among the others. A row much smaller than that is rounding. `scratch` has magnitudes_scratch doubles.
     * Returns ZD_DONE or ZD_CALLBACK. NULL: terms do not cancel. */
    int (*magnitudes)(const void *data, double t, const double *p, const double *v, double *magnitude, double *scratch);
    int magnitudes_scratch;
    /* magnitude (nv,) <- for each entry of f, the sum of the magnitudes of its terms before they cancel: those of all forces and moments on
     * bodies that it moves. `scratch` has as many doubles as for evaluate(). Returns as evaluate() does. NULL: not known. */
    int (*force_magnitudes)(const void *data, const double *inputs, double t, const double *p, const double *v, double *magnitude,
                            double *scratch);
    const zd_reading *reading;      /* user functions that read reactions; NULL: there are none */
    /* Checks that user functions are defined at a state that may be off by atol + rtol |x| of each quantity x; evaluate() may be called
     * beyond, in trial stages. `scratch` is that of evaluate(). Returns as evaluate() does. NULL: they are defined wherever it succeeds. */
    int (*check_domain)(const void *data, double rtol, double atol, double t, const double *p, const double *v, double *scratch);
    const zd_breaks *breaks;        /* times at which user functions jump; NULL: none are known */
    const zd_switches *switches;    /* NULL: none are known */
} zd_system;

/* ---- a kind of system: with parameters, names, a start and a drawing ---- */

enum zd_rule {
    ZD_ANY, ZD_POSITIVE, ZD_NOT_NEGATIVE,       /* numbers, all of them finite */
    ZD_CHOICE,              /* one of several words, passed as its index */
    ZD_COUNT,               /* a whole number of at least 1 */
    ZD_SWITCH               /* 1: yes, 0: no */
};

typedef struct zd_parameter {
    const char *name;
    const char *unit;
    const char *text;           /* description; for a ZD_CHOICE its words, then a colon and their meaning: "open crossed: which branch" */
    int size;
    enum zd_rule rule;
    const double *initial;      /* (size,) default, or NULL: derived from the other parameters, passed to the system as NaN */
} zd_parameter;

/* Card of a table entry: name, source and parameters. */
typedef struct zd_card {
    const char *name;
    const char *summary;     /* one sentence */
    const char *equations;   /* "(8), (25)" */
    int order;               /* order of an integrator; else 0 */
    int error_order;         /* order of its error estimate; 0: no estimate, fixed steps only */
    double stability;        /* limit of omega h, beyond which fixed steps are warned of: the largest at which oscillations of some damping do
                              * not grow, such as the end of the interval of stability on the negative real axis; 0: unbounded */
    const char *description; /* effect and recommended use, in a few sentences; may be NULL */
    const char *reference;   /* literature; may be NULL */
    int parameters;          /* number of parameters of a formulation, integrator or correction; a kind of system has its own below */
    const zd_parameter *parameter;  /* (parameters,) at most ZD_ROW_VALUES numbers in all, none of them derived */
} zd_card;

typedef struct zd_variable {
    const char *name;
    const char *unit;
} zd_variable;

typedef struct zd_kind {
    zd_card card;
    zd_system system;               /* sizes, terms and functions; `data` is set for each instance */
    int parameters, constants;      /* number of parameters, and of the doubles that evaluate() gets as data */
    const zd_parameter *parameter;
    const zd_variable *coordinate;  /* (nq,) */
    const zd_variable *velocity;    /* (nv,) */
    const zd_variable *constraint;  /* (m,) */
    /* constants <- from the parameters, concatenated in order. Returns NULL, or the reason in one sentence if they are invalid. */
    const char *(*prepare)(const double *parameters, double *constants);
    void (*start)(const double *parameters, double *p, double *v);
    /* The drawing: `points` points of `dimension` coordinates in m, joined by lines; NaN lifts the pen. */
    int points, dimension;
    void (*draw)(const double *constants, const double *p, double *points);
    const zd_precise *precise;      /* in double-double arithmetic; read of built-in systems only */
} zd_kind;

#endif
