"""Pickling of plans and parts for other processes: functions by name where possible, else by cloudpickle."""

from __future__ import annotations

import importlib
import io
import pickle
import sys
from types import FunctionType, ModuleType
from typing import Any

from ..errors import MissingPackage, WrongType, described
from .runs import named
from .unpicklable import unpicklable

MAIN = ("__main__", "__mp_main__")      # modules that another process does not have, or has another one of


def packed(what: Any, name: str = "this", *, shares_main: bool = False) -> bytes:
    """Pickle an object; `name` describes it in errors.

    Functions of the script that runs travel by their names, too, where `shares_main`: processes that `multiprocessing` has
    started import it.

    Raises
    ------
    TypeError
        If there is something in it that cannot travel; the function that refers to it is named. A function that no module has
        by its name needs cloudpickle.
    """
    shares_main = shares_main and hasattr(sys.modules["__main__"], "__file__")
    try:
        return _dumped(what, shares_main)
    except _Stuck as error:
        raise WrongType(f"{name} cannot travel to another process: {error}", "not-portable") from None
    except Exception as error:
        holder = unpicklable(what, lambda part: _fits(part, shares_main))
        raise WrongType(f"{name} cannot travel to another process: {holder}{described(error, code=False)}",
                        "not-portable") from error


def _dumped(what: Any, shares_main: bool) -> bytes:
    buffer = io.BytesIO()
    packer = _Packer(buffer, pickle.HIGHEST_PROTOCOL)
    packer.shares_main = shares_main
    packer.dump(what)
    return buffer.getvalue()


def _fits(what: Any, shares_main: bool) -> bool:
    try:
        _dumped(what, shares_main)
    except Exception:       # of any object
        return False
    return True


def unpacked(data: bytes) -> Any:
    """Unpickle an object.

    Raises
    ------
    ImportError
        If a module is missing here in which something in it was defined.
    """
    try:
        return pickle.loads(data)
    except (ImportError, AttributeError) as error:
        raise MissingPackage(f"{error}; objects of a module are sent by name, so that workers must have the same module; "
                             "cloudpickle.register_pickle_by_value(module) sends their content instead") from None


class _Stuck(WrongType):
    """Raised for a function that cannot be pickled."""

    code = "not-portable"


class _Packer(pickle.Pickler):
    """Pickler that sends functions and classes by name if another process can import them, else by value."""

    shares_main = False

    def reducer_override(self, what: Any) -> Any:
        if not isinstance(what, FunctionType | type) or is_found(what):
            return NotImplemented
        cloudpickle = _cloudpickle()
        if cloudpickle is not None:
            return _restored, (cloudpickle.dumps(what),)
        if isinstance(what, type) or (self.shares_main and is_found(what, but=())):
            return NotImplemented       # of a class, this says what is missing
        raise _Stuck(f"{named(what)} of {what.__module__} is in no module that another process could import; define it "
                     "there, or pip install cloudpickle")


def _restored(data: bytes) -> Any:
    return pickle.loads(data)


def is_found(what: Any, but: tuple[str, ...] = MAIN) -> bool:
    """True if another process can and should import a function or class by name; not from the modules given."""
    module = what.__module__
    if module == "builtins":
        return True
    if module in but or _is_by_value(module):
        return False
    found: Any = sys.modules.get(module)
    for name in what.__qualname__.split("."):
        found = getattr(found, name, None)
    return found is what


def _is_by_value(module: str) -> bool:
    """True if the user has registered that module, or a package containing it, with cloudpickle to be sent by value."""
    cloudpickle = sys.modules.get("cloudpickle")
    registered = cloudpickle.list_registry_pickle_by_value() if cloudpickle else ()
    return any(module == each or module.startswith(f"{each}.") for each in registered)


def _cloudpickle() -> ModuleType | None:
    try:
        return importlib.import_module("cloudpickle")
    except ImportError:
        return None
