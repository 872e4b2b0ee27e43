"""The core in WebAssembly, compiled at first use by the package ziglang and kept in the cache."""

from __future__ import annotations

from functools import partial
from importlib import resources
from pathlib import Path

from ..errors import CompilationFailed
from ..symbolics.compile import compilers
from . import core_build
from .core_files import ENTRIES, CoreFiles

TARGET = ("-target", "wasm32-wasi")
FLAGS = ("-Os", "-std=c11", "-ffp-contract=off", "-fvisibility=hidden", "-fno-sanitize=undefined", "-g0")
# The default methods of `simulate`, the cheapest one, and those with adaptive steps that a page may choose.
LISTS = {"SYSTEM": (), "FORMULATION": ("zd_augmented", "zd_schur"), "INTEGRATOR": ("zd_heun", "zd_rk4", "zd_dormand_prince"),
         "CORRECTION": ("zd_projection_row", "zd_energy_row")}
# Functions of zig's C library that the core calls and `c.zig` does not have. The whole library takes longer than the core.
FUNCTIONS = """snprintf vsnprintf vfprintf fwrite __towrite atan2 nextafter pow pow_data exp_data sinh __expo2 asinh acosh atanh
erf expm1 tgamma lgamma lgamma_r signgam ldexp scalbn __math_invalid __math_oflow __math_uflow __math_xflow __sin __cos"""


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
    made = partial(core_build.compiled, CoreFiles(LISTS, [*ENTRIES, "block/open_run/opened.c"]), command, FLAGS,
                   more={"page.c": text("page.c")}, product="core.wasm")
    join = [*command, "-Wl,--strip-all"]
    try:
        return made(join=[*join, "-nostdlib", "-Wl,--no-entry", "-o"], libraries=_library(program))
    except CompilationFailed:       # another version of zig, with other files
        return made(join=[*join, "-mexec-model=reactor", "-o"])


def _library(program: str) -> dict[str, list[str]]:
    """Commands that compile the functions of zig's C library that the core uses, by the objects and archives that they write."""
    lib = Path(program).parent / "lib"
    musl, wasi = lib / "libc/musl", lib / "libc/wasi/libc-top-half/musl"
    headers = (wasi / "src/include", wasi / "src/internal", wasi / "arch/wasm32", wasi / "../headers/private",
               musl / "src/include", musl / "src/internal", musl / "arch/generic")
    compiling = [program, "cc", *TARGET, *FLAGS, "-std=gnu17", "-w", *(f"-I{each}" for each in headers), "-c", "-o"]
    found = {"libc.a": [program, "build-lib", *TARGET, "-OReleaseSmall", "-lc", "-fcompiler-rt", "-femit-bin=libc.a",
                        str(lib / "c.zig")]}
    for name in FUNCTIONS.split():
        source = next((each for folder in (wasi, musl) for each in folder.glob(f"src/*/{name}.c")), None)
        if source:
            found[f"{source.stem}.o"] = [*compiling, f"{source.stem}.o", str(source)]
    return found
