/* What FMI 2.0 and FMI 3.0 share: an instance, its variables and its steps. Value references: 0 time, then inputs, then outputs. */
#ifndef FMU_H
#define FMU_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "block/open_run/opened.h"
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
    bool returns_early;         /* the importer allows steps to end at events */
    int event;                  /* index of the one that ended the last step; -1: none */
    int ends[EVENTS + 1];       /* occurrences of events that end a step: the first of each */
    zd_events events;
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

/* Inputs as the block has them, also those that events have set. */
static void fmu_read_inputs(fmu *self)
{
    for (int i = 0; i < INPUTS; i++) self->inputs[i] = zd_block_input(zd_opened_block(self->opened), i);
}

static const zd_events *fmu_events(const fmu *self) { return zd_block_events_of(zd_opened_block(self->opened)); }

/* Lets every event end a step, where the importer allows it, not only those that end the simulation. */
static void fmu_watch(fmu *self)
{
    if (!EVENTS || !self->returns_early) return;
    for (int i = 0; i < EVENTS; i++) self->ends[i] = 1;
    self->events = *fmu_events(self);
    self->events.terminal = self->ends;
    zd_opened_watch(self->opened, &self->events);
}

static int fmu_begin(fmu *self)
{
    zd_opened_free(self->opened);
    self->opened = zd_opened_create(block_words, sizeof block_words, self->start, self->message, sizeof self->message);
    self->is_new = true;
    if (!self->opened) return fmu_refuse(self, NULL);
    fmu_watch(self);
    if (zd_opened_begin(self->opened, self->start)) return fmu_refuse(self, zd_opened_message(self->opened));
    fmu_read_inputs(self);
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
    self->is_new = true;
    return zd_opened_begin(self->opened, self->start) ? fmu_refuse(self, zd_opened_message(self->opened)) : FMU_OK;
}

/* Steps to t + size, or to an event that ends a step. */
static int fmu_step(fmu *self, double t, double size)
{
    if (fmu_pass_inputs(self)) return FMU_ERROR;
    self->is_new = true;
    const int status = zd_opened_advance(self->opened, t + size);
    fmu_read_inputs(self);
    self->event = status == ZD_EVENT ? zd_run_ended_by(zd_opened_run(self->opened)) : -1;
    return status && status != ZD_EVENT ? fmu_refuse(self, zd_opened_message(self->opened)) : FMU_OK;
}

static int fmu_get(fmu *self, const uint32_t *reference, size_t count, double *value)
{
    if (!self->opened) return fmu_refuse(self, "variables must be read after the initialization has begun");
    if (self->is_new && zd_opened_outputs(self->opened, self->outputs)) return fmu_refuse(self, "the outputs are not defined here");
    self->is_new = false;
    for (size_t i = 0; i < count; i++) {
        const uint32_t variable = reference[i];
        if (variable > INPUTS + OUTPUTS) return fmu_refuse(self, "the value reference must be that of a variable of this unit");
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

/* ---- saved states ---- */

typedef struct fmu_state {
    size_t size;                /* of `bytes` */
    unsigned char bytes[];
} fmu_state;

static int fmu_save(fmu *self, void **state)
{
    const size_t size = zd_opened_state_size(self->opened);
    fmu_state *made = realloc(*state, sizeof *made + size);
    if (!made) return fmu_refuse(self, "there is no memory for the state");
    made->size = size;
    zd_opened_save(self->opened, TOKEN, made->bytes);
    *state = made;
    return FMU_OK;
}

static int fmu_restore(fmu *self, const fmu_state *state)
{
    if (!state) return fmu_refuse(self, "a state must be given");
    if (zd_opened_restore(self->opened, state->bytes, state->size, TOKEN))
        return fmu_refuse(self, zd_opened_message(self->opened));
    fmu_read_inputs(self);
    self->is_new = true;
    return FMU_OK;
}

static int fmu_release(void **state)
{
    if (state) {
        free(*state);
        *state = NULL;
    }
    return FMU_OK;
}

static int fmu_state_size(fmu *self, const fmu_state *state, size_t *size)
{
    if (!state) return fmu_refuse(self, "a state must be given");
    *size = state->size;
    return FMU_OK;
}

static int fmu_serialize(fmu *self, const fmu_state *state, unsigned char *bytes, size_t size)
{
    if (!state || size < state->size) return fmu_refuse(self, "the bytes must have the size of the state");
    memcpy(bytes, state->bytes, state->size);
    return FMU_OK;
}

static int fmu_deserialize(fmu *self, const unsigned char *bytes, size_t size, void **state)
{
    fmu_state *made = realloc(*state, sizeof *made + size);
    if (!made) return fmu_refuse(self, "there is no memory for the state");
    made->size = size;
    memcpy(made->bytes, bytes, size);
    *state = made;
    return FMU_OK;
}

#endif
