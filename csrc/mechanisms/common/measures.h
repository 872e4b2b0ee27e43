/* Evaluation of measures, common to plane and space: dispatch by kind, on the numerics of either. */
#ifndef ZD_COMMON_MEASURES_H
#define ZD_COMMON_MEASURES_H

#include "output_spec.h"

/* As zd_measures.evaluate(). Returns ZD_DONE, ZD_BAD_ARGUMENT or ZD_CALLBACK. */
int zd_measures_evaluate(const zd_measuring *self, int measure, const zd_measured_state *at, const zd_measured *out);
/* As zd_reading.evaluate(). */
int zd_measures_read(const zd_measuring *self, int law, const zd_measured_state *at, const double *r, int is_same_state, double *u);

#endif
