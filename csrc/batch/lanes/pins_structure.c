/* Structure of C M^-1 C^T for bodies joined by pins, found once for all runs, as it does not depend on the data. */
#include "pins_structure.h"

#include <math.h>
#include <string.h>

#include "../../linalg/refinement.h"

/* ---- ends of each body ---- */

static int body_of(const zd_pinned *of, int end) { return end & 1 ? of->second[end / 2] : of->first[end / 2]; }

/* `at` (bodies + 2,) and `end` (2 pins,): ends of each body; those of pin k are 2 place[k] and the next; place NULL: in the given order. */
static void list_ends(const zd_pinned *of, const int *place, int *at, int *end)
{
    memset(at, 0, (size_t)(of->bodies + 2) * sizeof *at);
    for (int e = 0; e < 2 * of->pins; e++)
        if (body_of(of, e) >= 0) at[body_of(of, e) + 2]++;
    for (int b = 0; b < of->bodies; b++) at[b + 2] += at[b + 1];
    for (int e = 0; e < 2 * of->pins; e++)      /* each body's begin moves to its end, which is where the next one begins */
        if (body_of(of, e) >= 0) end[at[body_of(of, e) + 1]++] = 2 * (place ? place[e / 2] : e / 2) + (e & 1);
}

int zd_pins_plan_find(zd_pins_plan *self, const zd_pinned *of)
{
    const size_t pins = (size_t)of->pins, bodies = (size_t)of->bodies;
    int *size = zd_allocate((3 * pins + bodies + 2) * sizeof *size);
    if (!size) return 0;
    int *end = size + pins, *at = end + 2 * pins;
    *self = (zd_pins_plan){.of = of};
    list_ends(of, NULL, at, end);
    for (int k = 0; k < of->pins; k++) size[k] = 2;
    for (int i = 0; i < at[of->bodies]; i++) end[i] /= 2;
    for (int b = 0; b < of->bodies; b++) self->pairs += (at[b + 1] - at[b]) * (at[b + 1] - at[b] - 1) / 2;
    const zd_pattern pattern = {of->pins, size, of->bodies, at, end};
    const int found = zd_ordering_find(&pattern, NULL, &self->ordering);
    zd_release(size);
    return found;
}

void zd_pins_plan_free(zd_pins_plan *self)
{
    zd_ordering_free(&self->ordering);
}

/* ---- positions in S ---- */

static void list_pins(const zd_lane_pins *self, int *row, zd_pin_end *end)
{
    const zd_pinned *of = self->of;
    for (int k = 0; k < of->pins; k++) {
        const int place = self->blocks->place[k], points = 2 * of->bodies + 6 * k;
        row[place] = 2 * k;
        end[2 * place] = (zd_pin_end){of->first[k], points};
        end[2 * place + 1] = (zd_pin_end){of->second[k], points + 2};
    }
}

/* Index of block (later, earlier) of S, both by position. */
static int find(const zd_blocks *blocks, int later, int earlier)
{
    int e = blocks->begin[earlier];
    while (blocks->row[e] != later) e++;
    return blocks->entry_at[e];
}

/* `has` (size of S,): 1 at the start of blocks that a pair contributes to */
static void list_pairs(const zd_lane_pins *self, int *pair_at, zd_pin_pair *pair, unsigned char *has)
{
    int next = 0;
    for (int b = 0; b < self->of->bodies; b++) {
        pair_at[b] = next;
        for (int i = self->end_at[b]; i < self->end_at[b + 1]; i++)
            for (int j = self->end_at[b]; j < i; j++) {
                const int one = self->of_body[i], other = self->of_body[j];
                const int later = one > other ? one : other, earlier = one > other ? other : one;
                const int at = find(self->blocks, later / 2, earlier / 2);
                pair[next++] = (zd_pin_pair){later, earlier, at, !has[at], (later ^ earlier) & 1 ? -1 : 1};
                has[at] = 1;
            }
    }
    pair_at[self->of->bodies] = next;
}

