"""The examples of W. Blajer, "Elimination of Constraint Violation and Accuracy Aspects in Numerical Simulation of
Multibody Systems", Multibody System Dynamics 7 (2002), section 4: their numbers, and nothing else.

`reference` has exact motions, `claims` the paper's claims and measured values, `figures` Figures 4-9,
`reproduce` all of them in a folder: ``python -m zerodrift reproduce``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from .. import systems
from ..runs.arguments.methods import Baumgarte, Projection
from ..runs.open.diagnosis import unwarned
from ..runs.samples.solution import Solution
from ..runs.simulate import simulate
from ..systems.builtin import BuiltIn

__all__ = ["FOUR_BAR", "FOUR_BAR_REFERENCE", "OSCILLATOR", "ROUND_OFF", "STEP", "Example", "run"]


def __dir__() -> list[str]:
    return __all__      # and not what is imported


@dataclass(frozen=True, repr=False)
class Example:
    """Example of the paper: a system, its end time, and the settings of its cases.

    Attributes
    ----------
    system : system
    end : float
        End time in s.
    cases : dict
        Arguments of `zerodrift.simulate` by the letter of the case in the paper.
    """

    system: BuiltIn
    end: float
    cases: dict[str, dict[str, Any]]

    def __repr__(self) -> str:
        parameters = self.system.parameters.items()
        units = {parameter.name: parameter.unit for parameter in self.system._kind.parameters}
        lines = [f"{self.system.name}, 0 ... {self.end:g} s"]
        lines += [f"  {name} = {value} {units[name]}".rstrip() for name, value in parameters if value is not None]
        for case, settings in self.cases.items():
            lines.append(f"  {case}: " + ", ".join(f"{name}={value!r}" for name, value in settings.items()))
        return "\n".join(lines)


STEP = 0.05         # s, of cases (a)-(d)
ROUND_OFF = 1e-14   # m, of the projections: what "no violation" means in double precision

FOUR_BAR = Example(
    system=systems.four_bar(lengths=(1.0, 0.3, 1.0, 0.6), masses=(1.5, 5.0, 3.0), gravity=9.81, assembly="open",
                            crank_angle=math.pi / 2, crank_rate=1.0),
    end=8.0,
    cases={
        "(a) no control": {"step": STEP, "formulation": "augmented", "stabilization": None},
        "(b) Baumgarte": {"step": STEP, "formulation": "augmented", "stabilization": Baumgarte(alpha=10.0, beta=25.0)},
        "(c) projection": {"step": STEP, "formulation": "augmented", "stabilization": Projection(tol=ROUND_OFF)},
        "(d) projection and energy": {"step": STEP, "formulation": "augmented",
                                      "stabilization": Projection(tol=ROUND_OFF), "energy": True},
    })

# The paper's own reference solution for example 1.
FOUR_BAR_REFERENCE: dict[str, Any] = {"step": 0.0005, "formulation": "augmented", "stabilization": None}

OSCILLATOR = Example(
    system=systems.oscillator(mass=1.0, stiffness=10.0, x0=0.1, v0=0.0),
    end=10.0,
    cases={
        "(a) RK4": {"step": 0.1, "integrator": "rk4"},
        "(b) RK4 and energy": {"step": 0.1, "integrator": "rk4", "energy": True},
        "(c) Newmark": {"step": 0.025, "integrator": "trapezoidal"},
        "(c) Newmark, equal step": {"step": 0.1, "integrator": "trapezoidal"},
    })


def run(example: Example) -> dict[str, Solution]:
    """All cases of an example; one that ends early is kept as far as it came.

    Examples
    --------
    >>> from zerodrift import paper
    >>> runs = paper.run(paper.OSCILLATOR)
    >>> len(runs["(a) RK4"].t)
    101
    """
    with unwarned():
        return {case: simulate(example.system, example.end, on_failure="return", closed_form=False, **settings)
                for case, settings in example.cases.items()}
