/* Memory: the only file that allocates. */
#include "workspace.h"

#include <stdlib.h>
#include <string.h>
#ifdef _WIN32
#include <malloc.h>
#endif

enum { CACHE_LINE = 64 };

/* Blocks aligned to a cache line; Windows has separate functions to allocate and to free these. */
#ifdef _WIN32
#define TAKE_ALIGNED(size) _aligned_malloc(size, CACHE_LINE)
#define GIVE_BACK _aligned_free
#else
#define TAKE_ALIGNED(size) aligned_alloc(CACHE_LINE, size)
#define GIVE_BACK free
#endif

static size_t round_up(size_t bytes)
{
    return (bytes + CACHE_LINE - 1) / CACHE_LINE * CACHE_LINE;
}

void *zd_take(zd_arena *arena, size_t bytes)
{
    void *here = arena->base ? arena->base + arena->used : NULL;
    arena->used += round_up(bytes);
    return here;
}

double *zd_take_doubles(zd_arena *arena, size_t count)
{
    return zd_take(arena, count * sizeof(double));
}

void *zd_take_filled(zd_arena *arena, const void *filled, size_t bytes)
{
    void *here = zd_take(arena, bytes);
    if (here) memcpy(here, filled, bytes);
    return here;
}

zd_span zd_span_since(const zd_arena *arena, size_t used)
{
    return (zd_span){arena->base ? arena->base + used : NULL, arena->used - used};
}

void *zd_allocate(size_t bytes)
{
    size_t size = round_up(bytes ? bytes : 1);
    void *memory = TAKE_ALIGNED(size);
    return memory ? memset(memory, 0, size) : NULL;
}

void zd_release(void *memory)
{
    GIVE_BACK(memory);
}

void *zd_store_take(zd_store *store, void *(*take)(zd_arena *arena, const void *of), const void *of)
{
    zd_arena counting = {NULL, 0};
    take(&counting, of);
    unsigned char *block = zd_allocate(CACHE_LINE + counting.used);
    if (!block) return NULL;
    memcpy(block, &store->last, sizeof store->last);
    store->last = block;
    zd_arena arena = {block + CACHE_LINE, 0};
    return take(&arena, of);
}

void zd_store_release(zd_store *store)
{
    while (store->last) {
        void *block = store->last;
        memcpy(&store->last, block, sizeof store->last);
        zd_release(block);
    }
}
