/* Recorder: writes one sample into the caller's arrays for each saved instant. */
#ifndef ZD_RECORD_H
#define ZD_RECORD_H

#include "../motion/motion.h"

typedef struct zd_recorder {
    zd_motion *motion;
    const zd_outputs *outputs;      /* measures recorded in every sample; NULL: none */
    const zd_system *measured;      /* system of these measures */
    int width;                      /* number of components of all of them */
    double *scratch;                /* scratch memory of the measures */
    int needs;                      /* bits of the terms needed for a sample, evaluated in one call */
} zd_recorder;

zd_recorder zd_recorder_create(zd_arena *arena, const zd_settings *settings, zd_motion *motion);
static inline int zd_record_has_room(const zd_record *record) { return record->rows < record->capacity; }
/* Adds a sample of the present point; ZD_FULL if there is no space, and nothing is changed. */
int zd_recorder_add(zd_recorder *self, zd_record *record);

#endif
