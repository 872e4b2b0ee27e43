#include "registry.h"

#include <string.h>

#define SYSTEMS(X) \
    X(zd_four_bar) X(zd_oscillator) X(zd_pendulum) X(zd_slider_crank) X(zd_knife_edge) \
    X(zd_chaplygin_sleigh) X(zd_rolling_disc) X(zd_vertical_disc) X(zd_driven_four_bar)
#define FORMULATIONS(X) X(zd_augmented) X(zd_nullspace) X(zd_schur) X(zd_mixed) X(zd_independent)
#define INTEGRATORS(X) \
    X(zd_euler) X(zd_midpoint) X(zd_heun) X(zd_rk4) X(zd_dormand_prince) X(zd_dop853) X(zd_extrapolation) X(zd_trapezoidal) X(zd_radau) X(zd_rattle) \
    X(zd_taylor)
#define CORRECTIONS(X)  X(zd_baumgarte_row) X(zd_projection_row) X(zd_energy_row)    /* in the order they are applied */

#define DECLARE_KIND(name) extern const zd_kind name;
#define DECLARE_FORMULATION(name) extern const zd_formulation name;
#define DECLARE_INTEGRATOR(name) extern const zd_integrator name;
#define DECLARE_CORRECTION(name) extern const zd_correction name;
#define ADDRESS(name) &name,

SYSTEMS(DECLARE_KIND)
FORMULATIONS(DECLARE_FORMULATION)
INTEGRATORS(DECLARE_INTEGRATOR)
CORRECTIONS(DECLARE_CORRECTION)

static const zd_kind *const kinds[] = {SYSTEMS(ADDRESS)};
static const zd_formulation *const formulations[] = {FORMULATIONS(ADDRESS)};
static const zd_integrator *const integrators[] = {INTEGRATORS(ADDRESS)};
static const zd_correction *const corrections[] = {CORRECTIONS(ADDRESS)};

#define COUNT(table) ((int)(sizeof(table) / sizeof(table)[0]))
_Static_assert(COUNT(corrections) <= ZD_CORRECTIONS_MAX, "settings have room for all corrections");
#define PICK(table, row) ((row) >= 0 && (row) < COUNT(table) ? (table)[row] : NULL)

const zd_kind *zd_kind_of(int row) { return PICK(kinds, row); }
const zd_formulation *zd_formulation_of(int row) { return PICK(formulations, row); }
const zd_integrator *zd_integrator_of(int row) { return PICK(integrators, row); }
const zd_correction *zd_correction_of(int row) { return PICK(corrections, row); }

int zd_correction_requires(int correction)
{
    const zd_correction *row = zd_correction_of(correction);
    return row ? row->requires : 0;
}

int zd_suits(const zd_system *system, int integrator)
{
    const zd_integrator *row = zd_integrator_of(integrator);
    return row && (!row->suits || row->suits(system));
}

int zd_formulation_suits(const zd_system *system, int formulation)
{
    const zd_formulation *row = zd_formulation_of(formulation);
    return row && (!row->suits || row->suits(system));
}

int zd_rows(enum zd_table table)
{
    switch (table) {
    case ZD_SYSTEMS: return COUNT(kinds);
    case ZD_FORMULATIONS: return COUNT(formulations);
    case ZD_INTEGRATORS: return COUNT(integrators);
    case ZD_CORRECTIONS: return COUNT(corrections);
    }
    return 0;
}

int zd_row_named(enum zd_table table, const char *name)
{
    for (int row = 0; row < zd_rows(table); row++)
        if (!strcmp(zd_row(table, row)->name, name)) return row;
    return -1;
}

static int row_of(enum zd_table table, const zd_card *card)
{
    int row = 0;
    while (zd_row(table, row) != card) row++;
    return row;
}

int zd_default_row(enum zd_table table)
{
    switch (table) {
    case ZD_SYSTEMS: return row_of(table, &zd_four_bar.card);
    case ZD_FORMULATIONS: return row_of(table, &zd_schur.card);
    case ZD_INTEGRATORS: return row_of(table, &zd_rk4.card);
    case ZD_CORRECTIONS: return row_of(table, &zd_projection_row.card);
    }
    return 0;
}

const zd_card *zd_row(enum zd_table table, int row)
{
    if (row < 0 || row >= zd_rows(table)) return NULL;
    switch (table) {
    case ZD_SYSTEMS: return &kinds[row]->card;
    case ZD_FORMULATIONS: return &formulations[row]->card;
    case ZD_INTEGRATORS: return &integrators[row]->card;
    case ZD_CORRECTIONS: return &corrections[row]->card;
    }
    return NULL;
}
