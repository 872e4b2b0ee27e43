/* With u and w the ways from the mass centres of both bodies to their points, in the drawing's axes,
 *
 *     Phi = x2 + w - x1 - u,      C = [-I  -k x u | I  k x w],      xi = omega2^2 w - omega1^2 u.         (3), (5), (6)
 *
 * Gauges along x and y say the same one by one, and turn both points each time. */
#include "pins.h"

static int is_plain(const zd_mechanism *mechanism, const zd_relation *row, int kind)
{
    const zd_gauge_term *term = mechanism->term + row->first;
    return row->law < 0 && !row->nonholonomic && row->terms == 1 && row->constant == 0 && row->slope == 0 && term->coefficient == 1
        && mechanism->gauge[term->gauge].kind == kind;
}

static int are_alike(const double *a, const double *b) { return a[0] == b[0] && a[1] == b[1]; }

int zd_pin_is_at(const zd_mechanism *mechanism, int row)
{
    if (row + 1 >= mechanism->mh) return 0;
    const zd_relation *x = mechanism->row + row, *y = x + 1;
    if (!is_plain(mechanism, x, ZD_GAUGE_X) || !is_plain(mechanism, y, ZD_GAUGE_Y)) return 0;
    const zd_gauge *a = mechanism->gauge + mechanism->term[x->first].gauge, *b = mechanism->gauge + mechanism->term[y->first].gauge;
    return a->first == b->first && a->second == b->second && are_alike(a->point1, b->point1) && are_alike(a->point2, b->point2);
}

/* Both rows of a body: sign [I  k x arm] */
ZD_INLINE void write_body(double *x, int width, double sign, zd_vector arm, int turns)
{
    double *y = x + width;
    x[0] = y[1] = sign;
    x[1] = y[0] = 0;
    if (!turns) return;
    x[2] = -sign * arm.y;
    y[2] = sign * arm.x;
}

void zd_pin_write(const zd_pin *pin, const zd_frame *frame, int want, double *Phi, double *C, double *xi)
{
    const zd_pose *first = frame->pose + pin->first, *second = frame->pose + pin->second;
    const zd_vector u = zd_rotated(first->cosine, first->sine, pin->point1), w = zd_rotated(second->cosine, second->sine, pin->point2);
    if (want & ZD_PHI) {
        Phi[0] = second->at.x + w.x - (first->at.x + u.x) - pin->zero.x;
        Phi[1] = second->at.y + w.y - (first->at.y + u.y) - pin->zero.y;
    }
    if (want & ZD_C) {
        if (pin->near >= 0) write_body(C + pin->C + pin->near, pin->width, -1, u, pin->near_turns);
        if (pin->far >= 0) write_body(C + pin->C + pin->far, pin->width, 1, w, pin->far_turns);
    }
    if (want & ZD_XI) {
        const double turn1 = frame->twist[pin->first].turn, turn2 = frame->twist[pin->second].turn;
        xi[0] = turn2 * turn2 * w.x - turn1 * turn1 * u.x;
        xi[1] = turn2 * turn2 * w.y - turn1 * turn1 * u.y;
    }
}
