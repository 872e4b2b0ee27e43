/* Sums over terms of rows and generalized forces, along their marker quantities, common to plane and space. The caller decides what a factor
 * along a marker quantity is added to: wrenches on two bodies, the reaction of a joint, magnitudes of a row. */
#pragma once

#include "../../linalg/small.h"
#include "output_spec.h"

typedef struct zd_actions {
    const zd_planned_elements *elements;
    const zd_readings *readings;
    void (*add)(const zd_readings *at, void *to, int quantity, double factor);
    void *to;
} zd_actions;

/* Statuses are those of planned.h. With the sign of (2), a row acts with -lambda times its factors. */
int zd_rows_act(const zd_actions *self, const zd_measured_state *at);  /* all rows, and the efforts of the state */
void zd_joint_rows_act(const zd_actions *self, int count, const int *rows, const double *lambda);  /* rows (count,) of a joint */
/* All that acts in a joint along its coordinates: drives by rows and, unless `at` is of constraints, given forces and efforts. */
int zd_drives_act(const zd_actions *self, int joint, const zd_measured_state *at);
/* magnitude (m, 2) <- sums of each row; add() gets its two numbers, and ignores `to`. */
int zd_rows_magnitudes(const zd_actions *self, double t, double *magnitude);

/* All generalized forces. In the header, so that each room compiles it with its own add(). */
ZD_INLINE int zd_forces_act(const zd_actions *self, double t)
{
    const zd_planned_elements *elements = self->elements;
    for (const zd_generalized_force *force = elements->force; force < elements->force + elements->forces; force++) {
        double value;
        const int status = zd_force_evaluate(elements, self->readings, force, t, &value, NULL);
        if (status) return status;
        self->add(self->readings, self->to, force->quantity, value);
    }
    return ZD_DONE;
}
