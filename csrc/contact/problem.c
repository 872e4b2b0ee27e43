/* All cases are enumerated: each normal row is closed or open, each friction sticks or slides to either side. A case is a system of
 * linear equations for the z of the rows that are closed or stick, whose w is zero; sliding friction is its bound times -1 or 1. It is a
 * solution if all signs are right. Rows whose z is not unique, as they depend on others, are idle, with z = 0. The bounds of parallel
 * friction that sticks add up.
 */
#include "problem.h"

#include <math.h>
#include <string.h>

static const double MAX_CASES = 2e5;
static const double PIVOT_SHARE = 1e-11;    /* relative pivot below which a row depends on others */
static const double SIGN_SHARE = 1e-9;      /* share of the largest value below which a sign is rounding */
static const double PARALLEL_SHARE = 1e-9;  /* 1 - cosine^2 of two rows, below which they are parallel */
static const double MOTION_SHARE = 1e-7;    /* the same for the difference of two solutions */

typedef struct search {
    zd_contact_problem *of;
    signed char *state;     /* (rows,) the case */
    int *active, *column;
    int count, rank;               /* numbers of active rows, and of those that are independent */
    double *A, *x, *z, *w;
    double size;            /* largest |b| */
    int found;
    int slip_sign;          /* 1: sliding friction must move; -1: it may be at rest, if no other solution exists */
} search;

size_t zd_problem_scratch(int rows) { return (size_t)rows * (rows + 1) + 4 * (size_t)rows + 4; }

static void swap(double *a, double *b)
{
    const double moved = *a;
    *a = *b, *b = moved;
}

/* Moves the largest entry of the rows and columns from k on to the diagonal. */
static void choose_pivot(int n, double *A, double *x, int *column, int k)
{
    int pi = k, pj = k;
    for (int i = k; i < n; i++)
        for (int j = k; j < n; j++)
            if (fabs(A[i * n + j]) > fabs(A[pi * n + pj])) pi = i, pj = j;
    for (int j = 0; j < n; j++) swap(A + k * n + j, A + pi * n + j);
    for (int i = 0; i < n; i++) swap(A + i * n + k, A + i * n + pj);
    swap(x + k, x + pi);
    const int moved = column[k];
    column[k] = column[pj], column[pj] = moved;
}

/* Solves A x = x, (n, n), by complete pivoting, with zero for unknowns that are not determined; 0 if the equations are inconsistent. Entry k
 * of the solution belongs to `column` k; *rank: number of independent equations. */
static int solve(int n, double *A, double *x, int *column, int *rank)
{
    double contradiction = 0, size = 0;
    for (int i = 0; i < n; i++) column[i] = i, size = fmax(size, fabs(x[i]));
    for (*rank = 0; *rank < n; (*rank)++) {
        const int k = *rank;
        choose_pivot(n, A, x, column, k);
        if (!(fabs(A[k * n + k]) > PIVOT_SHARE * fabs(A[0]))) break;
        for (int i = k + 1; i < n; i++) {
            const double factor = A[i * n + k] / A[k * n + k];
            for (int j = k; j < n; j++) A[i * n + j] -= factor * A[k * n + j];
            x[i] -= factor * x[k];
        }
    }
    for (int i = *rank; i < n; i++) contradiction = fmax(contradiction, fabs(x[i])), x[i] = 0;
    for (int k = *rank - 1; k >= 0; k--) {
        for (int j = k + 1; j < *rank; j++) x[k] -= A[k * n + j] * x[j];
        x[k] /= A[k * n + k];
    }
    return contradiction <= SIGN_SHARE * size;
}

int zd_problem_equations(int n, double *A, double *x)
{
    int column[ZD_MAX_CANDIDATES], rank;
    double solution[ZD_MAX_CANDIDATES];
    const int is_solved = solve(n, A, x, column, &rank);
    for (int i = 0; i < n; i++) solution[column[i]] = x[i];
    zd_copy_all(n, solution, x);
    return is_solved;
}

static int sticks_with_another(const search *it, int i)
{
    return it->of->tie[i] >= 0 && it->state[it->of->tie[i]] == ZD_CLOSED;
}

