"""Texts of the project: docstrings, descriptions, comments, messages and pages, each with the place where it stands."""

import ast
import json
import re
from dataclasses import dataclass
from pathlib import Path

from support import ROOT

PYTHON, C, PAGES = "python/zerodrift", "csrc", "notebooks"
MADE = {"__pycache__", "generated"}      # folders that git does not hold
DESCRIBED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)

# In Python: a comment, or a string, which may contain the sign of one. Python's own tokens take ten times as long.
COMMENT_OR_STRING = re.compile(r'(\#[^\n]*)|"""(?:\\.|[^\\])*?"""|' r"'''(?:\\.|[^\\])*?'''|"
                               r'"(?:\\.|[^"\\\n])*"|' r"'(?:\\.|[^'\\\n])*'", re.DOTALL)
ENTRY = re.compile(r"^\S.*\n((?: {4}.*(?:\n|$))+)", re.MULTILINE)       # of a section of a docstring: its description


@dataclass(frozen=True)
class Text:
    """A text of the project."""

    file: str
    line: int
    kind: str       # docstring, description, comment, message, page or test name
    owner: str      # the function or class that is documented, the exception that a message belongs to, or ""
    text: str

    def __str__(self):
        return f"{self.file}:{self.line}: {self.kind} {self.owner}: {' '.join(self.text.split())[:200]}"


def python_texts(path):
    """Docstrings, the entries of their sections, other sentences, comments and messages of a Python file."""
    source, file = path.read_text(encoding="utf-8"), str(path.relative_to(ROOT))
    docstrings = set()
    for node in ast.walk(ast.parse(source)):
        if str(getattr(node, "name", "")).startswith("test_"):
            yield Text(file, node.lineno, "test name", node.name, node.name.replace("_", " "))
        if isinstance(node, DESCRIBED) and (found := ast.get_docstring(node)):
            where = file, getattr(node, "lineno", 1)
            docstrings.add(ast.get_docstring(node, clean=False))
            yield Text(*where, "docstring", getattr(node, "name", ""), found)
            yield from (Text(*where, "description", getattr(node, "name", ""), each) for each in ENTRY.findall(found))
        if isinstance(node, ast.Constant) and node.value not in docstrings and re.match("[A-Z][a-z]* ", str(node.value)):
            yield Text(file, node.lineno, "description", "", node.value)
        if isinstance(node, ast.Call) and (name := _exception(node.func)):
            for found in filter(None, map(_message, node.args[:2])):
                yield Text(file, node.lineno, "message", name, found)
    line, end = 1, 0
    for token in COMMENT_OR_STRING.finditer(source):
        if token[1]:
            line, end = line + source.count("\n", end, token.start()), token.start()
            yield Text(file, line, "comment", "", token[1].lstrip("# ").rstrip("\r"))


def _exception(function):
    name = getattr(function, "id", getattr(function, "attr", ""))
    return name if re.search(r"(Error|Warning|^warn)$", name) else ""


def _message(node):
    """The text of a string or an f-string; values stand as {}."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return node.value
    if isinstance(node, ast.JoinedStr):
        return "".join(part.value if isinstance(part, ast.Constant) else "{}" for part in node.values)
    if isinstance(node, ast.BinOp):
        return (_message(node.left) or "") + (_message(node.right) or "")
    return None


def c_texts(path):
    """Comments and strings with a blank of a C file, in the order in which they stand."""
    source, file = path.read_text(encoding="utf-8"), str(path.relative_to(ROOT))
    for found in re.finditer(r"/\*(.*?)\*/|//([^\n]*)|\"((?:[^\"\\\n]|\\.)*)\"", source, re.DOTALL):
        comment, line = found[1] or found[2], source.count("\n", 0, found.start()) + 1
        if comment:
            yield Text(file, line, "comment", "", re.sub(r"\n\s*\*", "\n", comment).strip())
        elif found[3] and " " in found[3]:
            yield Text(file, line, "description" if found[3][0].isupper() else "message", "", found[3])


def page_texts(path):
    """Paragraphs of a page, or cells of a notebook that are text."""
    file = str(path.relative_to(ROOT))
    if path.suffix == ".ipynb":
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        for k, cell in enumerate(cells):
            if cell["cell_type"] == "markdown":
                yield Text(file, k, "page", "", "".join(cell["source"]))
        return
    line = 1
    for paragraph in path.read_text(encoding="utf-8").split("\n\n"):
        yield Text(file, line, "page", "", paragraph)
        line += paragraph.count("\n") + 2


READERS = {".py": python_texts, ".c": c_texts, ".h": c_texts, ".md": page_texts, ".ipynb": page_texts}


def texts(*places):
    """Texts of files and folders, sorted by file."""
    for place in places:
        path = ROOT / place
        for file in [path] if path.is_file() else sorted(path.rglob("*")):
            if file.suffix in READERS and not MADE.intersection(file.parts):
                yield from READERS[file.suffix](Path(file))


# Comments and strings of C and JavaScript.
OF_C = re.compile(r"""/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*'""", re.DOTALL)
OUTSIDE_CODE = {".py": COMMENT_OR_STRING, ".c": OF_C, ".h": OF_C, ".js": OF_C}


def code_files(place):
    """Source files in a folder, as paths from the root."""
    return [file.relative_to(ROOT) for file in sorted((ROOT / place).rglob("*"))
            if file.suffix in OUTSIDE_CODE and not MADE.intersection(file.parts)]


def identifiers(file):
    """The set of words in the code of a source file."""
    source = (ROOT / file).read_text(encoding="utf-8")
    return set(re.findall(r"[A-Za-z_]\w*", OUTSIDE_CODE[file.suffix].sub(" ", source)))
