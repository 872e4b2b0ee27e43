/* A row of the table of corrections: something done to the right side of (6), or to the state after a step. */
#ifndef ZD_CORRECTION_H
#define ZD_CORRECTION_H

#include "../point/point.h"

typedef struct zd_motion zd_motion;     /* motion.h */

/* How well the constraints hold after a step, as a correction sees to it; all 0: nothing does. */
typedef struct zd_constraint_target {
    int positions, velocities;      /* which of the two are held */
    int every;                      /* how many steps */
    int in_mass_metric;             /* whether nothing is moved along the manifold of the constraints */
    double tolerance;               /* of every |Phi|, in units of its row's size, zd_run_sizes() */
    int max_iterations;
} zd_constraint_target;

/* `given` are its parameters, the doubles that its card lists, one after the other. */
typedef struct zd_correction {
    zd_card card;
    int requires;           /* terms that the system has to provide */
    int needs;              /* terms it needs beside those of the acceleration */
    /* Whether parameters do not go together, each of which keeps to its rule: then it says so. NULL: they always do. */
    int (*clash)(const void *given, char *message, size_t size);
    int (*every)(const void *given);    /* how many steps it is made; NULL: in each */
    zd_constraint_target (*target)(const void *given);     /* NULL: it does not hold the constraints */
    void *(*take)(zd_arena *arena, const zd_system *system, const void *given);
    /* NULL: what is not done. */
    int (*after_step)(void *self, zd_motion *motion);
    /* xi -> xi_stab, with what the correction has integrated along with the state, if it does */
    void (*stabilize)(void *self, const zd_point *point, const double *extra, double *rhs);
    int (*extra_size)(const zd_system *system, const void *given);
    void (*extra_rate)(const zd_point *point, double *rate);
} zd_correction;

#endif
