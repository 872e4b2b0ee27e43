/* All cases are enumerated: each normal row is closed or open, each friction sticks or slides to either side. A case is a system of
 * linear equations for the z of the rows that are closed or stick, whose w is zero; sliding friction is its bound times -1 or 1. It is a
 * solution if all signs are right. Rows whose z is not unique, as they depend on others, are idle, with z = 0. The bounds of parallel
 * friction that sticks add up.
 *
 * In space, where it counts for friction which of several contacts bears a body, the least z are taken instead.
 *
 * Friction of two rows slides against w, whose direction e is given or found by Newton's method from e x w(e) = 0. Where it sticks in
 * several contacts, any distribution within their bounds does: contact/share.h.
 */
#include "problem.h"

#include <math.h>
#include <string.h>

#include "equations.h"

static const double MAX_CASES = 2e5;
static const double SIGN_SHARE = 1e-9;      /* share of the largest value below which a sign is rounding */
static const double PARALLEL_SHARE = 1e-9;  /* 1 - cosine^2 of two rows, below which they are parallel */
static const double MOTION_SHARE = 1e-7;    /* the same for the difference of two solutions */
static const double DIRECTION = 1e-11;      /* error of a direction that is found, in rad */
static const double TURN = 1e-6;            /* rad: difference by which its derivative is found */
enum { ITERATIONS = 60 };

typedef struct search {
    zd_contact_problem *of;
    signed char *state;     /* (rows,) the case */
    int *active, *column;
    int count, rank;               /* numbers of active rows, and of those that are independent */
    double *A, *x, *z, *w;
    double *e;              /* (rows,) directions of slip of the case */
    double size;            /* largest |b| */
    int found;
    int shared;             /* number of unknowns of friction of two rows that are not determined */
    int least;              /* and of normal forces, of which the least are taken */
    int slip_sign;          /* 1: sliding friction must move; -1: it may be at rest, if no other solution exists */
    int is_undetermined;    /* true if a case would be a solution, if the normal forces that bound its friction were determined */
} search;

size_t zd_problem_scratch(int rows) { return (size_t)rows * (rows + 1) + 5 * (size_t)rows + 4; }

int zd_problem_equations(int n, double *A, double *x)
{
    int column[ZD_MAX_CANDIDATES], rank;
    double solution[ZD_MAX_CANDIDATES];
    const int is_solved = zd_equations_solve(n, A, x, column, &rank);
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

static int has_pairs(const search *it)
{
    for (int i = 0; i < it->of->rows; i++)
        if (it->of->row[i].pair && it->state[i] != ZD_OPEN) return 1;
    return 0;
}

/* The least normal forces where they are not determined: sum W_kk z_k^2 = min. With null vectors n of their W,
 * n . (W_kk z_k) = 0 is added to equations that depend on others. */
static void choose_least(search *it)
{
    const zd_contact_problem *of = it->of;
    double W[ZD_MAX_CANDIDATES * ZD_MAX_CANDIDATES], null[ZD_MAX_CANDIDATES * ZD_MAX_CANDIDATES];
    int normals = 0;
    while (normals < it->count && of->row[it->active[normals]].normal < 0) normals++;
    for (int a = 0; a < normals; a++)
        for (int c = 0; c < normals; c++) W[a * normals + c] = of->W[it->active[a] * of->rows + it->active[c]];
    it->least = zd_equations_null_space(normals, W, null);
    for (const double *n = null; n < null + it->least * normals; n += normals)
        for (int a = 0; a < normals; a++)
            for (int c = 0; c < normals; c++)
                it->A[a * it->count + c] += n[a] * n[c] * of->W[it->active[c] * (of->rows + 1)];
}

/* The same with given directions. */
static int solve_with_directions(search *it)
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
        const double force = -it->e[s] * row->bound[1];
        for (int a = 0, c = 0; a < count; a++) {
            const double W = of->W[it->active[a] * n + s];
            for (c = 0; row->normal && c < count && it->active[c] != row->normal - 1;) c++;
            if (row->normal) it->A[a * count + c] += W * force;
            else it->x[a] -= W * force;
        }
    }
    it->least = 0;
    if (it->of->takes_least) choose_least(it);
    if (!zd_equations_solve(count, it->A, it->x, it->column, &it->rank)) return 0;
    memset(it->z, 0, n * sizeof *it->z);
    for (int a = 0; a < count; a++) it->z[it->active[it->column[a]]] = it->x[a];
    for (int s = 0; s < n; s++)
        if (zd_slides(it->state[s])) it->z[s] = -it->e[s] * slip_bound(it, s, 1);
    for (int i = 0; i < n; i++) {
        it->w[i] = of->b[i];
        for (int j = 0; j < n; j++) it->w[i] += of->W[i * n + j] * it->z[j];
    }
    return 1;
}

