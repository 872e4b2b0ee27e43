/* Angles of joints that count turns. An attitude does not tell how often a body went round, so that each angle of a joint is a coordinate of
 * its own, too: where bodies are free it follows both attitudes by its rate, and after each step it is brought to what they say; where the
 * joint carries a body it moves that body, and where it closes a loop of such joints it follows again. */
#ifndef ZD_SPACE_UNWRAPPED_ANGLES_H
#define ZD_SPACE_UNWRAPPED_ANGLES_H

#include "../../workspace.h"
#include "plan.h"

/* How many angles the coordinates of a joint are. */
int zd_unwrapped_angles_of(const zd_space_joint *joint);
/* Memory for those of so many joints. */
void zd_unwrapped_angles_take(zd_unwrapped_angles *self, zd_arena *arena, size_t joints);
/* All angles of the joints: where they follow, their coordinates begin at p[at]. */
void zd_unwrapped_angles_plan(zd_unwrapped_angles *self, int joints, const zd_space_joint *joint, int at);
/* frame->angle <- all angles where bodies are placed. */
void zd_unwrapped_angles_read(const zd_space *space, const zd_space_frame *frame, const double *p);
/* The rates of all angles that follow, where bodies are placed, to pdot (nq,), with the velocities x (nv,). */
void zd_unwrapped_angles_rate(const zd_space *space, const zd_space_frame *frame, const double *x, double *pdot);
/* Brings the angles in p to what the attitudes say, with the turns that they have. */
void zd_space_follow(const void *data, double *p);

#endif
