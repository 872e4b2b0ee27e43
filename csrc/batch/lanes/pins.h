/* (13) and (27) of bodies joined by pins, in lanes:
 *
 *     Phi = x2 + w - x1 - u - zero,      C = [-I  -k x u | I  k x w],      xi = omega2^2 w - omega1^2 u         (3), (5), (6)
 *     S lambda = C g - xi,     vdot = g - M^-1 C^T lambda                                                       (13)
 *
 * with u and w the arms of a pin and g of gravity; S and its factors are in pins_factors.h. */
#include "pins_factors.h"

/* ---- solution ---- */

/* y <- S^-1 y */
ZD_KERNEL void ZD_NAMED(solve)(const zd_lane_pins *pins)
{
    const zd_blocks *blocks = pins->blocks;
    const zd_stored *S = REAL(pins->S);
    zd_stored *y = REAL(pins->y);
    for (int k = 0; k < blocks->count; k++) {
        const zd_stored *P = S + 4 * k;
        const zd_real y0 = y[2 * k], y1 = y[2 * k + 1];
        for (int e = blocks->begin[k]; e < blocks->begin[k + 1]; e++) {
            const zd_stored *L = S + 4 * (blocks->count + e);
            zd_stored *z = y + 2 * blocks->row[e];
            z[0] = ZD_FNMA(L[1], y1, ZD_FNMA(L[0], y0, z[0]));
            z[1] = ZD_FNMA(L[3], y1, ZD_FNMA(L[2], y0, z[1]));
        }
        y[2 * k] = ZD_FMA(P[0], y0, P[2] * y1);
        y[2 * k + 1] = ZD_FMA(P[2], y0, P[3] * y1);
    }
    for (int k = blocks->count - 1; k >= 0; k--) {
        zd_real y0 = y[2 * k], y1 = y[2 * k + 1];
        for (int e = blocks->begin[k]; e < blocks->begin[k + 1]; e++) {
            const zd_stored *L = S + 4 * (blocks->count + e), *z = y + 2 * blocks->row[e];
            y0 = ZD_FNMA(L[2], z[1], ZD_FNMA(L[0], z[0], y0));
            y1 = ZD_FNMA(L[3], z[1], ZD_FNMA(L[1], z[0], y1));
        }
        y[2 * k] = y0;
        y[2 * k + 1] = y1;
    }
}

/* x <- g - M^-1 C^T y, without g where `falls` is 0 */
ZD_KERNEL void ZD_NAMED(distribute_forces)(const zd_lanes *self, double falls, double *x)
{
    const zd_lane_pins *pins = self->pins;
    const zd_stored *g = REAL(self->data) + pins->gravity, *y = REAL(pins->y);
    const zd_real gx = falls * g[0], gy = falls * g[1];
    for (int body = 0; body < pins->of->bodies; body++) {
        const int at = pins->of->at[body];
        zd_real forward = ZD_SPLAT(0.0), upward = forward, torque = forward;
        for (int i = pins->end_at[body]; i < pins->end_at[body + 1]; i++) {
            const int end = pins->of_body[i];
            const double sign = end & 1 ? 1 : -1;
            const ZD_NAMED(plane) arm = ZD_NAMED(arm_of)(pins, end);
            const zd_real fx = sign * y[end & ~1], fy = sign * y[end | 1];
            forward += fx;
            upward += fy;
            torque += ZD_FNMA(arm.y, fx, arm.x * fy);
        }
        REAL(x)[at] = ZD_FNMA(REAL(self->data)[2 * body], forward, gx);
        REAL(x)[at + 1] = ZD_FNMA(REAL(self->data)[2 * body], upward, gy);
        if (pins->of->at[body + 1] - at == 3) REAL(x)[at + 2] = -REAL(self->data)[2 * body + 1] * torque;
    }
}

/* Contribution of the velocities of an end's body to both rows of its pin, and the sizes of the terms. */
typedef struct ZD_NAMED(moved) {
    ZD_NAMED(plane) by, size;
} ZD_NAMED(moved);

