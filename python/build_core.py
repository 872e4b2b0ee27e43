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


# Beside the core's own interface: what it was built from, and the evaluation of systems written in Python. Python never sees the
# core's memory, which goes with the run: the state and the terms are copied between it and memory of Python's own.
FOR_PYTHON = """
typedef struct zd_python_term {     /* Python's memory of one term */
    int term, slot;                 /* its bit, and which pointer of zd_terms it is */
    size_t size;                    /* in bytes */
    const double *values;
} zd_python_term;

typedef struct zd_python {
    void *evaluator;                /* handle of the Python object */
    const zd_system *system;
    double *p, *v;                  /* (nq,), (nv,): the state of the last call, for Python to read */
    int terms;
    const zd_python_term *term;
} zd_python;
"""

IN_PYTHON = FOR_PYTHON + """
extern const char *const zd_fingerprint;
int zd_evaluate_in_python(const void *, int, double, const double *, const double *, const zd_terms *);
extern "Python" int zd_write_in_python(void *owner, int want, double t, int moved);
extern "Python" int zd_refuse_in_python(void *owner, int term, double t);
extern "Python" int zd_event_in_python(void *owner, int event, double t, const double *p, const double *v, double *value);
extern "Python" int zd_found_in_python(void *owner, int event, double t, const double *p, const double *v);
"""

BRIDGE = """
#include <string.h>
#include "zerodrift.h"

static const char *const zd_fingerprint = "%s";
""" + FOR_PYTHON + """
static int zd_write_in_python(void *evaluator, int want, double t, int moved);
static int zd_refuse_in_python(void *evaluator, int term, double t);

/* to <- from; returns whether that changed a bit */
static int replace(double *to, const double *from, int n)
{
    if (memcmp(to, from, (size_t)n * sizeof *to) == 0) return 0;
    memcpy(to, from, (size_t)n * sizeof *to);
    return 1;
}

static int zd_evaluate_in_python(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    const zd_python *self = data;
    const zd_system *system = self->system;
    double *const *to = (double *const *)out;
    int moved = replace(self->p, p, system->nq) | replace(self->v, v, system->nv) << 1;
    int status = zd_write_in_python(self->evaluator, want, t, moved);
    if (status) return status;
    for (const zd_python_term *term = self->term; term < self->term + self->terms; term++)
        if (want & term->term) memcpy(to[term->slot], term->values, term->size);
    int not_finite = zd_first_not_finite(system, want, out);
    return not_finite ? zd_refuse_in_python(self->evaluator, not_finite, t) : ZD_DONE;
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
