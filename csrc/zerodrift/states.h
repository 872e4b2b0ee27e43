/* Operations at given states, without a run: part of zerodrift.h. */
#ifndef ZERODRIFT_STATES_H
#define ZERODRIFT_STATES_H

#include "run.h"

/* ---- a system perturbed by rounding errors, to measure the sensitivity of its motion ---- */

/* Factors near 1 of the arguments of evaluate() and of the terms that it writes. Factors of M must be symmetric. */
typedef struct zd_perturbation {
    const double *numbers;      /* data of the series, found here as the first member; NULL: no series */
    const zd_series *series;    /* Taylor series of the perturbed motion; NULL: none */
    const zd_system *system;    /* the unperturbed system */
    double t;
    const double *p, *v;    /* (nq,), (nv,) */
    zd_terms terms;         /* factors of each term; NULL: unperturbed */
    zd_measures measures;   /* these two are written by zd_perturbed(): unperturbed, with the perturbation as data */
    zd_reading reading;
} zd_perturbation;

zd_system zd_perturbed(zd_perturbation *perturbation);      /* refers to the perturbation and its system, which must outlive it */

/* ---- a phase of a system with groups, which must outlive it ---- */

/* The system with the constraints that are active in these states (groups,), as zd_transition has them, and forces of sliding friction. NULL
 * without memory. */
zd_system *zd_phase_new(const zd_system *system, const signed char *state);
void zd_phase_free(zd_system *phase);
const int *zd_phase_rows(const zd_system *phase);       /* (m,): the constraint of the system that each one of the phase is */
/* Bound of the friction of a group of the system, from the multipliers of all of its constraints; `which`: 0 static, 1 sliding. */
double zd_friction_bound(const zd_system *system, int group, int which, const double *multipliers);

/* ---- operations of a run for single states; on failure each writes one sentence into `message` ---- */

/* Accelerations at states t (states,), p (states, nq), v (states, nv), those of these that are not NULL: vdot (states, nv), multipliers
 * (states, m); is_deficient (states,), 1 if some constraints depend on others, so that the multipliers are a choice; and, of a system with
 * zd_reading, the values u (states, functions) of its user functions. */
int zd_accelerations(const zd_system *system, int formulation, enum zd_on_singular on_singular, int64_t states, const double *t,
                     const double *p, const double *v, double *vdot, double *multipliers, int *is_deficient, double *u, char *message,
                     int message_size);
/* vdot (states, nv) of a system with groups of constraints, from the multipliers (states, m) of all rows there. */
int zd_accelerations_with(const zd_system *system, int formulation, int64_t states, const double *t, const double *p, const double *v,
                          const double *multipliers, double *vdot, char *message, int message_size);
/* Values u (states, functions) of these user functions where accelerations, multipliers and efforts (states,), NULL for none, are given. */
int zd_read_states(const zd_system *system, int64_t states, const double *t, const double *p, const double *v, const double *vdot,
                  const double *multipliers, const zd_efforts *efforts, double *u);
/* Measures at many states: `first` has the memory of the first, that of the others follows it, and components of several measures follow one
 * another, (states, size of all); scratch of the size that the measures declare. vdot and multipliers may be NULL if no measure depends on
 * them. `inputs` are those of the system, in all states the same, or (states, functions) of zd_reading. */
int zd_measure_states(const zd_system *system, const double *inputs, int count, const int *measures, int64_t states, const double *t,
                      const double *p, const double *v, const double *vdot, const double *multipliers, const zd_measured *first,
                      double *scratch);

/* The terms in `want` at many states t (states,), p (states, nq), v (states, nv): `first` has the memory of the first, the others follow
 * it, (states, size) of each term, with a single scratch. */
int zd_evaluate_states(const zd_system *system, int want, int64_t states, const double *t, const double *p, const double *v,
                       const zd_terms *first);

enum zd_residual_part {
    ZD_RESIDUAL_R = 1,      /* (nv,) M vdot + d - f + C^T lambda, of (2) */
    ZD_RESIDUAL_S = 2,      /* (m,) C vdot - xi, of (6) */
    ZD_RESIDUAL_PSI = 4,    /* (m,) C v + Phi_t, of (5) */
    ZD_RESIDUAL_PDOT = 8,   /* (nq,) A v, (1) */
    ZD_RESIDUAL_POWER = 16  /* the power in (28), lambda^T Phi_t included */
};

/* Derivatives of residuals, with vdot, lambda and inputs (of systems with zd_reading alone) frozen: those of the parts one behind the
 * other, (directions, their entries), along directions dt (directions,), dp (directions, nq), dv (directions, nv) of these sizes
 * (directions,) in characteristic scales, zero where nothing changes along one: the system's own, or by differences to 1e-12, is_rough:
 * to 1e-8. */
