"""Builds the C core as the extension module ``zerodrift._private.core`` (CFFI, out of line, stable ABI)."""

import logging
import os
import re
import runpy
import tempfile
from pathlib import Path

from cffi import FFI

import setuptools  # noqa: F401, isort: skip, as it brings distutils, which Python does not have any more
from distutils.ccompiler import new_compiler  # isort: skip
from distutils.sysconfig import customize_compiler  # isort: skip

ROOT = Path(__file__).resolve().parent.parent
WITH_MSVC = new_compiler().compiler_type == "msvc"
# Python's own flags come before these. Among them are -fwrapv, which costs a third of the speed, and -g, which makes the library
# five times as large.
OTHER_FLAGS = ["-O3", "-std=c11", "-ffp-contract=off", "-fvisibility=hidden", "-fno-wrapv", "-g0"]
FLAGS = ["/O2", "/std:c11", "/fp:precise"] if WITH_MSVC else OTHER_FLAGS
# For development: ZERODRIFT_CFLAGS adds to these, for instance warnings as errors, sanitizers, coverage.
EXTRA = os.environ.get("ZERODRIFT_CFLAGS", "").split()


def sources() -> list[str]:
    """C files of the core, relative to the project's root, as setuptools wants them."""
    return sorted(str(path.relative_to(ROOT)) for path in (ROOT / "csrc").rglob("*.c"))


def fingerprints() -> str:
    """Definitions of what the core is made of, by which a stale one is noticed, and of its layout of runs."""
    found = runpy.run_path(str(ROOT / "python" / "zerodrift" / "_private" / "fingerprint.py"))
    definitions = {"ZD_FINGERPRINT": found["core_fingerprint"](ROOT), "ZD_LAYOUT": found["layout_fingerprint"](ROOT)}
    return "".join(f'#define {name} "{value}"\n' for name, value in definitions.items())


def declarations() -> str:
    """The headers as the compiler's preprocessor leaves them; functions written in Python are marked as CFFI wants it."""
    of_mechanisms = ("common/elements.h", "common/assembly/given.h", "plane/elements.h", "plane/tables.h",
                     "plane/assembly/varied.h", "space/elements.h", "space/tables.h", "space_tree/tree.h")
    of_systems = ("terms.h", "structure.h", "closed_form.h", "derivatives.h", "system.h")
    of_core = ("tables.h", "settings.h", "run.h", "many_runs.h", "states.h")
    of_laws = ("program.h", "elimination.h", "terms.h")
    names = (*(f"include/zerodrift/{name}" for name in of_systems), *(f"laws/{name}" for name in of_laws),
             *(f"mechanisms/{name}" for name in of_mechanisms), *(f"zerodrift/{name}" for name in of_core),
             "block/block.h", "python/interface.h")
    headers = "".join((ROOT / "csrc" / name).read_text(encoding="utf-8") for name in names)
    return preprocessed(re.sub(r"^#(include|pragma|define ZD_WRITTEN).*$", "", headers, flags=re.MULTILINE)).replace(
        "ZD_WRITTEN_IN_PYTHON", 'extern "Python"')


def preprocessed(text: str) -> str:
    """C with its macros expanded."""
    compiler = new_compiler()
    customize_compiler(compiler)
    with tempfile.TemporaryDirectory() as folder:
        source, result = Path(folder, "headers.c"), Path(folder, "headers.i")
        source.write_text(text, encoding="utf-8")
        before = logging.root.manager.disable
        logging.disable(logging.INFO)       # distutils tells every command, and asks nobody for -q before there is a build
        try:
            preprocess(compiler, str(source), str(result))
        finally:
            logging.disable(before)
        return re.sub(r"^#.*$", "", result.read_text(encoding="utf-8"), flags=re.MULTILINE)


def preprocess(compiler, source: str, result: str):
    """As the compiler itself does it: setuptools knows how only for those that take Unix's options."""
    if compiler.compiler_type != "msvc":
        compiler.preprocess(source, result)
        return
    compiler.initialize()       # looks for cl.exe
    compiler.spawn([compiler.cc, "/nologo", "/std:c11", "/utf-8", "/EP", "/P", f"/Fi{result}", source])


ffibuilder = FFI()
ffibuilder.cdef(declarations())
ffibuilder.set_source(
    "zerodrift._private.core",
    f'{fingerprints()}#include "python/evaluate.h"\n',
    sources=sources(),
    depends=[str(path.relative_to(ROOT)) for path in (ROOT / "csrc").rglob("*.h")],
    include_dirs=["csrc"],
    libraries=[] if os.name == "nt" else ["m"],
    extra_compile_args=FLAGS + EXTRA,
    extra_link_args=EXTRA,
    py_limited_api=True,
)

if __name__ == "__main__":
    ffibuilder.compile(verbose=True)
