/* Entry of the table of corrections: a change of the right side of (6), or of the state after a step. */
#pragma once

#include "../point/point.h"

typedef struct zd_motion zd_motion;     /* motion.h */

/* Accuracy to which a correction satisfies the constraints after a step; all 0: no correction does. */
typedef struct zd_constraint_target {
    int positions, velocities;      /* true for each of the two that is corrected */
    int every;                      /* steps between corrections */
    int in_mass_metric;             /* true if corrections are M-orthogonal to the constraint manifold */
    double tolerance;               /* largest |Phi| of each constraint, in units of its size, zd_run_sizes() */
    int max_iterations;
} zd_constraint_target;

/* `given`: its parameters, as doubles in the order of its card. */
typedef struct zd_correction {
    zd_card card;
    int requires;           /* terms that the system has to provide */
    int needs;              /* terms it needs in addition to those of the acceleration */
    /* True if parameters that are valid individually contradict each other, with a message. NULL: they never do. */
    int (*clash)(const void *given, char *message, size_t size);
    int (*every)(const void *given);    /* steps between two applications; NULL: in each step */
    zd_constraint_target (*target)(const void *given);     /* NULL: it does not correct the constraints */
    void *(*create)(zd_arena *arena, const zd_system *system, const void *given);
    /* Functions; NULL if the correction has none of this kind. */
    int (*after_step)(void *self, zd_motion *motion);
    /* xi -> xi_stab; `extra`: the correction's own part of the integrated state */
    void (*stabilize)(void *self, const zd_point *point, const double *extra, double *rhs);
    int (*extra_size)(const zd_system *system, const void *given);
    void (*extra_rate)(const zd_point *point, double *rate);
} zd_correction;
