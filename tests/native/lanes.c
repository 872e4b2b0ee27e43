/* What <zerodrift/lanes.h> makes of numbers in lanes, for each vector unit and number of lanes: once included, for each of them. */
#ifndef ZD_LANES
#include <zerodrift/system.h>
#include <zerodrift/units.h>
#if (ZD_SETS) & ZD_SET_BASELINE_1
#define ZD_UNIT 0
#define ZD_LANES 1
#include "lanes.c"
#endif
#if (ZD_SETS) & ZD_SET_BASELINE_2
#define ZD_UNIT 0
#define ZD_LANES 2
#include "lanes.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX2_1
#define ZD_UNIT 1
#define ZD_LANES 1
#include "lanes.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX2_4
#define ZD_UNIT 1
#define ZD_LANES 4
#include "lanes.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX512_1
#define ZD_UNIT 2
#define ZD_LANES 1
#include "lanes.c"
#endif
#if (ZD_SETS) & ZD_SET_AVX512_8
#define ZD_UNIT 2
#define ZD_LANES 8
#include "lanes.c"
#endif

const int sets = ZD_SETS;

#else
#include <zerodrift/lanes.h>

/* s, c (groups, 3, lanes) <- sines and cosines of `angle` */
ZD_ON_UNIT void ZD_NAMED(sines)(int groups, const double *angle, double *s, double *c)
{
    for (int i = 0; i < groups; i++) {
        const zd_stored *given = (const zd_stored *)angle + 3 * i;
        const zd_real angles[ZD_PADDED(3)] = {given[0], given[1], given[2]};
        zd_real sine[ZD_PADDED(3)], cosine[ZD_PADDED(3)];
        ZD_SINES(3, angles, sine, cosine);
        for (int k = 0; k < 3; k++) ((zd_stored *)s)[3 * i + k] = sine[k], ((zd_stored *)c)[3 * i + k] = cosine[k];
    }
}

/* to (8, lanes) <- what each operation makes of a, b, c (lanes,) */
ZD_ON_UNIT void ZD_NAMED(operate)(const double *of_a, const double *of_b, const double *of_c, double *to)
{
    const zd_real a = *(const zd_stored *)of_a, b = *(const zd_stored *)of_b, c = *(const zd_stored *)of_c;
    zd_stored *found = (zd_stored *)to;
    found[0] = ZD_FMA(a, b, c);
    found[1] = ZD_FMS(a, b, c);
    found[2] = ZD_FNMA(a, b, c);
    found[3] = ZD_SQRT(a);
    found[4] = ZD_WHERE(a < b, a, 2.0);
    found[5] = ZD_WHERE(ZD_BOTH(a < b, ZD_NOT(b < c)), -0.0, c);
    found[6] = ZD_WHERE(ZD_EITHER(a < b, b == c), ZD_FMA(a, 0.5, b), 1 / c);
    found[7] = ZD_SPLAT(-0.0);
}

#undef ZD_UNIT
#undef ZD_LANES
#endif
