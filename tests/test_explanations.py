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
ARGUMENTS = (zd.errors.WrongValue, zd.errors.WrongType, zd.errors.WrongName)       # whose messages end without a code
WITHOUT_EXAMPLE = {"inconsistent-system", "step-failed",      # whose parts have codes of their own
                   "stale-core"}                              # needs sources that are newer than the core
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
    """Except what the interface never returns: wrong arguments, which Python refuses, and a lack of memory."""
    given = [row.code for row in _gateway.base.statuses() if row.code]
    assert len(given) == len(set(given)) == len(_gateway.base.statuses()) - 1       # MemoryError is one of Python
    assert set(given) <= set(EXPLANATIONS)
    assert set(zd.errors.OF_STATUS.values()) <= set(given)


@pytest.mark.parametrize("code", PROVOKED)
def test_the_example_provokes_it(code, monkeypatch):
    """Examples that change the environment do so for themselves alone."""
    if "sympy" in EXPLANATIONS[code].snippet:
        pytest.importorskip("sympy")
    monkeypatch.setenv("CC", "cc")
    monkeypatch.setenv("ZERODRIFT_CACHE", os.environ["ZERODRIFT_CACHE"])
    lines = compile(EXPLANATIONS[code].snippet, code, "exec")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        if issubclass(codes()[code][0], Warning):
            warnings.simplefilter("error", codes()[code][0])
        with pytest.raises((zd.ZerodriftError, zd.Interrupted, Warning, *ARGUMENTS)) as caught:
            exec(lines, {"zd": zd})
    assert caught.value.code == code
    assert str(caught.value).endswith(f" [zd:{code}]") != isinstance(caught.value, ARGUMENTS)


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


def test_arguments_are_refused_with_a_code():
    """Modules raise these instead of Python's own, so that `error.code` is there; a few may be younger than the last sweep."""
    package = Path(zd.__file__).parent
    plain = re.compile(r"\b(raise|return) (ValueError|TypeError)\(|\braise KeyError\(f")
    sources = {path.relative_to(package).as_posix(): path.read_text(encoding="utf-8") for path in package.rglob("*.py")}
    found = [name for name, source in sources.items() for _ in plain.finditer(source)]
    assert len(found) < 20, found
    for kind, error in zip((ValueError, TypeError, KeyError), ARGUMENTS, strict=True):
        assert issubclass(error, kind)
        assert zd.errors.described(error("x")) == f"{kind.__name__}: {error('x')}"
        assert str(pickle.loads(pickle.dumps(error("x")))) == str(kind("x"))


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
