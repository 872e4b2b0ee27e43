"""Files of mechanisms from an unknown source: no number fills the memory, and every refusal names its place."""

import copy
import json

import pytest
import sympy as sp

import zerodrift as zd
from support import refused


@pytest.fixture
def good(tmp_path):
    m = zd.Mechanism("m", gravity=(0, -9.81))
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    m.motor("motor", m.revolute("pin", m.ground, link.start), torque=sp.sin(3 * sp.Symbol("t")))
    return json.loads(m.save(tmp_path / "m").read_text())


def with_law(good, expression):
    other = copy.deepcopy(good)
    next(each for each in other["elements"] if each["kind"] == "motor")["law"] = {"expression": expression, "of": {}}
    return json.dumps(other)


def deep(depth):
    expression = "t"
    for _ in range(depth):
        expression = ["sin", expression]
    return expression


@pytest.mark.parametrize(("expression", "message"), [
    (["^", 9, ["^", 9, 9]], "must not have the power 9"),
    (["^", 10, 10**8], "must not have the power 10"),
    (["^", ["/", 1, 3], -10**8], "must not have the power"),
    (["*", 10**310, "t"], "within the range of doubles"),
    (deep(500), "at most 100 operations within operations"),
])
def test_expressions_that_are_refused(good, tmp_path, expression, message):
    (tmp_path / "h.json").write_text(with_law(good, expression))
    with refused("unreadable-file", rf"element 2 \(motor 'motor'\).*{message}"):
        zd.load(tmp_path / "h.json")


@pytest.mark.parametrize("expression", [
    ["^", 2, 10], ["^", "t", 3], ["^", ["/", 1, 2], -3], ["^", 2.5, 3], ["^", 1, 10**6], deep(50)])
def test_expressions_that_are_read(good, tmp_path, expression):
    (tmp_path / "h.json").write_text(with_law(good, ["*", expression, "t"]))
    assert zd.load(tmp_path / "h.json").motors[0].law.formula is not None


def test_kinds_are_names(good, tmp_path):
    good["elements"][0]["kind"] = ["link"]
    (tmp_path / "h.json").write_text(json.dumps(good))
    with refused("unreadable-file", "element 0.*'link'"):
        zd.load(tmp_path / "h.json")


def test_numbers_of_thousands_of_digits(good, tmp_path):
    (tmp_path / "h.json").write_text(json.dumps(good).replace('"mass": 1.0', '"mass": 1' + "0" * 5000))
    with refused("unreadable-file", "h.json.*of 5001"):
        zd.load(tmp_path / "h.json")
