/* Two rows that hold a point of one body at a point of another, in absolute coordinates: most rows of most mechanisms. */
#ifndef ZD_PINS_H
#define ZD_PINS_H

#include "plan.h"

typedef struct zd_pin {
    int first, second;      /* bodies */
    zd_vector point1, point2, zero;
    int C, width;           /* where the first row begins in C, and how long each is */
    int near, far;          /* where in a row the entries of each body begin; -1: it is the ground */
    int near_turns, far_turns;  /* whether the body has an angle */
} zd_pin;

/* Whether rows `row` and the next are a pin: gauges of the same two points along x and y, of which nothing else is asked. */
int zd_pin_is_at(const zd_mechanism *mechanism, int row);
/* Phi (2,), C and xi (2,), as far as they are wanted. */
void zd_pin_write(const zd_pin *pin, const zd_frame *frame, int want, double *Phi, double *C, double *xi);

#endif
