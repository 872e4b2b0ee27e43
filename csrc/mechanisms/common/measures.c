/* Measures are marker quantities with their first and second derivatives, reactions of joints, and forces of springs and drives. */
#include "output_spec.h"

#include <math.h>

#include "../../linalg/small.h"
#include "../../workspace.h"

/* Places the frame at the state, and moves it if twists are needed, unless the previous call has done so. */
static void place_and_move(const zd_measuring *self, int is_same_state, int needs_twists, const zd_measured_state *at)
{
    const zd_readings *of = self->readings;
    if (!is_same_state) *self->is_placed = 0;
    if (is_same_state != 1) *self->is_moving = *self->is_least = 0;
    if (*self->is_placed == 0) self->numerics->place(of->mechanism, of->frame, at->p);
    *self->is_placed = 1;
    if (*self->is_moving != 0 || !needs_twists) return;
    self->numerics->move(of->mechanism, of->frame, at->v);
    *self->is_moving = 1;
}

/* Component i of a measure that is a marker quantity or one of its first two derivatives. */
static void measure_quantity(const zd_measuring *self, const zd_output_spec *measure, int i, const zd_measured_state *at,
                             const zd_measured *out)
{
    const zd_readings *of = self->readings;
    const int quantity = measure->index + i, is_value = measure->kind == ZD_VALUES, is_acceleration = measure->kind == ZD_ACCELERATIONS;
    const double s = measure->scale;
    const double rate = !is_value || out->rate ? zd_rate_of(of, quantity) : 0;
    const double bias = is_acceleration || out->bias ? self->numerics->bias(of->mechanism, of->frame, quantity) : 0;
    double *row = is_acceleration ? self->row : out->jacobian ? out->jacobian + i * self->nv : NULL;
    double value = rate, *read = is_value && out->value ? &value : NULL;
    if (row) self->numerics->write_row(of->mechanism, of->frame, quantity, s, row, read);
    else if (read) value = zd_value_of(of, quantity);
    if (out->value) out->value[i] = is_acceleration ? s * bias + zd_dot(self->nv, row, at->vdot) : s * value;
    if (is_acceleration) return;
    if (out->rate && is_value) out->rate[i] = s * rate;
    if (out->bias) out->bias[i] = s * bias;
}

static double inner(int n, const double *a, const double *b)
{
    double sum = a[0] * b[0];
    for (int k = 1; k < n; k++) sum += a[k] * b[k];
    return sum;
}

/* Force of a joint between two points along the line that joins them, positive in tension. */
static int measure_tension(const zd_measuring *self, int joint, const zd_measured_state *at, double *value)
{
    const zd_readings *of = self->readings;
    const int n = self->numerics->forces;
    double wrench[ZD_WRENCH_SIZE], apart[ZD_WRENCH_FORCE];
    const int status = self->numerics->reaction(of->mechanism, of->frame, joint, at, wrench);
    self->numerics->apart(of->mechanism, of->frame, joint, apart);
    *value = -inner(n, wrench, apart) / sqrt(inner(n, apart, apart));
    return status;
}

/* Sum of the forces or torques of `size` generalized forces from measure->index on, on their second body. */
static int measure_forces(const zd_measuring *self, const zd_output_spec *measure, double t, double *value)
{
    const zd_readings *of = self->readings;
    const int is_force = measure->kind == ZD_FORCE_SUM, n = is_force ? self->numerics->forces : self->numerics->torques;
    int status = ZD_DONE;
    zd_clear(n, value);
    for (int i = measure->index; i < measure->index + measure->size && !status; i++) {
        double force = 0, wrench[ZD_WRENCH_SIZE];
        status = zd_force_evaluate(self->elements, of, self->elements->force + i, t, &force, NULL);
        self->numerics->unit_wrench(of->mechanism, of->frame, self->elements->force[i].quantity, wrench);
        for (int k = 0; k < n; k++) value[k] += force * wrench[is_force ? k : ZD_WRENCH_FORCE + k];
    }
    return status;
}

