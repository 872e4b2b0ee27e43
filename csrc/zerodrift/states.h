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

/* ---- operations of a run for single states; on failure each writes one sentence into `message` ---- */

/* *is_deficient, unless NULL, <- 1 if some constraints depend on others, so that the multipliers are a choice. */
int zd_acceleration(const zd_system *system, int formulation, enum zd_on_singular on_singular, double t, const double *p, const double *v,
                    double *vdot, double *multipliers, int *is_deficient, char *message, int message_size);
/* The same at many states: t (states,), p (states, nq), v (states, nv) give vdot (states, nv), multipliers (states, m),
 * is_deficient (states,). */
int zd_accelerations(const zd_system *system, int formulation, enum zd_on_singular on_singular, int64_t states, const double *t,
                     const double *p, const double *v, double *vdot, double *multipliers, int *is_deficient, char *message,
                     int message_size);
/* Values u (states, functions) of the user functions of a system that read reactions, see zd_reading, as they are solved for with the
 * accelerations, and where these, the multipliers and efforts (states,), NULL for none, are given. */
int zd_read_solved(const zd_system *system, int formulation, int64_t states, const double *t, const double *p, const double *v, double *u,
                   char *message, int message_size);
int zd_read_states(const zd_system *system, int64_t states, const double *t, const double *p, const double *v, const double *vdot,
                  const double *multipliers, const zd_efforts *efforts, double *u);
/* A measure at many states: `first` has the memory of the first, that of the others follows it; scratch of the size that the measures
 * declare. vdot and multipliers may be NULL if the measure does not depend on them. `inputs` are those of the system, in all states the
 * same, or (states, functions) of zd_reading; so in the two functions that follow. */
int zd_measure_states(const zd_system *system, const double *inputs, int measure, int64_t states, const double *t, const double *p,
                      const double *v, const double *vdot, const double *multipliers, const zd_measured *first, double *scratch);

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

/* Values, rates, Jacobians and biases, all requested, of several measures of positions or velocities at many states; their components follow
 * one another, (states, size of all) of each, of Jacobians (states, size of all, nv). */
int zd_measure_rates(const zd_system *system, const double *inputs, int count, const int *measures, int64_t states, const double *t,
                     const double *p, const double *v, const zd_measured *first, double *scratch);
/* Projects p and v in place onto the constraints by the corrections of `settings`. Coordinates and velocities with nonzero hold_p, hold_v
 * are held fixed (either may be NULL); iterations may be NULL. */
int zd_project(const zd_system *system, const zd_settings *settings, double t, double *p, double *v,
               const int *hold_p, const int *hold_v, int *iterations, char *message, int message_size);
/* States p (count, nq), v (count, nv) at times t (count,) within a finished run, from its states of every step and its settings: the values
 * that the run itself would have saved at these times. Increasing times are fastest. */
int zd_states_between(const zd_system *system, const zd_settings *settings, const zd_saved *saved, int64_t count, const double *t, double *p,
                      double *v, char *message, int message_size);

#endif
