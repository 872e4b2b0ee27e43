"""Code from the cache is executed, so files that another user may have written are refused, and compiled again elsewhere."""

import errno
import math
import os
import stat
import subprocess
import sys
import tempfile
import time
import warnings
from pathlib import Path

import pytest

import zerodrift as zd
from cached_system import elsewhere, made, said
from zerodrift.symbolics.compile import cache as kept
from zerodrift.symbolics.compile import shared_library

pytestmark = pytest.mark.skipif(kept.AS_WINDOWS, reason="owners and permissions are those of POSIX")
OTHER, OTHERS_GROUP = 12345, 12345
FILES = 4       # of a system: what was derived, its closed-form functions, a library and the note that it belongs to the source
needs_root = pytest.mark.skipif(kept.AS_WINDOWS or os.geteuid() != 0, reason="only root can give files away")


def mode(path):
    return stat.S_IMODE(path.stat().st_mode)


def pretending(monkeypatch, suspect, **changes):
    """The status of what `suspect` holds for is as if it had other members."""
    true = os.fstat

    def fstat(descriptor):
        status = true(descriptor)
        if not suspect(status):
            return status
        return os.stat_result([changes.get(name, getattr(status, name)) for name in
                               ("st_mode", "st_ino", "st_dev", "st_nlink", "st_uid", "st_gid", "st_size", "st_atime", "st_mtime",
                                "st_ctime")])

    monkeypatch.setattr(kept.os, "fstat", fstat)


def one_warning(function):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        function()
    assert [each.category for each in caught] == [zd.CacheWarning]
    return str(caught[0].message)


# ---- the folder ----


def test_what_is_made_is_the_users_alone_whatever_the_umask(tmp_path, cache_folder, monkeypatch):
    monkeypatch.setenv("ZERODRIFT_CACHE", str(tmp_path / "new" / "cache"))
    before = os.umask(0)
    try:
        made()
    finally:
        os.umask(before)
    assert mode(tmp_path / "new") == mode(tmp_path / "new" / "cache") == 0o700
    assert {mode(path) for path in (tmp_path / "new" / "cache").iterdir()} == {0o600}


@pytest.mark.parametrize("permissions", [0o777, 0o1777, 0o770, 0o702])
def test_a_folder_that_others_may_write_is_left_alone(cache_folder, compiler, permissions):
    made()
    files = {path: path.stat().st_mtime_ns for path in cache_folder.iterdir()}
    cache_folder.chmod(permissions)
    message = one_warning(made)
    assert f"neither taken from {cache_folder} nor kept there" in message
    assert f"`chmod go-w {cache_folder}`" in message
    assert f"others may write it (mode {permissions:04o})" in message
    assert "ZERODRIFT_CACHE" in message
    assert compiler.calls == 2
    made()      # kept in memory, and said once
    assert compiler.calls == 2
    assert {path: path.stat().st_mtime_ns for path in cache_folder.iterdir()} == files
    assert mode(cache_folder) == permissions
    cache_folder.chmod(0o755)      # as the sentence says
    kept._memory.clear()
    made()
    assert compiler.calls == 2


def test_in_the_users_own_place_permissions_are_mended(tmp_path, cache_folder, compiler, monkeypatch):
    """Earlier versions made the folder with the permissions of the umask."""
    monkeypatch.delenv("ZERODRIFT_CACHE")
    monkeypatch.setattr(kept, "_own", lambda: cache_folder)
    cache_folder.mkdir()
    cache_folder.chmod(0o775)
    made()
    assert mode(cache_folder) == 0o700
    made()
    assert compiler.calls == 1


def test_a_folder_of_another_user(cache_folder, compiler, monkeypatch):
    made()
    pretending(monkeypatch, lambda status: stat.S_ISDIR(status.st_mode), st_uid=OTHER)
    message = one_warning(made)
    assert f"neither taken from {cache_folder} nor kept there: it belongs to uid {OTHER}, not to" in message
    assert "Let ZERODRIFT_CACHE name a folder of your own" in message
    assert "chmod" not in message
    assert compiler.calls == 2


def test_files_of_another_user_are_made_anew(cache_folder, compiler, monkeypatch):
    made()
    pretending(monkeypatch, lambda status: stat.S_ISREG(status.st_mode), st_uid=OTHER)
    assert f"json in {cache_folder} is not used, but made anew: it belongs to uid {OTHER}, not to" in one_warning(made)
    assert compiler.calls == 2


@pytest.mark.parametrize("which", ["*.so", "*.json"])
def test_files_that_others_may_write_are_made_anew(cache_folder, compiler, which):
    made()
    for path in cache_folder.glob(which):
        path.chmod(0o620)
    with pytest.warns(zd.CacheWarning, match=r"not used, but made anew: it belongs to .* but others may write it \(mode 0620\)"):
        made()
    assert compiler.calls == 2
    made()
    assert compiler.calls == 2
    assert {mode(path) for path in cache_folder.iterdir()} == {0o600}


