/* J changes within a step if a stiff force rotates with the bodies it acts on: for a bushing of stiffness k on a body of mass m that rotates
 * at omega, by k omega h. With one J for all stages, the iteration contracts by about (k / m) omega^2 h^4, which bounds the step more than
 * the motion does. With one J for each stage it does not.
 *
 * Where the state is (p, v) with pdot = v, and B = A^-1 / h, its equations for changes of the stages (x_i, y_i), and right sides (a_i, b_i),
 *
 *     sum_j B_ij x_j - y_i = a_i,    sum_j B_ij y_j - J_p,i x_i - J_v,i y_i = b_i,
 *
 * leave one system for all x_i: sum_j (B^2)_ij x_j - J_v,i sum_j B_ij x_j - J_p,i x_i = b_i + sum_j B_ij a_j - J_v,i a_i.
 *
 * For any other state x, which is in independent velocities, it is sum_j B_ij x_j - J_i x_i = a_i as it stands.
 */
#include "iteration.h"

#include <math.h>
#include <string.h>

#include "../../linalg/dense.h"

enum {
    STAGES = ZD_RADAU_STAGES,
    LARGEST_STATE = 200,    /* that is not (p, v): its matrix has three times as many rows */
};

zd_radau_stages zd_radau_stages_create(zd_arena *arena, int size)
{
    const size_t n = size, rows = STAGES * (size <= LARGEST_STATE ? n : n / 2);
    return (zd_radau_stages){
        .J = zd_arena_doubles(arena, STAGES * n * n),
        .factors = zd_arena_doubles(arena, rows * rows),
        .order = zd_arena_ints(arena, rows),
        .weight = zd_arena_doubles(arena, rows),
        .right = zd_arena_doubles(arena, rows),
        .change = zd_arena_doubles(arena, STAGES * n),
    };
}

int zd_radau_stages_serve(const zd_radau_matrices *matrices)
{
    return matrices->pairs > 0 || matrices->size <= LARGEST_STATE;
}

/* Unknowns of a stage */
static int count_unknowns(const zd_radau_matrices *matrices)
{
    return matrices->pairs > 0 ? matrices->pairs : matrices->size;
}

static void set_step(zd_radau_stages *self, double h)
{
    static const double Lambda[STAGES][STAGES] = {
        {ZD_RADAU_GAMMA, 0, 0},
        {0, ZD_RADAU_ALPHA, ZD_RADAU_BETA},
        {0, -ZD_RADAU_BETA, ZD_RADAU_ALPHA},
    };
    double part[STAGES][STAGES], inverse[STAGES][STAGES];       /* A^-1 */
    const double square = 1 / (h * h);
    zd_radau_transform(STAGES, Lambda, zd_radau_T_inverse[0], part[0]);
    zd_radau_transform(STAGES, zd_radau_T, part[0], inverse[0]);
    for (int i = 0; i < STAGES; i++)
        for (int j = 0; j < STAGES; j++) {
            self->B[i][j] = inverse[i][j] / h;
            self->BB[i][j] = square * (inverse[i][0] * inverse[0][j] + inverse[i][1] * inverse[1][j] + inverse[i][2] * inverse[2][j]);
        }
    self->h = h;
}

static double *row_of(const zd_radau_stages *self, int n, int stage, int i)
{
    return self->factors + (stage * n + i) * STAGES * n;
}

static void fill_row_of_pairs(const zd_radau_stages *self, const zd_radau_matrices *matrices, int stage, int i, double *row)
{
    const int n = matrices->pairs, size = matrices->size;
    const double *J_p = self->J + (stage * size + n + i) * size, *J_v = J_p + n, *inverse_slope = matrices->inverse_slope;
    for (int s = 0; s < STAGES; s++) {
        for (int j = 0; j < n; j++) row[s * n + j] = -(s == stage ? J_p[j] : 0) - self->B[stage][s] * inverse_slope[j] * J_v[j];
        row[s * n + i] += self->BB[stage][s] * inverse_slope[i];
    }
}

static void fill_row_of_any(const zd_radau_stages *self, const zd_radau_matrices *matrices, int stage, int i, double *row)
{
    const int size = matrices->size;
    const double *J = self->J + (stage * size + i) * size;
    for (int s = 0; s < STAGES; s++) {
        for (int j = 0; j < size; j++) row[s * size + j] = s == stage ? -J[j] : 0;
        row[s * size + i] += self->B[stage][s];
    }
}

/* A row of the matrix, multiplied by a power of two, so that rows compare */
static void fill_row(const zd_radau_stages *self, const zd_radau_matrices *matrices, int stage, int i)
{
    const int n = count_unknowns(matrices);
    double *row = row_of(self, n, stage, i), largest = 0;
    if (matrices->pairs > 0) fill_row_of_pairs(self, matrices, stage, i, row);
    else fill_row_of_any(self, matrices, stage, i, row);
    for (int j = 0; j < STAGES * n; j++) largest = fmax(largest, fabs(row[j]));
    int exponent = 0;
    (void)frexp(largest, &exponent);
    const double share = self->weight[stage * n + i] = ldexp(1, -exponent);
    for (int j = 0; j < STAGES * n; j++) row[j] *= share;
}

