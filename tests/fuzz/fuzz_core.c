/* Fuzz target: bytes become a system, settings and states, mostly reasonable with some that are anything, and go through all that
 * zerodrift.h offers. Whatever they are, nothing crashes, leaks or runs on; a failure has a sentence; rows are finite, ordered in
 * time and on the constraints.
 *
 * With -DREPLAY it has a main of its own: `fuzz_core FILE...` replays inputs, `fuzz_core -random COUNT SEED` makes some up.
 */
#include <inttypes.h>
#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "zerodrift.h"

enum { LARGEST = 64, SIZES = 8, TIMES = 8, CALLS = 24, ITERATIONS = 60, MESSAGE = 320 };

#define EXPECT(condition) ((condition) ? (void)0 : fail(#condition, __LINE__))

static void fail(const char *what, int line)
{
    fprintf(stderr, "line %d: expected %s\n", line, what);
    abort();
}

/* ---- bytes ---- */

typedef struct input {
    const uint8_t *at;
    size_t left;
} input;

static unsigned byte(input *in)
{
    if (!in->left) return 0;
    in->left--;
    return *in->at++;
}

static int below(input *in, int n) { return (int)(byte(in) % (unsigned)n); }

static double number(input *in)
{
    static const double special[] = {0, -0.0, 1, -1, NAN, INFINITY, -INFINITY, DBL_MAX, -DBL_MAX, DBL_MIN, 5e-324, 1e-300, 1e-160,
                                     1e-16, 1e-12, 1e-8, 1e-3, 1e3, 1e8, 1e16, 1e100, 1e155, 1e300, 0x1p53, 1.5707963267948966};
    unsigned kind = byte(in);
    if (kind < 64) return special[kind % (sizeof special / sizeof special[0])];
    if (kind < 224) return ((int)byte(in) - 128) / 32.0;
    uint8_t raw[sizeof(double)];
    for (size_t i = 0; i < sizeof raw; i++) raw[i] = (uint8_t)byte(in);
    double x;
    memcpy(&x, raw, sizeof x);
    return x;
}

static int whole(input *in)
{
    static const int special[] = {-1, 0, 1, 2, 3, 7, 100, INT_MIN, INT_MAX};
    return special[below(in, sizeof special / sizeof special[0])];
}

static void spoil(input *in, double *x, int n)
{
    for (int k = below(in, 4); k > 0; k--) x[below(in, n)] = number(in);
}

/* ---- a system whose terms are whatever the bytes say; Phi is linear where pdot = v ---- */

typedef struct linear {
    zd_system system;
    double A[SIZES * SIZES], M[SIZES * SIZES], C[SIZES * SIZES], D[SIZES * SIZES];
    double d[SIZES], f[SIZES], Phi[SIZES], Phi_t[SIZES], xi[SIZES], gamma[SIZES], V[1], power[1];
    int crosses;        /* whether the one constraint is p_0 p_1 = 0 instead */
    int *calls;         /* until one fails; below 0: none does */
} linear;

static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const linear *self = data;
    const zd_system *system = &self->system;
    int nq = system->nq, nv = system->nv, m = system->mh + system->mn;
    (void)t;
    if ((*self->calls)-- == 0) return ZD_CALLBACK;
#define WRITE(term, field, count) \
    if (want & (term)) memcpy(out->field, self->field, (size_t)(count) * sizeof(double))
    WRITE(ZD_A, A, nq * nv);
    WRITE(ZD_M, M, nv * nv);
    WRITE(ZD_BIAS, d, nv);
    WRITE(ZD_FORCE, f, nv);
    WRITE(ZD_PHI, Phi, system->mh);
    WRITE(ZD_C, C, m * nv);
    WRITE(ZD_PHI_T, Phi_t, m);
    WRITE(ZD_XI, xi, m);
    WRITE(ZD_POTENTIAL, V, 1);
    WRITE(ZD_POWER, power, 1);
    WRITE(ZD_COMPLEMENT, D, nv * (nv - m));
    WRITE(ZD_GAMMA, gamma, nv);
