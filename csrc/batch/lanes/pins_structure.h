/* Bodies joined by revolute joints ("pins"), in lanes: structure of C M^-1 C^T, and memory of its factors. */
#ifndef ZD_LANE_PINS_H
#define ZD_LANE_PINS_H

#include "../../linalg/sparse/blocks.h"
#include "../../zerodrift.h"

/* One side of a pin, ordered by the pin's position in the elimination order. */
typedef struct zd_pin_end {
    int body;               /* index of its body; -1: the ground */
    int point;              /* index of its point in the data */
} zd_pin_end;

/* Two pins of one body: their block of S has the row of the later one and the column of the earlier. */
typedef struct zd_pin_pair {
    int later, earlier;     /* their ends */
    int at;                 /* index of the block in S */
    int is_first;           /* 1: the first contribution to that block */
    double sign;            /* 1 if the body is the first of both pins or the second of both, else -1 */
} zd_pin_pair;

typedef struct zd_lane_pins {
    const zd_pinned *of;
    const zd_blocks *blocks;    /* symbolic factors of S; the numbers are in `S` */
    int count;              /* number of pins */
    int gravity;            /* index of gravity in the data */
    const int *row;         /* (count,): first constraint of the pin at this position */
    const zd_pin_end *end;  /* (2 count,): both ends of each pin, by position */
    const int *end_at, *of_body;    /* (bodies + 2,), (end_at[bodies],): ends of each body */
    const int *pair_at;     /* (bodies + 1,): index of the first pair of each body */
    const zd_pin_pair *pair;
    int fills;              /* number of blocks of S without contributions: fill */
    const int *fill;        /* (fills,): their indices */
    /* Numbers that depend on p alone, the lanes of each adjacent. */
    double *p;              /* (nq,): the p at which they were computed */
    int is_turned, is_factored;     /* 1 in all lanes: arms are those at p; S is factored at p */
    double *arm;            /* (2 count, 2): arm from each body's mass centre (ground: origin) to the pin, m, fixed axes */
    double *S;              /* (blocks->size,) */
    double *diagonal;       /* (2 count,): diagonal of S before its factorization */
    double *is_small;       /* 1: solutions are verified, as a pivot was small */
    double *is_lost;        /* 1: a pivot was below ZD_REPORTED_PIVOT, so that the run has to be made individually, with its warning */
    double *refines;        /* 1: solutions are always verified, as bodies contribute unequally to a pin */
    double *y;              /* (2 count,): right-hand sides and solutions, in the order of elimination */
    double *lambda;         /* (2 count,): accumulated y, if solutions are verified */
    double *rest, *step;    /* (2 count,), (nv,): residual rhs - C x of a solution that is verified, and its correction */
} zd_lane_pins;

static inline int zd_lane_pins_numbers(const zd_pinned *of) { return 2 * of->bodies + 6 * of->pins + 2; }

/* Symbolic structure, independent of the data, in memory of its own. */
typedef struct zd_pins_plan {
    const zd_pinned *of;
    zd_ordering ordering;       /* elimination order of the pins */
    int pairs;
} zd_pins_plan;

/* Returns 0 without memory; else zd_pins_plan_free() must follow. */
int zd_pins_plan_find(zd_pins_plan *self, const zd_pinned *of);
void zd_pins_plan_free(zd_pins_plan *self);
/* Allocates; with an empty arena, only counts the memory. */
zd_lane_pins *zd_lane_pins_create(zd_arena *arena, const zd_pins_plan *plan, int lanes);
/* True if bodies contribute unequally to a pin with these data, in any position: see schur_blocks.c. */
int zd_pins_are_unequal(const zd_pinned *of, const double *numbers);

#endif
