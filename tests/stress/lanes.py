"""Random ensembles of built-in systems, beside their runs one by one.

Run it with ``python tests/stress/lanes.py 1000 [seed]``; it prints what was made, and fails where something differs.

Speeds go up to 450 times those of the systems' own starts, so that some runs fail, and others cannot be made in lanes. Each run
has the bits of ``ens[i]``. It succeeds, or fails, as by `simulate`, and ends at the same row; where it is further from that than
1e-9 of the largest value, a change of the start by 2^-50 of it changes the motion by a thousandth of that at least.
"""

import sys
import warnings
from collections import Counter

import numpy as np

import zerodrift as zd
from zerodrift.ensembles.part import ROADS

KINDS = ("four_bar", "slider_crank", "pendulum", "driven_four_bar", "knife_edge", "chaplygin_sleigh", "vertical_disc",
         "oscillator")
FIXED, CHOSEN = ("rk4", "heun", "midpoint", "euler", "dop853", "dormand_prince"), ("dop853", "dormand_prince")
ALIKE, SENSITIVE, CHANGE = 1e-9, 1e3, 2.0**-50


def options_of(chance, end):
    """Of `simulate`, at random."""
    fixed = bool(chance.integers(2))
    options = {"step": float(chance.choice([0.003, 0.01, 0.02, 0.05])), "integrator": str(chance.choice(FIXED))} if fixed else {
        "integrator": str(chance.choice(CHOSEN)), "rtol": 10 ** -chance.uniform(4, 11), "atol": 10 ** -chance.uniform(5, 11)}
    if not fixed or chance.integers(2):
        options["t_eval"] = np.unique(chance.uniform(0, end, size=int(chance.integers(1, 6))).round(5))
    elif chance.integers(2):
        options["save_every"] = int(chance.integers(1, 5))
    if chance.random() < 0.2:
        options["stabilization"] = None
    return options | {"vector": str(chance.choice(zd.runs.settings.VECTOR_UNITS[:zd._gateway.PROCESSOR_UNIT + 1]))}


def compare(system, name, start, end, options, again):
    """A run that has not failed, with what `simulate` makes."""
    def by_itself(change):
        return zd.simulate(system, end, v0=start * (1 + change), on_failure="return", **options)

    sol = by_itself(0)
    assert sol.success, (system, start, options, sol.message)
    assert np.array_equal(sol.t, again.t), (system, start, options)
    apart, size = np.abs(sol[name] - again[name]).max(), max(1.0, np.abs(sol[name]).max())
    if apart > ALIKE * size:
        other = by_itself(CHANGE)
        changed = np.abs(other[name] - sol[name]).max() if len(other.t) == len(sol.t) else np.inf
        assert apart <= SENSITIVE * changed, (system, start, options, apart)
    return apart / size


def study(chance):
    """One ensemble; how many of its runs took which road, or failed, and the largest difference."""
    system, count = getattr(zd.systems, chance.choice(KINDS))(), int(chance.integers(1, 20))
    end = float(chance.uniform(0.05, 0.6))
    shares = chance.choice([0.3, 1, 2, 5, 20, 300], size=count) * chance.uniform(0.5, 1.5, size=count)
    if system.name == "driven_four_bar":        # its start is what drives it
        shares[:] = 1
    starts, name, options = shares[:, None] * system.v0, system.coordinates[0].name, options_of(chance, end)
    ens = zd.ensemble(system, end, v0=starts, outputs=[name], threads=1, **options)
    made, worst = Counter(ROADS[road] for road in ens._part.roads), 0.0
    for run in range(count):
        if ens.failed[run]:
            made["failed"] += 1
            if ens._part.rows[run]:     # else it could not begin
                assert not zd.simulate(system, end, v0=starts[run], on_failure="return", **options).success
            continue
        again = ens[run]
        assert np.array_equal(again[name], ens[name][run][:len(again.t)])
        worst = max(worst, compare(system, name, starts[run], end, options, again))
    return made, worst


def main(count, seed=1):
    chance, made, worst = np.random.default_rng(seed), Counter(), 0.0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for _ in range(count):
            found, apart = study(chance)
            made, worst = made + found, max(worst, apart)
    print(f"{count} ensembles, seed {seed}: {dict(made)}; the largest difference from simulate is {worst:.1e}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
