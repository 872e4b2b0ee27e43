/* Sliding friction in two directions acts against the unit vector e of the slip, which is given, or found by Newton's method from
 * e x w(e) = 0; it starts from the result of sweeps of the projected Gauss-Seidel method over all rows. */
#include "case.h"

#include <math.h>
#include <string.h>

#include "../linalg/roots.h"
#include "../linalg/small.h"
#include "equations.h"

static const double DIRECTION = 1e-11;      /* error of a direction that is found, in rad */
static const double TURN = 1e-6;            /* rad: difference by which its derivative is found */
enum { ITERATIONS = 60, SWEEPS = 300, MAX_PAIRS = ZD_MAX_CANDIDATES / 2 };

int zd_case_sticks_with_another(const zd_case *it, int i)
{
    return it->of->tie[i] >= 0 && it->state[it->of->tie[i]] == ZD_CLOSED;
}

static double slip_bound(const zd_case *it, int i, int which)
{
    const zd_candidate *row = it->of->row + i;
    return row->bound[which] * (row->normal ? it->z[row->normal - 1] : 1);
}

double zd_case_total_bound(const zd_case *it, int i)
{
    double sum = slip_bound(it, i, 0);
    for (int k = i + 1; k < it->of->rows; k++)
        if (it->of->tie[k] == i && it->state[k] == ZD_CLOSED) sum += fabs(it->of->factor[k]) * slip_bound(it, k, 0);
    return sum;
}

int zd_case_has_pairs(const zd_case *it)
{
    for (int i = 0; i < it->of->rows; i++)
        if (it->of->row[i].pair && it->state[i] != ZD_OPEN) return 1;
    return 0;
}

/* Null vectors of W of normal rows; returns their number. */
static int find_normal_nulls(const zd_case *it, int count, const int *row, double *null)
{
    double W[ZD_MAX_CANDIDATES * ZD_MAX_CANDIDATES];
    for (int a = 0; a < count; a++)
        for (int c = 0; c < count; c++) W[a * count + c] = it->of->W[row[a] * it->of->rows + row[c]];
    return zd_equations_null_space(count, W, null);
}

int zd_case_normals_depend(const zd_case *it)
{
    double null[ZD_MAX_CANDIDATES * ZD_MAX_CANDIDATES];
    int row[ZD_MAX_CANDIDATES], normals = 0;
    for (; normals < it->of->rows && it->of->row[normals].normal < 0; normals++) row[normals] = normals;
    return find_normal_nulls(it, normals, row, null) > 0;
}

/* Normal forces that are not determined have the minimum norm, sum W_kk z_k^2. With null vectors n of their W, n . (W_kk z_k) = 0 is added
 * to dependent equations. */
static void add_min_norm(zd_case *it)
{
    const zd_contact_problem *of = it->of;
    double null[ZD_MAX_CANDIDATES * ZD_MAX_CANDIDATES];
    int normals = 0;
    while (normals < it->count && of->row[it->active[normals]].normal < 0) normals++;
    it->free_normals = find_normal_nulls(it, normals, it->active, null);
    for (const double *n = null; n < null + it->free_normals * normals; n += normals)
        for (int a = 0; a < normals; a++)
            for (int c = 0; c < normals; c++)
                it->A[a * it->count + c] += n[a] * n[c] * of->W[it->active[c] * (of->rows + 1)];
}

