/* The system interface: all declarations shared by the core and separately compiled systems.
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

/* Changes with any declaration below that compiled code depends on. */
enum { ZD_INTERFACE_VERSION = 4 };

/* ---- statuses: 0 done; positive: stopped early, what was recorded is valid; negative: failed ---- */

/* One status per line: its number, the exception that Python raises ("": the base class, ZerodriftError), and its meaning. More specific
 * messages with numbers are in explain.c. */
#define ZD_STATUS_LIST(STATUS) \
    STATUS(ZD_DONE, 0, "", "done") \
    STATUS(ZD_PAUSED, 1, "", "the time slice is over: call again") \
    STATUS(ZD_FULL, 2, "", "the record is full: give another") \
    STATUS(ZD_EVENT, 4, "", "a terminal event ended the run")       /* 3 is reserved for an interruption by the caller */ \
    STATUS(ZD_NOT_FINITE, -1, "Diverged", "the state left the range of doubles") \
    STATUS(ZD_NOT_DEFINITE, -2, "SingularSystem", "the mass matrix is not positive definite") \
    STATUS(ZD_DEPENDENT_ROWS, -3, "SingularSystem", "independent constraints are dependent within the precision of the formulation") \
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
    STATUS(ZD_TINY_STEP, -14, "StepFailed", "step size underflow: the tolerance requires steps below the rounding of the time") \
    STATUS(ZD_UNSUITED, -15, "UnsuitedFormulation", "the formulation does not apply to this system") \
    STATUS(ZD_BAD_TERM, -16, "", "a term of the system is not finite at a finite state") \
    STATUS(ZD_UNSUITED_INTEGRATOR, -17, "UnsuitedIntegrator", "the integrator does not apply to this system") \
    STATUS(ZD_BRANCH, -18, "BranchJump", \
           "the step ended on (or near) another assembly branch: displacement and velocities disagree") \
    STATUS(ZD_BIFURCATION, -19, "Bifurcation", \
           "constraints that are independent elsewhere are dependent here, and do not determine the motion") \
    STATUS(ZD_CONTRADICTION, -20, "SingularSystem", "dependent constraints contradict each other") \
    STATUS(ZD_BIFURCATION_PASSED, -21, "Bifurcation", \
           "the step passes a bifurcation, where the constraints do not determine the motion, or comes too near one to follow the motion") \
    STATUS(ZD_TOO_MANY_STEPS, -22, "StepFailed", "the run must end within max_steps steps") \
    STATUS(ZD_NOT_JACOBIAN, -23, "InconsistentSystem", "C or Phi_t are not the derivatives of Phi") \
    STATUS(ZD_NOT_KEPT, -24, "InconsistentSystem", "A v changes the length of a unit quaternion") \
    STATUS(ZD_BAD_INPUT, -25, "InputRefused", "an input is not finite, or beyond its limits") \
    STATUS(ZD_COLLAPSED, -26, "StepFailed", "the step size has collapsed at one place")

#define ZD_STATUS_NUMBER(name, number, error, sentence) name = number,
enum zd_status { ZD_STATUS_LIST(ZD_STATUS_NUMBER) };

/* ---- a system: one function evaluates the requested terms at (t, p, v) ---- */

/* Arguments of a function of the motion, besides t. */
enum zd_depends {
    ZD_OF_POSITIONS,    /* p */
    ZD_OF_VELOCITIES,   /* p and v */
    ZD_OF_ACCELERATIONS /* p, v, vdot and lambda */
};

/* The terms of the equations, one per line: name and value of the bit that requests it, its member of zd_terms, shape, arguments, and
 * meaning. All other tables of terms are made from this list; a new term is a new line, and a new interface version. Bits are below
 * ZD_MOVED. */
