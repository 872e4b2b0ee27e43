/* Least reactions of redundant constraints.
 *
 * Multipliers are determined up to N z, with N a basis of the vectors for which C^T n = 0: they do not move anything. S maps multipliers to
 * the wrenches of all joints, inboard ones included, and relations. z minimizes |S (lambda + N z)| with moments divided by a length, so that
 * the choice depends neither on coordinates nor on the axes of the drawing.
 */
#include "output_spec.h"

#include <math.h>

#include "../../linalg/dense.h"
#include "../../linalg/small.h"

static const double DEPENDENT = 1e-8;       /* relative to the norm of a constraint: residual norm below which it is redundant */
static const double SINGULAR = 1e-11;       /* relative to the longest row of S N: residual norm below which one is redundant */
static const double ZERO_COLUMN = 1e-9;     /* norm below which a null vector, of multipliers of about 1, changes no wrench */
static const double ZERO_ROW = 1e-12;       /* relative to the longest constraint: norm below which one is zero */

typedef struct least_reactions {
    zd_row_space C, SN;
    int count;              /* null vectors */
    double total;           /* |S N| */
    double *N;              /* (count, m) */
    double *wrenches;       /* (rows,) weighted */
    double *z;              /* (m,) */
    double *norm;           /* (m,) of each constraint; 0: zero up to rounding */
} least_reactions;

static int rows_of_wrenches(const zd_measuring *self) { return ZD_WRENCH_SIZE * self->joints + 2 * self->elements->relations; }

static void create(least_reactions *to, zd_arena *arena, const zd_measuring *self)
{
    const int m = self->elements->m, rows = rows_of_wrenches(self);
    to->C = zd_row_space_create(arena, m, self->nv);
    to->SN = zd_row_space_create(arena, rows, m);
    to->N = zd_arena_doubles(arena, (size_t)m * m);
    to->wrenches = zd_arena_doubles(arena, rows);
    to->z = zd_arena_doubles(arena, m);
    to->norm = zd_arena_doubles(arena, m);
}

/* Magnitude of the entries that a marker quantity can have in a constraint */
static double largest_arm(const zd_measuring *self, int quantity)
{
    double wrench[ZD_WRENCH_SIZE] = {0};
    self->numerics->unit_wrench(self->readings->mechanism, self->readings->frame, quantity, wrench);
    const double pull = zd_dot(ZD_WRENCH_FORCE, wrench, wrench), turn = zd_dot(ZD_WRENCH_FORCE, wrench + 3, wrench + 3);
    return fmax(sqrt(pull) * fmin(self->elements->length, 1), sqrt(turn));
}

/* C (m, nv) <- constraints, each divided by its norm; norm (m,), 0 where one is zero up to rounding */
static int write_constraints(const zd_measuring *self, double t, double *C, double *norm)
{
    const zd_readings *of = self->readings;
    const zd_planned_elements *elements = self->elements;
    const int n = self->nv, m = elements->m;
    double longest = 0;
    for (int i = 0; i < m; i++) {
        zd_combined all;
        const zd_relation *row = elements->row + i;
        const int status = zd_combine(elements, of, row, t, &all);
        if (status) return ZD_CALLBACK;
        for (int k = 0; k < row->terms; k++) {
            self->numerics->write_row(of->mechanism, of->frame, elements->term[row->first + k].quantity, all.factors[k], self->row, NULL);
            zd_add_scaled(n, C + i * n, 1, self->row);
            longest = fmax(longest, fabs(all.factors[k]) * largest_arm(self, elements->term[row->first + k].quantity));
        }
        norm[i] = sqrt(zd_dot(n, C + i * n, C + i * n));
        longest = fmax(longest, norm[i]);
    }
    for (int i = 0; i < m; i++) {
        if (!(norm[i] > ZERO_ROW * longest)) norm[i] = 0;
        for (int j = 0; j < n; j++) C[i * n + j] = norm[i] > 0 ? C[i * n + j] / norm[i] : 0;
    }
    return ZD_DONE;
}

/* N <- null vectors of C^T: of row d the coefficients by which the independent rows give it */
static void write_null_vectors(least_reactions *of, int m)
{
    const zd_row_space *C = &of->C;
    for (int d = C->rank; d < m; d++) {
        double *vector = of->N + (d - C->rank) * m;
        zd_clear(m, vector);
        for (int k = C->rank - 1; k >= 0; k--) {
            double sum = C->A[d * C->n + k];
            for (int i = k + 1; i < C->rank; i++) sum -= C->A[i * C->n + k] * of->z[i];
            of->z[k] = sum / C->diagonal[k];
            vector[C->order[k]] = -of->z[k] / of->norm[C->order[k]];
        }
        vector[C->order[d]] = of->norm[C->order[d]] > 0 ? 1 / of->norm[C->order[d]] : 1;
    }
    of->count = m - C->rank;
}

