#include "point.h"

#include <string.h>

/* Copies a matrix (rows, columns) into one with rows of length `stride`. Returns the end of the source. */
static const double *copy_block(int rows, int columns, const double *from, double *to, int stride)
{
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < columns; j++) to[i * stride + j] = from[i * columns + j];
    return from + rows * columns;
}

static const double *copy_diagonal(int n, const double *from, double *to, int stride)
{
    for (int i = 0; i < n; i++) to[i * (stride + 1)] = from[i];
    return from + n;
}

static void expand_blocks(const zd_system *system, int term, const double *packed, double *dense)
{
    const zd_structure *structure = system->structure;
    const int stride = system->nv;
    for (int b = 0, p = 0, v = 0; b < structure->blocks; b++) {
        int rows = structure->coordinates[b], n = structure->velocities[b];
        int is_diagonal = term == ZD_M && structure->mass && (structure->mass[b] & ZD_DIAGONAL);
        double *to = dense + (term == ZD_A ? p : v) * stride + v;
        packed = is_diagonal ? copy_diagonal(n, packed, to, stride) : copy_block(term == ZD_A ? rows : n, n, packed, to, stride);
        p += rows, v += n;
    }
}

/* First velocity of a block. */
static int velocity_at(const zd_structure *structure, int block)
{
    int at = 0;
    for (int b = 0; b < block; b++) at += structure->velocities[b];
    return at;
}

static void expand_rows(const zd_system *system, const double *packed, double *dense)
{
    const zd_structure *structure = system->structure;
    const int stride = system->nv;
    for (int g = 0; g < structure->groups; g++)
        for (int k = 0; k < structure->rows[g]; k++, dense += stride)
            for (int i = structure->first[g]; i < structure->first[g + 1]; i++) {
                int b = structure->block[i];
                packed = copy_block(1, structure->velocities[b], packed, dense + velocity_at(structure, b), stride);
            }
}

void zd_expand(const zd_system *system, int term, const double *packed, double *dense)
{
    const int rows = term == ZD_A ? system->nq : term == ZD_M ? system->nv : zd_constraints(system);
    memset(dense, 0, (size_t)(rows * system->nv) * sizeof *dense);
    if (term == ZD_C) expand_rows(system, packed, dense);
    else expand_blocks(system, term, packed, dense);
}
