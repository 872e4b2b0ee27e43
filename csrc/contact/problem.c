/* All cases are enumerated: each normal row is closed or open, each friction sticks or slides to either side. A case is a system of
 * linear equations for the z of the rows that are closed or stick, whose w is zero; sliding friction is its bound times -1 or 1. It is a
 * solution if all signs are right. Rows whose z is not unique, as they depend on others, are idle, with z = 0. The bounds of parallel
 * friction that sticks add up.
 *
 * In space, where friction depends on the distribution of normal forces, those of the minimum norm are the solution instead. Friction in
 * two directions is a pair of rows, which slides against its w: contact/case.c. Contacts that stick are a solution if some distribution of
 * their forces is within their bounds: contact/distribution.h.
 */
#include "case.h"

#include <math.h>
#include <string.h>

static const double MAX_CASES = 2e5;
static const double PARALLEL_SHARE = 1e-9;  /* 1 - cosine^2 of two rows, below which they are parallel */
static const double MOTION_SHARE = 1e-7;    /* the same for the difference of two solutions */

size_t zd_problem_scratch(int rows) { return (size_t)rows * (rows + 1) + 5 * (size_t)rows + 4; }

static int signs_are_right(const zd_case *it)
{
    const zd_contact_problem *of = it->of;
    double largest_z = 0, largest_w = it->size;
    for (int i = 0; i < of->rows; i++) largest_z = fmax(largest_z, fabs(it->z[i]));
    for (int i = 0; i < of->rows; i++) largest_w = fmax(largest_w, fabs(of->W[i * of->rows + i] * it->z[i]));
    const double z = ZD_SIGN_SHARE * largest_z, w = ZD_SIGN_SHARE * largest_w;
    for (int i = 0; i < of->rows; i++) {
        const zd_candidate *row = of->row + i;
        const signed char state = it->state[i];
        if (row->normal < 0) {
            if (state == ZD_CLOSED ? it->z[i] < -z : row->slides == ZD_OPEN && it->w[i] < -w) return 0;
        } else if (row->pair) {
            if (zd_case_has_unknown_direction(it, i)
                && it->e[i] * it->w[i] + it->e[i + 1] * it->w[i + 1] <= (row->is_unknown ? it->slip_sign : 1) * w) return 0;
        } else if (state == ZD_CLOSED) {
            if (!zd_case_sticks_with_another(it, i) && fabs(it->z[i]) > zd_case_total_bound(it, i) + z) return 0;
        } else if (zd_slides(state) && row->slides == ZD_OPEN && zd_slip_sign(state) * it->w[i] <= it->slip_sign * w) return 0;
    }
    return 1;
}

/* True if the case is a solution, with friction in two directions. */
static int is_solution(zd_case *it)
{
    it->free_forces = 0;
    if (!zd_case_has_pairs(it)) return signs_are_right(it);
    if (!zd_case_pairs_stick(it) || !signs_are_right(it)) return 0;
    const int lacking = it->count - it->rank;       /* equations, besides those of the minimum norm */
    if (lacking == (zd_case_has_sliding_pairs(it) ? it->free_forces : it->free_forces - it->free_normals)) return 1;
    it->is_undetermined = 1;
    return 0;
}

/* True if the case differs from the first solution in its motion, not only as it slides where the first one sticks by static friction. */
static int is_another(const zd_case *it)
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

/* True if two candidates are parallel; a blocked one is parallel to none. */
static int are_parallel(const zd_contact_problem *of, int i, int k)
{
    const double W = of->W[i * of->rows + k], product = of->W[i * of->rows + i] * of->W[k * of->rows + k];
    return product > 0 && product - W * W <= PARALLEL_SHARE * product;
}

/* True if an open normal row cannot move, as it is parallel to a row of friction that sticks. */
static int is_held_by_others(const zd_case *it, int i)
{
    const zd_contact_problem *of = it->of;
    if (of->row[i].normal >= 0 || it->state[i] != ZD_OPEN || of->row[i].slides != ZD_OPEN) return 0;
    for (int k = 0; k < of->rows; k++)
        if (of->row[k].normal >= 0 && it->state[k] == ZD_CLOSED && are_parallel(of, i, k)) return 1;
    return 0;
}

/* Sum W_kk z_k^2 of the normal forces */
static double find_norm(const zd_case *it)
{
    double sum = 0;
    for (int i = 0; i < it->of->rows && it->of->row[i].normal < 0; i++) sum += it->of->W[i * (it->of->rows + 1)] * it->z[i] * it->z[i];
    return sum;
}

static void check_case(zd_case *it)
{
    zd_contact_problem *of = it->of;
    if (!zd_case_solve(it) || !is_solution(it)) return;
    const double norm = find_norm(it);
    const int is_new = it->found && is_another(it);
    if (!it->normals_depend) it->found += is_new;
    if (it->found && !(is_new && it->normals_depend && norm < (1 - ZD_SIGN_SHARE) * it->norm)) return;
    it->found = 1;
    it->norm = norm;
    memcpy(of->state, it->state, of->rows);
    for (int i = 0; i < of->rows; i++)
        if (it->state[i] == ZD_CLOSED && zd_case_sticks_with_another(it, i)) of->state[i] = ZD_IDLE;
    for (int a = it->rank; a < it->count && !it->free_forces; a++) of->state[it->active[it->column[a]]] = ZD_IDLE;
    for (int i = 0; i < of->rows; i++)
        if (!zd_case_has_pairs(it) && is_held_by_others(it, i)) of->state[i] = ZD_IDLE;
    memcpy(of->z, it->z, of->rows * sizeof *of->z);
    memcpy(of->w, it->w, of->rows * sizeof *of->w);
    memcpy(of->direction, it->e, of->rows * sizeof *of->direction);
    of->free_forces = it->free_forces, of->free_normals = it->free_normals;
}

/* Enumerates the states of row i and of all later ones. */
static void complete(zd_case *it, int i)
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
            const int are_friction = self->row[i].normal >= 0 && self->row[k].normal >= 0 && !self->row[i].pair && !self->row[k].pair;
            if (are_friction && self->tie[k] < 0 && are_parallel(self, i, k))
                self->tie[i] = k, self->factor[i] = self->W[i * n + k] / self->W[k * n + k];
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
        const int normal = self->row[i].normal < 0 ? i : self->row[i].normal - 1;
        if (normal < 0 || self->row[normal].slides == ZD_OPEN) size = fmax(size, fabs(self->b[i]));     /* others take no part */
    }
    if (n > ZD_MAX_CANDIDATES || cases > MAX_CASES) return -1;
    signed char state[ZD_MAX_CANDIDATES];
    int active[ZD_MAX_CANDIDATES], column[ZD_MAX_CANDIDATES];
    zd_case it = {self, state, active, column, .size = size};
    find_parallel(self);
    it.A = self->scratch, it.x = it.A + (size_t)n * n, it.z = it.x + n, it.w = it.z + n, it.e = it.w + n;
    it.normals_depend = self->is_min_norm && zd_case_normals_depend(&it);
    int has_unknown = 0;
    for (int i = 0; i < n; i++) has_unknown |= self->row[i].pair && (self->row[i].slides == ZD_OPEN || self->row[i].is_unknown);
    if (has_unknown) zd_case_estimate_directions(&it);
    for (it.slip_sign = 1; it.slip_sign >= -1 && !it.found; it.slip_sign -= 2) complete(&it, 0);
    return it.found || !it.is_undetermined ? it.found : -2;
}
