/* The direct road of formulations in independent velocities: embed.c */
#ifndef ZD_EMBED_H
#define ZD_EMBED_H

#include "motion.h"

/* Memory of the road that this takes besides */
void zd_embed_take(zd_path *path, zd_arena *arena, const zd_system *system);
/* The order that solves for all velocities but those of the state, which the road notes; NULL: there is none. */
const zd_elimination *zd_embed_find(zd_motion *motion);
/* A step that begins at the point. */
void zd_embed_begin(zd_motion *motion);
/* Whether, at the point, a velocity that is solved for follows the others more steeply than the formulation keeps them for. */
int zd_embed_is_steep(const zd_motion *motion);
/* The acceleration at the point */
int zd_embed_accelerate(zd_motion *motion, const double *added);
/* p and v of the road from the state, as far as that has them: where it has not, they are estimates. */
void zd_embed_read(zd_motion *motion, double t, const double *y);
/* The state's entries of a p and v, or of their rates */
void zd_embed_write(const zd_motion *motion, const double *p, const double *v, double *y);

typedef struct zd_embedded {    /* results of an acceleration; D, lambda, power and pivots may be NULL */
    double *D, *pdot, *vdot, *lambda, *power, *pivots;
} zd_embedded;
/* The road's v, and where it has to be found its p, too, from the entries that the state has, and the results at these. */
int zd_embed_entries(zd_motion *motion, double t, int finds_p, const double *added, const zd_embedded *to);
/* embedded_rate.c */
int zd_motion_embedded_rate(void *motion, double t, const double *y, double *ydot);

#endif
