/* Sections of a block: their position, and the structures that their entries become. */
#ifndef ZD_BLOCK_LAYOUT_H
#define ZD_BLOCK_LAYOUT_H

#include "../mechanisms/common/check.h"
#include "structures.h"

enum { ZD_BLOCK_HEADER = 4 + ZD_BLOCK_SECTIONS };

typedef struct zd_block_part {
    int count, width;           /* entries, and words of an entry */
    const double *word;         /* (count, width) */
} zd_block_part;

typedef struct zd_block_layout {
    int dimension;
    zd_block_part part[ZD_BLOCK_SECTIONS];
} zd_block_layout;

/* Splits (words,) into sections, and checks counts, numbers and texts; returns 0 with the reason otherwise. */
int zd_block_split(const double *word, size_t words, zd_block_layout *to, zd_complaint complaint);
/* to (count,) <- entries of a section. Returns 0 if a whole number is not one. */
int zd_block_unpack(const zd_block_layout *layout, int section, void *to, zd_complaint complaint);
/* True if the word is a whole number from `low` on and below `end`. */
int zd_block_is_whole(double word, double low, double end);
/* Text at an offset; NULL if there is none. */
const char *zd_block_text(const zd_block_layout *layout, double offset);

static inline const double *zd_block_entry(const zd_block_layout *layout, int section, int entry)
{
    const zd_block_part *part = layout->part + section;
    return part->word + (size_t)entry * (size_t)part->width;
}

#endif
