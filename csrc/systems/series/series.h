/* Written by python/write_series.py with SymPy 1.14.0, from tests/support/symbolic_counterparts.py. */
/* Taylor series of built-in systems; series and residuals in double-double arithmetic. */
#pragma once

#include "../../include/zerodrift/system.h"

extern const zd_series zd_four_bar_series, zd_knife_edge_series, zd_oscillator_series, zd_pendulum_series;
extern const zd_precise zd_four_bar_precise, zd_knife_edge_precise, zd_oscillator_precise, zd_pendulum_precise;