#define ZD_TERM_LIST(TERM) \
    TERM(ZD_A, 0x1, A, ZD_MATRIX(nq, nv), ZD_OF_POSITIONS, "kinematic matrix of (1); absent: identity") \
    TERM(ZD_M, 0x2, M, ZD_MATRIX(nv, nv), ZD_OF_POSITIONS, "mass matrix of (2), both triangles") \
    TERM(ZD_BIAS, 0x4, d, ZD_VECTOR(nv), ZD_OF_VELOCITIES, "bias of (2); absent: zero") \
    TERM(ZD_FORCE, 0x8, f, ZD_VECTOR(nv), ZD_OF_VELOCITIES, "applied forces of (2); absent: zero") \
    TERM(ZD_PHI, 0x10, Phi, ZD_VECTOR(mh), ZD_OF_POSITIONS, "holonomic constraints (3)") \
    TERM(ZD_C, 0x20, C, ZD_MATRIX(m, nv), ZD_OF_POSITIONS, "constraint matrix of (5), holonomic rows first") \
    TERM(ZD_PHI_T, 0x40, Phi_t, ZD_VECTOR(m), ZD_OF_POSITIONS, \
         "time derivatives of Phi at fixed p, the term of (5) besides C v; absent: zero") \
    TERM(ZD_XI, 0x80, xi, ZD_VECTOR(m), ZD_OF_VELOCITIES, "right-hand side of (6), C vdot = xi, including the terms from Phi_t") \
    TERM(ZD_POTENTIAL, 0x100, V, ZD_NUMBER, ZD_OF_POSITIONS, "potential energy in J") \
    TERM(ZD_POWER, 0x200, power, ZD_NUMBER, ZD_OF_VELOCITIES, \
         "Edot of (28) in W: power of the forces in f that V does not describe, and dV/dt at fixed p") \
    TERM(ZD_COMPLEMENT, 0x400, D, ZD_MATRIX(nv, r), ZD_OF_POSITIONS, "complement of (14), C D = 0; absent: found from C by (16)") \
    TERM(ZD_GAMMA, 0x800, gamma, ZD_VECTOR(nv), ZD_OF_VELOCITIES, "term of (15), vdot = D udot + gamma; provided together with D")

#define ZD_TERM_BIT(name, bit, member, shape, depends, text) name = bit,
enum zd_term {
    ZD_TERM_LIST(ZD_TERM_BIT)
    ZD_MOVED = 0x400000,    /* passed in `want`: t or p differ from the last call with this scratch */
    ZD_TIMELESS = 0x800000  /* declared in `provides`: no term depends explicitly on t */
};

#define ZD_TERM_MEMBER(name, bit, member, shape, depends, text) double *member;
typedef struct zd_terms {
    ZD_TERM_LIST(ZD_TERM_MEMBER)    /* double *A; double *M; double *d; and so on */
    double *scratch;        /* (scratch,) memory of the system, for values that stay valid while (t, p) does not change, such as sines */
    const double *inputs;   /* (2 inputs + 1,) values to read: see zd_input; NULL without inputs */
} zd_terms;

/* Writes the terms in `want` and no others. Must be a pure function, except for out->scratch. Returns ZD_DONE; any other value: failed. */
typedef int zd_evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out);

/* p <- g(q) of (18), on the branch of the estimate in p. Returns 0, or ZD_NO_CONVERGENCE if there is no such p. */
typedef int zd_embed(const void *data, double t, const double *q, double *p);

/* ---- optional members of a system; NULL: not provided ---- */

/* Bodies of a system (blocks), and the constraints that join them (groups). With a declared structure, matrices are packed:
 *
 *     A   block after block, (coordinates[b], velocities[b]) each
 *     M   block after block, (velocities[b], velocities[b]) each, or its diagonal (velocities[b],) with ZD_DIAGONAL
 *     C   group after group, (rows[g], width) each: its columns are the velocities of the blocks that the group touches, in their order
 *
 * all row-major, so that the entries of a row of C are contiguous. Vectors are not packed. A system with a structure must not provide D. */
enum zd_mass { ZD_CONSTANT = 1, ZD_DIAGONAL = 2 };

typedef struct zd_structure {
    int blocks;
    const int *coordinates;     /* (blocks,) number of entries of p per block, in order, at least 1; sum: nq without followers */
    const int *velocities;      /* (blocks,) number of entries of v per block, in order, at least 1; sum: nv */
    const int *mass;            /* (blocks,) bits of zd_mass; NULL: all 0 */
    int groups;
    const int *rows;            /* (groups,) number of rows of C per group, in order, at least 1; sum: m; all holonomic, or all
                                 * nonholonomic */
    const int *first;           /* (groups + 1,) offset of the blocks of each group in `block` */
    const int *block;           /* (first[groups],) the blocks that each group touches, at least 1, increasing */
} zd_structure;

