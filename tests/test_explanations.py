"""Codes of errors and warnings: each is explained, its example provokes it, and its message ends with it."""

import os
import pickle
import re
import subprocess
import sys
import warnings
from pathlib import Path

import pytest

import zerodrift as zd
from zerodrift import _gateway
from zerodrift.__main__ import main
from zerodrift.explanations import classes, codes, explain, explanations

EXPLANATIONS = explanations()
CODED = tuple(classes().values())
PYTHON = {"wrong-value": ValueError, "wrong-type": TypeError, "wrong-name": KeyError, "missing-package": ImportError,
          "no-memory": MemoryError}
WITHOUT_EXAMPLE = {"inconsistent-system", "step-failed",      # whose parts have codes of their own
                   "stale-core", "no-locks"}      # need other sources, another file system: test_fingerprint.py, test_locking.py
PROVOKED = [code for code, each in EXPLANATIONS.items() if each.snippet]


def test_every_error_and_warning_is_explained():
    assert set(codes()) == set(EXPLANATIONS)
    assert set(classes()) <= set(EXPLANATIONS)
    assert all(each.causes and each.cures for each in EXPLANATIONS.values())
    public = {each for each in vars(zd.errors).values() if isinstance(each, type) and issubclass(each, BaseException)
              and not each.__name__.startswith("_")}
    assert set(classes().values()) == public
    assert set(EXPLANATIONS) - set(PROVOKED) == WITHOUT_EXAMPLE


def test_every_failure_of_the_core_has_a_code_of_its_own():
    """Except what the interface never returns: wrong arguments, which Python refuses."""
    given = [row.code for row in _gateway.base.statuses() if row.code]
    assert len(given) == len(set(given)) == len(_gateway.base.statuses())
    assert set(given) <= set(EXPLANATIONS)
    assert set(zd.errors.OF_STATUS.values()) <= set(given)


@pytest.mark.parametrize("code", PROVOKED)
def test_the_example_provokes_it(code, monkeypatch):
    """Examples that change the environment do so for themselves alone."""
    for module in ("tqdm", "tqdm.auto"):
        monkeypatch.delitem(sys.modules, module, raising=False)
    if "sympy" in EXPLANATIONS[code].snippet:
        pytest.importorskip("sympy")
    monkeypatch.setenv("CC", "cc")
    monkeypatch.setenv("ZERODRIFT_CACHE", os.environ["ZERODRIFT_CACHE"])
    lines = compile(EXPLANATIONS[code].snippet, code, "exec")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if issubclass(codes()[code][0], Warning):
            warnings.simplefilter("error", codes()[code][0])
        with pytest.raises(CODED) as caught:
            exec(lines, {"zd": zd})
    assert caught.value.code == code
    assert re.search(r"\S \[zd:[a-z-]+\]$", str(caught.value))[0].endswith(f"[zd:{code}]")
    assert str(caught.value).count("[zd:") == 1


@pytest.mark.parametrize("code", codes())
def test_codes_are_short_words(code):
    assert re.fullmatch(r"[a-z]+(-[a-z]+){0,2}", code)
    assert explain(code).startswith(f"{code} ({codes()[code][0].__name__})")
    assert explain(f"[zd:{code}]") == explain(code)


def test_a_message_within_another_has_no_code():
    error = zd.BranchJump("sentence")
    assert zd.errors.sentence(error) == "sentence"
    assert zd.errors.sentence(ValueError("x")) == "x"
    assert str(pickle.loads(pickle.dumps(error))) == str(error) == "sentence [zd:branch-jump]"


def test_parts_of_an_error_have_codes_of_their_own():
    """So that no message ends with the code of the whole."""
    package = Path(zd.__file__).parent
    whole = {classes()[code].__name__ for code in WITHOUT_EXAMPLE - {"stale-core", "no-locks"}}
    assert whole == {"InconsistentSystem", "StepFailed"}
    for path in package.rglob("*.py"):
        assert not re.search(rf"raise ({'|'.join(whole)})\(", path.read_text(encoding="utf-8")), path


def test_errors_of_python_have_a_code():
    """Modules raise errors that are Python's own, too: `error.code` is there, and the end of the message."""
    package = Path(zd.__file__).parent
    plain = re.compile(r"\b(raise|return) (ValueError|TypeError|MemoryError|KeyError)\(|raise ImportError\((?!f\"{error})")
    found = {path.relative_to(package).as_posix(): path.read_text(encoding="utf-8") for path in package.rglob("*.py")}
    assert [name for name, source in found.items() if plain.search(source)] == []
    for code, kind in PYTHON.items():
        error = classes()[code]("x")
        assert isinstance(error, kind)
        assert str(error) == str(pickle.loads(pickle.dumps(error))) == f"x [zd:{code}]"
    assert zd.errors.described(zd.errors.WrongValue("x")) == "ValueError: x [zd:wrong-value]"


def test_the_command_explains(capsys):
    assert main(["explain", "branch-jump"]) == 0
    assert "Take shorter steps" in capsys.readouterr().out
    assert main(["explain"]) == 0
    assert set(codes()) == {line.split()[0] for line in capsys.readouterr().out.splitlines()}
    assert main(["explain", "branch-jmp"]) == 2
    assert "branch-jump" in capsys.readouterr().err


def test_the_command_needs_no_matplotlib():
    code = ("import sys; from zerodrift.__main__ import main; main(['explain', 'diverged']); "
            "assert 'matplotlib' not in sys.modules")
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
