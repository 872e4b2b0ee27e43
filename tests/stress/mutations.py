"""Mutations of the core: does the suite, which runs pairs instead of products of independent axes, notice each of them?

    python tests/stress/mutations.py FOLDER [COUNT]     writes tests/bench/results/mutations.csv; CC="ccache gcc" makes it shorter

Operators of random lines of csrc are changed one at a time (SEED) in a copy of the sources below FOLDER, a new one. The
copy is built and tested until the first failure, by the tests of the changed room first. A test that fails is run without the
mutation as well, and left out if it fails then, too. A mutation that these tests do not notice is tested by all tests that
have been thinned, with the whole products (ZERODRIFT_PRODUCTS=1): if these do not notice it either, no thinning has lost it.
If they do, the same tests run with pairs, and then all others.

The script ends after COUNT mutations that are noticed, and exits with the number of those that only the products notice.
Mutations that neither the tests of the room nor the products notice are listed, but not counted: many of them change nothing
that can be observed, such as the order of equal candidates. What an earlier run has found is not tested again.
"""

import ast
import csv
import os
import random
import re
import resource
import shutil
import signal
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
RESULTS = ROOT / "tests" / "bench" / "results" / "mutations.csv"
SEED, COUNT = 2002, 20
CPU_TIME = 1500     # s: a mutation may make a loop endless, which is noticed
KEPT = shutil.ignore_patterns(".git", "build", "*.egg-info", "__pycache__", ".pytest_cache", ".hypothesis", ".venv")
OPERATORS = {" + ": " - ", " - ": " + ", " * ": " / ", " / ": " * ", " < ": " <= ", " <= ": " < ", " > ": " >= ", " >= ": " > ",
             " == ": " != ", " != ": " == ", " && ": " || ", " || ": " && ", " += ": " -= ", " -= ": " += ", "0.5": "0.25",
             " ? 1 : 0": " ? 0 : 1", "return 0;": "return 1;", "fabs(": "(", "fmax(": "fmin(", "fmin(": "fmax("}
PATTERN = re.compile("|".join(map(re.escape, sorted(OPERATORS, key=len, reverse=True))))
NO_CODE = re.compile(r'/\*.*?\*/|//[^\n]*|"(?:[^"\\\n]|\\.)*"|^[ \t]*#[^\n]*(?:\\\n[^\n]*)*', re.DOTALL | re.MULTILINE)
THINNED = re.compile(r"mark\.pairs|mark\.each_value|\bspread\(|\bdraws\(|\bfew_places\b")     # see conftest.py
TABLES = {"system", "formulation", "integrator"}    # arguments of a test that make it one, too
HEADER = ("place", "line", "change", "noticed with pairs by", "noticed with products by")
# About other things: notebooks, documentation, sources, peers, files and interruptions; test_core.py compiles the core again.
LEFT_OUT = ("test_notebooks.py", "test_documentation.py", "test_vocabulary.py", "test_structure.py", "test_structure_of_core.py",
            "test_peers.py", "test_site.py", "test_core.py", "test_cache.py", "test_cache_trust.py", "test_keyboard.py",
            "test_benchmarks.py", "test_exceptions.py", "test_sample_file.py", "test_bench.py")


def sites():
    """All places where an operator of the core can be changed: (file, position, operator)."""
    for path in sorted((ROOT / "csrc").rglob("*.c")):
        if path.parent == ROOT / "csrc" / "systems" / "closed_form":     # generated: a test compares their text
            continue
        code = NO_CODE.sub(lambda match: re.sub(r"[^\n]", "\0", match[0]), path.read_text(encoding="utf-8"))
        for match in PATTERN.finditer(code):
            yield path.relative_to(ROOT), match.start(), match[0]


def mutate(folder, file, position, operator):
    """Change an operator in the copy; return a description of the change."""
    text = (ROOT / file).read_text(encoding="utf-8")
    (folder / file).write_text(text[:position] + OPERATORS[operator] + text[position + len(operator):], encoding="utf-8")
    line = text.count("\n", 0, position)
    change = f"{operator.strip()} -> {OPERATORS[operator].strip()}"
    return f"{file.as_posix()}:{line + 1}", text.splitlines()[line].strip(), change


def build(folder):
    """Build the core of the copy; True if it compiles."""
    return subprocess.run([sys.executable, "setup.py", "-q", "build_ext", "--inplace"], cwd=folder, capture_output=True,
                          check=False).returncode == 0


