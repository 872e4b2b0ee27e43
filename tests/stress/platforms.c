/* The paper's four-bar over eight seconds in every formulation and on both paths, as the bits of its last state: the same program is
 * compiled for several systems and run where they are, or are emulated.
 */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "zerodrift.h"

enum { LARGEST = 64 };

static void print_bits(const char *name, int n, const double *value)
{
    for (int i = 0; i < n; i++) {
        uint64_t bits;
        memcpy(&bits, value + i, sizeof bits);
        printf(" %s%d=%016" PRIx64 "(%.15g)", name, i, bits, value[i]);
    }
}

static int run(const zd_kind *kind, int formulation, const char *integrator, int closed_form)
{
    double parameters[LARGEST], constants[LARGEST], p[LARGEST], v[LARGEST];
    int n = 0, status;
    for (int i = 0; i < kind->parameters; i++)
        for (int j = 0; j < kind->parameter[i].size; j++) {
            parameters[n++] = kind->parameter[i].initial ? kind->parameter[i].initial[j] : NAN;     /* NaN: is redundant */
        }
    if (kind->prepare(parameters, constants)) return 1;
    zd_system system = kind->system;
    system.data = constants;
    kind->start(parameters, p, v);

    zd_settings settings = {.t1 = 8.0, .step = 0.01, .save_every = 800, .closed_form = closed_form, .formulation = formulation};
    settings.integrator = zd_entry_named(ZD_INTEGRATORS, integrator);
    int projection = zd_entry_named(ZD_CORRECTIONS, "projection");
    settings.correction[projection] = zd_initial(zd_entry_card(ZD_CORRECTIONS, projection));
    settings.correction[projection].given = 1;
    char message[512];
    zd_run *made = zd_run_create(&system, &settings, p, v, &status, message, sizeof message);
    double t[2], rows[10][2 * LARGEST];
    int counts[2][2];
    zd_record record = {2, 0, t, rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], rows[6], rows[7], rows[8], counts[0], counts[1], NULL};
    if (!made || zd_run_advance(made, &record, 1e9) || record.samples != 2) return 1;
    printf("%s %s %s:", zd_entry_card(ZD_FORMULATIONS, formulation)->name, integrator, closed_form ? "closed_form" : "general");
    print_bits("p", system.nq, rows[0] + system.nq);
    print_bits("v", system.nv, rows[1] + system.nv);
    print_bits("lambda", system.mh + system.mn, rows[2] + system.mh + system.mn);
    printf("\n");
    zd_run_free(made);
    return 0;
}

int main(void)
{
    const zd_kind *kind = zd_kind_of(zd_entry_named(ZD_SYSTEMS, "four_bar"));
    const char *integrators[] = {"rk4", "dop853"};
    for (int formulation = 0; formulation < zd_entry_count(ZD_FORMULATIONS); formulation++)
        for (int i = 0; i < 2; i++)
            for (int closed_form = 0; closed_form < 2; closed_form++)
                if (run(kind, formulation, integrators[i], closed_form)) return 1;
    return 0;
}
