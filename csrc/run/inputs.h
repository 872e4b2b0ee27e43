/* Inputs of a run. */
#ifndef ZD_INPUTS_H
#define ZD_INPUTS_H

#include "run.h"

/* Memory for the inputs of a run, which are those of its settings. */
zd_held_inputs zd_inputs_create(zd_arena *arena, const zd_inputs *inputs, const zd_motion *motion);
/* True if one of them is a speed; the place is that of a given input. */
int zd_inputs_have_speeds(const zd_inputs *inputs);
/* Reads the inputs at the start of an advance; ZD_BAD_INPUT leaves the ones before. */
int zd_inputs_read(zd_run *run);
/* Writes new inputs, none of which is a speed, to their places. */
void zd_inputs_write(zd_run *run);
/* Ends the ramps of speeds that were followed, begins new ones, or makes their jumps. */
int zd_inputs_begin_step(zd_run *run);
/* s: time at which the next ramp of adaptive steps ends; INFINITY: none */
double zd_inputs_next_end(const zd_run *run);
/* Returns speeds to the start of the step. */
void zd_inputs_return(zd_run *run);

#endif
