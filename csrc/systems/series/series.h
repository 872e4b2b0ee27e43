/* Written by python/write_series.py with SymPy 1.14.0, from tests/support/symbolic_counterparts.py. */
/* Taylor series of built-in systems. */
#pragma once

#include "../../include/zerodrift/system.h"

extern const zd_series zd_four_bar_series, zd_knife_edge_series, zd_oscillator_series, zd_pendulum_series;
