/* Taylor series, Jacobians and directional derivatives of the equations: part of system.h. */
#ifndef ZERODRIFT_DERIVATIVES_H
#define ZERODRIFT_DERIVATIVES_H

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

#endif
