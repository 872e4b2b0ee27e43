/* The rate of the state that a formulation integrates, and its derivatives as jacobian.c finds them, for Python to compare. */
#include <string.h>

#include "../../csrc/constraints/rank.h"
#include "../../csrc/motion/motion.h"
#include "../../csrc/point/point.h"

extern const zd_formulation zd_independent, zd_mixed, zd_schur;

static const zd_formulation *const formulations[] = {&zd_independent, &zd_mixed, &zd_schur};

static zd_motion motion;
static zd_tally tally;
static double state[1000];

static void lay_out(zd_arena *arena, const zd_system *system, const zd_system *independent, int formulation)
{
    zd_motion_create(&motion, arena, system, independent, formulations[formulation], NULL, ZD_STOP);
    zd_motion_create_jacobian(&motion, arena);
    motion.tally = &tally;
}

static int place(double t, const double *p, const double *v)
{
    zd_point_move(motion.point, t, p, v);
    zd_point_normalise(motion.point);
    return zd_point_measure(motion.point);
}

/* At a place where all rows count that ever do; the memory is never given back. */
int begin(const zd_system *system, int formulation, double t, const double *p, const double *v)
{
    zd_system independent = *system;
    for (int turn = 0; turn < 2; turn++) {
        zd_arena counting = {NULL, 0};
        lay_out(&counting, system, &independent, formulation);
        zd_arena arena = {zd_allocate(counting.used), 0};
        lay_out(&arena, system, &independent, formulation);
        int status = place(t, p, v);
        if (!status && zd_constraints(system)) status = zd_redundancy_prepare(motion.point);
        if (!status && zd_constraints(system)) status = zd_motion_find_independent(&motion);
        if (!status && zd_constraints(system)) status = zd_redundancy_find(motion.point, ZD_STOP);
        if (status) return status;
        const zd_rank *rank = motion.point->rank;
        independent.mh = rank->max_rank_holonomic;
        independent.mn = rank->max_rank - rank->max_rank_holonomic;
    }
    zd_motion_attach(&motion, state);
    int status = place(t, p, v);
    return status ? status : motion.formulation->pack(motion.solver, motion.point, state);
}

int size(void) { return motion.rate.size; }
const double *start(void) { return state; }

int rate(double t, const double *y, double *ydot) { return motion.rate.evaluate(motion.rate.context, t, y, ydot); }

int jacobian(double t, const double *y, double *J)
{
    static double increment[1000];
    for (int i = 0; i < motion.rate.size; i++) increment[i] = 0x1p-26;
    return motion.rate.jacobian(motion.rate.context, t, y, increment, J);
}
