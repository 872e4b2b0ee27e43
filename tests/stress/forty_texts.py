"""Forty texts drawn at random: is each understood from its words alone?

    PYTHONPATH=python:tests python tests/stress/forty_texts.py

Docstrings, comments and messages of the package and of the core are drawn with a seed that does not change. Beside each, one
sentence is written before its code is opened, and then what the code does: ``forty_texts.md``, misses included.
"""

import random

from vocabulary import PYTHON, C, texts

SEED, DRAWN, SHORTEST = 20261124, 40, 5     # words: shorter texts are labels

if __name__ == "__main__":
    found = [each for each in texts(PYTHON, C) if each.kind != "page" and len(each.text.split()) >= SHORTEST]
    for number, each in enumerate(random.Random(SEED).sample(found, DRAWN), 1):
        print(f"{number}. {each.file}:{each.line}, {each.kind} {each.owner}\n\n{each.text}\n")
