/* The rows of each revolute joint are those of revolute_joints.c, I and k x arm with opposite signs on its bodies. */
#include "packing.h"

/* The arms of all joints are first in the scratch, followed by memory for a vector. */
static const zd_vector *arms_in(const double *scratch) { return (const zd_vector *)scratch; }
static double *room_in(double *scratch, const zd_revolute_joints *self) { return scratch + 4 * self->count; }

static void times_C(const void *data, const zd_terms *terms, const double *x, double *restrict y)
{
    const zd_plane *mechanism = data;
    const zd_revolute_joints *self = &mechanism->packing->revolutes;
    const zd_vector *arm = arms_in(terms->scratch);
    const double *of = zd_revolute_joints_expand(self, &mechanism->tree, x, room_in(terms->scratch, self));
    for (int k = 0; k < self->count; k++, arm += 2) {
        const double *a = zd_of_body(of, self->between[k].first), *b = zd_of_body(of, self->between[k].second);
        y[2 * k] = b[0] - b[2] * arm[1].y - (a[0] - a[2] * arm[0].y);
        y[2 * k + 1] = b[1] + b[2] * arm[1].x - (a[1] + a[2] * arm[0].x);
    }
}

typedef struct coordinates {    /* a body's own coordinates */
    int first, turns;
} coordinates;

/* Coordinates of body i; the link is read only if not all bodies have three coordinates. */
ZD_INLINE coordinates coordinates_of(const int have_angles, const zd_plane *mechanism, int i)
{
    const zd_plane_link *link = mechanism->tree.link + i;
    return have_angles ? (coordinates){3 * (i - 1), 1} : (coordinates){link->coordinate, link->hang == ZD_HANGS_FREE};
}

/* Sign of C for the first and second body of a joint; and of the product for two bodies on the same and on opposite sides */
static const double SIGN[] = {-1, 1}, SIGN_OF_TWO[] = {1, -1};

/* Body by body, so that nothing is added up in memory. */
ZD_INLINE void subtract(const int have_angles, const zd_plane *mechanism, const zd_vector *arm, const double *W, const double *restrict y,
                        const int *place, double *restrict x)
{
    const int *end_at = mechanism->packing->revolutes.end_at, *ends = mechanism->packing->revolutes.end;
    for (int i = 1, k = end_at[1]; i <= mechanism->tree.bodies; i++) {
        const coordinates at = coordinates_of(have_angles, mechanism, i);
        const double *w = W + at.first;
        double *own = x + at.first, forward = 0, upward = 0, torque = 0;
        for (const int last = end_at[i + 1]; k < last; k++) {
            const int end = ends[k];
            const double *of = y + place[end & ~1], sign = SIGN[end & 1], y0 = sign * of[0], y1 = sign * of[1];
            forward += y0;
            upward += y1;
            torque += arm[end].x * y1 - arm[end].y * y0;
        }
        own[0] -= w[0] * forward;
        own[1] -= w[1] * upward;
        if (at.turns) own[2] -= w[2] * torque;
    }
}

static void subtract_weighted(const void *data, const zd_terms *terms, const double *W, const double *restrict y, const int *place,
                              double *restrict x)
{
    const zd_plane *mechanism = data;
    const zd_vector *arm = arms_in(terms->scratch);
    if (mechanism->packing->revolutes.have_angles) subtract(1, mechanism, arm, W, y, place, x);
    else subtract(0, mechanism, arm, W, y, place, x);
}

/* to <- to + sign (I w + n u^T), n = k x a and u = k x b; turned: the transpose */
ZD_INLINE void add_product(double *to, int turned, double sign, const double *w, zd_vector a, zd_vector b)
{
    const double xx = sign * (w[0] + b.y * a.y), xy = sign * (b.y * a.x), yx = sign * (b.x * a.y), yy = sign * (w[1] + b.x * a.x);
    to[0] += xx;
    to[1 + turned] -= xy;
    to[2 - turned] -= yx;
    to[3] += yy;
}

/* The same of one end with itself */
ZD_INLINE void add_square(double *to, const double *w, zd_vector a, zd_vector b)
{
    to[0] += w[0] + b.y * a.y;
    to[2] -= b.x * a.y;
    to[3] += w[1] + b.x * a.x;
}

ZD_INLINE void add(const int have_angles, const zd_plane *mechanism, const zd_vector *arm, const double *W, const int *at,
                   double *restrict S)
{
    const int *end_at = mechanism->packing->revolutes.end_at, *ends = mechanism->packing->revolutes.end;
    for (int i = 1, k = end_at[1]; i <= mechanism->tree.bodies; i++) {
        const coordinates of = coordinates_of(have_angles, mechanism, i);
        const double *own = W + of.first, w[] = {own[0], own[1], of.turns ? own[2] : 0};
        for (const int first = k, last = end_at[i + 1]; k < last; k++) {
            const int end = ends[k];
            const zd_vector u = zd_times(w[2], arm[end]);
            for (int j = first; j < k; j++, at++)
                add_product(S + (*at >> 1), *at & 1, SIGN_OF_TWO[(end ^ ends[j]) & 1], w, arm[ends[j]], u);
            add_square(S + (*at++ >> 1), w, arm[end], u);
        }
    }
}

static void add_weighted(const void *data, const zd_terms *terms, const double *W, const int *at, double *restrict S)
{
    const zd_plane *mechanism = data;
    const zd_vector *arm = arms_in(terms->scratch);
    if (mechanism->packing->revolutes.have_angles) add(1, mechanism, arm, W, at, S);
    else add(0, mechanism, arm, W, at, S);
}

const zd_operations zd_plane_products = {.times_C = times_C, .subtract_weighted = subtract_weighted, .add_weighted = add_weighted};
