/* A point of the motion. A move clears the quantities that it invalidates; each quantity is computed once, at its first request.
 * So the leading matrix of a velocity correction serves the first stage of the next step, and the recorded multipliers
 * cost nothing if that stage needs them anyway. A move compares values, and so is right with any integrator or
 * correction, without flags from them.
 */
#include "point.h"

#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "../linalg/small.h"

/* ---- terms of a system: all that follows from their list in the public header ---- */

#define ROW(name, bit, member, shape, depends, text) {bit, #name, #member, #shape, offsetof(zd_terms, member), depends, text},
static const zd_term_entry rows[] = {ZD_TERM_LIST(ROW)};
enum { ROWS = sizeof rows / sizeof rows[0] };

#define ADD(name, bit, member, shape, depends, text) +(bit)
#define UNITE(name, bit, member, shape, depends, text) | (bit)
_Static_assert((0 ZD_TERM_LIST(ADD)) == (0 ZD_TERM_LIST(UNITE)), "each term has a bit of its own");
_Static_assert((0 ZD_TERM_LIST(UNITE)) < ZD_MOVED, "the bits of terms are below those that are said besides");

const zd_term_entry *zd_term_at(int row) { return row >= 0 && row < ROWS ? &rows[row] : NULL; }

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
    if (system->structure && (rows[row].term & (ZD_A | ZD_M | ZD_C))) return zd_packed_size(system, rows[row].term);
    zd_shape shape = zd_term_shape(system, row);
    return (size_t)shape.size[0] * shape.size[1];
}

double **zd_term_in(zd_terms *terms, int row) { return (double **)(void *)((char *)terms + rows[row].offset); }

double *zd_create_inputs(zd_arena *arena, const zd_system *system)
{
    if (system->reading) {      /* not a number until they are solved for */
        double *u = zd_arena_doubles(arena, system->reading->functions);
        for (int i = 0; u && i < system->reading->functions; i++) u[i] = NAN;
        return u;
    }
    if (!system->inputs) return NULL;
    double *inputs = zd_arena_doubles(arena, 2 * (size_t)system->inputs + 1);
    for (int i = 0; inputs && i < system->inputs; i++) inputs[i] = system->input[i].initial;
    return inputs;
}

int zd_largest_measure(const zd_measures *measures)
{
    int largest = 0;
    for (int i = 0; measures && i < measures->count; i++)
        if (measures->measure[i].size > largest) largest = measures->measure[i].size;
    return largest;
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

/* ---- a point ---- */

static zd_terms create_terms(zd_arena *arena, const zd_system *system)
{
    zd_terms terms = {0};
    for (int row = 0; zd_term_at(row); row++)
        if (system->provides & zd_term_at(row)->term) *zd_term_in(&terms, row) = zd_arena_doubles(arena, zd_term_size(system, row));
    terms.scratch = zd_arena_doubles(arena, system->scratch);
    return terms;
}

zd_point *zd_point_create(zd_arena *arena, const zd_system *system, zd_statistics *statistics)
{
    size_t nq = system->nq, nv = system->nv, m = zd_constraints(system);
    double *vdot = zd_arena_doubles(arena, nv + m);
    zd_point point = {
        .system = system,
        .statistics = statistics,
        .layout = zd_layout_create(arena, system),
        .constant = zd_mass_is(system, ZD_CONSTANT) ? ZD_M : 0,
        .p = zd_arena_doubles(arena, nq),
        .v = zd_arena_doubles(arena, nv),
        .terms = create_terms(arena, system),
        .vdot = vdot,
        .lambda = vdot ? vdot + nv : NULL,
        .force = zd_arena_doubles(arena, nv),
        .rhs = zd_arena_doubles(arena, m),
        .unit = zd_arena_doubles(arena, nv),
        .inverse_unit = zd_arena_doubles(arena, nv),
        .inverse_unit_p = zd_arena_doubles(arena, nq),
        .size = zd_arena_doubles(arena, m),
        .inverse_size = zd_arena_doubles(arena, m),
        .rounding = zd_arena_doubles(arena, m),
        .inputs = zd_create_inputs(arena, system),
    };
    point.terms.inputs = point.inputs;
    return zd_arena_copy(arena, &point, sizeof point);
}

/* to <- from; returns true if any bit has changed */
ZD_INLINE int replace(const int n, double *to, const double *from)
{
    if (memcmp(to, from, n * sizeof *to) == 0) return 0;
    zd_copy_all(n, from, to);
    return 1;
}

void zd_point_move(zd_point *point, double t, const double *p, const double *v)
{
    if (!(t == point->t)) point->known &= point->constant;
    point->t = t;
    zd_point_move_position(point, p);
    zd_point_move_velocity(point, v);
}

void zd_point_move_position(zd_point *point, const double *p)
{
    if (ZD_SIZED(replace, point->system->nq, point->p, p)) point->known &= point->constant;
}

void zd_point_move_velocity(zd_point *point, const double *v)
{
    if (ZD_SIZED(replace, point->system->nv, point->v, v)) point->known &= ~ZD_OF_VELOCITY;
}

int zd_point_need_missing(zd_point *point, int missing)
{
    int moved = ~point->known & ZD_MOVED;
    const zd_system *system = point->system;
    point->statistics->evaluations++;
    int status = system->evaluate(system->data, missing | moved, point->t, point->p, point->v, &point->terms);
    point->left_domain = status == ZD_NOT_FINITE;
    if (status) return ZD_CALLBACK;     /* for any nonzero value: a positive status would mean success */
    point->known |= missing | moved;
    return ZD_DONE;
}

void zd_point_force(const zd_point *point, double *force)
{
    int nv = point->system->nv;
    const double *f = point->terms.f, *d = point->terms.d;
    if (f && d) ZD_SIZED(zd_subtract, nv, f, d, force);
    else
        for (int i = 0; i < nv; i++) force[i] = f ? f[i] : d ? -d[i] : 0;
}

/* True if p and v are finite: 0 * x is NaN otherwise. The sum has no branches. */
ZD_INLINE int are_finite(const int n, const double *p, const double *v)
{
    double zero = 0;
    for (int i = 0; i < n; i++) zero += 0 * p[i] + 0 * v[i];
    return zero == 0;
}

int zd_point_is_finite(const zd_point *point)
{
    const int nq = point->system->nq, nv = point->system->nv;
    return nq == nv ? ZD_SIZED(are_finite, nv, point->p, point->v) : zd_is_finite(nq, point->p) && zd_is_finite(nv, point->v);
}

const char *zd_name_constraint(const zd_system *system, int row, char to[ZD_CONSTRAINT_NAME])
{
    char name[ZD_CONSTRAINT_NAME - 16] = "";
    if (system->name_constraint) system->name_constraint(system->names, row, name, (int)sizeof name);
    if (*name) snprintf(to, ZD_CONSTRAINT_NAME, "%d '%s'", row, name);
    else snprintf(to, ZD_CONSTRAINT_NAME, "%d", row);
    return to;
}
