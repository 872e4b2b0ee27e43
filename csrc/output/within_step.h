/* Values between steps. */
#pragma once

#include "../paths/path.h"
#include "../state/snapshot.h"
#include "../step/step_loop.h"
#include "reading.h"

/* Dense output within the last step, if its method has a polynomial. */

/* Allocates the copy of the formulation's choice of variables that values within a step need where that choice may change at its end. To be
 * called before the first step. ZD_NO_MEMORY */
int zd_dense_output_create(zd_stepper *stepper);
/* The first: true if there is a polynomial for the last step, from t0. The second prepares it, with the motion at the end of the step; it
 * is valid until the next step. */
int zd_has_dense_output(const zd_stepper *stepper, double t0);
int zd_dense_output_prepare(zd_stepper *stepper);
/* Moves to time t within the step: the value of the polynomial, with all corrections. */
int zd_dense_output_move(zd_stepper *stepper, double t);

typedef struct zd_output {
    zd_step_loop *loop;
    zd_stepper *stepper;
    zd_recorder *recorder;
    const double *t_eval;   /* (t_evals,) s: requested times; NULL: none */
    int64_t t_evals;
    int64_t next;              /* index of the next of them */
    int has_polynomial;     /* true if dense output of the method is used */
    zd_state before;        /* start of the step */
    zd_snapshot after;      /* its end */
    int is_waiting;         /* true if the record was full before all samples of the step were saved */
    int is_open;            /* true while samples within the step remain */
    int is_prepared;          /* true if its dense output is prepared */
    int is_within;            /* true while the motion is not at the end of the step, which is saved */
    double *y;              /* (size,) state from dense output */
} zd_output;

zd_output zd_output_create(zd_arena *arena, const zd_settings *settings, zd_step_loop *loop, zd_recorder *recorder);
static inline int zd_output_interpolates(const zd_output *self) { return self->has_polynomial && self->after.y; }
void zd_output_save_start(zd_output *self);
/* True if dense output is available for the last step. */
static inline int zd_output_has_dense(const zd_output *self)
{
    return self->has_polynomial && zd_has_dense_output(self->stepper, self->before.t);
}
/* Saves the end of the step before the motion leaves it: for shorter steps only; or for any values within the step, preparing dense output
 * if available. zd_output_return_to_end() returns there, so that the bits of the next step do not change. */
void zd_output_save_end(zd_output *self);
int zd_output_leave(zd_output *self);
int zd_output_return_to_end(zd_output *self);
/* Moves to a time within the step, after its end was saved: by dense output, or else by a shorter step; the second function always by a
 * shorter step. */
int zd_output_go(zd_output *self, double t);
int zd_output_make_shorter(zd_output *self, double t);
/* Saves the samples within the last step, and its end if the run ends there. ZD_FULL: to be called again with an emptied record. */
int zd_output_after(zd_output *self, zd_record *record, int is_end);
int zd_output_is_complete(const zd_output *self);
