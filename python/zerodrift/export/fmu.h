/* What FMI 2.0 and FMI 3.0 share: an instance, its variables and its steps. Value references: 0 time, then inputs, then outputs. */
#ifndef FMU_H
#define FMU_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "block/opened.h"
#include "data.h"

#ifdef _WIN32
#define FMU_EXPORT __declspec(dllexport)
#else
#define FMU_EXPORT __attribute__((visibility("default")))
#endif

enum { FMU_OK, FMU_WARNING, FMU_DISCARD, FMU_ERROR, FMU_FATAL };    /* the statuses of both versions */

typedef struct fmu {
    zd_opened *opened;
    double start, inputs[INPUTS + 1], outputs[OUTPUTS + 1];
    bool is_new;                /* outputs must be computed */
    char message[500];
    void *environment;
    void (*log)(struct fmu *self, int status);
    void *callback;             /* the importer's function for messages */
    char *name;
} fmu;

static int fmu_refuse(fmu *self, const char *message)
{
    if (message) snprintf(self->message, sizeof self->message, "%s", message);
    if (self->log) self->log(self, FMU_ERROR);
    return FMU_ERROR;
}

/* Inputs as they are set: from the next step on. */
static int fmu_pass_inputs(fmu *self)
{
    for (int i = 0; i < INPUTS; i++)
        if (zd_block_set_input(zd_opened_block(self->opened), i, self->inputs[i])) return fmu_refuse(self, "inputs must be finite numbers");
    return FMU_OK;
}

static int fmu_begin(fmu *self)
{
    zd_opened_free(self->opened);
    self->opened = zd_opened_create(block_words, sizeof block_words, self->start, self->message, sizeof self->message);
    self->is_new = true;
    if (!self->opened) return fmu_refuse(self, NULL);
    for (int i = 0; i < INPUTS; i++) self->inputs[i] = zd_block_input(zd_opened_block(self->opened), i);
    return FMU_OK;
}

static fmu *fmu_create(const char *name)
{
    fmu *self = calloc(1, sizeof *self);
    if (!self) return NULL;
    self->name = calloc(strlen(name) + 1, 1);
    if (self->name) memcpy(self->name, name, strlen(name));
    return self;
}

static void fmu_free(fmu *self)
{
    if (!self) return;
    zd_opened_free(self->opened);
    free(self->name);
    free(self);
}

/* Ends the initialization: the run starts with the inputs as they are now. */
static int fmu_initialize(fmu *self)
{
    if (fmu_pass_inputs(self)) return FMU_ERROR;
    const zd_run *run = zd_opened_run(self->opened);
    self->is_new = true;
    return zd_opened_restart(self->opened, self->start, zd_run_p(run), zd_run_v(run)) ? fmu_refuse(self, zd_opened_message(self->opened)) : FMU_OK;
}

static int fmu_step(fmu *self, double t, double size)
{
    if (fmu_pass_inputs(self)) return FMU_ERROR;
    self->is_new = true;
    return zd_opened_advance(self->opened, t + size) ? fmu_refuse(self, zd_opened_message(self->opened)) : FMU_OK;
}

static int fmu_get(fmu *self, const uint32_t *reference, size_t count, double *value)
{
    if (!self->opened) return fmu_refuse(self, "variables must be read after the initialization has begun");
    if (self->is_new && zd_opened_outputs(self->opened, self->outputs)) return fmu_refuse(self, "the outputs are not defined here");
    self->is_new = false;
    for (size_t i = 0; i < count; i++) {
        const uint32_t variable = reference[i];
        if (variable > INPUTS + OUTPUTS) return fmu_refuse(self, "there is no such variable");
        value[i] = variable == 0 ? zd_run_time(zd_opened_run(self->opened)) : variable <= INPUTS ? self->inputs[variable - 1] :
                   self->outputs[variable - 1 - INPUTS];
    }
    return FMU_OK;
}

static int fmu_set(fmu *self, const uint32_t *reference, size_t count, const double *value)
{
    for (size_t i = 0; i < count; i++) {
        if (reference[i] < 1 || reference[i] > INPUTS) return fmu_refuse(self, "only inputs may be set");
        self->inputs[reference[i] - 1] = value[i];
    }
    return FMU_OK;
}

#endif
