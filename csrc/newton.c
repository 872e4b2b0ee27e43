#include "newton.h"

#include <math.h>

#include "zerodrift.h"

int zd_newton_solve(const zd_newton *newton, void *context, int *iterations, double *residual)
{
    for (*iterations = 0;; ++*iterations) {
        int status = newton->residual(context, residual);
        if (status) return status;
        if (*residual <= newton->tolerance) return ZD_DONE;
        if (!isfinite(*residual)) return ZD_NOT_FINITE;
        if (*iterations == newton->max_iterations) return ZD_NO_CONVERGENCE;
        status = newton->improve(context);
        if (status) return status;
    }
}
