/* Which term of a system is not finite. Nobody looks while all goes well: once a run has failed, the step that failed is made again
 * and watched, so that systems pay nothing for being told what is wrong with them.
 */
#include "../core.h"

static const double IMMENSE = 1e75;     /* the state itself is at fault beyond: terms have up to its fourth power */

int zd_first_not_finite(const zd_system *system, int want, const zd_terms *terms)
{
    int nq = system->nq, nv = system->nv, m = zd_constraints(system);
    const struct {
        int term, count;
        const double *x;
    } all[] = {
        {ZD_A, nq * nv, terms->A}, {ZD_M, nv * nv, terms->M},        {ZD_BIAS, nv, terms->d}, {ZD_FORCE, nv, terms->f},
        {ZD_C, m * nv, terms->C},  {ZD_PHI, system->mh, terms->Phi}, {ZD_XI, m, terms->xi},   {ZD_PHI_T, m, terms->Phi_t},
        {ZD_POTENTIAL, 1, terms->V}, {ZD_POWER, 1, terms->power}, {ZD_COMPLEMENT, nv * (nv - m), terms->D},
        {ZD_GAMMA, nv, terms->gamma},
    };
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        if ((want & system->provides & all[i].term) && !isfinite(zd_max_abs(all[i].count, all[i].x))) return all[i].term;
    return 0;
}

static int is_moderate(const zd_system *system, const double *p, const double *v)
{
    return zd_max_abs(system->nq, p) < IMMENSE && zd_max_abs(system->nv, v) < IMMENSE;
}

/* ---- a system that is watched ---- */

typedef struct watched {
    zd_system system;
    int term;       /* the first that was not finite though the state was */
    double t;       /* where */
} watched;

static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    watched *self = (watched *)data;
    int status = self->system.evaluate(self->system.data, want, t, p, v, out);
    if (status || !is_moderate(&self->system, p, v)) return ZD_CALLBACK;
    self->term = zd_first_not_finite(&self->system, want, out);
    self->t = t;
    return self->term ? ZD_CALLBACK : ZD_DONE;
}

/* Makes the last step again, from where it began. */
static int watch_step(zd_run *run, double *t)
{
    watched self = {.system = run->system};
    zd_statistics statistics = run->statistics;
    zd_run_return(run);
    run->system.evaluate = evaluate;
    run->system.data = &self;
    run->point->known = 0;
    zd_run_make_step(run, run->last.h);
    run->system = self.system;
    run->statistics = statistics;
    if (self.term) *t = self.t;
    return self.term;
}

int zd_run_not_finite(zd_run *run, int status, double *t)
{
    const zd_point *point = run->point;
    const zd_system *system = &run->system;
    *t = point->t;
    int term = is_moderate(system, point->p, point->v) ? zd_first_not_finite(system, point->known, &point->terms) : 0;
    return term || status != ZD_NOT_FINITE || !run->last.h ? term : watch_step(run, t);
}
