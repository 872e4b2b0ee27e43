"""zerodrift: the four-bar as it is built in; chains written in SymPy and compiled, and written in NumPy; the model of Andrews."""

import functools
import itertools
import sys
import time
from pathlib import Path

import numpy as np

import zerodrift as zd

try:
    import sympy
    sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "support"))
    import energy_models
except ImportError:
    sympy = None

TOLERANCES = 10.0 ** -np.arange(2, 14, 0.5)
STEPS = (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128)     # between outputs


def kinds(chain):
    """Kinds of systems by which zerodrift can describe the chain: name to factory."""
    if chain.name == "four-bar":
        return {"built in": lambda chain: zd.systems.four_bar()} | ({"compiled": compiled_system} if sympy else {})
    if chain.name == "Andrews":
        return {"compiled": lambda chain: energy_models.andrews()}
    return ({"compiled": compiled_system} if sympy else {}) | {"Python system": python_system}


@functools.cache
def system_of(chain, kind):
    """Made once."""
    return kinds(chain)[kind](chain)


def compiled_system(chain):
    """From its energies and constraints in SymPy; the compiled code is kept for the next time."""
    p, v = sympy.symbols(f"p:{chain.n}"), sympy.symbols(f"v:{chain.n}")
    pairs = itertools.product(range(chain.n), repeat=2)
    return zd.symbolic(
        p, speeds=v,
        kinetic=sum(chain.coupling[i, j] * sympy.cos(p[i] - p[j]) * v[i] * v[j] for i, j in pairs) / 2,
        potential=sum(w * sympy.sin(angle) for w, angle in zip(chain.weight, p, strict=True)),
        constraints=[sum(length * sympy.cos(angle) for length, angle in zip(chain.lengths, p, strict=True)) - chain.distance,
                     sum(length * sympy.sin(angle) for length, angle in zip(chain.lengths, p, strict=True))],
        p0=chain.p0, v0=chain.v0, name=f"chain_of_{chain.n}")


def python_system(chain):
    """In NumPy, with all terms given."""
    K, w, lengths, distance = chain.coupling, chain.weight, chain.lengths, chain.distance

    def mass(p):
        c, s = np.cos(p), np.sin(p)
        return K * (np.outer(c, c) + np.outer(s, s))

    def force(p, v):
        c, s, squares = np.cos(p), np.sin(p), v * v
        return c * (K @ (s * squares)) - s * (K @ (c * squares)) - w * c

    return zd.System(
        [f"alpha{i + 1}" for i in range(chain.n)],
        mass=mass,
        force=force,
        constraints=lambda p: np.array([lengths @ np.cos(p) - distance, lengths @ np.sin(p)]),
        jacobian=lambda p: np.array([-lengths * np.sin(p), lengths * np.cos(p)]),
        xi=lambda p, v: np.array([lengths * np.cos(p), lengths * np.sin(p)]) @ (v * v),
        p0=chain.p0, v0=chain.v0, name=chain.name)


def sweeps(chain):
    """The settings of each method."""
    found = {}
    for kind, formulation in itertools.product(kinds(chain), ("schur", "independent")):
        few = kind == "Python system"
        label = f"zerodrift, {kind}: {formulation}"
        for integrator in ("rk4", "dop853"):
            found[f"{label}, {integrator}, fixed steps"] = [(kind, formulation, integrator, k, None, False)
                                                            for k in (STEPS[:10] if few else STEPS)]
        for integrator in ("dop853",) if few else _chosen(system_of(chain, kind), formulation):
            found[f"{label}, {integrator}, adaptive steps"] = [(kind, formulation, integrator, None, tolerance, False)
                                                             for tolerance in (TOLERANCES[::2] if few else TOLERANCES)]
        if not few and formulation == "schur" and chain.name != "Andrews":      # to whose energy a moment adds
            for integrator in ("rk4", "dop853"):
                found[f"{label}, {integrator}, fixed steps, energy"] = [(kind, formulation, integrator, k, None, True)
                                                                        for k in STEPS]
            found[f"{label}, dop853, adaptive steps, energy"] = [(kind, formulation, "dop853", None, tolerance, True)
                                                               for tolerance in TOLERANCES]
    return found


def _chosen(system, formulation):
    """Integrators that choose their steps, as far as the system has what they need: Taylor's method goes with states (p, v).

    Radau's, which is for stiff systems, is there once.
    """
    wanted = ("dormand_prince", "dop853") + (("taylor", "radau") if formulation == "schur" else ())
    return [name for name in wanted if name in zd.integrators(system)]


def solve(chain, setting):
    """Angles (k, n) at the outputs, and seconds of the whole call of `simulate`."""
    kind, formulation, integrator, steps, tolerance, energy = setting
    system = system_of(chain, kind)
    fine = ({"step": chain.spacing / steps, "save_every": steps} if steps
            else {"rtol": tolerance, "atol": tolerance, "t_eval": chain.outputs})
    start = time.process_time()
    solution = zd.simulate(system, chain.t_end, chain.p0, chain.v0, formulation=formulation, integrator=integrator, energy=energy,
                           **fine)
    return solution.p, time.process_time() - start


def reference(chain, error):
    """Angles (k, n) with a certified error, and that error: by two formulations of which rounding makes little here."""
    system = system_of(chain, next(iter(kinds(chain))))
    found = zd.reference(system, chain.t_end, chain.p0, chain.v0, error=error, t_eval=chain.outputs,
                         formulations=("schur", "nullspace"))
    return found.solution.p, found.error
