"""Cache of derived and compiled code: reused, verified before use, and never an obstacle where it fails."""

import ctypes
import os
import sys
import tempfile
from pathlib import Path

import pytest
import sympy as sp

import zerodrift as zd
from cached_system import GIVEN, A, Q, elsewhere, made, said
from zerodrift.symbolics import define
from zerodrift.symbolics.compile import cache as kept
from zerodrift.symbolics.compile import compilers, shared_library
from zerodrift.symbolics.emit import closed_form, closed_form_writer

# ---- what is kept ----


def test_the_second_process_neither_derives_nor_compiles(cache_folder, compiler, monkeypatch):
    said(elsewhere())
    assert compiler.calls == 1
    monkeypatch.setattr(define, "_derive", None)
    made()
    said(elsewhere())
    assert compiler.calls == 1


def test_values_and_the_start_are_not_part_of_what_is_compiled(cache_folder, compiler):
    made()
    zd.symbolic([Q], **(GIVEN | {"parameters": {A: 3.0}, "p0": [1.0], "name": "other"}))
    assert compiler.calls == 1


def test_another_definition_is_derived_anew(cache_folder):
    made()
    spare = zd.symbolic([Q], **(GIVEN | {"parameters": {"spare": 1.0, "a": 2.0}}))
    assert list(spare.parameters) == ["spare", "a"]
    assert zd.symbolic([Q], **(GIVEN | {"parameters": {"a": 2.0}})).parameters == {"a": 2.0}
    other = zd.symbolic([Q], **(GIVEN | {"potential": A * sp.sin(Q)}))
    assert other.evaluate([0.5]).f == pytest.approx(-2.0 * 0.8775825618903728)


def test_a_changed_compiler_and_changed_flags_compile_anew(cache_folder, compiler, monkeypatch):
    made()
    compiler.script.write_text(compiler.script.read_text() + "# a new version\n")
    made()
    assert compiler.calls == 2
    os.utime(compiler.script, (1, 1))       # as large as before, but another
    made()
    assert compiler.calls == 3
    monkeypatch.setenv("CC", f"{compiler.script} -O1")
    made()
    assert compiler.calls == 4
    line = compilers.Compiler.line
    monkeypatch.setattr(compilers.Compiler, "line", lambda *arguments: [*line(*arguments), "-g"])
    made()
    assert compiler.calls == 5
    made()
    assert compiler.calls == 5


@pytest.mark.each_value
@pytest.mark.pairs(which=["*.so", "*.json"], damage={
    "empty": lambda data: b"", "cut": lambda data: data[:100], "altered": lambda data: data[:-1] + b"?",
    "other": lambda data: b"not what it was", "gone": None})
def test_damaged_files_are_made_anew(cache_folder, compiler, damage, which):
    made()
    for path in cache_folder.glob(which):
        data = path.read_bytes()
        path.unlink()
        if damage:
            path.write_bytes(damage(data))
    made()
    assert compiler.calls == 2
    made()
    assert compiler.calls == 2


def test_a_definition_that_still_reads_well_but_was_altered(cache_folder):
    made()
    for path in cache_folder.glob("*.json"):
        path.write_bytes(path.read_bytes().replace(b"sin(", b"cos("))
    made()


def test_functions_that_are_not_sympys_are_not_taken_from_the_cache(cache_folder):
    values = iter([1.0, 2.0])
    for value in values:
        class Once(sp.Function):
            nargs = 1

            def fdiff(self, argindex=1):
                return sp.S.One

            def _ccode(self, printer, value=value):
                return f"({value} * {printer._print(self.args[0])})"

        system = zd.symbolic([Q], kinetic=Q.diff() ** 2, potential=Once(Q))
        assert float(system.evaluate([3.0]).V) == pytest.approx(3.0 * value)


def test_many_processes_at_once(cache_folder):
    assert len({said(process) for process in [elsewhere() for _ in range(3)]}) == 1
    assert not [path for path in cache_folder.iterdir() if path.suffix not in (".so", ".json")]


# ---- what must not stop anyone ----


def test_a_cache_that_cannot_be_written(tmp_path, cache_folder, monkeypatch):
    """A file stands in its place: not even the superuser can write there."""
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("ZERODRIFT_CACHE", str(tmp_path / "file" / "cache"))
    with pytest.warns(zd.CacheWarning, match="compiled systems are not kept: .*file.cache cannot be written") as caught:
        made()
    assert len(caught) == 1
    made()      # and once is enough
    monkeypatch.setattr(shared_library, "_build", None)
    made()      # it is kept as long as the process lasts


def test_a_cache_that_is_read_only_but_has_it(cache_folder, monkeypatch):
    made()
    monkeypatch.setattr(kept, "put", None)
    made()


