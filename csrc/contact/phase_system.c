/* The full system writes its constraints into scratch memory, from where the rows that are active are copied, holonomic ones first. Rows of
 * friction that sticks are constraints on velocities. Friction that slides is a force along its row: of a fixed size, or a user function u of
 * the load that it reads, for which the core solves together with the accelerations (motion/reactions.c):
 *
 *     f + C_s^T e u,     u = -mu N        power + u e C_s v
 *
 * e is the sign of the slip velocity s of one row, or the direction of that of two, s / |s|. Where s passes through zero, e must not change,
 * or no step could reach the instant at which friction begins to stick; and errors of a slow s must not turn it. So with d the direction at
 * the start of the step,
 *
 *     e = w / |w|,      w = s + slow d (1 - |s|^2 / (4 slow)^2)^4, within 4 slow,      with s + 2 |s . d| d in the place of s where s . d < 0
 *
 * Explicit steps h do not resolve ds/dt = -k s / |s| where k h > 2.7 |s|. With fixed steps, slow is hence a share of k h, and e at the end
 * of a step is d of the next one. Across a steady direction, this is stable with slow > k h / 2.7, and s becomes parallel to d:
 *
 *     ds/dt = -k (d + s / slow),      dd/dt = s / (slow h)
 */
#include "phase_system.h"

#include <math.h>
#include <string.h>

#include "../linalg/roots.h"

static const double FAST_SLIP = 4;          /* slip, in units of the slow one, that has left the start of sliding */
static const double REVERSED_COSINE = 1e-6; /* largest cosine of two directions of slip that have reversed */
enum { MAX_SLOW_STEPS = 30 };               /* steps with a slow slip after which it counts as reversed: it may then stick */

/* ---- memory of the full system's constraints ---- */

/* In scratch memory after that of the full system: C, Phi, Phi_t, xi. */
static double *C_in(const zd_phase_system *self, double *scratch) { return scratch + self->full->scratch; }
static double *Phi_in(const zd_phase_system *self, double *scratch) { return C_in(self, scratch) + self->size_of_C; }
static double *Phi_t_in(const zd_phase_system *self, double *scratch) { return Phi_in(self, scratch) + self->full->mh; }
static double *xi_in(const zd_phase_system *self, double *scratch) { return Phi_t_in(self, scratch) + zd_constraints(self->full); }

static zd_row_of_C row_in(const zd_phase_system *self, const double *C, int row)
{
    if (self->layout) return zd_packed_row(self->layout, C, row);
    return (zd_row_of_C){C + (size_t)row * self->full->nv, self->full->nv, NULL};
}

zd_row_of_C zd_phase_row(const zd_phase_system *self, int row) { return row_in(self, C_in(self, self->scratch), row); }
const double *zd_phase_Phi(const zd_phase_system *self) { return Phi_in(self, self->scratch); }
const double *zd_phase_Phi_t(const zd_phase_system *self) { return Phi_t_in(self, self->scratch); }
const double *zd_phase_xi(const zd_phase_system *self) { return xi_in(self, self->scratch); }

static zd_terms terms_in(const zd_phase_system *self, const zd_terms *out)
{
    zd_terms terms = *out;
    terms.C = C_in(self, out->scratch);
    terms.Phi = Phi_in(self, out->scratch);
    terms.Phi_t = Phi_t_in(self, out->scratch);
    terms.xi = xi_in(self, out->scratch);
    if (!self->full->reading) terms.inputs = NULL;
    return terms;
}

int zd_phase_evaluate(const zd_phase_system *self, int want, double t, const double *p, const double *v)
{
    const zd_system *full = self->full;
    const zd_terms own = {.scratch = self->scratch, .inputs = NULL}, terms = terms_in(self, &own);
    const int status = full->evaluate(full->data, (want & full->provides) | ZD_MOVED, t, p, v, &terms);
    if (!status && want & ZD_PHI_T && !(full->provides & ZD_PHI_T)) zd_clear(zd_constraints(full), terms.Phi_t);
    self->known->terms = self->known->parts = 0;
    return status;
}

int zd_phase_need(const zd_phase_system *self, int want, double t, const double *p, const double *v)
{
    zd_known_terms *known = self->known;
    const size_t size_p = self->full->nq * sizeof *p, size_v = self->full->nv * sizeof *v;
    int terms = known->terms;
    if (terms && (t != known->t || memcmp(p, known->p, size_p) || memcmp(v, known->v, size_v))) terms = 0;
    if ((terms & want) == want) return ZD_DONE;
    const int status = zd_phase_evaluate(self, want, t, p, v);
    if (status) return status;
    known->terms = terms | want;
    known->t = t;
    memcpy(known->p, p, size_p);
    memcpy(known->v, v, size_v);
    return ZD_DONE;
}

