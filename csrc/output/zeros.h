/* Intervals in which a function of time passes through zero, from its signs at the ends of a step and at 16 Chebyshev points within it, no
 * two of which are further apart than a tenth of the step. A pair of zeros between two of them is found at the extremum between both.
 */
#pragma once

#include "../linalg/bracket.h"

enum { ZD_SAMPLES = 16, ZD_MAX_POINTS = ZD_SAMPLES + 2 + ZD_SAMPLES / 2 };

typedef struct zd_zeros {
    int count;              /* number of points */
    double t[ZD_MAX_POINTS];   /* s: times, increasing */
    double g[ZD_MAX_POINTS];   /* function values there */
    double expected, slope; /* s, 1/s: the zero, and |slope| there, by points between both ends that are left out; NAN: not known */
    double error;           /* largest known error of predicted values */
    int at;                 /* index of the point that is verified, or from which the function is minimized */
    int verifies;           /* true while superfluous signs are compared with the rounding of the function */
    int tries;              /* number of values requested in the minimization; 0: it has not begun */
    double sign;            /* sign of the function around an extremum towards zero */
    double a, m, b;         /* s: the extremum lies between a and b, the smallest value is that at m */
    double fa, fm, fb;      /* values times sign there */
    double before, after;   /* 1/s: slopes of the function before a and after b; infinite: unknown */
    double next;            /* s: time of the requested value */
    double rounding;        /* rounding of the function at m; 0: not known */
    double range;           /* largest magnitude of the function at the points */
} zd_zeros;

/* True if the function passes through zero in this direction: 1 rising, -1 falling, 0 both. A zero at the beginning does not count. */
static inline int zd_passes_zero(double before, double now, int direction)
{
    return (before < 0 && now >= 0 && direction >= 0) || (before > 0 && now <= 0 && direction <= 0);
}

/* Fraction of the step at which sample k is taken, k = 1 ... ZD_SAMPLES; 0 and 1 at the ends. */
double zd_sample_share(int k);
/* Error of the predicted value at point k, by the corrected value. */
void zd_zeros_compare(zd_zeros *self, int k, double g);
/* True if the points show more sign changes than both ends, an extremum that may reach zero, or a value that may have the other sign. */
int zd_zeros_are_paired(const zd_zeros *self);
/* Removes the points between both ends; they show where a zero is expected, if they are known. */
void zd_zeros_keep_ends(zd_zeros *self, int are_known);
/* zd_zeros_begin() starts the search for pairs among the points. zd_zeros_next() returns true if it requires the function at time `next`,
 * which zd_zeros_narrow() receives with its rounding. */
void zd_zeros_begin(zd_zeros *self);
int zd_zeros_next(zd_zeros *self);
void zd_zeros_narrow(zd_zeros *self, double g, double rounding);
/* Bracket of the zero between two of the points. */
zd_bracket zd_zeros_bracket(const zd_zeros *self, int first, int last, double resolution);
/* The first and the last of the points around point k - 1, and around k, of the same signs. */
void zd_zeros_widen(const zd_zeros *self, int k, int *first, int *last);
