/* Statuses, and the terms of the equations that a system evaluates: part of system.h, which says what letters mean. */
#ifndef ZERODRIFT_TERMS_H
#define ZERODRIFT_TERMS_H

/* ---- statuses: 0 done; positive: stopped early, what was recorded is valid; negative: failed ---- */

/* One status per line: its number, the exception that Python raises ("": the base class, ZerodriftError), and its meaning. More specific
 * messages with numbers are in explain.c. */
#define ZD_STATUS_LIST(STATUS) \
    STATUS(ZD_DONE, 0, "", "done") \
    STATUS(ZD_PAUSED, 1, "", "the time slice is over, or an event has acted: call again") \
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
    STATUS(ZD_COLLAPSED, -26, "StepFailed", "the step size has collapsed at one place") \
    STATUS(ZD_SEVERAL_MOTIONS, -27, "NoUniqueMotion", \
           "reactions have no unique solution: forces must not depend so strongly on those that they read") \
    STATUS(ZD_CHATTERS, -28, "StepFailed", \
           "an event must not act again and again at one instant, as where a ball bounces ever less: what stays needs a constraint")

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

/* Writes the terms in `want` and no others. Must be a pure function, except for out->scratch. Returns ZD_DONE; ZD_NOT_FINITE if
 * terms are not finite or not defined at this state, where adaptive steps are repeated shorter; any other value: failed. */
typedef int zd_evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out);

/* p <- g(q) of (18), on the branch of the estimate in p. Returns 0, or ZD_NO_CONVERGENCE if there is no such p. */
typedef int zd_embed(const void *data, double t, const double *q, double *p);

#endif
