"""Compiled functions from any source, checked to be a `zd_evaluate` and reduced to their addresses."""

from __future__ import annotations

import contextlib
import ctypes
import importlib
import os
import re
from pathlib import Path
from typing import Any, NamedTuple

from ....errors import MissingFile, MissingPackage, WrongType, WrongValue, sentence
from ...core import ffi, lib
from ...fingerprint import fingerprint
from .native import VERSION

SIGNATURE = "int (const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)"
# The types of the result and of the arguments, without const; pointers to data and to terms may be of other types.
RESULT = "int"
ARGUMENTS = ({"void*", "double*"}, {"int"}, {"double"}, {"double*"}, {"double*"},
             {"void*", "zd_terms*", "structzd_terms*", "double**"})


class Function(NamedTuple):
    """The address of a function, what must be kept alive with it, and how another process finds the same function."""

    address: int
    keep: Any
    origin: Any = None       # where another process finds the same function: InLibrary, InModule or FromPython, for `find`
    why_no_origin: str = "a function pointer means nothing in another process; give the library's path and symbol"


class InLibrary(NamedTuple):
    """A symbol of a shared library whose content must not have changed."""

    path: str
    symbol: str
    digest: str


class InModule(NamedTuple):
    """Origin: a function compiled when its module is imported."""

    module: str
    name: str


class FromPython(NamedTuple):
    """Origin: a Python function that Numba compiles."""

    function: Any


def find(function: Any, symbol: str | None, version: int | None) -> Function:
    """The compiled function that an argument refers to, checked."""
    if isinstance(function, str | Path):
        if version is not None:
            raise WrongType(f"version must be left out: a library declares zd_interface_version, not {version!r}",
                            "compiled-function")
        return in_library(function, symbol)
    if symbol is not None:
        raise WrongType(f"symbol names a function of a library: with it, function must be the library's path, not {function!r}",
                        "compiled-function")
    if isinstance(function, InLibrary):
        return _find_unchanged(function)
    if isinstance(function, InModule):
        return find(_imported(function.module, function.name), None, None)
    if isinstance(function, FromPython):
        import numba

        return find(numba.cfunc(numba_signature())(function.function), None, None)
    for is_of_kind, found in _KINDS_OF_POINTER:
        if is_of_kind(function):
            check_version(version, "version", required=found is _address)
            return found(function)
    raise WrongType("function must be the path of a shared library, an address with its version, a function pointer of ctypes or "
                    f"cffi, a numba.cfunc, or a scipy.LowLevelCallable, not {function!r}", "compiled-function")


def check_version(version: Any, what: str, *, required: bool = False) -> None:
    """Refuse a library made for another version of the core's interface."""
    if version is None and required:
        raise WrongType("version must be given with an address: the ZD_INTERFACE_VERSION it was compiled with; "
                        f"this core has {VERSION}", "compiled-function")
    if version is not None and (isinstance(version, bool) or version != VERSION):
        raise WrongValue(f"{what} is {version!r}, and this core has version {VERSION} of the interface: compile it again, "
                         "against the header in zerodrift.get_include()", "compiled-function")


# ---- libraries ----

COPIES = "zerodrift-library-"
OLD = 3600.0            # s, after which what was copied has been loaded

_loaded: dict[str, ctypes.CDLL] = {}    # by digest


def load_library(path: str | Path) -> ctypes.CDLL:
    """Load a shared library with its present content; OSError if it is not a library.

    It is loaded from a copy for two reasons. From the same path, the system's loader returns what it loaded before, even if the
    file has changed. And overwriting a file that is loaded changes the memory of this process.
    """
    path = Path(path).resolve()
    return load_data(_content(path), path)  # it may look for others beside it, or nothing be executed from where the copy is


def load_data(data: bytes, otherwise: str | Path | None = None, *, copied: bool = True) -> ctypes.CDLL:
    """Load a shared library from its bytes, by a copy that other users cannot change; if that fails, from a path.

    `copied` False: from the path directly; the file there must not change.
    """
    digest = fingerprint(data)
    if digest not in _loaded:
        _loaded[digest] = _load_copy(data, otherwise) if copied else ctypes.CDLL(str(otherwise))
    return _loaded[digest]


