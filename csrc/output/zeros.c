#include "zeros.h"

#include <math.h>

enum { MAX_TRIES = 40 };
static const double DEPTH = 0.25;       /* least relative decrease from the smallest value for which an extremum is followed */
static const double MIN_ROUNDING = 0x1p-40;   /* least rounding of a function, relative to its range in the step */
static const double CERTAIN = 8;        /* least value of a certain sign, in units of the largest known error */
static const double SHIFT = 0.05;       /* least distance of a new point from m, relative to b - a */

/* sin^2((2 k - 1) pi / 64) */
static const double share[ZD_SAMPLES / 2] = {
    0.0024076366639016, 0.0215298321338956, 0.0590393678258225, 0.1134947733186315,
    0.1828033579181773, 0.2643016315870011, 0.3548576613727688, 0.4509914298352196,
};

double zd_sample_share(int k)
{
    if (k == 0 || k > ZD_SAMPLES) return k > 0;
    return k <= ZD_SAMPLES / 2 ? share[k - 1] : 1 - share[ZD_SAMPLES - k];
}

/* Zero between points k - 1 and k: of the cubic polynomial t(g) through the points around them, if g rises or falls there throughout; else of
 * the secant. */
static double interpolate_zero(const zd_zeros *self, int k)
{
    const int first = k < 2 ? 0 : k > self->count - 2 ? self->count - 4 : k - 2;
    const double *g = self->g + first;
    double t[4] = {self->t[first], self->t[first + 1], self->t[first + 2], self->t[first + 3]};
    const int rises = g[0] < g[1] && g[1] < g[2] && g[2] < g[3], falls = g[0] > g[1] && g[1] > g[2] && g[2] > g[3];
    if (!rises && !falls) return self->t[k] - self->g[k] * (self->t[k] - self->t[k - 1]) / (self->g[k] - self->g[k - 1]);
    for (int i = 1; i < 4; i++)     /* Neville's scheme */
        for (int j = 0; j < 4 - i; j++) t[j] = (g[j + i] * t[j] - g[j] * t[j + 1]) / (g[j + i] - g[j]);
    return t[0];
}

void zd_zeros_keep_ends(zd_zeros *self, int are_known)
{
    const int last = self->count - 1;
    for (int k = 1; k <= last && are_known; k++)
        if (zd_passes_zero(self->g[k - 1], self->g[k], 0)) {
            self->expected = interpolate_zero(self, k);
            self->slope = fabs(self->g[k] - self->g[k - 1]) / (self->t[k] - self->t[k - 1]);
        }
    self->t[1] = self->t[last], self->g[1] = self->g[last];
    self->count = 2;
}

/* ---- shape of the function at the points ---- */

static int count_changes(const zd_zeros *self)
{
    int changes = 0;
    for (int k = 1; k < self->count; k++) changes += zd_passes_zero(self->g[k - 1], self->g[k], 0);
    return changes;
}

static int has_superfluous_changes(const zd_zeros *self)
{
    return count_changes(self) > zd_passes_zero(self->g[0], self->g[self->count - 1], 0);
}

/* True if point k is an extremum towards zero, among points of the same sign. */
static int is_dip(const zd_zeros *self, int k)
{
    const double sign = copysign(1, self->g[k]), f = sign * self->g[k], before = sign * self->g[k - 1], after = sign * self->g[k + 1];
    return f > 0 && f <= before && f <= after && (f < before || f < after);
}

static double range_of(const zd_zeros *self)
{
    double range = 0;
    for (int k = 0; k < self->count; k++) range = fmax(range, fabs(self->g[k]));
    return range;
}

void zd_zeros_compare(zd_zeros *self, int k, double g)
{
    self->error = fmax(self->error, fabs(g - self->g[k]));
}

int zd_zeros_are_paired(const zd_zeros *self)
{
    const double range = range_of(self);
    if (has_superfluous_changes(self)) return 1;
    for (int k = 1; k + 1 < self->count; k++) {
        const double f = fabs(self->g[k]);
        if (f < CERTAIN * self->error || (is_dip(self, k) && 2 * f < range)) return 1;
    }
    return 0;
}

zd_bracket zd_zeros_bracket(const zd_zeros *self, int first, int last, double resolution)
{
    zd_bracket it = zd_bracket_of(self->t[first], self->t[last], self->g[first], self->g[last], resolution);
    if (!(it.a < self->expected && self->expected < it.b)) return it;
    it.slope = self->slope;
    return zd_bracket_near(self->expected, it);
}

void zd_zeros_widen(const zd_zeros *self, int k, int *first, int *last)
{
    *first = k - 1, *last = k;
    while (*first > 0 && self->g[*first - 1] * self->g[*first] > 0) --*first;
    while (*last + 1 < self->count && self->g[*last + 1] * self->g[*last] > 0) ++*last;
}

/* ---- search ---- */

void zd_zeros_begin(zd_zeros *self)
{
    self->at = 1;
    self->tries = 0;
    self->range = range_of(self);
    self->verifies = has_superfluous_changes(self);
}

static void remove_point(zd_zeros *self, int k)
{
    self->count--;
    for (; k < self->count; k++) self->t[k] = self->t[k + 1], self->g[k] = self->g[k + 1];
}

