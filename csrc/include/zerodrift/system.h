/* What a system is for zerodrift: the whole interface between the core and code that somebody else compiled.
 *
 *     #include <zerodrift/system.h>           the folder is what zerodrift.get_include() says
 *     const int zd_interface_version = ZD_INTERFACE_VERSION;
 *
 *     int pendulum(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
 *     {
 *         const double *q = data;             the parameters, in the order they are named in Python
 *         if (want & ZD_M) ...                out->M[...]
 *         return ZD_DONE;
 *     }
 *
 * A shared library that has both goes to zerodrift.native("library.so", symbol="pendulum", ...), which says the sizes and terms.
 * One that has a `const zd_kind zd_kind_pendulum` instead says all of it itself, and is as good as a built-in system.
 *
 * Declarations and nothing else: CFFI reads what the preprocessor makes of this text. Equation numbers are those of W. Blajer,
 * "Elimination of Constraint Violation and Accuracy Aspects in Numerical Simulation of Multibody Systems", Multibody System Dynamics 7 (2002)
 * 265-284. Matrices are row-major; SI units throughout.
 *
 *     nq  coordinates p       mh  holonomic rows of Phi         m = mh + mn  rows of C
 *     nv  velocities v        mn  nonholonomic rows             r = nv - m   columns of D
 */
#ifndef ZERODRIFT_SYSTEM_H
#define ZERODRIFT_SYSTEM_H

#include <stdint.h>

/* Changes whenever something below does that compiled code depends on. */
enum { ZD_INTERFACE_VERSION = 3 };

/* ---- statuses: 0 done; positive: stopped early, what was recorded is valid; negative: failed ---- */

/* One in each line: its number, the error that Python raises ("": the base of all), and what it means. A message that has numbers to
 * say more with is in explain.c. */
#define ZD_STATUS_LIST(STATUS) \
    STATUS(ZD_DONE, 0, "", "done") \
    STATUS(ZD_PAUSED, 1, "", "the time slice is over: call again") \
    STATUS(ZD_FULL, 2, "", "the record is full: give another") \
    STATUS(ZD_EVENT, 4, "", "a terminal event ended the run")       /* 3 is left to whoever stops it from outside */ \
    STATUS(ZD_NOT_FINITE, -1, "Diverged", "the state left the range of doubles") \
    STATUS(ZD_NOT_DEFINITE, -2, "SingularSystem", "the mass matrix is not positive definite") \
    STATUS(ZD_DEPENDENT_ROWS, -3, "SingularSystem", "rows of C that count are dependent, to the formulation's own precision") \
    STATUS(ZD_SINGULAR, -4, "SingularSystem", "a leading matrix is singular") \
    STATUS(ZD_NO_CONVERGENCE, -5, "CorrectionFailed", "the position correction did not reach its tolerance") \
    STATUS(ZD_NO_STEP, -6, "StepFailed", "the equations of an implicit step were not solved") \
    STATUS(ZD_BAD_START, -7, "InconsistentStart", "the initial state violates the constraints") \
    STATUS(ZD_BAD_ARGUMENT, -8, "", "an argument is wrong") \
    STATUS(ZD_NO_MEMORY, -9, "MemoryError", "there is no memory for this") \
    STATUS(ZD_CALLBACK, -10, "", "the system's own evaluation failed") \
    STATUS(ZD_UNREACHABLE, -11, "UnreachableTolerance", "the tolerance is below what doubles can reach") \
    STATUS(ZD_NO_EMBEDDING, -12, "StepFailed", "the independent coordinates do not determine the others here: p = g(q) was not solved") \
    STATUS(ZD_NOT_SYMMETRIC, -13, "SingularSystem", "the mass matrix is not symmetric") \
    STATUS(ZD_TINY_STEP, -14, "StepFailed", "the error asked for needs steps that time does not resolve") \
    STATUS(ZD_UNSUITED, -15, "UnsuitedFormulation", "the formulation cannot take this system") \
    STATUS(ZD_BAD_TERM, -16, "", "a term of the system is not finite where the state is") \
    STATUS(ZD_UNSUITED_INTEGRATOR, -17, "UnsuitedIntegrator", "the integrator cannot take this system") \
    STATUS(ZD_BRANCH, -18, "BranchJump", "the step ended where its velocities do not lead, on another assembly branch or nearly") \
    STATUS(ZD_BIFURCATION, -19, "Bifurcation", \
           "constraints that are independent elsewhere are not here, and do not determine the motion") \
    STATUS(ZD_CONTRADICTION, -20, "SingularSystem", "constraints that follow from others ask for something else") \
    STATUS(ZD_BIFURCATION_PASSED, -21, "Bifurcation", \
           "the step passes a bifurcation, where the constraints do not determine the motion, or comes too near one to follow the motion") \
    STATUS(ZD_TOO_MANY_STEPS, -22, "StepFailed", "settings->max_steps were taken") \
    STATUS(ZD_NOT_JACOBIAN, -23, "InconsistentSystem", "C or Phi_t are not the derivatives of Phi") \
    STATUS(ZD_NOT_KEPT, -24, "InconsistentSystem", "A v changes the length of a unit quaternion")