#undef WRITE
    for (int k = 0; (want & ZD_PHI) && k < system->mh; k++)
        for (int i = 0; i < nq && i < nv; i++) out->Phi[k] += self->C[k * nv + i] * p[i];
    if (!self->crosses) return ZD_DONE;
    if (want & ZD_PHI) *out->Phi = p[0] * p[1];
    if (want & ZD_C) out->C[0] = p[1], out->C[1] = p[0];
    if (want & ZD_XI) *out->xi = -2 * v[0] * v[1];
    return ZD_DONE;
}

/* Two branches, and a motion along one of them through where they meet, or a start there. */
static void make_crossing(input *in, linear *self, double *p, double *v)
{
    self->system.nv = self->system.nq = 2 + below(in, SIZES - 1);
    self->system.mh = self->crosses = 1;
    self->system.mn = 0;
    self->system.provides = (self->system.provides & ~(ZD_A | ZD_PHI_T | ZD_COMPLEMENT | ZD_GAMMA)) | ZD_PHI | ZD_C | ZD_XI;
    memset(self->C, 0, sizeof self->C);
    p[1] = (byte(in) - 128.0) / 512;
    for (int i = below(in, 16) > 0; i < self->system.nv; i++) v[i] = below(in, 5) - 2;
}

static void make_linear(input *in, linear *self, int *calls, double *p, double *v)
{
    zd_system *system = &self->system;
    memset(self, 0, sizeof *self);
    *system = (zd_system){.nv = 1 + below(in, SIZES), .evaluate = evaluate, .data = self};
    system->nq = below(in, 4) ? system->nv : 1 + below(in, SIZES);
    system->mh = below(in, system->nv + 1);
    system->mn = below(in, 3) ? 0 : below(in, system->nv - system->mh + 1);
    int m = system->mh + system->mn;
    system->provides = ZD_M | (system->nq != system->nv ? ZD_A : 0) | (m ? ZD_C | ZD_XI : 0) | (system->mh ? ZD_PHI : 0);
    system->provides |= (int)((byte(in) << 8 | byte(in)) & (ZD_A | ZD_BIAS | ZD_FORCE | ZD_POTENTIAL | ZD_POWER));
    if (m && below(in, 4) == 0) system->provides |= ZD_PHI_T;
    if (below(in, 4) == 0) system->provides |= ZD_COMPLEMENT | ZD_GAMMA;
    memset(p, 0, LARGEST * sizeof *p);
    memset(v, 0, LARGEST * sizeof *v);
    if (below(in, 4) == 0) make_crossing(in, self, p, v);
    for (int i = 0; i < SIZES; i++) self->M[i * system->nv % (SIZES * SIZES) + i % system->nv] = 1 + below(in, 4);
    for (int i = 0; i < system->nq; i++) self->A[i * system->nv + i % system->nv] = 1;
    for (int i = 0; i < SIZES * SIZES; i++) self->C[i] = self->crosses ? 0 : below(in, 9) - 4, self->D[i] = below(in, 3) - 1;
    spoil(in, self->M, system->nv * system->nv);
    spoil(in, self->C, SIZES * SIZES);
    spoil(in, self->A, SIZES * SIZES);
    double *vectors[] = {self->d, self->f, self->Phi_t, self->xi, self->gamma, self->Phi};
    for (size_t k = 0; k < sizeof vectors / sizeof vectors[0]; k++) spoil(in, vectors[k], SIZES);
    *self->V = number(in), *self->power = number(in);
    *calls = below(in, 4) ? -1 : (int)byte(in);
    self->calls = calls;
    static const int impossible[] = {-1, 0, 9000, INT_MAX, INT_MIN};
    if (below(in, 32) == 0) (&system->nq)[below(in, 4)] = impossible[below(in, 5)];
    if (below(in, 32) == 0) system->provides &= (int)(byte(in) << 8 | byte(in));
    if (below(in, 64) == 0) system->evaluate = NULL;
    if (below(in, 64) == 0) system->scratch = whole(in);
}

