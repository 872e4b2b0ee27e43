/* The terms of a system, whichever they are. */
#ifndef ZD_TERMS_H
#define ZD_TERMS_H

#include "../zerodrift.h"

static inline int zd_constraints(const zd_system *system) { return system->mh + system->mn; }
static inline int zd_brings_times_A(const zd_system *system) { return system->operations && system->operations->times_A; }
/* Whether the rates of p are anything but v. */
static inline int zd_has_A(const zd_system *system) { return (system->provides & ZD_A) || zd_brings_times_A(system); }
/* Its products do without the entries of C. */
static inline int zd_needs_no_C(const zd_system *system) { return system->operations && system->operations->add_weighted; }

double **zd_term_in(zd_terms *terms, int row);      /* the member that a row of the list of terms is about */
const char *zd_term_name(int term);                 /* of the term with this bit */

#endif
