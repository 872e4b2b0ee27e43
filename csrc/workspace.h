/* Arena: one block with all memory of a run. The same code is executed twice: first to count bytes, then to assign addresses. */
#ifndef ZD_WORKSPACE_H
#define ZD_WORKSPACE_H

#include <stddef.h>

typedef struct zd_arena {
    unsigned char *base;    /* NULL while counting: all addresses are NULL then */
    size_t used;
} zd_arena;

void *zd_take(zd_arena *arena, size_t bytes);
double *zd_take_doubles(zd_arena *arena, size_t count);
/* Allocates a structure in the arena and copies `filled` into it; NULL while counting. */
void *zd_take_filled(zd_arena *arena, const void *filled, size_t bytes);

/* Part of an arena, allocated since `used` bytes. */
typedef struct zd_span {
    void *at;
    size_t bytes;
} zd_span;

zd_span zd_span_since(const zd_arena *arena, size_t used);

void *zd_allocate(size_t bytes);    /* zeroed, aligned to a cache line; NULL if there is no memory */
void zd_release(void *memory);

/* Memory that a run allocates in rare cases, after its creation: a list of blocks that are freed together. */
typedef struct zd_store {
    void *last;             /* last block; each begins with a pointer to the previous one */
} zd_store;

/* Adds a block laid out by `take`, which is called twice as for an arena; NULL without memory. */
void *zd_store_take(zd_store *store, void *(*take)(zd_arena *arena, const void *of), const void *of);
void zd_store_release(zd_store *store);

#endif
