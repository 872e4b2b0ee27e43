"""C compilers on Linux, macOS and Windows: where they are found, and how each spells its options."""

from __future__ import annotations

import importlib.util
import os
import shlex
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

from ...errors import CompilationFailed

SYSTEM = sys.platform           # "linux", "darwin", "win32"
QUIETLY = getattr(subprocess, "CREATE_NO_WINDOW", 0)    # or a console appears for each compiler, where Python itself has none
ON_PATH = {"win32": ("cl", "gcc", "clang-cl", "clang"), "darwin": ("cc", "clang", "gcc")}
ELSEWHERE = ("cc", "gcc", "clang")
INSTALLED = {"win32": "Microsoft's build tools for C++, MinGW's gcc or `pip install ziglang`",
             "darwin": "`xcode-select --install` or `pip install ziglang`"}
IN_PACKAGES = "the system's gcc or clang, or `pip install ziglang`"
OF_MSVC = ("cl", "clang-cl")            # whose options begin with a slash
AS_MSVC = ("/nologo", "/utf-8", "/O2", "/std:c11", "/fp:precise", "/we4013", "/LD")     # 4013: a function that is not declared
CLANG_AS_MSVC = ("/clang:-ffp-contract=off",)       # its /fp:precise contracts products and sums
AS_GNU = ("-std=c11", "-ffp-contract=off", "-Werror=implicit-function-declaration", "-shared")
# Where all code may be moved in memory, and libraries beside a compiler are not looked for when others are loaded. None is libm.
ON_WINDOWS = ("-static-libgcc",)
# Of all processors of a kind, as caches are shared: zig takes the one that it runs on. It also looks for undefined behaviour.
ZIG_FLAGS = ("-mcpu=baseline", "-fno-sanitize=undefined")
PATIENCE = 60.0         # s: time limit of queries before a compilation


class Compiler(NamedTuple):
    """A compiler: its command, and the environment variables that it needs besides those of this process."""

    command: list[str]
    environment: dict[str, str] | None = None

    @property
    def is_like_msvc(self) -> bool:
        """True if the compiler takes the options of Microsoft's compiler."""
        return _called(self.command[0]) in OF_MSVC

    def line(self, source: str, product: str, include: str, optimized: Sequence[str], defined: Sequence[str]) -> list[str]:
        """The command that makes a shared library of a C source; `optimized` is how gcc spells what changes no bits."""
        if self.is_like_msvc:
            exactly = CLANG_AS_MSVC if _called(self.command[0]) == "clang-cl" else ()
            return [*self.command, *AS_MSVC, *exactly, *(f"/D{each}" for each in defined), f"/I{include}", f"/Fe:{product}",
                    source]
        before, behind = (ON_WINDOWS, ()) if SYSTEM == "win32" else (("-fPIC",), ("-lm",))
        return [*self.command, *optimized, *AS_GNU, *before, *(f"-D{each}" for each in defined), f"-I{include}", "-o", product,
                source, *behind]


def exporting(source: str, symbols: Sequence[str]) -> str:
    """Source with export declarations of these symbols, which libraries for Windows need unless a GNU compiler makes them."""
    pragmas = [f'#pragma comment(linker, "/export:{name}")\n' for name in symbols]
    return source + "".join(["#ifdef _MSC_VER\n", *pragmas, "#endif\n"])


def find() -> Compiler | None:
    """The compiler that `CC` names, or the first one that is installed; None: there is none.

    Raises
    ------
    CompilationFailed
        If `CC` cannot be read as a command.
    """
    if SYSTEM == "emscripten":
        return None
    for command in [given()] if said() else _candidates():
        program = shutil.which(command[0]) if command else None
        if program:
            program = os.path.abspath(program)      # it is run in another folder
            return Compiler([program, *command[1:]], _variables_of(program))
    return None


def said() -> str:
    """Value of the environment variable `CC`, stripped."""
    return os.environ.get("CC", "").strip()


def given() -> list[str]:
    """Command of `CC`, split into words."""
    try:
        if SYSTEM != "win32":
            return shlex.split(said())
        return [word.strip('"') for word in shlex.split(said(), posix=False)]       # backslashes are of paths there
    except ValueError as error:
        raise CompilationFailed(f"CC={said()} is no command ({str(error)[:1].lower()}{str(error)[1:]}): {advice()}") from None


