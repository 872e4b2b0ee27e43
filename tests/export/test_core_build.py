"""Cores that are compiled: objects are kept between them, and what takes long is said."""

from pathlib import Path

import pytest

from zerodrift.export import core_build, wasm
from zerodrift.export.core_files import CoreFiles
from zerodrift.symbolics import progress_message

JOIN = ["join", "-o"]


@pytest.fixture
def compiled(monkeypatch, tmp_path):
    """Sources that a compiler in Python was called for, whose objects are their names and options."""
    monkeypatch.setenv("ZERODRIFT_CACHE", str(tmp_path))
    found = []

    def run(line, here):
        if line[0] == "join":
            (here / line[2]).write_bytes(b"".join(sorted((here / each).read_bytes() for each in line[3:])))
            return
        assert (here / line[-1]).exists()
        found.append(line[-1])
        (here / line[line.index("-o") + 1]).write_text(f"{line[-1]} {' '.join(line[:2])}\n")

    monkeypatch.setattr(core_build, "run", run)
    return found


def core(**lists):
    return CoreFiles({**wasm.LISTS, **lists})


def product(files, options=("-O2",), more=None):
    return core_build.compiled(files, ["cc"], options, join=JOIN, product="core.o", more=more or {})


def test_a_core_with_other_methods_takes_the_objects_that_are_alike(compiled):
    first = product(core())
    assert sorted(compiled) == sorted(core().sources)
    compiled.clear()
    other = core(INTEGRATOR=("zd_heun",))
    second = product(other)
    assert 0 < len(compiled) < 0.1 * len(core().sources)
    assert all("methods.h" in core_build.included(each) for each in compiled if each in core().sources)
    assert second.count(b"\n") == len(other.sources) < first.count(b"\n")
    compiled.clear()
    assert (product(core()), product(other)) == (first, second)
    assert compiled == []


def test_other_options_and_sources_beside_the_core_are_compiled_anew(compiled):
    product(core())
    compiled.clear()
    assert b"-O1" in product(core(), ("-O1",))
    assert len(compiled) == len(core().sources)
    compiled.clear()
    product(core(), more={"page.c": "int one;"})
    product(core(), more={"page.c": "int two;"})
    assert compiled == ["page.c", "page.c"]


def test_libraries_are_made_by_their_own_commands_and_kept(compiled):
    made = [core_build.compiled(core(), ["cc"], [f"-O{level}"], join=JOIN, product="core.o",
                                libraries={"sine.o": ["zig", "-o", "sine.o", str(Path(wasm.__file__))]}) for level in (2, 2, 1)]
    assert all(f"{wasm.__file__} zig -o\n".encode() in each for each in made)
    assert compiled.count(str(Path(wasm.__file__))) == 2


def test_the_whole_c_library_is_taken_if_its_parts_do_not_compile(monkeypatch):
    monkeypatch.setattr(wasm.compilers, "zig", lambda: "zig")
    calls = []

    def made(*_, join, libraries=None, **__):
        calls.append(join)
        if libraries:
            raise wasm.CompilationFailed("zig must compile the core, and failed: error: no")
        return b"core"

    monkeypatch.setattr(core_build, "compiled", made)
    assert wasm.core() == b"core"
    assert ["-nostdlib" in each for each in calls] == [True, False]


def test_what_is_compiled_is_said_with_progress(compiled, monkeypatch, capsys):
    monkeypatch.setattr(progress_message, "PATIENCE", 0.0)
    monkeypatch.setattr(core_build, "EVERY", 0.0)
    product(core())
    said = capsys.readouterr().err
    assert f"compiling {len(core().sources)} files with cc, once" in said
    assert "joining objects" in said


def test_errors_leave_nothing(compiled, monkeypatch, tmp_path):
    def fail(line, here):
        raise core_build.CompilationFailed("cc must compile the core, and failed: error: no")

    monkeypatch.setattr(core_build, "run", fail)
    with pytest.raises(core_build.CompilationFailed):
        product(core())
    assert not list(Path(tmp_path).glob("core-*"))
