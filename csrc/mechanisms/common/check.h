/* Whether tables of a mechanism contradict themselves. */
#ifndef ZD_COMMON_CHECK_H
#define ZD_COMMON_CHECK_H

#include "elements.h"

typedef struct zd_complaint {
    char *message;
    int size;
} zd_complaint;

/* Writes what is wrong; returns 0, that it is not right. */
int zd_complain(zd_complaint to, const char *format, ...);

static inline int zd_is_in(int index, int count) { return index >= 0 && index < count; }

/* Whether relations, efforts and measures are of gauges and joints that there are; if not, says which is not. */
int zd_elements_are_right(const zd_elements *elements, int joints, int gauges, zd_complaint to);

#endif
