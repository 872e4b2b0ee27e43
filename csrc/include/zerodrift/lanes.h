/* One text for one trajectory and for several: the numbers of as many trajectories as a vector of the processor holds,
 * side by side in its lanes.
 *
 *     #define ZD_UNIT 1       ZD_AVX2: whose operations are used; 0: those that every processor of this kind has
 *     #define ZD_LANES 4      1, or as many as zerodrift/units.h says
 *     #include <zerodrift/lanes.h>
 *
 *     ZD_ON_UNIT static void ZD_NAMED(kinetic)(const double *m, const double *v, double *T)
 *     {
 *         const zd_stored *mass = (const zd_stored *)m, *rate = (const zd_stored *)v;
 *         const zd_real w = rate[0] * rate[0];
 *         *(zd_stored *)T = ZD_FMA(mass[0] * 0.5, w, ZD_SPLAT(1e-9));
 *     }
 *
 * It may be included once for each unit and number of lanes. An operation does the same in each lane, whatever is in the others. With a unit,
 * ZD_FMA and its like round once, and the same numbers come out of all units and numbers of lanes; without one they round twice, and so
 * give what the same text gives that was written with products and sums. Nothing else is contracted, for which there is
 * -ffp-contract=off.
 */
#include <stdint.h>
#include <string.h>

#include "sines.h"
#include "units.h"

#ifndef ZERODRIFT_LANES_H
#define ZERODRIFT_LANES_H
/* Operations of the units that C has no words for. GCC has them built in, and reading its header takes longer than compiling a system. */
#if defined(__clang__) && (ZD_SETS) & ~3
#include <immintrin.h>
#define ZD_FMA_4(a, b, c) _mm256_fmadd_pd(a, b, c)
#define ZD_FMA_8(a, b, c) _mm512_fmadd_pd(a, b, c)
#define ZD_SQRT_4(x) _mm256_sqrt_pd(x)
#define ZD_SQRT_8(x) _mm512_sqrt_pd(x)
#define ZD_ANY_4(bits) (_mm256_movemask_pd((__m256d)(bits)) != 0)
#define ZD_ANY_8(bits) (_mm512_test_epi64_mask((__m512i)(bits), (__m512i)(bits)) != 0)
#define ZD_HALF_OF_4(x, half) _mm256_extractf128_pd(x, half)
#elif defined(__GNUC__)
#define ZD_FMA_4(a, b, c) __builtin_ia32_vfmaddpd256(a, b, c)
#define ZD_FMA_8(a, b, c) __builtin_ia32_vfmaddpd512_mask(a, b, c, -1, 4)
#define ZD_SQRT_4(x) __builtin_ia32_sqrtpd256(x)
#define ZD_SQRT_8(x) __builtin_ia32_sqrtpd512_mask(x, x, -1, 4)
#define ZD_ANY_4(bits) (__builtin_ia32_movmskpd256((zd_vector)(bits)) != 0)
typedef long long zd_eight_bits __attribute__((vector_size(64)));
#define ZD_ANY_8(bits) (__builtin_ia32_ptestmq512((zd_eight_bits)(bits), (zd_eight_bits)(bits), -1) != 0)
#define ZD_HALF_OF_4(x, half) __builtin_ia32_vextractf128_pd256(x, half)
#endif
#if defined(__GNUC__)
#define ZD_ROOT_OF(x) __builtin_sqrt(x)
#else
#include <math.h>
#define ZD_ROOT_OF(x) sqrt(x)
#endif
#define ZD_JOINED_(name, unit, lanes) name##_##unit##_##lanes
#define ZD_JOINED(name, unit, lanes) ZD_JOINED_(name, unit, lanes)
#define ZD_NAMED(name) ZD_JOINED(name, ZD_UNIT, ZD_LANES)
/* zd_real: one number of each trajectory; zd_stored: the same in unaligned memory; zd_condition: result of a comparison. */
#define zd_real ZD_NAMED(zd_real_of)
#define zd_stored ZD_NAMED(zd_stored_of)
#define zd_condition ZD_NAMED(zd_condition_of)
/* Vectors of numbers: of the lanes, or of several angles of one trajectory. */
#define zd_vector ZD_NAMED(zd_vector_of)
#define zd_vector_stored ZD_NAMED(zd_vector_stored_of)
#define zd_vector_words ZD_NAMED(zd_vector_words_of)
#define ZD_BROADCAST(x) ((x) - (zd_vector){0})      /* a difference, as -0 - 0 is -0 */
#endif

