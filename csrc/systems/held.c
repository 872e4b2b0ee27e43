/* Held quantities as constraints: p_i - value_i = 0 is holonomic, v_i - value_i = 0 nonholonomic. The terms of the inner system are
 * evaluated into the scratch and copied to their positions.
 *
 * Such a constraint touches one body; its gradient is a row of A, or of the identity. So a declared structure gets one more group for this
 * body; without a structure the whole system is one body.
 */
#include "held.h"

#include <stdio.h>
#include <string.h>

#include "../linalg/small.h"
#include "../point/point.h"

typedef struct holding {    /* arguments of create() */
    const zd_system *inner;
    const int *hold;
    const double *value;
    int of_positions;
} holding;

typedef struct system_that_holds {
    zd_system system;
    zd_held held;
} system_that_holds;

/* ---- bodies ---- */

static int blocks_of(const zd_system *system) { return system->structure ? system->structure->blocks : 1; }
static int coordinates_of(const zd_system *system, int b) { return system->structure ? system->structure->coordinates[b] : system->nq; }
static int velocities_of(const zd_system *system, int b) { return system->structure ? system->structure->velocities[b] : system->nv; }
static int size_of_A(const zd_system *system) { return system->structure ? zd_packed_size(system, ZD_A) : system->nq * system->nv; }

/* Name of a constraint: by the inner system, or "p[i] is held", "v[i] is held". */
static void name_of_constraint(const void *names, int row, char *to, int size)
{
    const zd_held *held = names;
    const zd_system *inner = held->inner;
    const int rows = held->of_positions ? inner->mh : zd_constraints(inner);
    if (row < rows) {
        if (inner->name_constraint) inner->name_constraint(inner->names, row, to, size);
        return;
    }
    int i = 0;
    for (int left = row - rows; !held->hold[i] || left-- > 0;) i++;
    snprintf(to, size, "%s[%d] is held", held->of_positions ? "p" : "v", i);
}

static int count(const int *hold, int n)
{
    int held = 0;
    for (int i = 0; hold && i < n; i++) held += hold[i] != 0;
    return held;
}

/* ---- structure ---- */

/* Number of groups of the inner system with the first `rows` constraints. */
static int groups_of(const zd_structure *structure, int rows)
{
    int groups = 0;
    for (int before = 0; groups < structure->groups && before < rows; groups++) before += structure->rows[groups];
    return groups;
}

/* Number of stored entries of these groups in C. */
static int size_of_groups(const zd_structure *structure, int groups)
{
    int size = 0;
    for (int g = 0; g < groups; g++)
        for (int i = structure->first[g]; i < structure->first[g + 1]; i++)
            size += structure->rows[g] * structure->velocities[structure->block[i]];
    return size;
}

/* The groups of the first `rows` constraints of the inner system, then one group for each body with held quantities. */
static zd_structure create_structure(zd_arena *arena, const holding *it, int rows)
{
    const zd_structure *inner = it->inner->structure;
    const int groups = groups_of(inner, rows), touched = inner->groups ? inner->first[groups] : 0;
    zd_structure structure = *inner;
    int *rows_of = zd_arena_ints(arena, groups + inner->blocks);
    int *first = zd_arena_ints(arena, groups + inner->blocks + 1);
    int *block = zd_arena_ints(arena, touched + inner->blocks);
    if (!arena->base) return structure;
    if (groups) {
        memcpy(rows_of, inner->rows, groups * sizeof(int));
        memcpy(first, inner->first, (groups + 1) * sizeof(int));
        memcpy(block, inner->block, touched * sizeof(int));
    }
    structure.groups = groups;
    for (int b = 0, i = 0; b < inner->blocks; b++) {
        const int n = it->of_positions ? inner->coordinates[b] : inner->velocities[b], held = it->hold ? count(it->hold + i, n) : 0;
        i += n;
        if (!held) continue;
        block[first[structure.groups]] = b;
        rows_of[structure.groups] = held;
        first[structure.groups + 1] = first[structure.groups] + 1;
        structure.groups++;
    }
    structure.rows = rows_of;
    structure.first = first;
    structure.block = block;
    return structure;
}

/* ---- terms ---- */

/* The inner system writes C, then A, after its own scratch. */
static zd_terms inner_terms(const zd_system *inner, const zd_terms *out)
{
    zd_terms terms = *out;
    terms.C = out->scratch + inner->scratch;
    terms.A = terms.C + zd_size_of_C(inner);
    return terms;
}

/* Writes row i of A (coordinates, n) of a body; A NULL: the identity. Returns the end of the row. */
static double *write_row(int n, const double *A, int i, double *row)
{
    for (int j = 0; j < n; j++) row[j] = A ? A[i * n + j] : i == j;     /* C = dPhi/dp A */
    return row + n;
}

