"""Shapes that bodies are given: in pictures at their poses, in files, and without effect on the motion."""

import json

import numpy as np
import pytest

import zerodrift as zd
from support import refused
from zerodrift.player.live import live_view
from zerodrift.plot.glyphs import GLYPHS

CORNERS = np.array([(-0.5, 0.0), (0.5, 0.0), (0.4, 0.3), (0.0, 0.1), (-0.4, 0.3)])      # not convex


def arm(**more):
    m = zd.Mechanism("arm", gravity=(0, -9.81))
    body = m.body("plate", 2.0, 0.1, at=(1, 2), angle=0.3, com=(0.1, 0.05), **more)
    m.revolute("pin", m.ground, body.point((0.2, 0)))
    return m


def shape(m, name, sample=-1):
    sol = zd.simulate(m, 0.4, step=0.01)
    return sol, next(each for each in m.system()._sketches([sol.p[sample]])[0] if each.name == name)


def test_corners_are_drawn_at_the_pose_of_the_body():
    m, plain = arm(), arm()
    m.draw("plate", CORNERS)
    sol, found = shape(m, "plate")
    angle, place = sol["plate.angle"][-1], sol["plate.position"][-1]
    c, s = np.cos(angle), np.sin(angle)
    assert found.kind == "cam"
    assert found.points == pytest.approx(place + CORNERS @ np.array([[c, s], [-s, c]]), abs=1e-12)
    assert np.array_equal(GLYPHS["cam"].draw(found, 0.1)[0].path.vertices[:len(CORNERS)], found.points)
    assert np.array_equal(sol.p, zd.simulate(plain, 0.4, step=0.01).p)


def test_a_radius_is_a_disc_about_the_origin_of_the_body():
    m = arm()
    m.draw(m["plate"], 0.7)
    sol, found = shape(m, "plate")
    assert (found.kind, found.number) == ("wheel", 0.7)
    assert found.points[0] == pytest.approx(sol["plate.position"][-1])
    m.draw("plate", CORNERS)        # the last one counts
    assert shape(m, "plate")[1].kind == "cam"


@pytest.mark.parametrize(("corners", "kind", "count"), [(((0, 0, 0), (0.4, 0.2, 0.1)), "box", 8),
                                                        (((0, 0, 0), (0.4, 0, 0), (0.4, 0.2, 0.1)), "plate", 3)])
def test_boxes_and_plates_in_space(corners, kind, count):
    m = zd.Mechanism("block", dimension=3)
    m.body("block", 2.0, ((0.3, 0.03, 0), (0.03, 0.4, 0), (0, 0, 0.2)), com=(0.2, 0.1, 0.05))
    m.start({"block.angular_velocity": (1.0, 2.0, 0.5)})
    m.draw("block", corners)
    sol, found = shape(m, "block")
    rotation, place = sol["block.rotation"][-1], sol["block.position"][-1]
    assert (found.kind, len(found.points)) == (kind, count)
    of_box = [(x, y, z) for x in (0, 0.4) for y in (0, 0.2) for z in (0, 0.1)]
    own = np.array(corners if kind == "plate" else of_box)
    assert found.points == pytest.approx(place + own @ rotation.T, abs=1e-12)


def test_files_films_and_space_have_them(tmp_path):
    m = arm()
    m.draw("plate", CORNERS)
    again = zd.load(m.save(tmp_path / "arm"))
    assert json.loads((tmp_path / "arm.json").read_text())["shapes"] == {"plate": CORNERS.tolist()}
    assert shape(again, "plate")[1].points == pytest.approx(shape(m, "plate")[1].points)
    assert '["cam","plate"' in zd.view(zd.simulate(m, 0.2, step=0.01)).page.replace(" ", "")
    assert any(each[0] == "cam" for each in live_view(m)._scene["shapes"])
    flat = shape(m.lifted(), "plate")[1]
    assert flat.kind == "plate"
    assert flat.points[:, :2] == pytest.approx(shape(m, "plate")[1].points)
    m.remove("pin")
    m.remove("plate")
    m.body("plate", 1.0, 0.1)
    assert m._drawing().shapes == {}


def test_wrong_shapes():
    m = arm()
    m.particle("ball", 1.0, at=(0, 0))
    for body, given, code, word in (("ground", 1.0, "wrong-element", "ground"), ("ball", 1.0, "wrong-element", "ball"),
                                    ("plate", -1.0, "out-of-range", "plate"), ("plate", CORNERS[:2], "shape", "at least 3"),
                                    ("plate", [(0, 0, 0)] * 3, "shape", "corner")):
        with refused(code, word):
            m.draw(body, given)
    with refused("wrong-type", "a list of corners"):
        zd.models.heavy_top().draw("top", 0.5)
