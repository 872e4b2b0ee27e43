"""Solutions in NPZ files: arrays, and a description in JSON; no pickle."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

from ..._private import gateway
from ...errors import WrongValue
from ...systems.base import BaseSystem
from ...systems.builtin import FACTORIES, BuiltIn
from ..arguments.methods import CARDS, RowSettings

if TYPE_CHECKING:
    from pathlib import Path  # slow to import, as json is

JUMPS = np.dtype([("t", float), ("name", "U64"), ("energy", float)])     # rows of a solution's `jumps`


def transitions(rows: Sequence[Any] = ()) -> np.ndarray:
    """Field `transitions` of a solution: changes of phase as the core reports them."""
    groups = len(rows[0][1]) if rows else 0
    kind = np.dtype([("t", float), ("state", "i1", (groups,)), ("impulse", float, (groups,)), ("loss", float, (groups,))])
    return np.array([tuple(row) for row in rows], kind)


EVENTS = ("t_events", "p_events", "v_events")   # of a solution: an array for each event


def write(path: Path, values: Mapping[str, Any]) -> None:
    """Writes the fields of a solution."""
    from ..._private.writing import write_arrays  # pathlib is slow to import

    write_arrays(path, packed(values), np.savez_compressed)


def packed(values: Mapping[str, Any]) -> dict[str, np.ndarray]:
    """Fields of a solution as arrays; the others are in one array with a JSON text."""
    import json

    arrays = {name: value for name, value in values.items() if isinstance(value, np.ndarray)}
    for name in EVENTS:
        arrays |= {f"{name}.{i}": array for i, array in enumerate(values[name] or ())}
    arrays |= {f"outputs.{i}": array for i, array in enumerate(values["outputs"].values())}
    return {"zerodrift": np.array(json.dumps(described(values))), **arrays}


def described(values: Mapping[str, Any]) -> dict[str, Any]:
    """Fields of a solution that are not arrays, in the types of JSON."""
    description = {name: value for name, value in values.items() if not isinstance(value, np.ndarray)}
    description |= {name: None if values[name] is None else len(values[name]) for name in EVENTS}
    description["outputs"] = list(values["outputs"])
    description["system"] = values["system"]._described()
    description["settings"] = {name: to_json(value) for name, value in values["settings"].items()}
    return description


def read(path: str | Path, rebuilt: Callable[[dict[str, Any]], BaseSystem]) -> dict[str, Any] | None:
    """Fields of the solution in a file; None if the file has none. `rebuilt` makes the system of a mechanism from JSON."""
    arrays = read_arrays(path) if is_zip(path) else {}
    if "zerodrift" not in arrays:
        return None
    import json

    return unpacked(json.loads(str(arrays.pop("zerodrift"))), arrays, rebuilt)


def unpacked(description: dict[str, Any], arrays: dict[str, np.ndarray],
             rebuilt: Callable[[dict[str, Any]], BaseSystem]) -> dict[str, Any]:
    """The fields of a solution from its description and its arrays."""
    description["t_span"] = tuple(description["t_span"])
    for name in EVENTS:
        if (count := description.get(name)) is not None:
            description[name] = tuple(arrays[f"{name}.{i}"] for i in range(count))
            for i in range(count):
                del arrays[f"{name}.{i}"]
    description["outputs"] = {name: arrays.pop(f"outputs.{i}") for i, name in enumerate(description.get("outputs", ()))
                              if f"outputs.{i}" in arrays}
    description["system"] = restored_system(description["system"], rebuilt)
    description["settings"] = {name: from_json(value) for name, value in description["settings"].items()}
    return arrays | description


class Arrays(dict):
    """Arrays of an NPZ file by name. A name that is not there is a ValueError with the path of the file."""

    def __init__(self, path: str | Path, arrays: Mapping[str, np.ndarray]) -> None:
        super().__init__(arrays)
        self._path = path

    def __missing__(self, name: str) -> np.ndarray:
        raise WrongValue(f"{self._path} must contain the array {name!r}, and does not: it was not written to its end, or was "
                         "changed", "unreadable-file")


def read_arrays(path: str | Path, names: Sequence[str] | None = None) -> Arrays:
    """The arrays of an NPZ file; or some of them, without reading the others."""
    import zipfile  # slow to import
    import zlib

    try:
        with open(path, "rb") as opened, np.load(opened, allow_pickle=False) as file:
            return Arrays(path, file if names is None else {name: file[name] for name in names if name in file})
    except (OSError, ValueError, EOFError, zipfile.BadZipFile, zlib.error) as error:
        raise WrongValue(f"{path} cannot be read: {error}", "unreadable-file") from None


def is_zip(path: str | Path) -> bool:
    """NPZ files are ZIP files. NumPy would try to read other files in other ways."""
    with open(path, "rb") as file:
        return file.read(2) == b"PK"


def to_json(value: Any) -> Any:
    """A setting as JSON."""
    if isinstance(value, tuple):
        return [to_json(each) for each in value]
    if isinstance(value, RowSettings):
        return {"kind": type(value).__name__, **{field.name: getattr(value, field.name) for field in fields(value)}}
    return value.tolist() if isinstance(value, np.ndarray) else value


def from_json(value: Any) -> Any:
    if isinstance(value, dict):
        return CARDS[value.pop("kind")].settings(**value)
    if isinstance(value, list) and value and isinstance(value[0], dict | str):
        return tuple(map(from_json, value))
    return np.array(value) if isinstance(value, list) else value


class Described(BaseSystem):
    """A system of which only the description was saved: enough for tables and plots, not for another run."""

    def __init__(self, description: dict[str, Any]) -> None:
        self.name, self.parameters = description["name"], {}
        self._not_saved = description.get("not_saved")
        for group in ("coordinates", "velocities", "constraints"):
            setattr(self, group, tuple(gateway.Variable(*variable) for variable in description[group]))

    m = property(lambda self: len(self.constraints), doc="Number of constraints.")

    def _why_unknown(self, name: Any) -> str | None:
        """Why a measure is not known here, which the mechanism would have."""
        if not self._not_saved:
            return None
        return (f"{name!r} was not recorded, and {self.name} was not saved with its motion: {self._not_saved}. "
                f"simulate(..., outputs=[{name!r}]) records it")

    def __repr__(self) -> str:
        return f"<description of {self.name}>"

    def __str__(self) -> str:
        return repr(self)       # sizes, rows and parameters were not saved


def restored_system(description: dict[str, Any], rebuilt: Callable[[dict[str, Any]], Any]) -> BaseSystem:
    if "mechanism" in description:
        return rebuilt(description)
    if "parameters" in description and description["name"] in FACTORIES:
        return BuiltIn(description["name"], description["parameters"])
    return Described(description)