ZD_KERNEL ZD_NAMED(moved) ZD_NAMED(move_end)(const zd_lane_pins *pins, int end, const double *v)
{
    const int body = pins->end[end].body;
    if (body < 0) return (ZD_NAMED(moved)){{ZD_SPLAT(0.0), ZD_SPLAT(0.0)}, {ZD_SPLAT(0.0), ZD_SPLAT(0.0)}};
    const int at = pins->of->at[body], turns = pins->of->at[body + 1] - at == 3;
    const zd_real x = REAL(v)[at], y = REAL(v)[at + 1], turned = turns ? (zd_real)REAL(v)[at + 2] : ZD_SPLAT(0.0);
    const ZD_NAMED(plane) arm = ZD_NAMED(arm_of)(pins, end);
    const zd_real across = turned * arm.y, along = turned * arm.x;
    return (ZD_NAMED(moved)){{x - across, y + along}, {ZD_NAMED(size_of)(x) + ZD_NAMED(size_of)(across),
                                                      ZD_NAMED(size_of)(y) + ZD_NAMED(size_of)(along)}};
}

/* y <- -(rhs - C x), with rhs in `rest`; returns the largest residual relative to its terms, 0 if it is within the rounding of x. */
ZD_KERNEL zd_real ZD_NAMED(find_rest)(const zd_lane_pins *pins, const double *x)
{
    zd_real left = ZD_SPLAT(0.0);
    for (int place = 0; place < pins->count; place++) {
        const ZD_NAMED(moved) first = ZD_NAMED(move_end)(pins, 2 * place, x), second = ZD_NAMED(move_end)(pins, 2 * place + 1, x);
        const zd_stored *rhs = REAL(pins->rest) + 2 * place;
        const zd_real rest[] = {rhs[0] - (second.by.x - first.by.x), rhs[1] - (second.by.y - first.by.y)};
        const zd_real size[] = {ZD_NAMED(size_of)(rhs[0]) + first.size.x + second.size.x,
                                ZD_NAMED(size_of)(rhs[1]) + first.size.y + second.size.y};
        for (int i = 0; i < 2; i++) {
            const zd_real off = ZD_NAMED(size_of)(rest[i]);
            const zd_condition counts = (off > ZD_RESIDUAL_ROUNDING * size[i]) & (off > left * size[i]);
            left = ZD_WHERE(counts, off / ZD_WHERE(counts, size[i], ZD_SPLAT(1.0)), left);
            REAL(pins->y)[2 * place + i] = -rest[i];
        }
    }
    return left;
}

/* Refines x until C x = rhs, in lanes with small pivots or unequal masses: as in schur_blocks.c. */
ZD_KERNEL void ZD_NAMED(refine)(const zd_lanes *self, double *x)
{
    zd_lane_pins *pins = self->pins;
    zd_condition open = HOLDS(pins->is_small);
    zd_real before = ZD_SPLAT(INFINITY), left;
    if (!ZD_ANY(open)) return;
    for (int i = 0; i < 2 * pins->count; i++) REAL(pins->lambda)[i] = REAL(pins->y)[i];
    for (int i = 0; i < ZD_MAX_REFINEMENTS; i++) {
        left = ZD_NAMED(find_rest)(pins, x);
        open &= (left > 0.0) & (left < 0.5 * before);
        if (!ZD_ANY(open)) break;
        ZD_NAMED(solve)(pins);
        ZD_NAMED(distribute_forces)(self, 0, pins->step);
        for (int j = 0; j < self->nv; j++) REAL(x)[j] += ZD_WHERE(open, REAL(pins->step)[j], ZD_SPLAT(0.0));
        for (int j = 0; j < 2 * pins->count; j++) REAL(pins->lambda)[j] += ZD_WHERE(open, REAL(pins->y)[j], ZD_SPLAT(0.0));
        before = left;
    }
    for (int i = 0; i < 2 * pins->count; i++) REAL(pins->y)[i] = REAL(pins->lambda)[i];
}

/* x with C x = rhs, from rhs in `rest`, and -rhs (plus C g, if x includes gravity) in y. */
ZD_KERNEL void ZD_NAMED(exchange)(const zd_lanes *self, double falls, double *x)
{
    ZD_NAMED(solve)(self->pins);
    ZD_NAMED(distribute_forces)(self, falls, x);
    ZD_NAMED(refine)(self, x);
}

/* ---- functions for the lanes ---- */

ZD_KERNEL zd_real ZD_NAMED(spin_squared)(const zd_lane_pins *pins, int end, const double *v)
{
    const int body = pins->end[end].body;
    if (body < 0 || pins->of->at[body + 1] - pins->of->at[body] < 3) return ZD_SPLAT(0.0);
    const zd_real spin = REAL(v)[pins->of->at[body] + 2];
    return spin * spin;
}

