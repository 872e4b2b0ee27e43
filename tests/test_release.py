"""The version is that of the package; the change log, in the format of Keep a Changelog, has the notes of a release."""

import re
import runpy
import shutil
import subprocess
import sys
import tomllib

import pytest

import zerodrift as zd
from support import ROOT

RELEASE = runpy.run_path(str(ROOT / ".ci" / "release"))
KINDS = ["Added", "Changed", "Deprecated", "Removed", "Fixed", "Security"]


def test_the_version_is_that_of_the_package():
    assert set(RELEASE["versions"]().values()) == {zd.__version__}
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert project["project"]["dynamic"] == ["version"]
    assert project["tool"]["setuptools"]["dynamic"]["version"] == {"attr": "zerodrift.__version__"}


def test_the_change_log_has_versions_and_kinds_of_changes_in_order():
    found = RELEASE["sections"]()
    assert next(iter(found)) == "Unreleased"
    assert [version for version, (date, _) in found.items() if not date] == ["Unreleased"]
    for _, notes in found.values():
        kinds = re.findall(r"^### (.+)$", notes, re.MULTILINE)
        assert kinds == [kind for kind in KINDS if kind in kinds]
        assert "tokens" not in notes


@pytest.fixture
def tagged(tmp_path):
    """A tree in which the version is dated, and the command that prints its notes for a tag."""
    for name in (".ci/release", "python/zerodrift/__init__.py", "CITATION.cff", "CHANGELOG.md"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    log = tmp_path / "CHANGELOG.md"
    log.write_text(log.read_text(encoding="utf-8").replace(
        "## [Unreleased]\n", f"## [Unreleased]\n\n## [{zd.__version__}] - 2027-01-31\n", 1), encoding="utf-8")
    return lambda tag: subprocess.run([sys.executable, tmp_path / ".ci" / "release", tag], capture_output=True, text=True)


def test_notes_of_a_release_are_those_of_its_version(tagged):
    done = tagged(f"v{zd.__version__}")
    assert done.returncode == 0
    assert done.stdout.startswith("### ")
    assert "## [" not in done.stdout
    assert "tokens" not in done.stdout


def test_a_tag_that_is_not_the_version_is_refused(tagged):
    done = tagged("v9.9.9")
    assert done.returncode == 1
    for name in ("__init__.py", "CITATION.cff", "CHANGELOG.md"):
        assert f"{name}: {zd.__version__}" in done.stderr
