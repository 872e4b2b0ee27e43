/* Joint coordinates in space: bodies that joints carry, one on the other, from the ground or from bodies that are free.
 *
 * What a joint leaves free is listed in its table (../space/joints/joint.h). In that order a frame that begins on the inner body slides,
 * turns or swings until it is that of the outer one, which is the joint's second body; or, where the joint is taken backwards, the first,
 * by the same coordinates. Each freedom has a distance, an angle or a unit quaternion for its coordinates; velocities are their rates,
 * and of a quaternion the angular velocity of the outer frame against the inner one, in the outer one's axes. Angles count turns; those of
 * joints that carry nothing follow the others, and are the last of p. A body that is
 * free has the coordinates and velocities that it has in absolute coordinates.
 */
#ifndef ZD_SPACE_TREE_TREE_H
#define ZD_SPACE_TREE_TREE_H

#include "../space/tables.h"

/* As zd_space_create(), with joint coordinates where joints carry bodies. */
zd_space *zd_space_tree_create(const zd_space_tables *tables, char *message, int message_size);

/* Poses (bodies, 12), the place of each mass centre and then its axes one after another, and twists (bodies, 6), its velocity and its angular
 * velocity, all in the drawing's axes, from the state and back. Angles come with the turns
 * that are nearest to none, and of screws to how far they have come. What joints of the tree forbid is not looked at. `twists` and `v` may
 * be NULL; `scratch` holds system->scratch doubles. */
void zd_space_tree_poses(const zd_space *space, const double *p, const double *v, double *poses, double *twists, double *scratch);
void zd_space_tree_state(const zd_space *space, const double *poses, const double *twists, double *p, double *v);

#endif
