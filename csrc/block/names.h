/* Names of the rows of C of a mechanism, from the names of its joints and relations. */
#ifndef ZD_BLOCK_NAMES_H
#define ZD_BLOCK_NAMES_H

#include "layout.h"

/* Parts of the name of a row. */
typedef struct zd_block_names {
    const zd_block_layout *layout;
    const zd_row_owner *owner;      /* (m,) */
} zd_block_names;

/* 1 without names, or if there is one of each body, joint and relation. */
int zd_block_names_check(const zd_block_layout *layout, zd_complaint to);
/* zd_system.name_constraint; `names` is a zd_block_names. */
void zd_block_name_row(const void *names, int row, char *to, int size);

#endif
