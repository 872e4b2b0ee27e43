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
 * Plain declarations and nothing else: CFFI reads this very text. Equation numbers are those of W. Blajer, "Elimination of
 * Constraint Violation and Accuracy Aspects in Numerical Simulation of Multibody Systems", Multibody System Dynamics 7 (2002)
 * 265-284. Matrices are row-major; SI units throughout.
 *
 *     nq  coordinates p       mh  holonomic rows of Phi         m = mh + mn  rows of C
 *     nv  velocities v        mn  nonholonomic rows
 */
#ifndef ZERODRIFT_SYSTEM_H
#define ZERODRIFT_SYSTEM_H

/* Changes whenever something below does that compiled code depends on. */
enum { ZD_INTERFACE_VERSION = 2 };

/* ---- statuses: 0 done; positive: stopped early, what was recorded is valid; negative: failed ---- */

enum zd_status {
    ZD_DONE = 0,
    ZD_PAUSED = 1,            /* the time slice is over: call again */
    ZD_FULL = 2,              /* the record is full: give another */
    ZD_EVENT = 4,             /* a terminal event ended the run; 3 is left to whoever stops it from outside */
    ZD_NOT_FINITE = -1,       /* the state left the range of doubles */
    ZD_NOT_DEFINITE = -2,     /* M is not positive definite */
    ZD_DEPENDENT_ROWS = -3,        /* rows of C that count are dependent, to the formulation's own precision */
    ZD_SINGULAR = -4,         /* a leading matrix is singular */
    ZD_NO_CONVERGENCE = -5,   /* the position correction did not reach its tolerance */
    ZD_NO_STEP = -6,          /* the equations of an implicit step were not solved */
    ZD_BAD_START = -7,        /* the initial state violates the constraints */
    ZD_BAD_ARGUMENT = -8,
    ZD_NO_MEMORY = -9,
    ZD_CALLBACK = -10,        /* a system's own evaluation failed */
    ZD_UNREACHABLE = -11,     /* the tolerance is below what doubles can reach */
    ZD_NO_EMBEDDING = -12,    /* p = g(q) was not solved */
    ZD_NOT_SYMMETRIC = -13,   /* M is not */
    ZD_TINY_STEP = -14,       /* the error asked for needs steps that time does not resolve */
    ZD_UNSUITED = -15,        /* the formulation cannot take this system */
    ZD_BAD_TERM = -16,        /* a term of the system is not finite where the state is */
    ZD_UNSUITED_INTEGRATOR = -17,   /* the integrator cannot take this system */
    ZD_BRANCH = -18,          /* the step ended where its velocities do not lead: on another assembly branch, or nearly */
    ZD_BIFURCATION = -19,     /* constraints that are independent elsewhere are not here, and do not determine the motion */
    ZD_CONTRADICTION = -20,   /* constraints that follow from others ask for something else */
    ZD_BIFURCATION_PASSED = -21,    /* a bifurcation lies within the step, or so near that it cannot follow the motion there */
    ZD_TOO_MANY_STEPS = -22,  /* settings->max_steps were taken */
    ZD_NOT_JACOBIAN = -23     /* C or Phi_t are not the derivatives of Phi */
};

/* ---- a system: one function evaluates what is wanted at (t, p, v) ---- */

enum zd_term {
    ZD_A = 1,          /* kinematic matrix of (1); absent: identity */
    ZD_M = 2,          /* mass matrix of (2), both triangles */
    ZD_BIAS = 4,       /* d of (2); absent: zero */
    ZD_FORCE = 8,      /* f of (2); absent: zero */
    ZD_PHI = 16,       /* (3) */
    ZD_C = 32,         /* (5): holonomic rows first */
    ZD_PHI_T = 64,     /* what (5) has besides C v: time derivatives of Phi at fixed p; absent: zero */
    ZD_XI = 128,       /* (6), all that is not C vdot, also from Phi_t */
    ZD_POTENTIAL = 256,
    ZD_POWER = 512,    /* Edot of (28): power of the forces in f that V does not describe, and dV/dt at fixed p */
    ZD_COMPLEMENT = 1024,   /* D of (14), C D = 0; a system need not have it: absent, it is found from C by (16) */
    ZD_GAMMA = 2048,        /* what vdot has besides D udot, (15); goes with D */
    ZD_MOVED = 4096,   /* said to the system, not asked of it: t or p differ from its last call with this scratch */
    ZD_TIMELESS = 8192 /* said by the system among what it provides: none of its terms depends on t but through p and v */
};

typedef struct zd_terms {
    double *A;          /* (nq, nv) */
    double *M;          /* (nv, nv) */
    double *d;          /* (nv,) */
    double *f;          /* (nv,) */
    double *Phi;        /* (mh,) */
    double *C;          /* (m, nv) */
    double *Phi_t;      /* (m,) */
    double *xi;         /* (m,) */
    double *V;          /* (1,) J */
    double *power;      /* (1,) W */
    double *D;          /* (nv, nv - m) */
    double *gamma;      /* (nv,) */
    double *scratch;    /* (scratch,) what a system keeps while (t, p) stays, such as sines */
} zd_terms;

/* Writes the terms in `want` and no others. Pure: all it may keep is in out->scratch. Returns ZD_DONE; anything else: it failed. */
typedef int zd_evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out);

/* p = g(q) of (18), on the branch that p, an estimate of it, is on when called. Returns 0, or ZD_NO_CONVERGENCE where there is no such p. */
typedef int zd_embed(const void *data, double t, const double *q, double *p);

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
    const char *failure;    /* what ZD_CALLBACK from evaluate() means, in a sentence; may be NULL */
} zd_system;

/* ---- a kind of system: with parameters, names, a start and a drawing ---- */

typedef struct zd_card {
    const char *name;
    const char *summary;     /* one sentence */
    const char *equations;   /* "(8), (25)" */
    int order;               /* of an integrator; else 0 */
    int error_order;         /* of its error estimate; 0: there is none, and steps are of fixed size */
    double stability;        /* the largest omega h at which a motion that is somewhat damped does not grow; 0: there is none */
} zd_card;

enum zd_rule { ZD_ANY, ZD_POSITIVE, ZD_NOT_NEGATIVE, ZD_CHOICE };

typedef struct zd_parameter {
    const char *name;
    const char *unit;
    const char *text;           /* a ZD_CHOICE lists its words here: "open crossed" */
    int size;
    enum zd_rule rule;
    const double *initial;      /* (size,) or NULL: derived from the others, handed to the system as NaN */
} zd_parameter;

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
