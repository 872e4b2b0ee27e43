"""Systems of compiled functions for several tests: those of native/systems.c and native/pendulum.c, compiled and described."""

import atexit
import ctypes
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np
import pytest

import zerodrift as zd

ROOT = Path(__file__).resolve().parents[2]
PENDULUM = ROOT / "tests" / "native" / "pendulum.c"
OWN = ["arm", "top", "skate"]       # in native/systems.c: rheonomic; with a quaternion; holonomic with nonholonomic
COMPILER = shutil.which(os.environ.get("CC", "gcc" if os.name == "nt" else "cc"))
needs_compiler = pytest.mark.skipif(COMPILER is None, reason="there is no C compiler")

TERMS = ["M", "f", "Phi", "C", "xi", "V"]
GIVEN = {"terms": TERMS, "constraints": ["rod"], "parameters": {"mass": 1.0, "gravity": 9.81, "length": 1.0}, "p0": [1.0, 0.0]}
POINTER = ctypes.POINTER(ctypes.c_double)
PROTOTYPE = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_int, ctypes.c_double, POINTER, POINTER, ctypes.c_void_p)


def compile_library(source, library, *options):
    if COMPILER is None:
        pytest.skip("there is no C compiler")
    subprocess.run([COMPILER, "-shared", "-fPIC", "-O2", "-std=c11", "-ffp-contract=off", "-Wall", "-Wextra", "-Wpedantic",
                    "-Werror", *options, "-I", zd.get_include(), "-o", library, source, "-lm"], check=True)
    return library


def compile_text(text, library, *options):
    source = library.with_suffix(".c")
    source.write_text(text)
    return compile_library(source, library, *options)


def own_systems():
    """Systems of native/systems.c by their names, compiled once for this process and those it starts; none without a compiler."""
    if COMPILER is None:
        return {}
    if "ZERODRIFT_OWN_SYSTEMS" not in os.environ:
        folder = tempfile.mkdtemp(prefix="zerodrift-systems-")
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
        library = compile_library(ROOT / "tests" / "native" / "systems.c", Path(folder) / "systems.so")
        os.environ["ZERODRIFT_OWN_SYSTEMS"] = str(library)
    return {name: zd.native(os.environ["ZERODRIFT_OWN_SYSTEMS"], symbol=name) for name in OWN}


def compile_four_bar(library):
    """The built-in one as the library of a user."""
    folder = ROOT / "csrc" / "systems"
    source, closed_form = folder / "four_bar.c", folder / "closed_form" / "four_bar.c"
    text = f'#define zd_four_bar zd_kind_four_bar\n#include "{source}"\n#include "{closed_form}"\n'
    text += "const int zd_interface_version = ZD_INTERFACE_VERSION;\n"
    others = (str(folder / "series" / f"four_bar{name}.c") for name in ("", "_precise"))
    return compile_text(text, library, "-O3", "-Wno-pedantic", *others)


def pendulum(library, symbol="pendulum", **changes):
    return zd.native(library, ["x", "y"], symbol=symbol, **(GIVEN | changes))


def built_in():
    return zd.systems.pendulum(angle=np.pi / 2)


def motion(system, **options):
    """Solution of a pendulum from one start, on the matrix path."""
    return zd.simulate(system, 2.0, [1.0, 0.0], [0.0, 0.0], step=0.01, closed_form=False, **options)


def run_elsewhere(system):
    """For another process, which can import this file, but no file of tests in a folder."""
    return motion(system).p


# ---- its function, as other packages hand it over ----


def of_ctypes(library):
    function = ctypes.CDLL(str(library)).pendulum
    function.restype, function.argtypes = ctypes.c_int, PROTOTYPE._argtypes_
    return function


def address(library):
    return ctypes.cast(ctypes.CDLL(str(library)).pendulum, ctypes.c_void_p).value
