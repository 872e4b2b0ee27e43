/* Derivatives of the rate, as implicit integrators want them, from the system's own. */
#include <string.h>

#include "../linalg/norms.h"
#include "motion.h"

static int is_known(const zd_motion *motion)
{
    return !motion->formulation->settle && !motion->is_stabilized && !motion->corrections_size;
}

/* J (rows, columns) <- J (rows, rows), where nothing depends on the last entries of the state */
static void widen(int rows, int columns, double *J)
{
    if (rows == columns) return;
    for (int i = rows - 1; i >= 0; i--) {
        memmove(J + i * rows, J + i * columns, (size_t)columns * sizeof *J);
        for (int j = columns; j < rows; j++) J[i * rows + j] = 0;
    }
}

int zd_motion_jacobian(void *context, double t, const double *y, double *J)
{
    zd_motion *motion = context;
    const zd_system *system = &motion->system;
    const int size = motion->rate.size;
    if (!is_known(motion)) return ZD_SINGULAR;
    motion->statistics.evaluations++;
    int status = system->jacobian->evaluate(system->data, t, y, y + system->nq, J, motion->scratch);
    if (status) return status;
    widen(size, system->nq + system->nv, J);
    return zd_is_finite(size * size, J) ? ZD_DONE : ZD_NOT_FINITE;
}
