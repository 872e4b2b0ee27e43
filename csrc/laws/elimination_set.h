/* Closed-form functions by programs, of ZD_UNIT and ZD_LANES: elimination.c includes this text for each set of zerodrift/units.h. */
#include "../include/zerodrift/lanes.h"

/* ---- instructions ---- */

/* Sines, then cosines of the angles of n instructions. */
ZD_ON_UNIT static void ZD_NAMED(find_sines)(int n, const zd_instruction *of, const zd_real *value, zd_real *to)
{
    zd_real angle[ZD_PADDED(ZD_SINES_AT_ONCE)], sine[ZD_PADDED(ZD_SINES_AT_ONCE)], cosine[ZD_PADDED(ZD_SINES_AT_ONCE)];
    for (int i = 0; i < ZD_PADDED(n); i++) angle[i] = value[of[i < n ? i : 0].a];
    ZD_SINES(n, angle, sine, cosine);
    for (int i = 0; i < n; i++) {
        to[i] = sine[i];
        to[n + i] = cosine[i];
    }
}

/* An operation that takes the lanes in turn. */
ZD_ON_UNIT static zd_real ZD_NAMED(operate)(enum zd_code code, const zd_real *a, const zd_real *b, const zd_real *c)
{
    zd_real found = *a;
    for (int lane = 0; lane < ZD_LANES; lane++)
        ZD_LANE(found, lane) = zd_operation(code, ZD_LANE(*a, lane), ZD_LANE(*b, lane), ZD_LANE(*c, lane));
    return found;
}

/* Runs a program to its end; values go to `to` and the places after it, within the frame `value`. */
#define ZD_A value[next->a]
#define ZD_B value[next->b]
#define ZD_C value[next->c]
#if defined(__GNUC__)
#define ZD_NEXT goto *label[next->code]
#define ZD_VALUE(x) *to++ = (x); next++; ZD_NEXT
ZD_ON_UNIT ZD_THREADED static void ZD_NAMED(run)(const zd_instruction *next, zd_real *value, zd_real *to)
{
    static const void *const label[ZD_PROGRAM_CODES] = {
        &&plus, &&minus, &&times, &&over, &&negative, &&other, &&other, &&other, &&other, &&other, &&other, &&other, &&other, &&other,
        &&other, &&other, &&other, &&root, &&other, &&other, &&other, &&other, &&other, &&other, &&other, &&other, &&other, &&other,
        &&other, &&other, &&other, &&other, &&other, &&other, &&other, &&other, &&other, &&other, &&other, &&other, &&other, &&other,
        &&other, &&other, &&other, &&other, &&times_plus, &&times_minus, &&minus_times, &&sines, &&end};
    ZD_NEXT;
plus: ZD_VALUE(ZD_A + ZD_B);
minus: ZD_VALUE(ZD_A - ZD_B);
times: ZD_VALUE(ZD_A * ZD_B);
over: ZD_VALUE(ZD_A / ZD_B);
negative: ZD_VALUE(-ZD_A);
root: ZD_VALUE(ZD_SQRT(ZD_A));
times_plus: ZD_VALUE(ZD_FMA(ZD_A, ZD_B, ZD_C));
times_minus: ZD_VALUE(ZD_FMS(ZD_A, ZD_B, ZD_C));
minus_times: ZD_VALUE(ZD_FNMA(ZD_A, ZD_B, ZD_C));
sines:
    ZD_NAMED(find_sines)(next->b, next, value, to);
    to += 2 * next->b;
    next += next->b;
    ZD_NEXT;
other: ZD_VALUE(ZD_NAMED(operate)(next->code, &ZD_A, &ZD_B, &ZD_C));
end:;
}
#undef ZD_VALUE
#undef ZD_NEXT
#else
ZD_ON_UNIT static void ZD_NAMED(run)(const zd_instruction *next, zd_real *value, zd_real *to)
{
    while (next->code != ZD_CODE_END) {
        const int sines = next->code == ZD_CODE_SINES ? next->b : 0;
        if (sines) ZD_NAMED(find_sines)(sines, next, value, to);
        else *to = ZD_NAMED(operate)(next->code, &ZD_A, &ZD_B, &ZD_C);
        to += sines ? 2 * sines : 1;
        next += sines ? sines : 1;
    }
}
#endif
#undef ZD_A
#undef ZD_B
#undef ZD_C

