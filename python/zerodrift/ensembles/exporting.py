"""Ensembles as xarray.Dataset and pandas.DataFrame."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..runs.samples.columns import imported
from ..systems.measure_values import AXES, component_names
from .part import Part

# ---- xarray ----


def to_xarray(ens: Any, units: dict[str, str], part: Part) -> Any:
    """Ensemble as an xarray.Dataset."""
    xarray = imported("xarray", "to_xarray", "ensembles")
    over, coordinates = _runs(ens)
    time = "t" if ens.t is not None else "row"
    columns = {name: ens[name] if ens.t is not None else _padded(ens[name]) for name in part.arrays}
    if ens.t is None:
        columns["t"] = _padded(list(part.times()))
    else:
        coordinates["t"] = ("t", ens.t, {"units": "s"})
    variables = {name: _variable(ens, over, array, [time, *("component", "column")[:array.ndim - 2]], units.get(name, ""))
                 for name, array in columns.items()}
    variables["failed"] = _variable(ens, over, ens.failed, [], "")
    variables["message"] = _variable(ens, over, np.array(ens.messages, dtype=object), [], "")
    if isinstance(ens.values, np.ndarray):
        variables["value"] = _variable(ens, over, ens.values, [f"value_{i}" for i in range(ens.values.ndim - 1)], "")
    if any(array.ndim == 3 for array in columns.values()):
        coordinates["component"] = list(AXES)[:max(array.shape[2] for array in columns.values() if array.ndim == 3)]
    for name in coordinates:
        if name in units and isinstance(coordinates[name], tuple):
            coordinates[name] = (*coordinates[name][:2], {"units": units[name]})
    return xarray.Dataset(variables, coordinates)


def _runs(ens: Any) -> tuple[list[str], dict[str, Any]]:
    """Dimensions over the runs, and their coordinates."""
    if len(ens.shape) == len(ens.parameters) and all(each.ndim == 1 for each in ens.parameters.values()) and len(ens.shape) > 1:
        at = np.unravel_index(np.arange(len(ens)), ens.shape)
        axes = {}
        for i, (name, values) in enumerate(ens.parameters.items()):
            axes[name] = (name, np.array([values[np.argmax(at[i] == k)] for k in range(ens.shape[i])]))
        return list(axes), axes
    parameters = {name: (("run", *(f"{name}_{i}" for i in range(values.ndim - 1))), values)
                  for name, values in ens.parameters.items()}
    return ["run"], {"run": ("run", np.arange(len(ens))), **parameters}


def _variable(ens: Any, over: list[str], array: np.ndarray, more: list[str], unit: str) -> Any:
    shape = ens.shape if over != ["run"] else (len(ens),)
    return [*over, *more], array.reshape(*shape, *array.shape[1:]), {"units": unit} if unit else {}


def _padded(arrays: list[np.ndarray]) -> np.ndarray:
    """Stack arrays of different lengths, the shorter ones padded with NaN."""
    longest = max(map(len, arrays))
    found = np.full((len(arrays), longest, *arrays[0].shape[1:]), np.nan)
    for row, each in zip(found, arrays, strict=True):
        row[:len(each)] = each
    return found


# ---- pandas ----


def to_pandas(ens: Any, part: Part) -> Any:
    """Ensemble as a pandas.DataFrame."""
    pandas = imported("pandas", "to_pandas", "ensembles")
    parameters = _columns(ens.parameters)
    if not part.arrays:
        values = _columns({"value": ens.values}) if isinstance(ens.values, np.ndarray) else {
            "value": pandas.Series(ens.values, dtype=object)}
        return pandas.DataFrame({**parameters, **values, "failed": ens.failed, "message": list(ens.messages)}).rename_axis("run")
    run = np.repeat(np.arange(len(ens)), part.rows)
    index = pandas.MultiIndex.from_arrays([run, np.concatenate(list(part.times()))], names=["run", "t"])
    outputs = _columns(part.arrays, has_axes=True)
    return pandas.DataFrame({**{name: each[run] for name, each in parameters.items()}, **outputs}, index=index)


def _columns(arrays: Mapping[str, np.ndarray], *, has_axes: bool = False) -> dict[str, np.ndarray]:
    """Columns of an array: one, or one for each component."""
    return {each: column for name, array in arrays.items()
            for each, column in zip(component_names(name, array.shape[1:], has_axes=has_axes),
                                    array.reshape(len(array), -1).T, strict=True)}
