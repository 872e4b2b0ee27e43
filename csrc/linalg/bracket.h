/* Narrowing down a sign change by the ITP method: it converges like the secant method and takes at most one evaluation more than
 * bisection (Oliveira and Takahashi, ACM Trans. Math. Softw. 47 (2021) 5).
 */
#ifndef ZD_BRACKET_H
#define ZD_BRACKET_H

#include <math.h>

typedef struct zd_bracket {
    double a, b;        /* the interval */
    double ga, gb;      /* of different signs; gb may be zero */
    double first_width, resolution;   /* its width at first, and that wanted */
    double reach;       /* how far from the middle the next may be: half of what bisection would have left, doubled */
    double slope;       /* of the secant at first */
    double next;        /* while a zero is enclosed from where it was expected: where to look, */
    int sides;          /* and which of its sides are known, 1 and 2; 3: it is enclosed */
} zd_bracket;

static inline zd_bracket zd_bracket_of(double a, double b, double ga, double gb, double resolution)
{
    zd_bracket it = {a, b, ga, gb, b - a, resolution, resolution, fabs(gb - ga) / (b - a), a, 3};
    while (it.reach < it.first_width) it.reach *= 2;
    return it;
}

/* The same bracket of a zero that is expected at t */
static inline zd_bracket zd_bracket_near(double t, zd_bracket it)
{
    it.next = t;
    it.sides = 0;
    return it;
}

/* Whether the function leaps over zero: it changes by far more than its slope elsewhere and the resolution make it. */
static inline int zd_bracket_leaps(const zd_bracket *it)
{
    return fabs(it->gb - it->ga) > 64 * it->slope * it->resolution;
}

/* Where to look next: by the secant, moved a little towards the middle, and no further from that than allowed. */
static inline double zd_bracket_choose(const zd_bracket *it)
{
    if (it->sides != 3) return it->next;
    double width = it->b - it->a, middle = it->a + width / 2, secant = it->a + width * (it->ga / (it->ga - it->gb));
    double inwards = copysign(1, middle - secant), shift = fmax(0.2 * width * width / it->first_width, it->resolution / 2);
    double t = shift <= fabs(middle - secant) ? secant + inwards * shift : middle, allowed = it->reach - width / 2;
    return fabs(t - middle) <= allowed ? t : middle - inwards * allowed;
}

/* Of what was found at `next`: on beyond the zero, twice as far as its slope says and then ever further, until it is enclosed. */
static inline void zd_bracket_enclose(zd_bracket *it, double g, int is_before)
{
    const double stride = it->sides ? 8 * it->reach : fmax(it->resolution, 2 * fabs(g) / it->slope);
    it->sides |= is_before ? 1 : 2;
    it->reach = stride;
    it->next += is_before ? stride : -stride;
    if (!(it->a < it->next && it->next < it->b)) it->sides = 3;
    if (it->sides != 3) return;
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

#endif