/* vdot and, if required, lambda; NAN in lanes with is_lost. */
ZD_KERNEL void ZD_NAMED(accelerate_pins)(const zd_lanes *self, const double *p, const double *v, double *vdot, double *lambda)
{
    const zd_lane_pins *pins = self->pins;
    const zd_stored *g = REAL(self->data) + pins->gravity;
    ZD_NAMED(factorize)(self, p);
    for (int place = 0; place < pins->count; place++) {
        const int first = 2 * place, second = first + 1;
        const double falls = (pins->end[second].body >= 0) - (pins->end[first].body >= 0);
        const zd_real turn1 = ZD_NAMED(spin_squared)(pins, first, v), turn2 = ZD_NAMED(spin_squared)(pins, second, v);
        const ZD_NAMED(plane) u = ZD_NAMED(arm_of)(pins, first), w = ZD_NAMED(arm_of)(pins, second);
        const zd_real x = ZD_FNMA(turn1, u.x, turn2 * w.x), y = ZD_FNMA(turn1, u.y, turn2 * w.y);      /* xi of (6) */
        REAL(pins->rest)[first] = x, REAL(pins->rest)[second] = y;
        REAL(pins->y)[first] = falls * g[0] - x, REAL(pins->y)[second] = falls * g[1] - y;
    }
    ZD_NAMED(exchange)(self, 1, vdot);                                                                 /* (13) */
    *REAL(vdot) = ZD_WHERE(HOLDS(pins->is_lost), ZD_SPLAT(NAN), *REAL(vdot));
    for (int place = 0; lambda && place < pins->count; place++)
        for (int i = 0; i < 2; i++) REAL(lambda)[pins->row[place] + i] = REAL(pins->y)[2 * place + i];
}

/* Phi at p */
ZD_KERNEL void ZD_NAMED(close_pins)(const zd_lanes *self, const double *p)
{
    const zd_lane_pins *pins = self->pins;
    ZD_NAMED(turn)(self, p);
    for (int place = 0; place < pins->count; place++) {
        const zd_pin_end *first = pins->end + 2 * place, *second = first + 1;
        const ZD_NAMED(plane) u = ZD_NAMED(arm_of)(pins, 2 * place), w = ZD_NAMED(arm_of)(pins, 2 * place + 1);
        const zd_stored *zero = REAL(self->data) + second->point + 2;
        zd_real from[] = {u.x, u.y}, to[] = {w.x, w.y};
        for (int i = 0; i < 2; i++) {
            if (first->body >= 0) from[i] += REAL(p)[pins->of->at[first->body] + i];
            if (second->body >= 0) to[i] += REAL(p)[pins->of->at[second->body] + i];
            REAL(self->Phi)[pins->row[place] + i] = to[i] - from[i] - zero[i];
        }
    }
}

/* dp (27a) at p, where Phi is known */
ZD_KERNEL void ZD_NAMED(correct_pins)(const zd_lanes *self, const double *p)
{
    const zd_lane_pins *pins = self->pins;
    ZD_NAMED(factorize)(self, p);
    for (int place = 0; place < pins->count; place++)
        for (int i = 0; i < 2; i++) {
            const zd_real Phi = REAL(self->Phi)[pins->row[place] + i];
            REAL(pins->rest)[2 * place + i] = Phi;
            REAL(pins->y)[2 * place + i] = -Phi;
        }
    ZD_NAMED(exchange)(self, 0, self->dp);
}

/* dv (27b) at (p, v) */
ZD_KERNEL void ZD_NAMED(slow_pins)(const zd_lanes *self, const double *p, const double *v)
{
    const zd_lane_pins *pins = self->pins;
    ZD_NAMED(factorize)(self, p);
    for (int place = 0; place < pins->count; place++) {
        const ZD_NAMED(moved) first = ZD_NAMED(move_end)(pins, 2 * place, v), second = ZD_NAMED(move_end)(pins, 2 * place + 1, v);
        const zd_real Psi[] = {second.by.x - first.by.x, second.by.y - first.by.y};
        for (int i = 0; i < 2; i++) {
            REAL(pins->rest)[2 * place + i] = Psi[i];
            REAL(pins->y)[2 * place + i] = -Psi[i];
        }
    }
    ZD_NAMED(exchange)(self, 0, self->dv);
}
