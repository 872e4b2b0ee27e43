"""Blocks that are wrong are refused with a sentence, whatever they are; see tests/fuzz/fuzz_block.c."""

import os
import struct
import subprocess
import sys

import numpy as np
import pytest

import zerodrift as zd
from core_objects import linked, needs_compiler
from covering import draws
from support import ROOT, refused
from zerodrift._private.gateway.mechanisms.blocks import SECTIONS, BlockCore

CHANGES = draws(400, 4000)      # of each block; .ci/sanitize makes 4000, under sanitizers


def four_bar():
    return zd.block(zd.models.four_bar(), outputs=["crank.angle"])


def with_word(data, place, value):
    return data[:8 * place] + struct.pack("<d", value) + data[8 * place + 8:]


def first_word(data, section, width):
    """Place of the first word of a section; `width` has the words of an entry of each section before it."""
    counts = struct.unpack_from(f"<{len(SECTIONS)}d", data, 32)
    return 4 + len(SECTIONS) + int(sum(counts[i] * width[name] for i, name in enumerate(SECTIONS[:SECTIONS.index(section)])))


WIDTHS = {"gravity": 1, "bodies": 4, "joints": 13, "quantities": 10, "terms": 2, "relations": 7, "forces": 9, "measures": 7,
          "groups": 20,
          "laws": 7, "instructions": 4, "results": 1, "numbers": 1, "splines": 2, "knots": 5, "start": 1, "outputs": 1}


@pytest.mark.parametrize(("spoilt", "sentence"), [
    (lambda data: data[:-1], "words of 8 bytes"),
    (lambda data: data[:80], "at least 31 words"),
    (lambda data: b"ZDBLOCK\0" + data[8:], 'must begin with "zdblock"'),
    (lambda data: with_word(data, 1, 1.0), "version of the block must be 7, not 1"),
    (lambda data: data[:-8], "must have the .* words that its header counts"),
    (lambda data: with_word(data, 3, 4.0), "dimension of the block must be 2 or 3"),
    (lambda data: with_word(data, 5, 1e6), "number of bodies of the block must fit"),
    (lambda data: with_word(data, 5, 1.5), "number of bodies of the block must fit"),
    (lambda data: with_word(data, 5, -1.0), "number of bodies of the block must fit"),
    (lambda data: with_word(data, 5, 2.0), "must fill it|whole numbers|gravity|must fit"),
    (lambda data: with_word(data, first_word(data, "bodies", WIDTHS), np.nan), "every number must be finite"),
    (lambda data: with_word(data, first_word(data, "bodies", WIDTHS), -1.0), "its mass must be at least 0"),
    (lambda data: with_word(data, first_word(data, "joints", WIDTHS), 99.0), "its kind must be from 0 to"),
    (lambda data: with_word(data, first_word(data, "joints", WIDTHS) + 1, 99.0), "its bodies must be from 0 to 3"),
    (lambda data: with_word(data, first_word(data, "joints", WIDTHS) + 1, 0.5), "whole numbers from -1 on"),
    (lambda data: with_word(data, first_word(data, "measures", WIDTHS), 1e5), "existing texts"),
    (lambda data: with_word(data, first_word(data, "outputs", WIDTHS), 1.0), "its measure must exist"),
    (lambda data: data[:-1] + b"x", "must end with a zero byte")])
def test_a_wrong_block_is_refused_with_a_sentence(spoilt, sentence):
    with refused("wrong-value", sentence):
        BlockCore(spoilt(four_bar()))


def test_the_widths_of_this_file_are_those_of_the_block():
    data, system = four_bar(), zd.models.four_bar().system()
    start = first_word(data, "start", WIDTHS)
    np.testing.assert_array_equal(np.frombuffer(data, "<f8")[start:start + system.nq], system.p0)


