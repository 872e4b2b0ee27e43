/* Elements in their planned form: rows of joints and relations in the order of C, generalized forces and measures. */
#ifndef ZD_COMMON_PLANNED_H
#define ZD_COMMON_PLANNED_H

#include "../../include/zerodrift/system.h"
#include "../../workspace.h"
#include "elements.h"

typedef struct zd_planned_elements {
    int relations, forces, mh, m, longest;     /* `longest`: maximum number of terms of a row or generalized force */
    double length;                  /* m: see zd_elements */
    const zd_quantity_term *term;
    const double *coefficient;      /* coefficients of the terms, contiguous */
    const zd_relation *row;         /* (m,) rows of joints and relations, holonomic ones first */
    const zd_row_owner *owner_of_row;   /* (m,) */
    const int *row_of_relation;     /* (relations,) */
    const zd_generalized_force *force;
    const zd_output_spec *output;
    zd_law *law;
    void *owner;
    const zd_compiled_law *compiled;    /* by index of the user function: compiled ones, used instead of `law`. NULL: there are none */
    zd_reading reading;             /* its arrays are those given; no functions: no user function reads reactions */
    int has_velocity_forces;        /* 1 if a generalized force depends on velocities, so that rates must be computed for the forces */
} zd_planned_elements;

/* Arrays that are filled while the rows are planned, and constant afterwards. */
typedef struct zd_element_parts {
    zd_quantity_term *term;
    double *coefficient;
    zd_relation *row;
    zd_row_owner *owner_of_row;
    int *row_of_relation;
    zd_generalized_force *force;
    zd_output_spec *output;
    zd_measure *measure;
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
/* Planned form, after all rows were added; the first `mh` are holonomic. */
zd_planned_elements zd_elements_plan(const zd_elements *elements, const zd_element_parts *from, int mh);
/* Bit mask of the terms of (2), (3), (5) and (6) that rows and generalized forces provide. */
int zd_elements_terms(const zd_elements *elements, const zd_planned_elements *planned);

#endif
