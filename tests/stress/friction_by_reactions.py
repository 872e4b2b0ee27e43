"""Random chains of joints whose friction reads the joint's force, against Newton and Euler's equations.

    python tests/stress/friction_by_reactions.py [FIRST] [LAST]

For each number, a chain in the plane and one in space, in joint and absolute coordinates: the largest error
of an angle must be below 1e-8. With so much friction that it has no unique solution at the start,
`NoUniqueMotion` must be raised. The exit code is 1 otherwise.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))

import zerodrift as zd
from friction_chains import beyond, mechanism, random_chain, reference

END = 0.15          # s
LARGEST = 1e-8      # rad


def error(chain, layout, expected):
    run = zd.Run(mechanism(chain).system(layout), integrator="dop853", rtol=1e-11, atol=1e-12)
    run.advance_to(END)
    return np.abs([run[f"pin{i}.angle"] for i in range(len(chain.masses))] - expected).max()


def is_refused(chain):
    try:
        zd.Run(mechanism(chain)).step(1)
    except zd.NoUniqueMotion:
        return True
    return False


def main(first=0, last=125):
    wrong = beyonds = 0
    largest = 0.0
    for seed in range(first, last):
        for dimension in (2, 3):
            chain = random_chain(seed, dimension)
            expected, determinant = reference(chain, END)
            errors = [error(chain, layout, expected) for layout in ("joint", "absolute")]
            largest, more = max(largest, *errors), beyond(chain)
            beyonds += more is not None
            is_wrong = max(errors) > LARGEST or (more is not None and not is_refused(more))
            wrong += is_wrong
            if is_wrong:
                print(f"wrong: number {seed}, dimension {dimension}, errors {errors}, least determinant {determinant:.3f}")
    print(f"{4 * (last - first)} runs, largest error {largest:.1e} rad; {beyonds} chains with more friction; {wrong} wrong")
    return wrong > 0


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
