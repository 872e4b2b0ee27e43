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
} zd_bracket;

static inline zd_bracket zd_bracket_of(double a, double b, double ga, double gb, double resolution)
{
    zd_bracket it = {a, b, ga, gb, b - a, resolution, resolution};
    while (it.reach < it.first_width) it.reach *= 2;
    return it;
}

/* Where to look next: by the secant, moved a little towards the middle, and no further from that than allowed. */
static inline double zd_bracket_choose(const zd_bracket *it)
{
    double width = it->b - it->a, middle = it->a + width / 2, secant = it->a + width * (it->ga / (it->ga - it->gb));
    double inwards = copysign(1, middle - secant), shift = fmax(0.2 * width * width / it->first_width, it->resolution / 2);
    double t = shift <= fabs(middle - secant) ? secant + inwards * shift : middle, allowed = it->reach - width / 2;
    return fabs(t - middle) <= allowed ? t : middle - inwards * allowed;
}

static inline void zd_bracket_narrow(zd_bracket *it, double t, double g)
{
    if (it->ga < 0 ? g < 0 : g > 0) it->a = t, it->ga = g;
    else it->b = t, it->gb = g;
    it->reach /= 2;
}

#endif