#define ZD_STATUS_NUMBER(name, number, error, sentence) name = number,
enum zd_status { ZD_STATUS_LIST(ZD_STATUS_NUMBER) };

/* ---- a system: one function evaluates what is wanted at (t, p, v) ---- */

/* What a function of the motion depends on, besides t. */
enum zd_depends {
    ZD_OF_POSITIONS,    /* p */
    ZD_OF_VELOCITIES,   /* p and v */
    ZD_OF_ACCELERATIONS /* p, v, vdot and lambda */
};

/* The terms of the equations, one in each line: the bit that asks for it, its member of zd_terms, its shape, what it depends on, and
 * what it is. All else that is to be known of the terms follows from here; a new one is a line below, and a new interface version.
 * Bits are below ZD_MOVED. */
#define ZD_TERM_LIST(TERM) \
    TERM(ZD_A, 0x1, A, ZD_MATRIX(nq, nv), ZD_OF_POSITIONS, "kinematic matrix of (1); absent: identity") \
    TERM(ZD_M, 0x2, M, ZD_MATRIX(nv, nv), ZD_OF_POSITIONS, "mass matrix of (2), both triangles") \
    TERM(ZD_BIAS, 0x4, d, ZD_VECTOR(nv), ZD_OF_VELOCITIES, "bias of (2); absent: zero") \
    TERM(ZD_FORCE, 0x8, f, ZD_VECTOR(nv), ZD_OF_VELOCITIES, "applied forces of (2); absent: zero") \
    TERM(ZD_PHI, 0x10, Phi, ZD_VECTOR(mh), ZD_OF_POSITIONS, "holonomic constraints (3)") \
    TERM(ZD_C, 0x20, C, ZD_MATRIX(m, nv), ZD_OF_POSITIONS, "constraint matrix of (5), holonomic rows first") \
    TERM(ZD_PHI_T, 0x40, Phi_t, ZD_VECTOR(m), ZD_OF_POSITIONS, \
         "what (5) has besides C v: time derivatives of Phi at fixed p; absent: zero") \
    TERM(ZD_XI, 0x80, xi, ZD_VECTOR(m), ZD_OF_VELOCITIES, "right side of (6): all that is not C vdot, also from Phi_t") \
    TERM(ZD_POTENTIAL, 0x100, V, ZD_NUMBER, ZD_OF_POSITIONS, "potential energy in J") \
    TERM(ZD_POWER, 0x200, power, ZD_NUMBER, ZD_OF_VELOCITIES, \
         "Edot of (28) in W: power of the forces in f that V does not describe, and dV/dt at fixed p") \
    TERM(ZD_COMPLEMENT, 0x400, D, ZD_MATRIX(nv, r), ZD_OF_POSITIONS, "complement of (14), C D = 0; absent: found from C by (16)") \
    TERM(ZD_GAMMA, 0x800, gamma, ZD_VECTOR(nv), ZD_OF_VELOCITIES, "what vdot has besides D udot, (15); goes with D")

#define ZD_TERM_BIT(name, bit, member, shape, depends, text) name = bit,
enum zd_term {
    ZD_TERM_LIST(ZD_TERM_BIT)
    ZD_MOVED = 0x400000,    /* said to the system, not asked of it: t or p differ from its last call with this scratch */
    ZD_TIMELESS = 0x800000  /* said by the system among what it provides: none of its terms depends on t but through p and v */
};

