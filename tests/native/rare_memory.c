/* Memory of a run that passes bifurcations: parallelograms, in every formulation. Once the run is there every request is refused. Linked
 * with --wrap, so that each call of the core itself arrives here. Steps are of fixed size, where constraints come to depend in a stage or,
 * as Euler's method has none, while positions are corrected; and chosen.
 * Prints "<formulation> <integrator> <refused> <status> <blocks left when the run is freed> <message>".
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "zerodrift.h"

static const double BEND = 0.1;
enum { BARS = 3, N = 3 * BARS, M = 2 * BARS, STEPS = 200 };

static int refuses, refused, blocks;

void *__real_aligned_alloc(size_t alignment, size_t size);
void __real_free(void *memory);
void *__wrap_aligned_alloc(size_t alignment, size_t size);
void __wrap_free(void *memory);

void *__wrap_aligned_alloc(size_t alignment, size_t size)
{
    if (refuses) return refused++, NULL;
    blocks++;
    return __real_aligned_alloc(alignment, size);
}

void __wrap_free(void *memory)
{
    blocks -= memory != NULL;
    __real_free(memory);
}

/* Each with cranks of 0.3 m and a coupler of 1 m, whose inertia is constant; no forces. The second crank's angle is s + BEND s^2, so that no
 * step ends on the constraints without a correction. */
static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    static const double length[3] = {0.3, 1, -0.3};
    (void)data, (void)t;
    for (int i = 0; i < N * N && want & ZD_M; i++) out->M[i] = i % (N + 1) ? 0 : 0.1 + 0.1 * (i % 3);
    for (int i = 0; i < M * N && want & ZD_C; i++) out->C[i] = 0;
    for (int b = 0; b < BARS; b++) {
        double Phi[2] = {-1, 0}, xi[2] = {0, 0};
        for (int i = 3 * b; i < 3 * b + 3; i++) {
            double bend = i % 3 == 2 ? BEND : 0, angle = p[i] * (1 + bend * p[i]), slope = 1 + 2 * bend * p[i];
            double x = length[i % 3] * cos(angle), y = length[i % 3] * sin(angle);
            double turn = slope * slope * v[i] * v[i], shift = 2 * bend * v[i] * v[i];
            Phi[0] += x, Phi[1] += y, xi[0] += x * turn + y * shift, xi[1] += y * turn - x * shift;
            if (want & ZD_C) out->C[2 * b * N + i] = -y * slope, out->C[(2 * b + 1) * N + i] = x * slope;
        }
        for (int k = 0; k < 2 && want & ZD_PHI; k++) out->Phi[2 * b + k] = Phi[k];
        for (int k = 0; k < 2 && want & ZD_XI; k++) out->xi[2 * b + k] = xi[k];
    }
    return ZD_DONE;
}

static void run(const zd_system *system, const zd_settings *settings)
{
    static double rows[12][2 * N];
    static int counts[2][2];
    zd_record record = {2, 0, rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], rows[6], NULL, NULL, NULL, counts[0], counts[1]};
    double p[N], v[N];
    int status;
    char message[512];
    for (int i = 0; i < N; i++) {
        double bend = i % 3 == 2 ? BEND : 0, angle = i % 3 == 1 ? 0 : 2.4 + 0.2 * (i / 3);
        p[i] = 2 * angle / (1 + sqrt(1 + 4 * bend * angle));
        v[i] = i % 3 == 1 ? 0 : 2 / (1 + 2 * bend * p[i]);
    }
    refuses = refused = blocks = 0;
    zd_run *it = zd_run_create(system, settings, p, v, &status, message, sizeof message);
    refuses = 1;
    if (it) status = zd_run_advance(it, &record, 1e9);
    if (it) snprintf(message, sizeof message, "%s", zd_run_message(it));
    zd_run_free(it);
    printf("%s %s %d %d %d %s\n", zd_entry_card(ZD_FORMULATIONS, settings->formulation)->name,
           zd_entry_card(ZD_INTEGRATORS, settings->integrator)->name, refused, status, blocks, message);
}

int main(void)
{
    const zd_system system = {
        .nq = N, .nv = N, .mh = M, .provides = ZD_M | ZD_PHI | ZD_C | ZD_XI | ZD_TIMELESS, .evaluate = evaluate,
    };
    static const char *const integrators[] = {"rk4", "euler", "dormand_prince"};
    zd_settings settings = {.t1 = 0.6, .save_every = STEPS, .on_singular = ZD_CONTINUE};
    const int projection = zd_entry_named(ZD_CORRECTIONS, "projection");
    settings.correction[projection] = zd_initial(zd_entry_card(ZD_CORRECTIONS, projection));
    for (int i = 0; i < 3 * zd_entry_count(ZD_FORMULATIONS); i++) {
        const int is_chosen = i % 3 == 2;
        settings.formulation = i / 3;
        settings.integrator = zd_entry_named(ZD_INTEGRATORS, integrators[i % 3]);
        settings.steps = is_chosen ? ZD_ADAPTIVE_STEPS : ZD_FIXED_STEPS;
        settings.step = settings.t1 / STEPS;
        settings.rtol = settings.atol = is_chosen ? 1e-9 : 0;
        run(&system, &settings);
    }
    return 0;
}
