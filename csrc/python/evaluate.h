/* Between the core and Python stands a little C, as it costs a hundredth there: it copies the state and the terms between the core's memory,
 * which goes with the run, and Python's own, and notices whether the state has changed, and numbers that are not finite. The extension
 * module includes this text and has ZD_FINGERPRINT defined before it.
 */
#ifndef ZD_PYTHON_EVALUATE_H
#define ZD_PYTHON_EVALUATE_H

#include <string.h>

#include "interface.h"

const char *const zd_fingerprint = ZD_FINGERPRINT;

/* to <- from; returns whether that changed a bit */
static int replace(double *to, const double *from, int n)
{
    if (memcmp(to, from, (size_t)n * sizeof *to) == 0) return 0;
    memcpy(to, from, (size_t)n * sizeof *to);
    return 1;
}

int zd_evaluate_in_python(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const zd_python *self = data;
    const zd_system *system = self->system;
    int moved = replace(self->p, p, system->nq) | replace(self->v, v, system->nv) << 1;
    int status = zd_write_in_python(self->evaluator, want, t, moved);
    if (status) return status;
    for (const zd_python_term *term = self->term; term < self->term + self->terms; term++)
        if (want & term->term) memcpy(*(double *const *)(const void *)((const char *)out + term->offset), term->values, term->size);
    int not_finite = zd_first_not_finite(system, want, out);
    return not_finite ? zd_refuse_in_python(self->evaluator, not_finite, t) : ZD_DONE;
}

#endif