def test_what_root_has_filled_is_taken_by_others(cache_folder, compiler, monkeypatch):
    """As administrators do: a folder that all can read, whose files are then as readable."""
    cache_folder.mkdir()
    cache_folder.chmod(0o755)
    made()
    assert {mode(path) for path in cache_folder.iterdir()} == {0o644}
    pretending(monkeypatch, lambda status: True, st_uid=0)
    monkeypatch.setattr(kept.os, "geteuid", lambda: OTHER)
    monkeypatch.setattr(kept, "put", None)
    made()
    assert compiler.calls == 1


@pytest.mark.parametrize("which", ["*.so", "*.json"])
def test_links_in_the_folder_are_not_followed(tmp_path, cache_folder, compiler, which):
    made()
    for path in cache_folder.glob(which):
        path.rename(tmp_path / path.name)
        path.symlink_to(tmp_path / path.name)
    made()
    assert compiler.calls == 2
    assert not [path for path in cache_folder.iterdir() if path.is_symlink()]


def test_a_pipe_in_place_of_a_file_stops_nothing(cache_folder, compiler):
    made()
    for path in list(cache_folder.iterdir()):
        path.unlink()
        os.mkfifo(path)
    made()
    assert compiler.calls == 2
    assert all(path.is_file() for path in cache_folder.iterdir())


def test_a_link_to_a_folder_of_ones_own_is_followed(tmp_path, cache_folder, compiler, monkeypatch):
    made()
    (tmp_path / "link").symlink_to(cache_folder)
    monkeypatch.setenv("ZERODRIFT_CACHE", str(tmp_path / "link"))
    made()
    assert compiler.calls == 1


def test_a_link_that_is_changed_after_the_folder_was_looked_at(tmp_path, cache_folder, monkeypatch):
    """The folder that was opened is used, not the link's new target."""
    (tmp_path / "mine").mkdir(0o700)
    (tmp_path / "theirs").mkdir(0o777)
    link = tmp_path / "link"
    link.symlink_to(tmp_path / "mine")
    monkeypatch.setenv("ZERODRIFT_CACHE", str(link))
    kept.put("name", b"mine")
    (tmp_path / "theirs" / "name").write_bytes(b"theirs")
    with kept._usable() as folder:
        link.unlink()
        link.symlink_to(tmp_path / "theirs")
        assert folder.read("name") == b"mine"
        folder.write("name", b"also mine")
    assert (tmp_path / "theirs" / "name").read_bytes() == b"theirs"
    assert (tmp_path / "mine" / "name").read_bytes() == b"also mine"


def test_what_is_loaded_is_what_was_looked_at(tmp_path, cache_folder, monkeypatch):
    """A library that is replaced between its being read and its being loaded."""
    made()
    load = shared_library.gateway.load_data

    def replacing(data, otherwise=None):
        for path in cache_folder.glob("*.so"):
            path.write_bytes(b"not what was looked at")
        return load(data, otherwise)

    monkeypatch.setattr(shared_library.gateway, "load_data", replacing)
    monkeypatch.setattr(shared_library.gateway.compiled.functions, "_loaded", {})
    made()


def test_a_file_under_the_name_of_another_is_not_taken(cache_folder):
    kept.write("one", "content")
    (cache_folder / "one.json").rename(cache_folder / "other.json")
    assert kept.read("other", str) is None


# ---- as root ----


@needs_root
def test_what_another_user_has_planted_is_not_executed(cache_folder, tmp_path, monkeypatch):
    monkeypatch.setattr(shared_library.gateway.compiled.functions, "_loaded", {})
    made()
    planted = tmp_path / "planted"
    for path in cache_folder.glob("*.json"):
        content = kept.read(path.stem, dict)
        if "c_source" in (content or {}):
            content["c_source"] += (f'\n#include <stdio.h>\n__attribute__((constructor)) static void f(void) '
                                    f'{{ fclose(fopen("{planted}", "w")); }}\n')
            kept.write(path.stem, content)
    made()
    assert planted.exists()     # root's own is trusted
    planted.unlink()
    for path in [cache_folder, *cache_folder.iterdir()]:
        os.chown(path, OTHER, OTHERS_GROUP)
    assert f"{cache_folder} nor kept there: it belongs to uid {OTHER}" in one_warning(made)
    os.chown(cache_folder, 0, 0)
    for path in cache_folder.glob("*.so"):
        path.unlink()
    kept._memory.clear()
    with pytest.warns(zd.CacheWarning, match=f"is not used, but made anew: it belongs to uid {OTHER}"):
        made()
    assert not planted.exists()


@needs_root
def test_root_makes_no_folders_in_those_of_others(tmp_path, cache_folder, monkeypatch):
    """As with sudo that keeps HOME: they would be in their owner's way."""
    home = tmp_path / "home"
    home.mkdir()
    os.chown(home, OTHER, OTHERS_GROUP)
    monkeypatch.setenv("ZERODRIFT_CACHE", str(home / ".cache" / "zerodrift"))
    assert f"{home} belongs to uid {OTHER}, in whose folders root makes none" in one_warning(made)
    assert not list(home.iterdir())


