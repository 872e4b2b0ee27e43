/* Uses of gauges as the core keeps them: rows of joints and relations in the order of C, efforts and measures. */
#ifndef ZD_COMMON_PLANNED_H
#define ZD_COMMON_PLANNED_H

#include "../../include/zerodrift/system.h"
#include "../../workspace.h"
#include "elements.h"

typedef struct zd_planned_elements {
    int relations, efforts, mh, m, longest;     /* `longest`: most terms of any row or effort */
    const zd_gauge_term *term;
    const double *coefficient;      /* those of the terms, one after another */
    const zd_relation *row;         /* (m,) of the joints and the relations given, holonomic ones first */
    const zd_row_owner *owner_of_row;   /* (m,) */
    const int *row_of_relation;     /* (relations,) */
    const zd_effort *effort;
    const zd_output_spec *output;
    zd_law *law;
    void *owner;
    const zd_compiled_law *compiled;    /* by the laws' numbers: those that need no `law`. NULL: there are none */
    int has_velocity_forces;        /* whether an effort depends on velocities, and is to be told them */
} zd_planned_elements;

/* What is filled in while rows are planned, and constant afterwards. */
typedef struct zd_element_parts {
    zd_gauge_term *term;
    double *coefficient;
    zd_relation *row;
    zd_row_owner *owner_of_row;
    int *row_of_relation;
    zd_effort *effort;
    zd_output_spec *output;
    zd_measure *measure;
    int terms, rows;                /* so many are there by now */
} zd_element_parts;

/* Memory for those given, and for so many terms and rows of joints more. */
void zd_elements_take(zd_element_parts *to, zd_arena *arena, const zd_elements *elements, size_t terms, size_t rows);
/* Copies terms, efforts and measures; rows are added one by one. */
void zd_elements_copy(const zd_elements *elements, zd_element_parts *to);
void zd_elements_add_term(zd_element_parts *to, int gauge, double coefficient);
void zd_elements_add_row(zd_element_parts *to, zd_relation row, zd_row_owner owner);
/* The row of a joint whose terms are those from `first` on. */
void zd_elements_add_joint_row(zd_element_parts *to, int first, int nonholonomic, int joint, int component);
/* Those of the relations, if they are nonholonomic or not. */
void zd_elements_add_relations(const zd_elements *elements, int nonholonomic, zd_element_parts *to);
/* Once all rows are there, of which the first `mh` are holonomic. */
zd_planned_elements zd_elements_plan(const zd_elements *elements, const zd_element_parts *from, int mh);
/* Which terms of (2), (3), (5) and (6) rows and efforts provide. */
int zd_elements_terms(const zd_elements *elements, const zd_planned_elements *planned);

#endif
