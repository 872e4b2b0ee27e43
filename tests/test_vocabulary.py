"""The vocabulary of the project's texts: `notebooks/theory/glossary.md` names the terms, this the phrases that are refused.
Identifiers that were replaced stand in `older_identifiers.csv`: * for any end of a name, and the files in which a short word
is refused.

``PYTHONPATH=tests/support python tests/test_vocabulary.py [file or folder ...]`` lists what is refused there.
"""

import csv
import fnmatch
import re
import subprocess
import sys

import pytest

from support import ROOT
from vocabulary import PAGES, PYTHON, C, code_files, identifiers, texts

PLACES = (PYTHON, C, PAGES, "README.md", "tests")
REFUSED = (
    "general road", "direct road", r"(?<!\ba )(?<!\ba ``)\broads?\b", "rows that count",
    r"what is left of a", "natural units", "somebody",
    "nobody",
    r"\b(is|are|was|were|be|been) told",
    r"(?<!there )\b(is|are|was|were) no\b(?! (longer|more|less|slower|faster|larger|smaller|later))",
    r"\bbut for\b", r"\bfollows? from others", "chosen steps", "steps are chosen", r"\bsaved rows?\b", r"\blight parts?\b",
    "lengths win", "need no word", r"\b(is|are|was|were) asked\b", r"\bglances?\b", "lookout", r"\bblame", r"\bgauges?\b",
)
OPENING = re.compile(r"(What|Whether|Where|How|Those|Of)\b(?! freedom)", re.IGNORECASE)


def refused(text):
    """The reasons for which a text is refused, each with the words that are. Pages and test names may open with a question."""
    words = " ".join(text.text.split())
    found = [match[0] for phrase in REFUSED if (match := re.search(phrase, words, re.IGNORECASE))]
    opens = text.kind in ("docstring", "description") or (text.kind == "comment" and text.file.startswith(C))
    if opens and (match := OPENING.match(words)):
        found.append(f"opens with {match[0]!r}")
    return found


def violations(given):
    """Texts that are refused, with the reason first."""
    return [f"{', '.join(found)}: {each}" for each in given
            if each.file != "tests/test_vocabulary.py" and (found := refused(each))]


@pytest.mark.parametrize("place", PLACES)
def test_texts_are_in_words_of_the_field(place):
    found = list(texts(place))
    assert len(found) > 20
    assert not violations(found)


with (ROOT / "tests" / "older_identifiers.csv").open(encoding="utf-8", newline="") as replaced:
    OLDER = [(row["old"], row["new"], row["files"].split()) for row in csv.DictReader(replaced)]


@pytest.mark.parametrize("place", ["csrc", PYTHON, "tests"])
def test_identifiers_are_in_words_of_the_field(place):
    older = []
    for file in code_files(place):
        if file.is_relative_to("csrc/include"):     # the source of others: changed with the next version of the interface
            continue
        words = identifiers(file)
        older += [f"{file}: {old} is {new} now" for old, new, files in OLDER
                  if (fnmatch.filter(words, old) if "*" in old else old in words)
                  and (not files or any(fnmatch.fnmatch(file.as_posix(), each) for each in files))]
    assert not older


# Files of other projects, of a run, of the site's build, and of the history of the drawn texts.
NAMED = re.compile(r"(?<![\w./<>*{}\"-])((?:[\w-]+/)*[a-z][\w-]*\.(?:c|h|py|md|csv|ipynb|js))\b(?![.\w*(])")
ELSEWHERE = re.compile(r"heyoka\.py|data\.h|dop853_table\.h|generated/.*")


def test_files_that_texts_name_exist():
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False)
    parts = [file.split("/") for file in listed.stdout.split()] or [
        file.relative_to(ROOT).parts for place in PLACES for file in (ROOT / place).rglob("*")]
    ends = {"/".join(each[k:]) for each in parts for k in range(len(each))}
    missing = [f"{name}: {text}" for text in texts(*PLACES)
               if text.kind not in ("message", "description") and "forty_texts" not in text.file
               for name in NAMED.findall(text.text) if name not in ends and not ELSEWHERE.fullmatch(name)]
    assert not missing


if __name__ == "__main__":
    listed = violations(texts(*(sys.argv[1:] or PLACES)))
    print(*listed, f"{len(listed)} texts", sep="\n")
