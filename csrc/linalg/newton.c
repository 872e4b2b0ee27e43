#include "iteration.h"

enum { MAX_RETREATS = 10 };

/* Armijo's rule: an iteration that does not reduce the residual is shortened. A residual that is NaN does not reduce it. */
static int shorten(const zd_newton *newton, void *context, double before)
{
    double now, share = 1;
    for (int i = 0; i < MAX_RETREATS; i++, share *= 0.5) {
        int status = newton->residual(context, &now);
        if (!status && now <= (1 - 1e-4 * share) * before) return ZD_DONE;
        if (status == ZD_CALLBACK || status == ZD_NO_MEMORY) return status;
        status = newton->retreat(context);
        if (status) return status;
    }
    return ZD_DONE;
}

int zd_newton_solve(const zd_newton *newton, void *context, int *iterations, double *residual)
{
    double first = INFINITY, before = INFINITY;
    for (*iterations = 0;; ++*iterations) {
        int status = newton->residual(context, residual);
        if (status) return status;
        if (*residual <= newton->tolerance || (*residual <= newton->nearly && *residual > before / 2)) return ZD_DONE;
        status = zd_newton_goes_on(*iterations, newton->max_iterations, newton->contraction, *residual, &first);
        before = *residual;
        if (!status) status = newton->improve(context);
        if (!status && newton->retreat) status = shorten(newton, context, *residual);
        if (status) return status;
    }
}
