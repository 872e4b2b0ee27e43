/* A system with relative perturbations of rounding size in each argument and term, constant in time: the effect of systematic
 * rounding on a motion is measured by comparing a run of this system with one of the original. */
#include "../point/point.h"

static void multiply(int count, const double *factors, double *x)
{
    for (int i = 0; factors && i < count; i++) x[i] *= factors[i];
}

static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const zd_perturbation *self = data;
    const zd_system *inner = self->system;
    int nq = inner->nq, nv = inner->nv;
    double *at_p = out->scratch + inner->scratch, *at_v = at_p + nq;
    for (int i = 0; i < nq; i++) at_p[i] = p[i] * self->p[i];
    for (int i = 0; i < nv; i++) at_v[i] = v[i] * self->v[i];
    int status = inner->evaluate(inner->data, want, t * self->t, at_p, at_v, out);
    if (status) return status;
    zd_terms factors = self->terms, terms = *out;
    for (int row = 0; zd_term_at(row); row++)
        if (want & inner->provides & zd_term_at(row)->term)
            multiply((int)zd_term_size(inner, row), *zd_term_in(&factors, row), *zd_term_in(&terms, row));
    return ZD_DONE;
}

static int embed(const void *data, double t, const double *q, double *p)
{
    const zd_perturbation *self = data;
    return self->system->embed(self->system->data, t, q, p);
}

/* Product with the perturbed A. */
static void times_A(const void *data, const zd_terms *terms, const double *x, double *y)
{
    const zd_system *inner = ((const zd_perturbation *)data)->system;
    inner->operations->times_A(inner->data, terms, x, y);
}

static void follow(const void *data, double *p)
{
    const zd_system *inner = ((const zd_perturbation *)data)->system;
    inner->follow(inner->data, p);
}

/* Magnitudes of the unperturbed constraints: perturbations of rounding size do not matter. */
static int magnitudes(const void *data, double t, const double *p, const double *v, double *magnitude, double *scratch)
{
    const zd_system *inner = ((const zd_perturbation *)data)->system;
    return inner->magnitudes(inner->data, t, p, v, magnitude, scratch);
}

static int measure(const void *data, const double *inputs, int measure, double t, const double *p, const double *v, const double *vdot,
                   const double *lambda, const zd_measured *out, double *scratch)
{
    const zd_system *inner = ((const zd_perturbation *)data)->system;
    return inner->measures->evaluate(inner->data, inputs, measure, t, p, v, vdot, lambda, out, scratch);
}

static int read(const void *data, int function, double t, const double *p, const double *v, const double *r, int is_same_state, double *u,
                double *scratch)
{
    const zd_system *inner = ((const zd_perturbation *)data)->system;
    return inner->reading->evaluate(inner->data, function, t, p, v, r, is_same_state, u, scratch);
}

/* Measures, and user functions that read them, with the perturbation as data. */
static void pass_measures(zd_perturbation *to, zd_system *system)
{
    if (!system->reading) return;
    to->measures = *system->measures, to->reading = *system->reading;
    to->measures.evaluate = measure, to->reading.evaluate = read;
    system->measures = &to->measures, system->reading = &to->reading;
}

zd_system zd_perturbed(zd_perturbation *perturbation)
{
    zd_system system = *perturbation->system;
    pass_measures(perturbation, &system);
    system.scratch += system.nq + system.nv;
    system.evaluate = evaluate;
    static const zd_operations rates = {.times_A = times_A};
    /* Rates of dependent coordinates may be known to times_A only; the other operations do not use the perturbed terms. */
    system.operations = system.followers && system.operations && system.operations->times_A ? &rates : NULL;
    system.follow = system.follow ? follow : NULL;
    system.magnitudes = system.magnitudes ? magnitudes : NULL;
    system.force_magnitudes = NULL;
    system.check_domain = NULL;
    system.closed_form = NULL;
    system.closed_forms = 0;
    system.series = perturbation->series;      /* Taylor series of the perturbed terms */
    system.jacobian = NULL;
    system.residuals = NULL;
    system.embed = system.embed ? embed : NULL;
    system.data = perturbation;
    return system;
}