static double slip_bound(const search *it, int i, int which)
{
    const zd_candidate *row = it->of->row + i;
    return row->bound[which] * (row->normal ? it->z[row->normal - 1] : 1);
}

/* Bound of static friction of a row, with those of the rows that stick with it. */
static double total_bound(const search *it, int i)
{
    double sum = slip_bound(it, i, 0);
    for (int k = i + 1; k < it->of->rows; k++)
        if (it->of->tie[k] == i && it->state[k] == ZD_CLOSED) sum += it->of->factor[k] * slip_bound(it, k, 0);
    return sum;
}

/* z and w of the case; 0: it has no solution. */
static int solve_case(search *it)
{
    const zd_contact_problem *of = it->of;
    const int n = of->rows;
    int count = 0;
    for (int i = 0; i < n; i++)
        if (it->state[i] == ZD_CLOSED && !sticks_with_another(it, i)) it->active[count++] = i;
    it->count = count;
    for (int a = 0; a < count; a++) it->x[a] = -of->b[it->active[a]];
    for (int a = 0; a < count; a++)
        for (int c = 0; c < count; c++) it->A[a * count + c] = of->W[it->active[a] * n + it->active[c]];
    for (int s = 0; s < n; s++) {
        const zd_candidate *row = of->row + s;
        if (!zd_slides(it->state[s])) continue;
        const double force = -zd_slip_sign(it->state[s]) * row->bound[1];
        for (int a = 0, c = 0; a < count; a++) {
            const double W = of->W[it->active[a] * n + s];
            for (c = 0; row->normal && c < count && it->active[c] != row->normal - 1;) c++;
            if (row->normal) it->A[a * count + c] += W * force;
            else it->x[a] -= W * force;
        }
    }
    if (!solve(count, it->A, it->x, it->column, &it->rank)) return 0;
    memset(it->z, 0, n * sizeof *it->z);
    for (int a = 0; a < count; a++) it->z[it->active[it->column[a]]] = it->x[a];
    for (int s = 0; s < n; s++)
        if (zd_slides(it->state[s])) it->z[s] = -zd_slip_sign(it->state[s]) * slip_bound(it, s, 1);
    for (int i = 0; i < n; i++) {
        it->w[i] = of->b[i];
        for (int j = 0; j < n; j++) it->w[i] += of->W[i * n + j] * it->z[j];
    }
    return 1;
}

static int signs_are_right(const search *it)
{
    const zd_contact_problem *of = it->of;
    double largest_z = 0, largest_w = it->size;
    for (int i = 0; i < of->rows; i++) largest_z = fmax(largest_z, fabs(it->z[i]));
    for (int i = 0; i < of->rows; i++) largest_w = fmax(largest_w, fabs(of->W[i * of->rows + i] * it->z[i]));
    const double z = SIGN_SHARE * largest_z, w = SIGN_SHARE * largest_w;
    for (int i = 0; i < of->rows; i++) {
        const zd_candidate *row = of->row + i;
        const signed char state = it->state[i];
        if (row->normal < 0) {
            if (state == ZD_CLOSED ? it->z[i] < -z : row->slides == ZD_OPEN && it->w[i] < -w) return 0;
        } else if (state == ZD_CLOSED) {
            if (!sticks_with_another(it, i) && fabs(it->z[i]) > total_bound(it, i) + z) return 0;
        } else if (zd_slides(state) && row->slides == ZD_OPEN && zd_slip_sign(state) * it->w[i] <= it->slip_sign * w) return 0;
    }
    return 1;
}

/* True if the case differs from the first solution in its motion, not only as it slides where the first one sticks by static friction. */
static int is_another(const search *it)
{
    const zd_contact_problem *of = it->of;
    int differs = 0, slides_more = 0;
    for (int i = 0; i < of->rows; i++) {
        differs |= fabs(it->w[i] - of->w[i]) > MOTION_SHARE * it->size;
        const int by_choice = of->row[i].normal >= 0 && of->row[i].bound[0] > of->row[i].bound[1];
        slides_more |= by_choice && (of->state[i] == ZD_CLOSED || of->state[i] == ZD_IDLE) && zd_slides(it->state[i]);
    }
    return differs && !slides_more;
}