AS_ANOTHER = f"""
import os, pwd, tempfile
import sympy.physics.mechanics, zerodrift.symbolics.define as define, zerodrift.symbolics.compile.shared_library as shared_library
define.fingerprint(dict(read=sympy.S.One))      # reads the package's sources, which the other user may not
os.setgroups([]), os.setgid({OTHERS_GROUP}), os.setuid({OTHER})
if not os.access(shared_library.get_include() + "/zerodrift/system.h", os.R_OK):
    print("nan")
    raise SystemExit
"""


@needs_root
def test_a_user_takes_what_root_has_filled_and_root_nothing_of_the_users(cache_folder):
    """By a process that becomes another user, to whom the folder is read-only; then by root from that user's own folder."""
    with tempfile.TemporaryDirectory() as folder:
        filled, own = Path(folder) / "filled", Path(folder) / "own"
        for path in (Path(folder), filled, own):
            path.mkdir(exist_ok=True)
            path.chmod(0o755)
        os.chown(own, OTHER, OTHERS_GROUP)
        said(elsewhere({"ZERODRIFT_CACHE": str(filled)}))
        files = {path: path.stat().st_mtime_ns for path in filled.iterdir()}
        if math.isnan(said(elsewhere({"ZERODRIFT_CACHE": str(filled)}, before=AS_ANOTHER))):
            pytest.skip("another user cannot read the package here")
        assert {path: path.stat().st_mtime_ns for path in filled.iterdir()} == files
        said(elsewhere({"ZERODRIFT_CACHE": str(own)}, before=AS_ANOTHER))
        files = {path: path.stat().st_mtime_ns for path in own.iterdir()}
        assert len(files) == FILES
        process = elsewhere({"ZERODRIFT_CACHE": str(own)})
        assert f"CacheWarning: compiled systems are neither taken from {own} nor kept there" in process.communicate()[1]
        assert {path: path.stat().st_mtime_ns for path in own.iterdir()} == files


# ---- without a place ----


def test_the_current_folder(tmp_path, cache_folder, monkeypatch):
    (tmp_path / "here").mkdir(0o700)
    monkeypatch.chdir(tmp_path / "here")
    monkeypatch.setenv("ZERODRIFT_CACHE", ".")
    made()
    assert len(list((tmp_path / "here").iterdir())) == FILES


def test_permissions_that_cannot_be_mended(cache_folder, monkeypatch):
    """As on a file system that is read-only."""
    def refusing(descriptor, mode):
        raise OSError(errno.EROFS, "Read-only file system")

    monkeypatch.delenv("ZERODRIFT_CACHE")
    monkeypatch.setattr(kept, "_own", lambda: cache_folder)
    monkeypatch.setattr(kept.os, "fchmod", refusing)
    cache_folder.mkdir()
    cache_folder.chmod(0o775)
    assert f"neither taken from {cache_folder} nor kept there" in one_warning(made)


def test_without_a_home_folder(tmp_path, cache_folder, monkeypatch):
    monkeypatch.delenv("ZERODRIFT_CACHE")
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.setattr(kept.os.path, "expanduser", lambda path: path)      # what it does for users that the system does not know
    monkeypatch.chdir(tmp_path)
    assert "home folder of ~/" in one_warning(made)
    assert not (tmp_path / "~").exists()


@pytest.mark.skipif(not kept.AS_WINDOWS and os.geteuid() == 0, reason="root can read and write everywhere")
@pytest.mark.parametrize("permissions", [0o500, 0o000])
def test_a_folder_without_permissions(cache_folder, permissions):
    cache_folder.mkdir(permissions)
    try:
        assert f"{cache_folder} cannot be written (Permission denied). Give it space and" in one_warning(made)
    finally:
        cache_folder.chmod(0o700)


# ---- leftovers ----


def test_a_full_disk_leaves_nothing(cache_folder, compiler):
    resource = pytest.importorskip("resource")
    limit = resource.getrlimit(resource.RLIMIT_FSIZE)
    kept.put("before", b"1")
    resource.setrlimit(resource.RLIMIT_FSIZE, (10, limit[1]))
    try:
        message = one_warning(lambda: kept.put("large", bytes(1000)))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limit)
    assert f"compiled systems are not kept: {cache_folder} cannot be written (File too large)" in message
    assert [path.name for path in cache_folder.iterdir()] == ["before"]
    assert kept.get("large") == bytes(1000)


def test_temporary_files_of_killed_processes_are_removed_and_no_others(cache_folder):
    kept.put("before", b"1")
    killed = subprocess.run([sys.executable, "-c", "import os, zerodrift.symbolics.compile.cache as kept\n"
                             "kept.os.replace = lambda *a, **k: os.kill(os.getpid(), 9)\nkept.put('half', b'2')"], check=False)
    assert killed.returncode == -9
    (left,) = cache_folder.glob(".zerodrift-*.tmp")
    (cache_folder / "tmpabcdefgh").write_text("somebody's")
    kept.put("live", b"3")
    assert left.exists()        # it may be that of a process that is writing
    for path in cache_folder.iterdir():
        os.utime(path, (time.time() - 2 * kept.OLD,) * 2)
    kept.put("after", b"4")
    assert sorted(path.name for path in cache_folder.iterdir()) == ["after", "before", "live", "tmpabcdefgh"]
