/* The core through its public interface and the hand-written floors, alternately in one process: the best of many rounds each.
 * Prints "<name> <ns per step> <alpha_1 at 8 s>" for each floor, then for each formulation, every row saved or the last one only.
 *
 * The floors are one source, compiled by bench_four_bar.py with different sines and vector units, and renamed.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "zerodrift.h"

enum { STEPS = 800, ROUNDS = 300, SIZE = 64, CONTESTANTS = 32, FLOORS = 3 };
static const double STEP = 0.01, TOLERANCE = 1e-12;

typedef double floor_function(const double *start, const double *rates, double h, int steps, double tolerance);
floor_function floor_with_sines_of_libm, floor_with_polynomials, floor_of_this_machine;
static floor_function *const floors[FLOORS] = {floor_with_sines_of_libm, floor_with_polynomials, floor_of_this_machine};
static const char *const floor_names[FLOORS] = {"libm", "polynomials", "machine"};

static double now(void)
{
    struct timespec t;
    timespec_get(&t, TIME_UTC);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* alpha_1 at the end, or NaN; only the steps are timed, as creating a run is done once whatever its length */
static double core_run(const zd_system *system, int formulation, int64_t save_every, const double *p, const double *v, double *seconds)
{
    static double t[STEPS + 1], rows[9][3 * (STEPS + 1)];
    static int counts[2][STEPS + 1];
    zd_record record = {STEPS + 1, 0, t, rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], rows[6], rows[7], rows[8],
                        counts[0], counts[1]};
    zd_settings settings = {
        .formulation = formulation,
        .integrator = zd_entry_named(ZD_INTEGRATORS, "rk4"),
        .t1 = STEPS * STEP,
        .step = STEP,
        .save_every = save_every,
    };
    int projection = zd_entry_named(ZD_CORRECTIONS, "projection");
    settings.correction[projection] = zd_initial(zd_entry_card(ZD_CORRECTIONS, projection));
    *zd_value_named(&settings.correction[projection], zd_entry_card(ZD_CORRECTIONS, projection), "tol") = TOLERANCE;
    int status;
    char message[512];
    zd_run *run = zd_run_create(system, &settings, p, v, &status, message, sizeof message);
    if (!run) return NAN;
    double start = now();
    status = zd_run_advance(run, &record, 1e9);
    *seconds = now() - start;
    zd_run_free(run);
    return status ? NAN : record.p[3 * (record.samples - 1)];
}

int main(void)
{
    const zd_kind *kind = zd_kind_of(zd_entry_named(ZD_SYSTEMS, "four_bar"));
    double parameters[SIZE], constants[SIZE], p[3], v[3], best[CONTESTANTS], end[CONTESTANTS];
    int formulations = zd_entry_count(ZD_FORMULATIONS), contestants = FLOORS + 2 * formulations, n = 0;
    for (int i = 0; i < kind->parameters; i++)
        for (int j = 0; j < kind->parameter[i].size; j++)
            parameters[n++] = kind->parameter[i].initial ? kind->parameter[i].initial[j] : NAN;
    if (kind->prepare(parameters, constants) || contestants > CONTESTANTS) return 1;
    zd_system system = kind->system;
    system.data = constants;
    kind->start(parameters, p, v);
    for (int round = 0; round < ROUNDS; round++)
        for (int i = 0; i < contestants; i++) {
            double start = now(), seconds = 0;
            if (i < FLOORS) {
                end[i] = floors[i](p, v, STEP, STEPS, TOLERANCE);
                seconds = now() - start;
            } else {
                end[i] = core_run(&system, (i - FLOORS) / 2, (i - FLOORS) % 2 ? 1 : STEPS, p, v, &seconds);
            }
            if (round == 0 || seconds < best[i]) best[i] = seconds;
        }
    for (int i = 0; i < contestants; i++) {
        const char *name = i < FLOORS ? floor_names[i] : zd_entry_card(ZD_FORMULATIONS, (i - FLOORS) / 2)->name;
        printf("%s%s %.1f %.10f\n", name, i >= FLOORS && (i - FLOORS) % 2 ? "+rows" : "", 1e9 * best[i] / STEPS, end[i]);
    }
    return 0;
}