/* Products with matrices, for systems that compute them faster than from stored entries; NULL: from stored entries. They are called after
 * evaluate() with ZD_MOVED at the same (t, p), and may read its scratch. If both of the last two are provided, and all of M is diagonal by
 * structure, accelerations and corrections need no entries of C, which are then evaluated in rare cases only: so these and times_C must
 * not read C. */
typedef struct zd_operations {
    void (*times_A)(const void *data, const zd_terms *terms, const double *x, double *y);      /* y = A x, (nq,): if A is provided */
    void (*times_C)(const void *data, const zd_terms *terms, const double *x, double *y);      /* y = C x, (m,) */
    void (*times_M)(const void *data, const zd_terms *terms, const double *x, double *y);      /* y = M x, (nv,) */
    /* x <- x - W C^T y, W (nv,) diagonal; entry place[k] of y belongs to row k of C, and rows of a group are contiguous in y, too */
    void (*subtract_weighted)(const void *data, const zd_terms *terms, const double *W, const double *y, const int *place, double *x);
    /* S <- S + C W C^T: for each block in order, the products of its columns in the groups that touch it, of each group g and all h <= g,
     * increasing both. The block (rows[g], rows[h]) of the next of them begins in S at half of the next entry of `at`; it is stored
     * transposed where that entry is odd. Of those with g = h, nothing but the lower triangle is read. */
    void (*add_weighted)(const void *data, const zd_terms *terms, const double *W, const int *at, double *S);
} zd_operations;

/* Plane bodies joined by revolute joints (pins), under gravity only: the complete data of such a system, by which the core computes several
 * trajectories at once. Must agree with the structure, in which each body is a block of two coordinates, or three with its angle, and each
 * pin a group of two rows, in the same order. */
typedef struct zd_pinned {
    int bodies, pins;
    const int *at;              /* (bodies + 1,) offset of the coordinates of each body: x and y of its mass centre, and its angle */
    const int *first, *second;  /* (pins,) bodies; -1: the ground */
    /* 2 per body: 1 / mass, 1 / inertia (0 without an angle); 6 per pin: vectors from mass centre to pin in the axes of the first and of the
     * second body (on the ground from its origin), and the value of Phi = x2 + w - x1 - u when the pin is closed; 2 of gravity. */
    const double *numbers;
} zd_pinned;

/* The equations with their constraints eliminated in closed form: accelerations and corrections without a leading matrix.
 *
 * An order of elimination solves the rows of C, one or a few at a time, for as many velocities: the solution of C x = rhs is x = x0 + D a,
 * with a (nv - m,) from D^T M D a = D^T (force - M x0). So there are two kinds of pivots, written if `pivots` is not NULL:
 *
 *     (solves,)       determinants of the matrices of the sets of rows
 *     (nv - m,)       relative pivots of D^T M D: positive, 1 if the elimination has not changed the diagonal entry
 *
 * Functions are pure, and return 0, or any other value if they fail; then, or if pivots are too small, the core takes the matrix path. */
