/* Elements in their planned form: rows of joints and relations in the order of C, generalized forces and measures. */
#pragma once

#include <string.h>

#include "../../include/zerodrift/system.h"
#include "../../workspace.h"
#include "elements.h"

typedef struct zd_planned_elements {
    int relations, forces, mh, m, longest;     /* `longest`: maximum number of terms of a row or generalized force */
    double length;                  /* m: see zd_elements */
    const zd_quantity_term *term;
    const double *coefficient;      /* coefficients of the terms, contiguous */
    const zd_relation *row;         /* (m,) rows of joints and relations, holonomic ones first */
    const zd_constraint_owner *owner_of_constraint;   /* (m,) */
    const int *constraint_of_relation;     /* (relations,) */
    const zd_generalized_force *force;
    const zd_output_spec *output;
    zd_law *law;
    void *owner;
    const zd_law_program *program;      /* by index of the user function: expressions, used instead of `law`. NULL: there are none */
    zd_reading reading;             /* its arrays are those given; no functions: no user function reads reactions */
    int has_velocity_forces;        /* 1 if a generalized force depends on velocities, so that rates must be computed for the forces */
} zd_planned_elements;

/* Arrays that are filled while the rows are planned, and constant afterwards. */
typedef struct zd_element_parts {
    zd_quantity_term *term;
    double *coefficient;
    zd_relation *row;
    zd_constraint_owner *owner_of_constraint;
    int *constraint_of_relation;
    zd_generalized_force *force;
    zd_output_spec *output;
    zd_measure *measure;
    zd_group *group;
    int terms, rows;                /* numbers so far */
} zd_element_parts;

/* Allocates memory for the given elements, and for the terms and rows of joints in addition. */
void zd_elements_create(zd_element_parts *to, zd_arena *arena, const zd_elements *elements, size_t terms, size_t rows);
/* Copies terms, generalized forces and measures; rows are added individually. */
void zd_elements_copy(const zd_elements *elements, zd_element_parts *to);
void zd_elements_add_term(zd_element_parts *to, int quantity, double coefficient);
/* Adds the row of a joint whose terms are the last ones, from `first` on. */
void zd_elements_add_joint_row(zd_element_parts *to, int first, int nonholonomic, int joint, int component);
/* Adds the holonomic or the nonholonomic relations as rows. */
void zd_elements_add_relations(const zd_elements *elements, int nonholonomic, zd_element_parts *to);
/* The groups of a system, after all rows were added. */
void zd_elements_set_groups(const zd_elements *elements, const zd_element_parts *from, zd_system *system);
/* Planned form, after all rows were added; the first `mh` are holonomic. */
zd_planned_elements zd_elements_plan(const zd_elements *elements, const zd_element_parts *from, int mh);
/* Bit mask of the terms of (2), (3), (5) and (6) that rows and generalized forces provide. */
int zd_elements_terms(const zd_elements *elements, const zd_planned_elements *planned);

/* Memory of a mechanism at one state: arrays in a scratch, whose addresses are a struct, the frame, that begins with them. */

/* at (count + 1,) <- bytes before each array, and their sum; sizes of scratch: the system has the first `own` arrays, measures have all */
static inline void zd_divide(int count, int own, const size_t *bytes, size_t *at, zd_system *system, zd_measures *measures)
{
    for (int i = 0; i < count; i++) at[i + 1] = at[i] + bytes[i];
    system->scratch = (int)(at[own] / sizeof(double));
    measures->scratch = (int)(at[count] / sizeof(double));
}

static inline void zd_find_arrays(int count, const size_t *at, double *scratch, void *frame)
{
    for (int i = 0; i < count; i++) {
        char *array = (char *)scratch + at[i];
        memcpy((char *)frame + (size_t)i * sizeof array, &array, sizeof array);
    }
}

/* Access to values and rates of marker quantities at one state. */

