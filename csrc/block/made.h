/* A block that has become a mechanism. */
#pragma once

#include "../workspace.h"
#include "layout.h"

/* User functions of a block. */

typedef struct zd_block_laws {
    zd_law_program *program;    /* (laws,), of these: */
    zd_expressions *law;
    zd_instruction *instruction;
    uint16_t *result;
    double *number;             /* splines are their addresses */
    zd_spline *spline;
    int know_time, have_ends;   /* 1 if a law reads t; if one may have a table whose ends are an error */
} zd_block_laws;

void zd_block_laws_create(zd_block_laws *self, const zd_block_layout *layout, zd_arena *arena);
/* Takes the laws of a block; 0 with the reason if an entry is wrong. */
int zd_block_laws_unpack(zd_block_laws *self, const zd_block_layout *layout, zd_complaint to);
/* True if a law has these numbers of marker quantities and results. */
int zd_block_law_suits(const zd_block_laws *self, const zd_block_layout *layout, int law, int terms, int results);

/* Names of the rows of C of a mechanism, from the names of its joints and relations. */

/* Parts of the name of a row. */
typedef struct zd_block_names {
    const zd_block_layout *layout;
    const zd_constraint_owner *owner;      /* (m,) */
} zd_block_names;

/* 1 without names, or if there is one of each body, joint and relation. */
int zd_block_names_check(const zd_block_layout *layout, zd_complaint to);
/* zd_system.name_constraint; `names` is a zd_block_names. */
void zd_block_name_row(const void *names, int row, char *to, int size);

/* Memory of inputs, (inputs,) each. */
typedef struct zd_block_inputs_memory {
    double *value, *lower, *upper;
    zd_input_slot *place;
} zd_block_inputs_memory;

/* Events of a block: (events,) each, and (actions,). */
typedef struct zd_block_events {
    zd_argument *reading;
    zd_event *known;
    int *direction, *terminal;
    zd_action *action;
    zd_events all;              /* with these */
} zd_block_events;

struct zd_block {
    double *word;               /* its own copy */
    size_t size;                /* bytes */
    zd_block_layout layout;
    zd_block_laws laws;
    zd_block_names names;
    void *mechanism;            /* zd_plane or zd_space */
    zd_generalized_force *force;    /* planned forces of the mechanism */
    int *output;                /* (outputs,) */
    zd_outputs outputs;
    zd_block_inputs_memory inputs_memory;
    zd_inputs inputs;
    zd_block_events events;
    zd_system system;
};

/* Characteristic length of the mechanism, m. */
static inline double zd_block_length(const zd_block *block) { return block->layout.part[ZD_BLOCK_GRAVITY].word[block->layout.of->dimension]; }

/* Sets the initial inputs; and writes inputs to their places, for a new run. */
void zd_block_inputs_begin(zd_block *block);
void zd_block_inputs_write(zd_block *block);
void zd_block_events_create(zd_block_events *self, const zd_block_layout *layout, zd_arena *arena);
int zd_block_events_unpack(zd_block *block, zd_complaint to);
/* Checks of inputs and parameters; 1, or 0 with the reason. */
int zd_block_inputs_check(const zd_block *block, zd_complaint to);
int zd_block_parameters_check(const zd_block_layout *layout, zd_complaint to);

/* Tree of inboard joints of a block in the plane, and the loops that its other joints close. */

/* Inboard joint of a body, numbered from 1; -1: it is free. */
int zd_block_inboard(const zd_block_layout *layout, int body);
/* True if a body of the block has an inboard joint. */
int zd_block_has_tree(const zd_block_layout *layout);
/* inboard (bodies,) <- inboard joints, -1 for free bodies, of the tree that grows from the ground by the joint of fewest coordinates, and
 * among these by the one nearest to the ground; `distance` (bodies + 1,) is scratch. */
void zd_block_grow_tree(const zd_block_layout *layout, int *inboard, int *distance);
/* Appends the bodies and joints of the loop that a joint closes, "the loop of ground, crank, through A, B". `is_on_way`
 * (bodies + joints + 1,) is scratch. */
void zd_block_name_loop(const zd_block_layout *layout, int joint, int *is_on_way, zd_complaint *to);

const char *zd_block_joint_name(const zd_block_layout *layout, int joint);
