/* Consistency of the tables of a mechanism: every index must refer to an existing entry. */
#ifndef ZD_COMMON_CHECK_H
#define ZD_COMMON_CHECK_H

#include "elements.h"

typedef struct zd_complaint {
    char *message;
    int size;
} zd_complaint;

/* Writes the message of a violated rule; returns 0. */
int zd_complain(zd_complaint to, const char *format, ...);

static inline int zd_is_in(int index, int count) { return index >= 0 && index < count; }

/* True if relations, efforts and measures refer to existing marker quantities and joints; otherwise writes which one does not. */
int zd_elements_are_right(const zd_elements *elements, int joints, int gauges, zd_complaint to);

#endif