typedef struct zd_readings {
    double (*value)(const void *mechanism, const void *frame, int quantity);
    double (*rate)(const void *mechanism, const void *frame, int quantity);
    const void *mechanism, *frame;
    const double *inputs;       /* values of the user functions of forces, if some of these read reactions */
    double *x, *xdot, *out;     /* inputs of user functions, (longest,) each, and their output, (longest + 3,) */
} zd_readings;

static inline double zd_value_of(const zd_readings *at, int quantity) { return at->value(at->mechanism, at->frame, quantity); }
static inline double zd_rate_of(const zd_readings *at, int quantity) { return at->rate(at->mechanism, at->frame, quantity); }

/* Values of constraint rows and generalized forces at one state, with or without a user function. */

/* A row g(t, x) = 0 of (3), or a_i(t, x) xdot_i + a_0(t, x) = 0 of (5). */
typedef struct zd_combined {
    double value;           /* g of a user function; without one: minus the constant part, as the marker quantities are added by the caller */
    double explicit_rate;   /* explicit part of the rate in (5): dg/dt, or a_0 */
    double second;          /* part of (6) that does not contain second derivatives of the marker quantities */
    const double *factors;  /* dg/dx_i, or a_i: (terms,) */
} zd_combined;

/* These return ZD_DONE, or what the user function returns that failed: ZD_NOT_FINITE or ZD_CALLBACK. */
int zd_combine(const zd_planned_elements *elements, const zd_readings *at, const zd_relation *row, double t, zd_combined *all);
/* value <- the generalized force; rate <- the rate of its marker quantity, NULL: not wanted. */
int zd_force_evaluate(const zd_planned_elements *elements, const zd_readings *at, const zd_generalized_force *force, double t,
                      double *value, double *rate);
/* u <- the same with the reactions r that its user function reads; 0 if none has this user function. */
int zd_force_read(const zd_planned_elements *elements, const zd_readings *at, int law, double t, const double *r, double *u);
/* value <- a user function of t and of x (count,) alone */
int zd_law_evaluate(const zd_planned_elements *elements, const zd_readings *at, int law, int count, const double *x, double t, double *value);
/* zd_system.check_domain(), for all that has tables with ends. at NULL: ZD_DONE if these are tables of t, within their ends. */
int zd_laws_check(const zd_planned_elements *elements, const zd_readings *at, double rtol, double atol, double t);
/* zd_switches.evaluate() */
void zd_laws_compare(const zd_planned_elements *elements, const zd_readings *at, double t, double *difference);
int zd_forces_power(const zd_planned_elements *elements, const zd_readings *at, double t, double *power);     /* sum over all, for (28) */
/* Potential energy: V of gravity plus the energy stored in springs. */
double zd_springs_potential(const zd_planned_elements *elements, const zd_readings *at, double V);

/* Block structure and storage of C: each body is a block with a constant diagonal mass; the rows of a joint are a row group, and so is
 * each relation. */

typedef struct zd_packed {
    zd_structure structure;
    int size_of_C;          /* number of stored entries */
    int *at;                /* (m,) offset of each row in C */
    int *near, *far;        /* (terms,) offsets in the row of the entries of the first and second body; -1: the ground */
    int *coordinates, *velocities, *mass, *rows, *first, *block;    /* arrays of `structure` */
} zd_packed;

/* body <- the first and the second body of a marker quantity; 0 is the ground. */
typedef void zd_bodies_of(const void *quantities, int quantity, int body[2]);

/* Memory for so many bodies, rows and terms of rows. */
void zd_packed_create(zd_packed *self, zd_arena *arena, size_t bodies, size_t rows, size_t terms);
/* Fills in the structure; `coordinates` and `velocities` must be set. Returns -1, or the first row that has no entries, which is an error. */
int zd_packed_plan(zd_packed *self, const zd_planned_elements *elements, int bodies, zd_bodies_of *bodies_of, const void *quantities);
/* Lists the joints of each body: `end` and its offsets `at`, from zero, as both dimensions keep them. `joints` (count,): structs of `size`
 * bytes that begin with both bodies. */
void zd_list_ends(int count, const void *joints, size_t size, int bodies, int *at, int *end);
