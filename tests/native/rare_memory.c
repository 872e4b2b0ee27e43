/* Memory that ends while a run steps: parallelograms that pass the bifurcation of each of them, in every formulation. What the core asks for is only
 * granted so many times once the run is there, one time more in each run until nothing is refused. Linked with --wrap, so that each call of the core
 * itself arrives here. Prints "<formulation> <granted> <status> <blocks left when the run is freed> <message>".
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "zerodrift.h"

enum { BARS = 3, N = 3 * BARS, M = 2 * BARS, STEPS = 200 };

static int granted = -1, refused, blocks;      /* granted < 0: as much as is asked for */

void *__real_aligned_alloc(size_t alignment, size_t size);
void __real_free(void *memory);
void *__wrap_aligned_alloc(size_t alignment, size_t size);
void __wrap_free(void *memory);

void *__wrap_aligned_alloc(size_t alignment, size_t size)
{
    if (granted == 0) return refused++, NULL;
    granted -= granted > 0;
    blocks++;
    return __real_aligned_alloc(alignment, size);
}

void __wrap_free(void *memory)
{
    blocks -= memory != NULL;
    __real_free(memory);
}

/* Each with cranks of 0.3 m and a coupler of 1 m, whose inertia is constant; no forces. */
static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    static const double length[3] = {0.3, 1, -0.3};
    (void)data, (void)t;
    for (int i = 0; i < N * N && want & ZD_M; i++) out->M[i] = i % (N + 1) ? 0 : 0.1 + 0.1 * (i % 3);
    for (int i = 0; i < M * N && want & ZD_C; i++) out->C[i] = 0;
    for (int b = 0; b < BARS; b++) {
        double Phi[2] = {-1, 0}, xi[2] = {0, 0};
        for (int i = 3 * b; i < 3 * b + 3; i++) {
            double x = length[i % 3] * cos(p[i]), y = length[i % 3] * sin(p[i]);
            Phi[0] += x, Phi[1] += y, xi[0] += x * v[i] * v[i], xi[1] += y * v[i] * v[i];
            if (want & ZD_C) out->C[2 * b * N + i] = -y, out->C[(2 * b + 1) * N + i] = x;
        }
        for (int k = 0; k < 2 && want & ZD_PHI; k++) out->Phi[2 * b + k] = Phi[k];
        for (int k = 0; k < 2 && want & ZD_XI; k++) out->xi[2 * b + k] = xi[k];
    }
    return ZD_DONE;
}

static void run(const zd_system *system, const zd_settings *settings, int grant)
{
    static double rows[12][2 * N];
    static int counts[2][2];
    zd_record record = {2, 0, rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], rows[6], NULL, NULL, NULL, counts[0], counts[1]};
    double p[N], v[N];
    int status;
    char message[512];
    for (int i = 0; i < N; i++) p[i] = i % 3 == 1 ? 0 : 2.4 + 0.2 * (i / 3), v[i] = i % 3 == 1 ? 0 : 2;
    granted = -1, refused = 0, blocks = 0;
    zd_run *it = zd_run_create(system, settings, p, v, &status, message, sizeof message);
    granted = grant;
    if (it) status = zd_run_advance(it, &record, 1e9);
    if (it) snprintf(message, sizeof message, "%s", zd_run_message(it));
    zd_run_free(it);
    printf("%s %d %d %d %s\n", zd_row(ZD_FORMULATIONS, settings->formulation)->name, grant, status, blocks, message);
}

int main(void)
{
    const zd_system system = {
        .nq = N, .nv = N, .mh = M, .provides = ZD_M | ZD_PHI | ZD_C | ZD_XI | ZD_TIMELESS, .evaluate = evaluate,
    };
    zd_settings settings = {
        .integrator = zd_row_named(ZD_INTEGRATORS, "rk4"), .t1 = 0.6, .step = 0.6 / STEPS, .save_every = STEPS, .on_singular = ZD_CONTINUE,
    };
    const int projection = zd_row_named(ZD_CORRECTIONS, "projection");
    settings.correction[projection] = zd_initial(zd_row(ZD_CORRECTIONS, projection));
    for (settings.formulation = 0; settings.formulation < zd_rows(ZD_FORMULATIONS); settings.formulation++) {
        int grant = 0;
        do run(&system, &settings, grant++);
        while (refused);
    }
    return 0;
}
