/* Classification of dependent constraints at the start: redundant, dependent only there, or contradicting the others. Then rows.c
 * selects among those that are independent anywhere.
 */
#include "rank.h"

#include <math.h>

#include "../linalg/small.h"
#include "../point/point.h"

static const double SQUARED = ZD_RANK_TOLERANCE * ZD_RANK_TOLERANCE;
static const double CURVED = 16 * ZD_RANK_TOLERANCE;    /* residual of (6) relative to its terms: beyond, independent elsewhere */
static const double NO_ROW = 0x1p-80;   /* squared norm relative to the largest row: a row below it at the start is treated as zero there */

/* Reference norms of the rows, where nothing is singular. A row at the rounding of its terms gets their magnitude; a row that is zero at
 * the start for another reason gets the norm of the largest. */
static void measure(const zd_point *point)
{
    const zd_rank *self = point->rank;
    int m = self->m;
    for (int k = 0; k < m; k++) {
        zd_row_of_C row = zd_point_row(point, k);
        self->start_square[k] = zd_dot(row.count, row.x, row.x);
        if (self->start_square[k] <= point->rounding[k] * point->rounding[k])
            self->start_square[k] = point->rounding[k] * point->rounding[k] / NO_ROW;
    }
    double largest = zd_max_abs(m, self->start_square);
    for (int k = 0; k < m; k++)
        if (!(self->start_square[k] > NO_ROW * largest)) self->start_square[k] = largest;
    for (int k = 0; k < m; k++) {
        const double of_terms = point->rounding[k] * point->rounding[k] / NO_ROW;
        self->terms_square[k] = of_terms > 0 ? of_terms : self->start_square[k] > 0 ? self->start_square[k] : 1;
    }
}

/* v <- v0 and a random velocity that satisfies C v = 0 */
static void vary(const zd_point *point, unsigned *seed, const double *v0, double *v)
{
    const zd_selection *self = point->rank->selection;
    int n = self->n;
    double size = 1 + zd_max_scaled(n, v0, point->inverse_unit);
    for (int i = 0; i < n; i++) {
        *seed = *seed * 1664525u + 1013904223u;
        v[i] = size * ((double)(*seed >> 8) * 0x1p-23 - 1);
    }
    for (int a = 0; a < self->independent; a++) zd_add_scaled(n, v, -zd_dot(n, self->Q + a * n, v), self->Q + a * n);
    for (int i = 0; i < n; i++) v[i] = v0[i] + v[i] * point->unit[i];
}

static double unit_of(const zd_selection *self, int k)
{
    return self->rank->start_square[k] > 0 ? sqrt(self->rank->start_square[k]) : 1;
}

/* Largest residual of the velocity in (5), relative to the norms of the rows. Psi (m,) */
static double largest_violation_of_velocity(const zd_point *point, double *Psi)
{
    const zd_selection *self = point->rank->selection;
    double most = 0;
    zd_point_velocity_violation(point, Psi);
    for (int k = 0; k < self->m; k++) most = fmax(most, fabs(Psi[k]) / unit_of(self, k));
    return most;
}

/* Residuals w (m - rows,) of (6) of the dependent constraints at the point's velocity, after those of the independent ones are
 * eliminated; relative to the norms of the rows. For redundant constraints they are zero up to rounding and the effect of a velocity
 * that violates (5): where nothing can move, a computed velocity consists of nothing else. Returns the first constraint that is not
 * redundant, or m. */
static int curvature(const zd_point *point, double *w)
{
    const zd_selection *self = point->rank->selection;
    const double *xi = point->terms.xi;
    const double speed = zd_max_abs(self->n, point->v), violation = largest_violation_of_velocity(point, w);
    double largest = 0;
    int first = self->m;
    for (int k = 0; k < self->m; k++) largest = fmax(largest, fabs(xi[k]) / unit_of(self, k));
    for (int d = self->m - 1; d >= point->rows; d--) {
        int row = self->row[d];
        double sum = xi[row] / unit_of(self, row), terms = 1;
        for (int a = 0; a < point->rows; a++) {
            double share = self->G[row * self->m + a] / unit_of(self, row);
            sum -= share * xi[self->row[a]];
            terms += fabs(share) * unit_of(self, self->row[a]);
        }
        const double size = 1 + zd_max_abs(point->system->nq, point->p), scale = terms * largest + speed * speed / size;
        w[d - point->rows] = sum;
        if (!(fabs(sum) <= CURVED * scale + violation / ZD_DOUBTFUL * speed / size)) first = d;
    }
    return first;
}

