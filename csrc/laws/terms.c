#include "terms.h"

#include <string.h>

int zd_terms_by_programs(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const zd_terms_data *given = data;
    const zd_term_programs *self = given->programs;
    const size_t numbers = (size_t)self->numbers, literals = (size_t)self->literals, nq = (size_t)self->nq, size = sizeof *p;
    double *value = out->scratch, *time = value + numbers + literals;
    memcpy(value, given->numbers, numbers * size);
    memcpy(value + numbers, self->literal, literals * size);
    *time = t;
    memcpy(time + 1, p, nq * size);
    memcpy(time + 1 + nq, v, (size_t)self->nv * size);
    for (const zd_term_group *group = self->group; group < self->group + self->groups; group++)
        if (want & group->terms) zd_program_run(group->instructions, value, value + group->first);
    for (const zd_term_results *term = self->term; term < self->term + self->terms; term++) {
        double *to = *(double *const *)(const void *)((const char *)out + term->offset);
        for (int i = 0; want & term->term && i < term->results; i++) to[i] = value[term->result[i]];
    }
    return ZD_DONE;
}
