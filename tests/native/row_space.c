/* Minimum-norm solutions for tests/linalg/test_row_space.py. */
#include <string.h>

#include "linalg/dense.h"

/* x (n,) <- solution of A x = right, and turned (n,) <- the given vector along the rows and the null space, NULL: it is not wanted; returns
 * the rank, or -1 */
int solve(int rows, int n, const double *A, const double *right, double *x, double *turned)
{
    zd_arena arena = {0};
    zd_row_space_create(&arena, rows, n);
    arena = (zd_arena){.base = zd_allocate(arena.used)};
    if (!arena.base) return -1;
    zd_row_space space = zd_row_space_create(&arena, rows, n);
    memcpy(space.A, A, (size_t)(rows * n) * sizeof *A);
    (turned ? zd_row_space_factor : zd_row_space_prepare)(&space, rows, 1e-9, 0);
    zd_row_space_solve(&space, right, x);
    if (turned) zd_row_space_turn(&space, turned);
    const int rank = space.rank;
    zd_release(arena.base);
    return rank;
}
