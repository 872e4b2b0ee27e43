/* Which rows are of sockets, and what these write. */
#ifndef ZD_SOCKETS_H
#define ZD_SOCKETS_H

#include "../workspace.h"
#include "plan.h"

/* Memory for those of so many bodies, joints and rows. */
void zd_sockets_take(zd_sockets *self, zd_arena *arena, size_t bodies, size_t joints, size_t rows);
/* Which rows are of sockets, once it is known where all are stored. */
void zd_sockets_plan(zd_sockets *self, const zd_space *space);
/* What is known of all sockets where bodies are placed. */
void zd_sockets_turn(const zd_sockets *self, const zd_frame3 *frame);
/* Phi, C, Phi_t and xi of all sockets, as far as they are wanted. */
void zd_sockets_write(const zd_sockets *self, const zd_frame3 *frame, int want, const zd_terms *out);

#endif