#define ZD_TERM_MEMBER(name, bit, member, shape, depends, text) double *member;
typedef struct zd_terms {
    ZD_TERM_LIST(ZD_TERM_MEMBER)    /* double *A; double *M; double *d; and so on */
    double *scratch;        /* (scratch,) what a system keeps while (t, p) stays, such as sines */
    const double *inputs;   /* (inputs,) read, not written: see zd_input; NULL where there are none */
} zd_terms;

/* Writes the terms in `want` and no others. Pure: all it may keep is in out->scratch. Returns ZD_DONE; anything else: it failed. */
typedef int zd_evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out);

/* p = g(q) of (18), on the branch that p, an estimate of it, is on when called. Returns 0, or ZD_NO_CONVERGENCE where there is no such p. */
typedef int zd_embed(const void *data, double t, const double *q, double *p);

/* ---- what a system may bring besides; a pointer that is NULL says that there is nothing of it ---- */

/* Of which bodies a system consists, and which of its rows join which. Where it is declared, matrices are packed and nothing dense is stored:
 *
 *     A   block after block, (coordinates[b], velocities[b]) each
 *     M   block after block, (velocities[b], velocities[b]) each, or its diagonal (velocities[b],) where ZD_DIAGONAL says so
 *     C   group after group, (rows[g], width) each: its columns are the velocities of the blocks that the group touches, in their order
 *
 * row-major all, so that what is stored of a row of C stands together. Vectors are as they are without. A system with structure has no D of
 * its own. */
enum zd_mass { ZD_CONSTANT = 1, ZD_DIAGONAL = 2 };

typedef struct zd_structure {
    int blocks;
    const int *coordinates;     /* (blocks,) how many entries of p each has, in order, nq in all but followers */
    const int *velocities;      /* (blocks,) how many entries of v, in order, nv in all; of both at least one */
    const int *mass;            /* (blocks,) bits of zd_mass; NULL: none anywhere */
    int groups;
    const int *rows;            /* (groups,) how many rows of C each has, at least one, in order, m in all; none has holonomic and
                                 * nonholonomic ones */
    const int *first;           /* (groups + 1,) where in `block` the blocks of each group begin */
    const int *block;           /* (first[groups],) the blocks that each group touches, at least one, increasing */
} zd_structure;

/* Products with what was evaluated, for systems that know better ways than through stored entries; NULL: through these. They follow a call
 * with ZD_MOVED at the same (t, p), from whose scratch they may take what they need. Where both of the last two are there, and all of M is
 * diagonal by structure, the core has accelerations and corrections without C, which it then evaluates only for what is rare: so these and
 * times_C must not read it. */
typedef struct zd_operations {
    void (*times_A)(const void *data, const zd_terms *terms, const double *x, double *y);      /* y = A x, (nq,): where A is provided */
    void (*times_C)(const void *data, const zd_terms *terms, const double *x, double *y);      /* y = C x, (m,) */
    void (*times_M)(const void *data, const zd_terms *terms, const double *x, double *y);      /* y = M x, (nv,) */
    /* x <- x - W C^T y, W (nv,) diagonal; row k of C has entry place[k] of y, and rows of a group stand together there, too */
    void (*subtract_weighted)(const void *data, const zd_terms *terms, const double *W, const double *y, const int *place, double *x);
    /* S <- S + C W C^T: for each block in order, the products of its columns in the groups that touch it, of each group g and all h <= g,
     * increasing both. The block (rows[g], rows[h]) of the next of them begins in S at half of the next entry of `at`; it is stored
     * transposed where that entry is odd. Of those with g = h, nothing but the lower triangle is read. */
    void (*add_weighted)(const void *data, const zd_terms *terms, const double *W, const int *at, double *S);
} zd_operations;

/* Bodies in the plane that are joined by pins alone, and of which nothing but their weight asks anything: all that there is to know of
 * them, so that the core can make several trajectories at once by itself. It says the same as the structure, in which each body is a block
 * of two coordinates, or of three with its angle, and each pin a group of two rows, in the same order. */