@pytest.mark.skipif(kept.AS_WINDOWS or not os.path.isdir(kept.OPENED), reason="there are no paths to what is open")
def test_where_nothing_is_executed_from_temporary_folders(cache_folder, monkeypatch):
    load, loaded = ctypes.CDLL, []

    def refusing(path):
        if Path(path).is_relative_to(tempfile.gettempdir()):
            raise OSError("failed to map segment from shared object")
        loaded.append(path)
        return load(path)

    monkeypatch.setattr(shared_library.gateway.compiled.functions.ctypes, "CDLL", refusing)
    monkeypatch.setattr(shared_library.gateway.compiled.functions, "_loaded", {})
    made()
    monkeypatch.setattr(shared_library.gateway.compiled.functions, "_loaded", {})
    monkeypatch.setattr(shared_library, "_build", None)
    made()
    assert len(loaded) == 2
    assert all(path.startswith(kept.OPENED) for path in loaded)


@pytest.mark.skipif(kept.AS_WINDOWS, reason="the places are those of POSIX")
def test_where_the_cache_is(monkeypatch):
    monkeypatch.setenv("ZERODRIFT_CACHE", "~/mine")
    assert kept._chosen() == Path.home() / "mine"
    monkeypatch.delenv("ZERODRIFT_CACHE")
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("XDG_CACHE_HOME", "/somewhere")
    assert kept._chosen() == Path("/somewhere/zerodrift")
    monkeypatch.delenv("XDG_CACHE_HOME")
    assert kept._chosen() == Path.home() / ".cache" / "zerodrift"
    monkeypatch.setenv("XDG_CACHE_HOME", "relative")    # which the XDG Base Directory Specification says to ignore
    assert kept._chosen() == Path.home() / ".cache" / "zerodrift"


# ---- as on Windows ----


@pytest.fixture
def as_windows(cache_folder, monkeypatch):
    """Cache as on Windows, where files cannot be opened relative to an open folder; emulated on other systems."""
    monkeypatch.setattr(kept, "AS_WINDOWS", True)
    return cache_folder


def test_on_windows_files_are_reached_by_their_paths(as_windows):
    kept.put("some", b"first")
    kept.put("some", b"second")
    assert kept.get("some") == b"second"
    assert [path.name for path in as_windows.iterdir()] == ["some"]
    with kept.place("some", b"second") as path, kept.place("some", b"other") as nowhere:
        assert (Path(path), nowhere) == (as_windows / "some", None)
    kept.drop("some")
    assert (kept.get("some"), list(as_windows.iterdir())) == (None, [])


def test_on_windows_libraries_are_loaded_from_where_they_are_kept(as_windows, monkeypatch):
    """Windows locks a loaded library against changes, and a loaded copy could not be removed."""
    load, loaded = ctypes.CDLL, []
    functions = shared_library.gateway.compiled.functions
    monkeypatch.setattr(functions.ctypes, "CDLL", lambda path: loaded.append(Path(path)) or load(path))
    monkeypatch.setattr(shared_library.gateway.compiled.functions, "_loaded", {})
    assert made().compiled
    assert loaded
    assert all(path.parent == as_windows for path in loaded)


def test_on_windows_what_is_loaded_is_not_replaced(as_windows, monkeypatch):
    def refusing(*paths, **folders):
        raise PermissionError(13, "Access is denied")

    kept.put("some", b"first")
    monkeypatch.setattr(kept.os, "replace", refusing)
    kept.put("some", b"first")      # from another process, and the same
    with pytest.warns(zd.CacheWarning, match=r"cannot be written \(Access is denied\)"):
        kept.put("some", b"second")
    assert [path.read_bytes() for path in as_windows.iterdir()] == [b"first"]
    assert kept.get("some") == b"second"


def test_where_the_cache_is_on_windows(as_windows, tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "platform", "win32")
    monkeypatch.delenv("ZERODRIFT_CACHE")
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path))
    assert kept._chosen() == tmp_path / "zerodrift"
    monkeypatch.delenv("LOCALAPPDATA")
    assert kept._chosen() == Path.home() / "AppData" / "Local" / "zerodrift"


def test_closed_form_functions_are_written_once(cache_folder, monkeypatch):
    """Their text is found by what it depends on: the operations, numbers at which orders were chosen, and the limits."""
    system = made()
    source = system._closed_form.source
    assert source
    monkeypatch.setattr(closed_form, "write", lambda *given, **options: pytest.fail("written again"))
    assert made()._closed_form.source == source
    assert made().with_parameters(a=3.0)._closed_form.constants == system._closed_form.constants
    monkeypatch.setattr(closed_form, "write", lambda *given, **options: ("another", 0))
    other = zd.symbolic([Q], **(GIVEN | {"potential": A * sp.sin(Q)}))
    assert other._closed_form.source == "another"
    monkeypatch.setattr(closed_form_writer, "MAX_STATEMENTS", 900)
    assert made()._closed_form.source == "another"
