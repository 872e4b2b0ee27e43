/* A large system whose rows are independent all the way, through the core's public interface: what an ordinary run costs, in time and in
 * memory.
 *
 *     M constant, f = -p - c v,    Phi_k = b_k p + 1/2 sum_i q_ki p_i^2
 *
 * with n = 60 velocities and m = 50 rows of random numbers, so that every entry of C moves at every step. Prints for each formulation "<name>
 * <ns per step> <bytes held while it steps> <most bytes at once> <p_0 at the end>", the least time of so many rounds.
 * Compiled with -DEARLIER for cores whose settings were others. Linked with --wrap=aligned_alloc,--wrap=free, so that memory is counted where
 * the core asks for it.
 */
#include <malloc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "zerodrift.h"

enum { N = 60, M = 50, STEPS = 100, MAX_ROUNDS = 1000, MAX_FORMULATIONS = 16 };
static const double STEP = 0.01, TOLERANCE = 1e-10;

typedef struct numbers {
    double mass[N * N], b[M * N], q[M * N];
} numbers;

/* ---- memory ---- */

static size_t held, most;
void *__real_aligned_alloc(size_t alignment, size_t size);
void __real_free(void *memory);
void *__wrap_aligned_alloc(size_t alignment, size_t size);
void __wrap_free(void *memory);

void *__wrap_aligned_alloc(size_t alignment, size_t size)
{
    void *memory = __real_aligned_alloc(alignment, size);
    held += memory ? malloc_usable_size(memory) : 0;
    most = held > most ? held : most;
    return memory;
}

void __wrap_free(void *memory)
{
    held -= memory ? malloc_usable_size(memory) : 0;
    __real_free(memory);
}

/* ---- the system ---- */

static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const numbers *x = data;
    (void)t;
    if (want & ZD_M) memcpy(out->M, x->mass, sizeof x->mass);
    for (int i = 0; (want & ZD_FORCE) && i < N; i++) out->f[i] = -p[i] - 0.1 * v[i];
    for (int k = 0; (want & ZD_PHI) && k < M; k++) {
        double sums[4] = {0, 0, 0, 0};
        for (int i = 0; i < N; i++) sums[i % 4] += p[i] * (x->b[k * N + i] + 0.5 * x->q[k * N + i] * p[i]);
        out->Phi[k] = sums[0] + sums[1] + sums[2] + sums[3];
    }
    for (int k = 0; (want & ZD_C) && k < M; k++)
        for (int i = 0; i < N; i++) out->C[k * N + i] = x->b[k * N + i] + x->q[k * N + i] * p[i];
    for (int k = 0; (want & ZD_XI) && k < M; k++) {
        double sums[4] = {0, 0, 0, 0};
        for (int i = 0; i < N; i++) sums[i % 4] -= x->q[k * N + i] * v[i] * v[i];
        out->xi[k] = sums[0] + sums[1] + sums[2] + sums[3];
    }
    return 0;
}

static double random_number(void)       /* of -1 ... 1, the same on every machine */
{
    static unsigned long long state = 1;
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return (double)(state >> 11) * 0x1p-52 - 1;
}

static void fill(numbers *x)
{
    for (int i = 0; i < N; i++)
        for (int j = 0; j <= i; j++) x->mass[i * N + j] = x->mass[j * N + i] = i == j ? 2 + random_number() : 0.02 * random_number();
    for (int i = 0; i < M * N; i++) x->b[i] = random_number();
    for (int i = 0; i < M * N; i++) x->q[i] = random_number();
}

/* ---- the runs ---- */

static double now(void)
{
    struct timespec t;
    timespec_get(&t, TIME_UTC);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int named(enum zd_table table, const char *name)
{
    int row = 0;
    while (row < zd_entry_count(table) && strcmp(zd_entry_card(table, row)->name, name)) row++;
    return row;
}

#ifdef EARLIER      /* cores whose settings have a member for each correction */
static void correct(zd_settings *settings) { settings->projection = (zd_projection){1, TOLERANCE, 10, ZD_MASS_METRIC, 1, 1}; }
#else
static void correct(zd_settings *settings)
{
    int projection = named(ZD_CORRECTIONS, "projection");
    settings->correction[projection] = zd_initial(zd_entry_card(ZD_CORRECTIONS, projection));
    *zd_value_named(&settings->correction[projection], zd_entry_card(ZD_CORRECTIONS, projection), "tol") = TOLERANCE;
}
#endif

/* p_0 at the end, or NaN, the start being made consistent; only steps are timed, of a run that saves its last row */
static double run(const zd_system *system, zd_settings *settings, double *seconds, size_t *bytes)
{
    static double rows[12][M + N];
    static int counts[2][2];
    zd_record record = {2, 0, rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], rows[6], NULL, NULL, NULL, counts[0], counts[1]};
    double p[N] = {0}, v[N], *both[2] = {p, v};
    char message[512];
    int status;
    for (int i = 0; i < N; i++) v[i] = sin(1 + 7 * i);
    zd_project(system, settings, 0, both[0], both[1], NULL, NULL, NULL, message, sizeof message);
    size_t before = held;
    most = held;
    zd_run *it = zd_run_create(system, settings, p, v, &status, message, sizeof message);
    if (!it) return fprintf(stderr, "%s\n", message), NAN;
    double start = now();
    status = zd_run_advance(it, &record, 1e9);
    *seconds = now() - start;
    if (status) fprintf(stderr, "%s\n", zd_run_message(it));
    *bytes = held - before;
    most -= before;
    zd_run_free(it);
    return status ? NAN : record.p[N * (record.samples - 1)];
}

int main(int arguments, char **argument)
{
    static numbers x;
    double best[MAX_FORMULATIONS] = {0}, end[MAX_FORMULATIONS];
    size_t bytes[MAX_FORMULATIONS], peak[MAX_FORMULATIONS];
    int rounds = arguments > 1 ? atoi(argument[1]) : 3, formulations = zd_entry_count(ZD_FORMULATIONS);
    const char *only = arguments > 2 ? argument[2] : NULL;
    fill(&x);
    zd_system system = {
        .nq = N, .nv = N, .mh = M, .provides = ZD_M | ZD_FORCE | ZD_PHI | ZD_C | ZD_XI | ZD_TIMELESS, .evaluate = evaluate, .data = &x,
    };
    zd_settings settings = {
        .integrator = named(ZD_INTEGRATORS, "rk4"), .t1 = STEPS * STEP, .step = STEP, .save_every = STEPS,
    };
    correct(&settings);
    for (int round = 0; round < rounds; round++)
        for (int i = 0; i < formulations; i++) {
            double seconds = INFINITY;
            if (only && strcmp(only, zd_entry_card(ZD_FORMULATIONS, i)->name)) continue;
            settings.formulation = i;
            end[i] = run(&system, &settings, &seconds, bytes + i);
            peak[i] = most;
            if (round == 0 || seconds < best[i]) best[i] = seconds;
        }
    for (int i = 0; i < formulations; i++)
        if (best[i] > 0)
            printf("%s %.1f %zu %zu %.15f\n", zd_entry_card(ZD_FORMULATIONS, i)->name, 1e9 * best[i] / STEPS, bytes[i], peak[i], end[i]);
    return 0;
}
