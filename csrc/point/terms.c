/* The terms of a system: all that follows from their list in the public header. */
#include "terms.h"

#include <stddef.h>

#include "../linalg/norms.h"
#include "layout.h"

#define ROW(name, bit, member, shape, depends, text) {bit, #name, #member, #shape, offsetof(zd_terms, member), depends, text},
static const zd_term_row rows[] = {ZD_TERM_LIST(ROW)};
enum { ROWS = sizeof rows / sizeof rows[0] };

#define ADD(name, bit, member, shape, depends, text) +(bit)
#define UNITE(name, bit, member, shape, depends, text) | (bit)
_Static_assert((0 ZD_TERM_LIST(ADD)) == (0 ZD_TERM_LIST(UNITE)), "each term has a bit of its own");
_Static_assert((0 ZD_TERM_LIST(UNITE)) < ZD_MOVED, "the bits of terms are below those that are said besides");

const zd_term_row *zd_term_at(int row) { return row >= 0 && row < ROWS ? &rows[row] : NULL; }

#define ZD_NUMBER {0, {1, 1}}
#define ZD_VECTOR(size) {1, {size, 1}}
#define ZD_MATRIX(rows, columns) {2, {rows, columns}}
#define NUMBERED(name, bit, member, shape, depends, text) ROW_OF_##name,
#define SHAPED(name, bit, member, shape, depends, text) case ROW_OF_##name: return (zd_shape)shape;
enum { ZD_TERM_LIST(NUMBERED) };

zd_shape zd_term_shape(const zd_system *system, int row)
{
    const int nq = system->nq, nv = system->nv, mh = system->mh, m = zd_constraints(system), r = m < nv ? nv - m : 0;
    switch (row) {
        ZD_TERM_LIST(SHAPED)
    }
    return (zd_shape){0, {0, 0}};
}

size_t zd_term_size(const zd_system *system, int row)
{
    if (system->structure && (rows[row].term & (ZD_A | ZD_M | ZD_C))) return (size_t)zd_packed_size(system, rows[row].term);
    zd_shape shape = zd_term_shape(system, row);
    return (size_t)shape.size[0] * (size_t)shape.size[1];
}

double **zd_term_in(zd_terms *terms, int row) { return (double **)(void *)((char *)terms + rows[row].offset); }

double *zd_take_inputs(zd_arena *arena, const zd_system *system)
{
    if (!system->inputs) return NULL;
    double *inputs = zd_take_doubles(arena, 2 * (size_t)system->inputs + 1);
    for (int i = 0; inputs && i < system->inputs; i++) inputs[i] = system->input[i].initial;
    return inputs;
}

const char *zd_term_name(int term)
{
    for (int i = 0; i < ROWS; i++)
        if (rows[i].term == term) return rows[i].name;
    return "?";
}

int zd_first_not_finite(const zd_system *system, int want, const zd_terms *terms)
{
    zd_terms all = *terms;
    for (int i = 0; i < ROWS; i++)
        if ((want & system->provides & rows[i].term) && !zd_is_finite((int)zd_term_size(system, i), *zd_term_in(&all, i)))
            return rows[i].term;
    return 0;
}
