/* Written by python/write_series.py with SymPy 1.14.0, from tests/support/symbolic_counterparts.py. */
#include <math.h>
#include "../../include/zerodrift/series.h"
#include "../../include/zerodrift/system.h"
#include "series.h"

#define ZD_SERIES_NUMBERS data
#include "pendulum_series.h"

const zd_series zd_pendulum_series = {2 * ROWS, evaluate};
