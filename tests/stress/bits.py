"""A hash of every bit of many runs, to compare two versions of the package that must compute the same.

    OPENBLAS_NUM_THREADS=1 PYTHONPATH=python:tests:tests/support python tests/stress/bits.py > before
    ...
    OPENBLAS_NUM_THREADS=1 PYTHONPATH=python:tests:tests/support python tests/stress/bits.py | diff before -

One line for each built-in system, model, symbolic system and random symbolic system, in each kind of coordinates, with each
formulation and some integrators, fixed and adaptive. Failures are part of it, by the type of their error.
"""

import hashlib
import itertools
import warnings

import numpy as np

import zerodrift as zd
from every_model import IN_SPACE, MECHANISMS, MODELS
from random_symbolic import random_system

RUNS = tuple({"formulation": formulation, **how} for formulation, how in itertools.product(
    ("augmented", "nullspace", "schur", "mixed", "independent"),
    ({"integrator": "rk4", "step": 0.004}, {"integrator": "dormand_prince", "rtol": 1e-6, "atol": 1e-8},
     {"integrator": "radau", "step": 0.01}, {"integrator": "trapezoidal", "step": 0.01, "closed_form": False})))
DURATION = 0.08
MANY = 300              # velocities: of more, dense matrices and Newton iterations would take hours


def bits(system, options):
    """The hash of a run's samples, or the type of the error that ends it."""
    try:
        sol = zd.simulate(system, DURATION, on_failure="return", **options)
    except Exception as error:
        return type(error).__name__
    found = hashlib.sha256()
    for each in (sol.t, sol.p, sol.v, sol.multipliers):
        found.update(np.ascontiguousarray(each).tobytes())
    return f"{found.hexdigest()[:16]} {len(sol.t)}"


def systems():
    """Systems with their names; those that cannot be made in a kind of coordinates are left out."""
    yield from ((f"systems.{name}", getattr(zd.systems, name)()) for name in zd.systems.__all__)
    for name, make in (MECHANISMS | IN_SPACE).items():
        for kind in ("joint", "absolute"):
            try:
                yield f"models.{name} {kind}", make().system(kind)
            except (zd.ZerodriftError, ValueError) as error:
                print(f"models.{name} {kind}: {type(error).__name__}")
    yield from ((f"symbolic.{name}", make()) for name, make in MODELS.items())
    yield from ((f"random {seed}", random_system(seed)) for seed in range(12))


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    for name, system in systems():
        for options in RUNS:
            if system.nv > MANY and (options["formulation"], options["integrator"]) != ("schur", "rk4"):
                continue
            print(name, *options.values(), bits(system, options), flush=True)
