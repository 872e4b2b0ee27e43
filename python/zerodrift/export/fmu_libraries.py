"""Shared libraries of an FMU: for this platform by its C compiler, for platforms that are named by the package ziglang."""

from __future__ import annotations

import platform
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from .._private import checks
from ..errors import CompilationFailed, WrongType, WrongValue
from ..symbolics.compile import compilers
from . import core_build
from .core_files import CoreFiles

FLAGS = ("-O1", "-std=c11", "-ffp-contract=off", "-fPIC", "-fvisibility=hidden")      # -O2 takes longer to compile
MACHINES = {"x86_64": "x86_64", "amd64": "x86_64", "aarch64": "aarch64", "arm64": "aarch64"}
SYSTEMS = {"linux": "linux", "darwin": "darwin", "win32": "windows"}
SUFFIXES = {"linux": ".so", "darwin": ".dylib", "windows": ".dll"}
# Targets of zig by the systems of the standard. The oldest glibc of Linux distributions in use: libraries load with later ones.
TARGETS = {"linux": "linux-gnu.2.17", "darwin": "macos", "windows": "windows-gnu"}
OF_FMI3 = {f"{machine}-{system}": (machine, system) for system in SUFFIXES for machine in ("x86_64", "aarch64")}
OF_FMI2 = {"linux64": ("x86_64", "linux"), "darwin64": ("x86_64", "darwin"), "win64": ("x86_64", "windows")}
PLATFORMS = {"3.0": OF_FMI3, "2.0": OF_FMI2}        # by version of the standard and name in it: machine and system


class Library(NamedTuple):
    """A shared library: name of its platform in the standard, suffix of its file, and content."""

    platform: str
    suffix: str
    content: bytes


def chosen_platforms(names: Any, version: str) -> tuple[str, ...]:
    """Check the names of platforms; each is taken once.

    Raises
    ------
    CompilationFailed
        If the package ziglang is not installed.
    """
    if isinstance(names, str) or not isinstance(names, Sequence) or not names:
        raise WrongType(f"platforms must be a list of names, not {checks.shown(names)}")
    for name in names:
        checks.choice(f"platforms of FMI {version}", name, PLATFORMS[version])
    if compilers.zig() is None:
        raise CompilationFailed("libraries for platforms= must be compiled by ziglang: pip install zerodrift[fmu]")
    return tuple(dict.fromkeys(names))


def libraries(files: CoreFiles, own: Mapping[str, str], version: str, platforms: Sequence[str] | None) -> list[Library]:
    """Libraries of the core and of the unit's own sources; None: for this platform."""
    if platforms is None:
        return [_of_this_platform(files, own, version)]
    return [_of_platform(files, own, name, *PLATFORMS[version][name]) for name in platforms]


def _of_this_platform(files: CoreFiles, own: Mapping[str, str], version: str) -> Library:
    here = MACHINES.get(platform.machine().lower()), SYSTEMS.get(sys.platform)
    name, system = next(((name, there[1]) for name, there in PLATFORMS[version].items() if there == here), ("", ""))
    if not name:
        raise WrongValue(f"FMI {version} has no name for this platform, {sys.platform} on {platform.machine()}")
    compiler = compilers.find()
    if compiler is None or compiler.is_like_msvc:
        raise CompilationFailed(f"an FMU needs a C compiler with the options of gcc (looked for {compilers.looked_for()})")
    command = compiler.command
    core = core_build.compiled(files, command, FLAGS, join=[*command, "-r", "-nostdlib", "-o"], product="core.o")
    return Library(name, SUFFIXES[system], _linked(files, own, command, {"core.o": core}))


def _of_platform(files: CoreFiles, own: Mapping[str, str], name: str, machine: str, system: str) -> Library:
    """Library that zig makes; its linkers do not join objects into one for all systems, so the core is an archive."""
    program = compilers.zig() or "zig"
    command = [program, "cc", "-target", f"{machine}-{TARGETS[system]}", *compilers.ZIG_FLAGS, "-g0"]
    core = core_build.compiled(files, command, FLAGS, join=[program, "ar", "rcs"], product="core.a")
    return Library(name, SUFFIXES[system], _linked(files, own, [*command, "-s"], {"core.a": core}))


def _linked(files: CoreFiles, own: Mapping[str, str], command: Sequence[str], core: Mapping[str, bytes]) -> bytes:
    """Content of the library of a compiled core and of the unit's own sources."""
    with tempfile.TemporaryDirectory() as folder:
        here = Path(folder)
        files.write(here)
        for file, content in core.items():
            (here / file).write_bytes(content)
        for file, text in own.items():
            (here / file).write_text(text, encoding="utf-8")
        sources = [file for file in own if file.endswith(".c")]
        core_build.run([*command, *FLAGS, "-shared", "-I.", "-o", "library", *sources, *core, "-lm"], here)
        return (here / "library").read_bytes()
