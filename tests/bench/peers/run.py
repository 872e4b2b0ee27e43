"""Time against error of zerodrift and of what would be taken instead: the paper's four-bar, closed chains, Andrews' mechanism.

Run it with ``python tests/bench/peers/run.py``; it writes ``peers.csv``, ``peers_ratios.csv`` and ``peers.png`` in
``tests/bench/results``. What is not installed is named and left out: ``pip install '.[peers]'`` installs all but numbalsoda,
which needs a Fortran compiler, too. ``run.py --name compiled zerodrift scipy heyoka numba numbalsoda`` measures these alone,
for files ``compiled...``. On Andrews' mechanism there are those alone that take equations as they are written out.

All start from the same state and give the angles at the same times; the error is the largest of any angle at any of them. Timed
is what a user calls to get them, after the model is set up and after one call to warm up, in processor time: all use one thread,
and what else the machine does is not held against those that take long. The least of interleaved rounds counts.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
from comparing import AT, PEERS, installed, measured, report  # noqa: E402

CERTIFIED = 1e-9        # error asked of the reference, at most
NEAR_ROUNDING = 1e-11   # what rounding leaves of the four-bar is 4e-12
WRITTEN_OUT = ("zerodrift", "scipy", "heyoka", "numba", "numbalsoda")      # which take whatever equations are written out


def references(chain, peers):
    """Angles at the outputs, certified, and confirmed by the finest of SciPy's runs; or heyoka.py's with digits of 64 bits."""
    exact, error = peers["zerodrift"].reference(chain, CERTIFIED)
    other, _ = peers["scipy"].solve(chain, ("DOP853", 1e-13))
    apart = np.abs(exact - other).max()
    print(f"{chain.name}: reference known to {error:.1e} rad; SciPy's DOP853 at 1e-13 is {apart:.1e} rad away")
    assert apart < CERTIFIED, "two programs that share no code do not agree"
    if "heyoka" not in peers:
        return exact
    longer = peers["heyoka"].extended(chain)
    apart = np.abs(exact - longer).max()
    print(f"{chain.name}: heyoka.py in extended precision is {apart:.1e} rad away")
    assert apart < error, "the certificate does not hold"
    return longer


def main():
    """Measure, print, write and draw."""
    import andrews
    import problems

    there = [name for name in PEERS if (HERE / f"with_{name}.py").exists()]
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("peers", nargs="*", default=there, help=f"of {', '.join(there)}; zerodrift and scipy at least")
    asked.add_argument("--problem", action="append", help="one of the problems alone, such as four-bar; may be repeated")
    asked.add_argument("--every", type=int, default=1, help="measure every so many settings of each sweep alone")
    asked.add_argument("--name", default="peers", help="name of the files")
    asked = asked.parse_args()
    peers, rows = installed(asked.peers), []
    for chain in (problems.four_bar(), *map(problems.pendulum_chain, (3, 4, 6)), andrews.Squeezer()):
        if not asked.problem or chain.name in asked.problem:
            able = {name: peer for name, peer in peers.items() if name in WRITTEN_OUT or chain.name != "Andrews"}
            rows += measured(chain, references(chain, able), able, asked.every)
    report(rows, asked.name, (*AT, NEAR_ROUNDING) if "heyoka" in peers else AT)


if __name__ == "__main__":
    sys.exit(main())