/* size (2,) <- largest force, and moment about the centre of mass, that a relation puts on a body */
static int find_largest(const zd_measuring *self, const zd_measured_state *at, int relation, double *size)
{
    const zd_readings *of = self->readings;
    const zd_relation *row = self->elements->row + self->elements->constraint_of_relation[relation];
    const zd_quantity_term *term = self->elements->term + row->first;
    size[0] = size[1] = 0;
    for (int side = 0; side < 2 * row->terms; side++) {
        int of_side[2], body[2];
        double sum[ZD_WRENCH_SIZE] = {0}, force, wrench[2 * ZD_WRENCH_SIZE];
        self->numerics->unit_wrenches(of->mechanism, of->frame, term[side / 2].quantity, of_side, wrench);
        const int chosen = of_side[side % 2];
        for (int k = 0; k < row->terms && chosen; k++) {
            const int status = zd_drive_force(self->elements, of, relation, k, at->t, at->lambda, &force);
            if (status) return status;
            self->numerics->unit_wrenches(of->mechanism, of->frame, term[k].quantity, body, wrench);
            for (int i = 0; i < 2; i++)
                if (body[i] == chosen) zd_add_scaled(ZD_WRENCH_SIZE, sum, force, wrench + i * ZD_WRENCH_SIZE);
        }
        size[0] = fmax(size[0], sqrt(zd_dot(3, sum, sum)));
        size[1] = fmax(size[1], sqrt(zd_dot(3, sum + ZD_WRENCH_FORCE, sum + ZD_WRENCH_FORCE)));
    }
    return ZD_DONE;
}

/* to (rows,) <- wrenches of all joints, and the largest ones of relations without a joint, weighted; linear in the multipliers */
static int write_wrenches(const zd_measuring *self, const zd_measured_state *at, double *to)
{
    const zd_readings *of = self->readings;
    const zd_planned_elements *elements = self->elements;
    for (int joint = 0; joint < self->joints; joint++, to += ZD_WRENCH_SIZE) {
        memset(to, 0, ZD_WRENCH_SIZE * sizeof *to);
        const int status = self->numerics->reaction(of->mechanism, of->frame, joint, at, to);
        if (status) return status;
        for (int k = 0; k < self->numerics->torques; k++) to[ZD_WRENCH_FORCE + k] /= elements->length;
    }
    for (int i = 0; i < elements->relations; i++, to += 2) {
        const int row = elements->constraint_of_relation[i];
        double size[2] = {0, 0};
        const int status = elements->row[row].joint < 0 ? find_largest(self, at, i, size) : ZD_DONE;
        if (status) return status;
        to[0] = copysign(size[0], at->lambda[row]);
        to[1] = copysign(size[1], at->lambda[row]) / elements->length;
    }
    return ZD_DONE;
}

/* SN <- weighted wrenches of each null vector alone, a column each, and total <- |SN| */
static int write_columns(const zd_measuring *self, const zd_measured_state *at, least_reactions *of)
{
    const int m = self->elements->m, rows = rows_of_wrenches(self), count = of->SN.n = of->count;
    double sum = 0;
    for (int j = 0; j < count; j++) {
        const int status = write_wrenches(self, &(zd_measured_state){at->t, at->p, at->v, NULL, of->N + j * m, 2, NULL}, of->wrenches);
        const double square = zd_dot(rows, of->wrenches, of->wrenches);
        const int is_zero = square <= ZERO_COLUMN * ZERO_COLUMN;
        if (status) return status;
        if (is_zero) zd_clear(m, of->N + j * m);
        else sum += square;
        for (int i = 0; i < rows; i++) of->SN.A[i * count + j] = is_zero ? 0 : of->wrenches[i];
    }
    of->total = sqrt(sum);
    return ZD_DONE;
}

static int find_redundant(const zd_measuring *self, const zd_measured_state *at, least_reactions *of)
{
    const int m = self->elements->m;
    const int status = write_constraints(self, at->t, of->C.A, of->norm);
    if (status) return status;
    zd_row_space_factor(&of->C, m, DEPENDENT, 0.5 * DEPENDENT);
    write_null_vectors(of, m);
    return write_columns(self, at, of);
}

/* Memory of all arrays, to be released; NULL: there is none */
static void *allocate(least_reactions *of, const zd_measuring *self)
{
    zd_arena arena = {NULL, 0, NULL};
    create(of, &arena, self);
    void *memory = zd_allocate(arena.used);
    arena = (zd_arena){memory, 0, NULL};
    if (memory) create(of, &arena, self);
    return memory;
}

int zd_least_reactions(const zd_measuring *self, const zd_measured_state *at, double *to)
{
    const int m = self->elements->m;
    least_reactions of;
    void *memory = allocate(&of, self);
    if (!memory) return ZD_NO_MEMORY;
    int status = find_redundant(self, at, &of);
    zd_copy_all(m, at->lambda, to);
    if (!status && of.count) {
        status = write_wrenches(self, &(zd_measured_state){at->t, at->p, at->v, at->vdot, at->lambda, 2, at->efforts}, of.wrenches);
        zd_row_space_factor(&of.SN, rows_of_wrenches(self), SINGULAR, 0);
        zd_row_space_solve(&of.SN, of.wrenches, of.z);
        for (int j = 0; j < of.count && !status; j++) zd_add_scaled(m, to, -of.z[j], of.N + j * m);
    }
    zd_release(memory);
    return status;
}

int zd_redundant_multipliers(const zd_measuring *self, const zd_measured_state *at, double *N, int *count, double *total)
{
    least_reactions of;
    void *memory = allocate(&of, self);
    if (!memory) return ZD_NO_MEMORY;
    const int status = find_redundant(self, at, &of);
    *count = of.count, *total = of.total;
    if (!status) memcpy(N, of.N, (size_t)of.count * self->elements->m * sizeof *N);
    zd_release(memory);
    return status;
}
