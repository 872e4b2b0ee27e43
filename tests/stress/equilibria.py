"""All models: equilibrium, steady motion, or neither and why, with the balance of forces and reactions. Writes equilibria.md.

OPENBLAS_NUM_THREADS=1 PYTHONPATH=python:tests:tests/support python tests/stress/equilibria.py
"""

import sys
import time
import warnings
from pathlib import Path

import numpy as np

import zerodrift as zd

TABLE = Path(__file__).with_suffix(".md")
SIZES = {"chain": {"links": 10}}        # the search from afar takes seconds; dense matrices end at 1,000 coordinates
STEADY = {"coin": {"coin.angular_velocity.z": 5.0}, "rolling_disc": {"disc.angular_velocity.z": 0.9}}       # on a circle
REMARKS = {"whipple_bicycle": "hangs below its plane, as nothing else is under it"}
BALANCED = 1e-10        # of the largest force


def off_balance(eq):
    """The largest entry of M vdot + d - f + C^T lambda, relative to the largest force."""
    terms = eq.system.evaluate(eq.p, eq.v, eq.t)
    force = (0 if terms.f is None else terms.f) - (0 if terms.d is None else terms.d)
    reaction = 0 if terms.C is None else terms.C.T @ eq.multipliers
    single = 0 if terms.C is None else np.abs(terms.C.T * eq.multipliers).max(initial=0.0)
    left = terms.M @ eq.vdot - force + reaction
    return float(np.abs(left).max() / max(np.abs(force).max(initial=0.0) + single, 1.0))


def violation(eq):
    """The largest violation of (3) and (5)."""
    terms = eq.system.evaluate(eq.p, eq.v, eq.t)
    parts = [np.zeros(1) if terms.Phi is None else terms.Phi]
    if terms.C is not None and eq.v.any():
        parts.append(terms.C @ eq.v + (0 if terms.Phi_t is None else terms.Phi_t))
    return float(max(np.abs(each).max(initial=0.0) for each in parts))


def searched(name):
    """Result for a model: word, equilibrium or None, remark."""
    m = getattr(zd.models, name)(**SIZES.get(name, {}))
    try:
        eq = zd.equilibrium(m)
    except zd.EquilibriumFailed as failed:
        reason = "its stable position lies where its equations end, flat on the plane" if name in STEADY else str(failed)
        if name not in STEADY:
            return "neither", None, reason
        return "steady motion", zd.equilibrium(m, v=STEADY[name]), f"no equilibrium: {reason}"
    if not eq.basis.shape[1]:
        return "equilibrium", eq, "its drive holds it"
    return "equilibrium", eq, REMARKS.get(name, "")


def row(name):
    """The line of a model, and its balance."""
    word, eq, remark = searched(name)
    if eq is None:
        return f"| {name} | {word} | | | | | {remark} |", np.inf
    stable = {True: "yes", False: "no", None: "not decided by the linearization"}[eq.stable]
    moving = eq.frequencies[np.abs(eq.eigenvalues.imag) > 0]
    lowest = f"{moving.min():.6g}" if moving.size else ""
    free = ", ".join(eq.free[:3]) + (f" and {len(eq.free) - 3} more" if len(eq.free) > 3 else "")
    off = max(off_balance(eq), violation(eq))
    size = f" ({', '.join(f'{key} = {value}' for key, value in SIZES[name].items())})" if name in SIZES else ""
    return f"| {name}{size} | {word} | {stable} | {lowest} | {off:.1e} | {free} | {remark} |", off


def table(names):
    """Lines of the table, and the largest imbalance."""
    rows = [row(name) for name in names]
    lines = ["| model | | stable | lowest frequency, Hz | balance | free directions | |", "|---|---|---|---|---|---|---|",
             *(line for line, _ in rows)]
    return lines, max(off for _, off in rows)


def main():
    """Searches for all and writes the table."""
    warnings.simplefilter("ignore")
    names = sys.argv[1:] or list(zd.models.__all__)
    lines, worst = table(names)
    head = [f"# Equilibria of {len(names)} models", "",
            f"Written by `tests/stress/equilibria.py`, zerodrift {zd.__version__}, in {time.strftime('%B %Y')}.", "",
            "`zd.equilibrium` from the start of each model. Balance: the larger of the largest entry of (2), relative to the",
            "largest force, and the largest violation of the constraints.", ""]
    text = [*head, *lines, "", f"Largest imbalance: {worst:.1e}; allowed: {BALANCED:g}."]
    if len(sys.argv) == 1:
        TABLE.write_text("\n".join(text) + "\n")
    print("\n".join(text))
    if worst > BALANCED:
        sys.exit("a balance is off")


if __name__ == "__main__":
    main()
