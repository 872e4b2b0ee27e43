/* Which term of a system is not finite. */
#include <math.h>

#include "../linalg/norms.h"
#include "point.h"

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
        if ((want & system->provides & all[i].term) && !zd_is_finite(all[i].count, all[i].x)) return all[i].term;
    return 0;
}
