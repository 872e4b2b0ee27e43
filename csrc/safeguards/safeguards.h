/* Acceptance of steps: detection only; the reaction is in step/step.c. */
#ifndef ZD_SAFEGUARDS_H
#define ZD_SAFEGUARDS_H

#include "consistency.h"
#include "crossing.h"
#include "guard.h"
#include "resolution.h"

typedef struct zd_safeguards {
    zd_guard guard;
    zd_crossing crossing;
    zd_resolution resolution;   /* fixed steps only */
    zd_consistency consistency;
} zd_safeguards;

void zd_safeguards_create(zd_safeguards *self, zd_arena *arena, zd_motion *motion, const zd_settings *settings, const zd_card *method,
                        const zd_last *last);
/* Saves the present point as the start of the step with this number. */
int zd_safeguards_begin(zd_safeguards *self, int64_t step);
/* Comparison of the end of a step of size h with its start; `moved`: squared displacement in characteristic scales. */
typedef int zd_comparison(zd_safeguards *self, double h, double moved);
/* That of the matrix path: of C, as crossing.h. */
int zd_safeguards_compare(zd_safeguards *self, double h, double moved);
/* Checks a step of size h and saves its end as the start of the next. `parts`: 0 for a whole step; otherwise it is one of that many parts,
 * of which only rotations are checked for resolution, as the step may still be abandoned. */
int zd_safeguards_judge(zd_safeguards *self, zd_comparison *compare, double h, int64_t next_step, int parts);

#endif