static int evaluate_positions(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const zd_held *held = data;
    const zd_system *inner = held->inner;
    const zd_terms terms = inner_terms(inner, out);
    int status = inner->evaluate(inner->data, (want | ZD_A) & (inner->provides | ZD_MOVED), t, p, v, &terms);
    if (status) return status;
    if (want & ZD_C) zd_copy_all(held->size_of_C, terms.C, out->C);
    if (want & ZD_A) zd_copy_all(size_of_A(inner), terms.A, out->A);
    const double *A = inner->provides & ZD_A ? terms.A : NULL;
    double *C = out->C + held->size_of_C;
    for (int b = 0, i = 0, row = inner->mh; b < blocks_of(inner); b++) {
        const int coordinates = coordinates_of(inner, b), n = velocities_of(inner, b);
        for (int k = 0; k < coordinates; k++, i++) {
            if (!held->hold[i]) continue;
            if (want & ZD_PHI) out->Phi[row] = p[i] - held->value[i];
            if (want & ZD_C) C = write_row(n, A, k, C);
            row++;
        }
        if (A) A += coordinates * n;
    }
    return ZD_DONE;
}

static int evaluate_velocities(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const zd_held *held = data;
    const zd_system *inner = held->inner;
    const int m = zd_constraints(inner);
    int status = inner->evaluate(inner->data, want & (inner->provides | ZD_MOVED), t, p, v, out);
    if (status) return status;
    if ((want & ZD_PHI_T) && !(inner->provides & ZD_PHI_T)) zd_clear(m, out->Phi_t);
    double *C = out->C + held->size_of_C;
    for (int b = 0, i = 0, row = m; held->hold && b < blocks_of(inner); b++) {
        const int n = velocities_of(inner, b);
        for (int k = 0; k < n; k++, i++) {
            if (!held->hold[i]) continue;
            if (want & ZD_PHI_T) out->Phi_t[row] = -held->value[i];
            if (want & ZD_C) C = write_row(n, NULL, k, C);
            row++;
        }
    }
    return ZD_DONE;
}

/* ---- systems ---- */

/* Updates the dependent coordinates of the inner system; their rates, known to its products only, are not needed. */
static void follow(const void *data, double *p)
{
    const zd_system *inner = ((const zd_held *)data)->inner;
    inner->follow(inner->data, p);
}

/* Magnitudes of the inner system's constraints that are included, and 1 for those of held quantities. */
static int magnitudes(const void *data, double t, const double *p, const double *v, double *magnitude, double *scratch)
{
    const zd_held *held = data;
    const zd_system *inner = held->inner;
    const int kept = held->of_positions ? inner->mh : zd_constraints(inner);
    const int rows = kept + count(held->hold, held->of_positions ? inner->nq - inner->followers : inner->nv);
    double *of_inner = scratch + inner->magnitudes_scratch;
    const int status = inner->magnitudes(inner->data, t, p, v, of_inner, scratch);
    zd_copy_all(2 * kept, of_inner, magnitude);
    for (int i = 2 * kept; i < 2 * rows; i++) magnitude[i] = 1;
    return status;
}

static void *create(zd_arena *arena, const void *of)
{
    const holding *it = of;
    const zd_system *inner = it->inner;
    const int rows = it->of_positions ? inner->mh : zd_constraints(inner);
    system_that_holds nowhere, *here = zd_arena_bytes(arena, sizeof *here), *self = here ? here : &nowhere;
    self->held = (zd_held){.inner = inner, .hold = it->hold, .value = it->value, .of_positions = it->of_positions,
                           .size_of_C = rows * inner->nv};
    self->system = *inner;
    self->system.data = self->system.names = &self->held;
    self->system.name_constraint = name_of_constraint;
    self->system.operations = NULL;         /* they do not know the added constraints */
    self->system.follow = inner->follow ? follow : NULL;
    self->system.magnitudes = inner->magnitudes ? magnitudes : NULL;
    self->system.magnitudes_scratch += 2 * zd_constraints(inner);
    self->system.force_magnitudes = NULL;
    self->system.check_domain = NULL;
    self->system.closed_form = NULL;
    self->system.closed_forms = 0;
    self->system.residuals = NULL;
    if (!inner->structure) return here;
    self->held.structure = create_structure(arena, it, rows);
    self->held.size_of_C = size_of_groups(inner->structure, groups_of(inner->structure, rows));
    self->system.structure = &self->held.structure;
    return here;
}

const zd_system *zd_hold_positions(zd_store *store, const zd_system *inner, const int *hold, const double *p)
{
    zd_system *system = zd_store_create(store, create, &(holding){inner, hold, p, 1});
    if (!system) return NULL;
    system->mh += count(hold, inner->nq - inner->followers);
    system->mn = 0;
    system->provides = ZD_M | (inner->provides & ZD_A) | (system->mh ? ZD_PHI | ZD_C : 0);
    system->scratch += zd_size_of_C(inner) + size_of_A(inner);
    system->evaluate = evaluate_positions;
    return system;
}

const zd_system *zd_hold_velocities(zd_store *store, const zd_system *inner, const int *hold, const double *v)
{
    zd_system *system = zd_store_create(store, create, &(holding){inner, hold, v, 0});
    if (!system) return NULL;
    const int rows = count(hold, inner->nv);
    system->mn += rows;
    system->provides = ZD_M | (inner->provides & ZD_PHI_T) | (zd_constraints(system) ? ZD_C : 0) | (rows ? ZD_PHI_T : 0);
    system->evaluate = evaluate_velocities;
    return system;
}
