"""The core in WebAssembly, compiled at first use by the package ziglang and kept in the cache."""

from __future__ import annotations

from importlib import resources

from ..errors import CompilationFailed
from ..symbolics.compile import compilers
from . import core_build
from .core_files import ENTRIES, CoreFiles

TARGET = ("-target", "wasm32-wasi")
FLAGS = ("-Os", "-std=c11", "-ffp-contract=off", "-fvisibility=hidden", "-fno-sanitize=undefined", "-g0")
# The default methods of `simulate`, the cheapest one, and those with adaptive steps that a page may choose.
LISTS = {"SYSTEM": (), "FORMULATION": ("zd_augmented", "zd_schur"), "INTEGRATOR": ("zd_heun", "zd_rk4", "zd_dormand_prince"),
         "CORRECTION": ("zd_projection_row", "zd_energy_row")}


def text(name: str) -> str:
    """A file of this folder: ``core.js``, the functions of a page, or ``core.d.ts``, their types."""
    return resources.files(__package__).joinpath(name).read_text(encoding="utf-8")


def core() -> bytes:
    """The core in WebAssembly.

    Raises
    ------
    CompilationFailed
        If the package ziglang is not installed.
    """
    program = compilers.zig()
    if program is None:
        raise CompilationFailed("the core for browsers must be compiled once, by ziglang: pip install zerodrift[web]")
    command = [program, "cc", *TARGET]
    return core_build.compiled(
        CoreFiles(LISTS, [*ENTRIES, "block/open_run/opened.c"]), command, FLAGS, more={"page.c": text("page.c")},
        join=[*command, "-mexec-model=reactor", "-Wl,--strip-all", "-o"], product="core.wasm")
