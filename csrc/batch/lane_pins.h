/* Bodies joined by pins in lanes: where everything stands in the factors of C M^-1 C^T, and the memory of those that are being made. */
#ifndef ZD_LANE_PINS_H
#define ZD_LANE_PINS_H

#include "../linalg/blocks.h"
#include "../zerodrift.h"

/* An end of a pin, by the pin's place in the order of elimination. */
typedef struct zd_pin_end {
    int body;               /* -1: the ground */
    int point;              /* where its point begins among the numbers */
} zd_pin_end;

/* Two pins of one body, whose block of S is that of the row of the later one and of the column of the earlier. */
typedef struct zd_pin_pair {
    int later, earlier;     /* ends */
    int at;                 /* of the block in S */
    int is_first;           /* whether nothing has been added to that before */
    double sign;            /* 1 where the body is the first of both pins or the second of both, else -1 */
} zd_pin_pair;

typedef struct zd_lane_pins {
    const zd_pinned *of;
    const zd_blocks *blocks;    /* the symbolic factors of S; numbers stand in the lanes' own */
    int count;              /* of pins */
    int gravity;            /* where that stands among the numbers */
    const int *row;         /* (count,) the first row of C of the pin that has this place */
    const zd_pin_end *end;  /* (2 count,): of each pin by its place, the first and the second */
    const int *end_at, *of_body;    /* (bodies + 2,), (end_at[bodies],): which ends each body has */
    const int *pair_at;     /* (bodies + 1,): where its pairs begin in */
    const zd_pin_pair *pair;
    int fills;              /* blocks of S that no pair adds to */
    const int *fill;        /* (fills,) where they begin */
    /* What is the same while p is: so many numbers, each for all lanes beside each other */
    double *p;              /* (nq,): where that is */
    int is_turned, is_factored;     /* whether arms are those there, and S is factored there, in all lanes */
    double *arm;            /* (2 count, 2): from each body's mass centre to the pin, in the drawing's axes; of the ground from its origin */
    double *S;              /* (blocks->size,) */
    double *diagonal;       /* (2 count,): of S before it was factored */
    double *is_small;       /* whether a pivot was so small that solutions are looked at; */
    double *is_lost;        /* or that nothing is known */
    double *refines;        /* whether solutions are looked at in any case, as bodies contribute unequally to a pin */
    double *y;              /* (2 count,): right sides and solutions, in the order of elimination */
    double *lambda;         /* (2 count,): what y comes to, where solutions are looked at */
    double *rest, *step;    /* (2 count,), (nv,): of a solution that is looked at: what is left of C x = rhs, and what removes it */
} zd_lane_pins;

static inline int zd_lane_pins_numbers(const zd_pinned *of) { return 2 * of->bodies + 6 * of->pins + 2; }

/* What depends on no number, in memory of its own. */
typedef struct zd_pins_plan {
    const zd_pinned *of;
    zd_ordering ordering;       /* of the pins */
    int pairs;
} zd_pins_plan;

/* Returns 0 where there is no memory; else zd_pins_plan_free() has to follow. */
int zd_pins_plan_find(zd_pins_plan *self, const zd_pinned *of);
void zd_pins_plan_free(zd_pins_plan *self);
/* Only counts while the arena does. */
zd_lane_pins *zd_lane_pins_take(zd_arena *arena, const zd_pins_plan *plan, int lanes);
/* Whether bodies contribute unequally to a pin with these numbers, wherever they are: see schur_blocks.c. */
int zd_pins_are_unequal(const zd_pinned *of, const double *numbers);

#endif