#undef ZD_ON_UNIT
#undef ZD_WIDTH
#undef ZD_SPLAT
#undef ZD_LANE
#undef ZD_WHERE
#undef ZD_BOTH
#undef ZD_EITHER
#undef ZD_NOT
#undef ZD_ANY
#undef ZD_SQRT
#undef ZD_FMA
#undef ZD_FMS
#undef ZD_FNMA
#undef ZD_SINES
#undef ZD_PADDED
#undef ZD_TIMES_PLUS
#undef ZD_LESS_TIMES

#if ZD_UNIT == 2
#define ZD_ON_UNIT __attribute__((target("avx512f,avx512dq,avx512vl,avx2,fma")))
#elif ZD_UNIT == 1
#define ZD_ON_UNIT __attribute__((target("avx2,fma")))
#else
#define ZD_ON_UNIT
#endif

/* ---- vectors ---- */

#if ZD_UNIT || ZD_LANES > 1

#if ZD_LANES == 1
#define ZD_WIDTH 4
#else
#define ZD_WIDTH ZD_LANES
#endif
typedef double zd_vector __attribute__((vector_size(8 * ZD_WIDTH)));
typedef double zd_vector_stored __attribute__((vector_size(8 * ZD_WIDTH), aligned(8), may_alias));
typedef uint64_t zd_vector_words __attribute__((vector_size(8 * ZD_WIDTH)));

#define ZD_OF_TYPE ZD_NAMED
#define ZD_REAL zd_vector
#define ZD_WORDS zd_vector_words
#define ZD_INLINED ZD_ON_UNIT ZD_SINES_INLINE
#define ZD_WORDS_OF(x) ((zd_vector_words)(x))
#define ZD_REAL_OF(w) ((zd_vector)(w))
#if ZD_UNIT && ZD_WIDTH == 8
#define ZD_TIMES_PLUS(a, b, c) ((zd_vector)ZD_FMA_8(ZD_BROADCAST(a), ZD_BROADCAST(b), ZD_BROADCAST(c)))
#define ZD_LESS_TIMES(c, a, b) ZD_TIMES_PLUS(-ZD_BROADCAST(a), b, c)
#elif ZD_UNIT && ZD_WIDTH == 4
#define ZD_TIMES_PLUS(a, b, c) ((zd_vector)ZD_FMA_4(ZD_BROADCAST(a), ZD_BROADCAST(b), ZD_BROADCAST(c)))
#define ZD_LESS_TIMES(c, a, b) ZD_TIMES_PLUS(-ZD_BROADCAST(a), b, c)
#else
#define ZD_TIMES_PLUS(a, b, c) ((a) * (b) + (c))
#define ZD_LESS_TIMES(c, a, b) ((c) - (a) * (b))
#endif
#if ZD_WIDTH == 8
#define ZD_ANY ZD_ANY_8
#elif ZD_WIDTH == 4
#define ZD_ANY ZD_ANY_4
#else
#define ZD_ANY(condition) (((condition)[0] | (condition)[1]) != 0)
#endif
#include "sines_kernel.h"

/* Reduces those angles of a vector again that are not within +-2^19, or NaN. */
ZD_ON_UNIT ZD_SINES_RARE void ZD_NAMED(zd_reduce_large_lanes)(const zd_vector *angle, ZD_NAMED(zd_reduced) *a)
{
    double x[ZD_WIDTH], r[ZD_WIDTH], tail[ZD_WIDTH];
    uint64_t quadrant[ZD_WIDTH];
    memcpy(x, angle, sizeof x);
    memcpy(r, &a->r, sizeof r);
    memcpy(tail, &a->tail, sizeof tail);
    memcpy(quadrant, &a->quadrant, sizeof quadrant);
    zd_reduce_large_ones(ZD_WIDTH, x, r, tail, quadrant);
    memcpy(&a->r, r, sizeof r);
    memcpy(&a->tail, tail, sizeof tail);
    memcpy(&a->quadrant, quadrant, sizeof quadrant);
}

/* Sines and cosines of a vector of angles. The rare case has its own variables, so that the others can stay in registers. */
ZD_ON_UNIT ZD_SINES_INLINE void ZD_NAMED(zd_vector_sines)(const zd_vector angle, zd_vector *s, zd_vector *c)
{
    ZD_NAMED(zd_reduced) a;
    ZD_NAMED(zd_reduce_moderate)(angle, &a);
    zd_vector size = (zd_vector)((zd_vector_words)angle & ~(UINT64_C(1) << 63));
    if (ZD_ANY(~(size <= ZD_SINES_LARGE))) {
        zd_vector given = angle;
        ZD_NAMED(zd_reduced) large = a;
        ZD_NAMED(zd_reduce_large_lanes)(&given, &large);
        a = large;
    }
    ZD_NAMED(zd_sines_of_reduced)(&a, s, c);
}

