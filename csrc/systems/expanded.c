/* The packed matrices are written behind the inner system's own scratch, and expanded from there. */
#include "expanded.h"

#include "../point/expand.h"
#include "../point/layout.h"

static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const zd_system *inner = data;
    zd_terms terms = *out;
    terms.A = out->scratch + inner->scratch;
    terms.M = terms.A + zd_packed_size(inner, ZD_A);
    terms.C = terms.M + zd_packed_size(inner, ZD_M);
    int status = inner->evaluate(inner->data, want, t, p, v, &terms);
    if (status) return status;
    if (want & ZD_A) zd_expand(inner, ZD_A, terms.A, out->A);
    if (want & ZD_M) zd_expand(inner, ZD_M, terms.M, out->M);
    if (want & ZD_C) zd_expand(inner, ZD_C, terms.C, out->C);
    return ZD_DONE;
}

zd_system zd_expanded(const zd_system *inner)
{
    return (zd_system){
        .nq = inner->nq,
        .nv = inner->nv,
        .mh = inner->mh,
        .mn = inner->mn,
        .provides = inner->provides,
        .scratch = inner->scratch + zd_packed_size(inner, ZD_A) + zd_packed_size(inner, ZD_M) + zd_packed_size(inner, ZD_C),
        .evaluate = evaluate,
        .data = inner,
        .lengths = inner->lengths,
        .length = inner->length,
        .failure = inner->failure,
        .inputs = inner->inputs,
        .input = inner->input,
        .quaternions = inner->quaternions,
        .quaternion = inner->quaternion,
    };
}
