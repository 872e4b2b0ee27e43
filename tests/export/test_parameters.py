"""Parameters of a block: the tables that they make are those of a system with these parameters, and runs go on from there."""

import numpy as np

import zerodrift as zd
from support import refused
from zerodrift._private.gateway.mechanisms.blocks import SECTIONS, BlockCore

LIMITS = {"coupler.length": (0.9, 1.2), "coupler.mass": (2.0, 8.0), "crank.length": (0.25, 0.35)}


def tables(data):
    """Words of a block up to its start."""
    words = np.frombuffer(data, "<f8")
    widths = {"gravity": 1, "bodies": 4, "joints": 13, "quantities": 10, "terms": 2, "relations": 7, "forces": 9, "measures": 7,
              "laws": 4, "instructions": 4, "splines": 2, "knots": 5}
    counts = words[4:4 + len(SECTIONS)]
    first = 4 + len(SECTIONS)
    return words[first:first + int(sum(counts[SECTIONS.index(name)] * width for name, width in widths.items()))]


def test_changed_tables_are_those_of_changed_parameters():
    system = zd.models.four_bar().system()
    core = BlockCore(zd.block(system, parameters=LIMITS, outputs=["crank.angle"]))
    changed = {"coupler.length": 1.13, "coupler.mass": 3.7, "crank.length": 0.27}
    for i, name in enumerate(LIMITS):
        assert core.set_parameter(i, changed[name])
    expected = tables(zd.block(system.with_parameters(changed), outputs=["crank.angle"]))
    np.testing.assert_allclose(tables(core.words), expected, rtol=1e-10, atol=1e-12)       # of the fit, see EXACT
    assert BlockCore(core.words).nq == system.nq


def test_values_beyond_their_range_change_nothing():
    core = BlockCore(zd.block(zd.models.four_bar(), parameters=LIMITS, outputs=[]))
    before = core.words
    assert not core.set_parameter(0, 1.3)
    assert not core.set_parameter(0, np.nan)
    assert not core.set_parameter(5, 1.0)
    assert core.words == before


def test_ranges_are_checked_by_name():
    bar = zd.models.four_bar()
    with refused("wrong-name", r"parameters.*'crank.lenth'.*crank\.length"):
        zd.block(bar, parameters={"crank.lenth": (0.1, 0.2)})
    with refused("out-of-range", r"'crank\.length'.*value 0\.3"):
        zd.block(bar, parameters={"crank.length": (0.4, 0.5)})
    with refused("wrong-type", "parameters"):
        zd.block(bar, parameters=["crank.length"])
