/* Open runs that are advanced together: each has the bits that it has alone. */
#include <string.h>

#include "../../run/run.h"

static const double SLICE = 3600;       /* s: a slice that does not end */

static void read_state(const zd_open_runs *self, int64_t i)
{
    const zd_run *run = self->run[i];
    const zd_system *system = &run->motion.system;
    const size_t nq = system->nq, nv = system->nv;
    self->t[i] = zd_run_time(run);
    memcpy(self->p + (size_t)i * nq, zd_run_p(run), nq * sizeof(double));
    memcpy(self->v + (size_t)i * nv, zd_run_v(run), nv * sizeof(double));
}

void zd_open_runs_read(const zd_open_runs *self, int64_t first, int64_t count)
{
    for (int64_t i = first; i < first + count; i++) read_state(self, i);
}

void zd_open_runs_advance(const zd_open_runs *self, int64_t first, int64_t count, int64_t steps, double t)
{
    for (int64_t i = first; i < first + count; i++) {
        if (self->status[i] < 0) continue;
        int status = zd_run_set_goal(self->run[i], steps, t);
        if (!status) status = ZD_PAUSED;
        while (status == ZD_PAUSED) status = zd_run_advance(self->run[i], NULL, SLICE);
        self->status[i] = status;
        read_state(self, i);
    }
}

int zd_open_runs_measure(const zd_open_runs *self, const zd_system *const *systems, int measure, double *values, double *scratch)
{
    const int64_t nq = (*systems)->nq, nv = (*systems)->nv, size = (*systems)->measures->measure[measure].size;
    int status = ZD_DONE;
    for (int64_t i = 0; i < self->runs && !status; i++)
        status = zd_run_measure(self->run[i], systems[i], measure, self->t[i], self->p + i * nq, self->v + i * nv, values + i * size,
                                scratch);
    return status;
}