static void insert_point(zd_zeros *self, int k, double t, double g)
{
    for (int i = self->count++; i > k; i--) self->t[i] = self->t[i - 1], self->g[i] = self->g[i - 1];
    self->t[k] = t, self->g[k] = g;
}

/* Time and value of the vertex of the parabola through the three points; m if there is none. */
static double vertex(const zd_zeros *self, double *f)
{
    const double x = self->a - self->m, y = self->b - self->m, p = (self->fa - self->fm) / x, q = (self->fb - self->fm) / y;
    const double curvature = (q - p) / (y - x), slope = p - curvature * x;
    *f = self->fm;
    if (!(curvature > 0)) return self->m;
    *f -= slope * slope / (4 * curvature);
    return self->m - slope / (2 * curvature);
}

/* Lowers *f to the value at the intersection, within a to b, of lines with slopes p through (a, fa) and q through (b, fb); *t <- its time. */
static void intersect(double a, double fa, double p, double b, double fb, double q, double *t, double *f)
{
    const double x = isinf(p) ? a : isinf(q) ? b : fmin(b, fmax(a, (fb - fa + p * a - q * b) / (p - q)));
    const double value = isinf(p) ? fb + q * (x - b) : fa + p * (x - a);
    if (value < *f) *f = value, *t = x;
}

/* Time of the minimum *f around m, if the function goes on with its slopes to a kink, as the distance of two bodies that pass does. */
static double find_kink(const zd_zeros *self, double *f)
{
    const double p = (self->fm - self->fa) / (self->m - self->a), q = (self->fb - self->fm) / (self->b - self->m);
    double t = self->m;
    *f = self->fm;
    if (self->before < q) intersect(self->a, self->fa, self->before, self->m, self->fm, q, &t, f);
    if (p < self->after) intersect(self->m, self->fm, p, self->b, self->fb, self->after, &t, f);
    return t;
}

/* The next point of the minimization, by the parabola or a kink at a distance from m; false if no value beyond rounding is expected below
 * zero. */
static int continues(zd_zeros *self)
{
    double f, f_kink, t = vertex(self, &f), t_kink = find_kink(self, &f_kink);
    const double width = self->b - self->a, middle = self->a + width / 2, least = SHIFT * width;
    if (self->tries++ == MAX_TRIES) return 0;
    if (self->fm > 0 && f > (1 - DEPTH) * self->fm) {
        if (!(f_kink < 0)) return 0;
        f = f_kink, t = fmin(self->b - least, fmax(self->a + least, t_kink));
    }
    if (self->fm <= self->rounding && f >= -self->rounding) return 0;
    if (fabs(t - self->m) < least) t = self->m + copysign(least, middle - self->m);
    self->next = t;
    return self->a < t && t < self->b && t != self->m;
}

static void minimize_from(zd_zeros *self, int k)
{
    self->sign = copysign(1, self->g[k]);
    self->a = self->t[k - 1], self->m = self->t[k], self->b = self->t[k + 1];
    self->fa = fabs(self->g[k - 1]), self->fm = fabs(self->g[k]), self->fb = fabs(self->g[k + 1]);
    self->before = k > 1 ? (self->fa - self->sign * self->g[k - 2]) / (self->a - self->t[k - 2]) : -INFINITY;
    self->after = k + 2 < self->count ? (self->sign * self->g[k + 2] - self->fb) / (self->t[k + 2] - self->b) : INFINITY;
    self->rounding = 0;
}

static int verifies_next(zd_zeros *self)
{
    while (self->at + 1 < self->count && self->g[self->at] * self->g[self->at - 1] > 0) self->at++;
    self->next = self->t[self->at];
    return self->at + 1 < self->count;
}

int zd_zeros_next(zd_zeros *self)
{
    if (self->verifies && verifies_next(self)) return 1;
    if (self->verifies) self->verifies = 0, self->at = 1;
    for (; self->at + 1 < self->count; self->at++) {
        if (!self->tries && !is_dip(self, self->at)) continue;
        if (!self->tries) minimize_from(self, self->at);
        if (continues(self)) return 1;
        self->tries = 0;
    }
    return 0;
}

/* A value f of the minimization at t: the smallest, or one end of the new interval. */
static void narrow(zd_zeros *self, double t, double f)
{
    const int is_before = t < self->m;
    if (f >= self->fm) {
        if (is_before) self->before = (f - self->fa) / (t - self->a), self->a = t, self->fa = f;
        else self->after = (self->fb - f) / (self->b - t), self->b = t, self->fb = f;
        return;
    }
    if (is_before) self->after = (self->fb - self->fm) / (self->b - self->m), self->b = self->m, self->fb = self->fm;
    else self->before = (self->fm - self->fa) / (self->m - self->a), self->a = self->m, self->fa = self->fm;
    self->m = t, self->fm = f;
}

void zd_zeros_narrow(zd_zeros *self, double g, double rounding)
{
    const double f = self->sign * g, bound = fmax(rounding, MIN_ROUNDING * self->range);
    if (self->verifies) {
        if (fabs(g) <= bound) remove_point(self, self->at);
        else self->at++;
    } else if (f < -bound) {
        insert_point(self, self->at + (self->next > self->t[self->at]), self->next, g);
        self->at++;
        self->tries = 0;
    } else {
        self->rounding = bound;
        narrow(self, self->next, f);
    }
}
