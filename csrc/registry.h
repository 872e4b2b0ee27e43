/* The four tables. A new entry is a new file and one word in registry.c. */
#pragma once

#include "formulations/formulation.h"
#include "integrators/integrator.h"
#include "motion/correction.h"

const zd_formulation *zd_formulation_of(int row);
const zd_integrator *zd_integrator_of(int row);
const zd_correction *zd_correction_of(int row);
