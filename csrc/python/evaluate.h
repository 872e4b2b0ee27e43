/* Evaluation of systems written in Python. It copies the state and the terms between the core's memory, which is freed with the run, and
 * that of Python, detects changes of the state, and terms that are not finite, at a hundredth of the cost in Python. The extension module
 * includes this text with ZD_FINGERPRINT and ZD_LAYOUT defined.
 */
#pragma once

#include <string.h>

#include "../laws/elimination.h"
#include "../laws/terms.h"
#include "interface.h"

const char *const zd_fingerprint = ZD_FINGERPRINT;
const char *const zd_layout = ZD_LAYOUT;

/* to <- from; returns true if any bit has changed */
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