/* One of the table, with its parameters and start as they come or spoiled; returns whether it can be made. */
static int make_kind(input *in, int row, zd_system *system, double *constants, double *p, double *v)
{
    const zd_kind *kind = zd_kind_of(row);
    double parameters[LARGEST];
    int n = 0;
    for (int i = 0; i < kind->parameters; i++)
        for (int j = 0; j < kind->parameter[i].size; j++) {
            EXPECT(n < LARGEST);
            parameters[n++] = kind->parameter[i].initial ? kind->parameter[i].initial[j] : (double)NAN;
        }
    static const double flat[] = {1, 0.3, 1, 0.3};
    if (row == 0 && below(in, 4) == 0) memcpy(parameters, flat, sizeof flat);     /* a parallelogram */
    spoil(in, parameters, n);
    EXPECT(kind->constants <= LARGEST);
    if (kind->prepare(parameters, constants)) return 0;
    kind->start(parameters, p, v);
    double points[3 * 2 * LARGEST];
    EXPECT(kind->points * kind->dimension <= (int)(sizeof points / sizeof points[0]));
    kind->draw(constants, p, points);
    *system = kind->system;
    system->data = constants;
    return 1;
}

/* ---- events: a coordinate, a velocity, the time or nothing passes a value ---- */

typedef struct events {
    zd_events core;
    int direction[SIZES], terminal[SIZES], what[SIZES], found[SIZES];
    double value[SIZES], last[SIZES], t0, t1;
    int calls;          /* until one fails; below 0: none does */
} events;

static int value_of_event(void *data, int event, double t, const double *p, const double *v, const double *x, double *value)
{
    (void)x;
    events *self = data;
    if (self->calls-- == 0) return ZD_CALLBACK;
    *value = (self->what[event] == 0 ? p[0] : self->what[event] == 1 ? v[0] : self->what[event] == 2 ? t : 0) - self->value[event];
    return ZD_DONE;
}

static int found_event(void *data, int event, double t, const double *p, const double *v)
{
    events *self = data;
    EXPECT(t > self->last[event] && t > self->t0 && t <= self->t1);
    EXPECT(isfinite(p[0]) && isfinite(v[0]));
    EXPECT(!self->terminal[event] || self->found[event] < self->terminal[event]);
    self->last[event] = t;
    self->found[event]++;
    return ZD_DONE;
}

static void make_events(input *in, events *self, const zd_settings *settings)
{
    memset(self, 0, sizeof *self);
    self->t0 = settings->t0, self->t1 = settings->t1;
    self->calls = below(in, 4) ? -1 : (int)byte(in);
    self->core = (zd_events){
        .count = below(in, 4), .direction = self->direction, .terminal = self->terminal, .data = self, .evaluate = value_of_event,
        .found = found_event,
    };
    for (int i = 0; i < SIZES; i++) {
        self->what[i] = below(in, 4);
        self->direction[i] = below(in, 3) - 1;
        self->terminal[i] = below(in, 4) ? 0 : below(in, 3);
        self->value[i] = below(in, 4) ? (byte(in) - 128.0) / 256 : number(in);
        self->last[i] = -INFINITY;
    }
    if (below(in, 32) == 0) self->core.count = whole(in);
    if (below(in, 32) == 0) self->core.evaluate = NULL;
    if (below(in, 32) == 0) self->core.direction = NULL;
    if (self->core.count > SIZES && self->core.count < INT_MAX) self->core.count = SIZES;
}

/* ---- settings ---- */

/* A value of a parameter: mostly one that its rule allows, else anything. */
static double value_of(input *in, const zd_parameter *parameter)
{
    int kind = below(in, 8);
    if (kind == 0) return number(in);
    if (kind < 4 || parameter->rule == ZD_COUNT) return parameter->initial[0];
    return parameter->rule == ZD_CHOICE || parameter->rule == ZD_SWITCH ? below(in, 2) : fabs(number(in));
}

