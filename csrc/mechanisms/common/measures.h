/* Evaluation of measures, common to plane and space: dispatch by kind, on the numerics of either. */
#ifndef ZD_COMMON_MEASURES_H
#define ZD_COMMON_MEASURES_H

#include "measuring.h"

/* As zd_measures.evaluate(). Returns ZD_DONE, ZD_BAD_ARGUMENT or ZD_CALLBACK. */
int zd_measures_evaluate(const zd_measuring *self, int measure, const zd_measured_state *at, const zd_measured *out);

#endif
