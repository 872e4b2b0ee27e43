/* Phases of a run: which constraints are active. Each phase that has been seen keeps its plan, the components of a run of its equations. */
#pragma once

#include "../contact/phase_system.h"
#include "run.h"

typedef struct zd_phase {
    struct zd_phase *next;
    zd_phase_system *of;
    zd_run *plan;           /* copy of the run while this phase is not the present one */
    int is_open;            /* true if the plan exists */
    zd_memory *memory;      /* its own, without that of the plan */
    double *opened;         /* t, p (nq,), v (nv,) and numbers of inputs at which the plan was opened */
} zd_phase;

struct zd_phases {
    const zd_system *full;
    const zd_events *own;   /* events of the settings; NULL: none */
    zd_settings settings;   /* settings of the run, with one more event for each group, and outputs of the full system */
    zd_events events;
    zd_outputs outputs;
    zd_phase *first, *present;
    zd_store store;         /* memory of the phases */
    double length;          /* m: characteristic length, the unit of gaps */
    zd_state at;            /* state at which the phase changes; `extra` is NULL */
    double input;           /* J: energy input there */
    zd_transition last;
    double *offset;         /* (mh,) of the full system: Phi at which a two-sided group is joined */
    double *size;           /* (mh,) of the full system: sizes of its constraints, in the last phase in which each was active */
    signed char *state;     /* (groups,) the present one */
    int *occurs;            /* (own events,) true at the instant of the change */
    double *passed;         /* (own events,) values before the first change at that instant */
    int changes;            /* number of changes at one instant */
    double t_changes;       /* s: that instant */
    int has_images;         /* true if the state can be saved: what is opened keeps an image */
};

/* Unit of the gap of a group: the characteristic length, or that of the group, as 1 rad */
static inline double zd_group_scale(const zd_phases *phases, const zd_group *group)
{
    return group->scale > 0 ? group->scale : phases->length;
}
/* Phases of a system with groups; the first one is without any contact. NULL without memory. */
zd_phases *zd_phases_create(const zd_system *full, const zd_settings *settings);
void zd_phases_free(zd_run *run);
/* The phase with this state (groups,), made if it has not been seen; NULL without memory. */
zd_phase *zd_phases_find(zd_phases *self, const signed char *state);
/* Makes a phase, whose plan is in place, the present one. */
void zd_phase_use(zd_run *run, zd_phase *phase);
/* Opens the plan of a phase at phases->at in place of the run, of which `before` is a copy. */
int zd_phase_open(zd_run *run, zd_phase *phase, const zd_run *before);
/* Enters a phase at the state phases->at; `prepares`: alone for solutions there, not for a step. */
int zd_phase_enter(zd_run *run, const signed char *state, int prepares);
/* True if the integrator applies to all phases of a system. */
int zd_phases_suit(const zd_system *full, int integrator);
/* Attaches the phases to a run that has the plan of the first one. */
void zd_phases_attach(zd_run *run, zd_phases *phases);
const double *zd_phases_sizes(const zd_run *run);
/* Saves the present state in phases->at. */
void zd_phases_save_state(zd_run *run);
/* zd_run_set_state() of a run with phases. */
int zd_phases_set_state(zd_run *run, const double *p, const double *v);
/* After a step: ZD_BRANCH if a contact has been passed without its event. */
int zd_phases_check(zd_run *run);
/* Moves the run to a state in a phase, for a step from there. */
int zd_phases_place(zd_run *run, const signed char *state, double t, const double *p, const double *v, double input);
/* Finds the phase that follows at the present state, with impacts, and enters it. `state` (groups,): requested states of two-sided groups;
 * NULL: as they are. `is_start`: no event has preceded. */
int zd_phases_change(zd_run *run, const signed char *state, int is_start);
/* event_jumps.c: values of the events of the settings before a change of phase; those that jump past zero occur as the next step begins. */
int zd_event_jumps_begin(zd_run *run);
void zd_event_jumps_finish(zd_run *run);