int zd_residuals_along(const zd_system *system, const double *inputs, int parts, double t, const double *p, const double *v,
                       const double *vdot, const double *lambda, int is_rough, int64_t directions, const double *dt, const double *dp,
                       const double *dv, const double *sizes, double *derivatives);

/* A motion at many states, in the system's coordinates. */
typedef struct zd_given_motion {
    const zd_system *system;
    int64_t states;
    const double *t, *p, *v, *vdot;     /* (states,), (states, nq), (states, nv), (states, nv) */
    const double *force;    /* (states, nv): f - d; NULL: the system's */
    int efforts;
    const double *rows;     /* (states, efforts, nv): derivatives of the rates along which efforts act, with respect to v */
    const double *weight;   /* (efforts,): magnitudes of efforts that count alike */
    double length;          /* m: characteristic length */
    const double *scale, *inverse_scale;    /* (nv,): characteristic scale of each velocity, and its inverse */
} zd_given_motion;

typedef struct zd_needed_efforts {
    double *effort, *multipliers;       /* (states, efforts), (states, m) */
    double *residual;       /* (states,) N/sqrt(kg): norm in the mass metric of the force that the efforts do not give */
    double *wanted;         /* (states,) N/sqrt(kg): norm in the mass metric of the force that they should give */
    double *power;          /* (states,) W: of all efforts */
    double *rank;           /* (states,): number of independent efforts */
    int64_t sample;         /* the last one that was examined */
} zd_needed_efforts;

/* Efforts that drive a given motion, and its multipliers. More efforts than freedoms have the least sum of squares, in units of their
 * weights; with fewer the residual is the least. Returns ZD_DONE, ZD_BAD_START if the motion violates constraints, ZD_NOT_DEFINITE if a
 * motion that they allow has no mass, ZD_NO_MEMORY or ZD_CALLBACK. */
int zd_inverse_dynamics(const zd_given_motion *given, zd_needed_efforts *to);

/* ---- motion by prescribed quantities, without forces and masses ---- */

/* Quantities are components of measures of positions, or coordinates. */
typedef struct zd_prescribed_motion {
    const zd_system *system, *measured;     /* the latter provides the measures: the system, or one with the same equations */
    int measures, components;   /* components of all measures */
    const int *measure;         /* (measures,): indices */
    int quantities;
    const int *which;           /* (quantities,): component among those of all measures, one after another; -1 - i: coordinate i */
    int64_t samples;
    const double *value;        /* (samples, quantities + 1): values, then the time in s, which increases if there are rates */
    const double *rate, *second;    /* (samples, quantities): derivatives of the values; NULL: positions alone */
    const double *inverse_scale_p, *scale_v;    /* (nq,), (nv,): characteristic scales, of p in reciprocals */
} zd_prescribed_motion;

typedef struct zd_tracked {
    double *p, *v, *vdot;       /* (samples, nq), (samples, nv), (samples, nv): not written beyond dead points */
    int64_t dead;               /* first sample beyond a dead point; -1: none */
    double *reached;            /* (quantities + 1,): the last values before it, then the time */
    int64_t contradicting;      /* first sample where quantities or their rates contradict each other or the constraints; -1: none */
    double contradiction;       /* residual there, relative to the changes or rates */
    int is_determined;          /* 1: the quantities determine all positions at p */
} zd_tracked;

/* The motion from p (nq,) on, which satisfies the constraints at the first time. Where the quantities do not determine all positions there,
 * moves have minimum norm in characteristic scales. */
int zd_kinematics(const zd_prescribed_motion *motion, const double *p, zd_tracked *found);
/* p (nq,) <- position with the first values, by Newton's method from this guess, with steps of minimum norm in characteristic scales.
 * Returns ZD_NO_CONVERGENCE where there is none near it. *iteration: size of the last step. */
int zd_find_position(const zd_prescribed_motion *motion, double *p, double *iteration);
/* rate, second (samples, columns) <- derivatives at the inner samples t of the quintic splines through value, with the given ones at both
 * ends. factors (samples, 4), of zeros, is overwritten. */
void zd_quintic_spline(int64_t samples, int columns, const double *t, const double *value, double *factors, double *rate, double *second);

/* ---- states on the constraints ---- */

/* Projects p and v in place onto the constraints by the corrections of `settings`. Coordinates and velocities with nonzero hold_p, hold_v
 * are held fixed (either may be NULL); iterations may be NULL. */
int zd_project(const zd_system *system, const zd_settings *settings, double t, double *p, double *v,
               const int *hold_p, const int *hold_v, int *iterations, char *message, int message_size);
/* States p (count, nq), v (count, nv) at times t (count,) within a finished run, from its states of every step and its settings: the values
 * that the run itself would have saved at these times. Increasing times are fastest. */
int zd_states_between(const zd_system *system, const zd_settings *settings, const zd_saved *saved, int64_t count, const double *t, double *p,
                      double *v, char *message, int message_size);

#endif
