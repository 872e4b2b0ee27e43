/* A system in one phase: with the groups of constraints that are active in it, and the forces of sliding friction. */
#pragma once

#include "../point/point.h"
#include "distribution.h"

/* State of a group: of a one-sided row open or closed; of two-sided rows released or joined; of friction absent, sticking, or sliding with a
 * slip velocity of this sign; friction in two directions slides forward in any. Idle: closed or sticking, redundant with other groups, which
 * bear its force. Behind: within the range of a shape, on its back, and not in contact. */
enum { ZD_OPEN, ZD_CLOSED, ZD_SLIDES_FORWARD, ZD_SLIDES_BACKWARD, ZD_IDLE, ZD_BEHIND };

static const double ZD_TOUCHING = 1e-10;     /* gap of contacts that take part in a change, relative to the characteristic length */

static const double ZD_SLOW_SLIP = 1e-6;      /* slip in two directions below which it does not turn, in characteristic lengths per s */

enum { ZD_MAX_LOADS = 4 };      /* number of rows whose multipliers may be a load */

/* True of groups whose force has one sign. */
static inline int zd_is_normal(enum zd_group_kind kind) { return kind == ZD_ONE_SIDED || kind == ZD_ONE_WAY; }
static inline int zd_slides(signed char state) { return state == ZD_SLIDES_FORWARD || state == ZD_SLIDES_BACKWARD; }
static inline double zd_slip_sign(signed char state) { return state == ZD_SLIDES_FORWARD ? 1 : -1; }

typedef struct zd_sliding {     /* friction of a group that slides */
    int group;
    int input;              /* index of its force among those of the reading; -1: its bound is fixed */
    int reaction, reactions;    /* first component of the load, and their number, among what the reading reads */
} zd_sliding;

/* Terms of the full system's constraints that are those of a state. */
typedef struct zd_part_forces {     /* coupled contacts, whose forces may not be determined */
    zd_distribution forces;
    int normal[ZD_MAX_DISTRIBUTED], friction[ZD_MAX_DISTRIBUTED];       /* groups of its contacts; -1: no friction that sticks */
} zd_part_forces;

typedef struct zd_known_terms {
    int terms;
    double t, *p, *v;       /* s, (nq,), (nv,) */
    double *row;            /* (nv,) a row of C, expanded */
    int parts;              /* number of parts whose forces are those of the state */
    zd_part_forces *part;   /* (groups,); NULL: no contact is in space */
} zd_known_terms;

typedef struct zd_phase_system zd_phase_system;

struct zd_phase_system {
    zd_system system;       /* its `data` is this structure */
    const zd_system *full;  /* with the rows of all groups */
    signed char *state;     /* (groups,) */
    int *row;               /* (m,): row of the full system that each row is */
    int *row_here;          /* (full m,): the inverse; -1: it is not active */
    int *is_switched;       /* (full m,): true if the row is of a group */
    double *value;          /* (m,): Phi of the full system at which the row is closed */
    int *keeps_value;       /* (m,): true of rows of two-sided groups, whose value is set when they join */
    const zd_layout *layout;    /* layout of the full system; NULL: it declares no structure */
    int size_of_C;          /* entries of C of the full system */
    int slidings;
    int has_sliding_pairs;  /* true if friction in two directions slides */
    int is_indeterminate;   /* true if forces of contacts that stick are not determined */
    double slow_slip;       /* m/s: slip velocity in two directions below which it does not turn */
    double *direction;      /* (groups, 2): unit vectors of slip in two directions at the start of a step */
    double *slip_speed;     /* (groups,) m/s: its magnitude there */
    double *mobility;       /* (groups,) 1/kg: acceleration of the slip of sliding friction by a unit normal force */
    double *turning_slip;   /* (groups,) m/s: slip velocity below which a step does not resolve its direction */
    int *slow_steps;        /* (groups,) number of steps in which it has been slow */
    zd_sliding *sliding;    /* (groups,) */
    zd_structure structure;
    zd_measures measures;   /* measures of the full system, then the multiplier of each row of the full system */
    zd_measure *measure;
    zd_reading reading;
    zd_read_reaction *reaction;
    zd_read *read;
    const char **name;      /* names of functions that read reactions */
    double *scratch;        /* memory of zd_phase_evaluate() */
    zd_known_terms *known;  /* the terms in it */
    double *lambda;         /* (full m,): multipliers of all rows, from zd_point_multipliers() */
    int *part;              /* (groups,) of contacts: those with the same number are coupled */
    int *tie;               /* (groups,) of idle friction: the parallel group that sticks in its place; -1: none */
    double *tie_factor;     /* (groups,) length of its row in units of that one, negative if it is opposite */
    int has_ties;           /* true if there is any */
    double *bias;           /* (groups,): added to each margin, which rounding may make negative when the phase begins */
    zd_switches switches;
    zd_operations operations;
    zd_closed_form *closed_form;    /* (closed_forms,) of the full system for single runs, while no group acts */
    int closed_forms;
    zd_memory *memory;      /* its own, of zd_phase_new() */
};

