/* A row of the table of corrections: something done to the right side of (6), or to the state after a step. */
#ifndef ZD_CORRECTION_H
#define ZD_CORRECTION_H

#include "../point/point.h"

typedef struct zd_motion zd_motion;     /* motion.h */

typedef struct zd_correction {
    zd_card card;
    /* Every how many steps it is made, 0: never. */
    int (*every)(const zd_settings *settings);
    int needs;              /* terms it needs beside those of the acceleration */
    void *(*take)(zd_arena *arena, const zd_system *system, const zd_settings *settings);
    /* NULL: what is not done. */
    int (*after_step)(void *self, zd_motion *motion);
    /* xi -> xi_stab, with what the correction has integrated along with the state, if it does */
    void (*stabilize)(void *self, const zd_point *point, const double *extra, double *rhs);
    int (*extra_size)(const zd_system *system, const zd_settings *settings);
    void (*extra_rate)(const zd_point *point, double *rate);
} zd_correction;

#endif