/* Slip velocity of a group, from constraints in scratch memory. */
static void slip_in(const zd_phase_system *self, double *scratch, int index, const double *v, double *slip)
{
    const zd_group *group = self->full->group + index;
    for (int i = 0; i < group->rows; i++) {
        const zd_row_of_C row = row_in(self, C_in(self, scratch), group->first + i);
        slip[i] = zd_row_times(&row, v) + Phi_t_in(self, scratch)[group->first + i];
    }
}

void zd_phase_slip(const zd_phase_system *self, int index, const double *v, double *slip) { slip_in(self, self->scratch, index, v, slip); }

/* e of the sliding friction of a group, (rows,) */
static void find_direction(const zd_phase_system *self, double *scratch, int index, const double *v, double *e)
{
    e[0] = zd_slip_sign(self->state[index]);
    if (self->full->group[index].rows == 1) return;
    const double *d = self->direction + 2 * index;
    double s[2];
    slip_in(self, scratch, index, v, s);
    const double slow = fmax(self->slow_slip, self->turning_slip[index]);
    const double along = s[0] * d[0] + s[1] * d[1], ratio = zd_hypotenuse(s[0], s[1]) / (4 * slow);
    const double left = fmax(0, 1 - ratio * ratio), added = slow * left * left * left * left - 2 * fmin(0, along);
    for (int i = 0; i < 2; i++) s[i] += added * d[i];
    const double size = zd_hypotenuse(s[0], s[1]);
    for (int i = 0; i < 2; i++) e[i] = size > 0 ? s[i] / size : 0;
}

int zd_phase_update_directions(const zd_phase_system *self, int is_start, double t, const double *p, const double *v)
{
    for (int g = 0; self->has_sliding_pairs && g < self->full->groups; g++) {
        if (self->full->group[g].rows != 2 || !zd_slides(self->state[g])) continue;
        const int status = zd_phase_need(self, ZD_C | ZD_PHI_T, t, p, v);
        if (status) return status;
        double s[2], *d = self->direction + 2 * g;
        zd_phase_slip(self, g, v, s);
        double size = zd_hypotenuse(s[0], s[1]);
        self->slow_steps[g] = is_start || size > self->slow_slip ? 0 : self->slow_steps[g] + 1;
        if (self->slow_steps[g] > MAX_SLOW_STEPS) self->bias[g] -= FAST_SLIP * self->slow_slip;
        if (size <= self->slow_slip || (!is_start && d[0] * s[0] + d[1] * s[1] <= REVERSED_COSINE * size)) continue;
        self->slip_speed[g] = size;
        if (!is_start && size > FAST_SLIP * self->slow_slip) self->bias[g] = 0;
        if (!is_start && self->turning_slip[g] > self->slow_slip) find_direction(self, self->scratch, g, v, s), size = 1;
        d[0] = s[0] / size, d[1] = s[1] / size;
    }
    return ZD_DONE;
}

double zd_phase_gap(const zd_phase_system *self, int index)
{
    const zd_group *group = self->full->group + index;
    return group->kind == ZD_ONE_WAY ? 0 : group->sign * (zd_phase_Phi(self)[group->first] - group->value);
}

double zd_phase_range_margin(const zd_phase_system *self, int index)
{
    const zd_group *group = self->full->group + index;
    if (!group->range) return INFINITY;
    const double x = zd_phase_Phi(self)[group->range - 1];
    return fmin(x - group->lower, group->upper - x);
}

/* ---- terms ---- */

static double fixed_force(const zd_phase_system *self, const zd_sliding *it)
{
    return -self->full->group[it->group].friction[1];
}

static double force_of(const zd_phase_system *self, const zd_sliding *it, const double *u)
{
    return it->input < 0 ? fixed_force(self, it) : u[it->input];
}

static void add_friction(const zd_phase_system *self, int want, const double *v, const zd_terms *out)
{
    for (const zd_sliding *it = self->sliding; it < self->sliding + self->slidings; it++) {
        const zd_group *group = self->full->group + it->group;
        double e[2];
        find_direction(self, out->scratch, it->group, v, e);
        for (int i = 0; i < group->rows; i++) {
            const zd_row_of_C row = row_in(self, C_in(self, out->scratch), group->first + i);
            const double force = force_of(self, it, out->inputs) * e[i];
            for (int j = 0; want & ZD_FORCE && j < row.count; j++) out->f[zd_column(&row, j)] += row.x[j] * force;
            if (want & ZD_POWER) *out->power += force * zd_row_times(&row, v);
        }
    }
}

