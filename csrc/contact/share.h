/* Friction of several contacts that stick and bear one load together: how it is shared among them. */
#pragma once

enum { ZD_MAX_PAIRS = 12 };

typedef struct zd_share {
    int pairs;
    double f[2 * ZD_MAX_PAIRS];     /* forces of each in two directions; result: those of the least load factor */
    double bound[ZD_MAX_PAIRS];
    double weight[ZD_MAX_PAIRS];    /* result: share of each in what limits the load factor; 0: it is within its bound */
    int nulls;                      /* result: number of unknowns of f that are not determined */
    double factor;                  /* result: max |f_i| / bound_i, which no other distribution makes less; they stick up to 1 */
} zd_share;

/* K (2 pairs, 2 pairs): products of the rows of the pairs, whose null vectors are the distributions that differ; it is overwritten. */
void zd_share_find(zd_share *self, double *K);
