/* Traces the calls of one step of the four-bar in a core compiled with -finstrument-functions: prints "<depth> <address>" of each function
 * entered, from the entry of the function whose address is the third argument.
 *
 *     step_trace NUMBER DIRECT ADDRESS    number of the step; 1: in closed form, 0: by matrices
 */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "zerodrift.h"

#define UNTRACED __attribute__((no_instrument_function))
enum { LARGEST = 64, MAX_CALLS = 1 << 20 };

static uintptr_t first, called[MAX_CALLS];
static int depths[MAX_CALLS], calls, depth, number, steps, is_on;

void __cyg_profile_func_enter(void *function, void *from) UNTRACED;
void __cyg_profile_func_exit(void *function, void *from) UNTRACED;

void __cyg_profile_func_enter(void *function, void *from)
{
    (void)from;
    if ((uintptr_t)function == first && ++steps == number) is_on = 1, depth = 0;
    if (!is_on || calls == MAX_CALLS) return;
    called[calls] = (uintptr_t)function;
    depths[calls++] = depth++;
}

void __cyg_profile_func_exit(void *function, void *from)
{
    (void)function, (void)from;
    if (is_on && --depth == 0) is_on = 0;
}

static void run(const zd_system *system, const zd_settings *settings, const double *p, const double *v)
{
    static double t[LARGEST], rows[10][LARGEST * LARGEST];
    static int counts[2][LARGEST];
    zd_record record = {LARGEST, 0, t, rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], rows[6], rows[7], rows[8], counts[0], counts[1]};
    char message[512];
    int status;
    zd_run *run = zd_run_create(system, settings, p, v, &status, message, sizeof message);
    if (run) status = zd_run_advance(run, &record, 1e9);
    if (status || zd_run_statistics(run)->closed_form_steps != (settings->closed_form ? zd_run_statistics(run)->steps : 0))
        exit(EXIT_FAILURE);
    zd_run_free(run);
}

int main(int count, char **argument)
{
    if (count != 4) return EXIT_FAILURE;
    number = atoi(argument[1]);
    first = (uintptr_t)strtoull(argument[3], NULL, 16);
    const zd_kind *kind = zd_kind_of(zd_entry_named(ZD_SYSTEMS, "four_bar"));
    double parameters[LARGEST], constants[LARGEST], p[LARGEST], v[LARGEST];
    int n = 0;
    for (int i = 0; i < kind->parameters; i++)
        for (int j = 0; j < kind->parameter[i].size; j++)
            parameters[n++] = kind->parameter[i].initial ? kind->parameter[i].initial[j] : strtod("nan", NULL);
    if (kind->prepare(parameters, constants)) return EXIT_FAILURE;
    kind->start(parameters, p, v);
    zd_system system = kind->system;
    system.data = constants;
    const int projection = zd_entry_named(ZD_CORRECTIONS, "projection"), energy = zd_entry_named(ZD_CORRECTIONS, "energy");
    zd_settings settings = {
        .formulation = zd_entry_named(ZD_FORMULATIONS, "schur"), .integrator = zd_entry_named(ZD_INTEGRATORS, "rk4"),
        .t1 = 0.3, .step = 0.01, .save_every = 1, .closed_form = atoi(argument[2]),
    };
    settings.correction[projection] = zd_initial(zd_entry_card(ZD_CORRECTIONS, projection));
    settings.correction[energy] = zd_initial(zd_entry_card(ZD_CORRECTIONS, energy));
    settings.correction[projection].given = settings.correction[energy].given = 1;
    run(&system, &settings, p, v);
    for (int i = 0; i < calls; i++) printf("%d %" PRIxPTR "\n", depths[i], called[i]);
    return 0;
}
