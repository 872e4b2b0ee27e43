/* Forces of several contacts that are closed and stick together, which are not determined: whether any of them hold. */
#pragma once

#include <math.h>

/* sqrt(x^2 + y^2) */
static inline double zd_length_of_two(double x, double y) { return sqrt(x * x + y * y); }

enum { ZD_MAX_SHARES = 24, ZD_MAX_NULLS = 24 };

typedef struct zd_share {
    int contacts;
    double force[3 * ZD_MAX_SHARES];        /* N and two components of friction of each; result: those with the largest margin */
    double friction[ZD_MAX_SHARES];         /* coefficient of static friction; 0: the contact has none */
    int nulls;                              /* number of ways in which the forces may differ */
    double null[ZD_MAX_NULLS * 3 * ZD_MAX_SHARES];          /* (nulls, 3 contacts) */
    double margin;          /* result, N: largest of all distributions, of the smallest of friction N - |f|, or of N; they hold from 0 on */
    double weight[ZD_MAX_SHARES];           /* result: share of each in what limits the margin */
} zd_share;

void zd_share_find(zd_share *self);