#if !ZD_UNIT
/* Values of expressions at as many states as there are lanes, side by side. */
static void ZD_NAMED(express)(const zd_expressions *self, const double *numbers, const double *t, const double *x, const double *xdot,
                              double *out)
{
    ZD_VALUES(zd_real, value, self->frame);
    zd_real *to = value;
    const double *const given[] = {t, x, xdot};
    const int count[] = {1, self->terms, self->rates};
    for (int i = 0; i < self->numbers; i++) *to++ = ZD_SPLAT(numbers[i]);
    for (int part = 0; part < 3; part++)
        for (int i = 0; i < count[part]; i++, to++)
            for (int lane = 0; lane < ZD_LANES; lane++) ZD_LANE(*to, lane) = given[part][lane * count[part] + i];
    ZD_NAMED(run)(self->first, value, to);
    for (int lane = 0; lane < ZD_LANES; lane++)
        for (int i = 0; i < self->results; i++) *out++ = ZD_LANE(value[self->result[i]], lane);
}
#endif

/* ---- functions ---- */

typedef struct ZD_NAMED(frame) {
    const zd_order_program *of;
    zd_real *value, *v, *before;    /* before: v before the projection */
} ZD_NAMED(frame);

#define zd_frame ZD_NAMED(frame)

/* The frame in `value`: constants, state, and terms that are added, NULL: zero. */
ZD_ON_UNIT static zd_frame ZD_NAMED(begin)(const zd_elimination *self, const void *data, const double *t, const double *p, const double *v,
                                           const double *added, zd_real *value)
{
    const zd_order_program *of = self->program;
    const double *constant = ZD_LANES == 1 ? *(const double *const *)data : data;
    const size_t size = sizeof *value, constants = (size_t)of->constants, nq = (size_t)of->nq, nv = (size_t)of->nv, m = (size_t)of->m;
    zd_real *to = value;
    memcpy(to, constant, constants * size);
    memcpy(to += constants, t, size);
    memcpy(to += 1, p, nq * size);
    const zd_frame found = {of, value, to + nq, to + nq + nv};
    memcpy(found.v, v, nv * size);
    memcpy(found.before, v, nv * size);
    if (added) memcpy(found.before + nv, added, m * size);
    else memset(found.before + nv, 0, m * size);
    return found;
}

/* Computes a part of a function; its results' places. */
ZD_ON_UNIT static const uint16_t *ZD_NAMED(find)(const zd_frame *in, const zd_function_program *function, enum zd_found part)
{
    ZD_NAMED(run)(function->part[part], in->value, in->value + function->first[part]);
    return function->result[part];
}

/* Writes n results, unless `to` is NULL; the places of the next ones. */
ZD_ON_UNIT static const uint16_t *ZD_NAMED(give)(const zd_frame *in, const uint16_t *place, int n, double *to)
{
    for (int i = 0; to && i < n; i++) ((zd_stored *)to)[i] = in->value[place[i]];
    return place + n;
}

/* Equations of motion (17), (8), (28), and the pivots. */
ZD_ON_UNIT static void ZD_NAMED(accelerate_in)(const zd_frame *in, const zd_function_program *function, double *pdot, double *vdot,
                                               double *lambda, double *power, double *pivots, double *D)
{
    const zd_order_program *of = in->of;
    const uint16_t *place = ZD_NAMED(find)(in, function, ZD_FOUND_RATES);
    ZD_NAMED(give)(in, ZD_NAMED(give)(in, place, of->pdot, pdot), of->nv, vdot);
    if (lambda || power) {
        place = ZD_NAMED(find)(in, function, ZD_FOUND_MULTIPLIERS);
        ZD_NAMED(give)(in, ZD_NAMED(give)(in, place, of->m, lambda), 1, power);
    }
    if (pivots || D) {
        place = ZD_NAMED(find)(in, function, ZD_FOUND_PIVOTS);
        ZD_NAMED(give)(in, ZD_NAMED(give)(in, place, of->pivots, pivots), of->D, D);
    }
}

ZD_ON_UNIT static int ZD_NAMED(accelerate)(const zd_elimination *self, const void *data, const double *inputs, const double *t,
                                           const double *p, const double *v, const double *added, double *pdot, double *vdot, double *lambda,
                                           double *power, double *pivots)
{
    ZD_VALUES(zd_real, value, ((const zd_order_program *)self->program)->frame);
    (void)inputs;
    const zd_frame in = ZD_NAMED(begin)(self, data, t, p, v, added, value);
    ZD_NAMED(accelerate_in)(&in, &in.of->accelerate, pdot, vdot, lambda, power, pivots, NULL);
    return ZD_DONE;
}

