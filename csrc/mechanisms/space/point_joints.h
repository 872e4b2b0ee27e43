/* Rows of point joints. */
#ifndef ZD_SPACE_POINT_JOINTS_H
#define ZD_SPACE_POINT_JOINTS_H

#include "../../workspace.h"
#include "plan.h"

/* Allocates memory for the given numbers of bodies, joints and rows. */
void zd_point_joints_create(zd_point_joints *self, zd_arena *arena, size_t bodies, size_t joints, size_t rows);
/* Finds the point joints among the rows, after their storage was planned. */
void zd_point_joints_plan(zd_point_joints *self, const zd_space *space);
/* Arms, directions and angular entries of all point joints, from placed bodies. */
void zd_point_joints_turn(const zd_point_joints *self, const zd_space_frame *frame);
/* Phi, C, Phi_t and xi of all point joints, as far as wanted. */
void zd_point_joints_write(const zd_point_joints *self, const zd_space_frame *frame, int want, const zd_terms *out);

#endif