typedef struct zd_pinned {
    int bodies, pins;
    const int *at;              /* (bodies + 1,) where the coordinates of each begin: x and y of its mass centre, and its angle */
    const int *first, *second;  /* (pins,) bodies; -1: the ground */
    /* 2 and 6 for each body and pin: 1 / mass, 1 / inertia, 0 without an angle; from mass centre to pin in the axes of the first body and
     * of the second, on the ground from its origin; and what Phi = x2 + w - x1 - u is where the pin is closed.
     * Behind all of them the two of gravity. */
    const double *numbers;
} zd_pinned;

/* The equations with their constraints eliminated in closed form: accelerations and corrections without a leading matrix.
 *
 * An order of elimination solves the rows of C, one or a few at a time, for as many velocities: C x = rhs is x = x0 + D a with a of the
 * degrees of freedom, and D^T M D a = D^T (force - M x0). So there are two kinds of pivots, which are written where `pivots` is not NULL:
 *
 *     (solves,)       determinants of what each set of rows is solved with, as they are
 *     (nv - m,)       of D^T M D, each as the share that it is of its diagonal entry: positive, 1 where nothing was taken from that
 *
 * Functions return 0, or anything else where they do not know; then, and where a pivot says so, the core does without them. They are pure. */
typedef struct zd_elimination {
    int solves;             /* how many sets of rows are solved, each at once */
    const int *solve;       /* (m,) which of them has the k-th of these rows and columns */
    const int *row, *column;    /* (m,) rows of C, and the velocities that they are solved for; each row once, each velocity at most once */
    /* vdot at the state, with `added` (m,) on the right side of (6), NULL: zero. pdot is written by systems with A alone; lambda, power and
     * pivots may be NULL: not wanted. The power is that of (28): ZD_POWER, and what moving constraints do, lambda^T Phi_t. */
    int (*accelerate)(const void *data, const double *t, const double *p, const double *v, const double *added, double *pdot, double *vdot,
                      double *lambda, double *power, double *pivots);
    /* Phi (3), and Newton's steps in the metric of M, dp (nq,) of (25a) ... (27a) and dv (nv,) of (25b) ... (27b), both at (t, p, v) and to
     * be subtracted. NULL where there are no constraints. */
    int (*correct)(const void *data, const double *t, const double *p, const double *v, double *Phi, double *dp, double *dv);
    /* Both at once, for the end of a step: Phi, and where every |Phi| is as small as `allowed` (mh,), v less that dv, and what
     * accelerate() has there with nothing added. Else only dp, v stays, and it returns ZD_NO_CONVERGENCE. NULL:
     * the core calls both of the others. */
    int (*land)(const void *data, const double *t, const double *p, double *v, const double *allowed, double *Phi, double *dp, double *pdot,
                double *vdot, double *lambda, double *power, double *pivots);
    /* The same for a state in the velocities that are not solved for, and where dp is wanted in as many coordinates: with `added` as
     * above, and with steps that keep these instead of Newton's shortest, so that the v left is all that follows from them. D (m, nv - m),
     * which goes with the pivots and may be NULL without them: dv of the velocities solved for to dv of each of the others,
     * in their order. */
    int (*embed)(const void *data, const double *t, const double *p, double *v, const double *added, const double *allowed, double *Phi,
                 double *dp, double *D, double *pdot, double *vdot, double *lambda, double *power, double *pivots);
} zd_elimination;

/* The processors' vector units: a processor that has one has those before it. */
enum zd_unit {
    ZD_BASELINE,            /* what every processor of its kind has: no product and sum is contracted to one operation */
    ZD_AVX2,                /* AVX2 and FMA: contracted */
    ZD_AVX512               /* AVX-512 F, DQ and VL: contracted, too */
};

/* Functions for one unit and number of lanes. */
typedef struct zd_direct {
    enum zd_unit unit;      /* that they are compiled for */
    int lanes;              /* trajectories at once, 1, 2, 4 or 8: entries of every array come in groups of so many, t and the doubles of `data`,
                             * too; and what the functions return has a bit for each trajectory that they do not know */
    int orders;             /* at most 4: the first whose pivots are large enough is taken, which depends on the state alone */
    const zd_elimination *order;    /* (orders,) */
    int embeddings;         /* at most 4, for formulations in independent velocities: the one is taken that solves for all but these */
    const zd_elimination *embedding;    /* (embeddings,) with embed() instead of accelerate() and land(); of one lane alone */
} zd_direct;

