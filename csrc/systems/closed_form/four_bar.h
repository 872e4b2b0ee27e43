/* Written by python/write_closed_form.py with SymPy 1.14.0, from tests/support/symbolic_counterparts.py. */
#pragma once

#include "../../include/zerodrift/system.h"
#include "../../include/zerodrift/units.h"

/* Range of the constants of the closed-form functions among those of the system. */
enum { ZD_FOUR_BAR_CLOSED_FORM_BEGINS = 14, ZD_FOUR_BAR_CLOSED_FORM_ENDS = 36 };

extern const zd_closed_form zd_four_bar_closed_form[];
/* Computes the constants that depend on the parameters alone, which are the first of these doubles. */
void zd_four_bar_closed_form_constants(double *k);
