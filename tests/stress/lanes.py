"""Random ensembles of built-in and symbolic systems, beside their runs one by one.

Run it with ``PYTHONPATH=tests:tests/support python tests/stress/lanes.py 1000 [seed]``; it prints what was made, and fails
where something differs.

Speeds go up to 450 times those of the systems' own starts, so that some runs fail, and others cannot be made in lanes. Half of
the ensembles have events, some of which end their runs; a third have their energy corrected. Each run has the bits of
``ens[i]``, its events, too. It succeeds, or fails, as by `simulate`, and ends at the same row, with the same events; where it is
further from that than 1e-9 of the largest value, a change of the start by 2^-50 of it changes the motion by a thousandth of that
at least.
"""

import sys
import warnings
from collections import Counter

import numpy as np
import sympy as sp

import energy_models
import symbolic_counterparts
import zerodrift as zd
from zerodrift._private import gateway
from zerodrift.ensembles.part import PATHS
from zerodrift.runs.arguments import settings

KINDS = {name: getattr(zd.systems, name) for name in zd.systems.__all__} | {
    "slider_crank": lambda: energy_models.slider_crank().starting(v0=[1.0, -0.5, 0.0]), "arm": symbolic_counterparts.arm,
    "sleigh": symbolic_counterparts.chaplygin_sleigh}
FIXED, CHOSEN = ("rk4", "heun", "midpoint", "euler", "dop853", "dormand_prince"), ("dop853", "dormand_prince")
ALIKE, SENSITIVE, CHANGE = 1e-9, 1e3, 2.0**-50


def options_of(chance, end):
    """Random options of `simulate`."""
    fixed = bool(chance.integers(2))
    options = {"step": float(chance.choice([0.003, 0.01, 0.02, 0.05])), "integrator": str(chance.choice(FIXED))} if fixed else {
        "integrator": str(chance.choice(CHOSEN)), "rtol": 10 ** -chance.uniform(4, 11), "atol": 10 ** -chance.uniform(5, 11)}
    if not fixed or chance.integers(2):
        options["t_eval"] = np.unique(chance.uniform(0, end, size=int(chance.integers(1, 6))).round(5))
    elif chance.integers(2):
        options["save_every"] = int(chance.integers(1, 5))
    if chance.random() < 0.2:
        options["stabilization"] = None
    elif chance.random() < 0.2:
        options["stabilization"] = zd.Projection(every=int(chance.integers(2, 8)))
    if chance.random() < 1 / 3:
        options["energy"] = zd.EnergyCorrection(every=int(chance.integers(1, 4)))
    return options | {"vector": str(chance.choice(settings.VECTOR_UNITS[:gateway.PROCESSOR_UNIT + 1]))}


def events_of(system, chance, end):
    """Coordinates and velocities that reach what they are near, time, and expressions; some end the run."""
    names = [variable.name for variable in (*system.coordinates, *system.velocities)]
    found = []
    for _ in range(int(chance.integers(1, 4))):
        name, shift = str(chance.choice(names)), float(chance.normal())
        what, value = {0: (name, shift), 1: (sp.sin(sp.Symbol(name)), shift / 4), 2: (name, 0.0),
                       3: (sp.Symbol("t"), float(chance.uniform(0, end)))}[int(chance.integers(4))]
        direction, terminal = int(chance.integers(-1, 2)), int(chance.choice([0, 0, 1, 2]))
        found.append(zd.Event(what, value=value, direction=direction, terminal=terminal))
    return found


def distance(one, other, name):
    """Largest difference of two runs in their samples and events; infinite if their numbers of samples or events differ."""
    pairs = [(one.t, other.t), (one[name], other[name]), *zip(one.t_events or (), other.t_events or (), strict=True)]
    if one.message.rpartition(": ")[2] != other.message.rpartition(": ")[2] or any(len(a) != len(b) for a, b in pairs):
        return np.inf
    return max(np.abs(a - b).max(initial=0) for a, b in pairs)


def compare(system, name, start, end, options, again):
    """A run that has not failed, with what `simulate` makes."""
    def by_itself(change):
        return zd.simulate(system, end, v0=start * (1 + change), on_failure="return", **options)

    sol = by_itself(0)
    assert sol.success, (system, start, options, sol.message)
    apart, size = distance(sol, again, name), max(1.0, np.abs(sol[name]).max())
    if apart > ALIKE * size:
        assert apart <= SENSITIVE * distance(by_itself(CHANGE), sol, name), (system, start, options, apart)
    return apart / size


def study(chance):
    """One ensemble; numbers of its runs made in lanes, made individually, or failed, and the largest difference."""
    system, count = KINDS[chance.choice(list(KINDS))](), int(chance.integers(1, 20))
    end = float(chance.uniform(0.05, 0.6))
    shares = chance.choice([0.3, 1, 2, 5, 20, 300], size=count) * chance.uniform(0.5, 1.5, size=count)
    if system.name == "arm":        # its start is what drives it
        shares[:] = 1
    starts, name, options = shares[:, None] * system.v0, system.coordinates[0].name, options_of(chance, end)
    if chance.integers(2):
        options["events"] = events_of(system, chance, end)
    if "energy" in options and not system._core.has_energy:
        del options["energy"]
    ens = zd.ensemble(system, end, v0=starts, outputs=[name], threads=1, **options)
    made, worst = Counter(PATHS[path] for path in ens._part.paths), 0.0
    for run in range(count):
        if ens.failed[run]:
            made["failed"] += 1
            if ens._part.rows[run]:     # else it could not begin
                assert not zd.simulate(system, end, v0=starts[run], on_failure="return", **options).success
            continue
        again, rows = ens[run], ens._part.rows[run]
        assert np.array_equal(again[name][:rows], ens[name][run][:rows])
        for mine, its in zip(again.t_events or (), ens.t_events[run] or (), strict=True):
            assert np.array_equal(mine, its)
            made["events"] += len(mine)
        made["ended by events"] += again.status > 0
        made["energy corrections"] += again.stats["energy_corrections"]
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
