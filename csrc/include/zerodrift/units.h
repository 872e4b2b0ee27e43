/* For which vector units this compiler can write the same functions, and how many trajectories each takes at once.
 *
 * A set of functions is for one trajectory, or for as many as a vector of the unit has doubles: its lanes. The processor that they run
 * on need not have the unit: which sets are taken is decided when they are, by what it has.
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

/* What the compiler can, but for gcc on Windows, which aligns the stack to 16 bytes there and yet spills longer vectors as if it were to
 * more, */
#if defined(__GNUC__) && defined(__x86_64__) && (!defined(_WIN32) || defined(__clang__))
#define ZD_POSSIBLE_SETS 63
#elif defined(__GNUC__)
#define ZD_POSSIBLE_SETS 3
#else
#define ZD_POSSIBLE_SETS 1
#endif

/* and what it is told to: all of it, or those of ZD_SETS. Where it can none of these, it does the first. */
#ifndef ZD_SETS
#define ZD_SETS ZD_POSSIBLE_SETS
#elif !((ZD_SETS) & ZD_POSSIBLE_SETS)
#undef ZD_SETS
#define ZD_SETS ZD_SET_BASELINE_1
#endif

#define ZD_COUNT_OF_SETS \
    (((ZD_SETS) & 1) + ((ZD_SETS) >> 1 & 1) + ((ZD_SETS) >> 2 & 1) + ((ZD_SETS) >> 3 & 1) + ((ZD_SETS) >> 4 & 1) + ((ZD_SETS) >> 5 & 1))

#endif
