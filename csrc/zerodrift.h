/* zerodrift: constrained multibody systems without constraint drift.
 *
 * The public C interface, by subject. The system interface itself stands in include/zerodrift/system.h, which is shipped to authors of
 * systems.
 * Declarations only: CFFI reads this text after the preprocessor. Equation numbers are those of W. Blajer, "Elimination of Constraint
 * Violation and Accuracy Aspects in Numerical Simulation of Multibody Systems", Multibody System Dynamics 7 (2002) 265-284.
 */
#ifndef ZERODRIFT_H
#define ZERODRIFT_H

#include "include/zerodrift/system.h"
#include "zerodrift/many_runs.h"
#include "zerodrift/run.h"
#include "zerodrift/settings.h"
#include "zerodrift/states.h"
#include "zerodrift/tables.h"

#endif
