"""Methods whose errors of arguments name the method, the argument and its unit."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from typing import Any

from ..errors import WrongType

UNITS = {"speed": "rad/s or m/s", "angle": "rad", "displacement": "m", "torque": "N m", "force": "N", "mass": "kg",
         "inertia": "kg m^2", "length": "m", "pressure_angle": "rad", "helix_angle": "rad", "radius": "m", "pitch": "m per turn"}
WORDS = {"speed": ("rpm", "omega", "w", "velocity", "angular_velocity"), "angle": ("deg", "degrees", "theta", "phi"),
         "displacement": ("x", "s", "position"), "stiffness": ("k", "spring_constant"), "damping": ("c", "d"),
         "mass": ("m", "weight"), "inertia": ("I", "J", "moment_of_inertia"), "torque": ("T", "moment", "M"),
         "force": ("F", "kN"), "length": ("L", "l", "l0", "rest_length"), "at": ("pos", "position", "origin", "xy"),
         "value": ("force", "torque", "F", "magnitude"), "along": ("direction", "dir"), "axis": ("direction", "along"),
         "com": ("center", "centre", "cog"), "ratio": ("i", "teeth", "n")}

HINTS = {("link", "com"): ". Its centre of mass is its middle; that of m.body(com=) is anywhere"}


def verb(method: Callable[..., Any]) -> Callable[..., Any]:
    """Return the method with errors that name it, the unknown argument and those that it takes."""
    signature = inspect.signature(method)

    @functools.wraps(method)
    def checked(self: Any, *arguments: Any, **named: Any) -> Any:
        try:
            signature.bind(self, *arguments, **named)
        except TypeError as error:
            raise WrongType(_explained(method.__name__, signature, arguments, named, error)) from None
        return method(self, *arguments, **named)

    return checked


def _explained(name: str, signature: inspect.Signature, arguments: tuple[Any, ...], named: dict[str, Any],
               error: TypeError) -> str:
    every = list(signature.parameters.values())[1:]
    others = [f"**{each.name}" for each in every if each.kind is each.VAR_KEYWORD]
    known = [each.name for each in every if each.kind is not each.VAR_KEYWORD]
    takes = f"it takes {', '.join(known + others) or 'none'}"
    if unknown := [] if others else [each for each in named if each not in known]:
        meant = next((each for each in known if unknown[0] in WORDS.get(each, ())), None)
        unit = f"{meant}= is in {UNITS[meant]}; " if meant in UNITS else f"use {meant}=; " if meant else ""
        hint = HINTS.get((name, unknown[0]), "")
        return f"{name} has no argument {unknown[0]!r}; {unit}{takes}{hint}"
    places = [each.name for each in every if each.kind not in (each.KEYWORD_ONLY, each.VAR_KEYWORD)]
    if len(arguments) > len(places):
        return (f"{name} must be given {' and '.join(places) or 'nothing'} by position and other arguments by name, not "
                f"{len(arguments)} by position; {takes}")
    what = f"{name} {arguments[0]!r}" if arguments and isinstance(arguments[0], str) else name
    missing = [each.name for each in every if each.default is each.empty and each.name in known
               and each.name not in named and each.name not in places[:len(arguments)]]
    return f"{what} must have {' and '.join(missing)}; {takes}" if missing else f"{name}: {error}"
