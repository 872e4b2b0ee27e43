"""The sum of the sources, in tokens: names, numbers, strings and operators, without comments, docstrings and line breaks.

``PYTHONPATH=tests/support python tests/test_size.py`` prints it by room. Generated files and tests are counted apart.
`CHANGELOG.md` has the ceiling.
"""

import ast
import io
import re
import subprocess
import tokenize
from collections import Counter
from pathlib import PurePath

import pytest

from support import ROOT

# Comments, which are left out; strings; names; numbers; operators of several signs; any other sign.
SIGNS = re.compile(r"""(?P<comment>/\*.*?\*/|//[^\n]*)|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'|`(?:\\.|[^`\\])*`|[A-Za-z_]\w*
    |\.?\d[\w.]*|<<=|>>=|\.\.\.|->|=>|\+\+|--|&&|\|\||[-+*/%&|^=!<>]=|<<|>>|\S""", re.DOTALL | re.VERBOSE)
LAYOUT = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT, tokenize.ENCODING,
          tokenize.ENDMARKER}
SUFFIXES = {".py", ".pyi", ".c", ".h", ".js", ".ts", ".css"}
GENERATED = re.compile(r"csrc/systems/(closed_form|series)/|\.pyi$")


def of_python(source):
    """Number of tokens of a Python file."""
    docstrings = {(node.body[0].value.lineno, node.body[0].value.col_offset) for node in ast.walk(ast.parse(source))
                  if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef)
                  and ast.get_docstring(node, clean=False) is not None}
    return sum(token.type not in LAYOUT and not (token.type == tokenize.STRING and token.start in docstrings)
               for token in tokenize.generate_tokens(io.StringIO(source).readline))


def of_signs(source):
    """Number of tokens of a file in C, JavaScript or CSS."""
    return sum(not found["comment"] for found in SIGNS.finditer(source))


def sizes():
    """Tokens by room: two folders of the core or three of the package; "tests", "generated", "notebooks"."""
    command = ["git", "ls-files", "csrc", "python", "notebooks", "tests", "setup.py"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False).stdout.split()
    if not listed:
        pytest.skip("the list of files is that of git")
    rooms = Counter()
    for name in listed:
        path = PurePath(name)
        if path.suffix not in SUFFIXES:
            continue
        room = "generated" if GENERATED.search(name) else path.parts[0] if path.parts[0] in ("tests", "notebooks") else (
            "/".join(path.parts[:-1][:3 if path.parts[0] == "python" else 2]))
        source = (ROOT / name).read_text(encoding="utf-8")
        rooms[room] += of_python(source) if path.suffix in (".py", ".pyi") else of_signs(source)
    return rooms


def shipped(rooms):
    """Tokens of what is written by hand and shipped."""
    return sum(count for room, count in rooms.items() if room not in ("tests", "generated"))


def test_tokens_are_those_of_the_languages():
    assert of_python('"""Doc."""\nx = f(1, "a b")  # more\n') == 8
    assert of_signs("/* a b */ int x = y->z + 1.5e-3; // more\n") == 11


def test_sources_stay_below_their_ceiling():
    """A sum more than a hundredth below it takes a lower ceiling, with a line that says what was taken away."""
    lines = re.findall(r"^\| ([\d,]+) \|", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)
    ceiling = int(lines[-1].replace(",", ""))
    count = shipped(sizes())
    assert 0.99 * ceiling < count <= ceiling, f"{count:,d} tokens: remove some, or add a row to the last table of CHANGELOG.md"


if __name__ == "__main__":
    for room, count in (found := sizes()).most_common():
        print(f"{count:>9,d} {room}")
    print(f"{shipped(found):>9,d} written by hand and shipped")
