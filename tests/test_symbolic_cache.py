"""What is derived and compiled is kept: found again, never trusted blindly, and never in anyone's way."""

import os
import stat
import subprocess
import sys
import warnings
from pathlib import Path

import pytest
import sympy as sp
from sympy.physics.mechanics import dynamicsymbols

import zerodrift as zd
from support import assert_close
from zerodrift.symbolics import compiling, define

Q = dynamicsymbols("q")
A = sp.Symbol("a")
GIVEN = {"kinetic": Q.diff() ** 2 / 2, "potential": A * sp.cos(Q), "parameters": {A: 2.0}}
SCRIPT = """
import sys, sympy as sp
from sympy.physics.mechanics import dynamicsymbols
import zerodrift as zd
Q, A = dynamicsymbols("q"), sp.Symbol("a")
system = zd.symbolic([Q], kinetic=Q.diff() ** 2 / 2, potential=A * sp.cos(Q), parameters={A: 2.0})
print(*system.evaluate([0.5]).f)
"""


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """An empty cache, and nothing that this process remembers."""
    folder = tmp_path / "cache"
    monkeypatch.setenv("ZERODRIFT_CACHE", str(folder))
    monkeypatch.setattr(define, "_derived", {})
    monkeypatch.setattr(compiling, "_warned", set())
    return folder


