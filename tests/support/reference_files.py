"""Reads the files of references/, and judges errors against them."""

import csv
import json
from itertools import pairwise

import numpy as np
import pytest

import zerodrift as zd
from support import ROOT

FOLDER = ROOT / "tests" / "references"
ROUND_OFF = 1e-10   # what the finest step leaves: truncation has fallen to the round-off of some 1e4 steps


def definition(name):
    return json.loads((FOLDER / f"{name}.json").read_text())


def table(name):
    path = FOLDER / f"{name}_ref.csv"
    if not path.exists() and (ROOT / "PKG-INFO").exists():
        pytest.skip(f"{path.name} is not in source distributions: it is in the repository")
    with open(path) as file:
        rows = list(csv.DictReader(file))
    return {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}


def number(text):
    return np.array(text, dtype=float)


def falls_at_order_four(steps, errors):
    """Errors at falling steps: overall at order four until they are at round-off, and always falling."""
    clear = [(h, error) for h, error in zip(steps, errors, strict=True) if error > ROUND_OFF]
    (first, coarse), (last, fine) = clear[0], clear[-1]
    assert np.log(coarse / fine) / np.log(first / last) > 3.5, errors
    assert all(fine < max(coarse, ROUND_OFF) for coarse, fine in pairwise(errors)), errors
    assert errors[-1] < ROUND_OFF, errors


def end(system, t_end, step, **options):
    return zd.simulate(system, t_end, step=step, save_every=10**6, **options)
