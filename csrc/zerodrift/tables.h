/* Statuses, terms and methods of the core, as tables that callers read: part of zerodrift.h. */
#ifndef ZERODRIFT_TABLES_H
#define ZERODRIFT_TABLES_H

#include <stddef.h>

#include "../include/zerodrift/system.h"

/* ---- statuses, the entries of ZD_STATUS_LIST ---- */

typedef struct zd_status_row {
    int status;
    const char *symbol;     /* "ZD_DONE" */
    const char *error;      /* name of the exception that Python raises; "": the base class, ZerodriftError */
    const char *sentence;   /* its meaning, for messages */
} zd_status_row;

const zd_status_row *zd_status_at(int row);     /* NULL: past the last entry */

/* ---- the terms of a system, the entries of ZD_TERM_LIST ---- */

typedef struct zd_term_entry {
    int term;               /* its bit */
    const char *symbol;     /* name of the bit: "ZD_M" */
    const char *name;       /* its member of zd_terms: "M" */
    const char *shape;      /* "ZD_MATRIX(nv, nv)" */
    size_t offset;          /* offset of the member in zd_terms, bytes */
    enum zd_depends depends;
    const char *text;
} zd_term_entry;

typedef struct zd_shape {
    int dimensions;         /* 0: a number, 1: (size[0],), 2: (size[0], size[1]) */
    int size[2];
} zd_shape;

const zd_term_entry *zd_term_at(int row);                         /* NULL: past the last entry */
zd_shape zd_term_shape(const zd_system *system, int row);       /* shape of the dense term in the equations */
size_t zd_term_size(const zd_system *system, int row);          /* number of doubles that evaluate() writes, packed if structured */

/* Cost of eliminating C W C^T of a declared structure, W = M^-1: numbers of multiplications to form C W C^T, to factor it, and to solve
 * with its factors. Entry [0] counts blocks for whose size there is a compiled kernel, entry [1] all other blocks. */
typedef struct zd_structure_work {
    int columns, blocks, rows;  /* block columns; blocks below the diagonal, fill-in included; scalar rows */
    double products[2], factors[2], solves[2];
    int has_products;           /* true if the system's own products replace C, so that C is not stored */
    int is_of_many;             /* true if there are so many constraints that bifurcations are not searched for */
    int is_alike;               /* true if the bodies of each constraint contribute similar amounts, so that solutions need no check */
    double share;               /* smallest relative pivot (pivot / its diagonal entry before elimination); 0: a pivot was not positive */
} zd_structure_work;

/* Counts the work at (t, p, v) = (0, p, 0), where M must be diagonal. All counts are 0 for a system without a structure. Fails with
 * ZD_NO_MEMORY, or with the status of evaluate(). */
int zd_structure_count(const zd_system *system, const double *p, zd_structure_work *work);

/* The bit of the first requested term with an entry that is not finite; 0 if all are finite. */
int zd_first_not_finite(const zd_system *system, int want, const zd_terms *terms);

/* Checks that sizes, terms and other members of a system agree; else ZD_BAD_ARGUMENT, with the reason in `message`. */
int zd_check_system(const zd_system *system, char *message, int message_size);

/* ---- the four tables ---- */

enum zd_table { ZD_SYSTEMS, ZD_FORMULATIONS, ZD_INTEGRATORS, ZD_CORRECTIONS };

int zd_entry_count(enum zd_table table);
const zd_card *zd_entry_card(enum zd_table table, int row);
int zd_entry_named(enum zd_table table, const char *name);    /* index of the entry of that name; -1: none */
int zd_default_entry(enum zd_table table);        /* index of the default entry */
int zd_correction_requires(int correction);     /* bits of the terms that a system must provide for this correction */
int zd_suits(const zd_system *system, int integrator);      /* true if the integrator applies to the system */
int zd_formulation_suits(const zd_system *system, int formulation);     /* likewise for a formulation */

const zd_kind *zd_kind_of(int row);

#endif