static int list_fill(const zd_blocks *blocks, const unsigned char *has, int *fill)
{
    int count = 0;
    for (int e = 0; e < blocks->begin[blocks->count]; e++)
        if (!has[blocks->entry_at[e]]) fill[count++] = blocks->entry_at[e];
    return count;
}

/* ---- memory ---- */

static int *arena_ints(zd_arena *arena, int count) { return zd_arena_bytes(arena, (size_t)count * sizeof(int)); }

static void create_numbers(zd_lane_pins *self, zd_arena *arena, int size_of_S, size_t lanes)
{
    const size_t pins = (size_t)self->count, nv = (size_t)self->of->at[self->of->bodies];
    self->p = zd_arena_doubles(arena, nv * lanes);
    self->is_small = zd_arena_doubles(arena, lanes);
    self->is_lost = zd_arena_doubles(arena, lanes);
    self->refines = zd_arena_doubles(arena, lanes);
    self->arm = zd_arena_doubles(arena, 4 * pins * lanes);
    self->S = zd_arena_doubles(arena, (size_t)size_of_S * lanes);
    self->diagonal = zd_arena_doubles(arena, 2 * pins * lanes);
    self->y = zd_arena_doubles(arena, 2 * pins * lanes);
    self->lambda = zd_arena_doubles(arena, 2 * pins * lanes);
    self->rest = zd_arena_doubles(arena, 2 * pins * lanes);
    self->step = zd_arena_doubles(arena, nv * lanes);
}

static int size_of(const zd_ordering *ordering)
{
    return 4 * (ordering->count + ordering->begin[ordering->count]);    /* all blocks have two rows */
}

zd_lane_pins *zd_lane_pins_create(zd_arena *arena, const zd_pins_plan *plan, int lanes)
{
    const zd_pinned *of = plan->of;
    const int count = of->pins, entries = plan->ordering.begin[count], size = size_of(&plan->ordering);
    int *row = arena_ints(arena, count), *end_at = arena_ints(arena, of->bodies + 2), *of_body = arena_ints(arena, 2 * count);
    int *pair_at = arena_ints(arena, of->bodies + 1), *fill = arena_ints(arena, entries);
    zd_pin_end *end = zd_arena_bytes(arena, (size_t)(2 * count) * sizeof *end);
    zd_pin_pair *pair = zd_arena_bytes(arena, (size_t)plan->pairs * sizeof *pair);
    unsigned char *has = zd_arena_bytes(arena, (size_t)size);
    zd_lane_pins self = {
        .of = of, .blocks = zd_blocks_create(arena, &plan->ordering), .count = count, .gravity = zd_lane_pins_numbers(of) - 2, .row = row,
        .end = end, .end_at = end_at, .of_body = of_body, .pair_at = pair_at, .pair = pair, .fill = fill,
    };
    create_numbers(&self, arena, size, (size_t)lanes);
    if (arena->base) {
        list_ends(of, self.blocks->place, end_at, of_body);
        list_pins(&self, row, end);
        list_pairs(&self, pair_at, pair, has);
        self.fills = list_fill(self.blocks, has, fill);
    }
    return zd_arena_copy(arena, &self, sizeof self);
}

/* ---- data ---- */

/* Extends [least, most] by the bounds of a body's contribution c W c^T to a constraint: 1 / mass, and that with its whole arm. */
static void widen(const double *numbers, int body, const double *point, double *least, double *most)
{
    if (body < 0) return;
    const double *inverse = numbers + 2 * body;
    *least = fmin(*least, inverse[0]);
    *most = fmax(*most, inverse[0] + inverse[1] * (point[0] * point[0] + point[1] * point[1]));
}

int zd_pins_are_unequal(const zd_pinned *of, const double *numbers)
{
    for (int k = 0; k < of->pins; k++) {
        const double *points = numbers + 2 * of->bodies + 6 * k;
        double least = INFINITY, most = 0;
        widen(numbers, of->first[k], points, &least, &most);
        widen(numbers, of->second[k], points + 2, &least, &most);
        if (most > ZD_UNEQUAL_SHARES * least) return 1;
    }
    return 0;
}
