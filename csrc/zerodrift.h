/* zerodrift: constrained multibody systems without constraint drift.
 *
 * The whole public C interface, and the very text that CFFI reads: plain declarations and nothing else. Equation numbers
 * are those of W. Blajer, "Elimination of Constraint Violation and Accuracy Aspects in Numerical Simulation of Multibody
 * Systems", Multibody System Dynamics 7 (2002) 265-284. Matrices are row-major; SI units throughout.
 *
 *     nq  coordinates p       mh  holonomic rows of Phi         m = mh + mn  rows of C
 *     nv  velocities v        mn  nonholonomic rows
 */
#ifndef ZERODRIFT_H
#define ZERODRIFT_H

/* ---- statuses: 0 done; positive: stopped early, what was recorded is valid; negative: failed ---- */

enum zd_status {
    ZD_DONE = 0,
    ZD_PAUSED = 1,            /* the time slice is over: call again */
    ZD_FULL = 2,              /* the record is full: give another */
    ZD_NOT_FINITE = -1,       /* the state left the range of doubles */
    ZD_NOT_DEFINITE = -2,     /* M is not positive definite */
    ZD_DEPENDENT = -3,        /* rows of C that count are dependent, to the formulation's own precision */
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
    ZD_BIFURCATION = -16,     /* constraints that are independent elsewhere are not here, and do not determine the motion */
    ZD_CONTRADICTION = -17    /* constraints that follow from others ask for something else */
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
    ZD_MOVED = 4096    /* said to the system, not asked of it: t or p differ from its last call with this scratch */
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

/* Writes the terms in `want` and no others. Pure: all it may keep is in out->scratch. Returns 0, or ZD_CALLBACK. */
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
    const char *failure;    /* what ZD_CALLBACK from evaluate() means, in a sentence; may be NULL */
} zd_system;

/* The first of the wanted terms that has an entry which is not finite, as its bit; 0: there is none. */
int zd_first_not_finite(const zd_system *system, int want, const zd_terms *terms);

/* ---- the four tables ---- */

typedef struct zd_card {
    const char *name;
    const char *summary;     /* one sentence */
    const char *equations;   /* "(8), (25)" */
    int order;               /* of an integrator; else 0 */
    int error_order;         /* of its error estimate; 0: there is none, and steps are of fixed size */
} zd_card;

enum zd_table { ZD_SYSTEMS, ZD_FORMULATIONS, ZD_INTEGRATORS, ZD_CORRECTIONS };

int zd_rows(enum zd_table table);
const zd_card *zd_row(enum zd_table table, int row);

/* ---- built-in systems ---- */

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

const zd_kind *zd_kind_of(int row);

/* ---- settings of a run ---- */

enum zd_metric { ZD_MASS_METRIC, ZD_IDENTITY_METRIC };

typedef struct zd_projection {      /* (25)-(27) */
    int every;                      /* steps between corrections; 0: off */
    double tolerance;               /* of max |Phi| */
    int max_iterations;
    enum zd_metric metric;
    int positions, velocities;      /* which of the two are corrected */
} zd_projection;

typedef struct zd_baumgarte {       /* (23) */
    int on;
    double alpha, beta;             /* 1/s, 1/s^2: of Psi and Phi */
    double integral;                /* 1/s^3: of the time integral of Phi; 0: not integrated */
} zd_baumgarte;

typedef struct zd_energy {          /* (28), (29) */
    int every;                      /* 0: off */
} zd_energy;

/* What to do where constraints that are independent elsewhere are not: a bifurcation. */
enum zd_on_singular { ZD_STOP, ZD_CONTINUE };   /* the latter: on the branch of least acceleration */

typedef struct zd_settings {
    int formulation, integrator;    /* rows of the tables */
    double t0, t1;                  /* s */
    double step;                    /* s; the last step is shortened to end at t1. 0: chosen by the error estimate */
    double rtol, atol;              /* of the state, per step, where steps are chosen */
    double first_step, max_step;    /* s; 0: no bound, nothing given */
    long save_every;
    const double *t_eval;           /* (t_evals,) times to save at, instead of every so many steps; NULL: none */
    long t_evals;
    zd_projection projection;
    zd_baumgarte baumgarte;
    zd_energy energy;
    enum zd_on_singular on_singular;
} zd_settings;

/* ---- a run ---- */

typedef struct zd_statistics {
    long steps;
    long rejected;              /* steps whose error estimate was too large, or that failed and were tried smaller */
    long output_steps;          /* shorter ones, to times between steps that are to be saved */
    long evaluations;           /* calls of the system */
    long factorizations;        /* of leading matrices */
    long solves;                /* with them */
    long position_iterations;
    long max_position_iterations;   /* in one step */
    long velocity_corrections;
    long energy_corrections;
    long energy_skipped;        /* where (29) has no bounded solution: T too small for the violation */
    long implicit_iterations;   /* Newton iterations of implicit integrators */
    long embedding_iterations;  /* Newton iterations for p = g(q) */
    long repartitions;          /* changes of the independent variables between steps */
    long rank;                  /* of C; less than m where constraints are redundant */
    long rank_drops;            /* steps in which it was less for a while */
} zd_statistics;

typedef struct zd_record {      /* one row per saved instant; memory belongs to the caller */
    long capacity, rows;
    double *t;                  /* (capacity,) */
    double *p, *v, *multipliers;                    /* (capacity, nq), (capacity, nv), (capacity, m) */
    double *position_violation, *velocity_violation;    /* (capacity, mh), (capacity, m) */
    double *kinetic, *potential, *input, *energy_violation; /* (capacity,) J; the last three NULL without potential */
    int *iterations;            /* (capacity,) most position iterations of a step since the row before */
} zd_record;

typedef struct zd_run zd_run;

/* Steps from t0 to t1: a span within rounding of a whole number of steps has that many, else a shorter one is added. */
double zd_count_steps(double t0, double t1, double step);

/* All memory of a run is taken here. On failure returns NULL and says why in `status` and `message`. */
zd_run *zd_run_create(const zd_system *system, const zd_settings *settings, const double *p0, const double *v0,
                      int *status, char *message, int message_size);
void zd_run_free(zd_run *run);
/* Steps until the end, a full record, or about `seconds` have passed. The slicing changes no bit of the result. */
int zd_run_advance(zd_run *run, zd_record *record, double seconds);
double zd_run_progress(const zd_run *run);                  /* 0 ... 1 */
const char *zd_run_message(const zd_run *run);              /* the first failure, one sentence */
const zd_statistics *zd_run_statistics(const zd_run *run);
/* The constraints that follow from others wherever the system goes; their number. rows (m,), increasing. */
int zd_run_redundant(const zd_run *run, int *rows);

/* ---- the same operations outside a run; each writes a sentence into `message` where it fails ---- */

int zd_acceleration(const zd_system *system, int formulation, enum zd_on_singular on_singular, double t, const double *p, const double *v,
                    double *vdot, double *multipliers, char *message, int message_size);
/* Corrects p and v in place as settings->projection says, holding coordinates and velocities where hold_p, hold_v are
 * nonzero (either may be NULL); iterations may be NULL. */
int zd_project(const zd_system *system, const zd_settings *settings, double t, double *p, double *v,
               const int *hold_p, const int *hold_v, int *iterations, char *message, int message_size);
/* One step, corrected, from (p, v) at settings->t0 to settings->t1: what a run does between its own steps. In place. */
int zd_step(const zd_system *system, const zd_settings *settings, double *p, double *v, char *message, int message_size);

#endif
