/* Sets of closed-form functions that this compiler can build: by vector unit, and by number of trajectories per call.
 *
 * A set is for one trajectory, or for as many as a vector of the unit has doubles: its SIMD lanes. The set is selected at run time, by the
 * vector units of the processor.
 */
#ifndef ZERODRIFT_UNITS_H
#define ZERODRIFT_UNITS_H

/* The bits of the sets, by zd_unit and lanes */
#define ZD_SET_BASELINE_1 1
#define ZD_SET_BASELINE_2 2
#define ZD_SET_AVX2_1 4
#define ZD_SET_AVX2_4 8
#define ZD_SET_AVX512_1 16
#define ZD_SET_AVX512_8 32

/* Sets that the compiler supports. Excluded are longer vectors by gcc on Windows, which spills them as if the stack were aligned to more
 * than 16 bytes. */
#if defined(__GNUC__) && defined(__x86_64__) && (!defined(_WIN32) || defined(__clang__))
#define ZD_POSSIBLE_SETS 63
#elif defined(__GNUC__)
#define ZD_POSSIBLE_SETS 3
#else
#define ZD_POSSIBLE_SETS 1
#endif

/* Sets to build: all supported ones, or those of ZD_SETS; the first one if none of these is supported. */
#ifndef ZD_SETS
#define ZD_SETS ZD_POSSIBLE_SETS
#elif !((ZD_SETS) & ZD_POSSIBLE_SETS)
#undef ZD_SETS
#define ZD_SETS ZD_SET_BASELINE_1
#endif

#define ZD_COUNT_OF_SETS \
    (((ZD_SETS) & 1) + ((ZD_SETS) >> 1 & 1) + ((ZD_SETS) >> 2 & 1) + ((ZD_SETS) >> 3 & 1) + ((ZD_SETS) >> 4 & 1) + ((ZD_SETS) >> 5 & 1))

#endif
