"""Codes of errors and warnings: each is explained, its example provokes it, and its message ends with it."""

import ast
import os
import pickle
import re
import subprocess
import sys
import warnings
from pathlib import Path

import pytest

import zerodrift as zd
from zerodrift.__main__ import main
from zerodrift._private import gateway
from zerodrift.explanations import classes, codes, explain, explanations

EXPLANATIONS = explanations()
CODED = tuple(classes().values())
PYTHON = {"wrong-value": ValueError, "wrong-type": TypeError, "wrong-name": KeyError, "missing-package": ImportError,
          "wrong-attribute": AttributeError, "wrong-index": IndexError, "missing-file": FileNotFoundError,
          "existing-file": FileExistsError, "file-in-use": PermissionError, "no-space": OSError,
          "needs-compiler": NotImplementedError, "no-memory": MemoryError}
WHOLE = {"inconsistent-system", "step-failed"}      # whose parts have codes of their own
WITHOUT_EXAMPLE = WHOLE | {
    "stale-core", "no-locks",       # need other sources, another file system: test_fingerprint.py, test_locking.py
    "file-in-use", "needs-compiler"}        # need Windows, or no compiler: test_sample_file.py, test_expressions.py
PROVOKED = [code for code, each in EXPLANATIONS.items() if each.snippet]


def test_every_error_and_warning_is_explained():
    assert set(codes()) == set(EXPLANATIONS)
    assert set(classes()) <= set(EXPLANATIONS)
    assert all(each.causes and each.cures for each in EXPLANATIONS.values())
    public = {each for each in vars(zd.errors).values() if isinstance(each, type) and issubclass(each, BaseException)
              and not each.__name__.startswith("_") and each is not zd.errors.WrongArgument}
    assert set(classes().values()) == public
    assert set(EXPLANATIONS) - set(PROVOKED) == WITHOUT_EXAMPLE


def test_every_failure_of_the_core_has_a_code_of_its_own():
    """Except what the interface never returns: wrong arguments, which Python refuses."""
    given = [row.code for row in gateway.base.statuses() if row.code]
    assert len(given) == len(set(given)) == len(gateway.base.statuses())
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
    whole = {classes()[code].__name__ for code in WHOLE}
    assert whole == {"InconsistentSystem", "StepFailed"}
    for path in package.rglob("*.py"):
        assert not re.search(rf"raise ({'|'.join(whole)})\(", path.read_text(encoding="utf-8")), path


# Errors that modules raise without a code, by the expression after `raise`, with the reason.
PLAIN = {
    "AttributeError": "`__getattr__` in Python's own words, which Python completes by the closest name",
    "PermissionError": "an error of the operating system with its number and words, as open() raises it",
    "KeyboardInterrupt": "Ctrl-C, passed on",
    "NotImplementedError": "a method that each class of the package defines",
    "argparse.ArgumentTypeError": "argparse prints it as one of its own",
    "type(error)": "an error of the operating system that names another path",
    **dict.fromkeys(("LookupError", "Cancelled", "Unrecorded", "Unwritten", "Varies", "_Touched"), "caught by the package"),
}
# Functions that return an error of the package, which are raised at once.
MAKERS = {"error_of", "self.error", "run.error", "_failure", "_complaint", "_beyond", "self.refusal", "self.goal.refusal",
          "with_solution", "self._error", "self._unmet", "contradiction", "advised",
          "of_code", "search.interrupted", "_wrong"}


def raised(tree):
    """Expressions after `raise`, and those alternatives that stand within one; without those of errors that are passed on."""
    for node in ast.walk(tree):
        parts = [node.exc] if isinstance(node, ast.Raise) else []
        while parts:
            each = parts.pop()
            if isinstance(each, ast.BoolOp | ast.IfExp):
                parts += each.values if isinstance(each, ast.BoolOp) else [each.body, each.orelse]
            elif isinstance(each, ast.Call) or (isinstance(each, ast.Name) and each.id[0].isupper()):
                yield each


def test_every_error_that_is_raised_has_a_code():
    """Raised are classes of the package, or what returns these; all that is left is listed with its reason."""
    package = Path(zd.__file__).parent
    trees = {path.relative_to(package).as_posix(): ast.parse(path.read_text(encoding="utf-8")) for path in package.rglob("*.py")}
    own = {each.__name__ for each in CODED}
    own |= {node.name for tree in trees.values() for node in ast.walk(tree) if isinstance(node, ast.ClassDef)
            and any(isinstance(base, ast.Name) and base.id in own for base in node.bases)}
    used = set()
    for name, tree in trees.items():
        for each in raised(tree):
            made = ast.unparse(each.func if isinstance(each, ast.Call) else each)
            used.add(made)
            assert made.removeprefix("errors.") in own | MAKERS | set(PLAIN), (name, each.lineno, made)
    assert used >= MAKERS | set(PLAIN)


def test_errors_of_arguments_have_codes_that_are_explained():
    given = set()
    for path in Path(zd.__file__).parent.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in ("WrongValue", "WrongType", "WrongName", "checks.number"):
                codes_of = node.args[1:] if "Wrong" in ast.unparse(node.func) else [
                    each.value for each in node.keywords if each.arg == "code"]
                given |= {each.value for part in codes_of for each in ast.walk(part) if isinstance(each, ast.Constant)}
    assert set(zd.errors.OF_ARGUMENTS) == given - {""}


@pytest.mark.parametrize("code", PYTHON)
def test_errors_of_python_have_a_code(code):
    error = classes()[code]("x")
    assert isinstance(error, PYTHON[code])
    assert str(error) == str(pickle.loads(pickle.dumps(error))) == f"x [zd:{code}]"


def test_an_error_of_an_argument_has_the_code_of_its_rule():
    error = zd.errors.WrongValue("p0 must have shape (2,)", "shape")
    again = pickle.loads(pickle.dumps(error))
    assert (again.code, str(again), again.args) == ("shape", "p0 must have shape (2,) [zd:shape]", ("p0 must have shape (2,)",))
    assert zd.errors.described(error) == f"ValueError: {error}"
    assert zd.errors.advised(error, "take two").code == "shape"
    assert zd.errors.WrongValue.code == "wrong-value"


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
