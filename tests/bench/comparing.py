"""Time against error of zerodrift and of what would be taken instead: what all comparisons with other programs share.

The error is the largest of any compared number at any output. Timed is what a user calls to get them, after the model is set up
and after one call to warm up, in processor time: all use one thread, and what else the machine does is not held against those
that take long. The least of interleaved rounds counts.
"""

import contextlib
import csv
import importlib
import itertools
import math
import os
from importlib import metadata
from pathlib import Path
from typing import NamedTuple

for library in ("OMP", "OPENBLAS", "MKL"):      # matrices are tiny: threads would only get in each other's way
    os.environ[f"{library}_NUM_THREADS"] = "1"

import matplotlib  # noqa: E402
import numpy as np  # noqa: E402

RESULTS = Path(__file__).resolve().parent / "results"
PEERS = {"zerodrift": "zerodrift", "scipy": "SciPy", "sundials": "SUNDIALS", "casadi": "CasADi", "exudyn": "Exudyn",
         "pinocchio": "Pinocchio", "mujoco": "MuJoCo", "heyoka": "heyoka.py", "numba": "numba", "numbalsoda": "numbalsoda",
         "pymunk": "pymunk"}
DISTRIBUTIONS = {"sundials": "scikit-sundae", "pinocchio": "pin"}
KINDS = {"Python system": ":", "absolute": "--"}      # how lines of zerodrift that run another kind of system are drawn
ROUNDS = 3
LONG_RUN = 0.3          # s: what takes longer is timed once more only
AT = (1e-3, 1e-6, 1e-9)     # errors at which methods are compared


class Row(NamedTuple):
    """Cost and error of one setting of one method."""

    problem: str
    peer: str
    method: str
    setting: str
    error: float
    seconds: float
    message: str


def installed(names, prefix="with_"):
    """The modules of the peers there are, by name; the others are said to be absent. Their files begin with the prefix."""
    there = {}
    for peer in names:
        try:
            there[peer] = importlib.import_module(f"{prefix}{peer}")
        except ImportError as error:
            print(f"{PEERS[peer]} is absent: {error}")
    for peer in there:
        with contextlib.suppress(metadata.PackageNotFoundError):       # as of a source tree
            print(f"{PEERS[peer]} {metadata.version(DISTRIBUTIONS.get(peer, peer))}")
    return there


def reference(drawing, peers, steps):
    """The motion at the outputs, certified; and it says how far from it Exudyn's is, which shares no code.

    Exudyn's motion is extrapolated to steps of no length, from runs with two numbers of `steps` between outputs.
    """
    exact, error = peers["zerodrift"].reference(drawing)
    print(f"{drawing.name}: reference known to {error:.1e}")
    if "exudyn" in peers:
        coarse, fine = (peers["exudyn"].solve(drawing, ("Newmark, index 2", "dense", each))[0] for each in steps)
        apart = np.abs(exact - (4 * fine - coarse) / 3).max()       # the method has order two
        print(f"{drawing.name}: Exudyn's runs, extrapolated, are {apart:.1e} away")
        assert apart < 1e-5, "two programs that share no code do not agree"
    return exact


def measured(chain, exact, peers, every):
    """All rows of one problem, whose exact numbers at the outputs are given, of every so many settings."""
    rows = {}
    cases = [(peer, method, setting) for peer, module in peers.items()
             for method, settings in module.sweeps(chain).items() for setting in settings[::every]]
    for case in cases:
        rows[case] = first(chain, peers, case, exact)
    for round_ in range(ROUNDS):
        for case, row in rows.items():
            if math.isfinite(row.error) and (row.seconds < LONG_RUN or round_ == 0):
                seconds = peers[case[0]].solve(chain, case[2])[1]
                rows[case] = row._replace(seconds=seconds if round_ == 0 else min(row.seconds, seconds))
    return list(rows.values())


def first(chain, peers, case, exact):
    """The error of one setting; its time is that of the warm-up."""
    peer, method, setting = case
    text = " ".join(f"{item:.3g}" if isinstance(item, float) else str(item) for item in setting if item is not None)
    try:
        with np.errstate(all="ignore"):
            p, seconds = peers[peer].solve(chain, setting)
    except Exception as problem:      # whatever a peer raises where its method does not get through
        return Row(chain.name, PEERS[peer], method, text, math.nan, math.nan, " ".join(str(problem).split())[:100])
    if p.shape != exact.shape or not np.isfinite(p).all():
        return Row(chain.name, PEERS[peer], method, text, math.nan, math.nan, "did not reach the end")
    return Row(chain.name, PEERS[peer], method, text, np.abs(p - exact).max(), seconds, "")