def paths_of_tests():
    """All files of tests of the core, relative to the sources."""
    paths = [path for path in sorted((ROOT / "tests").rglob("test_*.py")) if path.name not in LEFT_OUT]
    return [path.relative_to(ROOT).as_posix() for path in paths]


def near(file):
    """The test files that are likely to notice a change of this file, those of its room first."""
    room = file.parts[1]
    first = (f"tests/{room}", "tests/test_registry.py", *(f"tests/{name}" for name in
             ("corrections", "formulations", "integrators", "motion", "safeguards/test_guard.py", "runs/test_runs.py")))
    files = [path for path in paths_of_tests() if path.startswith(first)]
    return sorted(files, key=lambda path: not path.startswith(f"tests/{room}"))


def thinned(path):
    """The tests of a file that run for fewer cases than with ZERODRIFT_PRODUCTS=1, as arguments of pytest."""
    text = (ROOT / path).read_text(encoding="utf-8")
    body = ast.parse(text).body
    constants = [target.id for node in body if isinstance(node, ast.Assign) and THINNED.search(ast.unparse(node))
                 for target in node.targets if isinstance(target, ast.Name)]
    marks = re.compile("|".join([THINNED.pattern, *(rf"\b{name}\b" for name in constants)]))
    tests = [node for node in body if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")]
    return [f"{path}::{test.name}" for test in tests
            if marks.search(ast.unparse(test)) or {argument.arg for argument in test.args.args} >= TABLES]


def first_failure(folder, files, left_out, environment):
    """The first test that fails; "" if all pass."""
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-n0", "-p", "no:cacheprovider", "--no-header",
               *(f"--deselect={test}" for test in left_out), *files]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False,
                          env=os.environ | {"PYTHONPATH": str(folder / "python")} | environment,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (CPU_TIME, CPU_TIME)))
    if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
        return f"no end within {CPU_TIME} s"
    if done.returncode == 0:
        return ""
    found = re.search(r"^(?:FAILED|ERROR) (.+?)(?: - |$)", done.stdout, re.MULTILINE)     # names of tests have spaces
    return found[1] if found else f"exit status {done.returncode}"


def noticed_by(folder, files, failing, **environment):
    """The first test that fails with the mutation only; "" if there is none. `failing` has those that fail without it."""
    while test := first_failure(folder / "mutated", files, failing, environment):
        if "::" not in test or first_failure(folder / "original", [test], (), environment) != test:
            return test
        failing.append(test)
    return ""


def tested(folder, file, failing):
    """The test that notices the change with pairs, or else that with the products, where none does with pairs."""
    if test := noticed_by(folder, near(file), failing):
        return test, ""
    tests = [test for path in paths_of_tests() for test in thinned(path)]
    if not (of_products := noticed_by(folder, tests, failing, ZERODRIFT_PRODUCTS="1")):
        return "", ""
    same = of_products.partition("[")[0]
    for others in ([same] if "::" in same else [], tests, paths_of_tests()):
        if others and (test := noticed_by(folder, others, failing)):
            return test, ""
    return "", of_products


def earlier():
    """Lines of the results of an earlier run."""
    if not RESULTS.exists():
        return []
    with RESULTS.open(newline="", encoding="utf-8") as file:
        return list(csv.reader(file))[1:]


def main(folder, count):
    """Draw, test, list."""
    mutated = folder / "mutated"
    for copy in (folder / "original", mutated):
        shutil.copytree(ROOT, copy, ignore=KEPT)
        if not build(copy):
            sys.exit("the core does not compile without a mutation")
    drawn = sorted(sites())
    random.Random(SEED).shuffle(drawn)
    known = {tuple(row[:3]): tuple(row) for row in earlier()}
    rows, failing = [], []
    for file, position, operator in drawn:
        if sum(bool(row[3] or row[4]) for row in rows) == count:
            break
        change = mutate(mutated, file, position, operator)
        if change in known or build(mutated):
            rows.append(known.get(change) or (*change, *tested(folder, file, failing)))
            print(*rows[-1], sep=" | ", flush=True)
            with RESULTS.open("w", newline="", encoding="utf-8") as out:
                csv.writer(out).writerows([HEADER, *rows])
        shutil.copy(ROOT / file, mutated / file)
    print("left out, as they fail without a mutation:", *failing or ["none"])
    return sum(bool(row[4]) for row in rows)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve(), int(sys.argv[2]) if len(sys.argv) > 2 else COUNT))
