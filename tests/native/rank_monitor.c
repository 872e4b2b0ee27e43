/* What the core's cheap looks say of one matrix after another, that has read them: for constraints/test_rank_monitor.py.
 *
 * Reads n, m, how many matrices C there are, a matrix M (n, n), and then the matrices (m, n), all as doubles, again and again. Prints for
 * each matrix of constraints/rank_monitor.c whether it is doubtful and whether it may have been turned; of formulations/schur.c the same.
 * That file is included for what it holds against both numbers of an orthogonalization, and the start is the first matrix. With an argument,
 * rows are of a chain of bodies with three velocities each, as many for each two neighbours, and what rank_monitor.c says of them packed
 * takes the place of what `schur` says. It fails where rows that both keep may change by different amounts, or there never are such rows.
 */
#include <stdio.h>
#include <stdlib.h>

#include "constraints/rank_monitor.h"
#include "formulations/schur.c"
#include "workspace.h"

enum { MOST = 64, BODY = 3, MAX_BODIES = MOST / BODY };

static int read_doubles(double *to, size_t count) { return fread(to, sizeof *to, count, stdin) == count; }

static void *create_monitor(zd_arena *arena, const void *system) { return zd_rank_monitor_create(arena, system, 0, NULL, NULL); }

static void say(const char *which, int is_doubtful, int was_turned) { printf("%s %d %d\n", which, is_doubtful, was_turned); }

static int follow(const zd_system *system, int count, const double *M, double *C)
{
    const int n = system->nv, m = system->mh;
    zd_arena arena = {NULL, 0};
    create_monitor(&arena, system);
    create(&arena, system, NULL);
    arena = (zd_arena){zd_allocate(arena.used), 0};
    if (!arena.base) return 1;
    zd_rank_monitor *monitor = create_monitor(&arena, system);
    schur *solver = create(&arena, system, NULL);
    double start_square[MOST];
    zd_rank rank = {.n = n, .m = m, .mh = m, .max_rank = m, .max_rank_holonomic = m, .start_square = start_square};
    zd_point point = {.system = system, .rank = &rank, .terms = {.C = C}};
    if (zd_cholesky(n, M, solver->L) < n) return 1;
    for (int i = 0; i < count && read_doubles(C, (size_t)(m * n)); i++) {
        for (int k = 0; k < m && !i; k++) start_square[k] = zd_dot(n, C + k * n, C + k * n);
        rank.was_turned = 0;
        int is_doubtful = zd_rank_monitor_is_doubtful(monitor, &point);
        say("look", is_doubtful, rank.was_turned);
        rank.was_turned = 0;
        zd_shares shares = orthogonalize_all(solver, &point, m, C);
        int tells = shares.rows == m && shares.least > ZD_ILL_CONDITIONED * ZD_ILL_CONDITIONED && zd_rows_are_long(&point);
        say("schur", !tells, rank.was_turned);
    }
    zd_release(arena.base);
    return 0;
}

/* ---- packed ---- */

typedef struct packed {
    zd_system system;
    const zd_layout *layout;
    zd_rank_monitor *monitor;
    double *C;
} packed;

static void *create_packed(zd_arena *arena, const void *of)
{
    packed self = *(const packed *)of;
    self.layout = zd_layout_create(arena, &self.system);
    self.monitor = zd_rank_monitor_create(arena, &self.system, 0, NULL, NULL);
    self.C = zd_arena_doubles(arena, (size_t)zd_size_of_C(&self.system));
    return zd_arena_copy(arena, &self, sizeof self);
}

static void pack(const packed *self, const double *C)
{
    for (int k = 0; k < self->system.mh; k++) {
        const zd_row_of_C row = zd_packed_row(self->layout, self->C, k);
        for (int j = 0; j < row.count; j++) self->C[row.x - self->C + j] = C[k * self->system.nv + zd_column(&row, j)];
    }
}

/* Whether both keep the same rows: what these may change by comes from orthogonal rows, and from blocks of (C C^T)^-1. */
static int keep_alike(const zd_rank_monitor *monitor, const packed *self)
{
    if (!monitor->is_known || !self->monitor->is_known) return 0;
    for (int k = 0; k < self->system.mh; k++) {
        const zd_row_of_C row = zd_packed_row(self->layout, self->C, k);
        for (int j = 0; j < row.count; j++)
            if (self->monitor->C[row.x - self->C + j] != monitor->C[k * self->system.nv + zd_column(&row, j)]) return 0;
    }
    return 1;
}

static int weights_differ(const zd_rank_monitor *monitor, const packed *self)
{
    for (int k = 0; k < self->system.mh; k++)
        if (!(fabs(self->monitor->weight[k] - monitor->weight[k]) <= 1e-9 * monitor->weight[k])) return 1;
    return 0;
}

static int compared;

static int follow_packed(const zd_system *system, int count, double *C)
{
    static int sizes[MAX_BODIES], rows[MAX_BODIES], first[MAX_BODIES], block[2 * MAX_BODIES];
    const int bodies = system->nv / BODY, each = system->mh / (bodies - 1);
    for (int b = 0; b < bodies; b++) sizes[b] = BODY, rows[b] = each, first[b] = 2 * b, block[2 * b] = b, block[2 * b + 1] = b + 1;
    const zd_structure structure = {bodies, sizes, sizes, NULL, bodies - 1, rows, first, block};
    packed wanted = {.system = *system};
    wanted.system.structure = &structure;
    zd_store store = {NULL};
    const packed *self = zd_store_create(&store, create_packed, &wanted);
    if (!self) return 1;
    double start_square[MOST];
    zd_rank rank = {.n = system->nv, .m = system->mh, .mh = system->mh, .start_square = start_square, .store = &store};
    zd_point dense = {.system = system, .rank = &rank, .terms = {.C = C}}, point = dense;
    point.system = &self->system, point.layout = self->layout, point.terms.C = self->C;
    zd_store of_dense = {NULL};
    zd_rank_monitor *monitor = zd_store_create(&of_dense, create_monitor, system);
    if (!monitor) return 1;
    for (int i = 0; i < count && read_doubles(C, (size_t)(system->mh * system->nv)); i++) {
        for (int k = 0; k < system->mh && !i; k++) start_square[k] = zd_dot(system->nv, C + k * system->nv, C + k * system->nv);
        pack(self, C);
        rank.was_turned = 0;
        int is_doubtful = zd_rank_monitor_is_doubtful(monitor, &dense);
        say("look", is_doubtful, rank.was_turned);
        rank.was_turned = 0;
        is_doubtful = zd_rank_monitor_is_doubtful(self->monitor, &point);
        say("packed", is_doubtful, rank.was_turned);
        if (!keep_alike(monitor, self)) continue;
        compared++;
        if (weights_differ(monitor, self)) return 1;
    }
    zd_store_release(&store);
    zd_store_release(&of_dense);
    return 0;
}

int main(int arguments, char **argument)
{
    (void)argument;
    static double M[MOST * MOST], C[MOST * MOST];
    double sizes[3];
    int failed = 0;
    while (!failed && read_doubles(sizes, 3)) {
        const int n = (int)sizes[0], m = (int)sizes[1];
        const zd_system system = {.nq = n, .nv = n, .mh = m};
        failed = n > MOST || m > n || !read_doubles(M, (size_t)(n * n));
        failed = failed || (arguments > 1 ? follow_packed(&system, (int)sizes[2], C) : follow(&system, (int)sizes[2], M, C));
    }
    return failed || (arguments > 1 && !compared);
}