def least(rows, error):
    """The shortest time in which an error is reached."""
    return min((row.seconds for row in rows if row.error <= error), default=math.nan)


def ratios(rows, errors):
    """Per problem, peer and method: the least time at each error, over that of the best of zerodrift's."""
    for problem in dict.fromkeys(row.problem for row in rows):
        here = [row for row in rows if row.problem == problem]
        own = [least([row for row in here if row.peer == "zerodrift"], error) for error in errors]
        yield problem, "zerodrift's best, in ms", [1e3 * seconds for seconds in own]
        for column in ("peer", "method"):
            for name in dict.fromkeys(getattr(row, column) for row in here):
                of = [row for row in here if getattr(row, column) == name]
                yield (problem, f"best of {name}" if column == "peer" else name,
                       [least(of, error) / best for error, best in zip(errors, own, strict=True)])


def write(path, header, rows):
    """A table."""
    with path.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(header)
        table.writerows(rows)


def draw(rows, path):
    """Error against time, a panel for each problem, a colour for each peer."""
    matplotlib.use("Agg")
    from matplotlib.lines import Line2D

    import zerodrift as zd

    problems = list(dict.fromkeys(row.problem for row in rows))
    figure, axes = zd.plot.panels(2, math.ceil(len(problems) / 2), width=12, height=9)
    colours = dict(zip(dict.fromkeys(row.peer for row in rows), itertools.cycle(zd.plot.COLOURS), strict=False))
    markers, used = "os^Dv<>pPX*hd8H", {}
    for problem, ax in zip(problems, axes.flat, strict=False):
        for method in dict.fromkeys(row.method for row in rows if row.problem == problem):
            of = [row for row in rows if (row.problem, row.method) == (problem, method) and row.error < 1]
            if not of:
                continue
            mine = used.setdefault(of[0].peer, {})
            name = method.split(": ")[-1] if of[0].peer == "zerodrift" else method
            marker = markers[mine.setdefault(name, len(mine))]
            dashes = next((dashes for kind, dashes in KINDS.items() if kind in method), "-")
            ax.plot([1e3 * row.seconds for row in of], [row.error for row in of], dashes,
                    color=colours[of[0].peer], marker=marker, markersize=4, linewidth=1.8 if of[0].peer == "zerodrift" else 0.9)
        ax.set(xscale="log", yscale="log", xlabel="time [ms]", ylabel="max |error| [rad, m]", title=problem,
               ylim=(1e-13, 1))
    handles = [Line2D([], [], color=colours[peer], marker=markers[place], markersize=4,
                      label=name if name.startswith(peer) else f"{peer}: {name}")
               for peer, names in used.items() for name, place in names.items()]
    handles += [Line2D([], [], color=colours["zerodrift"], linestyle=dashes, label=f"zerodrift, {kind}")
                for kind, dashes in KINDS.items() if any(kind in row.method for row in rows)]
    figure.legend(handles=handles, loc="outside right center", frameon=False, fontsize="small")
    figure.savefig(path, dpi=110)


def report(rows, name, errors=AT):
    """Print all rows and ratios, write them to tables of this name, and draw them."""
    for row in rows:
        print(f"{row.problem:20} {row.method:52} {row.setting:28} "
              + (row.message or f"{row.error:9.1e} {1e3 * row.seconds:10.3f} ms"))
    table = list(ratios(rows, errors))
    print(f"\ntime to reach an error, over that of zerodrift's best\n{'':74}" + "".join(f"{error:>10.0e}" for error in errors))
    for problem, method, numbers in table:
        print(f"{problem:20} {method:52} " + "".join(f"{number:10.3g}" for number in numbers))
    write(RESULTS / f"{name}.csv", Row._fields,
          [(*row[:4], f"{row.error:.3g}", f"{row.seconds:.3g}", row.message) for row in rows])
    write(RESULTS / f"{name}_ratios.csv", ["problem", "method", *(f"at {error:.0e}" for error in errors)],
          [(problem, method, *(f"{number:.3g}" for number in numbers)) for problem, method, numbers in table])
    draw(rows, RESULTS / f"{name}.png")
