/* Simulates the mechanism of data.h, and prints t and its outputs, one line for each step.
 *
 *     cc -O3 -std=c11 -ffp-contract=off -I. -o main $(find . -name '*.c') -lm
 *     ./main 10                           simulates 10 s
 */
#include <stdio.h>
#include <stdlib.h>

#include "block/block.h"
#include "data.h"

static double t, p[NQ], v[NV], multipliers[M + 1], position[M + 1], velocity[M + 1], energy[4], outputs[OUTPUTS + 1];
static int counts[2];
static zd_record sample = {
    .capacity = 1, .t = &t, .p = p, .v = v, .multipliers = multipliers, .position_violation = position, .velocity_violation = velocity,
    .kinetic = energy, .potential = energy + 1, .input = energy + 2, .energy_violation = energy + 3, .iterations = counts,
    .energy_skipped = counts + 1, .outputs = outputs};

static int refuse(const char *message)
{
    fprintf(stderr, "%s\n", message);
    return 1;
}

int main(int arguments, char **argument)
{
    char message[500] = "";
    zd_settings settings;
    zd_block *block = zd_block_create(block_words, sizeof block_words, message, sizeof message);
    if (!block || zd_block_settings(block, &settings, message, sizeof message)) return refuse(message);
    settings.t1 = settings.t0 + (arguments > 1 ? strtod(argument[1], NULL) : 1);
    const double *start = zd_block_start(block);
    int status;
    zd_run *run = zd_run_create(zd_block_system(block), &settings, start, start + NQ, &status, message, sizeof message);
    if (!run) return refuse(message);
    do {        /* makes a step, or reports the last sample; the memory of both is allocated above */
        sample.rows = 0;
        status = zd_run_advance(run, &sample, 1);
        if (sample.rows) printf("%.17g", t);
        for (int i = 0; sample.rows && i < OUTPUTS; i++) printf(" %.17g", outputs[i]);
        if (sample.rows) printf("\n");
    } while (status == ZD_FULL || status == ZD_PAUSED);
    if (status < 0) refuse(zd_run_message(run));
    zd_run_free(run);
    zd_block_free(block);
    return status < 0;
}