#undef ZD_OF_TYPE
#undef ZD_REAL
#undef ZD_WORDS
#undef ZD_INLINED
#undef ZD_WORDS_OF
#undef ZD_REAL_OF

#endif

/* ---- numbers of one trajectory ---- */

#if ZD_LANES == 1

typedef double zd_real, zd_stored;
typedef int zd_condition;
#define ZD_SPLAT(x) (x)
#define ZD_LANE(x, lane) (x)
#define ZD_WHERE(condition, a, b) ((condition) ? (a) : (b))
#define ZD_BOTH(a, b) ((a) && (b))
#define ZD_EITHER(a, b) ((a) || (b))
#define ZD_NOT(a) (!(a))
#define ZD_SQRT(x) ZD_ROOT_OF(x)
#if ZD_UNIT
#define ZD_FMA(a, b, c) __builtin_fma(a, b, c)
#define ZD_FMS(a, b, c) __builtin_fma(a, b, -(c))
#define ZD_FNMA(a, b, c) __builtin_fma(-(a), b, c)
#define ZD_PADDED(n) (((n) + ZD_WIDTH - 1) / ZD_WIDTH * ZD_WIDTH)
#define ZD_SINES ZD_NAMED(zd_sines_of)
#else
#define ZD_FMA(a, b, c) ((a) * (b) + (c))
#define ZD_FMS(a, b, c) ((a) * (b) - (c))
#define ZD_FNMA(a, b, c) ((c) - (a) * (b))
#define ZD_PADDED(n) (n)
#define ZD_SINES zd_sines
#endif

/* ---- numbers of several ---- */

#else

typedef zd_vector zd_real;
typedef zd_vector_stored zd_stored;
typedef int64_t zd_condition __attribute__((vector_size(8 * ZD_LANES)));
#define ZD_SPLAT(x) ZD_BROADCAST(x)
#define ZD_LANE(x, lane) (x)[lane]
#define ZD_WHERE(condition, a, b) \
    ((zd_real)(((zd_condition)ZD_SPLAT(a) & (zd_condition)(condition)) | ((zd_condition)ZD_SPLAT(b) & ~(zd_condition)(condition))))
#define ZD_BOTH(a, b) ((a) & (b))
#define ZD_EITHER(a, b) ((a) | (b))
#define ZD_NOT(a) (~(a))
#if ZD_LANES == 8
#define ZD_SQRT(x) ((zd_real)ZD_SQRT_8(x))
#elif ZD_LANES == 4
#define ZD_SQRT(x) ((zd_real)ZD_SQRT_4(x))
#else
#define ZD_SQRT(x) ((zd_real){ZD_ROOT_OF((x)[0]), ZD_ROOT_OF((x)[1])})
#endif
#define ZD_FMA ZD_TIMES_PLUS
#define ZD_FMS(a, b, c) ZD_FMA(a, b, -(c))
#define ZD_FNMA(a, b, c) ZD_LESS_TIMES(c, a, b)
#define ZD_PADDED(n) (n)
#define ZD_SINES ZD_NAMED(zd_sines_of)

#endif

#if ZD_UNIT || ZD_LANES > 1
#if ZD_LANES == 1
/* In halves, as compilers take the way through memory for a vector at once. */
ZD_ON_UNIT ZD_SINES_INLINE void ZD_NAMED(zd_split)(const zd_vector x, double *to)
{
    typedef double half __attribute__((vector_size(16)));
    const half low = ZD_HALF_OF_4(x, 0), high = ZD_HALF_OF_4(x, 1);
    to[0] = low[0];
    to[1] = low[1];
    to[2] = high[0];
    to[3] = high[1];
}
#endif

/* s[i], c[i] <- sine and cosine of angle[i]; each has ZD_PADDED(n) numbers */
ZD_ON_UNIT ZD_SINES_INLINE void ZD_NAMED(zd_sines_of)(const int n, const zd_real *angle, zd_real *s, zd_real *c)
{
#if ZD_LANES > 1
    for (int i = 0; i < n; i++) ZD_NAMED(zd_vector_sines)(angle[i], s + i, c + i);
#else
    for (int i = 0; i < n; i += ZD_WIDTH) {
        zd_vector sine, cosine;
        ZD_NAMED(zd_vector_sines)((zd_vector){angle[i], angle[i + 1], angle[i + 2], angle[i + 3]}, &sine, &cosine);
        ZD_NAMED(zd_split)(sine, s + i);
        ZD_NAMED(zd_split)(cosine, c + i);
    }
#endif
}

#endif
