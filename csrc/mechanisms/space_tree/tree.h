/* Joint coordinates in space: trees of bodies and inboard joints, whose roots are the ground or free bodies.
 *
 * The freedoms of a joint are listed in its table (../space/elements.h). In that order a frame that starts as the inner body's slides
 * and rotates until it is that of the outer one, which is the joint's second body, or its first if the joint is used in reverse, with the
 * same coordinates. Each freedom has a distance, an angle or a unit quaternion as coordinates. Velocities are their rates; for a quaternion,
 * the angular velocity of the outer frame relative to the inner one, in the outer axes. Angles count turns; those of joints outside the
 * tree are dependent coordinates, the last of p. A free body has the coordinates and velocities that it has in absolute coordinates.
 */
#pragma once

#include "../space/tables.h"

/* As zd_space_create(), with joint coordinates where joints carry bodies. */
zd_space *zd_space_tree_create(const zd_space_tables *tables, char *message, int message_size);

/* From the state to poses (bodies, 12), position of the mass centre and the three axes of each body, and twists (bodies, 6), velocity and
 * angular velocity, all in global axes; and back. Angles are in (-pi, pi], those of screws nearest to the displacement. Motion that joints of
 * the tree do not allow is ignored. `twists` and `v` may be NULL; `scratch` holds system->scratch doubles. Poses are also those of mechanisms
 * without a tree. */
void zd_space_tree_poses(const zd_space *space, const double *p, const double *v, double *poses, double *twists, double *scratch);
void zd_space_tree_state(const zd_space *space, const double *poses, const double *twists, double *p, double *v);
/* Quaternion (4,) of a body whose axes these are, (3, 3). */
void zd_space_tree_quaternion(const double *axes, double *q);
