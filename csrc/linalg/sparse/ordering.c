/* Multiple minimum degree ordering: the next block rows are an independent set of those with the fewest neighbours; their neighbours, with
 * new degrees, are considered after all of these (George and Liu, The evolution of the minimum degree ordering algorithm, SIAM Review 31
 * (1989)). The reduced matrix is stored as cliques: elimination of a block row merges all cliques that contain it into one, whose members
 * are its column of the factor. So the memory does not exceed that of the factor's pattern.
 *
 * Ties are resolved in favour of the row that has had its degree longest. So rows that are not coupled are eliminated in succession, a
 * chain of loops from both ends at once: consecutive products are then independent, and the processor overlaps them.
 */
#include "blocks.h"

#include <string.h>

#include "../../workspace.h"

enum {
    LARGEST_DEGREE = 4095,      /* larger degrees share one queue */
    TO_BE_FOUND,                /* queue of the neighbours of eliminated block rows, whose degrees are not updated yet */
    QUEUES
};

/* Queues of block rows, one per degree. */
typedef struct queues {
    int lowest;             /* no queue below this has entries */
    int *first, *last;      /* (QUEUES,): -1: empty */
    int *before, *after;    /* (count,) */
} queues;

typedef struct search {
    const zd_pattern *pattern;
    const int *given;       /* a given order; NULL: minimum degree */
    int *degree;            /* (count,): -1: eliminated */
    int *in_at, *in;        /* (count + 1,), (members,): cliques that contain each block row: given ones, then those from eliminations */
    int *in_count;          /* (count,) */
    int *marked;            /* (count,): mark of the last visit */
    int mark;               /* mark of the present search */
    int *gone;              /* (cliques + count,): true if a clique was merged into another */
    queues waiting;
    int *members;           /* members of the cliques from eliminations, one clique after another */
    int used, capacity;
    int *begin;             /* (count + 1,): offsets of these cliques */
} search;

static int least(int a, int b) { return a < b ? a : b; }

/* ---- queues ---- */

static void append(queues *self, int degree, int k)
{
    self->before[k] = self->last[degree];
    self->after[k] = -1;
    if (self->last[degree] < 0) self->first[degree] = k;
    else self->after[self->last[degree]] = k;
    self->last[degree] = k;
    self->lowest = least(self->lowest, degree);
}

static void remove(queues *self, int degree, int k)
{
    if (self->before[k] < 0) self->first[degree] = self->after[k];
    else self->after[self->before[k]] = self->after[k];
    if (self->after[k] < 0) self->last[degree] = self->before[k];
    else self->before[self->after[k]] = self->before[k];
}

/* ---- the search ---- */

static search lay_out(zd_arena *arena, const zd_pattern *pattern, const int *given)
{
    const int count = pattern->count;
    return (search){
        .pattern = pattern,
        .given = given,
        .degree = zd_arena_ints(arena, count),
        .in_at = zd_arena_ints(arena, count + 1),
        .in = zd_arena_ints(arena, pattern->begin[pattern->cliques]),
        .in_count = zd_arena_ints(arena, count),
        .marked = zd_arena_ints(arena, count),
        .gone = zd_arena_ints(arena, pattern->cliques + count),
        .waiting = {
            .first = zd_arena_ints(arena, QUEUES),
            .last = zd_arena_ints(arena, QUEUES),
            .before = zd_arena_ints(arena, count),
            .after = zd_arena_ints(arena, count),
        },
        .begin = zd_arena_ints(arena, count + 1),
    };
}

/* The members of a clique: a given one, or the column of the block row with the number that is left when those are counted off. */
static const int *members_of(const search *self, const int *column, int clique, int *count)
{
    const zd_pattern *pattern = self->pattern;
    const int given = clique < pattern->cliques, step = given ? 0 : column[clique - pattern->cliques];
    const int *begin = given ? pattern->begin + clique : self->begin + step;
    *count = begin[1] - begin[0];
    return (given ? pattern->member : self->members) + begin[0];
}

/* The rows that block row k is still coupled with. */
static int degree_of(search *self, const int *column, int k)
{
    int degree = 0, count;
    self->marked[k] = ++self->mark;
    for (int i = self->in_at[k]; i < self->in_at[k] + self->in_count[k]; i++) {
        const int *member = members_of(self, column, self->in[i], &count);
        for (int j = 0; j < count; j++) {
            const int other = member[j];
            if (self->degree[other] < 0 || self->marked[other] == self->mark) continue;
            self->marked[other] = self->mark;
            degree += self->pattern->size[other];
        }
    }
    return least(degree, LARGEST_DEGREE);
}

static void begin_search(search *self, const int *column)
{
    const zd_pattern *pattern = self->pattern;
    for (int i = 0; i < pattern->begin[pattern->cliques]; i++) self->in_at[pattern->member[i] + 1]++;
    for (int k = 0; k < pattern->count; k++) self->in_at[k + 1] += self->in_at[k];
    for (int c = 0; c < pattern->cliques; c++)
        for (int i = pattern->begin[c]; i < pattern->begin[c + 1]; i++) {
            const int k = pattern->member[i];
            self->in[self->in_at[k] + self->in_count[k]++] = c;
        }
    for (int d = 0; d < QUEUES; d++) self->waiting.first[d] = self->waiting.last[d] = -1;
    for (int k = 0; !self->given && k < pattern->count; k++) append(&self->waiting, self->degree[k] = degree_of(self, column, k), k);
}

