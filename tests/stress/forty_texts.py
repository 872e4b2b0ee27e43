"""Forty texts and forty identifiers drawn at random: is each understood from its words alone?

    PYTHONPATH=python:tests:tests/support python tests/stress/forty_texts.py

First lines of docstrings, comments and descriptions of parameters, and identifiers of at least two words, of the package and of
the core are drawn with a seed that does not change. Beside each, one sentence is written before its code is opened, and then what
the code does: ``forty_texts.md``, misses included.
"""

import random

from vocabulary import PYTHON, C, code_files, identifiers, texts

SEED, DRAWN, SHORTEST = 20261128, 40, 5     # words: shorter texts are labels

if __name__ == "__main__":
    draw = random.Random(SEED)
    found = [each for each in texts(PYTHON, C) if each.kind != "message" and len(each.text.split()) >= SHORTEST]
    for number, each in enumerate(draw.sample(found, DRAWN), 1):
        print(f"{number}. {each.file}:{each.line}, {each.kind} {each.owner}\n\n{each.text.split(chr(10) * 2)[0]}\n")
    names = {name: file for place in (PYTHON, C) for file in code_files(place) for name in identifiers(file) if "_" in name[3:-1]}
    for number, name in enumerate(draw.sample(sorted(names), DRAWN), 1):
        print(f"{number}. {name}    {names[name]}")