int zd_radau_stages_make(zd_radau_stages *self, zd_radau_matrices *matrices, const zd_rate *rate, double t, double h, const double *y,
                         const double *z, double *stage, double *f)
{
    const int n = count_unknowns(matrices), size = matrices->size;
    set_step(self, h);
    for (int s = 0; s < STAGES; s++) {
        for (int i = 0; i < size; i++) stage[i] = y[i] + z[s * size + i];
        int status = zd_radau_evaluate_J(matrices, rate, t + zd_radau_c[s] * h, h, stage, f, 0, self->J + s * size * size);
        if (status) return status;
        for (int i = 0; i < n; i++) fill_row(self, matrices, s, i);
    }
    return zd_lu_factor(STAGES * n, self->factors, self->order) == STAGES * n ? ZD_DONE : ZD_NO_STEP;
}

/* right <- b_i + sum_j B_ij a_j - J_v,i a_i, in units, of (a, b) in `change` */
static void combine(const zd_radau_stages *self, const zd_radau_matrices *matrices, double *right)
{
    const int n = matrices->pairs, size = matrices->size;
    const double *r = self->change, *inverse_unit = matrices->inverse_unit + n;
    for (int s = 0; s < STAGES; s++)
        for (int i = 0; i < n; i++) {
            const double *J_v = self->J + (s * size + n + i) * size + n;
            double sum = r[s * size + n + i] + self->B[s][0] * r[i] + self->B[s][1] * r[size + i] + self->B[s][2] * r[2 * size + i];
            sum *= inverse_unit[i];
            for (int j = 0; j < n; j++) sum -= J_v[j] * (r[s * size + j] * inverse_unit[j]);
            right[s * n + i] = sum * self->weight[s * n + i];
        }
}

/* Entries of the state after (p, v): the right side of (A^-1 / h) x_e = c + e_p x_p + e_v x_v */
static void follow(const zd_radau_stages *self, const zd_radau_matrices *matrices, double *x)
{
    const int size = matrices->size, n = 2 * matrices->pairs;
    for (int s = 0; s < STAGES; s++)
        for (int i = n; i < size; i++)
            for (int j = 0; j < n; j++) {
                const double e = self->J[(s * size + i) * size + j] * matrices->differences.unit[i];
                x[s * size + i] += e * (x[s * size + j] * matrices->inverse_unit[j]);
            }
}

static void solve_any(const zd_radau_stages *self, const zd_radau_matrices *matrices, double *x)
{
    const int n = matrices->size;
    double *r = self->change, *right = self->right;
    zd_radau_transform(n, zd_radau_T, x, r);
    for (int k = 0; k < STAGES * n; k++) right[k] = r[k] * matrices->inverse_unit[k % n] * self->weight[k];
    zd_lu_solve(STAGES * n, self->factors, self->order, right);
    for (int k = 0; k < STAGES * n; k++) r[k] = right[k] * matrices->differences.unit[k % n];
    zd_radau_transform(n, zd_radau_T_inverse, r, x);
}

static void solve_pairs(const zd_radau_stages *self, const zd_radau_matrices *matrices, double *x)
{
    const int n = matrices->pairs, size = matrices->size;
    const double *unit = matrices->differences.unit, a = ZD_RADAU_ALPHA / self->h, b = ZD_RADAU_BETA / self->h, norm = a * a + b * b;
    double *r = self->change, *p = self->right;
    zd_radau_transform(size, zd_radau_T, x, r);
    combine(self, matrices, p);
    zd_lu_solve(STAGES * n, self->factors, self->order, p);
    for (int i = 0; i < STAGES * n; i++) p[i] *= unit[i % n];
    for (int s = 0; s < STAGES; s++)
        for (int i = 0; i < n; i++) {
            r[s * size + n + i] = self->B[s][0] * p[i] + self->B[s][1] * p[n + i] + self->B[s][2] * p[2 * n + i] - r[s * size + i];
            r[s * size + i] = p[s * n + i];
        }
    follow(self, matrices, r);
    zd_radau_transform(size, zd_radau_T_inverse, r, x);
    for (int i = 2 * n; i < size; i++) {
        const double re = x[size + i], im = x[2 * size + i];
        x[i] *= self->h / ZD_RADAU_GAMMA;
        x[size + i] = (a * re - b * im) / norm;
        x[2 * size + i] = (a * im + b * re) / norm;
    }
}

void zd_radau_stages_solve(const zd_radau_stages *self, const zd_radau_matrices *matrices, double *x)
{
    if (matrices->pairs > 0) solve_pairs(self, matrices, x);
    else solve_any(self, matrices, x);
}

void zd_radau_stages_give_J(const zd_radau_stages *self, zd_radau_matrices *matrices)
{
    const size_t entries = matrices->size * matrices->size;
    memcpy(matrices->J, self->J + (STAGES - 1) * entries, entries * sizeof *matrices->J);
    matrices->has_J = 1;
    matrices->h = matrices->complex_h = 0;
}
