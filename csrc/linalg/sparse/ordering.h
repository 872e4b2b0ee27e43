/* An order in which a symmetric matrix of blocks is eliminated with little fill. */
#ifndef ZD_ORDERING_H
#define ZD_ORDERING_H

/* Which blocks of the matrix there are: those of any two block rows that are in one clique. */
typedef struct zd_pattern {
    int count;              /* block rows */
    const int *size;        /* (count,) rows of each, at least one */
    int cliques;
    const int *begin, *member;  /* (cliques + 1,), (begin[cliques],): the block rows of each, each at most once */
} zd_pattern;

/* The order, and what is below the diagonal once fill is added. */
typedef struct zd_ordering {
    int count;
    int *place;             /* (count,) position of each block row in the order */
    int *size;              /* (count,) rows of each, in the order */
    int *begin;             /* (count + 1,) in the order: where the block rows begin that are below the diagonal in each column */
    int *row;               /* (begin[count],) their places, increasing in each column */
} zd_ordering;

/* Takes memory of its own, which zd_ordering_free() releases. Returns 0 where there is none. `given` (count,): the block rows in the order in
 * which they are to be eliminated; NULL: in one of little fill. */
int zd_ordering_find(const zd_pattern *pattern, const int *given, zd_ordering *ordering);
void zd_ordering_free(zd_ordering *ordering);

#endif
