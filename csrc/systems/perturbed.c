/* A system each of whose arguments and terms is off by a rounding or so, always by the same: what systematic rounding does to a
 * motion is then seen by comparing two runs, one of which is of this system. */
#include "../point/point.h"
#include "../zerodrift.h"

static void multiply(int count, const double *factors, double *x)
{
    for (int i = 0; factors && x && i < count; i++) x[i] *= factors[i];
}

static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const zd_perturbation *self = data;
    const zd_system *inner = self->system;
    int nq = inner->nq, nv = inner->nv, m = zd_constraints(inner);
    double *at_p = out->scratch + inner->scratch, *at_v = at_p + nq;
    for (int i = 0; i < nq; i++) at_p[i] = p[i] * self->p[i];
    for (int i = 0; i < nv; i++) at_v[i] = v[i] * self->v[i];
    int status = inner->evaluate(inner->data, want, t * self->t, at_p, at_v, out);
    if (status) return status;
    const zd_terms *factors = &self->terms;
    if (want & ZD_A) multiply(nq * nv, factors->A, out->A);
    if (want & ZD_M) multiply(nv * nv, factors->M, out->M);
    if (want & ZD_BIAS) multiply(nv, factors->d, out->d);
    if (want & ZD_FORCE) multiply(nv, factors->f, out->f);
    if (want & ZD_C) multiply(m * nv, factors->C, out->C);
    if (want & ZD_PHI_T) multiply(m, factors->Phi_t, out->Phi_t);
    if (want & ZD_XI) multiply(m, factors->xi, out->xi);
    return ZD_DONE;
}

static int embed(const void *data, double t, const double *q, double *p)
{
    const zd_perturbation *self = data;
    return self->system->embed(self->system->data, t, q, p);
}

zd_system zd_perturbed(const zd_perturbation *perturbation)
{
    zd_system system = *perturbation->system;
    system.scratch += system.nq + system.nv;
    system.evaluate = evaluate;
    system.embed = system.embed ? embed : NULL;
    system.data = perturbation;
    return system;
}
