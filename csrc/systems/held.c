/* Holding is a constraint like any other: p_i - value_i = 0 among the holonomic rows, v_i - value_i = 0 among the
 * nonholonomic ones. The rows of the inner system are evaluated into the scratch and copied where they belong.
 */
#include "held.h"

#include <string.h>

#include "../point/point.h"

static int count(const int *hold, int n)
{
    int held = 0;
    for (int i = 0; hold && i < n; i++) held += hold[i] != 0;
    return held;
}

/* The inner system writes its rows behind its own scratch: C (m, nv), A (nq, nv). */
static zd_terms inner_terms(const zd_system *inner, const zd_terms *out)
{
    zd_terms terms = *out;
    terms.C = out->scratch + inner->scratch;
    terms.A = terms.C + zd_constraints(inner) * inner->nv;
    return terms;
}

static void copy_rows(double *to, const double *from, int rows, int width)
{
    if (rows) memcpy(to, from, (size_t)(rows * width) * sizeof *to);
}

static int evaluate_positions(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const zd_held *held = data;
    const zd_system *inner = held->inner;
    int nv = inner->nv, mh = inner->mh;
    const zd_terms terms = inner_terms(inner, out);
    int status = inner->evaluate(inner->data, (want | ZD_A) & (inner->provides | ZD_MOVED), t, p, v, &terms);
    if (status) return status;
    if (want & ZD_C) copy_rows(out->C, terms.C, mh, nv);
    if (want & ZD_A) copy_rows(out->A, terms.A, inner->nq, nv);
    for (int i = 0, row = mh; held->hold && i < inner->nq; i++) {
        if (!held->hold[i]) continue;
        if (want & ZD_PHI) out->Phi[row] = p[i] - held->value[i];
        for (int j = 0; (want & ZD_C) && j < nv; j++)
            out->C[row * nv + j] = inner->provides & ZD_A ? terms.A[i * nv + j] : i == j;   /* C = dPhi/dp A */
        row++;
    }
    return ZD_DONE;
}

static int evaluate_velocities(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const zd_held *held = data;
    const zd_system *inner = held->inner;
    int nv = inner->nv, m = zd_constraints(inner);
    int status = inner->evaluate(inner->data, want & (inner->provides | ZD_MOVED), t, p, v, out);
    if (status) return status;
    if ((want & ZD_PHI_T) && !(inner->provides & ZD_PHI_T)) memset(out->Phi_t, 0, (size_t)m * sizeof(double));
    for (int i = 0, row = m; held->hold && i < nv; i++) {
        if (!held->hold[i]) continue;
        if (want & ZD_PHI_T) out->Phi_t[row] = -held->value[i];
        for (int j = 0; (want & ZD_C) && j < nv; j++) out->C[row * nv + j] = i == j;
        row++;
    }
    return ZD_DONE;
}

/* These are of the inner system alone. */
static void leave_out_others(zd_system *system)
{
    system->operations = NULL;
    system->direct = NULL;
    system->directs = 0;
}

zd_system zd_hold_positions(zd_held *held, const zd_system *inner, const int *hold, const double *p)
{
    *held = (zd_held){inner, hold, p};
    zd_system system = *inner;
    leave_out_others(&system);
    system.mh += count(hold, inner->nq);
    system.mn = 0;
    system.provides = ZD_M | (inner->provides & ZD_A) | (system.mh ? ZD_PHI | ZD_C : 0);
    system.scratch += (zd_constraints(inner) + inner->nq) * inner->nv;
    system.evaluate = evaluate_positions;
    system.data = held;
    return system;
}

zd_system zd_hold_velocities(zd_held *held, const zd_system *inner, const int *hold, const double *v)
{
    *held = (zd_held){inner, hold, v};
    zd_system system = *inner;
    leave_out_others(&system);
    int rows = count(hold, inner->nv);
    system.mn += rows;
    system.provides = ZD_M | (inner->provides & ZD_PHI_T) | (zd_constraints(&system) ? ZD_C : 0) | (rows ? ZD_PHI_T : 0);
    system.evaluate = evaluate_velocities;
    system.data = held;
    return system;
}
