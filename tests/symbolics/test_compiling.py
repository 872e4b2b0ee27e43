"""Compilers: those there are, none, and what `CC` may name instead of one."""

import contextlib
import os
import re
import socket
import stat
import sys
import warnings

import pytest
import sympy as sp

import tolerances as tol
import zerodrift as zd
from cached_system import Q, made
from support import assert_close
from zerodrift.symbolics.compile import compilers, shared_library

on_posix = pytest.mark.skipif(os.name == "nt", reason="what stands for a compiler is a program of POSIX")


def program(path, text):
    if os.name == "nt":
        pytest.skip("what stands for a compiler is a program of POSIX")
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return path


def refusal():
    with pytest.raises(zd.CompilationFailed) as caught:
        made()
    return str(caught.value)


def test_without_a_compiler_it_is_interpreted(cache_folder, monkeypatch):
    compiled = made()
    monkeypatch.setenv("CC", "no-such-compiler")
    with pytest.warns(zd.NoCompilerWarning, match=r"there is no C compiler \(looked for CC=no-such-compiler\): symbolic is"):
        slow = made()
    assert (compiled.compiled, slow.compiled) == (True, False)
    assert repr(slow).endswith("constraints, interpreted>")
    a, b = (zd.simulate(system, 1.0, [0.5], step=0.01, energy=True) for system in (slow, compiled))
    assert "evaluation  closed form" in repr(a)
    assert_close(a.p, b.p, 1e-13)
    assert_close(a.energy_violation, b.energy_violation, 1e-13, scale=1.0)
    monkeypatch.delenv("CC")
    monkeypatch.setattr(compilers, "_candidates", lambda: iter(()))
    with pytest.warns(zd.NoCompilerWarning):
        made()


@pytest.mark.parametrize("name", ["gcc", "clang"])
def test_each_compiler_there_is(cache_folder, monkeypatch, name):
    monkeypatch.setenv("CC", name)
    if compilers.find() is None:
        pytest.skip(f"there is no {name}")
    made()


@on_posix
def test_a_compiler_that_fails_is_said(cache_folder, monkeypatch):
    monkeypatch.setenv("CC", "false")
    with pytest.raises(zd.CompilationFailed, match="false refused the C source: status 1"):
        made()


@on_posix
def test_what_is_written_compiles_with_warnings_as_errors(cache_folder, monkeypatch):
    strict = "-Wall -Wextra -Wpedantic -Wshadow -Wstrict-prototypes -Werror"
    monkeypatch.setenv("CC", f"cc {strict}")
    with warnings.catch_warnings():
        made()
        zd.symbolic([Q], kinetic=(2 + sp.sin(Q)) * Q.diff() ** 2, potential=None)


# ---- odd ones ----


def test_a_compiler_by_a_relative_path(cache_folder, compiler, monkeypatch):
    monkeypatch.chdir(compiler.script.parent)
    monkeypatch.setenv("CC", "./compiler")
    made()
    monkeypatch.setenv("CC", "compiler")
    monkeypatch.setenv("PATH", f".{os.pathsep}{os.environ['PATH']}")
    made()
    assert compiler.calls == 1      # it is the same program


@pytest.mark.parametrize("said", ["", "  "])
def test_an_empty_name_is_none(cache_folder, monkeypatch, said):
    monkeypatch.setenv("CC", said)
    assert made().compiled


@on_posix
@pytest.mark.parametrize(("said", "why"), [
    ("gcc '", "CC=gcc ' is no command \\(no closing quotation\\): CC has to be the command of a C compiler"),
    ("gcc \\", "CC=gcc \\\\ is no command \\(no escaped character\\)"),
    ("true", "true wrote no library; CC=true, it was run as `/.*true -O1 .*CC has to be the command"),
    ("cc -fsyntax-only", "cc wrote no library; CC=cc -fsyntax-only, it was run as"),
    ("cc -c", "cc wrote a file that cannot be loaded \\(.*\\); CC=cc -c, it was run as `.* TMPDIR"),
    ("cc -S", "cc wrote a file that cannot be loaded"),
    ("cc --no-such-flag", "cc refused the C source: .*no-such-flag.*; CC=cc --no-such-flag, it was run as"),
    ("cat", "cat refused the C source: "),
])
def test_what_is_not_a_compiler_is_refused_by_name(cache_folder, monkeypatch, said, why):
    monkeypatch.setenv("CC", said)
    with pytest.raises(zd.CompilationFailed, match=why):
        made()
    assert not cache_folder.exists() or not list(cache_folder.glob("*.so"))     # nothing is kept of it


