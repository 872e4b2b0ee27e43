"""Start of a mechanism: values of measures that are held or wished."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..._private import checks
from ..._private.types import Values
from ...errors import WrongType, WrongValue
from ..elements.forces import Actuator
from ..elements.frames import given_rotation
from ..elements.measures import name_of
from ..equations.measure_names import checked_reading
from .registry import Elements


class StartVerbs(Elements):
    """Method of `Mechanism` for initial values."""

    def __init__(self, parameters: Any) -> None:
        super().__init__(parameters)
        self._held: dict[str, Any] = {}
        self._wished: dict[str, Any] = {}
        self._is_balanced = False

    def start(self, held: Values | None = None, *, wish: Values | None = None, equilibrium: bool | None = None) -> None:
        """Set initial positions and velocities. Other coordinates start as drawn and at rest, as far as loops and drives allow.

        Joint coordinates that neither values given here nor drives determine stay as in the drawing with its joints closed, and
        their rates are zero: the angle of a pendulum on a cart does not change with the cart's position. Coordinates of a loop
        or a coupling that contains a forced one move as little as possible in the mass metric. A coordinate whose speed a drive
        prescribes keeps its drawn value, even if lengths change, unless values given here move it. Where joint coordinates
        cannot stay, as in a singular drawing, all bodies move as little as possible in the mass metric. The printed mechanism
        names joints that are drawn open and bodies that do not start as drawn; a run warns of a large gap, and of a drive that
        cannot start as drawn, see `DrawingWarning`.

        Velocities that remain undetermined have the least kinetic energy relative to a reference motion, in which connected
        bodies that a drive leaves undetermined move rigidly with one that it moves if no constraint prevents this, or else
        translate with a driven point; in mechanisms of more than 1,000 constraints or velocities in absolute coordinates,
        relative to the ground. Rates given here change the velocities by the least kinetic energy. The printed mechanism lists
        velocities that start undetermined.

        Parameters
        ----------
        held : dict of measure to value
            Values to satisfy: positions and velocities by object or by name, components or vectors; of a body in space its
            ``rotation``, too, as a matrix or a unit quaternion. Later calls add and replace values; None removes one.
        wish : dict of measure to value
            Values to approach as closely as the held ones allow.
        equilibrium : bool, optional
            True: the motion starts in the stable equilibrium that `zerodrift.equilibrium` finds from that position, with drives
            at its time; the search begins at held positions, and held speeds are kept as closely as the constraints allow.
            False cancels this; left out, the setting stays.

        Raises
        ------
        ValueError, TypeError
            If there is no such measure, a value is not a number or vector, or a motor prescribes it.

        Examples
        --------
        >>> import zerodrift as zd
        >>> m = zd.Mechanism("pendulum")
        >>> link = m.link("link", (0, 0), (1, 0), mass=1.0)
        >>> pin = m.revolute("pin", m.ground, link.start)
        >>> m.start({link.angle: -0.3, "pin.speed": 2.0})
        """
        if equilibrium is not None:
            self._is_balanced = checks.instance("equilibrium", equilibrium, bool, "True or False")
        for kept, given, what in ((self._held, held, "held"), (self._wished, wish, "wish")):
            checked = targets(given, what, self.dimension)
            for name, value in checked.items():
                self._check_start("start" if what == "held" else what, name, value)
            for name, value in checked.items():
                kept.pop(name, None) if value is None else kept.update({name: value})

    def _check_start(self, what: str, name: str, value: Any) -> None:
        """Check that a measure exists and that no drive prescribes it."""
        self._check_measured(what, name)
        checked_reading(what, name, value, self._elements)
        for motor in self.motors:
            taken = {"angle": ("angle", "speed"), "displacement": ("displacement", "speed"),
                     "speed": ("speed",)}.get(motor.drives, ())
            if name in {f"{motor.joint.name}.{quantity}" for quantity in taken}:
                raise WrongValue(f"start holds {name!r}, which motor {motor.name!r} prescribes: leave one of them out",
                                 "prescribed-twice")
        owner, _, quantity = name.rpartition(".")
        actuator = self._elements.get(owner)
        if isinstance(actuator, Actuator) and actuator.prescribes:
            raise WrongValue(f"start holds {name!r}, which the actuator prescribes: leave its {quantity} out", "prescribed-twice")


def targets(given: Any, what: str, dimension: int = 2) -> dict[str, Any]:
    """Measures and their values, checked: names to numbers, vectors or None."""
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise WrongType(f"{what} must be a dict of values by measure, not {checks.shown(given)}")
    read = {}
    for measure, value in given.items():
        name = name_of(measure, f"a key of {what}")
        if value is not None:
            said = f"{what}[{name!r}]"
            if dimension == 3 and name.endswith(".rotation"):
                value = given_rotation(said, value)
            else:
                value = checks.vector(said, value, dimension) if np.ndim(value) else checks.number(said, value)
        read[name] = value
    return read
