#include "closed_form.h"

#include "../constraints/rank.h"
#include "../linalg/small.h"
#include "../safeguards/glance.h"
#include "choose.h"

/* Zero times what is not finite is not a number; the sum has no branches. */
ZD_INLINE int is_finite(const int n, const double *y)
{
    double zero = 0;
    for (int i = 0; i < 2 * n; i++) zero += 0 * y[i];
    return zero == 0;
}

ZD_INLINE void remember(const int n, zd_stepper *stepper)
{
    zd_copy(n, stepper->y, stepper->last.y);
    zd_copy(n, stepper->y + n, stepper->last.y + n);
}

ZD_INLINE int integrate(const int n, zd_stepper *stepper, double h)
{
    zd_motion *motion = stepper->motion;
    remember(n, stepper);
    motion->rate.vdot = motion->point->known & ZD_ACCELERATED ? motion->point->vdot : NULL;
    int status = stepper->integrator->step(stepper->memory, &motion->rate, stepper->t, h, stepper->y, &motion->statistics);
    motion->rate.vdot = NULL;
    return status;      /* values that are not finite are found at the end of the step */
}

static int integrate_from(zd_stepper *stepper, double h)
{
    const zd_point *point = stepper->motion->point;
    stepper->last.t = stepper->t;
    stepper->last.h = h;
    point->rank->was_ill_conditioned = 0;
    return ZD_SIZED(integrate, point->system->nv, stepper, h);
}

/* Projects the state y at t, and moves the point to it. */
ZD_INLINE int project(const int n, zd_stepper *stepper, double t, double *y)
{
    zd_point *point = stepper->motion->point;
    point->t = stepper->t = t;
    int status = zd_direct_land(stepper->motion, t, y, y + n);
    zd_copy_pairs(n, y, point->p);
    zd_copy_pairs(n, y + n, point->v);
    return status;
}

static int project_state(zd_stepper *stepper, double t1, int64_t step, int forced)
{
    (void)step, (void)forced;       /* due in every step */
    return ZD_SIZED(project, stepper->motion->system.nv, stepper, t1, stepper->y);
}

/* Applies the other corrections at the point, and computes its acceleration. */
ZD_INLINE int correct(const int n, zd_stepper *stepper, double *y, int64_t step, int forced)
{
    zd_motion *motion = stepper->motion;
    int status = zd_motion_correct_rest(motion, step, forced);
    if (status) return status;
    zd_copy_pairs(n, motion->point->v, y + n);
    return zd_motion_accelerate(motion);
}

static int correct_state(zd_stepper *stepper, int64_t step, int forced)
{
    return ZD_SIZED(correct, stepper->motion->system.nv, stepper, stepper->y, step, forced);
}

ZD_RARE int check_fully(zd_stepper *stepper, zd_safeguards *safeguards, int64_t next_step, int parts)
{
    const int is_number = is_finite(stepper->motion->system.nv, stepper->y);
    return is_number ? zd_safeguards_judge(safeguards, zd_direct_compare, stepper->last.h, next_step, parts) : ZD_NOT_FINITE;
}

ZD_INLINE int check(const int n, zd_stepper *stepper, zd_safeguards *safeguards, int64_t next_step, int parts)
{
    const double *y = stepper->y;
    if (!parts && zd_safeguards_glance(n, safeguards, stepper->last.h, next_step, y, y + n)) return ZD_DONE;
    return check_fully(stepper, safeguards, next_step, parts);
}

static int check_state(zd_stepper *stepper, zd_safeguards *safeguards, int64_t next_step, int parts)
{
    return ZD_SIZED(check, stepper->motion->system.nv, stepper, safeguards, next_step, parts);
}

const zd_evaluation_path zd_closed_form_path = {"closed form", integrate_from, project_state, correct_state, NULL, check_state};

ZD_INLINE int land_between(const int n, zd_stepper *stepper, double t, double *y)
{
    int status = project(n, stepper, t, y);
    if (!status && stepper->motion->others_after_step) status = correct(n, stepper, y, 0, 1);
    return status || is_finite(n, y) ? status : ZD_NOT_FINITE;
}

int zd_short_land_between(zd_stepper *stepper, double t, double *y)
{
    return ZD_SIZED(land_between, stepper->motion->system.nv, stepper, t, y);
}

/* Exchanges the arrays of accelerations at the end of the step with others: a copy would take as long as saving a sample. */
static void exchange_rates(zd_motion *motion, zd_cached_accelerations *rates)
{
    zd_exchange(&motion->point->vdot, &rates->vdot);
    zd_exchange(&motion->point->lambda, &rates->lambda);
    zd_exchange(&motion->path.pivots, &rates->pivots);
}

void zd_short_keep_rates(const zd_stepper *stepper, zd_cached_accelerations *rates)
{
    rates->smallest = stepper->motion->path.smallest;
    exchange_rates(stepper->motion, rates);
}

ZD_INLINE void return_to_end(const int n, const double *y, const zd_point *point)
{
    zd_copy_pairs(n, y, point->p);
    zd_copy_pairs(n, y + n, point->v);
}

void zd_short_return_to_end(zd_stepper *stepper, double t, zd_cached_accelerations *rates)
{
    zd_motion *motion = stepper->motion;
    motion->point->t = stepper->t = t;
    motion->point->known = ZD_ACCELERATED;
    motion->path.smallest = rates->smallest;
    exchange_rates(motion, rates);
    ZD_SIZED(return_to_end, motion->system.nv, stepper->y, motion->point);
}
