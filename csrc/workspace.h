/* All memory of a run comes from one arena. It is laid out twice by the same code: first to count, then to hand out. */
#ifndef ZD_WORKSPACE_H
#define ZD_WORKSPACE_H

#include <stddef.h>

typedef struct zd_arena {
    unsigned char *base;    /* NULL while counting: then everything handed out is NULL, too */
    size_t used;
} zd_arena;

void *zd_take(zd_arena *arena, size_t bytes);
double *zd_take_doubles(zd_arena *arena, size_t count);
/* A structure in the arena, filled with what was laid out beside it: `*here = *filled`. */
void *zd_take_filled(zd_arena *arena, const void *filled, size_t bytes);

/* All that has been laid out since that much was used */
typedef struct zd_span {
    void *at;
    size_t bytes;
} zd_span;

zd_span zd_span_since(const zd_arena *arena, size_t used);

void *zd_allocate(size_t bytes);    /* zeroed, aligned to a cache line; NULL if there is no memory */
void zd_release(void *memory);

/* What a run takes besides once something rare has happened, in blocks that are freed together. */
typedef struct zd_store {
    void *last;             /* block; each begins with where the one before it is */
} zd_store;

/* What `take` lays out for this, twice as ever; NULL if there is no memory. */
void *zd_store_take(zd_store *store, void *(*take)(zd_arena *arena, const void *of), const void *of);
void zd_store_release(zd_store *store);

#endif
