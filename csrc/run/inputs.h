/* Inputs of a run. */
#ifndef ZD_INPUTS_H
#define ZD_INPUTS_H

#include "run.h"

/* Memory for the inputs of a run, which are those of its settings. */
zd_held_inputs zd_inputs_take(zd_arena *arena, const zd_inputs *inputs);
/* Reads the inputs at the start of an advance; ZD_BAD_INPUT leaves the ones before. */
int zd_inputs_read(zd_run *run);
/* Writes new inputs, none of which is a speed, to their places. */
void zd_inputs_write(zd_run *run);
/* Ends the ramps of speeds that were followed in the last step, and begins new ones. */
int zd_inputs_begin_step(zd_run *run);

#endif
