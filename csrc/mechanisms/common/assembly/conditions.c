#include "problem.h"

#include <math.h>
#include <string.h>

#include "../../../linalg/small.h"
#include "../../../point/point.h"
#include "given.h"

static const double MIN_MASS = 1e-6;          /* relative to the largest mass, in the metric: mass of massless directions */
static const double OFTEN = 1e8;                /* operations between checks for an interruption: some 0.1 s */
static const double OF_DENSE = 10, OF_BLOCKS = 500;     /* operations of a step per product of its sizes */

/* ---- memory ---- */

static int widest_of(const zd_assembly_problem *given)
{
    int widest = 1;
    for (int i = 0; i < given->targets; i++) {
        const int size = given->system->measures->measure[given->target[i].measure].size;
        widest = size > widest ? size : widest;
    }
    return widest;
}

static zd_terms create_terms(zd_arena *arena, const zd_system *system, size_t m)
{
    return (zd_terms){.M = zd_arena_doubles(arena, zd_size_of_M(system)),
                      .C = zd_arena_doubles(arena, zd_size_of_C(system)), .Phi = zd_arena_doubles(arena, m),
                      .Phi_t = zd_arena_doubles(arena, m), .scratch = zd_arena_doubles(arena, system->scratch)};
}

static void create_steps(zd_arena *arena, zd_assembly *self, size_t n, size_t nq, size_t most)
{
    self->right = zd_arena_doubles(arena, most);
    self->x = zd_arena_doubles(arena, n);
    self->step = zd_arena_doubles(arena, n);
    self->moved = zd_arena_doubles(arena, n);
    double **positions[] = {&self->tried, &self->polished, &self->led, &self->begun, &self->found, &self->as_drawn, &self->drawn};
    for (size_t i = 0; i < sizeof positions / sizeof *positions; i++) *positions[i] = zd_arena_doubles(arena, nq);
}

/* Rows of the conditions, and what targets are read into: dense, or with the entries of their bodies alone */
static void create_rows(zd_arena *arena, zd_assembly *self, size_t n, size_t m, size_t targets)
{
    const zd_many_bodies *many = self->given->many;
    const size_t width = many ? 2 * (size_t)many->width : n, size_of_C = many ? (size_t)zd_size_of_C(self->system) : m * n;
    self->size_of_C = (int)size_of_C;
    self->layout = many ? zd_layout_create(arena, self->system) : NULL;
    self->C = many ? self->terms.C : zd_arena_doubles(arena, size_of_C);
    self->J = zd_arena_bytes(arena, (m + targets) * sizeof *self->J);
    self->entries = zd_arena_doubles(arena, size_of_C + targets * width);
    const size_t values = many ? targets : (size_t)self->widest;
    self->value = zd_arena_doubles(arena, values);
    self->jacobian = zd_arena_doubles(arena, values * width);
    self->which = zd_arena_bytes(arena, many ? 2 * targets * sizeof(int) : 0);
    self->at = zd_arena_bytes(arena, many ? 2 * targets * sizeof(int) : 0);
    self->column = zd_arena_bytes(arena, many ? width * targets * sizeof(int) : 0);
}

static void weigh(zd_assembly *self, const double *p);

static zd_assembly create(zd_arena *arena, const zd_assembly_problem *given)
{
    const zd_system *system = given->system;
    const size_t n = system->nv, m = zd_constraints(system), targets = given->targets, most = m + targets;
    const size_t measures = system->measures ? system->measures->scratch : 0;
    zd_assembly self = {
        .given = given, .system = system, .block = arena->base, .n = system->nv, .m = (int)m, .most = (int)most,
        .widest = widest_of(given), .solver = given->many ? &zd_assembly_sparse : &zd_assembly_dense,
        .terms = create_terms(arena, system, m), .at_rest = zd_arena_doubles(arena, n), .measures = zd_arena_doubles(arena, measures),
        .target = zd_arena_doubles(arena, targets), .scale = zd_arena_doubles(arena, n), .weight = zd_arena_doubles(arena, n),
        .r = zd_arena_doubles(arena, most), .start = zd_arena_doubles(arena, most), .of = zd_arena_ints(arena, most),
    };
    self.metric = given->many ? NULL : self.weight;
    self.terms.inputs = given->inputs;
    for (int i = 0; i < ZD_ROLE_SETS; i++) self.size[i] = zd_arena_doubles(arena, most);
    create_rows(arena, &self, n, m, targets);
    create_steps(arena, &self, n, system->nq, most);
    self.solver_data = self.solver->create(arena, &self);
    return self;
}

