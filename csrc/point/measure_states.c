#include "point.h"

int zd_measure_states(const zd_system *system, const double *inputs, int count, const int *measures, int64_t states, const double *t,
                      const double *p, const double *v, const double *vdot, const double *multipliers, const zd_measured *first,
                      double *scratch)
{
    const zd_measures *all = system->measures;
    const int64_t nq = system->nq, nv = system->nv, m = zd_constraints(system), k = system->reading ? system->reading->functions : 0;
    zd_measured at = *first;
    int status = ZD_DONE;
    for (int64_t i = 0; i < states && !status; i++) {
        for (int j = 0; j < count && !status; j++) {
            const int64_t size = all->measure[measures[j]].size;
            status = all->evaluate(system->data, inputs ? inputs + i * k : NULL, measures[j], t[i], p + i * nq, v + i * nv,
                                   vdot ? vdot + i * nv : NULL, multipliers ? multipliers + i * m : NULL, &at, scratch);
            at.is_same_state = 1;
            if (at.value) at.value += size;
            if (at.rate) at.rate += size;
            if (at.jacobian) at.jacobian += size * nv;
            if (at.bias) at.bias += size;
            if (at.least) at.least += m;
            if (at.redundant) at.redundant += size * m;
        }
        if (at.efforts) at.efforts++;
        at.is_same_state = 0;
    }
    return status;
}