ZD_ON_UNIT static int ZD_NAMED(correct)(const zd_elimination *self, const void *data, const double *inputs, const double *t,
                                        const double *p, const double *v, double *Phi, double *dp, double *dv)
{
    ZD_VALUES(zd_real, value, ((const zd_order_program *)self->program)->frame);
    (void)inputs;
    const zd_frame in = ZD_NAMED(begin)(self, data, t, p, v, NULL, value);
    const zd_function_program *function = &in.of->correct;
    ZD_NAMED(give)(&in, ZD_NAMED(find)(&in, function, ZD_FOUND_PHI), in.of->mh, Phi);
    ZD_NAMED(give)(&in, ZD_NAMED(find)(&in, function, ZD_FOUND_DP), in.of->nq, dp);
    ZD_NAMED(give)(&in, ZD_NAMED(find)(&in, function, ZD_FOUND_DV), in.of->nv, dv);
    return ZD_DONE;
}

#if ZD_LANES == 1
/* Phi, and dp where one is not within what is allowed: then ZD_NO_CONVERGENCE; otherwise v - dv to the frame and to v. */
ZD_ON_UNIT static int ZD_NAMED(land)(const zd_frame *in, const zd_function_program *function, const double *allowed, double *Phi, double *dp,
                                     double *v)
{
    const zd_order_program *of = in->of;
    int is_within = 1;
    ZD_NAMED(give)(in, ZD_NAMED(find)(in, function, ZD_FOUND_PHI), of->mh, Phi);
    for (int k = 0; k < of->mh; k++) is_within &= fabs(Phi[k]) <= allowed[k];
    if (!is_within) {
        ZD_NAMED(give)(in, ZD_NAMED(find)(in, function, ZD_FOUND_DP), of->nq, dp);
        return ZD_NO_CONVERGENCE;
    }
    ZD_NAMED(give)(in, ZD_NAMED(find)(in, function, ZD_FOUND_DV), of->nv, in->v);
    for (int i = 0; i < of->nv; i++) v[i] = in->v[i] = in->before[i] - in->v[i];    /* (25b), (26b), (27b) */
    return ZD_DONE;
}

ZD_ON_UNIT static int ZD_NAMED(finish)(const zd_elimination *self, const void *data, const double *inputs, const double *t,
                                       const double *p, double *v, const double *allowed, double *Phi, double *dp, double *pdot,
                                       double *vdot, double *lambda, double *power, double *pivots)
{
    ZD_VALUES(zd_real, value, ((const zd_order_program *)self->program)->frame);
    (void)inputs;
    const zd_frame in = ZD_NAMED(begin)(self, data, t, p, v, NULL, value);
    const int status = ZD_NAMED(land)(&in, &in.of->finish, allowed, Phi, dp, v);
    if (!status) ZD_NAMED(accelerate_in)(&in, &in.of->finish, pdot, vdot, lambda, power, pivots, NULL);
    return status;
}

ZD_ON_UNIT static int ZD_NAMED(embed)(const zd_elimination *self, const void *data, const double *inputs, const double *t, const double *p,
                                      double *v, const double *added, const double *allowed, double *Phi, double *dp, double *D,
                                      double *pdot, double *vdot, double *lambda, double *power, double *pivots)
{
    ZD_VALUES(zd_real, value, ((const zd_order_program *)self->program)->frame);
    (void)inputs;
    const zd_frame in = ZD_NAMED(begin)(self, data, t, p, v, added, value);
    const int status = ZD_NAMED(land)(&in, &in.of->embed, allowed, Phi, dp, v);
    if (!status) ZD_NAMED(accelerate_in)(&in, &in.of->embed, pdot, vdot, lambda, power, pivots, D);
    return status;
}

static const zd_elimination ZD_NAMED(functions) = {
    .accelerate = ZD_NAMED(accelerate), .correct = ZD_NAMED(correct), .finish = ZD_NAMED(finish)};
static const zd_elimination ZD_NAMED(embedding) = {.correct = ZD_NAMED(correct), .embed = ZD_NAMED(embed)};
#else
static const zd_elimination ZD_NAMED(functions) = {.accelerate = ZD_NAMED(accelerate), .correct = ZD_NAMED(correct)};
#endif

#undef zd_frame
#undef ZD_UNIT
#undef ZD_LANES
