"""`Store`: folder with the finished parts of an ensemble, so that the same call resumes where it stopped."""

from __future__ import annotations

import json
import platform
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, ExitStack, nullcontext
from pathlib import Path
from typing import Any

import numpy as np

from .._private import checks, gateway
from .._private.locking import Lock
from .._private.writing import is_temporary, sweep, write_arrays, write_atomically
from ..errors import WrongValue
from ..runs.arguments.settings import VECTOR_UNITS
from ..runs.open.identity import Identity, differences, version
from ..runs.samples.saving import read_arrays
from ..systems.base import BaseSystem
from . import memory, saving
from .part import Part
from .plan import OPTIONS, Plan

FORMAT = 1
MANIFEST, STUDY = "manifest.json", "study.npz"      # what tells the study from others, and its numbers
LOCK = ".lock"                                      # a file that is there while an ensemble writes to the folder
PATTERN = "runs_*_*.npz"                            # each has the runs from the first number on, up to the second
WHAT = "store of an ensemble"


def is_one(path: str | Path) -> bool:
    """Return whether a folder is a store."""
    return (Path(path) / MANIFEST).is_file()


def vector_of(folder: str | Path) -> Any:
    """Vector unit with which a store began; None for a new store.

    Raises
    ------
    ValueError
        If this processor does not have it.
    """
    if not is_one(checks.instance("store", folder, str | Path, "the path of a folder")):
        return None
    unit, units = _manifest(Path(folder)).get("vector"), VECTOR_UNITS[:gateway.PROCESSOR_UNIT + 1]
    if unit not in units:
        raise WrongValue(f"store {str(folder)!r} was begun with {unit}, and the processor of {platform.node()} has "
                         f'{" and ".join(units)}: it goes on where that is, or elsewhere from the beginning with vector="avx2" | '
                         '"baseline"', "other-study")
    return unit


class Store:
    """Parts of one ensemble in a folder; a context manager that locks the folder unless all runs are done.

    A part is written under a name of its own and then renamed, so that it is there as a whole or not at all. It does not matter
    which process wrote it, nor how many runs it has.

    Parameters
    ----------
    folder : str or Path
    plan : Plan

    Raises
    ------
    ValueError
        If what is there belongs to another study; all differences are named. Nothing is changed then.
    InUse
        If another ensemble writes to the folder.
    """

    def __init__(self, folder: str | Path, plan: Plan) -> None:
        self.folder, self._plan, self._manifest = Path(folder), plan, manifest_of(plan)
        self._lock = Lock(self.folder / LOCK, f"store {str(folder)!r} must be that of one ensemble at a time; it is in use by")
        self._held: AbstractContextManager = nullcontext()

    def __enter__(self) -> Store:
        if self._is_begun() and not any(missing(_files(self.folder), self._plan.runs.count, 1)):
            return self
        self.folder.mkdir(parents=True, exist_ok=True)
        with ExitStack() as stack:
            stack.enter_context(self._lock)
            sweep(self.folder)
            if not self._is_begun():        # as another process may have done meanwhile
                self._begin()
            self._held = stack.pop_all()
        return self

    def __exit__(self, *error: Any) -> None:
        self._held.__exit__(*error)

    def _is_begun(self) -> bool:
        """True if the folder has this study; False if it is new or empty."""
        is_new = not self.folder.exists() or _is_empty(self.folder)     # before the manifest, which another process may write
        if is_one(self.folder):
            _check_same(self.folder, self._manifest, self._plan)
            return True
        if not is_new:
            raise WrongValue(f"store {str(self.folder)!r} must be a new or an empty folder, or that of an ensemble, and it is "
                             "neither", "other-study")
        return False

    def _begin(self) -> None:
        """Write the files of a new study, the manifest last: without one, a folder counts as not begun."""
        write_arrays(self.folder / STUDY, saving.packed_plan(self._plan), np.savez_compressed)
        write_atomically(self.folder / MANIFEST, lambda file: file.write(json.dumps(self._manifest, indent=1).encode()))

    def parts(self) -> dict[int, Part]:
        """Finished parts by their first run, without overlap. Outputs that take much memory remain in the files."""
        found, end, size = {}, 0, 0
        for (first, last), path in sorted(_files(self.folder).items()):
            if last <= end:
                continue
            part = saving.unpacked_part(read_arrays(path))
            if memory.exceeds(size + memory.size_of(part), memory.IN_STORE):
                part = in_file(part, path)
            if first < end:         # parts that others have made may overlap
                part = part.behind(end - first)
            found[max(first, end)] = part
            end, size = last, size + memory.size_of(part)
        return found

    def write(self, first: int, part: Part) -> Path:
        """Write a part, complete or interrupted, and return its path."""
        count = len(part.rows)
        path = self.folder / f"runs_{first:09}_{first + count:09}.npz"
        if count:
            write_arrays(path, saving.packed_part(part), np.savez)
        return path


def in_file(part: Part, path: Path) -> Part:
    """Part in a file, with outputs that are read at access."""
    return part._replace(arrays=memory.InFile(path, saving.places_of(part.arrays), slice(0, int(part.rows.sum()))))


def load(folder: str | Path, rebuilt: Callable[[dict[str, Any]], BaseSystem]) -> tuple[saving.Kept, dict[int, Part]]:
    """Ensemble of the finished parts of a store, without the functions of the original call."""
    store = object.__new__(Store)
    store.folder = Path(folder)
    return saving.unpacked_plan(read_arrays(store.folder / STUDY), rebuilt), store.parts()


