/* Cost of a structure: multiplications to form S(W) = C W C^T of (13) and (27), to factor it, and to solve with the factors. They are
 * counted in the elimination order of a run, with fill, so that mechanisms can choose the cheapest coordinates. Blocks with a kernel of
 * their size are counted separately from the others, which take several times as long.
 */

#include "../linalg/small.h"
#include "../point/sparse/weighted.h"
#include "../zerodrift.h"
#include "rank.h"

/* Products A W B^T for each pair of groups that share a body. */
static void count_products(const zd_weighted *self, zd_structure_work *work)
{
    for (int i = 0; i < self->pairs; i++) {
        const zd_pair *pair = self->pair + i;
        const int kernel = pair->kernel % ZD_SQUARE, n = kernel ? kernel / 10 : self->piece[pair->a].n;
        const int rows = kernel ? kernel % 10 : self->piece[pair->a].rows, others = kernel ? rows : self->piece[pair->b].rows;
        work->products[kernel == 0] += rows * n * others;
    }
}

/* Multiplications to eliminate a block column with s rows in its pivot and b rows below. */
static double count_column(double s, double b) { return s * s * s / 6 + s * s * b + s * b * b / 2; }

static void count_factors(const zd_blocks *blocks, zd_structure_work *work)
{
    work->columns = blocks->count;
    work->blocks = blocks->begin[blocks->count];
    work->rows = blocks->rows;
    for (int k = 0; k < blocks->count; k++) {
        const int s = blocks->at[k + 1] - blocks->at[k], has_none = !blocks->kernel[k];
        int below = 0;
        for (int i = blocks->begin[k]; i < blocks->begin[k + 1]; i++) below += blocks->at[blocks->row[i] + 1] - blocks->at[blocks->row[i]];
        work->factors[has_none] += count_column(s, below);
        work->solves[has_none] += s * s + 2.0 * s * below;
    }
}

typedef struct place {      /* M, then its inverse, and C at one position, with work space (m,) */
    zd_terms terms;
    double *v, *least, *most;
} place;

static place create_place(zd_arena *arena, const zd_system *system)
{
    const size_t m = zd_constraints(system), nv = system->nv;
    place it = {.v = zd_arena_doubles(arena, nv), .least = zd_arena_doubles(arena, m), .most = zd_arena_doubles(arena, m)};
    it.terms.M = zd_arena_doubles(arena, zd_size_of_M(system));
    it.terms.C = zd_arena_doubles(arena, zd_size_of_C(system));
    it.terms.scratch = zd_arena_doubles(arena, system->scratch);
    it.terms.inputs = zd_create_inputs(arena, system);
    return it;
}

/* Smallest relative pivot of S at p: a measure of the digits lost. */
static int measure_pivots(zd_weighted *weighted, const zd_system *system, const double *p, place *at, zd_structure_work *work)
{
    double *W = at->terms.M;
    zd_clear(system->nv, at->v);
    const int status = system->evaluate(system->data, ZD_M | ZD_C | ZD_MOVED, 0, p, at->v, &at->terms);
    if (status) return status;
    for (int i = 0; i < system->nv; i++) W[i] = 1 / W[i];
    work->is_alike = zd_weighted_is_alike(weighted, at->terms.C, W, at->least, at->most);
    const zd_pivots pivots = zd_weighted_factor(weighted, at->terms.C, W, NULL);
    work->share = pivots.failed < 0 ? pivots.pivot / pivots.diagonal : 0;
    return ZD_DONE;
}

static int count_and_measure(zd_store *store, zd_arena *arena, const zd_system *system, const double *p, zd_structure_work *work)
{
    zd_weighted *weighted = zd_weighted_create(store, zd_layout_create(arena, system));
    place at = create_place(arena, system);
    if (!weighted) return ZD_NO_MEMORY;
    count_products(weighted, work);
    count_factors(weighted->blocks, work);
    work->has_products = zd_weighted_products(weighted, system) != NULL;
    work->is_of_many = zd_rank_is_of_many(system);
    return measure_pivots(weighted, system, p, &at, work);
}

int zd_structure_count(const zd_system *system, const double *p, zd_structure_work *work)
{
    *work = (zd_structure_work){0};
    if (!system->structure) return ZD_DONE;
    zd_arena counting = {0};
    zd_layout_create(&counting, system);
    create_place(&counting, system);
    zd_arena arena = {.base = zd_allocate(counting.used)};
    if (!arena.base) return ZD_NO_MEMORY;
    zd_store store = {NULL};
    const int status = count_and_measure(&store, &arena, system, p, work);
    zd_store_release(&store);
    zd_release(arena.base);
    return status;
}
