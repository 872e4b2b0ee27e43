/* Values between steps. */
#ifndef ZD_BETWEEN_H
#define ZD_BETWEEN_H

#include "../stepping/checkpoint.h"
#include "../stepping/short_step.h"
#include "../stepping/spread.h"
#include "record.h"

typedef struct zd_output {
    zd_stepper *stepper;
    zd_recorder *recorder;
    const double *t_eval;   /* (t_evals,) times that are wanted; NULL: none */
    int64_t t_evals;
    int64_t next;              /* of them */
    int has_polynomial;     /* whether that of the method is taken */
    zd_state before, after; /* the step: where it began and where it has ended, */
    zd_cached_accelerations rates;   /* with the acceleration there, */
    int is_factored;        /* or else the leading matrix; */
    zd_checkpoint aside;         /* and what goes into the next step besides */
    int is_waiting;         /* whether the record was full before all was saved that is due; then, and within the step: */
    int is_open;            /* whether rows of it are left, */
    int is_spread;          /* its polynomial is made, */
    int is_away;            /* the motion is not at its end, which is kept, */
    int is_short;           /* and values of the polynomial are in a state y of their own, that of the stepper being that of the end */
    double *y;              /* (size,) */
} zd_output;

zd_output zd_output_take(zd_arena *arena, const zd_settings *settings, zd_stepper *stepper, zd_recorder *recorder);
static inline int zd_output_looks_between(const zd_output *self) { return self->has_polynomial && self->aside.y; }
void zd_output_keep_beginning(zd_output *self);
/* Whether the step just made has a polynomial that serves for values between. */
static inline int zd_output_may_spread(const zd_output *self)
{
    return self->has_polynomial && zd_may_spread(self->stepper, self->before.t);
}
/* Keeps the end of the step, before the motion leaves it for shorter steps alone; or for any values between, the polynomial being made if
 * there is one; and back to it, so that the next step is what it would have been. `may_stay`: whether the stepper's state may, as the motion
 * only goes to such values. */
void zd_output_leave_end(zd_output *self);
int zd_output_leave(zd_output *self, int may_stay);
int zd_output_come_back(zd_output *self);
/* To a time within the step, whose end was left: by the polynomial, or else by a shorter step, as is done at once by the other. */
int zd_output_go(zd_output *self, double t);
int zd_output_make_shorter(zd_output *self, double t);
/* Saves those times that lie in the step just made, and where it has ended if that is where the run ends. ZD_FULL: it goes on where it was
 * when it is called again, with room. */
int zd_output_after(zd_output *self, zd_record *record, int is_end);
int zd_output_is_complete(const zd_output *self);

#endif
