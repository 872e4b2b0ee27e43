/* Integrated variables near a bifurcation.
 *
 * Formulations in independent velocities compute v = D u from p. At a distance s from a bifurcation, where a row of C has a relative residual
 * s with respect to the others, an error of p across the branch is amplified by 1 / s in D and v, and by 1 / s^2 in the acceleration. If p
 * itself is computed from q, its error is 1 / s of the rounding of Phi. These formulations so lose digits that one with v in its state
 * keeps, and adaptive steps shrink without end, as no step is so short that its noise meets the tolerance.
 *
 * A step near a bifurcation is made in (p, v) by (8) instead, and so are the next, until one is no longer near; the projection after each
 * of them corrects the constraints. Without such a projection the chosen variables are used throughout.
 */
#include "stepper.h"

#include <string.h>

extern const zd_formulation zd_augmented, zd_augmented_dense;

static int is_held(const zd_constraint_target *target)
{
    return target->every == 1 && target->positions && target->velocities;
}

zd_variables zd_variables_of(const zd_motion *motion, const zd_integrator *integrator, const zd_system *independent)
{
    int loses = motion->formulation->update && zd_constraints(independent);
    if (!loses || integrator->step_of_motion || !is_held(&motion->target)) return (zd_variables){NULL, NULL, 0};
    const zd_formulation *used = zd_has_many_constraints(motion->formulation, &motion->system) ? &zd_augmented : &zd_augmented_dense;
    return (zd_variables){used, NULL, used->state_size(independent)};
}

/* Replaces the formulation; `along`: the other entries of the state, which are kept. */
static void use(zd_stepper *stepper, const zd_variables *variables, const double *along)
{
    zd_motion *motion = stepper->motion;
    int size = motion->rate.size - motion->formulation_size;
    memmove(stepper->y + variables->size, along, size * sizeof *along);
    motion->formulation = variables->formulation;
    motion->solver = variables->solver;
    motion->drifts_from = variables->formulation->drifts_from;
    motion->formulation_size = variables->size;
    motion->rate.size = variables->size + size;
    zd_motion_describe_rate(motion);
    motion->point->known &= ~(ZD_FACTORED | ZD_ACCELERATED);
    zd_motion_attach(motion, stepper->y);
}

int zd_variables_use_dependent(zd_stepper *stepper)
{
    zd_motion *motion = stepper->motion;
    const zd_last *last = &stepper->last;
    motion->statistics.repartitions++;
    stepper->t = last->t;
    zd_point_move(motion->point, last->t, last->p, last->v);
    use(stepper, &stepper->dependent, last->y + motion->formulation_size);
    /* This near a bifurcation, the constraints must be satisfied far better than the tolerance requires, and can be. */
    int status = zd_motion_correct(motion);
    return status ? status : motion->formulation->pack(motion->solver, motion->point, stepper->y);
}

void zd_variables_restore(zd_stepper *stepper)
{
    const zd_motion *motion = stepper->motion;
    if (motion->formulation != stepper->chosen.formulation) use(stepper, &stepper->chosen, stepper->y + motion->formulation_size);
}

int zd_variables_use_chosen(zd_stepper *stepper)
{
    zd_motion *motion = stepper->motion;
    if (motion->formulation == stepper->chosen.formulation || motion->point->rank->was_ill_conditioned) return ZD_DONE;
    use(stepper, &stepper->chosen, stepper->y + motion->formulation_size);
    return motion->formulation->pack(motion->solver, motion->point, stepper->y);
}
