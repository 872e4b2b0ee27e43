/* The paper's four-bar mechanism with its crank driven: a third row of Phi prescribes alpha_1, and no degree of freedom is left.
 *
 *     Phi_3 = alpha_1 - (angle + rate t + amplitude sin(frequency t))
 *
 * It depends on time, so that Phi_t enters (5) and its rate (6). Its multiplier is minus the torque of the drive in N m, by which
 * energy comes in.
 */
#include "../include/zerodrift/sines.h"
#include "closed_form/driven_four_bar.h"
#include "four_bar.h"
#include "kind.h"
#include "precise/precise.h"
#include "series/series.h"

enum { N = ZD_FOUR_BAR_N, DRIVE = 2, ROWS = 3 };

typedef struct drive {
    double angle, rate;             /* rad, rad/s */
    double amplitude, frequency;    /* rad, rad/s */
} drive;

/* parameters, in the order of the table at the end */
typedef struct given {
    zd_four_bar_given bar;
    double amplitude, frequency;
} given;

typedef struct constants {
    zd_four_bar_constants bar;
    drive drive;
} constants;

static double drive_angle(const drive *u, double t) { return u->angle + u->rate * t + u->amplitude * zd_sin(u->frequency * t); }

static double drive_rate(const drive *u, double t) { return u->rate + u->amplitude * u->frequency * zd_cos(u->frequency * t); }

static double drive_acceleration(const drive *u, double t)
{
    return -u->amplitude * u->frequency * u->frequency * zd_sin(u->frequency * t);
}

static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const constants *k = data;
    const drive *u = &k->drive;
    int status = zd_four_bar_evaluate(&k->bar, want, t, p, v, out);
    if (want & ZD_PHI) out->Phi[DRIVE] = p[0] - drive_angle(u, t);                              /* (3) */
    if (want & ZD_C) memcpy(out->C + DRIVE * N, (double[N]){1}, N * sizeof(double));            /* (5) */
    if (want & ZD_PHI_T) memcpy(out->Phi_t, (double[ROWS]){[DRIVE] = -drive_rate(u, t)}, ROWS * sizeof(double));
    if (want & ZD_XI) out->xi[DRIVE] = drive_acceleration(u, t);                                /* (6) */
    return status;
}

_Static_assert(sizeof(constants) == ZD_DRIVEN_FOUR_BAR_CLOSED_FORM_BEGINS * sizeof(double), "where closed-form functions look for theirs");

static const char *prepare(const double *parameters, double *to)
{
    const given *q = (const given *)parameters;
    constants *k = (constants *)to;
    k->drive = (drive){q->bar.angle, q->bar.rate, q->amplitude, q->frequency};
    double *of_closed_form = to + ZD_DRIVEN_FOUR_BAR_CLOSED_FORM_BEGINS;
    zd_four_bar_fill(&q->bar, of_closed_form);
    memcpy(of_closed_form + ZD_FOUR_BAR_CLOSED_FORM, &k->drive, sizeof k->drive);
    zd_driven_four_bar_closed_form_constants(of_closed_form);
    return zd_four_bar_prepare(&q->bar, &k->bar);
}

static void start(const double *parameters, double *p, double *v)
{
    const given *q = (const given *)parameters;
    zd_four_bar_given bar = q->bar;
    bar.rate += q->amplitude * q->frequency;
    zd_four_bar_start(&bar, p, v);
}

static void draw(const double *data, const double *p, double *points)
{
    zd_four_bar_draw((const double *)&((const constants *)data)->bar, p, points);
}

static const zd_parameter parameter[] = {
    ZD_FOUR_BAR_PARAMETERS,
    {"crank_rate", "rad/s", "mean rate of alpha1", 1, ZD_ANY, (const double[]){1}},
    {"amplitude", "rad", "of what is added to the steady rotation: amplitude sin(frequency t)", 1, ZD_ANY, (const double[]){0.3}},
    {"frequency", "rad/s", "of what is added", 1, ZD_ANY, (const double[]){2}},
};

static const zd_variable constraint[] = {{"closure_x", "m"}, {"closure_y", "m"}, {"drive", "rad"}};

const zd_kind zd_driven_four_bar = {
    .card = {
        .name = "driven_four_bar",
        .summary = "The four-bar mechanism with its crank at a prescribed angle.",
        .equations = "section 4.1, (5)",
        .description = "The four-bar mechanism with a third constraint that prescribes the angle of its crank in time, so that "
                       "no degree of freedom is left. The multiplier of that constraint is minus the torque of the drive in N m, "
                       "by which energy comes in.",
        .reference = "W. Blajer, Elimination of constraint violation and accuracy aspects in numerical simulation of multibody "
                     "systems, Multibody System Dynamics 7 (2002) 265-284, section 4.1",
    },
    .system = {
        .nq = N, .nv = N, .mh = ROWS,
        .provides = ZD_M | ZD_BIAS | ZD_FORCE | ZD_PHI | ZD_C | ZD_PHI_T | ZD_XI | ZD_POTENTIAL,
        .scratch = ZD_FOUR_BAR_SCRATCH,
        .evaluate = evaluate,
        .series = &zd_driven_four_bar_series,
        .closed_form = zd_driven_four_bar_closed_form, .closed_forms = ZD_COUNT_OF_SETS,
    },
    ZD_PREPARED_DOUBLES(ZD_DRIVEN_FOUR_BAR_CLOSED_FORM_ENDS),
    .coordinate = zd_four_bar_coordinate, .velocity = zd_four_bar_velocity, .constraint = constraint,
    .points = N + 1, .dimension = 2, .draw = draw,
    .precise = &zd_driven_four_bar_precise,
};
