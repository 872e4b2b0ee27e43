/* Measures of a spatial mechanism. */
#ifndef ZD_SPACE_MEASURES_H
#define ZD_SPACE_MEASURES_H

#include "../plan.h"

/* Evaluator of the outputs in self->elements.output; their self->measures.count descriptions are written to `measure`. */
zd_measures zd_space_measures(const zd_space *self, zd_measure *measure);
/* zd_reading.evaluate() */
int zd_space_read(const void *data, int law, double t, const double *p, const double *v, const double *r, int is_same_state, double *u,
                  double *scratch);

#endif
