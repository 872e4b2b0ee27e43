#ifndef ZD_EXPLAIN_H
#define ZD_EXPLAIN_H

#include "run.h"

/* Writes the run's message, if it has none yet; gives the status, or a better one, back. */
int zd_explain(zd_run *run, int status);

#endif
