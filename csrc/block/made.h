/* A block that has become a mechanism. */
#ifndef ZD_BLOCK_MADE_H
#define ZD_BLOCK_MADE_H

#include "laws.h"
#include "names.h"

/* Memory of inputs, (inputs,) each; `speed` has three numbers for each. */
typedef struct zd_block_inputs_memory {
    double *value, *lower, *upper, *speed;
    zd_input_place *place;
} zd_block_inputs_memory;

struct zd_block {
    double *word;               /* its own copy */
    size_t size;                /* bytes */
    zd_block_layout layout;
    zd_block_laws laws;
    zd_block_names names;
    void *mechanism;            /* zd_plane or zd_space */
    zd_generalized_force *force;    /* planned forces of the mechanism */
    int *output;                /* (outputs,) */
    zd_outputs outputs;
    zd_block_inputs_memory inputs_memory;
    zd_inputs inputs;
    zd_system system;
};

/* Sets the initial inputs; and writes inputs to their places, for a new run. */
void zd_block_inputs_begin(zd_block *block);
void zd_block_inputs_write(zd_block *block);
/* Checks of inputs and parameters; 1, or 0 with the reason. */
int zd_block_inputs_check(const zd_block *block, zd_complaint to);
int zd_block_parameters_check(const zd_block_layout *layout, zd_complaint to);

#endif
