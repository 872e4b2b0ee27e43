/* Minimum-norm solutions of sparse rows for tests/linalg/test_minimum_norm.py. */
#include <stdlib.h>

#include "linalg/sparse/equations.h"

/* x (n,) <- solution; row k has the entries begin[k] to begin[k + 1] of x and column. Returns the status. */
int solve(int blocks, const int *at, const int *block_of, int rows, const int *begin, double *entries, const int *column,
          const double *right, const double *factor, const unsigned char *is_square, const double *weight, double *x)
{
    zd_sparse_row *row = calloc((size_t)rows + 1, sizeof *row);
    for (int k = 0; k < rows; k++) row[k] = (zd_sparse_row){entries + begin[k], begin[k + 1] - begin[k], column + begin[k]};
    const zd_sparse_equations equations = {.blocks = blocks, .at = at, .block_of = block_of, .rows = rows, .row = row, .right = right,
                                           .factor = factor, .is_square = is_square, .weight = weight};
    const int status = zd_minimum_norm(&equations, x);
    free(row);
    return status;
}