/* ---- friction of two rows ---- */

static int slides_in_sought_direction(const search *it, int i)
{
    const zd_candidate *row = it->of->row + i;
    return row->pair == 1 && zd_slides(it->state[i]) && (row->slides == ZD_OPEN || row->seeks);
}

/* Directions to begin with: given ones, or those of b. */
static void begin_directions(search *it)
{
    const zd_contact_problem *of = it->of;
    for (int i = 0; i < of->rows; i++) {
        it->e[i] = of->row[i].pair ? of->direction[i] : zd_slip_sign(it->state[i]);
        if (of->row[i].pair != 2 || it->e[i - 1] != 0 || it->e[i] != 0) continue;
        const double size = hypot(of->b[i - 1], of->b[i]);
        it->e[i - 1] = size > 0 ? of->b[i - 1] / size : 1;
        it->e[i] = size > 0 ? of->b[i] / size : 0;
    }
}

static void turn(double *e, double angle)
{
    const double c = cos(angle), s = sin(angle), x = e[0];
    e[0] = c * x - s * e[1];
    e[1] = s * x + c * e[1];
}

/* r (count,) <- e x w of sought directions */
static int find_residuals(search *it, int count, const int *sought, double *r)
{
    if (!solve_with_directions(it)) return 0;
    for (int k = 0; k < count; k++) r[k] = it->e[sought[k]] * it->w[sought[k] + 1] - it->e[sought[k] + 1] * it->w[sought[k]];
    return 1;
}

/* z and w of the case, with its directions; 0: it has no solution. */
static int solve_case(search *it)
{
    int sought[ZD_MAX_PAIRS], count = 0;
    double r[ZD_MAX_PAIRS], turned[ZD_MAX_PAIRS], J[ZD_MAX_PAIRS * ZD_MAX_PAIRS];
    begin_directions(it);
    for (int i = 0; i < it->of->rows; i++)
        if (slides_in_sought_direction(it, i)) sought[count++] = i;
    for (int n = 0; n < ITERATIONS; n++) {
        double largest = 0;
        if (!find_residuals(it, count, sought, r)) return 0;
        for (int k = 0; k < count; k++) largest = fmax(largest, fabs(r[k]));
        if (!(largest > DIRECTION * it->size)) return 1;
        for (int j = 0; j < count; j++) {
            turn(it->e + sought[j], TURN);
            if (!find_residuals(it, count, sought, turned)) return 0;
            turn(it->e + sought[j], -TURN);
            for (int k = 0; k < count; k++) J[k * count + j] = (turned[k] - r[k]) / TURN;
        }
        for (int k = 0; k < count; k++) r[k] = -r[k];
        zd_problem_equations(count, J, r);
        for (int k = 0; k < count; k++) turn(it->e + sought[k], fmax(-0.5, fmin(0.5, r[k])));
    }
    return 0;
}

/* True if friction of two rows that sticks is within its bounds; z <- a distribution that shows it. */
static int pairs_stick(search *it, double rounding)
{
    const zd_contact_problem *of = it->of;
    int at[ZD_MAX_PAIRS];
    zd_share share = {.pairs = 0};
    double K[4 * ZD_MAX_PAIRS * ZD_MAX_PAIRS];
    for (int i = 0; i < of->rows; i++) {
        if (of->row[i].pair != 1 || it->state[i] != ZD_CLOSED) continue;
        share.bound[share.pairs] = slip_bound(it, i, 0) + rounding;
        share.f[2 * share.pairs] = it->z[i], share.f[2 * share.pairs + 1] = it->z[i + 1];
        at[share.pairs++] = i;
    }
    if (!share.pairs) return 1;
    for (int i = 0; i < 2 * share.pairs; i++)
        for (int j = 0; j < 2 * share.pairs; j++)
            K[i * 2 * share.pairs + j] = of->W[(at[i / 2] + i % 2) * of->rows + at[j / 2] + j % 2];
    zd_share_find(&share, K);
    it->shared = share.nulls;
    for (int i = 0; i < 2 * share.pairs; i++) it->z[at[i / 2] + i % 2] = share.f[i];
    return share.factor <= 1 + SIGN_SHARE;
}