/* Room for as many more members as block rows are left, at the most. */
static int grow(search *self, int more)
{
    if (self->used + more <= self->capacity) return 1;
    const int capacity = 2 * (self->used + more);
    int *members = zd_allocate(capacity * sizeof(int));
    if (!members) return 0;
    if (self->used) memcpy(members, self->members, self->used * sizeof(int));
    zd_release(self->members);
    self->members = members;
    self->capacity = capacity;
    return 1;
}

/* The cliques that k is in are joined to one, without k. Returns 0 where there is no memory. */
static int join_cliques(search *self, const int *column, int k, int step)
{
    int room = 0, count;
    for (int i = self->in_at[k]; i < self->in_at[k] + self->in_count[k]; i++)
        (void)members_of(self, column, self->in[i], &count), room += count;
    if (!grow(self, room)) return 0;
    self->marked[k] = ++self->mark;
    for (int i = self->in_at[k]; i < self->in_at[k] + self->in_count[k]; i++) {
        const int *member = members_of(self, column, self->in[i], &count);
        for (int j = 0; j < count; j++) {
            if (self->degree[member[j]] < 0 || self->marked[member[j]] == self->mark) continue;
            self->marked[member[j]] = self->mark;
            self->members[self->used++] = member[j];
        }
        self->gone[self->in[i]] = 1;
    }
    self->begin[step + 1] = self->used;
    return 1;
}

/* Each member of the new clique is in that, and not any more in those that were joined. */
static void enter_clique(search *self, int k, int step)
{
    for (int j = self->begin[step]; j < self->begin[step + 1]; j++) {
        const int i = self->members[j];
        int *in = self->in + self->in_at[i], kept = 0;
        for (int c = 0; c < self->in_count[i]; c++)
            if (!self->gone[in[c]]) in[kept++] = in[c];
        in[kept++] = self->pattern->cliques + k;
        self->in_count[i] = kept;
    }
    for (int j = self->begin[step]; !self->given && j < self->begin[step + 1]; j++) {
        const int i = self->members[j];
        if (self->degree[i] == TO_BE_FOUND) continue;
        remove(&self->waiting, self->degree[i], i);
        append(&self->waiting, self->degree[i] = TO_BE_FOUND, i);
    }
}

/* One of the lowest degree; once there is no more of these, degrees are found anew. */
static int next_of(search *self, const int *column)
{
    queues *waiting = &self->waiting;
    const int are_through = waiting->first[waiting->lowest] < 0;
    while (are_through && waiting->first[TO_BE_FOUND] >= 0) {
        const int i = waiting->first[TO_BE_FOUND];
        remove(waiting, TO_BE_FOUND, i);
        append(waiting, self->degree[i] = degree_of(self, column, i), i);
    }
    while (waiting->first[waiting->lowest] < 0) waiting->lowest++;
    const int k = waiting->first[waiting->lowest];
    remove(waiting, waiting->lowest, k);
    return k;
}

static int eliminate_all(search *self, int *place)
{
    begin_search(self, place);
    for (int step = 0; step < self->pattern->count; step++) {
        const int k = self->given ? self->given[step] : next_of(self, place);
        self->degree[k] = -1;
        place[k] = step;
        if (!join_cliques(self, place, k, step)) return 0;
        enter_clique(self, k, step);
    }
    return 1;
}

/* ---- the result ---- */

/* Places of the members, in increasing order in each column: columns are met in order by those that they have below the diagonal. */
static void sort_columns(const search *self, zd_ordering *to, int *next)
{
    const int count = to->count, *begin = self->begin;
    int *at = next + count, *column = at + count + 1;
    for (int i = 0; i < begin[count]; i++) at[to->place[self->members[i]] + 1]++;
    for (int k = 0; k < count; k++) at[k + 1] += at[k], next[k] = at[k];
    for (int k = 0; k < count; k++)
        for (int i = begin[k]; i < begin[k + 1]; i++) column[next[to->place[self->members[i]]]++] = k;
    memcpy(to->begin, begin, (count + 1) * sizeof(int));
    memcpy(next, begin, count * sizeof(int));
    for (int r = 0; r < count; r++)
        for (int i = at[r]; i < at[r + 1]; i++) to->row[next[column[i]]++] = r;
}

static int keep_columns(const search *self, zd_ordering *to)
{
    const size_t count = to->count, entries = self->begin[to->count];
    int *next = zd_allocate((2 * count + 1 + entries) * sizeof(int));
    to->row = zd_allocate(entries * sizeof(int));
    if (next && to->row) sort_columns(self, to, next);
    zd_release(next);
    return next && to->row;
}

int zd_ordering_find(const zd_pattern *pattern, const int *given, zd_ordering *ordering)
{
    const size_t count = pattern->count;
    zd_arena counting = {0};
    lay_out(&counting, pattern, given);
    *ordering = (zd_ordering){
        .count = pattern->count,
        .place = zd_allocate(count * sizeof(int)),
        .size = zd_allocate(count * sizeof(int)),
        .begin = zd_allocate((count + 1) * sizeof(int)),
    };
    zd_arena arena = {.base = zd_allocate(counting.used)};
    int found = arena.base && ordering->place && ordering->size && ordering->begin;
    if (found) {
        search it = lay_out(&arena, pattern, given);
        found = eliminate_all(&it, ordering->place) && keep_columns(&it, ordering);
        zd_release(it.members);
        for (size_t i = 0; i < count; i++) ordering->size[ordering->place[i]] = pattern->size[i];
    }
    zd_release(arena.base);
    if (!found) zd_ordering_free(ordering);
    return found;
}

void zd_ordering_free(zd_ordering *ordering)
{
    zd_release(ordering->place);
    zd_release(ordering->size);
    zd_release(ordering->begin);
    zd_release(ordering->row);
    *ordering = (zd_ordering){.count = 0};
}
