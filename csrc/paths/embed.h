/* Closed-form path of formulations in independent velocities: embed.c */
#ifndef ZD_EMBED_H
#define ZD_EMBED_H

#include "../motion/motion.h"

extern const zd_equations zd_equations_of_independent;      /* embedded_rate.c */

/* Allocates the fields of the path that only these formulations need. */
void zd_embed_create(zd_path *path, zd_arena *arena, const zd_system *system);
/* The elimination order whose dependent velocities are those not in the state, which it saves in the path; NULL: there is none. */
const zd_elimination *zd_embed_find(zd_motion *motion);
/* Sets the tolerance of Phi for a step that begins at the point. */
void zd_embed_begin(zd_motion *motion);
/* True if, at the point, an entry of D exceeds the bound up to which the formulation keeps its independent velocities. */
int zd_embed_is_steep(const zd_motion *motion);
/* The acceleration at the point, with the terms `added` to the right side of (6) */
int zd_embed_accelerate(zd_motion *motion, const double *added);
/* Counterparts of a formulation's unpack(), pack() and update(), for a step that begins or ends at the point. */
int zd_embed_unpack(zd_motion *motion, double t, const double *y);
int zd_embed_pack(zd_motion *motion, double *y);
int zd_embed_update(zd_motion *motion);
/* p and v of the path from the state; entries that the state does not have are estimates. */
void zd_embed_read(zd_motion *motion, double t, const double *y);
/* y <- the independent entries of p and v, or of their rates */
void zd_embed_write(const zd_motion *motion, const double *p, const double *v, double *y);

typedef struct zd_embedded {    /* outputs of an evaluation; D, lambda, power and pivots are NULL if not requested */
    double *D, *pdot, *vdot, *lambda, *power, *pivots;
} zd_embedded;
/* Dependent entries of the path's v and, with finds_p, of its p, from the independent ones; with them the requested outputs. */
int zd_embed_entries(zd_motion *motion, double t, int finds_p, const double *added, const zd_embedded *to);

#endif
