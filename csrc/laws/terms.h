/* Terms of a system by programs, where no code is compiled.
 *
 * Plain declarations only: CFFI parses this text.
 */
#pragma once

#include <stddef.h>

#include "../include/zerodrift/terms.h"
#include "program.h"

/* Instructions that run where one of `terms` is wanted. */
typedef struct zd_term_group {
    int terms;                  /* bits */
    int first;                  /* place in the frame of the first value */
    const zd_instruction *instructions;
} zd_term_group;

typedef struct zd_term_results {
    int term;                   /* its bit */
    size_t offset;              /* offset of its pointer in zd_terms, bytes */
    int results;
    const uint16_t *result;     /* (results,) places in the frame */
} zd_term_results;

/* A frame is the scratch memory of a run: numbers, literals, t, p (nq,), v (nv,), then values of instructions. */
typedef struct zd_term_programs {
    int numbers, literals, nq, nv, groups, terms;
    const double *literal;
    const zd_term_group *group;
    const zd_term_results *term;
} zd_term_programs;

/* Data of zd_terms_by_programs(); closed-form functions read the numbers, too. */
typedef struct zd_terms_data {
    const double *numbers;
    const zd_term_programs *programs;
} zd_terms_data;

/* A zd_evaluate. */
int zd_terms_by_programs(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out);
