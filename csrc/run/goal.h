/* Open runs: the goal of the present advance, and the return from a step that failed. */
#ifndef ZD_GOAL_H
#define ZD_GOAL_H

#include "run.h"

/* Removes the end of a run that is at its start. */
void zd_run_leave_open(zd_run *run);
/* Saves the start of the next step. */
void zd_run_save_good(zd_run *run);
/* Returns from a failed step to its start, from where the run can go on; on failure it cannot. */
int zd_run_return_to_good(zd_run *run);

#endif
