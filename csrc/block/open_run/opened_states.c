/* Saved states of the open run of a block. A state has the time and the inputs with which its run was created, the present inputs, and the
 * state of the run: this one is restored into a run that is created alike, see run/saved_state.c.
 */
#include <stdio.h>
#include <string.h>

#include "opened.h"
#include "opened_memory.h"

static size_t input_bytes(const zd_opened *self) { return (size_t)zd_block_inputs(self->block) * sizeof(double); }

static size_t header_bytes(const zd_opened *self) { return sizeof self->t0 + 2 * input_bytes(self); }

static void set_inputs(const zd_opened *self, const void *values)
{
    for (int i = 0; i < zd_block_inputs(self->block); i++) {
        double value;
        memcpy(&value, (const unsigned char *)values + (size_t)i * sizeof value, sizeof value);
        zd_block_set_input(self->block, i, value);
    }
}

/* Copies the present inputs. */
static void get_inputs(const zd_opened *self, void *values)
{
    for (int i = 0; i < zd_block_inputs(self->block); i++) {
        const double value = zd_block_input(self->block, i);
        memcpy((unsigned char *)values + (size_t)i * sizeof value, &value, sizeof value);
    }
}

int zd_opened_begin(zd_opened *self, double t)
{
    const double *start = zd_block_start(self->block), *v = start + zd_block_system(self->block)->nq;
    int status = zd_opened_restart(self, t, start, v);
    if (status) return status;
    self->t0 = t;
    get_inputs(self, self->initial);
    status = zd_state_begin(self->run, start, v);
    if (status) snprintf(self->message, sizeof self->message, "there is no memory for a state of the run");
    return status;
}

size_t zd_opened_state_size(const zd_opened *self) { return header_bytes(self) + zd_state_size(self->run); }

void zd_opened_save(const zd_opened *self, const char *fingerprint, void *state)
{
    unsigned char *to = state;
    const size_t bytes = input_bytes(self);
    memcpy(to, &self->t0, sizeof self->t0);
    memcpy(to + sizeof self->t0, self->initial, bytes);
    get_inputs(self, to + sizeof self->t0 + bytes);
    zd_state_save(self->run, fingerprint, to + header_bytes(self));
}

/* Numbers at the places of the inputs: those of speeds are followed over a step. */
static void copy_places(const zd_opened *self, int is_back)
{
    const zd_inputs *inputs = self->settings.inputs;
    for (int i = 0; inputs && i < inputs->places; i++) {
        double *place = inputs->place[i].place, *copy = self->places + ZD_OPENED_PLACE * i;
        const size_t bytes = (inputs->place[i].is_speed ? ZD_OPENED_PLACE : 1) * sizeof *place;
        memcpy(is_back ? place : copy, is_back ? copy : place, bytes);
    }
}

/* A run created as the saved one was, at its state; NULL on failure. */
static zd_run *restored(zd_opened *self, const unsigned char *from, size_t size, const char *fingerprint, int *status)
{
    const size_t header = header_bytes(self);
    zd_settings settings;
    double t0;
    memcpy(&t0, from, sizeof t0);
    set_inputs(self, from + sizeof t0);
    *status = zd_opened_settings(self, t0, &settings);
    if (*status) return NULL;
    return zd_state_restore(zd_block_system(self->block), &settings, from + header, size - header, fingerprint, status, self->message,
                            ZD_OPENED_MESSAGE);
}

int zd_opened_restore(zd_opened *self, const void *state, size_t size, const char *fingerprint)
{
    const unsigned char *from = state;
    int status;
    if (size < header_bytes(self)) {
        snprintf(self->message, sizeof self->message, "a saved state must be whole: some of its bytes are missing");
        return ZD_BAD_ARGUMENT;
    }
    copy_places(self, 0);
    get_inputs(self, self->present);
    zd_run *run = restored(self, from, size, fingerprint, &status);
    if (!run) {
        set_inputs(self, self->present);
        copy_places(self, 1);
        return status;
    }
    zd_run_free(self->run);
    self->run = run;
    memcpy(&self->t0, from, sizeof self->t0);
    memcpy(self->initial, from + sizeof self->t0, input_bytes(self));
    set_inputs(self, from + sizeof self->t0 + input_bytes(self));
    return ZD_DONE;
}
