/* The named functions of a mechanism's motion. */
#ifndef ZD_MECHANISM_MEASURES_H
#define ZD_MECHANISM_MEASURES_H

#include "plan.h"

/* Fills in the names and sizes of the measures that the mechanism has been told. */
zd_measures zd_mechanism_measures(const zd_mechanism *self, zd_measure *measure);

#endif
