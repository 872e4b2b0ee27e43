"""Builds the C core as the extension module ``zerodrift._core`` (CFFI, out of line, stable ABI)."""

import hashlib
import os
import re
from pathlib import Path

from cffi import FFI

ROOT = Path(__file__).resolve().parent.parent
FLAGS = ["-O3", "-std=c11", "-ffp-contract=off", "-fvisibility=hidden"]
# For development: ZERODRIFT_CFLAGS adds to these, for instance warnings as errors, sanitizers, coverage.
EXTRA = os.environ.get("ZERODRIFT_CFLAGS", "").split()


def sources() -> list[str]:
    """C files of the core, relative to the project's root, as setuptools wants them."""
    return sorted(str(path.relative_to(ROOT)) for path in (ROOT / "csrc").rglob("*.c"))


def fingerprint() -> str:
    """What the core is made of; `zerodrift` compares it to notice that a core in place is stale."""
    digest = hashlib.sha256()
    for path in sorted((ROOT / "csrc").rglob("*.[ch]")):
        digest.update(path.relative_to(ROOT).as_posix().encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()


def declarations() -> str:
    """The public header without the preprocessor's lines."""
    header = (ROOT / "csrc" / "zerodrift.h").read_text()
    return re.sub(r"^#.*$", "", header, flags=re.MULTILINE) + IN_PYTHON


# Beside the core's own interface: what it was built from, and the evaluation of systems written in Python.
IN_PYTHON = """
extern const char *const zd_fingerprint;
extern "Python" int zd_evaluate_in_python(const void *, int, double, const double *, const double *, const zd_terms *);
"""

ffibuilder = FFI()
ffibuilder.cdef(declarations())
ffibuilder.set_source(
    "zerodrift._core",
    f'#include "zerodrift.h"\nstatic const char *const zd_fingerprint = "{fingerprint()}";\n',
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
