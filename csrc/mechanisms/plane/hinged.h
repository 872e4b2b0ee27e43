/* Trees in which all bodies turn: mass matrix, bias, gravity and closing points from the sines and cosines of the angles alone.
 *
 * A point of such a tree is a sum of constant vectors, each turned by one angle. So with d = a_j - a_i the mass matrix has the entries
 * M_ij = K_ij cos d - X_ij sin d, of constants K and X, and no body has to be placed or moved.
 */
#pragma once

#include "../common/planned.h"
#include "tables.h"
#include "tree.h"

/* A vector that is turned by an angle; angles are numbered as in zd_plane_tree.angle. */
typedef struct zd_arm {
    int angle;
    zd_vector along;        /* the vector at angle zero */
} zd_arm;

typedef struct zd_hinged_pair {    /* a pair of different angles that M couples */
    int i, j;
    double K, X;
} zd_hinged_pair;

/* Two rows, x and y of a point of one body less a point of another: `constant` and the arms from `first` on. */
typedef struct zd_closure {
    int row;
    int first, arms;
    zd_vector constant;
} zd_closure;

typedef struct zd_hinged {
    int is_complete;               /* 1 if all bodies of the tree turn about revolute joints; otherwise the other members are not set */
    int pairs, closures, arms;
    int *angle;                 /* (bodies + 1,) which angle is that of each body, where it has one of its own */
    double *inertia;            /* (angles,) the diagonal of M */
    zd_vector *moment;          /* (angles,) kg m: of all that is further out, about the body's joint */
    zd_hinged_pair *pair;
    zd_closure *closure;
    zd_arm *arm;
    int *is_closure;            /* (m,) whether a row belongs to one */
} zd_hinged;

/* Memory for a tree of so many bodies, 0 where there is none, and at most so many rows. */
void zd_hinged_create(zd_hinged *self, zd_arena *arena, size_t bodies, size_t rows);
void zd_hinged_plan(zd_hinged *self, const zd_plane_tree *tree, const zd_planned_elements *elements, const zd_plane_quantity *quantity);

/* M, d, and the force of gravity; the arrays must be zero before. `sines` is from zd_plane_tree_turn(). */
void zd_hinged_mass(const zd_hinged *self, const zd_plane_tree *tree, const double *sines, double *M);
void zd_hinged_bias(const zd_hinged *self, const zd_plane_tree *tree, const double *sines, const double *v, double *d);
void zd_hinged_weight(const zd_hinged *self, const zd_plane_tree *tree, const double *sines, zd_vector gravity, double *f);
/* Phi, C, Phi_t and xi of rows that are closures, as far as they are wanted. */
void zd_hinged_close(const zd_hinged *self, const zd_plane_tree *tree, const double *sines, const double *v, int want, const zd_terms *out);