@pytest.fixture
def compiler(tmp_path, monkeypatch):
    """A compiler that counts its calls."""
    log, script = tmp_path / "calls", tmp_path / "compiler"
    script.write_text(f"#!/bin/sh\necho called >> '{log}'\nexec cc \"$@\"\n")
    script.chmod(script.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("CC", str(script))
    return Compiler(script, log)


class Compiler:
    def __init__(self, script: Path, log: Path) -> None:
        self.script, self.log = script, log

    @property
    def calls(self):
        return len(self.log.read_text().splitlines()) if self.log.exists() else 0


def made():
    """The system, by a process that remembers nothing."""
    define._derived.clear()
    system = zd.symbolic([Q], **GIVEN)
    assert system.evaluate([0.5]).f == pytest.approx(2.0 * 0.479425538604203)
    return system


def elsewhere(**environment):
    """The same in a process of its own."""
    return subprocess.Popen([sys.executable, "-W", "error", "-c", SCRIPT], env=os.environ | environment, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def said(process):
    out, err = process.communicate()
    assert process.returncode == 0, err
    return float(out)


# ---- what is kept ----


def test_the_second_process_neither_derives_nor_compiles(cache, compiler, monkeypatch):
    said(elsewhere())
    assert compiler.calls == 1
    monkeypatch.setattr(define, "_derive", None)
    made()
    said(elsewhere())
    assert compiler.calls == 1


def test_values_and_the_start_are_no_part_of_what_is_compiled(cache, compiler):
    made()
    zd.symbolic([Q], **(GIVEN | {"parameters": {A: 3.0}, "p0": [1.0], "name": "other"}))
    assert compiler.calls == 1


def test_another_definition_is_derived_anew(cache):
    made()
    spare = zd.symbolic([Q], **(GIVEN | {"parameters": {"spare": 1.0, "a": 2.0}}))
    assert list(spare.parameters) == ["spare", "a"]
    assert zd.symbolic([Q], **(GIVEN | {"parameters": {"a": 2.0}})).parameters == {"a": 2.0}
    other = zd.symbolic([Q], **(GIVEN | {"potential": A * sp.sin(Q)}))
    assert other.evaluate([0.5]).f == pytest.approx(-2.0 * 0.8775825618903728)


def test_a_changed_compiler_and_changed_flags_compile_anew(cache, compiler, monkeypatch):
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
    monkeypatch.setattr(compiling, "FLAGS", (*compiling.FLAGS, "-g"))
    made()
    assert compiler.calls == 5
    made()
    assert compiler.calls == 5


@pytest.mark.parametrize("damage", [lambda data: b"", lambda data: data[:100], lambda data: data[:-1] + b"?",
                                    lambda data: b"not what it was", None], ids=["empty", "cut", "altered", "other", "gone"])
@pytest.mark.parametrize("which", ["*.so", "*.json"])
def test_damaged_files_are_made_anew(cache, compiler, damage, which):
    made()
    for path in cache.glob(which):
        data = path.read_bytes()
        path.unlink()
        if damage:
            path.write_bytes(damage(data))
    said(elsewhere())
    assert compiler.calls == 2
    said(elsewhere())
    assert compiler.calls == 2


def test_a_definition_that_still_reads_well_but_was_altered(cache):
    made()
    for path in cache.glob("*.json"):
        path.write_bytes(path.read_bytes().replace(b"sin(", b"cos("))
    made()


def test_functions_that_are_not_sympys_are_not_taken_from_the_cache(cache):
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


def test_many_processes_at_once(cache):
    assert len({said(process) for process in [elsewhere() for _ in range(6)]}) == 1
    assert not [path for path in cache.iterdir() if path.suffix not in (".so", ".json")]


# ---- what must not stop anyone ----


def test_a_cache_that_cannot_be_written(tmp_path, cache, monkeypatch):
    """A file stands in its place: not even the superuser can write there."""
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("ZERODRIFT_CACHE", str(tmp_path / "file" / "cache"))
    with pytest.warns(zd.CacheWarning, match="compiled systems are not kept: .*file/cache cannot be written") as caught:
        made()
    assert len(caught) == 1
    made()      # and once is enough
    monkeypatch.setattr(compiling, "_build", None)
    made()      # it is kept as long as the process lasts


def test_a_cache_that_is_read_only_but_has_it(cache, monkeypatch):
    made()
    monkeypatch.setattr(compiling, "put", None)
    made()


def test_a_folder_from_which_nothing_is_executed(cache, monkeypatch):
    load = compiling._gateway.load_library

    def refusing(path):
        if cache in Path(path).parents:
            raise OSError("failed to map segment from shared object")
        return load(path)

    monkeypatch.setattr(compiling._gateway, "load_library", refusing)
    made()


def test_where_the_cache_is(monkeypatch):
    monkeypatch.setenv("ZERODRIFT_CACHE", "~/mine")
    assert compiling._chosen() == Path.home() / "mine"
    monkeypatch.delenv("ZERODRIFT_CACHE")
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("XDG_CACHE_HOME", "/somewhere")
    assert compiling._chosen() == Path("/somewhere/zerodrift")
    monkeypatch.delenv("XDG_CACHE_HOME")
    assert compiling._chosen() == Path.home() / ".cache" / "zerodrift"


# ---- compilers ----


def test_without_a_compiler_it_is_evaluated_in_python(cache, monkeypatch):
    compiled = made()
    monkeypatch.setenv("CC", "no-such-compiler")
    with pytest.warns(zd.NoCompilerWarning, match=r"there is no C compiler \(looked for CC=no-such-compiler\): symbolic is"):
        slow = made()
    assert (compiled.compiled, slow.compiled) == (True, False)
    assert repr(slow).endswith("constraints, evaluated in Python>")
    a, b = (zd.simulate(system, 1.0, [0.5], step=0.01, energy=True) for system in (slow, compiled))
    assert_close(a.p, b.p, 1e-13)
    assert_close(a.energy_violation, b.energy_violation, 1e-13, scale=1.0)
    monkeypatch.delenv("CC")
    monkeypatch.setattr(compiling, "CANDIDATES", ())
    with pytest.warns(zd.NoCompilerWarning):
        made()


@pytest.mark.parametrize("name", ["gcc", "clang"])
def test_each_compiler_there_is(cache, monkeypatch, name):
    monkeypatch.setenv("CC", name)
    if compiling.compiler() is None:
        pytest.skip(f"there is no {name}")
    made()


def test_a_compiler_that_fails_is_said(cache, monkeypatch):
    monkeypatch.setenv("CC", "false")
    with pytest.raises(zd.CompilationFailed, match="false refused the C source: status 1"):
        made()


def test_what_is_written_compiles_with_warnings_as_errors(cache, monkeypatch):
    strict = "-Wall -Wextra -Wpedantic -Wshadow -Wstrict-prototypes -Werror"
    monkeypatch.setenv("CC", f"cc {strict}")
    with warnings.catch_warnings():
        made()
        zd.symbolic([Q], kinetic=(2 + sp.sin(Q)) * Q.diff() ** 2, potential=None)
