/* Offsets by zd_structure: A and M are stored block after block, C group after group. */
#include "point.h"

#include "../linalg/small.h"

enum { MAX_TOUCHERS = 12 };

static int size_of_mass(const zd_structure *structure, int b)
{
    int n = structure->velocities[b];
    return structure->mass && (structure->mass[b] & ZD_DIAGONAL) ? n : n * n;
}

/* Number of stored entries per row of a group. */
static int width_of(const zd_structure *structure, int g)
{
    int width = 0;
    for (int i = structure->first[g]; i < structure->first[g + 1]; i++) width += structure->velocities[structure->block[i]];
    return width;
}

int zd_packed_size(const zd_system *system, int term)
{
    const zd_structure *structure = system->structure;
    int size = 0;
    for (int b = 0; b < structure->blocks; b++)
        size += term == ZD_A ? structure->coordinates[b] * structure->velocities[b] : term == ZD_M ? size_of_mass(structure, b) : 0;
    for (int g = 0; term == ZD_C && g < structure->groups; g++) size += structure->rows[g] * width_of(structure, g);
    return size;
}

int zd_mass_is(const zd_system *system, enum zd_mass kind)
{
    const zd_structure *structure = system->structure;
    for (int b = 0; structure && b < structure->blocks; b++)
        if (!structure->mass || !(structure->mass[b] & kind)) return 0;
    return structure != NULL;
}

int zd_size_of_M(const zd_system *system)
{
    return system->structure ? zd_packed_size(system, ZD_M) : system->nv * system->nv;
}

int zd_size_of_C(const zd_system *system)
{
    return system->structure ? zd_packed_size(system, ZD_C) : (system->mh + system->mn) * system->nv;
}

double *zd_create_dense(zd_arena *arena, const zd_system *system, size_t count)
{
    return zd_arena_doubles(arena, system->structure ? count : 0);
}

/* to (n, n) <- the identity, or its diagonal alone */
static void fill_identity(int n, int is_diagonal, double *to)
{
    for (int i = 0; i < n; i++) to[is_diagonal ? i : i * (n + 1)] = 1;
}

void zd_set_identity(const zd_system *system, double *M)
{
    const zd_structure *structure = system->structure;
    zd_clear(zd_size_of_M(system), M);
    if (!structure) fill_identity(system->nv, 0, M);
    for (int b = 0; structure && b < structure->blocks; b++) {
        int size = size_of_mass(structure, b), n = structure->velocities[b];
        fill_identity(n, size == n, M);
        M += size;
    }
}

static void fill_blocks(zd_layout *self, const zd_structure *structure)
{
    for (int b = 0; b < self->blocks; b++) {
        int p = structure->coordinates[b], v = structure->velocities[b];
        self->coordinate_at[b + 1] = self->coordinate_at[b] + p;
        self->velocity_at[b + 1] = self->velocity_at[b] + v;
        self->A_at[b + 1] = self->A_at[b] + p * v;
        self->M_at[b + 1] = self->M_at[b] + size_of_mass(structure, b);
        self->is_diagonal[b] = structure->mass && (structure->mass[b] & ZD_DIAGONAL);
        for (int i = self->velocity_at[b]; i < self->velocity_at[b + 1]; i++) self->block_of[i] = b;
    }
}

static void fill_groups(zd_layout *self, const zd_structure *structure)
{
    for (int g = 0, column = 0; g < self->groups; g++) {
        self->row_at[g + 1] = self->row_at[g] + structure->rows[g];
        self->width[g] = width_of(structure, g);
        self->C_at[g + 1] = self->C_at[g] + structure->rows[g] * self->width[g];
        for (int k = self->row_at[g]; k < self->row_at[g + 1]; k++) self->group_of[k] = g;
        for (int i = structure->first[g]; i < structure->first[g + 1]; i++) {
            int b = self->touched[i] = structure->block[i];
            for (int j = self->velocity_at[b]; j < self->velocity_at[b + 1]; j++) self->column[column++] = j;
        }
        self->touched_at[g + 1] = structure->first[g + 1];
        self->column_at[g + 1] = column;
    }
}

/* Fills the lists of groups that touch each block. */
static void fill_touchers(zd_layout *self, const zd_structure *structure)
{
    int *at = self->toucher_at;
    for (int i = 0; i < self->touched_at[self->groups]; i++) at[self->touched[i] + 1]++;
    for (int b = 0; b < self->blocks; b++) at[b + 1] += at[b];
    for (int g = 0; g < self->groups; g++)
        for (int i = self->touched_at[g], offset = 0; i < self->touched_at[g + 1]; i++) {
            int b = self->touched[i], place = at[b]++;
            self->toucher[place] = g;
            self->toucher_offset[place] = offset;
            offset += structure->velocities[b];
        }
    for (int b = self->blocks; b > 0; b--) at[b] = at[b - 1];
    at[0] = 0;
}

const zd_layout *zd_layout_create(zd_arena *arena, const zd_system *system)
{
    const zd_structure *structure = system->structure;
    if (!structure) return NULL;
    int blocks = structure->blocks, groups = structure->groups, touched = groups ? structure->first[groups] : 0, columns = 0;
    for (int g = 0; g < groups; g++) columns += width_of(structure, g);
    zd_layout self = {
        .blocks = blocks,
        .groups = groups,
        .max_touchers = MAX_TOUCHERS,
        .coordinate_at = zd_arena_ints(arena, blocks + 1),
        .velocity_at = zd_arena_ints(arena, blocks + 1),
        .A_at = zd_arena_ints(arena, blocks + 1),
        .M_at = zd_arena_ints(arena, blocks + 1),
        .is_diagonal = zd_arena_ints(arena, blocks),
        .block_of = zd_arena_ints(arena, system->nv),
        .row_at = zd_arena_ints(arena, groups + 1),
        .C_at = zd_arena_ints(arena, groups + 1),
        .width = zd_arena_ints(arena, groups),
        .group_of = zd_arena_ints(arena, system->mh + system->mn),
        .touched_at = zd_arena_ints(arena, groups + 1),
        .touched = zd_arena_ints(arena, touched),
        .toucher_at = zd_arena_ints(arena, blocks + 1),
        .toucher = zd_arena_ints(arena, touched),
        .toucher_offset = zd_arena_ints(arena, touched),
        .column_at = zd_arena_ints(arena, groups + 1),
        .column = zd_arena_ints(arena, columns),
    };
    if (arena->base) {
        fill_blocks(&self, structure);
        fill_groups(&self, structure);
        fill_touchers(&self, structure);
    }
    return zd_arena_copy(arena, &self, sizeof self);
}