def missing(done: Iterable[tuple[int, int]], count: int, length: int) -> Iterator[tuple[int, int]]:
    """Ranges of at most `chunk` runs that cover everything outside the finished ranges."""
    begin = 0
    for first, last in [*sorted(done), (count, count)]:
        for here in range(begin, first, length):
            yield here, min(first, here + length)
        begin = max(begin, last)


def manifest_of(plan: Plan) -> dict[str, Any]:
    """Digests and settings that identify an ensemble."""
    runs, found = plan.runs, Identity()
    numbers = {"parameters": runs.parameters, "start": {name: array for name, (array, _) in runs.start_values.items()},
               **runs.states}
    settings = {name: plan.options.get(name, default) for name, default in OPTIONS.items() if name != "vector"}
    made = {"system": _system(runs.made, found), "reduce": None if plan.reduce is None else found.of(plan.reduce)}
    described = {name: _described(value, found) for name, value in settings.items()}
    return {
        "what": WHAT, "format": FORMAT, "version": version(), "vector": plan.options["vector"], "runs": runs.count,
        "t_span": list(checks.span(plan.t_span)), "outputs": list(plan.names), **made, "settings": described,
        "assemble": runs.may_assemble, "hold": saving.names_of(runs.hold), "functions": found.functions,
        "python": ".".join(platform.python_version_tuple()[:2]) if found.functions else None,     # their code depends on it
        "numbers": {name: {key: found.of(array) for key, array in each.items()} if isinstance(each, dict) else found.of(each)
                    for name, each in numbers.items()}}


def _system(made: Any, found: Identity) -> Any:
    """Description of the runs, with a digest for each parameter, as these differ most often."""
    if not isinstance(made, BaseSystem):
        return found.of(made)
    return {"name": made.name, "parameters": {name: _described(value, found) for name, value in made.parameters.items()},
            "digest": found.of(made)}


def _described(value: Any, found: Identity) -> Any:
    """A setting: its value if that is short, else its digest."""
    return value if isinstance(value, str | bool | int | float | None) else found.of(value)


def _check_same(folder: Path, now: dict[str, Any], plan: Plan) -> None:
    """Check that a store belongs to this study."""
    then = _manifest(folder)
    if then.get("format") != FORMAT:
        raise WrongValue(f"store {str(folder)!r} has format {then.get('format')!r}, and format {FORMAT} is known here",
                         "unreadable-file")
    numbers = _other_runs(folder, plan) if then["numbers"] != now["numbers"] and then["runs"] == now["runs"] else []
    others = {name: value for name, value in now.items() if name != "numbers"}
    found = differences("", {name: value for name, value in then.items() if name != "numbers"}, others) + numbers
    if found or then["numbers"] != now["numbers"]:
        raise WrongValue(f"store {str(folder)!r} belongs to another study: {'; '.join(found) or 'its numbers differ'}. Take "
                         "another folder, or call as it was called", "other-study")


def _other_runs(folder: Path, plan: Plan) -> list[str]:
    """Description of the runs with other numbers: how many, and the first."""
    then = saving.unpacked_plan(read_arrays(folder / STUDY), lambda description: None).runs
    found = []
    for what, old, new in (("parameters", then.parameters, plan.runs.parameters),
                           ("start", _arrays(then.start_values), _arrays(plan.runs.start_values)),
                           ("", then.states, plan.runs.states)):
        for name in [*old, *(name for name in new if name not in old)]:
            found += _other_column(f"{what}[{name!r}]" if what else name, old.get(name), new.get(name))
    return found


def _arrays(columns: dict[str, tuple[np.ndarray, bool]]) -> dict[str, np.ndarray]:
    return {name: array for name, (array, _) in columns.items()}


def _other_column(name: str, old: np.ndarray | None, new: np.ndarray | None) -> list[str]:
    if old is None or new is None:
        return [f"{name} was {'not ' if old is None else ''}there and is {'not ' if new is None else ''}there"]
    if old.shape != new.shape or not old.ndim:
        return [] if np.array_equal(old, new) else [f"{name} was {checks.shown(old)} and is {checks.shown(new)}"]
    other = np.flatnonzero((old != new).reshape(len(old), -1).any(axis=1))
    return [f"{name} of {len(other)} runs, first run {other[0]}, where it was {checks.shown(old[other[0]].tolist())} and is "
            f"{checks.shown(new[other[0]].tolist())}"] if len(other) else []


def _manifest(folder: Path) -> dict[str, Any]:
    try:
        found = json.loads((folder / MANIFEST).read_bytes())
    except (OSError, ValueError) as error:
        raise WrongValue(f"{folder / MANIFEST} cannot be read: {error}", "unreadable-file") from None
    if not isinstance(found, dict) or found.get("what") != WHAT:
        raise WrongValue(f"{folder / MANIFEST} is that of no {WHAT}", "unreadable-file")
    return found


def _is_empty(folder: Path) -> bool:
    """True if a folder has no files, or only those of a process that was killed before it had written the manifest."""
    return folder.is_dir() and all(path.name == LOCK or is_temporary(path) or (path.name == STUDY and saving.is_ensemble(path))
                                   for path in folder.iterdir())


def _files(folder: Path) -> dict[tuple[int, int], Path]:
    """Files of the parts by their ranges of runs."""
    found = {}
    for path in folder.glob(PATTERN):
        first, last = path.stem.split("_")[1:]
        found[int(first), int(last)] = path
    return found
