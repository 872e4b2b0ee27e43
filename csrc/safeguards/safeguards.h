/* Whether a step can be believed: detection only, whatever is done about it. */
#ifndef ZD_SAFEGUARDS_H
#define ZD_SAFEGUARDS_H

#include "consistency.h"
#include "crossing.h"
#include "guard.h"
#include "resolution.h"

typedef struct zd_safeguards {
    zd_guard guard;
    zd_crossing crossing;
    zd_resolution resolution;   /* where steps are of fixed size */
    zd_consistency consistency;
} zd_safeguards;

void zd_safeguards_take(zd_safeguards *self, zd_arena *arena, zd_motion *motion, const zd_settings *settings, const zd_card *method,
                        const zd_last *last);
/* Keeps where the motion is; `step` is the one that begins there. */
int zd_safeguards_begin(zd_safeguards *self, int64_t step);
/* Compares that with where a step of size h has led, and keeps it. Of one of so many parts of a step, 0: of a whole one, only its rotations
 * count, as it may be given up yet. */
int zd_safeguards_judge(zd_safeguards *self, double h, int64_t next_step, int parts);

#endif