static zd_parameter_values make_given(input *in, enum zd_table table, int row, int on)
{
    const zd_card *card = zd_entry_card(table, row);
    zd_parameter_values given = zd_initial(card);
    double *value = given.value;
    given.given = on;
    for (int i = 0; i < card->parameters; value += card->parameter[i++].size)
        if (below(in, 4) == 0) *value = value_of(in, &card->parameter[i]);
    double *iterations = zd_value_named(&given, card, "max_iterations"), *every = zd_value_named(&given, card, "every");
    if (iterations && *iterations > ITERATIONS) *iterations = ITERATIONS;
    if (every && below(in, 4) == 0) *every = 1 + below(in, 3);
    return given;
}

static int named(enum zd_table table, int row, const char *name) { return row == zd_entry_named(table, name); }

static zd_settings make_settings(input *in, double *times)
{
    unsigned how = byte(in);
    zd_settings settings = {
        .formulation = below(in, zd_entry_count(ZD_FORMULATIONS)), .integrator = below(in, zd_entry_count(ZD_INTEGRATORS)), .t1 = 0.5,
        .step = 0.05, .save_every = 1 + below(in, 3),
    };
    settings.of_formulation = make_given(in, ZD_FORMULATIONS, settings.formulation, 1);
    settings.of_integrator = make_given(in, ZD_INTEGRATORS, settings.integrator, 1);
    for (int row = 0; row < zd_entry_count(ZD_CORRECTIONS); row++)
        settings.correction[row] = make_given(in, ZD_CORRECTIONS, row, below(in, 8) < (named(ZD_CORRECTIONS, row, "projection") ? 7 : 3));
    if (how & 1) settings.steps = ZD_ADAPTIVE_STEPS, settings.rtol = 1e-6, settings.atol = 1e-9;
    if (how & 2) settings.t_eval = times, settings.t_evals = TIMES;
    settings.on_singular = below(in, 2) ? ZD_CONTINUE : ZD_STOP;
    for (int i = 0; i < TIMES; i++) times[i] = 0.5 * (i + 1) / TIMES;
    double *doubles[] = {&settings.t0, &settings.t1, &settings.step, &settings.rtol, &settings.atol, &settings.first_step,
                         &settings.max_step, times, times + 1, times + TIMES - 1};
    int *ints[] = {&settings.formulation, &settings.integrator};
    for (int k = below(in, 4); k > 0; k--) *doubles[below(in, sizeof doubles / sizeof doubles[0])] = number(in);
    if (below(in, 16) == 0) *ints[below(in, sizeof ints / sizeof ints[0])] = whole(in);
    if (below(in, 16) == 0) settings.save_every = whole(in);
    if (below(in, 16) == 0) settings.t_evals = below(in, TIMES + 1) - 1;
    return settings;
}

/* ---- what is done with them ---- */

static double *doubles(int64_t count) { return malloc((size_t)(count > 0 ? count : 1) * sizeof(double)); }

static zd_record make_record(const zd_system *system, int64_t capacity)
{
    int64_t m = system->mh + system->mn;
    int energy = (system->provides & ZD_POTENTIAL) != 0;
    zd_record record = {
        .capacity = capacity,
        .t = doubles(capacity), .p = doubles(capacity * system->nq), .v = doubles(capacity * system->nv),
        .multipliers = doubles(capacity * m), .position_violation = doubles(capacity * system->mh),
        .velocity_violation = doubles(capacity * m), .kinetic = doubles(capacity),
        .potential = energy ? doubles(capacity) : NULL, .input = energy ? doubles(capacity) : NULL,
        .energy_violation = energy ? doubles(capacity) : NULL,
        .iterations = malloc((size_t)(capacity + 1) * sizeof(int)),
        .energy_skipped = malloc((size_t)(capacity + 1) * sizeof(int)),
    };
    return record;
}

