/* Limits that Python reads. */
#include "step_limits.h"

#include "zerodrift.h"

const zd_warning_limits *zd_limits_of_warnings(void)
{
    static const zd_warning_limits limits = {
        ZD_REPORTED_PIVOT, ZD_LARGEST_ENERGY_ERROR, ZD_LARGEST_ENERGY_CORRECTION, ZD_ENERGY_ROUNDING};
    return &limits;
}