typedef struct zd_elimination {
    int solves;             /* number of sets of constraints that are solved simultaneously */
    const int *solve;       /* (m,) set of the k-th of these rows and columns */
    const int *row, *column;    /* (m,) rows of C, and the velocities that they are solved for; each row once, each velocity at most once */
    /* vdot at the state, with `added` (m,) added to the right-hand side of (6), NULL: zero. pdot is written by systems with A only; lambda,
     * power and pivots may be NULL: not requested. The power is that of (28): ZD_POWER, and that of moving constraints, lambda^T Phi_t. */
    int (*accelerate)(const void *data, const double *inputs, const double *t, const double *p, const double *v, const double *added,
                      double *pdot, double *vdot, double *lambda, double *power, double *pivots);
    /* Phi (3), and Newton corrections in the metric of M, dp (nq,) of (25a) ... (27a) and dv (nv,) of (25b) ... (27b), both at (t, p, v), to
     * be subtracted. NULL without constraints. */
    int (*correct)(const void *data, const double *inputs, const double *t, const double *p, const double *v, double *Phi, double *dp,
                   double *dv);
    /* Both at once, for the end of a step: Phi, and if every |Phi| is at most `allowed` (mh,), the corrected v - dv and the results of
     * accelerate() there with `added` zero. Otherwise dp only, with unchanged v and ZD_NO_CONVERGENCE. NULL: the core calls both other
     * functions. */
    int (*finish)(const void *data, const double *inputs, const double *t, const double *p, double *v, const double *allowed, double *Phi,
                  double *dp, double *pdot, double *vdot, double *lambda, double *power, double *pivots);
    /* The same for formulations in independent velocities, which are those not solved for: corrections change the dependent coordinates and
     * velocities only, instead of being shortest in the metric of M; `added` as above. D (m, nv - m), written together with the pivots, NULL
     * without them: derivatives of the velocities solved for with respect to the others, in their order. */
    int (*embed)(const void *data, const double *inputs, const double *t, const double *p, double *v, const double *added,
                 const double *allowed, double *Phi, double *dp, double *D, double *pdot, double *vdot, double *lambda, double *power,
                 double *pivots);
} zd_elimination;

/* Vector units: a processor that has one has all before it, too. */
enum zd_unit {
    ZD_BASELINE,            /* instructions of every processor of the architecture; products and sums are not contracted */
    ZD_AVX2,                /* AVX2 and FMA: contracted */
    ZD_AVX512               /* AVX-512 F, DQ and VL: contracted, too */
};

/* Functions for one unit and number of lanes. */
typedef struct zd_closed_form {
    enum zd_unit unit;      /* the unit that they are compiled for */
    int lanes;              /* SIMD lanes, trajectories per call, 1, 2, 4 or 8: each number of every array, of t, inputs and `data` is a
                             * group of so many; the value returned has a bit for each trajectory that failed */
    int orders;             /* at most 4: the first with sufficiently large pivots is used, which depends on the state only */
    const zd_elimination *order;    /* (orders,) */
    int embeddings;         /* at most 4, for independent velocities: the one that solves for the dependent ones is used */
    const zd_elimination *embedding;    /* (embeddings,) with embed() instead of accelerate() and finish(); for one lane only */
} zd_closed_form;

/* Taylor coefficients of the motion from (t, p, v), up to the given order: p_series (order + 1, nq), v_series (order + 1, nv), the first
 * ones being p and v; and work (order + 1,), NULL: not requested, of the energy input in (28), the first one being 0. Returns 0; any other
 * value: not available at this state. */
typedef struct zd_series {
    int scratch;            /* doubles of scratch memory per order; a call needs order + 1 times as many */
    int (*evaluate)(const void *data, const double *inputs, int order, double t, const double *p, const double *v, double *p_series,
                    double *v_series, double *work, double *scratch);
} zd_series;

/* The same in double-double arithmetic, with the residuals of the constraints: see double_double.h. Numbers, times, states and coefficients
 * are pairs of doubles, one after the other. Functions return 0; any other value: not available at this state. */
typedef struct zd_precise {
    int scratch;            /* pairs of scratch memory per order; a call needs order + 1 times as many */
    int (*series)(const double *numbers, int order, const double *t, const double *p, const double *v, double *p_series, double *v_series,
                  double *scratch);
    /* Phi (mh,) of (3) and Psi (m,) of (5); M (nv, nv), C (m, nv) and A (nq, nv) as doubles, of which only entries that may differ from zero
     * are written. */
    int (*residuals)(const double *numbers, const double *t, const double *p, const double *v, double *Phi, double *Psi, double *M,
                     double *C, double *A);
    void (*value)(int order, int n, const double *series, const double *h, double *to);     /* to (n,): sum_k series_k h^k */
} zd_precise;

/* Jacobian of the rates of a state (p, v): J (nq + nv, nq + nv) <- derivatives of pdot = A v and of vdot by (2) and (6), with one more row
 * for the power of (28) if ZD_POWER or ZD_PHI_T is provided. Returns 0; any other value: not available at this state. */