static void free_record(zd_record *record)
{
    double *all[] = {record->t, record->p, record->v, record->multipliers, record->position_violation, record->velocity_violation,
                     record->kinetic, record->potential, record->input, record->energy_violation};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) free(all[i]);
    free(record->iterations);
    free(record->energy_skipped);
}

static int are_finite(const double *x, int64_t n)
{
    for (int64_t i = 0; i < n; i++)
        if (!isfinite(x[i])) return 0;
    return 1;
}

static void check_rows(const zd_system *system, const zd_settings *settings, const double *sizes, const zd_record *record, double *last)
{
    const double rounding = 1 + 0x1p-51, smallest = 0x1p-1074;      /* of the division by the size, and where that underflows */
    const int row_of_projection = zd_entry_named(ZD_CORRECTIONS, "projection");
    const zd_card *card = zd_entry_card(ZD_CORRECTIONS, row_of_projection);
    zd_parameter_values projection = settings->correction[row_of_projection];
    int corrected = projection.given && *zd_value_named(&projection, card, "every") == 1 && *zd_value_named(&projection, card, "positions")
                 && strcmp(zd_entry_card(ZD_FORMULATIONS, settings->formulation)->name, "independent");
    EXPECT(record->samples <= record->capacity);
    EXPECT(are_finite(record->p, record->samples * system->nq));
    EXPECT(are_finite(record->v, record->samples * system->nv));
    for (int64_t row = 0; row < record->samples; row++) {
        EXPECT(record->t[row] > *last && record->t[row] >= settings->t0 && record->t[row] <= settings->t1);
        *last = record->t[row];
        for (int k = 0; corrected && *last > settings->t0 && k < system->mh; k++)
            EXPECT(fabs(record->position_violation[row * system->mh + k])
                   <= (*zd_value_named(&projection, card, "tol") * rounding + smallest) * sizes[k]);
    }
}

static void simulate(input *in, const zd_system *system, const zd_settings *settings, const double *p, const double *v)
{
    char message[MESSAGE];
    int status = 12345;
    zd_run *run = zd_run_create(system, settings, p, v, &status, message, sizeof message);
    EXPECT(!run == (status < 0) && !run == (message[0] != '\0'));
    if (!run) return;
    double last = -INFINITY, progress = 0;
    status = ZD_PAUSED;
    for (int call = 0; call < CALLS && (status == ZD_PAUSED || status == ZD_FULL); call++) {
        zd_record record = make_record(system, below(in, 12) + (settings->t_eval && below(in, 4) ? TIMES + 1 : 0));
        status = zd_run_advance(run, &record, 0);
        EXPECT(status <= ZD_FULL || (status == ZD_EVENT && settings->events));
        EXPECT((status < 0 || status == ZD_EVENT) == (zd_run_message(run)[0] != '\0'));
        check_rows(system, settings, zd_run_sizes(run), &record, &last);
        free_record(&record);
        double now = zd_run_progress(run);
        EXPECT(status < 0 || (now >= progress && now <= 1));
        progress = now;
    }
    EXPECT(status || settings->t_eval || last == settings->t1);
    zd_run_free(run);
}

/* Within one row and another that is not an end of its step: p and v become a state between them. */
static int states_between(const zd_system *system, const zd_settings *settings, double at, double *p, double *v, char *message, int size)
{
    const double t[] = {settings->t0, settings->t1};
    double rows_p[2 * LARGEST], rows_v[2 * LARGEST], energies[] = {0, 1};
    const int nq = system->nq > 0 && system->nq < LARGEST ? system->nq : 0, nv = system->nv > 0 && system->nv < LARGEST ? system->nv : 0;
    for (int i = 0; i < LARGEST; i++) rows_p[i] = rows_p[nq + i] = p[i], rows_v[i] = rows_v[nv + i] = v[i];
    const zd_saved saved = {2, t, rows_p, rows_v, energies, at > 1, 0};
    const double within = at > t[0] && at < t[1] ? at : t[0] + (t[1] - t[0]) / 2;
    return zd_states_between(system, settings, &saved, 1, &within, p, v, message, size);
}