/* With C_d = T C_r at p, constraints d are redundant if xi_d = T xi_r, too, for any velocity: else they become independent as soon as
 * the system moves. Returns how many of the first `others` do; -1 if the evaluation failed. */
static int count_curved(zd_point *point, int others, double *sample)
{
    zd_selection *self = point->rank->selection;
    int n = self->n, curved = 0, status = ZD_DONE;
    double *v0 = sample, *v = v0 + n, *basis = v + n;
    unsigned seed = 1;
    if (self->independent == n) return 0;       /* no freedom: at most n rows can be independent anywhere */
    zd_copy(n, point->v, v0);
    zd_rank_set_basis(point);
    for (int i = 0; i < n && curved < others && !status; i++) {
        double *w = basis + curved * others;
        vary(point, &seed, v0, v);
        zd_point_move_velocity(point, v);
        status = zd_point_need(point, ZD_XI);
        if (status) break;
        if (curvature(point, w) >= point->rows + others) continue;
        double square = zd_dot(others, w, w);
        for (int b = 0; b < curved; b++) zd_add_scaled(others, w, -zd_dot(others, basis + b * others, w), basis + b * others);
        double left = zd_dot(others, w, w);
        if (!(left > SQUARED * square)) continue;
        for (int b = 0; b < others; b++) w[b] /= sqrt(left);
        curved++;
    }
    zd_point_move_velocity(point, v0);
    return status ? -1 : curved;
}

static int classify(zd_point *point, double *sample)
{
    zd_selection *self = point->rank->selection;
    int status = zd_point_need(point, ZD_XI | ZD_PHI_T);
    if (status) return status;
    int first = curvature(point, sample);
    point->failed_index = self->row[first < self->m ? first : 0];
    if (first < self->m) return ZD_CONTRADICTION;       /* no vdot exists */
    int others = self->m - point->rows, holonomic = self->mh - point->holonomic;     /* these come first */
    int curved = count_curved(point, others, sample), curved_holonomic = curved > 0 ? count_curved(point, holonomic, sample) : 0;
    if (curved < 0 || curved_holonomic < 0) return ZD_CALLBACK;
    self->rank->max_rank = point->rows + curved;
    self->rank->max_rank_holonomic = point->holonomic + curved_holonomic;
    if (curved) return ZD_DONE;
    for (int d = point->rows; d < self->m; d++) self->redundant[self->row[d]] = 1;
    return ZD_DONE;
}

/* Classifies with temporary memory, which is needed only if constraints are dependent. */
static int classify_dependent(zd_point *point)
{
    size_t n = point->rank->n, m = point->rank->m;
    double *sample = zd_allocate((2 * n + m * m + m) * sizeof(double));
    int status = sample ? classify(point, sample) : ZD_NO_MEMORY;
    zd_release(sample);
    return status;
}

int zd_redundancy_prepare(zd_point *point)
{
    int status = zd_point_need(point, ZD_C | ZD_M);
    if (!status) status = zd_point_measure(point);
    if (status) return status;
    point->rank->allows_deficiency = 1;
    measure(point);
    return ZD_DONE;
}

int zd_redundancy_find(zd_point *point, enum zd_on_singular on_singular)
{
    zd_rank *self = point->rank;
    if (self->is_large) {
        self->is_started = 1;
        return zd_redundancy_sparse_find(point);
    }
    int status = zd_find_independent(point);
    self->allows_deficiency = on_singular == ZD_CONTINUE;
    self->is_started = 1;
    if (status || point->rows == self->m) return status;
    status = point->system->provides & ZD_XI ? classify_dependent(point) : ZD_DONE;
    if (status) return status;
    self->was_deficient = point->rows < self->max_rank;
    if (self->was_deficient && !self->allows_deficiency) return ZD_BIFURCATION;
    return self->was_deficient ? zd_rows_find_again(point) : ZD_DONE;
}
