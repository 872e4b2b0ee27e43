/* What the core's cheap looks say of one matrix after another, that has read them: for constraints/test_looks.py.
 *
 * Reads n, m, how many matrices C there are, a matrix M (n, n), and then the matrices (m, n), all as doubles, again and again. Prints for each matrix
 * of constraints/look.c whether it is doubtful and whether it may have been turned; of formulations/schur.c the same. That file is included for what
 * it holds against both numbers of an orthogonalization, and the start is the first matrix.
 */
#include <stdio.h>
#include <stdlib.h>

#include "constraints/look.h"
#include "formulations/schur.c"
#include "workspace.h"

enum { MOST = 64 };

static int read_doubles(double *to, size_t count) { return fread(to, sizeof *to, count, stdin) == count; }

static zd_look *take_look(zd_arena *arena, const zd_system *system) { return zd_look_take(arena, system, NULL, NULL); }

static void say(const char *which, int is_doubtful, int was_turned) { printf("%s %d %d\n", which, is_doubtful, was_turned); }

static int follow(const zd_system *system, int count, const double *M, double *C)
{
    const int n = system->nv, m = system->mh;
    zd_arena arena = {NULL, 0};
    take_look(&arena, system);
    take(&arena, system, NULL);
    arena = (zd_arena){zd_allocate(arena.used), 0};
    if (!arena.base) return 1;
    zd_look *look = take_look(&arena, system);
    schur *solver = take(&arena, system, NULL);
    double start_square[MOST];
    zd_rank rank = {.n = n, .m = m, .mh = m, .most_rows = m, .most_holonomic = m, .start_square = start_square};
    zd_point point = {.system = system, .rank = &rank, .terms = {.C = C}};
    if (zd_cholesky(n, M, solver->L) < n) return 1;
    for (int i = 0; i < count && read_doubles(C, (size_t)(m * n)); i++) {
        for (int k = 0; k < m && !i; k++) start_square[k] = zd_dot(n, C + k * n, C + k * n);
        rank.was_turned = 0;
        int is_doubtful = zd_look_is_doubtful(look, &point);
        say("look", is_doubtful, rank.was_turned);
        rank.was_turned = 0;
        zd_shares shares = orthogonalize_all(solver, &point, m, C);
        int tells = shares.rows == m && shares.least > ZD_ILL_CONDITIONED * ZD_ILL_CONDITIONED && zd_rows_are_long(&point);
        say("schur", !tells, rank.was_turned);
    }
    zd_release(arena.base);
    return 0;
}

int main(void)
{
    static double M[MOST * MOST], C[MOST * MOST];
    double sizes[3];
    int failed = 0;
    while (!failed && read_doubles(sizes, 3)) {
        const int n = (int)sizes[0], m = (int)sizes[1];
        const zd_system system = {.nq = n, .nv = n, .mh = m};
        failed = n > MOST || m > n || !read_doubles(M, (size_t)(n * n)) || follow(&system, (int)sizes[2], M, C);
    }
    return failed;
}
