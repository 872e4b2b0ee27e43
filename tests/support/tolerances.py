"""The one table of tolerances, each with its reason. Relative to the size of what is compared, unless a unit is given."""

EPS = 2.0**-52

# ---- round-off ----
SAME = 64 * EPS             # the same few dozen operations, done in another order
SOLVED = 64 * EPS           # a linear solve by another elimination; times the condition number of its matrix
STEPPED = 1e-11             # a few steps of a method written a second time: SOLVED and SAME through a hundred evaluations
ENERGY = 32 * EPS           # E after (29), of T + |V| + |E0|: the balance is a difference of these three, each a sum of products
VELOCITY = 256 * EPS        # |Psi| after (25b), of sum |C v|: what one solve leaves, its condition included
IMPLICIT = 64 * EPS         # defect of an implicit step among its terms: the core iterates to 4 EPS, our own f differs by SOLVED

REACTION = 1e-10            # random mechanisms in two kinds of coordinates: SOLVED times conditions up to 1e3, through joints
EXACT = 128 * EPS           # against exact arithmetic, masses nine powers of ten apart: with no condition number beside it

# ---- truncation ----
DIFFERENCE = 1e-9           # five-point differences at 1e-3: 1e-12 truncation, 1e-13 round-off, and derivatives of size 1e2
ORDER = 0.2                 # observed against declared order, up to four: what the next term of the error contributes
HIGH_ORDER = 0.9            # above: two or three refinements lie between too coarse a step and round-off
MEASURABLE = 1e-11          # below this the difference of two runs is round-off, and has no order
CONVERGED = 1e-8            # motions with step 1e-3 over half a second: the fourth order leaves 1e-10 where rates are near 10/s
REFERENCE = 1e-8            # against DOP853 at rtol 1e-12, for a run at step 1e-3

# ---- physics ----
START = 1e-10               # |Phi|, |Psi| that a start may have: START_TOLERANCE of csrc/run/create.c
KEYBOARD = 0.1              # s: from Ctrl-C to the partial solution, as promised

# ---- the machine ----
HUNG = 600                  # s: what takes longer will not end; Dask of 2024 has taken 120 on a busy machine, of which 25 at work