/* The phase with the state (groups,) of each group, in memory of the arena. */
zd_phase_system *zd_phase_system_create(zd_arena *arena, const zd_system *full, const signed char *state);
/* all (full m,) <- multipliers of all rows at a state, from those (m,) of the phase: 0 for open rows, and for sliding friction the multiplier
 * that equals its force. `u`: forces that read reactions; NULL without any. */
void zd_phase_expand(const zd_phase_system *self, double t, const double *p, const double *v, const double *lambda, const double *u,
                     double *all);
/* True if contacts have friction in two directions. */
static inline int zd_has_pairs(const zd_system *full)
{
    for (int g = 0; g < full->groups; g++)
        if (full->group[g].normal && full->group[g].rows == 2) return 1;
    return 0;
}
/* True if one-sided constraints are among the groups of a phase, if there is one. */
static inline int zd_has_contacts(const zd_phase_system *phase)
{
    for (int g = 0; phase && g < phase->full->groups; g++)
        if (phase->full->group[g].kind == ZD_ONE_SIDED) return 1;
    return 0;
}
/* Number of rows of the full system of a point. */
static inline int zd_point_constraints(const zd_point *point) { return zd_constraints(point->phase ? point->phase->full : point->system); }
/* Multipliers of all rows at the point, which are known there; valid until the next call. */
const double *zd_point_multipliers(const zd_point *point);
/* Evaluates terms of the constraints of the full system at a state, in memory of its own; then a row of its C, its Phi, Phi_t and xi there,
 * and the slip velocity (rows,) of a group. */
int zd_phase_evaluate(const zd_phase_system *self, int want, double t, const double *p, const double *v);
/* The same, of terms that are not known there yet. */
int zd_phase_need(const zd_phase_system *self, int want, double t, const double *p, const double *v);
zd_row_of_C zd_phase_row(const zd_phase_system *self, int row);
const double *zd_phase_Phi(const zd_phase_system *self);
const double *zd_phase_Phi_t(const zd_phase_system *self);
const double *zd_phase_xi(const zd_phase_system *self);
void zd_phase_slip(const zd_phase_system *self, int group, const double *v, double *slip);
/* Directions of slip <- those at a state, unless they have reversed; at a start in any case. */
int zd_phase_update_directions(const zd_phase_system *self, int is_start, double t, const double *p, const double *v);
/* turning_slip of sliding friction, of which normal forces are the margins (groups,); 0: adaptive steps. */
void zd_phase_update_turning_slip(const zd_phase_system *self, const zd_settings *settings, const double *margin);
/* Gap of a one-sided group; and distance of its coordinate from the ends of its range, negative outside: INFINITY for an unbounded shape. */
double zd_phase_gap(const zd_phase_system *self, int group);
double zd_phase_range_margin(const zd_phase_system *self, int group);
/* Number of measures of the full system. */
static inline int zd_own_measures(const zd_system *full) { return full->measures ? full->measures->count : 0; }
/* Forces of the closed and sticking contacts coupled with that of a group, in the distribution with the largest margin; C of the state
 * must be known. While friction in two directions slides among them, normal forces are given. */
const zd_part_forces *zd_phase_part_forces(const zd_phase_system *self, int group, const double *lambda);
/* Sets the functions of a phase whose rows are known. */
void zd_phase_pass_functions(zd_phase_system *self);
/* First row of the multipliers that are the load of friction. */
static inline int zd_first_load(const zd_system *full, const zd_group *group)
{
    return group->normal ? full->group[group->normal - 1].first : group->load;
}
/* Load that bounds friction, from the multipliers (loads,) of its rows or of the normal row; 1 for a fixed bound. */
double zd_friction_load(const zd_system *full, const zd_group *group, const double *lambda);
/* Bounds of static friction minus the forces, of a group and of those in whose place it sticks. */
double zd_friction_room(const zd_phase_system *self, int group, const double *lambda);
/* Multipliers (full m,) of parallel friction that sticks <- shares of its force in proportion to the bounds. */
void zd_friction_distribute(const zd_phase_system *self, double *lambda);
/* Margin of a group at a state, whose accelerations and multipliers are those of the point: positive while its phase lasts. It is the gap of
 * an open row, the force N of a closed one, the bound of static friction minus its force, and the slip speed; and how far the coordinate of a
 * bounded shape is from the ends of its range. */
int zd_phase_margin(zd_phase_system *self, const zd_point *point, int group, double t, const double *p, const double *v,
                    double *margin);
/* Discards the terms of the last margins, as after a change of inputs. */
static inline void zd_phase_forget(const zd_phase_system *self) { self->known->terms = 0; }
/* True if the margin depends on accelerations and multipliers. */
int zd_margin_reads_accelerations(const zd_phase_system *self, int group);
