/* Written by tests/direct_sources.py with SymPy 1.14.0, from tests/symbolic_counterparts.py. */
#ifndef ZD_KNIFE_EDGE_DIRECT_H
#define ZD_KNIFE_EDGE_DIRECT_H

#include "../../include/zerodrift/system.h"
#include "../../include/zerodrift/units.h"

/* Where among the constants of the system those of its direct functions begin, and where they end. */
enum { ZD_KNIFE_EDGE_DIRECT_BEGINS = 0, ZD_KNIFE_EDGE_DIRECT_ENDS = 3 };

extern const zd_direct zd_knife_edge_direct[];
/* What follows from the parameters, which the first of these doubles are. */
void zd_knife_edge_direct_constants(double *k);

#endif
