/* The mechanism of a block with its open run, for programs that step it: co-simulation, a page in the browser. */
#pragma once

#include "../block.h"

typedef struct zd_opened zd_opened;

/* Opens a run at time t from the start of the block, which must have one. NULL on failure, with the reason in `message`. */
zd_opened *zd_opened_create(const void *data, size_t size, double t, char *message, int message_size);
/* The same from the start projected onto the constraints: the one of a drawing, at rest, with a motor that runs. */
zd_opened *zd_opened_create_assembled(const void *data, size_t size, double t, char *message, int message_size);
void zd_opened_free(zd_opened *self);
zd_block *zd_opened_block(const zd_opened *self);
/* Events of the runs that are begun from now on, instead of those of the block; kept by the caller as long as they are. At a terminal one an
 * advance ends with ZD_EVENT, and the next goes on from there. */
void zd_opened_watch(zd_opened *self, const zd_events *events);
/* Settings of a run from time t on; writes the inputs to their places. Returns ZD_DONE, or ZD_BAD_ARGUMENT with a message. */
int zd_opened_settings(zd_opened *self, double t, zd_settings *settings);
/* Begins a new run at (t, p, v), with the inputs as set; on failure the old one stays. */
int zd_opened_restart(zd_opened *self, double t, const double *p, const double *v);
/* The same from a state that is first projected onto the constraints. */
int zd_opened_assemble(zd_opened *self, double t, const double *p, const double *v);
/* Changes a parameter of the block, projects the present state onto the changed constraints and begins a new run there, with the inputs as
 * set. On failure the parameter and the run stay. */
int zd_opened_set_parameter(zd_opened *self, int parameter, double value);
/* So many steps; or steps to time t. On failure the run stays at its last good state. */
int zd_opened_step(zd_opened *self, double steps);
int zd_opened_advance(zd_opened *self, double t);
const zd_run *zd_opened_run(const zd_opened *self);
const char *zd_opened_message(const zd_opened *self);      /* the last failure in one sentence */
/* Values of a measure at the present state: (size,). */
int zd_opened_measure(zd_opened *self, int measure, double *value);
/* Poses of the bodies at the present state, as zd_block_poses(): (bodies, size). */
void zd_opened_poses(zd_opened *self, double *poses);
/* Largest residual of the position constraints at the present state. */
double zd_opened_violation(zd_opened *self);
/* J: error of the energy (28) at the present state; NaN where it is not defined. */
double zd_opened_energy_violation(zd_opened *self);
/* Values of all outputs in order. */
int zd_opened_outputs(zd_opened *self, double *value);

/* ---- saved states, as those of a run: see zd_state_save() ---- */

/* Begins a new run whose state can be saved, at time t from the start of the block, with the inputs as set; on failure the old one stays. */
int zd_opened_begin(zd_opened *self, double t);
size_t zd_opened_state_size(const zd_opened *self);
void zd_opened_save(const zd_opened *self, const char *fingerprint, void *state);
/* Continues from a state of the same block, which has the inputs, too. On failure the present run and inputs stay. */
int zd_opened_restore(zd_opened *self, const void *state, size_t size, const char *fingerprint);
