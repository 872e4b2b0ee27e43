/* Memory of one sample of the run of data.h, allocated by the compiler; its outputs as a line of text. */
#ifndef SAMPLE_H
#define SAMPLE_H

#include <stdio.h>

#include "block/block.h"
#include "data.h"

static double t, p[NQ], v[NV], multipliers[M + 1], position[M + 1], velocity[M + 1], energy[4], outputs[OUTPUTS + 1];
static int counts[2];
static zd_record sample = {
    .capacity = 1, .t = &t, .p = p, .v = v, .multipliers = multipliers, .position_violation = position, .velocity_violation = velocity,
    .kinetic = energy, .potential = energy + 1, .input = energy + 2, .energy_violation = energy + 3, .iterations = counts,
    .energy_skipped = counts + 1, .outputs = outputs};

/* Prints t and the outputs of the sample with 17 digits. */
static void print_sample(void)
{
    printf("%.17g", t);
    for (int i = 0; i < OUTPUTS; i++) printf(" %.17g", outputs[i]);
    printf("\n");
}

/* Prints the reason of a failure; returns the program's result. */
static int refuse(const char *message)
{
    fprintf(stderr, "%s\n", message);
    return 1;
}

#endif
