/* Closed-form functions by programs, for each set of zerodrift/units.h, and expressions by programs. */
#include "elimination.h"

#include <math.h>
#include <string.h>

#include "../include/zerodrift/units.h"
#include "../zerodrift.h"

/* Threaded code: each instruction ends in a jump of its own to the next, which processors predict better than one jump for all. gcc would
 * join these jumps, and a step take half as long again. */
#if defined(__GNUC__) && !defined(__clang__)
#define ZD_THREADED __attribute__((optimize("no-crossjumping", "no-gcse")))
#else
#define ZD_THREADED
#endif
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpedantic"     /* labels as values */
#endif

#if (ZD_SETS) & ZD_SET_BASELINE_1
#define ZD_UNIT 0
#define ZD_LANES 1
#include "elimination_set.h"
#endif
#if (ZD_SETS) & ZD_SET_BASELINE_2
#define ZD_UNIT 0
#define ZD_LANES 2
#include "elimination_set.h"
#endif
#if (ZD_SETS) & ZD_SET_AVX2_1
#define ZD_UNIT 1
#define ZD_LANES 1
#include "elimination_set.h"
#endif
#if (ZD_SETS) & ZD_SET_AVX2_4
#define ZD_UNIT 1
#define ZD_LANES 4
#include "elimination_set.h"
#endif
#if (ZD_SETS) & ZD_SET_AVX512_1
#define ZD_UNIT 2
#define ZD_LANES 1
#include "elimination_set.h"
#endif
#if (ZD_SETS) & ZD_SET_AVX512_8
#define ZD_UNIT 2
#define ZD_LANES 8
#include "elimination_set.h"
#endif

const zd_closed_form zd_closed_forms_by_programs[] = {
#if (ZD_SETS) & ZD_SET_BASELINE_1
    {ZD_BASELINE, 1, 1, &functions_0_1, 1, &embedding_0_1},
#endif
#if (ZD_SETS) & ZD_SET_BASELINE_2
    {ZD_BASELINE, 2, 1, &functions_0_2, 0, NULL},
#endif
#if (ZD_SETS) & ZD_SET_AVX2_1
    {ZD_AVX2, 1, 1, &functions_1_1, 1, &embedding_1_1},
#endif
#if (ZD_SETS) & ZD_SET_AVX2_4
    {ZD_AVX2, 4, 1, &functions_1_4, 0, NULL},
#endif
#if (ZD_SETS) & ZD_SET_AVX512_1
    {ZD_AVX512, 1, 1, &functions_2_1, 1, &embedding_2_1},
#endif
#if (ZD_SETS) & ZD_SET_AVX512_8
    {ZD_AVX512, 8, 1, &functions_2_8, 0, NULL},
#endif
};
const int zd_sets_of_programs = ZD_COUNT_OF_SETS;

void zd_program_run(const zd_instruction *next, double *value, double *to) { run_0_1(next, value, to); }

void zd_expressions_evaluate(const zd_expressions *self, const double *numbers, double t, const double *x, const double *xdot, double *out)
{
    express_0_1(self, numbers, &t, x, xdot, out);
}

void zd_expressions_evaluate_all(const zd_expressions *self, const double *numbers, int64_t states, const double *t, const double *x,
                                 const double *xdot, double *out)
{
    int64_t i = 0;
#if (ZD_SETS) & ZD_SET_BASELINE_2
    for (; i + 2 <= states; i += 2)
        express_0_2(self, numbers, t + i, x + i * self->terms, xdot + i * self->rates, out + i * self->results);
#endif
    for (; i < states; i++)
        express_0_1(self, numbers, t + i, x + i * self->terms, xdot + i * self->rates, out + i * self->results);
}
