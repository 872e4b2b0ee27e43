/* Consistency of the tables of a mechanism: every index must refer to an existing entry. */
#pragma once

#include "elements.h"

typedef struct zd_complaint {
    char *message;
    int size;
} zd_complaint;

/* Writes the message of a violated rule; returns 0. */
int zd_complain(zd_complaint to, const char *format, ...);

/* Writes after what was written; `to` <- the rest of the message. */
void zd_append(zd_complaint *to, const char *format, ...);

static inline int zd_is_in(int index, int count) { return index >= 0 && index < count; }

/* Checks of bodies, joints and marker quantities, common to plane and space. They return 1, or write the violated rule and
 * return 0. Bodies are numbered from 1; the ground is 0. */
int zd_mass_is_right(int body, double mass, zd_complaint to);
int zd_inertia_is_right(int body, double inertia, int is_particle, zd_complaint to);
/* The two bodies of an entry, a "joint" or "marker quantity", must exist. */
int zd_bodies_are_right(const char *entry, int index, int first, int second, int bodies, zd_complaint to);
/* Inboard joint of a body: it must exist, and connect the body. */
int zd_inboard_exists(int body, int inboard, int joints, zd_complaint to);
int zd_inboard_connects(int body, int inboard, int first, int second, zd_complaint to);

/* An array of a mechanism's tables, and the check of each of its entries. */
typedef struct zd_checked {
    int count;
    int (*is_right)(const void *tables, int index, zd_complaint to);
} zd_checked;

/* Checks all arrays of the tables `of` in their order, then the elements. */
int zd_mechanism_is_right(const void *of, int bodies, int arrays, const zd_checked *checked, const zd_elements *elements, int joints,
                          int quantities, zd_complaint to);