static int measure_reaction(const zd_measuring *self, const zd_output_spec *measure, const zd_measured_state *at, double *value)
{
    const zd_readings *of = self->readings;
    const int is_torque = measure->kind == ZD_JOINT_TORQUE, n = is_torque ? self->numerics->torques : self->numerics->forces;
    double wrench[ZD_WRENCH_SIZE] = {0}, r[ZD_WRENCH_FORCE] = {0}, *F = wrench;
    int status = self->numerics->reaction(of->mechanism, of->frame, measure->index, at, wrench);
    for (int i = 1; !is_torque && i <= measure->term && !status; i++) {
        double more[ZD_WRENCH_SIZE] = {0};
        status = self->numerics->reaction(of->mechanism, of->frame, measure->index + i, at, more);
        for (int k = 0; k < ZD_WRENCH_FORCE; k++) F[k] += more[k];
    }
    if (is_torque && measure->term) self->numerics->apart(of->mechanism, of->frame, measure->index, r);
    const double moment[] = {r[1] * F[2] - r[2] * F[1], r[2] * F[0] - r[0] * F[2], r[0] * F[1] - r[1] * F[0]};
    for (int k = 0; k < n; k++) value[k] = is_torque ? F[ZD_WRENCH_FORCE + k] + moment[n == 1 ? 2 : k] : F[k];
    return status;
}

/* Value of a user function of components of other measures, whose multipliers are those of the least reactions already. */
static int measure_formula(const zd_measuring *self, const zd_output_spec *measure, const zd_measured_state *at, double *value)
{
    const zd_quantity_term *term = self->elements->term + measure->term;
    double x[ZD_MAX_READS], read[ZD_MAX_COMPONENTS] = {0};
    int status = ZD_DONE;
    for (int i = 0; i < measure->size && !status; i++) {
        status = zd_measures_evaluate(self, term[i].quantity, at, &(zd_measured){.value = read, .is_least = 1, .is_same_state = 1});
        x[i] = read[(int)term[i].coefficient];
    }
    return status ? status : zd_law_evaluate(self->elements, self->readings, measure->index, measure->size, x, at->t, value);
}

static int measure_force(const zd_measuring *self, const zd_output_spec *measure, const zd_measured_state *at, double *value)
{
    switch (measure->kind) {
    case ZD_FORMULA: return measure_formula(self, measure, at, value);
    case ZD_JOINT_TENSION: return measure_tension(self, measure->index, at, value);
    case ZD_FORCE_VALUE:
    case ZD_FORCE_POWER: return zd_output_force(self->elements, self->readings, measure, at->t, value);
    case ZD_FORCE_SUM:
    case ZD_TORQUE_SUM: return measure_forces(self, measure, at->t, value);
    case ZD_DRIVE_VALUE:
    case ZD_DRIVE_POWER: return zd_output_drive(self->elements, self->readings, measure, at->t, at->lambda, value);
    default: return measure_reaction(self, measure, at, value);
    }
}

static int depends_on_multipliers(const zd_measuring *self, int kind)
{
    return self->elements->m && (kind < ZD_FORCE_VALUE || kind == ZD_DRIVE_VALUE || kind == ZD_DRIVE_POWER || kind == ZD_FORMULA);
}

/* self->least <- multipliers of the least reactions, unless the previous call has done so; with many constraints, those given */
static int find_least(const zd_measuring *self, const zd_measured_state *at)
{
    const int m = self->elements->m;
    if (*self->is_least != 0) return ZD_DONE;
    int status = ZD_DONE;
    if (m <= ZD_MAX_LEAST) status = zd_least_reactions(self, at, self->least);
    else zd_copy_all(m, at->lambda, self->least);
    *self->is_least = !status;
    return status;
}

