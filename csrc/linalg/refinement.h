/* Limits of iterative refinement, x <- x + solve(rhs - C x). */
#ifndef ZD_REFINEMENT_H
#define ZD_REFINEMENT_H

#define ZD_RESIDUAL_ROUNDING (8 * 0x1p-52)  /* residual relative to the terms of C x that needs no refinement */
#define ZD_GOOD_PIVOT 0x1p-10               /* pivot relative to the diagonal of C M^-1 C^T above which few digits are lost */
#define ZD_UNEQUAL_SHARES 0x1p6             /* largest ratio of the contributions of two bodies to one entry of that diagonal */
enum { ZD_MAX_REFINEMENTS = 40 };

#endif
