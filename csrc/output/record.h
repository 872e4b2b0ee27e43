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
    int needs;                      /* terms of a row, evaluated at once */
} zd_recorder;

zd_recorder zd_recorder_take(zd_arena *arena, const zd_settings *settings, zd_motion *motion);
static inline int zd_record_has_room(const zd_record *record) { return record->rows < record->capacity; }
/* Adds where the motion is; ZD_FULL where there is no room, and nothing has happened. */
int zd_recorder_add(zd_recorder *self, zd_record *record);

#endif