static void copy_rows(const zd_phase_system *self, int want, const zd_terms *from, const zd_terms *out)
{
    const int mh = self->system.mh, m = zd_constraints(&self->system);
    double *C = out->C;
    for (int k = 0; k < m; k++) {
        const int row = self->row[k];
        if (want & ZD_PHI && k < mh) out->Phi[k] = from->Phi[row] - self->value[k];
        if (want & ZD_PHI_T) out->Phi_t[k] = from->Phi_t[row] - (k < mh ? 0 : self->value[k]);
        if (want & ZD_XI) out->xi[k] = from->xi[row];
        if (!(want & ZD_C)) continue;
        const zd_row_of_C stored = row_in(self, from->C, row);
        zd_copy_all(stored.count, stored.x, C);
        C += stored.count;
    }
}

static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const zd_phase_system *self = data;
    const zd_system *full = self->full;
    const zd_terms terms = terms_in(self, out);
    const int is_sliding = self->slidings && (want & (ZD_FORCE | ZD_POWER));
    const int all = want | (!is_sliding ? 0 : self->has_sliding_pairs ? ZD_C | ZD_PHI_T : ZD_C);
    const int status = full->evaluate(full->data, all & (full->provides | ZD_MOVED), t, p, v, &terms);
    if (status) return status;
    if (all & ZD_PHI_T && !(full->provides & ZD_PHI_T)) zd_clear(zd_constraints(full), terms.Phi_t);
    if (want & ZD_FORCE && !(full->provides & ZD_FORCE)) zd_clear(full->nv, out->f);
    if (want & ZD_POWER && !(full->provides & ZD_POWER)) *out->power = 0;
    copy_rows(self, want, &terms, out);
    if (is_sliding) add_friction(self, want, v, out);
    return ZD_DONE;
}

static void follow(const void *data, double *p)
{
    const zd_system *full = ((const zd_phase_system *)data)->full;
    full->follow(full->data, p);
}

static void times_A(const void *data, const zd_terms *terms, const double *x, double *y)
{
    const zd_system *full = ((const zd_phase_system *)data)->full;
    full->operations->times_A(full->data, terms, x, y);
}

static int magnitudes(const void *data, double t, const double *p, const double *v, double *magnitude, double *scratch)
{
    const zd_phase_system *self = data;
    double *all = scratch + self->full->magnitudes_scratch;
    const int status = self->full->magnitudes(self->full->data, t, p, v, all, scratch);
    for (int k = 0; k < zd_constraints(&self->system); k++) zd_copy_all(2, all + 2 * self->row[k], magnitude + 2 * k);
    return status;
}

static int force_magnitudes(const void *data, const double *inputs, double t, const double *p, const double *v, double *magnitude,
                            double *scratch)
{
    const zd_system *full = ((const zd_phase_system *)data)->full;
    return full->force_magnitudes(full->data, inputs, t, p, v, magnitude, scratch);
}

static int check_domain(const void *data, double rtol, double atol, double t, const double *p, const double *v, double *scratch)
{
    const zd_system *full = ((const zd_phase_system *)data)->full;
    return full->check_domain(full->data, rtol, atol, t, p, v, scratch);
}

static void compare(const void *data, double t, const double *p, const double *v, double *value, double *scratch)
{
    const zd_system *full = ((const zd_phase_system *)data)->full;
    full->switches->evaluate(full->data, t, p, v, value, scratch);
}

static void name_constraint(const void *names, int row, char *to, int size)
{
    const zd_phase_system *self = names;
    self->full->name_constraint(self->full->names, self->row[row], to, size);
}

/* ---- measures and loads ---- */

void zd_phase_expand(const zd_phase_system *self, double t, const double *p, const double *v, const double *lambda, const double *u,
                     double *all)
{
    const int status = self->has_sliding_pairs ? zd_phase_need(self, ZD_C | ZD_PHI_T, t, p, v) : ZD_DONE;
    for (int k = 0; k < zd_constraints(self->full); k++) all[k] = self->row_here[k] < 0 ? 0 : lambda[self->row_here[k]];
    for (const zd_sliding *it = self->sliding; it < self->sliding + self->slidings; it++) {
        const zd_group *group = self->full->group + it->group;
        double e[2];
        find_direction(self, self->scratch, it->group, v, e);
        for (int i = 0; i < group->rows; i++) all[group->first + i] = status ? NAN : -force_of(self, it, u) * e[i];
    }
    if (self->has_ties) zd_friction_distribute(self, all);
}

