/* Release and joining of joints, and other states of a run with phases. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../motion/motion.h"
#include "contacts.h"

static int find_offset(zd_run *run, const zd_group *group, enum zd_joining how)
{
    zd_phases *phases = run->phases;
    const zd_point *point = run->motion.point;
    const int status = zd_phase_evaluate(phases->present->of, ZD_PHI, point->t, point->p, point->v);
    double largest = 0;
    for (int k = group->first; k < group->first + group->rows && k < phases->full->mh; k++) {
        const double Phi = zd_phase_Phi(phases->present->of)[k];
        phases->offset[k] = how == ZD_JOINED_HERE ? Phi : 0;
        largest = fmax(largest, fabs(Phi - phases->offset[k]));
    }
    if (status || largest <= ZD_PENETRATION * phases->length) return status;
    snprintf(run->outcome.message, ZD_MESSAGE, "joint '%s' must be closed when it joins, and is open by %.3g; here=True joins it in "
             "its present position", group->name, largest);
    return ZD_BAD_START;
}

int zd_run_switch(zd_run *run, int index, enum zd_joining how)
{
    zd_phases *phases = run->phases;
    const zd_group *group = phases && index >= 0 && index < phases->full->groups ? phases->full->group + index : NULL;
    if (!group || group->kind != ZD_TWO_SIDED) return ZD_BAD_ARGUMENT;
    signed char *wanted = zd_allocate(phases->full->groups);
    if (!wanted) return ZD_NO_MEMORY;
    memcpy(wanted, phases->state, phases->full->groups);
    wanted[index] = how ? ZD_CLOSED : ZD_OPEN;
    int status = how && phases->state[index] != ZD_CLOSED ? find_offset(run, group, how) : ZD_DONE;
    if (!status && phases->state[index] != wanted[index]) status = zd_phases_change(run, wanted, 0);
    zd_release(wanted);
    return status;
}

int zd_phases_set_state(zd_run *run, const double *p, const double *v)
{
    zd_phases *phases = run->phases;
    double before = 0, after = 0;
    signed char *open = zd_allocate(phases->full->groups);
    int status = open ? zd_motion_balance(&run->motion, &before) : ZD_NO_MEMORY;
    for (int g = 0; !status && g < phases->full->groups; g++)
        open[g] = phases->full->group[g].kind == ZD_TWO_SIDED ? phases->state[g] : ZD_OPEN;
    if (!status) status = zd_phases_place(run, open, run->stepper.t, p, v, zd_motion_input(&run->motion));
    if (!status) status = zd_start_check(run, run->motion.point->rhs);
    if (!status) status = zd_motion_balance(&run->motion, &after);
    if (!status) {
        memcpy(phases->state, open, phases->full->groups);
        zd_motion_add_jump(&run->motion, run->stepper.t, after - before);
        status = zd_phases_change(run, NULL, 1);
        run->tally.start_saved = run->settings.t_eval != NULL;
    }
    zd_release(open);
    return status;
}
