"""Random mechanisms with friction that reads joint forces, against dense equations that share nothing with the program.

    python tests/stress/friction_by_reactions.py [FIRST] [LAST]

For each number a chain and a closed loop, in the plane and in space, with friction up to half of that with which it has no unique
solution at the start, whatever its arm is: the error of an angle must be below 1e-8, in joint and absolute coordinates by
turns. With 1.2 times that friction `NoUniqueMotion` must be raised. The exit code is 1 otherwise.
"""

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

import friction_chains as chains
import friction_loops as loops
import zerodrift as zd

END = 0.02          # s
LARGEST = 1e-8      # rad
BEYOND = 5          # numbers of which more friction is tried, too


def scenes(seed, dimension):
    """Name, module, scene with its friction, and one with too much or None"""
    share = np.random.default_rng(1000 + seed).uniform(0.05, 0.5)
    chain, loop = chains.random_chain(seed, dimension), loops.random_loop(seed, dimension)
    for name, module, scene in (("chain", chains, chain), ("loop", loops, loop)):
        more = module.critical(scene)
        yield name, module, scene if more is None else scene._replace(c=share * more.c), more and more._replace(c=1.2 * more.c)


def last_angle(module, scene, layout):
    run = zd.Run(module.mechanism(scene).system(layout), integrator="dop853", rtol=1e-11, atol=1e-12)
    run.advance_to(END)
    return run["pin0.angle" if module is chains else "A.angle"]


def is_refused(module, scene):
    try:
        zd.Run(module.mechanism(scene)).step(1)
    except zd.NoUniqueMotion:
        return True
    return False


def compared(seed, dimension):
    """Kind of mechanism, error in rad, least determinant, and whether more friction is refused; None: not tried"""
    for name, module, scene, more in scenes(seed, dimension):
        try:
            angle, least = module.reference(scene, END)
        except ValueError:      # the motion comes to Painleve's friction on its way
            angle, least = np.nan, 0.0
        try:
            found = last_angle(module, scene, ("joint", "absolute")[seed % 2])
            error = np.inf if least <= 0 else abs(found - np.ravel(angle)[0])
        except zd.NoUniqueMotion:       # wrong, unless the determinant is negative on the way
            error = 0.0 if least <= 0 else np.inf
        yield f"{name}, {dimension}D", error, least, is_refused(module, more) if more and seed < BEYOND else None


def main(first=0, last=125):
    rows = {}
    for seed in range(first, last):
        for dimension in (2, 3):
            for kind, *found in compared(seed, dimension):
                rows.setdefault(kind, []).append(found)
                if found[0] > LARGEST or found[2] is False:
                    print(f"wrong: number {seed}, {kind}, error {found[0]:.1e} rad, refused {found[2]}", flush=True)
    wrong = 0
    print("mechanism    scenes  largest error  least determinant  beyond  refused")
    for kind, found in rows.items():
        beyond = [each[2] for each in found if each[2] is not None]
        bad = sum(each[0] > LARGEST for each in found) + beyond.count(False)
        wrong += bad
        print(f"{kind:12} {len(found):6}  {max(each[0] for each in found):9.1e} rad  {min(each[1] for each in found):17.3f}"
              f"  {len(beyond):6}  {sum(beyond):7}")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
