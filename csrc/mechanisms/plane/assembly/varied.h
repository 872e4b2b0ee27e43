/* Mechanisms that differ in their parameters, with the start of each.
 *
 * Plain declarations only: CFFI parses this text. SI units, radians.
 */
#pragma once

#include "../../common/assembly/given.h"
#include "../tables.h"

/* Tables of the first of so many mechanisms; entries of each that are bodies, joints, marker quantities, terms, relations and generalized
 * forces follow those of the one before. There are no laws. */
typedef struct zd_varied {
    zd_plane_tables moving;           /* in the coordinates that it moves in, with all of its measures */
    zd_plane_tables drawn;            /* in absolute coordinates, with the measures that the start holds */
    const double *gravity;      /* (runs, 2) */
    const double *poses;        /* (runs, bodies, 3): of mass centres, as drawn; NULL: starts are known, */
    const double *length;       /* (runs,) m: characteristic length of each */
    int targets;
    const zd_target *target;
    int drives;                 /* relations of constant speed, whose constants are 0 in the tables and set by the start */
    const int *drive;
} zd_varied;

/* Creates one mechanism, as zd_family requires; `of` is a zd_varied. */
const zd_system *zd_varied_make(const void *of, int64_t run, double *p, double *v, void **made);
void zd_varied_free(void *made);
/* Initial value of the coordinate of a constant-speed drive; `drive` is its index among the drives. */
double zd_varied_place(const void *of, const void *made, int drive);
