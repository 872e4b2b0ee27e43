/* Written by python/write_series.py with SymPy 1.14.0, from tests/support/symbolic_counterparts.py. */
#include <math.h>
#include "../../include/zerodrift/series.h"
#include "../../include/zerodrift/system.h"
#include "series.h"

#define ZD_SERIES_NUMBERS data
#include "oscillator_series.h"

const zd_series zd_oscillator_series = {2 * ROWS, evaluate};
