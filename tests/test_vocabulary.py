"""The vocabulary of the project's texts: `notebooks/glossary.md` names the terms, this the phrases that are refused.

``python tests/test_vocabulary.py [file or folder ...]`` lists what is refused there.
"""

import re
import sys

import pytest

from vocabulary import PAGES, PYTHON, C, texts

PLACES = (PYTHON, C, PAGES, "README.md", "tests")
GLOSSARY = "notebooks/glossary.md"      # it names the older words
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
    """The reasons for which a text is refused, each with the words that are."""
    words = " ".join(text.text.split())
    found = [match[0] for phrase in REFUSED if (match := re.search(phrase, words, re.IGNORECASE))]
    if (text.kind == "docstring" or (text.kind == "comment" and text.file.startswith(C))) and (match := OPENING.match(words)):
        found.append(f"opens with {match[0]!r}")
    return found


def violations(given):
    """Texts that are refused, with the reason first."""
    return [f"{', '.join(found)}: {each}" for each in given
            if each.file not in (GLOSSARY, "tests/test_vocabulary.py") and (found := refused(each))]


@pytest.mark.parametrize("place", PLACES)
def test_texts_are_in_words_of_the_field(place):
    found = list(texts(place))
    assert len(found) > 20
    assert not violations(found)


if __name__ == "__main__":
    listed = violations(texts(*(sys.argv[1:] or PLACES)))
    print(*listed, f"{len(listed)} texts", sep="\n")
