"""Which compiler is found on Linux, macOS and Windows, by programs that stand for those there, and how each is called."""

import importlib.util
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import zerodrift as zd
from cached_system import made
from core_objects import CC, needs_compiler
from zerodrift.symbolics.compile import compilers

PATH = os.environ["PATH"]
VSWHERE = Path("Microsoft Visual Studio", "Installer", "vswhere.exe")
VCVARSALL = Path("VC", "Auxiliary", "Build", "vcvarsall.bat")


def program(path, text="exit 0"):
    if os.name == "nt":
        pytest.skip("what stands for a compiler is a script of POSIX' shell")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"#!/bin/sh\n{text}\n")
    path.chmod(0o755)
    return path


@pytest.fixture
def machine(tmp_path, monkeypatch):
    """A machine with nothing installed, of whichever system: what is to be there is put in its folder bin."""
    for name in ("CC", "INCLUDE", "PROGRAMFILES", "PROGRAMFILES(X86)"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("PATH", str(tmp_path / "bin"))
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    compilers._visual_studio_of.cache_clear()

    def of(system, *names):
        monkeypatch.setattr(compilers, "SYSTEM", system)
        for name in names:
            program(tmp_path / "bin" / name)
        return tmp_path

    yield of
    compilers._visual_studio_of.cache_clear()


def found():
    compiler = compilers.find()
    return compiler and Path(compiler.command[0]).name


@pytest.mark.parametrize(("platform", "there", "taken"), [
    ("linux", ("clang", "gcc", "cc"), "cc"), ("linux", ("clang", "gcc"), "gcc"), ("linux", ("clang",), "clang"),
    ("linux", ("cl",), None),
    ("darwin", ("gcc", "clang"), "clang"), ("darwin", ("gcc",), "gcc"), ("darwin", (), None),
    ("win32", ("clang", "clang-cl", "gcc"), "gcc"), ("win32", ("clang", "clang-cl"), "clang-cl"), ("win32", ("clang",), "clang"),
    ("win32", ("cc", "cl"), None),      # outside of its command prompt that finds no headers
])
def test_the_first_on_the_path_is_taken(machine, platform, there, taken):
    machine(platform, *there)
    assert found() == taken


def test_microsofts_compiler_is_taken_first_in_its_command_prompt(machine, monkeypatch):
    machine("win32", "cl", "gcc")
    monkeypatch.setenv("INCLUDE", "headers")
    assert found() == "cl"
    assert compilers.find().environment is None


@pytest.mark.parametrize(("installed", "taken"), [(True, "clang"), (False, None)])
def test_what_only_offers_to_install_apples_compiler_is_none(machine, monkeypatch, installed, taken):
    folder = machine("darwin", "xcode-select")
    program(folder / "bin" / "xcode-select", "echo /Library/Developer" if installed else "exit 2")
    which = {"cc": None, "clang": "/usr/bin/clang", "gcc": "/usr/bin/gcc"}
    monkeypatch.setattr(compilers.shutil, "which", which.get)
    assert found() == taken


def test_the_compiler_of_the_package_ziglang_is_taken_last(machine, monkeypatch):
    folder = machine("win32")
    program(folder / "ziglang" / "zig.exe")
    spec = importlib.util.spec_from_loader("ziglang", None, origin=str(folder / "ziglang" / "__init__.py"))
    monkeypatch.setattr(importlib.util, "find_spec", {"ziglang": spec}.get)
    zig, *options = compilers.find().command
    assert (Path(zig).name, options[0]) == ("zig.exe", "cc")
    assert "-mcpu=baseline" in options          # by itself it writes for the processor that it runs on
    program(folder / "bin" / "gcc")
    assert found() == "gcc"


# ---- Visual Studio ----


@pytest.fixture
def studio(machine, monkeypatch):
    """Visual Studio, whose script is read by a shell that takes its command as Windows does: as one string."""
    folder = machine("win32")
    monkeypatch.setenv("PROGRAMFILES(X86)", str(folder))
    where = program(folder / "Visual Studio" / VCVARSALL)
    program(folder / "Visual Studio" / "bin" / "cl")
    program(folder / VSWHERE, f"echo '{folder / 'Visual Studio'}'")
    commands, run = [], subprocess.run

    def shell(line, **options):
        if not isinstance(line, str):
            return run(line, **options)
        commands.append(line)
        text = f"Path={folder / 'Visual Studio' / 'bin'}\nINCLUDE=headers\nLIB=a=b\nnothing\n"
        return subprocess.CompletedProcess(line, 0, text, "")

    monkeypatch.setattr(compilers.subprocess, "run", shell)
    return folder, where, commands


def test_visual_studio_is_found_by_its_installer(studio):
    folder, where, commands = studio
    compiler = compilers.find()
    assert compiler.command == [str(folder / "Visual Studio" / "bin" / "cl")]
    assert (compiler.environment["INCLUDE"], compiler.environment["LIB"]) == ("headers", "a=b")
    assert commands == [f'cmd /d /s /c ""{where}" x64 > nul && set"']
    assert compilers.find() == compiler
    assert len(commands) == 1           # the compiler is called once


@pytest.mark.parametrize(("platform", "target"), [("win-arm64", "arm64"), ("win32", "x86"), ("win-amd64", "x64")])
def test_visual_studio_writes_for_the_processor_of_this_python(studio, monkeypatch, platform, target):
    monkeypatch.setattr(compilers.sysconfig, "get_platform", lambda: platform)
    assert compilers.find()
    assert f'" {target} >' in studio[2][0]


@pytest.mark.parametrize("missing", [VSWHERE, Path("Visual Studio") / VCVARSALL, Path("Visual Studio", "bin", "cl")])
def test_visual_studio_without_its_compiler_is_none(studio, missing):
    (studio[0] / missing).unlink()
    assert compilers.find() is None


def test_an_installer_that_fails_is_none(studio):
    program(studio[0] / VSWHERE, "echo nowhere; exit 1")
    assert compilers.find() is None


def test_cl_named_in_cc_has_its_variables(studio, monkeypatch):
    program(studio[0] / "bin" / "cl.exe")
    monkeypatch.setenv("CC", "cl.exe /Zi")
    compiler = compilers.find()
    assert compiler.command[1:] == ["/Zi"]
    assert compiler.is_like_msvc
    assert compiler.environment["INCLUDE"] == "headers"


# ---- how they are called ----


def line_of(name):
    return compilers.Compiler([name]).line("system.c", "system.dll", "headers", ["-O1"], ["ZD_SETS=1"])


@pytest.mark.parametrize(("platform", "own"), [("linux", {"-fPIC", "-lm"}), ("darwin", {"-fPIC", "-lm"}),
                                              ("win32", {"-static-libgcc"})])
def test_options_of_gcc(monkeypatch, platform, own):
    monkeypatch.setattr(compilers, "SYSTEM", platform)
    line = line_of("gcc")
    assert {"-O1", "-std=c11", "-ffp-contract=off", "-shared", "-DZD_SETS=1", "-Iheaders"} < set(line)
    assert line[line.index("-o") + 1:][:2] == ["system.dll", "system.c"]
    assert {"-fPIC", "-lm", "-static-libgcc"} & set(line) == own


@pytest.mark.parametrize("name", ["cl", "CL.EXE", "clang-cl", "clang-cl.exe"])
def test_options_of_msvc(name):
    line = line_of(name)
    assert {"/O2", "/std:c11", "/fp:precise", "/LD", "/DZD_SETS=1", "/Iheaders", "/Fe:system.dll", "system.c"} < set(line)
    assert not [option for option in line[1:] if option.startswith("-")]
    assert ("/clang:-ffp-contract=off" in line) == ("clang" in name)        # whose /fp:precise contracts


@needs_compiler
@pytest.mark.parametrize(("macros", "sets"), [
    (("__GNUC__=12", "__x86_64__"), 63), (("__GNUC__=4", "__x86_64__", "__clang__"), 63), (("__GNUC__=12", "__aarch64__"), 3),
    (("__GNUC__=12", "__x86_64__", "_WIN32"), 3),       # which misaligns longer vectors where it spills them
    (("__GNUC__=4", "__x86_64__", "_WIN32", "__clang__"), 63), (("_MSC_VER=1940", "_WIN32"), 1),
    (("__GNUC__=12", "__x86_64__", "_WIN32", "ZD_SETS=12"), 1), (("__GNUC__=12", "__x86_64__", "ZD_SETS=12"), 12),
], ids=lambda each: "-".join(word.strip("_") for word in each) if isinstance(each, tuple) else None)
def test_vector_units_that_a_compiler_writes_for(macros, sets):
    known = ("__GNUC__", "__clang__", "__x86_64__", "__aarch64__", "_WIN32")
    macros = [*(f"-U{name}" for name in known), *(f"-D{macro}" for macro in macros)]
    command = [CC, *macros, f"-I{zd.get_include()}", "-E", "-P", "-"]
    said = subprocess.run(command, input='#include "zerodrift/units.h"\nZD_SETS\n', capture_output=True, text=True, check=True)
    assert int(said.stdout) == sets


def test_symbols_are_exported_where_nothing_is_without_being_asked(tmp_path):
    source = compilers.exporting("int one;\n", ["zd_one", "zd_two"])
    assert source.startswith("int one;\n")
    assert source.count("#pragma comment(linker, \"/export:zd_") == 2
    assert source.index("#ifdef _MSC_VER") < source.index("#pragma")


# ---- what is said ----


@pytest.mark.parametrize(("platform", "names", "what"), [
    ("linux", "cc, gcc, clang, the package ziglang", "the system's gcc or clang, or `pip install ziglang`"),
    ("darwin", "cc, clang, gcc, the package ziglang", "`xcode-select --install` or `pip install ziglang`"),
    ("win32", "cl, gcc, clang-cl, clang, Visual Studio's cl, the package ziglang", "Microsoft's build tools for C\\+\\+"),
])
def test_where_there_is_none_it_is_said_what_would_be_one(machine, cache_folder, platform, names, what):
    machine(platform)
    with pytest.warns(zd.NoCompilerWarning, match=rf"there is no C compiler \(looked for {names}; {what}.* would bring one\)"):
        assert not made().compiled


@pytest.mark.parametrize(("said", "words"), [
    (r"C:\LLVM\bin\clang.exe -O2", [r"C:\LLVM\bin\clang.exe", "-O2"]),
    (r'"C:\Program Files\LLVM\bin\clang-cl.exe" /arch:AVX2', [r"C:\Program Files\LLVM\bin\clang-cl.exe", "/arch:AVX2"]),
])
def test_paths_of_windows_in_cc(machine, monkeypatch, said, words):
    machine("win32")
    monkeypatch.setenv("CC", said)
    assert compilers.given() == words


def test_a_complaint_of_msvc_is_shown_with_its_line(machine, cache_folder, monkeypatch):
    folder = machine("win32")
    program(folder / "bin" / "cl", "echo system.c; echo 'system.c(1): error C2143: syntax error'; exit 2")
    monkeypatch.setenv("INCLUDE", "headers")
    with pytest.raises(zd.CompilationFailed, match=r"refused the C source: system.c\(1\): error C2143: .*\n  line 1: \S"):
        made()


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="what stands for the compiler is a script")
def test_a_system_is_compiled_by_what_is_called_as_msvc_is(machine, cache_folder, tmp_path, monkeypatch):
    """All but the compiler itself: a script takes the options of one and calls the other with its own."""
    real, folder = shutil.which("cc", path=PATH), machine("win32")
    program(folder / "bin" / "cl", f'''PATH={PATH}
for word in "$@"; do case "$word" in
    /I*) include="${{word#/I}}";; /Fe:*) product="${{word#/Fe:}}";; *.c) source="$word";; /D*) defined="$defined -D${{word#/D}}";;
esac; done
[ "$INCLUDE" = headers ] && exec {real} -O1 -std=c11 -shared -fPIC $defined "-I$include" -o "$product" "$source" -lm''')
    monkeypatch.setenv("INCLUDE", "headers")
    assert made().compiled