/* z and w with the present directions; 0: there are none. */
static int solve_with_directions(zd_case *it)
{
    const zd_contact_problem *of = it->of;
    const int n = of->rows;
    int count = 0;
    for (int i = 0; i < n; i++)
        if (it->state[i] == ZD_CLOSED && !zd_case_sticks_with_another(it, i)) it->active[count++] = i;
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
    it->free_normals = 0;
    if (it->of->is_min_norm) add_min_norm(it);
    if (!zd_equations_eliminate(count, it->A, it->x, it->column, &it->rank)) return 0;
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

/* ---- friction in two directions ---- */

int zd_case_has_unknown_direction(const zd_case *it, int i)
{
    const zd_candidate *row = it->of->row + i;
    return row->pair == 1 && zd_slides(it->state[i]) && (row->slides == ZD_OPEN || row->is_unknown);
}

/* Relative velocity or acceleration of a row at z. */
static double find_w(const zd_case *it, int i) { return it->of->b[i] + zd_dot(it->of->rows, it->of->W + (size_t)i * it->of->rows, it->z); }

/* One sweep of the projected Gauss-Seidel method over a pair of rows. */
static void sweep_pair(zd_case *it, int i)
{
    const zd_contact_problem *of = it->of;
    const zd_candidate *row = of->row + i;
    const int n = of->rows, is_given = row->slides != ZD_OPEN && !row->is_unknown;
    const double bound = slip_bound(it, i, 1), scale = of->W[i * n + i] + of->W[(i + 1) * n + i + 1];
    const double w[] = {find_w(it, i), find_w(it, i + 1)};
    double size = 1;
    for (int k = 0; k < 2; k++) it->z[i + k] = is_given ? -bound * of->direction[i + k] : it->z[i + k] - w[k] / scale;
    if (!is_given) size = zd_hypotenuse(it->z[i], it->z[i + 1]) / bound;
    for (int k = 0; k < 2 && size > 1; k++) it->z[i + k] = bound > 0 ? it->z[i + k] / size : 0;
}

void zd_case_estimate_directions(zd_case *it)
{
    const zd_contact_problem *of = it->of;
    zd_clear(of->rows, it->z);
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (int i = 0; i < of->rows; i++) {
            const double W = of->W[i * (of->rows + 1)];
            if (of->row[i].normal < 0 && of->row[i].slides == ZD_OPEN && W > 0) it->z[i] = fmax(0, it->z[i] - find_w(it, i) / W);
            else if (of->row[i].pair == 1) sweep_pair(it, i);
        }
    for (int i = 0; i < of->rows; i++) {
        const double size = of->row[i].pair == 1 ? zd_hypotenuse(it->z[i], it->z[i + 1]) : 0;
        if (!(size > 0) || of->direction[i] != 0 || of->direction[i + 1] != 0) continue;
        of->direction[i] = -it->z[i] / size, of->direction[i + 1] = -it->z[i + 1] / size;
    }
}

/* Initial directions: given ones, or those of b. */
static void begin_directions(zd_case *it)
{
    const zd_contact_problem *of = it->of;
    for (int i = 0; i < of->rows; i++) {
        it->e[i] = of->row[i].pair ? of->direction[i] : zd_slip_sign(it->state[i]);
        if (of->row[i].pair != 2 || it->e[i - 1] != 0 || it->e[i] != 0) continue;
        const double size = zd_hypotenuse(of->b[i - 1], of->b[i]);
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

/* r (count,) <- e x w of unknown directions */
static int find_residuals(zd_case *it, int count, const int *unknown, double *r)
{
    if (!solve_with_directions(it)) return 0;
    for (int k = 0; k < count; k++) r[k] = it->e[unknown[k]] * it->w[unknown[k] + 1] - it->e[unknown[k] + 1] * it->w[unknown[k]];
    return 1;
}

int zd_case_solve(zd_case *it)
{
    int unknown[MAX_PAIRS], count = 0;
    double r[MAX_PAIRS], turned[MAX_PAIRS], J[MAX_PAIRS * MAX_PAIRS];
    begin_directions(it);
    for (int i = 0; i < it->of->rows; i++)
        if (zd_case_has_unknown_direction(it, i)) unknown[count++] = i;
    for (int n = 0; n < ITERATIONS; n++) {
        double largest = 0;
        if (!find_residuals(it, count, unknown, r)) return 0;
        for (int k = 0; k < count; k++) largest = fmax(largest, fabs(r[k]));
        if (!(largest > DIRECTION * it->size)) return 1;
        for (int j = 0; j < count; j++) {
            turn(it->e + unknown[j], TURN);
            if (!find_residuals(it, count, unknown, turned)) return 0;
            turn(it->e + unknown[j], -TURN);
            for (int k = 0; k < count; k++) J[k * count + j] = (turned[k] - r[k]) / TURN;
        }
        for (int k = 0; k < count; k++) r[k] = -r[k];
        zd_equations_solve(count, J, r);
        for (int k = 0; k < count; k++) turn(it->e + unknown[k], fmax(-0.5, fmin(0.5, r[k])));
    }
    return 0;
}

int zd_case_has_sliding_pairs(const zd_case *it)
{
    for (int i = 0; i < it->of->rows; i++)
        if (it->of->row[i].pair && zd_slides(it->state[i])) return 1;
    return 0;
}

int zd_case_pairs_stick(zd_case *it)
{
    const zd_contact_problem *of = it->of;
    const int with_normals = !zd_case_has_sliding_pairs(it);
    int row[ZD_MAX_CANDIDATES], rows = 0, pairs = 0;
    double K[ZD_MAX_CANDIDATES * ZD_MAX_CANDIDATES];
    zd_distribution forces = {.contacts = 0};
    for (int i = 0; i < of->rows; i++) {
        if (of->row[i].normal >= 0 || it->state[i] != ZD_CLOSED) continue;
        int k = i + 1;      /* its friction */
        while (k < of->rows && (of->row[k].pair != 1 || of->row[k].normal != i + 1 || it->state[k] != ZD_CLOSED)) k++;
        const int sticks = k < of->rows;
        if (!with_normals && !sticks) continue;
        zd_distribution_add(&forces, it->z[i], with_normals, sticks ? it->z + k : NULL, sticks ? of->row[k].bound[0] : 0);
        if (with_normals) row[rows++] = i;
        for (int j = 0; j < 2 * sticks; j++) row[rows++] = k + j;
        pairs += sticks;
    }
    if (!pairs) return 1;
    for (int i = 0; i < rows; i++)
        for (int j = 0; j < rows; j++) K[i * rows + j] = of->W[row[i] * of->rows + row[j]];
    zd_distribution_find(&forces, K);
    it->free_forces = forces.nulls;
    for (int i = 0; i < rows; i++) it->z[row[i]] = forces.force[forces.component[i]];
    return forces.margin >= -ZD_SIGN_SHARE * zd_max_abs(3 * forces.contacts, forces.force);
}
