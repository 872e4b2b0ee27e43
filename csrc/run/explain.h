#ifndef ZD_EXPLAIN_H
#define ZD_EXPLAIN_H

#include "run.h"

/* Writes the run's message, if it has none yet; returns the status, or a more specific one. */
int zd_explain(zd_run *run, int status);
/* Writes the beginning of a message, with time and step; returns its length. `steps` is 0 if their number is not known in advance. */
size_t zd_say_where(char *to, size_t size, double t, int64_t step, int64_t steps);
void zd_say_event(char *to, size_t size, int event);    /* message of a run ended by this event */

#endif