static void operate(input *in, const zd_system *system, const zd_settings *settings, const double *p0, const double *v0)
{
    char message[MESSAGE];
    int size = below(in, 4) ? MESSAGE : 1 + below(in, 32), status;
    double p[LARGEST], v[LARGEST], vdot[LARGEST], multipliers[LARGEST];
    int hold_p[LARGEST] = {0}, hold_v[LARGEST] = {0}, iterations;
    memcpy(p, p0, sizeof p);
    memcpy(v, v0, sizeof v);
    for (int k = below(in, SIZES); k > 0; k--) hold_p[below(in, SIZES)] = hold_v[below(in, SIZES)] = 1;
    double t = below(in, 4) ? 0 : number(in);
    switch (below(in, 3)) {
    case 0:
        status = zd_accelerations(system, settings->formulation, settings->on_singular, 1, &t, p, v, vdot, multipliers, NULL, NULL, message,
                                  size);
        break;
    case 1:
        status = zd_project(system, settings, t, p, v, below(in, 2) ? hold_p : NULL, below(in, 2) ? hold_v : NULL,
                            below(in, 2) ? &iterations : NULL, message, size);
        break;
    default:
        status = states_between(system, settings, t, p, v, message, size);
        EXPECT(status || (are_finite(p, system->nq) && are_finite(v, system->nv)));
    }
    EXPECT(status <= 0 && (size == 1 || !status == (message[0] == '\0')) && memchr(message, '\0', (size_t)size));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    input in = {data, size};
    zd_system system;
    linear made;
    int calls, row = below(&in, 2 * zd_entry_count(ZD_SYSTEMS));
    double constants[LARGEST], p[LARGEST] = {0}, v[LARGEST] = {0}, times[TIMES];
    if (row < zd_entry_count(ZD_SYSTEMS)) {
        if (!make_kind(&in, row, &system, constants, p, v)) return 0;
    } else {
        make_linear(&in, &made, &calls, p, v);
        system = made.system;
    }
    zd_settings settings = make_settings(&in, times);
    events watched;
    if (below(&in, 3) == 0) make_events(&in, &watched, &settings), settings.events = &watched.core;
    if (below(&in, 2)) spoil(&in, p, SIZES);
    if (below(&in, 2)) spoil(&in, v, SIZES);
    if (below(&in, 2)) simulate(&in, &system, &settings, p, v);
    else operate(&in, &system, &settings, p, v);
    return 0;
}

#ifdef REPLAY

static uint64_t next(uint64_t *state)     /* xorshift */
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    return *state ^= *state << 17;
}

static int make_up(int64_t count, uint64_t seed)
{
    uint8_t data[1024];
    for (int64_t i = 0; i < count; i++) {
        uint64_t state = (seed + 1) * 0x9e3779b97f4a7c15u + (uint64_t)i * 0xbf58476d1ce4e5b9u + 1;
        size_t size = (size_t)(next(&state) % sizeof data);
        for (size_t k = 0; k < size; k++) data[k] = (uint8_t)(next(&state) >> 32);
        LLVMFuzzerTestOneInput(data, size);
    }
    printf("%" PRId64 " inputs\n", count);
    return 0;
}

int main(int argc, char **argv)
{
    if (argc == 4 && !strcmp(argv[1], "-random")) return make_up(atol(argv[2]), strtoull(argv[3], NULL, 10));
    for (int i = 1; i < argc; i++) {
        static uint8_t data[1 << 20];
        FILE *file = fopen(argv[i], "rb");
        if (!file) return perror(argv[i]), 1;
        LLVMFuzzerTestOneInput(data, fread(data, 1, sizeof data, file));
        fclose(file);
    }
    return 0;
}

#endif