int zd_assembly_open(zd_assembly *self, const zd_assembly_problem *given, const double *p)
{
    zd_arena arena = {0};
    create(&arena, given);
    if (!zd_arena_allocate(&arena)) return ZD_NO_MEMORY;
    *self = create(&arena, given);
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

static void add_constraint(zd_assembly *self, int k, double residual)
{
    self->r[self->rows] = residual;
    if (!self->layout) {
        zd_copy_all(self->n, self->C + k * self->n, zd_assembly_begin_row(self, k, self->entries + self->rows * self->n, self->n, NULL));
        return;
    }
    const zd_row_of_C row = zd_packed_row(self->layout, self->C, k);
    zd_copy_all(row.count, row.x, zd_assembly_begin_row(self, k, self->entries + (row.x - self->C), row.count, row.column));
}

static void evaluate(zd_assembly *self, int terms, const double *p)
{
    const zd_system *system = self->system;
    terms &= system->provides;
    if (!terms) return;
    const int status = system->evaluate(system->data, terms | ZD_MOVED, self->given->t, p, self->at_rest, &self->terms);
    if (status && !self->status) self->status = status < 0 ? status : ZD_CALLBACK;
    if (!(terms & ZD_C) || !self->m || self->layout) return;
    if (system->structure) zd_expand(system, ZD_C, self->terms.C, self->C);
    else zd_copy_all(self->m * self->n, self->terms.C, self->C);
}

/* The square root of the mass metric, in scaled coordinates */
static void weigh(zd_assembly *self, const double *p)
{
    const zd_structure *structure = self->system->structure;
    const int *lengths = self->system->lengths ? self->system->lengths + self->system->nq : NULL;
    double largest = 0, *M = self->terms.M;
    evaluate(self, ZD_M, p);
    for (int i = 0, b = 0, in_block = 0; i < self->n; i++) {
        const int is_diagonal = structure && structure->mass && structure->mass[b] & ZD_DIAGONAL;
        const int width = structure ? structure->velocities[b] : self->n;
        const double mass = is_diagonal ? M[0] : M[in_block];
        M += is_diagonal ? 1 : width;
        if (++in_block == width) b++, in_block = 0;
        self->scale[i] = lengths && lengths[i] ? self->given->length : 1;
        self->weight[i] = mass * (self->scale[i] * self->scale[i]);
        largest = fmax(largest, self->weight[i]);
    }
    const double least = self->layout ? 0 : MIN_MASS * (largest > 0 ? largest : 1);     /* many bodies have mass */
    for (int i = 0; i < self->n; i++) self->weight[i] = sqrt(fmax(self->weight[i], least));
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
    for (int k = 0; k < self->rows; k++) {
        const zd_sparse_row *J = self->J + k;
        for (int j = 0; j < J->count; j++) J->x[j] *= self->scale[J->column ? J->column[j] : j];
    }
}

/* Keeps the chosen rows only. */
static void choose(zd_assembly *self, enum zd_assembly_choice choice)
{
    int count = 0;
    for (int k = 0; k < self->rows; k++) {
        const int is_target = self->of[k] >= self->m, role = is_target ? 0 : self->given->role[self->of[k]];
        if (!is_target && (role == ZD_ROLE_DRIVE ? choice != ZD_OF_ALL : role == ZD_ROLE_COUPLING && choice == ZD_OF_JOINTS)) continue;
        self->J[count] = self->J[k];
        self->of[count] = self->of[k];
        self->r[count++] = self->r[k];
    }
    self->rows = count;
}

/* Ends the assembly if it is interrupted; the check costs more than a step of few bodies. */
static void check_interruption(zd_assembly *self)
{
    const double rows = self->rows;
    self->work += self->layout ? OF_BLOCKS * rows * self->given->many->width : OF_DENSE * rows * rows * self->n;
    if (self->work < OFTEN || !self->given->interrupted) return;
    self->work = 0;
    if (self->given->interrupted(self->given->owner) && !self->status) self->status = ZD_CALLBACK;
}

double zd_assembly_find(zd_assembly *self, const zd_conditions *of, const double *p)
{
    evaluate(self, ZD_PHI | ZD_C, p);
    self->rows = 0;
    for (int k = 0; k < self->system->mh; k++)
        if (self->given->role[k] != ZD_ROLE_IGNORED) add_constraint(self, k, self->terms.Phi[k]);
    zd_assembly_add_targets(self, of->roles, 0, p);
    scale_rows(self);
    divide_by_sizes(self, of->roles);
    for (int k = 0; of->left > 0 && k < self->rows; k++) self->r[k] -= of->left * self->start[k];
    if (of->choice != ZD_OF_ALL) choose(self, of->choice);
    check_interruption(self);
    return self->status ? INFINITY : zd_largest(self->rows, self->r);
}

double zd_assembly_gap(zd_assembly *self, const double *p)
{
    double gap = 0;
    evaluate(self, ZD_PHI, p);
    for (int k = 0; k < self->system->mh; k++)
        if (self->given->role[k] != ZD_ROLE_IGNORED) gap = fmax(gap, isnan(self->terms.Phi[k]) ? INFINITY : fabs(self->terms.Phi[k]));
    return self->status ? INFINITY : gap;
}

void zd_assembly_find_rates(zd_assembly *self, int roles, const double *p)
{
    const int is_driven = (self->system->provides & ZD_PHI_T) != 0;
    evaluate(self, ZD_C | ZD_PHI_T, p);
    self->rows = 0;
    for (int k = 0; k < self->m; k++) add_constraint(self, k, is_driven ? self->terms.Phi_t[k] : 0);
    zd_assembly_add_targets(self, roles, 1, p);
    scale_rows(self);
}

/* ---- displacements ---- */

void zd_assembly_move(zd_assembly *self, const double *p, double longest, double *step, double *to)
{
    const double most = zd_largest(self->n, step), share = most > longest ? longest / most : 1;
    for (int i = 0; i < self->n; i++) {
        step[i] *= share;
        self->moved[i] = step[i] * self->scale[i];
    }
    zd_displace(self->system, p, self->moved, to);
}
