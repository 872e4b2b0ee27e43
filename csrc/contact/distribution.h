/* Forces of contacts that are closed and stick together, where constraints do not determine them: whether some distribution holds. */
#pragma once

enum { ZD_MAX_DISTRIBUTED = 24, ZD_MAX_FREE = 24 };     /* contacts, and components of their forces that may differ */

typedef struct zd_distribution {
    int contacts;
    double force[3 * ZD_MAX_DISTRIBUTED];       /* N and two components of friction of each; result: those with the largest margin */
    double friction[ZD_MAX_DISTRIBUTED];        /* coefficient of static friction; 0: the contact has none */
    int components;
    int component[ZD_MAX_FREE];                 /* (components,) indices in `force` of those that may differ */
    int nulls;                                  /* result: number of ways in which they do */
    double margin;          /* result, N: largest of all distributions, of the smallest of friction N - |f|, or of N; they hold from 0 on */
    double weight[ZD_MAX_DISTRIBUTED];          /* result: share of each in what limits the margin */
} zd_distribution;

/* Adds a contact with its force N, and of friction f (2,); NULL: it has none. `is_free`: N may differ, besides f. */
void zd_distribution_add(zd_distribution *self, double N, int is_free, const double *f, double coefficient);
/* K (components, components): products of the rows of these components; it is overwritten. */
void zd_distribution_find(zd_distribution *self, double *K);