static int own_scratch(const zd_system *full) { return full->measures ? full->measures->scratch : 0; }

static int measure(const void *data, const double *inputs, int index, double t, const double *p, const double *v, const double *vdot,
                   const double *lambda, const zd_measured *out, double *scratch)
{
    const zd_phase_system *self = data;
    const zd_system *full = self->full;
    double *all = scratch + own_scratch(full);
    if (index >= zd_own_measures(full)) {       /* the multiplier of a constraint, of which loads are active ones */
        const int row = self->row_here[index - zd_own_measures(full)];
        out->value[0] = row < 0 ? 0 : lambda[row];
        return ZD_DONE;
    }
    if (lambda) zd_phase_expand(self, t, p, v, lambda, inputs, all);
    return full->measures->evaluate(full->data, inputs, index, t, p, v, vdot, lambda ? all : NULL, out, scratch);
}

/* Force of sliding friction, from the load that it reads. */
static int read_load(const void *data, int function, double t, const double *p, const double *v, const double *r, int is_same_state,
                     double *u, double *scratch)
{
    const zd_phase_system *self = data;
    const zd_reading *own = self->full->reading;
    const int count = own ? own->functions : 0;
    if (function < count) return own->evaluate(self->full->data, function, t, p, v, r, is_same_state, u, scratch);
    const zd_sliding *it = self->sliding;
    while (it->input != function) it++;
    const zd_group *group = self->full->group + it->group;
    const double load = zd_friction_load(self->full, group, r + it->reaction);
    *u = -group->friction[1] * load;
    return ZD_DONE;
}

/* ---- functions ---- */

static void list_measures(zd_phase_system *self)
{
    const zd_system *full = self->full;
    const int own = zd_own_measures(full), m = zd_constraints(full);
    if (own) memcpy(self->measure, full->measures->measure, own * sizeof *self->measure);
    for (int row = 0; row < m; row++) self->measure[own + row] = (zd_measure){"multiplier", "", 1, ZD_OF_ACCELERATIONS};
    self->measures = (zd_measures){own + m, self->measure, own_scratch(full) + m, measure};
    self->system.measures = &self->measures;
}

/* Functions of the full system, called with this system as their data; functions that need all of its rows are left out. */
void zd_phase_pass_functions(zd_phase_system *self)
{
    const zd_system *full = self->full;
    zd_system *system = &self->system;
    const int m = zd_constraints(system);
    list_measures(self);
    self->reading.evaluate = read_load;
    system->data = system->names = self;
    system->evaluate = evaluate;
    system->scratch += self->size_of_C + full->mh + 2 * zd_constraints(full);
    system->provides &= ~(ZD_COMPLEMENT | ZD_GAMMA | (system->mh ? 0 : ZD_PHI) | (m ? 0 : ZD_C | ZD_XI | ZD_PHI_T));
    if (self->slidings) system->provides |= ZD_FORCE;
    for (int k = system->mh; k < m; k++)
        if (self->value[k] != 0) system->provides |= ZD_PHI_T;
    if (full->provides & ZD_POTENTIAL) system->provides |= ZD_POWER;
    self->operations = (zd_operations){.times_A = times_A};
    system->operations = zd_brings_times_A(full) ? &self->operations : NULL;
    system->follow = full->follow ? follow : NULL;
    system->magnitudes = full->magnitudes ? magnitudes : NULL;
    system->magnitudes_scratch += 2 * zd_constraints(full);
    system->force_magnitudes = full->force_magnitudes ? force_magnitudes : NULL;
    system->check_domain = full->check_domain ? check_domain : NULL;
    system->name_constraint = full->name_constraint ? name_constraint : NULL;
    if (full->switches) {
        self->switches = (zd_switches){full->switches->count, full->switches->place, compare};
        system->switches = &self->switches;
    }
    system->groups = 0;
    system->embed = NULL;
    system->independent = NULL;
    system->closed_form = self->closed_forms ? self->closed_form : NULL;
    system->closed_forms = self->closed_forms;
    system->series = NULL;
    system->jacobian = NULL;
    system->residuals = NULL;
}
