#include "conditions.h"

#include <math.h>
#include <string.h>

#include "../../../linalg/small.h"
#include "../../../point/expand.h"
#include "../../../point/point.h"
#include "displacement.h"

static const double LEAST_MASS = 1e-6;          /* relative to the largest mass, in the metric: mass of massless directions */
static const double RANK = 1e-9;                /* relative to the longest row: bound below which rows are redundant */

/* ---- memory ---- */

static int widest_of(const zd_assembly_given *given)
{
    int widest = 1;
    for (int i = 0; i < given->targets; i++) {
        const int size = given->system->measures->measure[given->target[i].measure].size;
        widest = size > widest ? size : widest;
    }
    return widest;
}

static zd_terms take_terms(zd_arena *arena, const zd_system *system, size_t n, size_t m)
{
    return (zd_terms){.M = zd_take_doubles(arena, n * n), .C = zd_take_doubles(arena, m * n), .Phi = zd_take_doubles(arena, m),
                      .Phi_t = zd_take_doubles(arena, m), .scratch = zd_take_doubles(arena, (size_t)system->scratch)};
}

static void take_steps(zd_arena *arena, zd_assembly *self, size_t n, size_t nq, size_t most)
{
    const size_t fewer = most < n ? most : n;
    self->right = zd_take_doubles(arena, most);
    self->x = zd_take_doubles(arena, n);
    self->step = zd_take_doubles(arena, n);
    self->moved = zd_take_doubles(arena, n);
    double **positions[] = {&self->tried, &self->polished, &self->led, &self->begun, &self->found, &self->as_drawn, &self->drawn};
    for (size_t i = 0; i < sizeof positions / sizeof *positions; i++) *positions[i] = zd_take_doubles(arena, nq);
    self->square = zd_take_doubles(arena, fewer * fewer);
    self->factors = zd_take_doubles(arena, fewer * fewer + 2 * fewer);
}

static void weigh(zd_assembly *self, const double *p);

static zd_assembly take(zd_arena *arena, const zd_assembly_given *given)
{
    const zd_system *system = given->system;
    const size_t n = (size_t)system->nv, m = (size_t)zd_constraints(system), targets = (size_t)given->targets, most = m + targets;
    const size_t widest = (size_t)widest_of(given), measures = system->measures ? (size_t)system->measures->scratch : 0;
    zd_assembly self = {
        .given = given, .system = system, .block = arena->base, .n = system->nv, .m = (int)m, .most = (int)most, .widest = (int)widest,
        .terms = take_terms(arena, system, n, m),
        .at_rest = zd_take_doubles(arena, n), .measures = zd_take_doubles(arena, measures), .value = zd_take_doubles(arena, widest),
        .jacobian = zd_take_doubles(arena, widest * n), .target = zd_take_doubles(arena, targets),
        .scale = zd_take_doubles(arena, n), .weight = zd_take_doubles(arena, n), .C = zd_take_doubles(arena, m * n),
        .r = zd_take_doubles(arena, most), .J = zd_take_doubles(arena, most * n), .start = zd_take_doubles(arena, most),
        .of = zd_take(arena, most * sizeof(int)),
        .required = zd_row_space_take(arena, (int)most, system->nv), .wished = zd_row_space_take(arena, (int)targets, system->nv),
    };
    for (int i = 0; i < ZD_ROLE_SETS; i++) self.size[i] = zd_take_doubles(arena, most);
    take_steps(arena, &self, n, (size_t)system->nq, most);
    self.terms.inputs = given->inputs;
    return self;
}

int zd_assembly_open(zd_assembly *self, const zd_assembly_given *given, const double *p)
{
    zd_arena arena = {0};
    take(&arena, given);
    arena = (zd_arena){.base = zd_allocate(arena.used)};
    if (!arena.base) return ZD_NO_MEMORY;
    *self = take(&arena, given);
    for (int i = 0; i < given->targets; i++) self->target[i] = given->target[i].value;
    weigh(self, p);
    return ZD_DONE;
}

int zd_assembly_close(zd_assembly *self, int outcome)
{
    zd_release(self->block);
    return self->status ? self->status : outcome;
}

/* ---- evaluation ---- */

/* self->value and self->jacobian <- measure of a target */
static void read_target(zd_assembly *self, const zd_target *target, const double *p)
{
    const zd_measured out = {.value = self->value, .jacobian = self->jacobian};
    const zd_measures *all = self->system->measures;
    const int status = all->evaluate(self->system->data, self->given->inputs, target->measure, self->given->t, p, self->at_rest, NULL,
                                     NULL, &out, self->measures);
    if (status && !self->status) self->status = status < 0 ? status : ZD_CALLBACK;
}

