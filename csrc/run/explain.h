#ifndef ZD_EXPLAIN_H
#define ZD_EXPLAIN_H

#include "run.h"

/* Writes the run's message, if it has none yet; gives the status, or a better one, back. */
int zd_explain(zd_run *run, int status);
/* How messages begin that say where something has happened; how long that is. `steps` is 0 where nobody knows how many there will be. */
size_t zd_say_where(char *to, size_t size, double t, int64_t step, int64_t steps);
void zd_say_event(char *to, size_t size, int event);    /* that this one has ended the run */

#endif
