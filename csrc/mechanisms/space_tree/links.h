/* Connections of bodies to their parents, as determined by their inboard joints. */
#ifndef ZD_SPACE_TREE_LINKS_H
#define ZD_SPACE_TREE_LINKS_H

#include "../space/plan.h"

/* Three directions: those of a joint's frame, or of a body, and in whose axes is said where they stand. */
typedef struct zd_space_axes {
    zd_vector3 d[ZD_SPACE_AXES];
} zd_space_axes;

/* Freedom of the inboard joint of a body, in the order in which the joint's frame moves from the parent to the body. */
typedef struct zd_space_link_freedom {
    enum zd_space_freedom_kind kind;
    int direction;          /* index of the direction in the joint's moving frame */
    double sign;            /* -1 where the joint is taken backwards */
    double zero;            /* m: the distance along the direction where the coordinate is zero */
    double length;          /* m for each rad of what advances */
    int p, v;               /* its coordinates and velocities, from the first of all */
} zd_space_link_freedom;

typedef struct zd_space_link {
    int inner;              /* its parent; for a free body the ground */
    int is_free, turns;     /* turns: it has an orientation */
    int depth;              /* number of bodies from it down to the ground, itself included */
    int p, v, nq, nv;       /* its own coordinates and velocities */
    int freedoms;
    zd_space_link_freedom freedom[ZD_SPACE_FREEDOMS];
    zd_vector3 near, far;   /* the joint's point in the inner body's axes, and in its own */
    zd_space_axes near_axes, far_axes;   /* the joint's frame, in the same */
} zd_space_link;

/* Origins of the joint's frame in global axes, before each freedom and after the last. */
typedef struct zd_space_way {
    zd_vector3 at[ZD_SPACE_FREEDOMS + 1];
} zd_space_way;

typedef struct zd_space_composite {  /* a body with all that hangs on it, as if its joints were fixed */
    double mass;
    zd_vector3 first;           /* kg m: its mass times the way from the body's mass centre to its own */
    double second[6];           /* kg m^2: inertia about the body's mass centre, xx, yy, zz, xy, xz, yz, in global axes */
} zd_space_composite;

typedef struct zd_space_tree {
    int bodies, nq, nv;
    const zd_space_link *link;       /* (bodies + 1,), the first one unused */
    const int *order;           /* (bodies,) parents before children */
} zd_space_tree;

/* The tree's part of a frame, in its scratch. */
typedef struct zd_space_tree_frame {
    zd_space_twist *column;          /* (nv,) the twist of the body's mass centre where it moves by this velocity alone */
    zd_space_way *way;               /* (bodies + 1,) */
    zd_space_twist *change;          /* (bodies + 1,) accelerations */
    zd_space_composite *composite;   /* (bodies + 1,) */
} zd_space_tree_frame;

int zd_space_tree_frame_size(int bodies, int nv);
zd_space_tree_frame zd_space_tree_frame_of(const zd_space_tree *tree, const zd_space_frame *frame);

static inline const zd_space_tree *zd_space_tree_of(const zd_space *space) { return space->carrying.tree; }

#endif