/* Residuals and rows (not scaled) of the chosen targets, after those that there are */
static void add_targets(zd_assembly *self, int roles, int is_rate, const double *p)
{
    int last = -1;
    for (int i = 0; i < self->given->targets; i++) {
        const zd_target *target = self->given->target + i;
        if (!(roles & 1 << target->role) || target->is_rate != is_rate) continue;
        if (target->measure != last) read_target(self, target, p);
        last = target->measure;
        self->of[self->rows] = self->m + i;
        self->r[self->rows] = self->value[target->component] - self->target[i];
        zd_copy_all(self->n, self->jacobian + target->component * self->n, self->J + self->rows++ * self->n);
    }
}

static void evaluate(zd_assembly *self, int terms, const double *p)
{
    const zd_system *system = self->system;
    terms &= system->provides;
    if (!terms) return;
    const int status = system->evaluate(system->data, terms | ZD_MOVED, self->given->t, p, self->at_rest, &self->terms);
    if (status && !self->status) self->status = status < 0 ? status : ZD_CALLBACK;
    if (!(terms & ZD_C) || !self->m) return;
    if (system->structure) zd_expand(system, ZD_C, self->terms.C, self->C);
    else zd_copy_all(self->m * self->n, self->terms.C, self->C);
}

/* The square root of the mass metric, in scaled coordinates */
static void weigh(zd_assembly *self, const double *p)
{
    const zd_structure *structure = self->system->structure;
    double largest = 0, *M = self->terms.M;
    evaluate(self, ZD_M, p);
    for (int i = 0, b = 0, in_block = 0; i < self->n; i++) {
        const int is_diagonal = structure && structure->mass && structure->mass[b] & ZD_DIAGONAL;
        const int width = structure ? structure->velocities[b] : self->n;
        const double mass = is_diagonal ? M[0] : M[in_block];
        M += is_diagonal ? 1 : width;
        if (++in_block == width) b++, in_block = 0;
        self->scale[i] = self->given->is_angle[i] ? 1 : self->given->length;
        self->weight[i] = mass * (self->scale[i] * self->scale[i]);
        largest = fmax(largest, self->weight[i]);
    }
    for (int i = 0; i < self->n; i++) self->weight[i] = sqrt(fmax(self->weight[i], LEAST_MASS * (largest > 0 ? largest : 1)));
}

void zd_assembly_keep(zd_assembly *self, const double *p)
{
    for (int i = 0; i < self->given->targets; i++) {
        const zd_target *target = self->given->target + i;
        if (target->role != ZD_TARGET_STAYS || target->is_rate) continue;
        read_target(self, target, p);
        self->target[i] = self->value[target->component];
    }
}

int zd_assembly_has(const zd_assembly *self, enum zd_target_role role, int is_rate)
{
    int any = 0;
    for (int i = 0; i < self->given->targets; i++) {
        const zd_target *target = self->given->target + i;
        any |= target->role == (int)role && target->is_rate == is_rate;
    }
    return any;
}

double zd_assembly_length_of(const zd_assembly *self, int row)
{
    const double *J = self->J + row * self->n;
    return sqrt(zd_dot(self->n, J, J));
}

void zd_assembly_divide_row(zd_assembly *self, int row, double by)
{
    self->r[row] /= by;
    for (int i = 0; i < self->n; i++) self->J[row * self->n + i] /= by;
}

int zd_assembly_is_joint(const zd_assembly *self, int row)
{
    return self->of[row] < self->m && self->given->row[self->of[row]] == ZD_ROW_OF_JOINT;
}

/* In units of their sizes where this set of conditions was first evaluated: units must not change during a minimization. */
static void divide_by_sizes(zd_assembly *self, int roles)
{
    double *size = self->size[roles], largest = self->given->length;
    for (int k = 0; !self->is_known[roles] && k < self->rows; k++) {
        size[k] = zd_assembly_length_of(self, k);
        largest = fmax(largest, size[k]);
    }
    for (int k = 0; !self->is_known[roles] && k < self->rows; k++) size[k] = fmax(size[k], ZD_SMALLEST_SIZE * largest);
    self->is_known[roles] = 1;
    for (int k = 0; k < self->rows; k++) zd_assembly_divide_row(self, k, size[k]);
}

static void scale_rows(zd_assembly *self)
{
    for (int k = 0; k < self->rows; k++)
        for (int i = 0; i < self->n; i++) self->J[k * self->n + i] *= self->scale[i];
}

/* Keeps the chosen rows only. */
static void choose(zd_assembly *self, enum zd_assembly_choice choice)
{
    int count = 0;
    for (int k = 0; k < self->rows; k++) {
        const int is_target = self->of[k] >= self->m, owner = is_target ? 0 : self->given->row[self->of[k]];
        if (!is_target && (owner == ZD_ROW_OF_DRIVE ? choice != ZD_OF_ALL : owner == ZD_ROW_OF_COUPLING && choice == ZD_OF_JOINTS)) continue;
        if (count < k) zd_copy_all(self->n, self->J + k * self->n, self->J + count * self->n);
        self->of[count] = self->of[k];
        self->r[count++] = self->r[k];
    }
    self->rows = count;
}