typedef struct zd_jacobian {
    int scratch;            /* doubles that a call needs */
    int (*evaluate)(const void *data, const double *inputs, double t, const double *p, const double *v, double *J, double *scratch);
    /* Psi_p (m, nq) <- derivatives of C v + Phi_t, (5), with respect to p, needed by `mixed` and `independent`; NULL: by differences. */
    int (*constraints)(const void *data, const double *inputs, double t, const double *p, const double *v, double *Psi_p,
                       double *scratch);
} zd_jacobian;

/* Named functions of the motion, such as the position of a point or the force in a joint. */
typedef struct zd_measure {
    const char *name;       /* "crank.angle" */
    const char *unit;       /* unit of each component */
    int size;               /* number of components */
    enum zd_depends depends;
} zd_measure;

typedef struct zd_measured {    /* memory for the results; NULL: not requested */
    double *value;          /* (size,) */
    double *rate;           /* (size,) time derivative of a measure of positions: jacobian v + explicit time derivative */
    double *jacobian;       /* (size, nv) for a measure of positions: d rate / d v; of velocities: d value / d v */
    double *bias;           /* (size,) second (positions) or first (velocities) time derivative minus jacobian vdot */
    int is_same_state;      /* 1: inputs, t, p, v and scratch are those of the previous call, so that values in scratch may be reused */
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

/* Constraints that are switched on and off together, such as those of a latch, a stop or a contact. Rows outside all groups are always
 * active. Only groups that are active and ZD_TWO_SIDED are simulated as yet. */
enum zd_group_kind {
    ZD_TWO_SIDED,           /* rows of a latch or a lock */
    ZD_ONE_SIDED,           /* one holonomic row: Phi >= 0, lambda <= 0, and one of them zero */
    ZD_FRICTION             /* nonholonomic rows, the slip velocities: either C v + Phi_t = 0, or a force against the slip */
};

typedef struct zd_group {
    const char *name;
    int first, rows;        /* first row of C, and number of rows */
    enum zd_group_kind kind;
    int is_active;          /* at the start: 1: closed, sticking; 0: open, sliding */
    int normal;             /* ZD_FRICTION: 1 + index of the ZD_ONE_SIDED group whose multiplier bounds the friction; 0: a fixed bound */
    double restitution;     /* ZD_ONE_SIDED: coefficient of restitution, 0 to 1 */
    double friction[2];     /* ZD_FRICTION: static and sliding; coefficients, or with a fixed bound in N or N m */
} zd_group;

/* A direction in which residuals are differentiated; NULL: zero. */
typedef struct zd_direction {
    double t;
    const double *p, *v;            /* (nq,), (nv,) */
    const double *parameters;       /* all parameters in their order */
    const double *inputs;           /* (2 inputs,) values and rates */
} zd_direction;

/* Derivatives in a direction, at constant vdot and lambda, p and v being independent of each other; NULL: not requested. */
typedef struct zd_derivatives {
    double *dynamics;       /* (nv,) of M vdot + d - f + C^T lambda, (2) */
    double *accelerations;  /* (m,) of C vdot - xi, (6) */
    double *velocities;     /* (m,) of C v + Phi_t, (5) */
    double *positions;      /* (mh,) of Phi, (3) */
    double *rates;          /* (nq,) of A v, (1) */
    double *potential;      /* derivative of V */
    double *power;          /* derivative of the power in (28), with that of moving constraints, lambda^T Phi_t */
} zd_derivatives;

/* Directional derivatives of the residuals. Returns 0; any other value: not available at this state. */
typedef struct zd_residuals {
    int scratch;            /* doubles that a call needs */
    int (*evaluate)(const void *data, const double *inputs, double t, const double *p, const double *v, const double *vdot,
                    const double *lambda, int directions, const zd_direction *direction, const zd_derivatives *derivatives,
                    double *scratch);       /* direction, derivatives: (directions,) */
} zd_residuals;

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
    const zd_pinned *pinned;
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
    double stability;        /* largest omega h at which a slightly damped oscillation does not grow; 0: unbounded */
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
