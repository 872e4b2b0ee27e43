/* Memory: the only file that allocates. */
#include "workspace.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#ifdef _WIN32
#include <malloc.h>
#endif

enum { CACHE_LINE = 64, HALF_LINE = CACHE_LINE / 2 };

_Static_assert(sizeof(zd_memory) <= CACHE_LINE, "a header fits in the line before its block");

/* Blocks aligned to a cache line; Windows has separate functions to allocate and to free these. */
#ifdef _WIN32
#define TAKE_ALIGNED(size) _aligned_malloc(size, CACHE_LINE)
#define GIVE_BACK _aligned_free
#else
#define TAKE_ALIGNED(size) aligned_alloc(CACHE_LINE, size)
#define GIVE_BACK free
#endif

/* To a multiple of `unit`, a power of two */
static size_t round_up(size_t bytes, size_t unit)
{
    return (bytes + unit - 1) & ~(unit - 1);
}

/* Memory that begins and ends at multiples of `unit`. */
static void *allocate(zd_arena *arena, size_t bytes, size_t unit)
{
    const size_t from = round_up(arena->used, unit);
    arena->used = from + round_up(bytes, unit);
    return arena->base ? arena->base + from : NULL;
}

void *zd_arena_bytes(zd_arena *arena, size_t bytes)
{
    void *here = allocate(arena, bytes, CACHE_LINE);
    const size_t lines = round_up(bytes, CACHE_LINE) / CACHE_LINE;
    if (arena->has_structures) memset(arena->has_structures + arena->used / CACHE_LINE - lines, 1, lines);
    return here;
}

/* Memory of numbers only: two short arrays share a line. */
static void *take_numbers(zd_arena *arena, size_t bytes)
{
    return allocate(arena, bytes, bytes > HALF_LINE ? CACHE_LINE : HALF_LINE);
}

double *zd_arena_doubles(zd_arena *arena, size_t count) { return take_numbers(arena, count * sizeof(double)); }
int *zd_arena_ints(zd_arena *arena, size_t count) { return take_numbers(arena, count * sizeof(int)); }

void *zd_arena_copy(zd_arena *arena, const void *filled, size_t bytes)
{
    void *here = zd_arena_bytes(arena, bytes);
    if (here) memcpy(here, filled, bytes);
    return here;
}

zd_span zd_span_since(const zd_arena *arena, size_t used)
{
    return (zd_span){arena->base ? arena->base + used : NULL, arena->used - used};
}

void *zd_allocate(size_t bytes)
{
    size_t size = round_up(bytes ? bytes : 1, CACHE_LINE);
    void *memory = TAKE_ALIGNED(size);
    return memory ? memset(memory, 0, size) : NULL;
}

int zd_arena_allocate(zd_arena *arena)
{
    *arena = (zd_arena){.base = zd_allocate(arena->used)};
    return arena->base != NULL;
}

void zd_release(void *memory)
{
    GIVE_BACK(memory);
}

zd_memory *zd_memory_create(size_t bytes)
{
    bytes = round_up(bytes, CACHE_LINE);
    unsigned char *block = zd_allocate(CACHE_LINE + bytes + bytes / CACHE_LINE);
    if (!block) return NULL;
    zd_memory *memory = (void *)block;
    *memory = (zd_memory){.bytes = bytes, .base = block + CACHE_LINE, .has_structures = block + CACHE_LINE + bytes};
    return memory;
}

void zd_memory_free(zd_memory *memory)
{
    if (memory) zd_release(memory->image);
    zd_release(memory);
}

int zd_memory_save(zd_memory *memory)
{
    if (!memory->image) memory->image = zd_allocate(memory->bytes);
    if (memory->image) memcpy(memory->image, memory->base, memory->bytes);
    return !memory->image;
}

zd_memory *zd_store_add(zd_store *store, size_t bytes)
{
    zd_memory *memory = zd_memory_create(bytes);
    if (!memory) return NULL;
    memory->previous = store->last;
    store->last = memory;
    return memory;
}

void *zd_store_bytes(zd_store *store, size_t bytes)
{
    const zd_memory *memory = zd_store_add(store, bytes);
    return memory ? memory->base : NULL;
}

void *zd_store_create(zd_store *store, void *(*create)(zd_arena *arena, const void *of), const void *of)
{
    zd_arena counting = {0};
    create(&counting, of);
    zd_memory *memory = zd_store_add(store, counting.used);
    if (!memory) return NULL;
    zd_arena arena = zd_arena_in(memory);
    void *made = create(&arena, of);
    assert(arena.used == counting.used);
    return made;
}

void zd_store_release(zd_store *store)
{
    while (store->last) {
        zd_memory *memory = store->last;
        store->last = memory->previous;
        zd_memory_free(memory);
    }
}
