"""Builds the C core as the extension module ``zerodrift._core`` (CFFI, out of line, stable ABI)."""

import os
import re
import runpy
from pathlib import Path

from cffi import FFI

ROOT = Path(__file__).resolve().parent.parent
# Python's own flags come before these; among them is -fwrapv, which costs a third of the speed.
FLAGS = ["-O3", "-std=c11", "-ffp-contract=off", "-fvisibility=hidden", "-fno-wrapv"]
# For development: ZERODRIFT_CFLAGS adds to these, for instance warnings as errors, sanitizers, coverage.
EXTRA = os.environ.get("ZERODRIFT_CFLAGS", "").split()


def sources() -> list[str]:
    """C files of the core, relative to the project's root, as setuptools wants them."""
    return sorted(str(path.relative_to(ROOT)) for path in (ROOT / "csrc").rglob("*.c"))


def fingerprint() -> str:
    """What the core is made of; `zerodrift` compares it to notice that a core in place is stale."""
    return runpy.run_path(str(ROOT / "python" / "zerodrift" / "_fingerprint.py"))["core_fingerprint"](ROOT)


def declarations() -> str:
    """The public headers without the preprocessor's lines."""
    headers = "".join((ROOT / "csrc" / name).read_text() for name in ("include/zerodrift/system.h", "zerodrift.h"))
    return re.sub(r"^#.*$", "", headers, flags=re.MULTILINE) + IN_PYTHON


# Beside the core's own interface: what it was built from, and the evaluation of systems written in Python. Between the core and
# Python stands a little C, as it costs there a hundredth: noticing that the memory is another, and numbers that are not finite.
IN_PYTHON = """
extern const char *const zd_fingerprint;

typedef struct zd_python {
    void *evaluator;            /* handle of the Python object */
    const zd_system *system;
    const double *p, *v;        /* the memory of the last call */
    zd_terms terms;
    double t;
    int not_finite;             /* the term that was not, as its bit */
} zd_python;

int zd_evaluate_in_python(const void *, int, double, const double *, const double *, const zd_terms *);
extern "Python" int zd_write_in_python(void *owner, int want, double t, int elsewhere);
extern "Python" int zd_event_in_python(void *owner, int event, double t, const double *p, const double *v, double *value);
extern "Python" int zd_found_in_python(void *owner, int event, double t, const double *p, const double *v);
"""

BRIDGE = """
#include <string.h>
#include "zerodrift.h"

static const char *const zd_fingerprint = "%s";

typedef struct zd_python {
    void *evaluator;
    const zd_system *system;
    const double *p, *v;
    zd_terms terms;
    double t;
    int not_finite;
} zd_python;

static int zd_write_in_python(void *evaluator, int want, double t, int elsewhere);

static int zd_evaluate_in_python(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    zd_python *self = (zd_python *)data;
    int elsewhere = p != self->p || v != self->v || memcmp(out, &self->terms, sizeof *out) != 0;
    self->p = p, self->v = v, self->terms = *out, self->t = t;
    int status = zd_write_in_python(self->evaluator, want, t, elsewhere);
    if (status) return status;
    self->not_finite = zd_first_not_finite(self->system, want, out);
    return self->not_finite ? ZD_CALLBACK : ZD_DONE;
}
"""

ffibuilder = FFI()
ffibuilder.cdef(declarations())
ffibuilder.set_source(
    "zerodrift._core",
    BRIDGE % fingerprint(),
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
