/* Sections of a block: their position, and the structures that their entries become. */
#pragma once

#include "../mechanisms/common/check.h"
#include "block.h"

/* Structures of mechanisms that entries of a block become. */

/* A member of a structure, or several of one type in sequence. */
enum zd_block_member { ZD_MEMBER_END, ZD_MEMBER_DOUBLES, ZD_MEMBER_INT, ZD_MEMBER_TEXT };

typedef struct zd_block_field {
    enum zd_block_member member;
    size_t offset;
    int count;
} zd_block_field;

typedef struct zd_block_structure {
    size_t size;
    const zd_block_field *field;    /* ended by ZD_MEMBER_END */
} zd_block_structure;

/* Structure of the terms, relations, forces or measures. */
const zd_block_structure *zd_block_structure_of(int section);

/* Members of a structure. */
#define ZD_DOUBLES_FIELD(type, member, count) {ZD_MEMBER_DOUBLES, offsetof(type, member), count}
#define ZD_INT_FIELD(type, member) {ZD_MEMBER_INT, offsetof(type, member), 1}
#define ZD_TEXT_FIELD(type, member) {ZD_MEMBER_TEXT, offsetof(type, member), 1}
#define ZD_END_FIELD {ZD_MEMBER_END, 0, 0}
#define ZD_STRUCTURE(type, ...) {sizeof(type), (const zd_block_field[]){__VA_ARGS__, ZD_END_FIELD}}

enum { ZD_BLOCK_HEADER = 4 + ZD_BLOCK_SECTIONS };

typedef struct zd_block_part {
    int count, width;           /* entries, and words of an entry */
    const double *word;         /* (count, width) */
} zd_block_part;

typedef struct zd_block_dimension zd_block_dimension;

typedef struct zd_block_layout {
    const zd_block_dimension *of;
    zd_block_part part[ZD_BLOCK_SECTIONS];
} zd_block_layout;

/* Mechanisms of a dimension: an entry of ZD_DIMENSION_LIST. */
struct zd_block_dimension {
    int dimension;
    const zd_block_structure *structure;    /* structures of bodies, joints and marker quantities, by section */
    /* The mechanism and its system, from the unpacked entries of each section. Returns 0 with the reason on failure. */
    int (*make)(zd_block *self, void *const *section, const zd_elements *elements, zd_complaint to);
    void (*release)(void *mechanism);
    int pose;                   /* numbers of a pose, see zd_block_poses() */
    void (*poses)(const void *mechanism, const double *p, double *poses, double *scratch);
    void (*name_of_constraint)(const zd_block_layout *layout, int joint, int component, const char *name, char *to, size_t size);
    /* p (nq,) at poses, in the coordinates in which gaps are found: in space absolute ones */
    void (*state)(const zd_block *block, const double *poses, double *p);
    /* Coordinates of a body whose inboard joint this is; -1: it is of no kind for trees. NULL: gaps are found without a tree. */
    int (*freedoms)(const zd_block_layout *layout, int joint, int is_particle);
    int (*is_angle_row)(const zd_block_layout *layout, int joint, int component);   /* 1 for residuals in rad; NULL without a tree */
};

/* Structure of the entries of a section; NULL: they are read as words. */
const zd_block_structure *zd_block_structure_in(const zd_block_layout *layout, int section);
/* Splits (words,) into sections, and checks counts, numbers and texts; returns 0 with the reason otherwise. `known` are the dimensions that
 * a block may have; the last one is NULL. */
int zd_block_split(const double *word, size_t words, const zd_block_dimension *const *known, zd_block_layout *to, zd_complaint complaint);
/* to (count,) <- entries of a section. Returns 0 if a whole number is not one. */
int zd_block_unpack(const zd_block_layout *layout, int section, void *to, zd_complaint complaint);
/* True if the word is a whole number from `low` on and below `end`. */
int zd_block_is_integer(double word, double low, double end);
/* Text at an offset; NULL if there is none. */
const char *zd_block_text(const zd_block_layout *layout, double offset);

/* True if a word has this value of an enumeration. */
static inline int zd_block_is(double word, int value) { return word == value; }

/* Number of entries of a section. */
static inline int zd_block_count(const zd_block_layout *layout, int section) { return layout->part[section].count; }

static inline const double *zd_block_entry(const zd_block_layout *layout, int section, int entry)
{
    const zd_block_part *part = layout->part + section;
    return part->word + (size_t)entry * (size_t)part->width;
}