/* redundant (size, m) <- changes of a measure by redundant multipliers, relative to the norm of those of all wrenches */
static int find_changes(const zd_measuring *self, const zd_output_spec *measure, const zd_measured_state *at, int size, double *redundant)
{
    const int m = self->elements->m;
    const double unit = strcmp(measure->unit, "N m") ? 1 : self->elements->length;
    double change[ZD_WRENCH_SIZE], total, *N = zd_allocate(sizeof(double) * m * (size_t)m);
    int count;
    if (!N) return ZD_NO_MEMORY;
    memset(redundant, 0, (size_t)size * m * sizeof *redundant);
    int status = zd_redundant_multipliers(self, at, N, &count, &total);
    for (int j = 0; j < count && total > 0 && !status; j++) {
        status = measure_force(self, measure, &(zd_measured_state){at->t, at->p, at->v, NULL, N + j * m, 1, NULL}, change);
        for (int k = 0; k < size; k++) redundant[k * m + j] = change[k] / (unit * total);
    }
    zd_release(N);
    return status;
}

/* redundant (m,) <- sum of the changes of what a formula reads */
static int find_changes_of_formula(const zd_measuring *self, const zd_output_spec *measure, const zd_measured_state *at, double *redundant)
{
    const int m = self->elements->m;
    const size_t size = sizeof(double) * ZD_MAX_COMPONENTS * (size_t)m;
    double *change = zd_allocate(size);
    int status = change ? ZD_DONE : ZD_NO_MEMORY;
    zd_clear(m, redundant);
    for (const zd_quantity_term *term = self->elements->term + measure->term, *end = term + measure->size; term < end && !status; term++) {
        memset(change, 0, size);
        status = zd_measures_evaluate(self, term->quantity, at, &(zd_measured){.redundant = change, .is_least = 1, .is_same_state = 1});
        for (int j = 0; j < m; j++) redundant[j] += fabs(change[(int)term->coefficient * m + j]);
    }
    zd_release(change);
    return status;
}

/* Results of a measure of forces */
static int measure_with_least(const zd_measuring *self, const zd_output_spec *measure, const zd_measured_state *at, const zd_measured *out)
{
    const int size = zd_output_size(measure, self->numerics->forces, self->numerics->torques);
    zd_measured_state of = *at;
    const int is_of_multipliers = depends_on_multipliers(self, measure->kind);
    int status = ZD_DONE;
    if (!out->is_least && is_of_multipliers) {
        status = find_least(self, at);
        of.lambda = self->least;
    }
    if (!status && out->redundant && is_of_multipliers)
        status = measure->kind == ZD_FORMULA ? find_changes_of_formula(self, measure, &of, out->redundant)
                                             : find_changes(self, measure, at, size, out->redundant);
    if (status || !out->value) return status;
    status = measure_force(self, measure, &of, out->value);
    for (int i = 0; i < size; i++) out->value[i] *= measure->scale;
    return status;
}

int zd_measures_evaluate(const zd_measuring *self, int measure, const zd_measured_state *at, const zd_measured *out)
{
    const zd_output_spec *output = self->elements->output + measure;
    if (!zd_output_is_available(self->elements, output, at->vdot, at->lambda)) return ZD_BAD_ARGUMENT;
    place_and_move(self, out->is_same_state, output->kind != ZD_VALUES || out->rate || out->bias, at);
    if (out->least) {
        const int status = at->lambda ? find_least(self, at) : ZD_BAD_ARGUMENT;
        if (!status) zd_copy_all(self->elements->m, self->least, out->least);
        return status;
    }
    if (output->kind <= ZD_ACCELERATIONS) {
        for (int i = 0; i < output->size; i++) measure_quantity(self, output, i, at, out);
        return ZD_DONE;
    }
    switch (output->kind) {
    case ZD_SUM:
    case ZD_SUM_OF_RATES:
    case ZD_SUM_OF_ACCELERATIONS: zd_sum_measure(self, output, at, out); return ZD_DONE;
    case ZD_ANGULAR_MOMENTUM:
    case ZD_INERTIA_TORQUE:
        if (out->value) zd_momentum_measure(self, output, at, out->value);
        return ZD_DONE;
    default: return measure_with_least(self, output, at, out);
    }
}

int zd_measures_read(const zd_measuring *self, int law, const zd_measured_state *at, const double *r, int is_same_state, double *u)
{
    place_and_move(self, is_same_state, 1, at);
    return zd_force_read(self->elements, self->readings, law, at->t, r, u);
}
