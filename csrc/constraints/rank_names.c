/* Indices of the redundant constraints, and the dependent ones in words. */
#include <stdio.h>

#include "../point/point.h"
#include "rank.h"

enum { MAX_NAMED = 8 };       /* constraints named in a message */

int zd_rank_redundant(const zd_rank *self, int *rows)
{
    int count = 0;
    for (int k = 0; k < self->m; k++)
        if ((self->selection && self->selection->redundant[k]) || (self->left_out && self->left_out[k])) rows[count++] = k;
    return count;
}

/* Index of the next dependent constraint: not selected, or left out at the start. */
static int next_of_others(const zd_rank *self, int k)
{
    if (self->selection) return k < self->m ? self->selection->row[k] : -1;
    while (k < self->m && !self->left_out[k]) k++;
    return k < self->m ? k : -1;
}

static int count_others(const zd_rank *self)
{
    int count = 0;
    for (int k = 0; self->left_out && k < self->m; k++) count += self->left_out[k];
    return self->selection ? self->m - self->selection->independent : count;
}

void zd_rank_name_rows(const zd_point *point, char *to, size_t size)
{
    const zd_rank *self = point->rank;
    const int count = count_others(self), named = count > MAX_NAMED ? MAX_NAMED : count;
    int length = snprintf(to, size, count > 1 ? "rows" : "row");
    for (int i = 0, k = self->selection ? self->selection->independent : 0; i < named && (size_t)length < size; i++, k++) {
        const int row = next_of_others(self, k);
        const char *before = i == 0 ? " " : i == count - 1 ? " and " : ", ";
        char name[ZD_CONSTRAINT_NAME];
        length += snprintf(to + length, size - (size_t)length, "%s%s", before, zd_name_constraint(point->system, row, name));
        if (!self->selection) k = row;
    }
    if (count > named && (size_t)length < size) length += snprintf(to + length, size - (size_t)length, " and %d others", count - named);
    if ((size_t)length < size) snprintf(to + length, size - (size_t)length, count > 1 ? " follow" : " follows");
}
