/* Which rows are of sockets, and what these write. */
#ifndef ZD_SPACE_POINT_JOINTS_H
#define ZD_SPACE_POINT_JOINTS_H

#include "../../workspace.h"
#include "plan.h"

/* Memory for those of so many bodies, joints and rows. */
void zd_point_joints_take(zd_point_joints *self, zd_arena *arena, size_t bodies, size_t joints, size_t rows);
/* Which rows are of sockets, once it is known where all are stored. */
void zd_point_joints_plan(zd_point_joints *self, const zd_space *space);
/* What is known of all sockets where bodies are placed. */
void zd_point_joints_turn(const zd_point_joints *self, const zd_space_frame *frame);
/* Phi, C, Phi_t and xi of all sockets, as far as they are wanted. */
void zd_point_joints_write(const zd_point_joints *self, const zd_space_frame *frame, int want, const zd_terms *out);

#endif
