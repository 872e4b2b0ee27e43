/* Location of a sign change by the ITP method: it converges like the secant method and takes at most one evaluation more than bisection
 * (Oliveira and Takahashi, ACM Trans. Math. Softw. 47 (2021) 5).
 */
#pragma once

#include <math.h>

typedef struct zd_bracket {
    double a, b;        /* the interval */
    double ga, gb;      /* values at a and b, of different signs; gb may be zero */
    double first_width, resolution;   /* initial and requested width of the interval */
    double reach;       /* the next point is within reach - (b - a) / 2 of the middle; halved in each evaluation, as by bisection */
    double slope;       /* |slope| of the initial secant, or at an expected zero */
    double next;        /* next point during the search from an expected zero */
    int sides;          /* sides of the zero found by that search, bits 1 (before) and 2 (after); 3: the zero is enclosed */
} zd_bracket;

static inline zd_bracket zd_bracket_of(double a, double b, double ga, double gb, double resolution)
{
    zd_bracket it = {a, b, ga, gb, b - a, resolution, resolution, fabs(gb - ga) / (b - a), a, 3};
    while (it.reach < it.first_width) it.reach *= 2;
    return it;
}

/* True if two zeros are at one instant, to rounding. */
static inline int zd_is_same_instant(double t, double other, double resolution) { return fabs(t - other) <= 4 * resolution; }

/* The same bracket, with a zero expected at t. */
static inline zd_bracket zd_bracket_near(double t, zd_bracket it)
{
    it.next = t;
    it.sides = 0;
    return it;
}

/* True if the function jumps over zero: its change in the final interval is far above the initial slope times the resolution. */
static inline int zd_bracket_leaps(const zd_bracket *it)
{
    return fabs(it->gb - it->ga) > 64 * it->slope * it->resolution;
}

/* The next point: the zero of the secant, shifted slightly towards the middle, within the reach. */
static inline double zd_bracket_choose(const zd_bracket *it)
{
    if (it->sides != 3) return it->next;
    double width = it->b - it->a, middle = it->a + width / 2, secant = it->a + width * (it->ga / (it->ga - it->gb));
    double inwards = copysign(1, middle - secant), shift = fmax(0.2 * width * width / it->first_width, it->resolution / 2);
    double t = shift <= fabs(middle - secant) ? secant + inwards * shift : middle, allowed = it->reach - width / 2;
    return fabs(t - middle) <= allowed ? t : middle - inwards * allowed;
}

/* Continues the search from an expected zero after the value g at `next`: first by somewhat more than the distance g / slope, then by growing
 * strides, until the zero is enclosed. It is then so narrow that secants need no shift. */
static inline void zd_bracket_enclose(zd_bracket *it, double g, int is_before)
{
    const double stride = it->sides ? 8 * it->reach : fmax(it->resolution, 1.25 * fabs(g) / it->slope);
    it->sides |= is_before ? 1 : 2;
    it->reach = stride;
    it->next += is_before ? stride : -stride;
    if (!(it->a < it->next && it->next < it->b)) it->sides = 3;
    if (it->sides != 3) return;
    it->first_width = INFINITY;
    for (it->reach = it->resolution; it->reach < it->b - it->a;) it->reach *= 2;
}

static inline void zd_bracket_narrow(zd_bracket *it, double t, double g)
{
    const int is_before = it->ga < 0 ? g < 0 : g > 0;
    if (is_before) it->a = t, it->ga = g;
    else it->b = t, it->gb = g;
    if (it->sides == 3) it->reach /= 2;
    else zd_bracket_enclose(it, g, is_before);
}
