/* The rows of each pin are those of pins.c, I and k x arm with opposite signs on its bodies. */
#include "products.h"

#include "structure.h"

static void times_C(const void *data, const zd_terms *terms, const double *x, double *y)
{
    const zd_mechanism *mechanism = data;
    const zd_pins *self = &mechanism->packing->pins;
    const zd_frame frame = zd_frame_of(mechanism, terms->scratch);
    const double *of = zd_pins_spread(self, &mechanism->tree, &frame, x);
    for (int k = 0; k < self->count; k++) {
        const double *a = of + 3 * self->pin[k].first, *b = of + 3 * self->pin[k].second;
        const zd_vector u = frame.arm[2 * k], w = frame.arm[2 * k + 1];
        y[2 * k] = b[0] - b[2] * w.y - (a[0] - a[2] * u.y);
        y[2 * k + 1] = b[1] + b[2] * w.x - (a[1] + a[2] * u.x);
    }
}

static int turns(const zd_pins *self, const zd_link *link) { return self->have_angles || link->hang == ZD_HANGS_FREE; }

/* Body by body, so that nothing is added up in memory. */
static void subtract_weighted(const void *data, const zd_terms *terms, const double *W, const double *y, double *x)
{
    const zd_mechanism *mechanism = data;
    const zd_pins *self = &mechanism->packing->pins;
    const zd_vector *arm = zd_frame_of(mechanism, terms->scratch).arm;
    for (int i = 1; i <= mechanism->tree.bodies; i++) {
        const zd_link *link = mechanism->tree.link + i;
        const double *w = W + link->coordinate;
        double *own = x + link->coordinate, forward = 0, upward = 0, torque = 0;
        for (int k = self->end_at[i]; k < self->end_at[i + 1]; k++) {
            const int end = self->end[k], row = end & ~1;
            const double sign = 2 * (end & 1) - 1, y0 = sign * y[row], y1 = sign * y[row + 1];
            forward += y0;
            upward += y1;
            torque += arm[end].x * y1 - arm[end].y * y0;
        }
        own[0] -= w[0] * forward;
        own[1] -= w[1] * upward;
        if (turns(self, link)) own[2] -= w[2] * torque;
    }
}

/* sign (I w + w_angle n n'^T) of two pins of a body, with n = k x arm of each */
static void add_weighted(const void *data, const zd_terms *terms, const double *W, const int *at, double *S)
{
    const zd_mechanism *mechanism = data;
    const zd_pins *self = &mechanism->packing->pins;
    const zd_vector *arm = zd_frame_of(mechanism, terms->scratch).arm;
    for (int i = 1; i <= mechanism->tree.bodies; i++) {
        const zd_link *link = mechanism->tree.link + i;
        const double *w = W + link->coordinate, of_angle = turns(self, link) ? w[2] : 0;
        const int first = self->end_at[i], last = self->end_at[i + 1];
        for (int k = first; k < last; k++) {
            const int end = self->end[k];
            const zd_vector u = zd_times(of_angle, arm[end]);
            for (int j = first; j <= k; j++) {
                const int other = self->end[j], turned = *at & 1;
                const double sign = (end ^ other) & 1 ? -1 : 1;
                const zd_vector n = arm[other];
                double *to = S + (*at++ >> 1);
                to[0] += sign * (w[0] + u.y * n.y);
                to[1 + turned] -= sign * (u.y * n.x);
                to[2 - turned] -= sign * (u.x * n.y);
                to[3] += sign * (w[1] + u.x * n.x);
            }
        }
    }
}

const zd_operations zd_mechanism_products = {.times_C = times_C, .subtract_weighted = subtract_weighted, .add_weighted = add_weighted};