double zd_assembly_find(zd_assembly *self, const zd_conditions *of, const double *p)
{
    evaluate(self, ZD_PHI | ZD_C, p);
    self->rows = 0;
    for (int k = 0; k < self->system->mh; k++) {
        if (self->given->row[k] == ZD_ROW_LEFT_OUT) continue;
        self->of[self->rows] = k;
        self->r[self->rows] = self->terms.Phi[k];
        zd_copy_all(self->n, self->C + k * self->n, self->J + self->rows++ * self->n);
    }
    add_targets(self, of->roles, 0, p);
    scale_rows(self);
    divide_by_sizes(self, of->roles);
    for (int k = 0; of->left > 0 && k < self->rows; k++) self->r[k] -= of->left * self->start[k];
    if (of->choice != ZD_OF_ALL) choose(self, of->choice);
    return self->status ? INFINITY : zd_largest(self->rows, self->r);
}

double zd_assembly_gap(zd_assembly *self, const double *p)
{
    double gap = 0;
    evaluate(self, ZD_PHI, p);
    for (int k = 0; k < self->system->mh; k++)
        if (self->given->row[k] != ZD_ROW_LEFT_OUT) gap = fmax(gap, isnan(self->terms.Phi[k]) ? INFINITY : fabs(self->terms.Phi[k]));
    return self->status ? INFINITY : gap;
}

void zd_assembly_find_rates(zd_assembly *self, int roles, const double *p)
{
    const int is_driven = (self->system->provides & ZD_PHI_T) != 0;
    evaluate(self, ZD_C | ZD_PHI_T, p);
    for (int k = 0; k < self->m; k++) {
        self->of[k] = k;
        self->r[k] = is_driven ? self->terms.Phi_t[k] : 0;
    }
    zd_copy_all(self->m * self->n, self->C, self->J);
    self->rows = self->m;
    add_targets(self, roles, 1, p);
    scale_rows(self);
}

/* ---- displacements ---- */

double zd_assembly_unit_of(const zd_assembly *self, int row, const double *weight)
{
    const double *J = self->J + row * self->n;
    double square = 0;
    for (int i = 0; weight && i < self->n; i++) square += J[i] / weight[i] * (J[i] / weight[i]);
    return square > 0 ? zd_assembly_length_of(self, row) / sqrt(square) : 1;
}

/* Rows of J from `first` on, by weights; `keeps`: with their lengths, as otherwise rows of light bodies would be so long that those of heavy
 * ones seem redundant */
static void weigh_rows(zd_assembly *self, int first, int count, const double *weight, int keeps, double *A, double *right)
{
    const int n = self->n;
    for (int k = 0; k < count; k++, A += n) {
        const double *row = self->J + (first + k) * n, unit = keeps ? zd_assembly_unit_of(self, first + k, weight) : 1;
        for (int i = 0; i < n; i++) A[i] = weight ? row[i] / weight[i] * unit : row[i] * unit;
        right[k] *= unit;
    }
}

/* x <- x + the step along the null space of the required rows on which the wished rows come nearest to `right` */
static void approach_wished(zd_assembly *self, int first, const double *weight, double *right, double *x)
{
    const int n = self->n, count = self->rows - first, rank = self->required.rank;
    double *A = self->wished.A, square = 0;
    weigh_rows(self, first, count, weight, 0, A, right);
    for (int k = 0; k < count; k++) {
        right[k] -= zd_dot(n, A + k * n, x);
        square += zd_dot(n, A + k * n, A + k * n);
        zd_row_space_turn(&self->required, A + k * n);
    }
    self->wished.n = n - rank;
    for (int k = 0; k < count; k++)
        for (int i = 0; i < n - rank; i++) A[k * (n - rank) + i] = A[k * n + rank + i];
    zd_row_space_factor(&self->wished, count, 0, RANK * sqrt(square * (n - rank)));
    double *y = self->moved;
    for (int i = 0; i < rank; i++) y[i] = 0;
    zd_row_space_solve(&self->wished, right, y + rank);
    zd_row_space_turn_back(&self->required, y);
    zd_add_scaled(n, x, 1, y);
}

void zd_assembly_solve(zd_assembly *self, int required, const double *right, const double *weight, double *x)
{
    for (int k = 0; k < self->rows; k++) self->right[k] = right[k];
    weigh_rows(self, 0, required, weight, 1, self->required.A, self->right);
    zd_row_space_factor(&self->required, required, RANK, 0);
    zd_row_space_solve(&self->required, self->right, x);
    if (required < self->rows) approach_wished(self, required, weight, self->right + required, x);
    for (int i = 0; weight && i < self->n; i++) x[i] /= weight[i];
}

void zd_assembly_move(zd_assembly *self, const double *p, double longest, double *step, double *to)
{
    const double most = zd_largest(self->n, step), share = most > longest ? longest / most : 1;
    for (int i = 0; i < self->n; i++) {
        step[i] *= share;
        self->moved[i] = step[i] * self->scale[i];
    }
    zd_displace(self->system, p, self->moved, to);
}