/* Taylor coefficients of the motion from (t, p, v) on, up to t^order: p_series (order + 1, nq), v_series (order + 1, nv), the first ones
 * being p and v; and work (order + 1,), NULL: not wanted, of the energy that comes in (28), the first one being 0. Not 0:
 * there are none here. */
typedef struct zd_series {
    int scratch;            /* doubles that a call needs, for each order and one more */
    int (*evaluate)(const void *data, int order, double t, const double *p, const double *v, double *p_series, double *v_series,
                    double *work, double *scratch);
} zd_series;

/* How the rates of a state (p, v) change with it: J (nq + nv, nq + nv) <- the derivatives of pdot = A v and of vdot as (2) and (6) have
 * it, and in one row more, where ZD_POWER or ZD_PHI_T is provided, those of the power of (28). Not 0: there are none here. */
typedef struct zd_jacobian {
    int scratch;            /* doubles that a call needs */
    int (*evaluate)(const void *data, double t, const double *p, const double *v, double *J, double *scratch);
    /* Psi_p (m, nq) <- the derivatives of C v + Phi_t, (5), by p, which `mixed` and `independent` need; NULL: they take differences. */
    int (*constraints)(const void *data, double t, const double *p, const double *v, double *Psi_p, double *scratch);
} zd_jacobian;

/* Named functions of the motion, such as where a point is or what goes through a joint. */
typedef struct zd_measure {
    const char *name;       /* "crank.angle" */
    const char *unit;       /* of each component */
    int size;               /* how many components */
    enum zd_depends depends;
} zd_measure;

typedef struct zd_measured {    /* where the values go; NULL: not wanted */
    double *value;          /* (size,) */
    double *rate;           /* (size,) of a measure of positions: its derivative by time, row v + what is explicit in t */
    double *row;            /* (size, nv) of a measure of positions: d rate / d v; of velocities: d value / d v */
    double *bias;           /* (size,) what the derivative of these by time has besides row vdot */
    int is_same_state;      /* 1: t, p, v and the scratch are as in the call before, so that what follows from them need not be found again */
} zd_measured;

typedef struct zd_measures {
    int count;
    const zd_measure *measure;      /* (count,) */
    int scratch;            /* doubles that a call needs */
    /* vdot, lambda are NULL where the measure does not depend on them */
    int (*evaluate)(const void *data, int measure, double t, const double *p, const double *v, const double *vdot, const double *lambda,
                    const zd_measured *out, double *scratch);
} zd_measures;

/* A number that may be set from outside between steps: a control, or what another program computes. Not a parameter. */
typedef struct zd_input {
    const char *name;
    const char *unit;
    double initial;
} zd_input;

/* Rows that can be switched off and on together: a phase, a joint that is locked and released. */
typedef struct zd_group {
    const char *name;
    int first, rows;        /* of C */
} zd_group;

/* By how much the residuals of (2), M vdot + d - f + C^T lambda, and of (6), C vdot - xi, change along a direction, while vdot and
 * lambda stay. */
typedef struct zd_residuals {
    int scratch;            /* doubles that a call needs */
    int (*derivative)(const void *data, double t, const double *p, const double *v, const double *vdot, const double *lambda,
                      const double *dp, const double *dv, const double *dparameters,    /* (nq,), (nv,), all parameters; NULL: zero */
                      double *dynamics, double *constraints, double *scratch);          /* (nv,), (m,) */
} zd_residuals;

