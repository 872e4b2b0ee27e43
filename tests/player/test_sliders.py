"""Sliders of live views that are chosen without being named: they go together, and their block is that of changed mechanisms."""

import numpy as np
import pytest

import zerodrift as zd
from support import refused
from zerodrift import gallery
from zerodrift._private.gateway.mechanisms.blocks import BlockCore
from zerodrift.export import block
from zerodrift.player.live import live_view


@pytest.mark.parametrize("exhibit", gallery.exhibits(), ids=lambda each: each.name)
def test_every_model_has_a_live_view_with_sliders(exhibit):
    assert live_view(exhibit.made())._scene["sliders"]


def words(mechanism):
    return block.table_words(block.choose(mechanism, None, None, 0.0, 0.01, [], []))


def test_a_delta_robot_is_changed_by_all_its_sliders_together():
    robot = zd.models.delta_robot()
    sliders = [each for each in live_view(robot)._scene["sliders"] if each["kind"] == "parameter"]
    assert {"arm 0.length", "arm 1.length"} & {each["name"] for each in sliders}   # the tables of one may change their order
    core = BlockCore(zd.block(robot, outputs=[], parameters={each["name"]: (each["least"], each["most"]) for each in sliders}))
    changed = {each["name"]: 0.4 * each["least"] + 0.6 * each["most"] for each in sliders}
    assert all(core.set_parameter(i, value) for i, value in enumerate(changed.values()))
    of, begin = words(robot), 4 + len(block.blocks.SECTIONS)
    found = np.frombuffer(core.words, "<f8")[begin:begin + of({}).size]
    np.testing.assert_allclose(found, of(changed), rtol=1e-10, atol=1e-14)


def test_a_rational_function_is_refused_alone_as_beside_others():
    """The common mass centre of an arm and of a particle on it depends on the particle's mass as m / (1 + m)."""
    for ranges in ({"elbow 0.mass": (0.11, 0.19)}, {"elbow 0.mass": (0.11, 0.19), "arm 0.length": (0.25, 0.35)}):
        with refused("not-portable", "elbow 0.mass"):
            zd.block(zd.models.delta_robot(), parameters=ranges)


def test_principal_axes_of_a_symmetric_body_do_not_jump_with_its_mass():
    """Three particles on a disc: products of inertia are rounding, whatever the masses are."""
    of = words(zd.models.delta_robot())
    for mass in (0.61, 0.8, 0.93):
        assert list(np.flatnonzero(of({"platform.mass": mass}) != of({}))) == ([] if mass == 0.8 else [4])