def test_splines_are_out_of_reach():
    """Numbers that two laws share, or that are a spline and a speed, could become the address of anything."""
    m = zd.Mechanism("drives")
    for i in range(2):
        link = m.link(f"link{i}", (i, 0), (i, 1), mass=1.0)
        pin = m.revolute(f"pin{i}", m.ground, link.start)
        m.motor(f"drive{i}", pin, **({"speed": 1.0} if i else {"angle": zd.table([0.0, 1.0, 2.0], [0.0, 0.1, 0.0])}))
    data = zd.block(m, inputs=["drive1.speed"])
    laws, inputs = (first_word(data, name, WIDTHS) for name in ("laws", "inputs"))
    assert BlockCore(data).inputs == {"drive1.speed": 1.0}
    with refused("wrong-value", "law 1: .* be its own"):
        BlockCore(with_word(data, laws + 7 + 5, 0.0))
    with refused("wrong-value", "input 0: it must be a speed of a law"):
        BlockCore(with_word(data, inputs + 3, 0.0))


@pytest.mark.parametrize(("section", "place", "value", "sentence"), [
    ("measures", 3, 1.0, "measure 2 must have a law"), ("measures", 4, 1.0, "measure 2 must have a law"),
    ("measures", 4, 40.0, "measure 2 must have a law"), ("measures", 6, 1.0, "measure power must read"),
    ("terms", 0, 2.0, "measure power must read"), ("terms", 0, 9.0, "measure power must read"),
    ("terms", 1, 9.0, "measure power must read")])
def test_a_formula_reads_what_there_is(section, place, value, sentence):
    m = zd.Mechanism("one")
    pin = m.revolute("pin", m.ground, m.link("link", (0, 0), (1, 0), mass=1.0).start)
    m.measure("power", lambda a, w: a * w, of={"a": pin.angle, "w": pin.speed})
    data = zd.block(m, outputs=["power"])
    first = first_word(data, section, WIDTHS) + place + (14 if section == "measures" else 0)
    with refused("wrong-value", sentence):
        BlockCore(with_word(data, first, value))


def seeds():
    """Blocks of the plane and of space, in joint and in absolute coordinates, with and without user functions."""
    import sympy as sp

    m = zd.Mechanism("laws")
    first, second = m.link("first", (0, 0), (1, 0), mass=1.0), m.link("second", (1, 0), (1, 1), mass=1.0)
    pin, elbow = m.revolute("pin", m.ground, first.start), m.revolute("elbow", first.end, second.start)
    t = np.linspace(0, 1, 11)
    m.motor("drive", pin, angle=zd.table(t, 0.2 * t**3))
    m.motor("push", elbow, torque=sp.sin(sp.Symbol("t")))
    m.force("wind", second.end, value=(2.0, 0.0))
    m.measure("power", lambda M, w: M * w, of={"M": "push.torque", "w": elbow.speed})
    return {"law": zd.block(m, outputs=["second.angle", "power"]), "four_bar": four_bar(),
            "cam": zd.block(zd.models.cam_follower()), "coin": zd.block(zd.models.coin()),
            "slider": zd.block(zd.models.slider_crank()), "wishbone": zd.block(zd.models.double_wishbone(), outputs=[]),
            "wishbone_absolute": zd.block(zd.models.double_wishbone().system("absolute"), outputs=[])}


@needs_compiler
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="needs the tools of GNU")
def test_changed_blocks_are_refused_or_run(tmp_path, core_objects):
    """Each ends, without a signal; what reads or writes where it must not, .ci/sanitize finds."""
    program = linked(tmp_path / "fuzz_block", ROOT / "tests" / "fuzz" / "fuzz_block.c", core_objects.values())
    files = []
    for name, data in seeds().items():
        files.append(tmp_path / name)
        files[-1].write_bytes(data)
    clean = {key: value for key, value in os.environ.items() if key != "LD_PRELOAD"}
    result = subprocess.run([program, str(CHANGES), "1", *files], capture_output=True, text=True, check=False, env=clean)
    assert result.returncode == 0, result.stderr
