"""The command line, `python -m zerodrift`: what it refuses, in words that name what is wrong."""

import os
import re
import subprocess
import sys

import matplotlib
import pytest

from zerodrift.__main__ import main

matplotlib.use("Agg")


def test_a_folder_that_cannot_be_written_is_named(tmp_path, capsys):
    (tmp_path / "file").write_text("in the way")
    assert main(["reproduce", "--out", str(tmp_path / "file")]) == 1
    assert main(["reproduce", "--out", str(tmp_path / "file" / "below")]) == 1
    assert f"cannot write to {tmp_path / 'file'}" in capsys.readouterr().err


@pytest.mark.parametrize("arguments", [["draw"], ["reproduce", "here"]])
def test_the_command_explains_itself(arguments):
    run = subprocess.run([sys.executable, "-m", "zerodrift", *arguments], capture_output=True, text=True, check=False)
    assert run.returncode == 2
    assert "usage: python -m zerodrift" in run.stderr


def test_without_a_command_each_has_a_line_and_an_example():
    run = subprocess.run([sys.executable, "-m", "zerodrift"], capture_output=True, text=True, check=True,
                         env=os.environ | {"COLUMNS": "80"})
    for name in ("reproduce", "gallery", "explain"):
        assert re.search(rf"^ +{name} +[A-Z].+$", run.stdout, re.MULTILINE)
        assert f"\n  python -m zerodrift {name} " in run.stdout
    assert len(run.stdout.splitlines()) < 22


@pytest.mark.parametrize("folder", ["", "  ", "a\0b"], ids=["empty", "blank", "null"])
def test_folders_that_are_none(folder, capsys):
    with pytest.raises(SystemExit) as end:
        main(["reproduce", "--out", folder])
    assert end.value.code == 2
    assert "--out" in capsys.readouterr().err


def test_a_backend_that_is_none(tmp_path):
    done = subprocess.run([sys.executable, "-m", "zerodrift", "reproduce", "--out", str(tmp_path)], capture_output=True,
                          text=True, env=os.environ | {"MPLBACKEND": "nonsense"})
    assert done.returncode == 1
    assert "MPLBACKEND" in done.stderr
    assert "Traceback" not in done.stderr
