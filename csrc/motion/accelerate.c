/* The equations of motion of a run at its point: the rate of the integrated state, and the energy balance. */
#include "../core.h"
#include "../linalg/small.h"
#include "../constraints/rank.h"

int zd_has_energy(const zd_system *system)
{
    return (system->provides & ZD_POTENTIAL) != 0;
}

int zd_has_input(const zd_system *system)
{
    return zd_has_energy(system) && (system->provides & (ZD_POWER | ZD_PHI_T));
}

int zd_run_factor(zd_run *run)
{
    zd_point *point = run->point;
    if (point->known & ZD_FACTORED) return ZD_DONE;
    int status = zd_point_need(point, ZD_M | ZD_C);
    if (status) return status;
    run->statistics.factorizations++;
    status = run->formulation->factor(run->solver, point);
    if (!status) point->known |= ZD_FACTORED;
    return status;
}

void zd_run_solve(zd_run *run, const double *force, const double *rhs, double *x, double *lambda)
{
    zd_rank_solve(run->point, run->formulation, run->solver, force, rhs, x, lambda);
}

static void stabilize(zd_run *run)
{
    for (int i = 0; i < run->corrections; i++) {
        const zd_active *active = &run->active[i];
        if (active->row->stabilize)
            active->row->stabilize(active->self, &run->settings, run->point, run->state + active->extra, run->point->rhs);
    }
}

int zd_run_accelerate(zd_run *run)
{
    zd_point *point = run->point;
    if (point->known & ZD_ACCELERATED) return ZD_DONE;
    int status = zd_point_need(point, run->acceleration_needs);
    if (!status) status = zd_run_factor(run);
    if (status) return status;
    zd_point_force(point, point->force);
    ZD_SIZED(zd_copy, zd_constraints(point->system), point->terms.xi, point->rhs);
    stabilize(run);
    status = zd_rank_replace(point, ZD_LIMIT_XI, point->rhs);
    if (status) return status;
    run->statistics.solves++;
    zd_run_solve(run, point->force, point->rhs, point->vdot, point->lambda);    /* (8), (9), (13) */
    point->known |= ZD_ACCELERATED;
    return ZD_DONE;
}

/* What comes in besides V: from forces, and through moving constraints, whose force -C^T lambda does work as C v = -Phi_t. */
static double power(const zd_point *point)
{
    double sum = point->terms.power ? *point->terms.power : 0;
    if (point->terms.Phi_t)
        for (int k = 0; k < zd_constraints(point->system); k++) sum += point->lambda[k] * point->terms.Phi_t[k];
    return sum;
}

static void extra_rates(const zd_run *run, double *ydot)
{
    for (int i = 0; i < run->corrections; i++) {
        const zd_active *active = &run->active[i];
        if (active->extra_size) active->row->extra_rate(run->point, ydot + active->extra);
    }
}

int zd_run_rate(void *context, double t, const double *y, double *ydot)
{
    zd_run *run = context;
    int status = run->formulation->enter(run->solver, run->point, t, y);
    run->state = y;
    if (run->extras) run->point->known &= ~ZD_ACCELERATED;     /* vdot depends on them, too */
    if (!status) status = zd_run_accelerate(run);
    if (!status) status = run->formulation->rate(run->solver, run->point, ydot);
    if (status) return status;
    extra_rates(run, ydot);
    if (zd_has_input(&run->system)) ydot[run->rate.size - 1] = power(run->point);
    return ZD_DONE;
}

int zd_run_energy_violation(zd_run *run, double *violation, double *kinetic)
{
    int status = zd_point_need(run->point, ZD_M | ZD_POTENTIAL);
    if (status) return status;
    *kinetic = zd_point_kinetic(run->point);
    *violation = *kinetic + zd_point_potential(run->point) - run->energy0 - *run->input;     /* (28) */
    return isfinite(*violation) ? ZD_DONE : ZD_NOT_FINITE;
}

int zd_run_correct(zd_run *run)
{
    for (int i = 0; i < run->corrections; i++) {
        const zd_active *active = &run->active[i];
        int status = active->row->after_step ? active->row->after_step(active->self, run) : ZD_DONE;
        if (status) return status;
    }
    return ZD_DONE;
}