def _load_copy(data: bytes, otherwise: str | Path | None) -> ctypes.CDLL:
    import tempfile  # slow to import

    if os.name == "nt":
        _remove_old_copies(Path(tempfile.gettempdir()))
    with tempfile.TemporaryDirectory(prefix=COPIES, ignore_cleanup_errors=True) as folder:
        copy = Path(folder) / ("library.dll" if os.name == "nt" else "library.so")
        try:
            copy.write_bytes(data)
            return ctypes.CDLL(str(copy))
        except OSError:
            if otherwise is None:
                raise
            return ctypes.CDLL(str(otherwise))


def _remove_old_copies(temporary: Path) -> None:
    """Remove copies left by ended processes: Windows does not let a process remove a loaded library."""
    import shutil
    import time

    for folder in temporary.glob(f"{COPIES}*"):
        with contextlib.suppress(OSError):      # it has gone meanwhile
            if time.time() - folder.stat().st_mtime > OLD:
                shutil.rmtree(folder, ignore_errors=True)       # what is loaded stays


def _content(path: Path) -> bytes:
    if not path.is_file():
        raise MissingFile(f"the shared library must exist: {path}")
    return path.read_bytes()


def digest_of(path: Path) -> str:
    """Hash of the content of a file."""
    return fingerprint(_content(path))


def address_of(library: ctypes.CDLL, symbol: str) -> int:
    """Address of a symbol of a library; ValueError if it is missing."""
    return ctypes.addressof(ctypes.c_char.in_dll(library, symbol))


SET_SINES_OF_LARGE = "zd_set_sines_of_large"    # of libraries that were compiled with ZD_LARGE_SINES_OF_CORE


def set_sines_of_large(library: ctypes.CDLL) -> None:
    """Set the core's large-argument sines in a library that was compiled without them: see zerodrift/sines.h."""
    given = (ffi.addressof(lib, name) for name in ("zd_sines_of_large", "zd_reductions_of_large"))
    library[SET_SINES_OF_LARGE](*(ctypes.c_void_p(int(ffi.cast("intptr_t", each))) for each in given))


def in_library(path: str | Path, symbol: Any) -> Function:
    """Function of a shared library; its interface version must be the core's."""
    if not isinstance(symbol, str) or not symbol:
        raise WrongType(f"symbol must be the name of a function in {path}, not {symbol!r}", "compiled-function")
    path = Path(path).resolve()
    digest = digest_of(path)
    try:
        library = load_library(path)
    except OSError as error:
        raise WrongValue(f"{path} must be a shared library that can be loaded here: {error}", "compiled-function") from None
    try:
        version = ctypes.c_int.in_dll(library, "zd_interface_version").value
    except ValueError:
        raise WrongValue(f"{path} must declare its version of the interface by the line "
                         "`const int zd_interface_version = ZD_INTERFACE_VERSION;`", "compiled-function") from None
    check_version(version, f"zd_interface_version of {path}")
    try:
        address = address_of(library, symbol)
    except ValueError:
        raise WrongValue(f"{path} has no symbol {symbol!r}", "compiled-function") from None
    return Function(address, library, InLibrary(str(path), symbol, digest))


def _find_unchanged(origin: InLibrary) -> Function:
    found = in_library(origin.path, origin.symbol)
    if found.origin.digest != origin.digest:
        raise WrongValue(f"{origin.path} is not what it was when this system was made: its content has changed",
                         "compiled-function")
    return found


# ---- pointers ----


def _check_signature(types: list[str], what: str) -> None:
    """Refuse a function with other result or argument types."""
    result, *arguments = [re.sub(r"\bconst\b|\s", "", name) for name in types]
    fits = len(arguments) == len(ARGUMENTS) and all(name in allowed for name, allowed in zip(arguments, ARGUMENTS, strict=True))
    if result != RESULT or not fits:
        raise WrongType(f"{what} is {types[0]} ({', '.join(types[1:])}), and must be {SIGNATURE}", "compiled-function")


def _is_ctypes(function: Any) -> bool:
    return isinstance(function, ctypes._CFuncPtr)     # type: ignore[attr-defined]


def _is_cffi(function: Any) -> bool:
    return isinstance(function, ffi.CData)


def _is_numba(function: Any) -> bool:
    return type(function).__module__.partition(".")[0] == "numba" and hasattr(function, "address") and hasattr(function, "_sig")


def _is_scipy(function: Any) -> bool:
    return type(function).__name__ == "LowLevelCallable" and hasattr(function, "signature")


def _is_address(function: Any) -> bool:
    return isinstance(function, int) and not isinstance(function, bool)


def _address(function: int) -> Function:
    if function <= 0:
        raise WrongValue(f"function must be the address of a function, not {function}", "compiled-function")
    return Function(function, None)


