/* Limits by which a step is accepted, checked, repeated or resized: for single runs and for lanes alike. Distances and speeds are in
 * characteristic scales.
 */
#pragma once

/* ---- closed-form path: pivots relative to their scales, zd_closed_form_find_scales() ---- */

#define ZD_LARGE_PIVOT 0x1p-3       /* the first elimination order with none below is preferred */
#define ZD_SUFFICIENT_PIVOT 0x1p-5  /* at the start of a step, otherwise the first with none below: 5 bits of D and 10 of M are then lost */
#define ZD_SMALL_PIVOT 0x1p-6       /* at the end of a step: below, the matrix path is ill-conditioned, too */
#define ZD_SHRUNK_PIVOT 0x1p-4      /* ratio to the pivot at the start of the step: below, values in between are unknown */
#define ZD_LOST_PIVOT 0x1p-20       /* pivot of D^T M D, relative to its diagonal: below, too many of 53 bits are lost */
#define ZD_FAR_PATH 1.0             /* displacement in a step: a longer one needs the checks of the matrix path */

/* Largest ratio of the violation after the first iteration of a position correction to that before: by Kantorovich's theorem there is then
 * one solution near the start of the iteration. */
#define ZD_TRUSTED_SHARE 0.25

/* ---- displacement against velocities: guard.c ---- */

#define ZD_LONG_PATH 0.25           /* displacement: a longer step may rotate a row of C noticeably */
#define ZD_CALM_DETOUR 48.0         /* ratio of displacement to detour: above, omega h is below a half */
#define ZD_FASTER_SPEED 1.5         /* ratio of |pdot|^2 to the largest at a full check: below, the motion has not changed much */

/* ---- full checks of fixed steps: guard.c, resolution.c ---- */

enum {
    ZD_UNSTABLE_STREAK = 3,         /* consecutive steps that must be too long: in a single one p1 - p0 may be zero by chance */
    ZD_CHECK_EVERY = 8,             /* steps between full checks, at first */
    ZD_CHECK_SELDOM = 64,           /* at most: ZD_CHECK_EVERY times a power of two, not above the interval of consistency.c */
};
#define ZD_AMPLE_STABILITY 0x1p-8   /* ratio of (omega h)^4 to its limit: a quarter of the largest omega h */
#define ZD_DECAY (1.0 / 128)       /* decay of sums per check, or per eight steps if checks are further apart */
#define ZD_ERROR_SHARE 1e-3         /* error of a coordinate, relative to the distance it has covered */
#define ZD_NOTED_ERROR 1e-3         /* error of a coordinate: a smaller one is not recorded in the statistics */
#define ZD_UNRESOLVED_ERROR 0.03    /* error of a coordinate: a larger one is reported to the user */
#define ZD_AMPLE_RESOLUTION 0x1p-4  /* fraction of the two errors above below which checks may be less frequent */

/* ---- adaptive steps: adaptive.c, runge_kutta.h ---- */

#define ZD_SAFETY 0.8               /* factor of the step size that the error estimate suggests */
#define ZD_MIN_FACTOR 0.2           /* ratios of successive step sizes */
#define ZD_MAX_FACTOR 10.0
enum {
    ZD_CHECK_STIFFNESS_EVERY = 32,  /* steps, where a check takes an evaluation */
    ZD_STIFF_AFTER = 10,            /* steps at the stability limit after which the problem counts as stiff */
    ZD_NOT_STIFF_AFTER = 3,         /* consecutive shorter steps after which it no longer does */
    ZD_COLLAPSES = 50,              /* steps at one place that get nowhere, after which the run fails: collapse.c */
};
#define ZD_STABILITY_LIMIT 0.95     /* ratio of |lambda h| to the largest stable value */
#define ZD_STATE_ROUNDING 0x1p-42   /* relative difference of states that errors of accelerations near a bifurcation cause */

/* ---- warnings of completed runs, and runs in lanes that are repeated individually to give them ---- */

#define ZD_REPORTED_PIVOT 0x1p-26           /* relative pivot: below, half of the digits of accelerations are lost */
#define ZD_LARGEST_ENERGY_ERROR 0.005       /* error of the energy balance (28), relative to the largest kinetic energy */
#define ZD_LARGEST_ENERGY_CORRECTION 0.02   /* energy of one correction, relative to the largest kinetic energy */
#define ZD_ENERGY_ROUNDING 1e-10            /* error of the energy balance that is rounding, relative to kinetic and potential energy */

/* ---- events and bifurcations ---- */

#define ZD_LARGEST_TURN 2.0         /* rad: change of an angle in an adaptive step with contacts, whose gaps may be periodic in it */
#define ZD_SMALL_DISPLACEMENT 0.5   /* displacement: the gaps of contacts in a shorter step follow from those at both ends */

#define ZD_TIME_RESOLUTION (4 * 0x1p-52)    /* rounding of times, and final width of a bracket of them, relative to the times */