typedef struct zd_system {
    int nq, nv, mh, mn;
    int provides;       /* the terms it has; M always, what is left out is never computed nor stored */
    int scratch;        /* doubles it keeps per run */
    zd_evaluate *evaluate;
    const void *data;   /* its parameters, or whatever it wants to be handed */
    zd_embed *embed;    /* may be NULL: then g is found numerically */
    const int *independent;     /* (nv - mh,): which entries of p are q; NULL: chosen from C; goes with `embed` */
    const int *lengths;     /* (nq + nv,): which entries of p are lengths, and of v lengths per time; NULL: none, all are pure
                             * numbers such as angles */
    double length;          /* m: it is at least so large, which lengths are compared to; 0: as its coordinates and rows tell at the start */
    const char *failure;    /* what ZD_CALLBACK from evaluate() means, in a sentence; may be NULL */
    /* Writes what a row of C is called into `to` (size,), "" where it has no name; NULL: none has. Asked for messages alone. */
    void (*name_row)(const void *names, int row, char *to, int size);
    const void *names;
    const zd_structure *structure;  /* NULL: one block, one group, matrices dense */
    const zd_operations *operations;
    const zd_pinned *pinned;
    const zd_direct *direct;        /* (directs,) at most one for each unit and number of lanes; those for one lane serve single runs */
    int directs;
    const zd_series *series;
    const zd_jacobian *jacobian;    /* for implicit integrators; NULL: differences */
    const zd_measures *measures;
    int inputs;
    const zd_input *input;          /* (inputs,) */
    int groups;
    const zd_group *group;          /* (groups,) at most 64 */
    const zd_residuals *residuals;
    int quaternions;
    const int *quaternion;          /* (quaternions,) where unit quaternions (w, x, y, z) begin in p: they are kept at length 1, and A is such
                                     * that it does not change by itself */
    int followers;                  /* so many entries of p follow the others, as an angle that counts turns follows two attitudes: they are the last
                                     * ones, of no block, and no row of A is stored for them, so that times_A has to be there */
    void (*follow)(const void *data, double *p);    /* brings them to what they follow, with the turns that they have; no term differs by that */
    /* magnitude (m, 2) <- of each row of C, the sum of the magnitudes of the terms of its entries before they cancel: the largest entry of a
     * velocity that is a length per time, and of another velocity. A row that is much shorter is rounding. `scratch` holds as many doubles
     * as the next member says. Returns ZD_DONE or ZD_CALLBACK. NULL: no entries cancel, and rows are as large as they are. */
    int (*magnitudes)(const void *data, double t, const double *p, const double *v, double *magnitude, double *scratch);
    int magnitudes_scratch;
} zd_system;

/* ---- a kind of system: with parameters, names, a start and a drawing ---- */

enum zd_rule {
    ZD_ANY, ZD_POSITIVE, ZD_NOT_NEGATIVE,       /* numbers, all of them finite */
    ZD_CHOICE,              /* one of some words, handed over as its number */
    ZD_COUNT,               /* a whole number from 1 on */
    ZD_SWITCH               /* 1: yes, 0: no */
};

typedef struct zd_parameter {
    const char *name;
    const char *unit;
    const char *text;           /* of a ZD_CHOICE its words, and what they mean behind a colon: "open crossed: which branch" */
    int size;
    enum zd_rule rule;
    const double *initial;      /* (size,) or NULL: derived from the others, handed to the system as NaN */
} zd_parameter;

/* What a row of a table is called, where it comes from, and what may be set of it. */
typedef struct zd_card {
    const char *name;
    const char *summary;     /* one sentence */
    const char *equations;   /* "(8), (25)" */
    int order;               /* of an integrator; else 0 */
    int error_order;         /* of its error estimate; 0: there is none, and steps are of fixed size */
    double stability;        /* the largest omega h at which a motion that is somewhat damped does not grow; 0: there is none */
    const char *description; /* what it does and when to take it, in some sentences; may be NULL */
    const char *reference;   /* the literature; may be NULL */
    int parameters;          /* of a formulation, integrator or correction; a kind of system has its own below */
    const zd_parameter *parameter;  /* (parameters,) at most ZD_ROW_VALUES numbers, none of them derived */
} zd_card;

typedef struct zd_variable {
    const char *name;
    const char *unit;
} zd_variable;

typedef struct zd_kind {
    zd_card card;
    zd_system system;               /* sizes, terms and function; `data` is filled in for each instance */
    int parameters, constants;      /* how many of each; `constants` doubles are what evaluate() gets as data */
    const zd_parameter *parameter;
    const zd_variable *coordinate;  /* (nq,) */
    const zd_variable *velocity;    /* (nv,) */
    const zd_variable *constraint;  /* (m,) */
    /* Constants from the parameters, concatenated in order. Returns 0, or the reason why not as a sentence. */
    const char *(*prepare)(const double *parameters, double *constants);
    void (*start)(const double *parameters, double *p, double *v);
    /* The drawing: `points` points of `dimension` coordinates in m, joined by lines; NaN lifts the pen. */
    int points, dimension;
    void (*draw)(const double *constants, const double *p, double *points);
} zd_kind;

#endif
