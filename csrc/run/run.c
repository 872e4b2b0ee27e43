/* Queries of a run: progress, message, statistics; and the table of statuses. */
#include "phases.h"

#include <stddef.h>

#include "../constraints/rank.h"

double zd_run_progress(const zd_run *run)
{
    const double span = run->loop.end - run->settings.t0;
    const double t = run->output.is_open ? run->output.after.state.t : run->stepper.t;    /* the step is finished, its samples are not */
    return span > 0 ? (t - run->settings.t0) / span : 1;
}

const char *zd_run_message(const zd_run *run) { return run->outcome.message; }
const zd_statistics *zd_run_statistics(const zd_run *run) { return &run->motion.statistics; }
int zd_run_redundant(const zd_run *run, int *rows)
{
    const int count = zd_rank_redundant(run->motion.point->rank, rows);
    for (int i = 0; run->phases && i < count; i++) rows[i] = run->motion.point->phase->row[rows[i]];
    return count;
}

const double *zd_run_sizes(const zd_run *run) { return run->phases ? zd_phases_sizes(run) : run->motion.point->size; }
const zd_energy_jump *zd_run_energy_jump(const zd_run *run) { return &run->motion.balance.jump; }
double zd_run_kinetic(const zd_run *run) { return run->safeguards.guard.kinetic; }
double zd_run_energy_error(const zd_run *run) { return run->tally.energy_error; }
double zd_run_omega_h(const zd_run *run) { return zd_guard_omega_h(&run->safeguards.guard); }

/* Statuses: all that follows from their list in the public header. */

#define ROW(name, number, error, sentence) {number, #name, error, sentence},
static const zd_status_row rows[] = {ZD_STATUS_LIST(ROW)};
enum { ROWS = sizeof rows / sizeof rows[0] };

const zd_status_row *zd_status_at(int row) { return row >= 0 && row < ROWS ? &rows[row] : NULL; }

const char *zd_sentence(int status)
{
    for (int i = 0; i < ROWS; i++)
        if (rows[i].status == status) return rows[i].sentence;
    return "an unknown status";
}