def advice() -> str:
    """Rule for the value of `CC`, for messages."""
    return ("CC has to be the command of a C compiler that makes shared libraries for this machine, such as gcc or clang; "
            f"without it, the first of {_names()} is taken")


def looked_for() -> str:
    """Compilers that `find` searches for, and a way to install one, for messages."""
    if SYSTEM == "emscripten":
        return "none, as Python in WebAssembly starts no programs"
    if not said():
        return f"{_names()}; {INSTALLED.get(SYSTEM, IN_PACKAGES)} would bring one"
    program = Path(next(iter(given()), ""))
    why = ", which is a folder" if program.is_dir() else ", which may not be executed" if program.is_file() else ""
    return f"CC={said()}{why if len(program.parts) > 1 else ''}"


# ---- those there are ----


def _names() -> str:
    of_system = ("Visual Studio's cl",) if SYSTEM == "win32" else ()
    return ", ".join((*_on_path(), *of_system, "the package ziglang"))


def _on_path() -> tuple[str, ...]:
    return ON_PATH.get(SYSTEM, ELSEWHERE)


def _candidates() -> Iterator[list[str]]:
    """Candidate commands, in the order in which they are tried."""
    for name in _on_path():
        if _can_be_called(name):
            yield [name]
    if SYSTEM == "win32" and (found := _visual_studio()):
        yield [found[0]]
    if program := zig():
        yield [program, "cc", *ZIG_FLAGS]


def zig() -> str | None:
    """Program of the package ziglang; None: it is not installed."""
    package = importlib.util.find_spec("ziglang")
    return str(Path(package.origin).parent / ("zig.exe" if SYSTEM == "win32" else "zig")) if package and package.origin else None


def _can_be_called(name: str) -> bool:
    """True if a command is a working compiler.

    Microsoft's finds nothing without the variables of its command prompt. Apple's exist from the beginning, and open a window
    that asks for permission to install them.
    """
    if name == "cl":
        return "INCLUDE" in os.environ
    program = shutil.which(name) if SYSTEM == "darwin" else None
    return program is None or os.path.dirname(program) != "/usr/bin" or _answer(["xcode-select", "-p"]) != ""


def _called(program: str) -> str:
    name = os.path.basename(program).lower()
    return name.removesuffix(".exe")


def _variables_of(program: str) -> dict[str, str] | None:
    """Environment variables that a compiler needs and this process does not have; None: it needs none."""
    if SYSTEM != "win32" or _called(program) != "cl" or "INCLUDE" in os.environ:
        return None
    found = _visual_studio()
    return found[1] if found else None


# ---- Visual Studio ----


def _visual_studio() -> tuple[str, dict[str, str]] | None:
    """Microsoft's compiler, located by its installer's tool, and the environment variables of its command prompt."""
    folder = os.environ.get("PROGRAMFILES(X86)") or os.environ.get("PROGRAMFILES", "")
    return _visual_studio_of(str(Path(folder, "Microsoft Visual Studio", "Installer", "vswhere.exe")))


@cache          # it takes some seconds
def _visual_studio_of(vswhere: str) -> tuple[str, dict[str, str]] | None:
    target = {"win-arm64": "arm64", "win32": "x86"}.get(sysconfig.get_platform(), "x64")
    where = _answer([vswhere, "-latest", "-prerelease", "-products", "*", "-property", "installationPath", "-utf8"])
    script = Path(where, "VC", "Auxiliary", "Build", "vcvarsall.bat")
    if not where or not script.is_file():
        return None
    lines = _answer(["cmd", "/d", "/s", "/c", f'""{script}" {target} > nul && set"']).splitlines()
    variables = dict(line.split("=", 1) for line in lines if "=" in line)
    program = shutil.which("cl", path=next((value for name, value in variables.items() if name.upper() == "PATH"), ""))
    return (program, variables) if program else None


def _answer(command: list[str]) -> str:
    """Standard output of a program; empty if it is missing or fails."""
    try:
        line = command if command[0] != "cmd" else " ".join(command)    # which reads quotes in a way of its own
        result = subprocess.run(line, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace", check=False,
                                timeout=PATIENCE, creationflags=QUIETLY)
    except (OSError, subprocess.SubprocessError):
        return ""
    return result.stdout.strip() if result.returncode == 0 else ""
