/* Closed-form functions by programs, for systems whose code is not compiled: the same operations, and the same bits.
 *
 * Plain declarations only: CFFI parses this text.
 */
#pragma once

#include "../include/zerodrift/closed_form.h"
#include "program.h"

/* Parts of what a function computes, in their order. */
enum zd_found {
    ZD_FOUND_PHI,           /* Phi (mh,) (3) */
    ZD_FOUND_DP,            /* dp (nq,) of (25a), (26a), (27a) */
    ZD_FOUND_DV,            /* dv (nv,) of (25b), (26b), (27b) */
    ZD_FOUND_RATES,         /* pdot (nq,) or nothing, vdot (nv,) */
    ZD_FOUND_MULTIPLIERS,   /* lambda (m,), power */
    ZD_FOUND_PIVOTS,        /* pivots, D (m, nv - m) or nothing */
    ZD_FOUND
};

typedef struct zd_function_program {
    const zd_instruction *part[ZD_FOUND];
    int first[ZD_FOUND];                    /* place in the frame of the first value of each part */
    const uint16_t *result[ZD_FOUND];       /* places of what each part gives */
} zd_function_program;

/* Functions of one order: zd_elimination.program. Frames have constants, t, p (nq,), v (nv,), v before the projection (nv,), added terms
 * (m,), then values of instructions. */
typedef struct zd_order_program {
    int nq, nv, mh, m;
    int pdot;                               /* nq, or 0 if pdot is v */
    int constants, pivots, D;
    int frame;                              /* values, at most ZD_FRAME */
    zd_function_program accelerate, correct, finish, embed;
} zd_order_program;

/* Functions that run them, for each vector unit and number of lanes: those of an order and of an embedding whose other members are not set.
 * The data of a system begin with a pointer to its constants; in lanes they are the constants. */
extern const zd_closed_form zd_closed_forms_by_programs[];
extern const int zd_sets_of_programs;
