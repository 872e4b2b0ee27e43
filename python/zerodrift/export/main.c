/* Simulates the mechanism of data.h, and prints t and its outputs, one line for each step.
 *
 *     cc -O3 -std=c11 -ffp-contract=off -I. -o main $(find . -name '*.c') -lm
 *     ./main 10                           simulates 10 s
 */
#include <stdlib.h>

#include "sample.h"

int main(int arguments, char **argument)
{
    char message[500] = "";
    zd_settings settings;
    zd_block *block = zd_block_create(block_words, sizeof block_words, message, sizeof message);
    if (!block || zd_block_settings(block, &settings, message, sizeof message)) return refuse(message);
    settings.t1 = settings.t0 + (arguments > 1 ? strtod(argument[1], NULL) : 1);
    int status;
    const double *start = zd_block_start(block);
    zd_run *run = zd_run_create(zd_block_system(block), &settings, start, start + NQ, &status, message, sizeof message);
    if (!run) return refuse(message);
    do {        /* a step or its sample, in memory that is allocated above */
        sample.samples = 0;
        status = zd_run_advance(run, &sample, 1);
        if (sample.samples) print_sample();
    } while (status == ZD_FULL || status == ZD_PAUSED);
    if (status < 0) refuse(zd_run_message(run));
    zd_run_free(run);
    zd_block_free(block);
    return status < 0;
}