@pytest.mark.parametrize(("text", "why"), [
    ("#!/no/such/interpreter\n", "cannot be run \\(No such file or directory\\)"),
    (b"\x7fELF\x02\x01\x01" + bytes(9) + b"\x02\0\xff\xff" + bytes(44), "cannot be run \\(Exec format error\\)"),
    (b"#!/bin/sh\nprintf 'error: \\377\\376' >&2; exit 1\n", "refused the C source: error: \ufffd\ufffd"),
    ("#!/bin/sh\nprintf 'error: on stdout'; exit 1\n", "refused the C source: error: on stdout"),
    ("#!/bin/sh\nkill -9 $$\n", "refused the C source: status -9"),
    ("#!/bin/sh\nread line; exit 3\n", "refused the C source: status 3"),     # there is nothing to be read, and no waiting for it
])
def test_programs_that_fail(cache_folder, tmp_path, monkeypatch, text, why):
    script = program(tmp_path / "odd", text)
    monkeypatch.setenv("CC", str(script))
    with pytest.raises(zd.CompilationFailed, match=f"^{script} {why}.*CC={script}, it was run as `{script} -O1"):
        made()


def test_a_library_of_something_else(cache_folder, tmp_path, monkeypatch):
    (tmp_path / "other.c").write_text("int other;")
    script = program(tmp_path / "odd", f"#!/bin/sh\nexec cc -shared -fPIC -o system.so {tmp_path}/other.c\n")
    monkeypatch.setenv("CC", str(script))
    assert "wrote a file that cannot be loaded" in refusal()


# A program that waits for one that it starts; that one waits until whoever listens leaves.
LISTENER = "import socket, sys; socket.create_connection(('127.0.0.1', int(sys.argv[1]))).recv(1)"
HANGING = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {LISTENER!r}, sys.argv[1]])"


def left_hanging(folder, monkeypatch):
    """The connection to the inner of two programs, the outer of which has been ended because it took too long."""
    monkeypatch.setattr(shared_library, "PATIENCE", 0.1)
    met = []
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.settimeout(tol.HUNG)
        line = [sys.executable, "-c", HANGING, str(server.getsockname()[1])]
        with pytest.raises(zd.CompilationFailed, match=r"did not end within 0.1 s"):
            shared_library._run(line, folder, None, lambda: met.append(server.accept()[0]))
    return met[0]


def assert_all_ended(connection):
    with connection, contextlib.suppress(ConnectionResetError):
        connection.settimeout(tol.HUNG)
        assert connection.recv(1) == b""


def test_a_compiler_that_hangs_is_ended_with_all_it_started(tmp_path, monkeypatch):
    assert_all_ended(left_hanging(tmp_path, monkeypatch))


@on_posix
def test_a_compiler_that_hangs_is_ended_as_on_windows(tmp_path, monkeypatch):
    """A script in place of Windows' taskkill ends processes only if called with the arguments of that program."""
    (tmp_path / "System32").mkdir()
    program(tmp_path / "System32" / "taskkill.exe", '#!/bin/sh\n[ "$1 $2 $3" = "/t /f /pid" ] && kill -s KILL -- "-$4"\n')
    monkeypatch.setenv("SYSTEMROOT", str(tmp_path))
    monkeypatch.delattr(os, "killpg")
    assert_all_ended(left_hanging(tmp_path, monkeypatch))


@on_posix
def test_a_compiler_that_hangs_is_ended_itself_where_windows_has_no_taskkill(tmp_path, monkeypatch):
    monkeypatch.setenv("SYSTEMROOT", str(tmp_path))
    monkeypatch.delattr(os, "killpg")
    with left_hanging(tmp_path, monkeypatch) as connection:     # which is not waited for without end
        connection.settimeout(0.1)
        with pytest.raises(TimeoutError):
            connection.recv(1)


@on_posix
@pytest.mark.parametrize(("name", "why"), [("folder", ", which is a folder"), ("file", ", which may not be executed"),
                                           ("missing", "")])
def test_what_cannot_be_executed_is_as_if_there_were_none(cache_folder, tmp_path, monkeypatch, name, why):
    (tmp_path / "folder").mkdir()
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("CC", str(tmp_path / name))
    with pytest.warns(zd.NoCompilerWarning, match=rf"looked for CC={re.escape(str(tmp_path / name))}{why}\)"):
        assert not made().compiled


def test_flags_in_the_environment_are_not_looked_at(cache_folder, monkeypatch):
    monkeypatch.setenv("CFLAGS", "--no-such-flag '")
    assert made().compiled


def test_without_space_to_compile(cache_folder, tmp_path, monkeypatch):
    monkeypatch.setattr(shared_library.tempfile, "tempdir", str(tmp_path / "missing"))
    assert "no space to compile" in refusal()
    assert "TMPDIR" in refusal()


def test_what_is_in_the_cache_and_cannot_be_loaded_is_compiled_anew(cache_folder, compiler, monkeypatch):
    """As on another machine with the same compiler, but older libraries."""
    made()
    load, calls = shared_library.gateway.load_data, []

    def once(data, otherwise=None):
        calls.append(data)
        if len(calls) == 1:
            raise OSError("version `GLIBC_9.9' not found")
        return load(data, otherwise)

    monkeypatch.setattr(shared_library.gateway, "load_data", once)
    monkeypatch.setattr(shared_library.cache, "place", lambda name, data: contextlib.nullcontext())
    made()
    assert compiler.calls == 2
