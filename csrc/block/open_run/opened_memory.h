/* Memory of the mechanism of a block with its open run. */
#pragma once

#include "../block.h"

enum {
    ZD_OPENED_MESSAGE = 2000,   /* names of the bodies and joints of a loop included */
    ZD_OPENED_PLACE = 3         /* numbers at most at the place of an input */
};

struct zd_opened {
    zd_block *block;
    zd_run *run;
    zd_settings settings;
    double *p, *v, *scratch;
    double t0, *initial;        /* time and inputs (inputs,) at the start of the run, if its state can be saved */
    double *present, *places;   /* (inputs,), (inputs, 3): copies of the inputs and of their places, put back if a state is refused */
    char message[ZD_OPENED_MESSAGE];
};

/* Message <- sentence on the drives that bring the run to a dead point within four steps; otherwise it is unchanged. */
void zd_opened_explain_reach(struct zd_opened *self);
/* self->p <- positions at time t, assembled from p (nq,), which may be too far for a projection. Returns a status; the message names the
 * drives that cannot be met. */
int zd_opened_find_positions(struct zd_opened *self, double t, const double *p);
