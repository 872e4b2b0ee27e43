/* Unwrapped angles of joints. An attitude determines an angle only up to full turns, so each joint angle is a coordinate of its own. Where
 * bodies are free, and for joints that close loops of a tree, it is a dependent coordinate: integrated by its rate, and after each step set
 * to the angle between both attitudes plus the nearest multiple of 2 pi. Of an inboard joint it is an independent coordinate. */
#ifndef ZD_SPACE_UNWRAPPED_ANGLES_H
#define ZD_SPACE_UNWRAPPED_ANGLES_H

#include "../../workspace.h"
#include "plan.h"

/* Number of angles among the coordinates of a joint. */
int zd_unwrapped_angles_of(const zd_space_joint *joint);
/* Allocates memory for the given number of joints. */
void zd_unwrapped_angles_create(zd_unwrapped_angles *self, zd_arena *arena, size_t joints);
/* Lists all angles of the joints; the coordinates of dependent ones begin at p[at]. */
void zd_unwrapped_angles_plan(zd_unwrapped_angles *self, int joints, const zd_space_joint *joint, int at);
/* frame->angle <- all joint angles. */
void zd_unwrapped_angles_read(const zd_space *space, const zd_space_frame *frame, const double *p);
/* pdot (nq,) <- rates of all dependent angles at the velocities x (nv,), from placed bodies. */
void zd_unwrapped_angles_rate(const zd_space *space, const zd_space_frame *frame, const double *x, double *pdot);
/* Updates the dependent angles in p from the attitudes, keeping their full turns. */
void zd_space_follow(const void *data, double *p);

#endif
