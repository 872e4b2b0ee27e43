/* Written by tests/direct_sources.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#ifndef ZD_VERTICAL_DISC_DIRECT_H
#define ZD_VERTICAL_DISC_DIRECT_H

#include "../../include/zerodrift/system.h"
#include "../../include/zerodrift/units.h"

/* Where among the constants of the system those of its direct functions begin, and where they end. */
enum { ZD_VERTICAL_DISC_DIRECT_BEGINS = 0, ZD_VERTICAL_DISC_DIRECT_ENDS = 7 };

extern const zd_direct zd_vertical_disc_direct[];
/* What follows from the parameters, which the first of these doubles are. */
void zd_vertical_disc_direct_constants(double *k);

#endif
