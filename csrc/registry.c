#include "registry.h"

#include <string.h>

#include "methods.h"

#define DECLARE_KIND(name) extern const zd_kind name;
#define DECLARE_FORMULATION(name) extern const zd_formulation name;
#define DECLARE_INTEGRATOR(name) extern const zd_integrator name;
#define DECLARE_CORRECTION(name) extern const zd_correction name;
#define ADDRESS(name) &name,

ZD_SYSTEM_LIST(DECLARE_KIND)
ZD_FORMULATION_LIST(DECLARE_FORMULATION)
ZD_INTEGRATOR_LIST(DECLARE_INTEGRATOR)
ZD_CORRECTION_LIST(DECLARE_CORRECTION)

static const zd_kind *const kinds[] = {ZD_SYSTEM_LIST(ADDRESS) NULL};
static const zd_formulation *const formulations[] = {ZD_FORMULATION_LIST(ADDRESS) NULL};
static const zd_integrator *const integrators[] = {ZD_INTEGRATOR_LIST(ADDRESS) NULL};
static const zd_correction *const corrections[] = {ZD_CORRECTION_LIST(ADDRESS) NULL};

#define COUNT(table) ((int)(sizeof(table) / sizeof(table)[0]) - 1)     /* the last entry is NULL */
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
    return row && (!system->reading || zd_evaluates_accelerations(row)) && (!row->suits || row->suits(system));
}

int zd_formulation_suits(const zd_system *system, int formulation)
{
    const zd_formulation *row = zd_formulation_of(formulation);
    return row && (!row->suits || row->suits(system));
}

int zd_entry_count(enum zd_table table)
{
    switch (table) {
    case ZD_SYSTEMS: return COUNT(kinds);
    case ZD_FORMULATIONS: return COUNT(formulations);
    case ZD_INTEGRATORS: return COUNT(integrators);
    case ZD_CORRECTIONS: return COUNT(corrections);
    }
    return 0;
}

int zd_entry_named(enum zd_table table, const char *name)
{
    for (int row = 0; row < zd_entry_count(table); row++)
        if (!strcmp(zd_entry_card(table, row)->name, name)) return row;
    return -1;
}

int zd_default_entry(enum zd_table table)
{
    static const char *const name[] = {"four_bar", "schur", "rk4", "projection"};
    return zd_entry_named(table, name[table]);
}

const zd_card *zd_entry_card(enum zd_table table, int row)
{
    if (row < 0 || row >= zd_entry_count(table)) return NULL;
    switch (table) {
    case ZD_SYSTEMS: return &kinds[row]->card;
    case ZD_FORMULATIONS: return &formulations[row]->card;
    case ZD_INTEGRATORS: return &integrators[row]->card;
    case ZD_CORRECTIONS: return &corrections[row]->card;
    }
    return NULL;
}
