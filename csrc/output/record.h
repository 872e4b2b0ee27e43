/* What is kept of a run: one row of the caller's arrays for each saved instant. */
#ifndef ZD_RECORD_H
#define ZD_RECORD_H

#include "../motion/motion.h"

typedef struct zd_recorder {
    zd_motion *motion;
    const zd_outputs *outputs;      /* measures that every row has besides; NULL: none */
    const zd_system *measured;      /* whose they are */
    int width;                      /* how many components all of them have */
    double *scratch;                /* of the measures */
} zd_recorder;

zd_recorder zd_recorder_take(zd_arena *arena, const zd_settings *settings, zd_motion *motion);
/* Adds where the motion is. */
int zd_recorder_add(zd_recorder *self, zd_record *record);

#endif