_C_NAMES = {
    None: "void", ctypes.c_int: "int", ctypes.c_double: "double", ctypes.c_void_p: "void *",
    ctypes.POINTER(ctypes.c_double): "double *", ctypes.POINTER(ctypes.POINTER(ctypes.c_double)): "double **",
}


def _c_name(kind: Any) -> str:
    """A type of ctypes in C; any structure pointed to is taken for `zd_terms`."""
    if isinstance(target := getattr(kind, "_type_", None), type) and issubclass(target, ctypes.Structure):
        return "zd_terms *"
    return _C_NAMES.get(kind, getattr(kind, "__name__", repr(kind)))


def _from_ctypes(function: Any) -> Function:
    if function.argtypes is None:
        raise WrongType(f"argtypes and restype of {function!r} must be set, as of a {SIGNATURE}", "compiled-function")
    _check_signature([_c_name(kind) for kind in (function.restype, *function.argtypes)], "the ctypes function")
    address = ctypes.cast(function, ctypes.c_void_p).value
    if not address:
        raise WrongValue("the ctypes function is a null pointer", "compiled-function")
    return Function(address, function)


def _from_cffi(function: Any) -> Function:
    kind = ffi.typeof(function)
    if kind.kind != "function":
        raise WrongType(f"the cffi object is a {kind.cname}, and must be a pointer to a function {SIGNATURE}",
                        "compiled-function")
    _check_signature([part.cname for part in (kind.result, *kind.args)], "the cffi function")
    if not function:
        raise WrongValue("the cffi function is a null pointer", "compiled-function")
    return Function(int(ffi.cast("intptr_t", function)), function)


def _from_numba(function: Any) -> Function:
    signature = function._sig
    names = [_numba_name(kind) for kind in (signature.return_type, *signature.args)]
    try:
        _check_signature(names, "the numba.cfunc")
    except TypeError as error:
        raise WrongType(f"{sentence(error)}; zerodrift.numba_signature() is that for numba", "compiled-function") from None
    origin = _numba_origin(function)
    why_no_origin = "numba would have to find its Python function at the top of a module"
    return Function(function.address, function, origin, why_no_origin)


def _numba_name(kind: Any) -> str:
    if hasattr(kind, "dtype") and type(kind).__name__ == "CPointer":
        return f"{_numba_name(kind.dtype)}*"
    if type(kind).__name__ == "Record":
        return "zd_terms"
    return {"int32": "int", "float64": "double", "none": "void", "voidptr": "void*"}.get(str(kind), str(kind))


def _numba_origin(function: Any) -> Any:
    """Origin from which another process obtains the same function: an import, or the Python function to compile again."""
    python = function.__wrapped__
    try:
        found = _imported(python.__module__, python.__qualname__)
    except (ImportError, AttributeError):
        return None
    if found is function:
        return InModule(python.__module__, python.__qualname__)
    return FromPython(python) if found is python else None


def _imported(module: str, name: str) -> Any:
    found = importlib.import_module(module)
    for part in name.split("."):
        found = getattr(found, part)
    return found


def numba_signature() -> Any:
    """Signature for `numba.cfunc`; see `zerodrift.native`."""
    try:
        from numba import types
    except ImportError:
        raise MissingPackage("this needs numba, which is not installed: pip install numba") from None
    doubles = types.CPointer(types.float64)
    return types.int32(doubles, types.int32, types.float64, doubles, doubles, types.CPointer(doubles))


def _from_scipy(function: Any) -> Function:
    result, _, types = function.signature.partition("(")
    _check_signature([result.strip(), *map(str.strip, types.rpartition(")")[0].split(","))], "the LowLevelCallable")
    if function.user_data is not None:
        raise WrongValue("the LowLevelCallable must have no user_data: the argument of that place passes the parameters",
                         "compiled-function")
    if _is_ctypes(function.function) or _is_cffi(function.function):
        return find(function.function, None, None)
    api = ctypes.pythonapi
    name, pointer = api.PyCapsule_GetName, api.PyCapsule_GetPointer
    name.restype, name.argtypes = ctypes.c_char_p, [ctypes.py_object]
    pointer.restype, pointer.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]
    return Function(pointer(function.function, name(function.function)), function)


_KINDS_OF_POINTER = ((_is_address, _address), (_is_ctypes, _from_ctypes), (_is_cffi, _from_cffi), (_is_numba, _from_numba),
          (_is_scipy, _from_scipy))