/* True if an open normal row cannot move, as it is parallel to a row of friction that sticks. */
static int is_held_by_others(const search *it, int i)
{
    const zd_contact_problem *of = it->of;
    const int n = of->rows;
    if (of->row[i].normal >= 0 || it->state[i] != ZD_OPEN || of->row[i].slides != ZD_OPEN) return 0;
    for (int k = 0; k < n; k++) {
        const double W = of->W[i * n + k], product = of->W[i * n + i] * of->W[k * n + k];
        if (of->row[k].normal >= 0 && it->state[k] == ZD_CLOSED && product - W * W <= PARALLEL_SHARE * product) return 1;
    }
    return 0;
}

static void check_case(search *it)
{
    zd_contact_problem *of = it->of;
    if (!solve_case(it) || !signs_are_right(it)) return;
    if (it->found) {
        it->found += is_another(it);
        return;
    }
    it->found = 1;
    memcpy(of->state, it->state, of->rows);
    for (int i = 0; i < of->rows; i++)
        if (it->state[i] == ZD_CLOSED && sticks_with_another(it, i)) of->state[i] = ZD_IDLE;
    for (int a = it->rank; a < it->count; a++) of->state[it->active[it->column[a]]] = ZD_IDLE;
    for (int i = 0; i < of->rows; i++)
        if (is_held_by_others(it, i)) of->state[i] = ZD_IDLE;
    memcpy(of->z, it->z, of->rows * sizeof *of->z);
    memcpy(of->w, it->w, of->rows * sizeof *of->w);
}

/* Enumerates the states of row i and of all later ones. */
static void complete(search *it, int i)
{
    const zd_contact_problem *of = it->of;
    if (it->found > 1) return;
    if (i == of->rows) {
        check_case(it);
        return;
    }
    const zd_candidate *row = of->row + i;
    const int is_absent = row->normal > 0 && it->state[row->normal - 1] == ZD_OPEN;
    if (row->normal < 0) {
        for (int second = 0; second < 2; second++) {
            it->state[i] = second != of->opens ? ZD_OPEN : ZD_CLOSED;
            if (row->slides == ZD_OPEN || it->state[i] == ZD_OPEN) complete(it, i + 1);
        }
    } else if (is_absent || row->slides != ZD_OPEN) {
        it->state[i] = is_absent ? ZD_OPEN : row->slides, complete(it, i + 1);
    } else {
        for (signed char state = ZD_CLOSED; state <= ZD_SLIDES_BACKWARD; state++) it->state[i] = state, complete(it, i + 1);
    }
}

static void find_parallel(zd_contact_problem *self)
{
    const int n = self->rows;
    for (int i = 0; i < n; i++) {
        self->tie[i] = -1;
        for (int k = 0; k < i && self->tie[i] < 0; k++) {
            const double W = self->W[i * n + k], product = self->W[i * n + i] * self->W[k * n + k];
            const int are_friction = self->row[i].normal >= 0 && self->row[k].normal >= 0;
            if (are_friction && self->tie[k] < 0 && product - W * W <= PARALLEL_SHARE * product)
                self->tie[i] = k, self->factor[i] = fabs(W / self->W[k * n + k]);
        }
    }
}

int zd_problem_solve(zd_contact_problem *self)
{
    const int n = self->rows;
    double cases = 1, size = 0;
    for (int i = 0; i < n; i++) {
        cases *= self->row[i].normal < 0 ? 2 : self->row[i].slides == ZD_OPEN ? 3 : 1;
        size = fmax(size, fabs(self->b[i]));
    }
    if (n > ZD_MAX_CANDIDATES || cases > MAX_CASES) return -1;
    signed char state[ZD_MAX_CANDIDATES];
    int active[ZD_MAX_CANDIDATES], column[ZD_MAX_CANDIDATES];
    search it = {self, state, active, column, .size = size};
    find_parallel(self);
    it.A = self->scratch, it.x = it.A + (size_t)n * n, it.z = it.x + n, it.w = it.z + n;
    for (it.slip_sign = 1; it.slip_sign >= -1 && !it.found; it.slip_sign -= 2) complete(&it, 0);
    return it.found;
}
