/* Table of a system's terms. */
#ifndef ZD_TERMS_H
#define ZD_TERMS_H

#include "../workspace.h"
#include "../zerodrift.h"

static inline int zd_constraints(const zd_system *system) { return system->mh + system->mn; }
static inline int zd_brings_times_A(const zd_system *system) { return system->operations && system->operations->times_A; }
/* True if pdot = A v with a kinematic matrix A, false if pdot = v. */
static inline int zd_has_A(const zd_system *system) { return (system->provides & ZD_A) || zd_brings_times_A(system); }
/* True if the system's own products replace the entries of C. */
static inline int zd_needs_no_C(const zd_system *system) { return system->operations && system->operations->add_weighted; }

double **zd_term_in(zd_terms *terms, int row);      /* address of the member for an entry of the list of terms */
const char *zd_term_name(int term);                 /* name of the term with this bit */
double *zd_take_inputs(zd_arena *arena, const zd_system *system);   /* (2 inputs + 1,): initial values; NULL without inputs */

#endif