static int signs_are_right(search *it)
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
        } else if (row->pair) {
            if (slides_in_sought_direction(it, i) && it->e[i] * it->w[i] + it->e[i + 1] * it->w[i + 1] <= it->slip_sign * w) return 0;
        } else if (state == ZD_CLOSED) {
            if (!sticks_with_another(it, i) && fabs(it->z[i]) > total_bound(it, i) + z) return 0;
        } else if (zd_slides(state) && row->slides == ZD_OPEN && zd_slip_sign(state) * it->w[i] <= it->slip_sign * w) return 0;
    }
    it->shared = 0;
    if (!pairs_stick(it, z)) return 0;
    if (!has_pairs(it) || it->count - it->rank == it->shared) return 1;
    it->is_undetermined = 1;
    return 0;
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
        it->found += !of->least && !it->least && is_another(it);      /* with other least forces it is a choice */
        return;
    }
    it->found = 1;
    memcpy(of->state, it->state, of->rows);
    for (int i = 0; i < of->rows; i++)
        if (it->state[i] == ZD_CLOSED && sticks_with_another(it, i)) of->state[i] = ZD_IDLE;
    for (int a = it->rank; a < it->count; a++)
        if (!of->row[it->active[it->column[a]]].pair) of->state[it->active[it->column[a]]] = ZD_IDLE;
    for (int i = 0; i < of->rows; i++)
        if (is_held_by_others(it, i)) of->state[i] = ZD_IDLE;
    memcpy(of->z, it->z, of->rows * sizeof *of->z);
    memcpy(of->w, it->w, of->rows * sizeof *of->w);
    memcpy(of->direction, it->e, of->rows * sizeof *of->direction);
    of->shared = it->shared, of->least = it->least;
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
    } else if (row->pair == 2) {
        it->state[i] = it->state[i - 1], complete(it, i + 1);
    } else if (is_absent || row->slides != ZD_OPEN) {
        it->state[i] = is_absent ? ZD_OPEN : row->slides, complete(it, i + 1);
    } else {
        const signed char last = row->pair ? ZD_SLIDES_FORWARD : ZD_SLIDES_BACKWARD;
        for (signed char state = ZD_CLOSED; state <= last; state++) it->state[i] = state, complete(it, i + 1);
    }
}

static void find_parallel(zd_contact_problem *self)
{
    const int n = self->rows;
    for (int i = 0; i < n; i++) {
        self->tie[i] = -1;
        for (int k = 0; k < i && self->tie[i] < 0; k++) {
            const double W = self->W[i * n + k], product = self->W[i * n + i] * self->W[k * n + k];
            const int are_friction = self->row[i].normal >= 0 && self->row[k].normal >= 0 && !self->row[i].pair && !self->row[k].pair;
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
        const int states = self->row[i].normal < 0 ? 2 : !self->row[i].pair ? 3 : self->row[i].pair == 1 ? 2 : 1;
        cases *= self->row[i].normal < 0 || self->row[i].slides == ZD_OPEN ? states : 1;
        size = fmax(size, fabs(self->b[i]));
    }
    if (n > ZD_MAX_CANDIDATES || cases > MAX_CASES) return -1;
    signed char state[ZD_MAX_CANDIDATES];
    int active[ZD_MAX_CANDIDATES], column[ZD_MAX_CANDIDATES];
    search it = {self, state, active, column, .size = size};
    find_parallel(self);
    it.A = self->scratch, it.x = it.A + (size_t)n * n, it.z = it.x + n, it.w = it.z + n, it.e = it.w + n;
    for (it.slip_sign = 1; it.slip_sign >= -1 && !it.found; it.slip_sign -= 2) complete(&it, 0);
    return it.found || !it.is_undetermined ? it.found : -2;
}
