/* Written by tests/direct_sources.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#ifndef ZD_OSCILLATOR_DIRECT_H
#define ZD_OSCILLATOR_DIRECT_H

#include "../../include/zerodrift/system.h"
#include "../../include/zerodrift/units.h"

/* Where among the constants of the system those of its direct functions begin, and where they end. */
enum { ZD_OSCILLATOR_DIRECT_BEGINS = 0, ZD_OSCILLATOR_DIRECT_ENDS = 5 };

extern const zd_direct zd_oscillator_direct[];
/* What follows from the parameters, which the first of these doubles are. */
void zd_oscillator_direct_constants(double *k);

#endif
