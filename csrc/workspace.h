/* Arena: one block with all memory of a run. The same code is executed twice: first to count bytes, then to assign addresses. Memory of a run
 * is in blocks that record where they have numbers only, so that its state can be saved: see run/saved_state.c.
 */
#pragma once

#include <stddef.h>

typedef struct zd_arena {
    unsigned char *base;    /* NULL while counting: all addresses are NULL then */
    size_t used;
    unsigned char *has_structures;  /* for each cache line 1 if it has structures, not numbers alone; NULL: not recorded */
} zd_arena;

/* Header of a block of memory. */
typedef struct zd_memory {
    struct zd_memory *previous;     /* in a store */
    size_t bytes;
    unsigned char *base, *has_structures;
    unsigned char *image;   /* (bytes,): copy from zd_memory_save(); NULL: none */
} zd_memory;

/* A zeroed block; NULL if there is no memory. */
zd_memory *zd_memory_create(size_t bytes);
void zd_memory_free(zd_memory *memory);
int zd_memory_save(zd_memory *memory);      /* copies the block to its image; nonzero: out of memory */
static inline zd_arena zd_arena_in(zd_memory *memory) { return (zd_arena){memory->base, 0, memory->has_structures}; }

/* Begins an arena with the memory that it has counted, to be released by its base; 0 without memory. */
int zd_arena_allocate(zd_arena *arena);
void *zd_arena_bytes(zd_arena *arena, size_t bytes);
double *zd_arena_doubles(zd_arena *arena, size_t count);
int *zd_arena_ints(zd_arena *arena, size_t count);
/* Allocates a structure in the arena and copies `filled` into it; NULL while counting. */
void *zd_arena_copy(zd_arena *arena, const void *filled, size_t bytes);

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
    zd_memory *last;
} zd_store;

/* Adds a block laid out by `create`, which is called twice as for an arena; NULL without memory. */
void *zd_store_create(zd_store *store, void *(*create)(zd_arena *arena, const void *of), const void *of);
zd_memory *zd_store_add(zd_store *store, size_t bytes);     /* adds a zeroed block; NULL without memory */
void *zd_store_bytes(zd_store *store, size_t bytes);        /* the same for numbers: their address */
void zd_store_release(zd_store *store);
