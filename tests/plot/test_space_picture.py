"""Pictures of mechanisms in space: what is drawn is where the measures say."""

import matplotlib.pyplot as plt
import numpy as np
import pytest

import zerodrift as zd
from every_model import IN_SPACE
from support import assert_close, refused
from zerodrift.mechanisms.elements.frames import about
from zerodrift.plot.space_picture import DOTS, FACES, GLYPHS


def artists(ax, kind):
    return [each for each in [*ax.collections, *ax.lines] if each.get_label() == f"_{kind}" and each.get_visible()]


def artist(ax, kind):
    (found,) = artists(ax, kind)
    return found


def shapes(system, kind):
    return [shape for shape in system._sketches([system.p0])[0] if shape.kind == kind]


@pytest.mark.parametrize("name", IN_SPACE)
def test_every_model_in_space_is_drawn(name):
    m = IN_SPACE[name](**({"links": 20} if name == "chain" else {}))
    ax = zd.plot.mechanism(m, names=True)
    assert ax.name == "3d"
    names = {text.get_text() for text in ax.texts}
    assert name == "chain" or {body.name for body in m.bodies} <= names | {"elbow 0"}
    if name in ("gyroscope", "double_wishbone"):
        ax.figure.canvas.draw()
    plt.close(ax.figure)


def test_bars_and_plates_are_where_their_ends_are():
    m = zd.models.stewart_platform()
    sol = zd.simulate(m, 0.3, step=5e-3)
    bars = [shape for shape in sol.system._sketches([sol.p[-1]])[0] if shape.kind == "bar"]
    for shape in bars:
        assert_close(shape.points[1], sol[f"{shape.name}.end.position"][-1], 1e-12, scale=1.0)
    (top,) = [shape for shape in sol.system._sketches([sol.p[-1]])[0] if shape.kind == "plate"]
    ends = np.array([sol[f"piston {k}.end.position"][-1] for k in range(6)])
    assert all(np.abs(ends - corner).sum(axis=1).min() < 1e-9 for corner in top.points)
    assert len(top.points) == 6
    assert len(bars) == 12
    sides = np.linalg.norm(np.diff(np.vstack([top.points, top.points[:1]]), axis=0), axis=1)
    assert sides.max() < 1.01 * 2 * 0.6 * np.sin(np.pi / 3 - 0.2)      # neighbours, so that no two edges cross


def test_a_box_has_the_inertia_of_its_body():
    m = zd.Mechanism("box", dimension=3)
    m.body("box", 2.0, (0.1, 0.2, 0.25), rotation=about((1, 2, 3), 0.4), at=(1, 2, 3))
    ((_, corners, _, _),) = shapes(m.system(), "box")
    middle = corners.mean(axis=0)
    assert_close(middle, np.array([1.0, 2, 3]), 1e-14)
    edges = np.array([corners[i] - corners[0] for i in (4, 2, 1)])
    squares = (edges**2).sum(axis=1)
    assert_close(2.0 / 12 * (squares.sum() - squares), np.array([0.1, 0.2, 0.25]), 1e-14)
    assert len(GLYPHS["box"].draw(corners, 1.0)) == len(FACES) == 6
    for face in corners[FACES]:         # round each face, not across it
        assert abs(np.diff(np.vstack([face, face[:1]]), axis=0) @ np.diff(face, axis=0)[0]).max() < 1.01 * squares.max()


def test_a_wheel_is_a_disc_of_its_own_inertia():
    m = zd.Mechanism("wheel", dimension=3)
    m.body("wheel", 2.0, (0.13, 0.25, 0.13), rotation=about((1, 2, 3), 0.4), at=(1, 2, 3))
    ((_, rim, _, _),) = shapes(m.system(), "disc")
    assert_close(np.linalg.norm(rim - (1, 2, 3), axis=1), np.full(len(rim), np.sqrt(2 * 0.25 / 2.0)), 1e-14)
    assert np.abs((rim - (1, 2, 3)) @ about((1, 2, 3), 0.4)[:, 1]).max() < 1e-14
    assert not shapes(m.system(), "box")


def test_a_disc_touches_the_ground_where_its_contact_is():
    m = zd.models.rolling_disc()
    ((_, rim, name, _),) = shapes(m.system(), "disc")
    assert name == "disc"
    assert rim[:, 2].min() == pytest.approx(0.0, abs=5e-3)      # of a polygon
    assert_close(np.linalg.norm(rim - m.p0[:3], axis=1), np.full(len(rim), 0.5), 1e-14)
    rings = shapes(zd.models.rattleback().system(), "ring")
    longest = [np.linalg.norm(np.ptp(ring.points, axis=0)) / 2 for ring in rings]
    assert max(longest) == pytest.approx(np.hypot(0.2, 0.03), abs=1e-3)
    assert min(longest) == pytest.approx(np.hypot(0.02, 0.03), abs=1e-3)


def everything():
    m = zd.Mechanism("all", dimension=3)
    box, other = m.body("box", 1.0, (0.1, 0.1, 0.1)), m.body("other", 1.0, (0.1, 0.1, 0.1), at=(1, 0, 0.2))
    star = m.body("star", 1.0, (0.1, 0.1, 0.1), at=(0, 2, 0))
    bob = m.particle("bob", 1.0, at=(2, 0, 0))
    m.planar("ice", m.ground, box, normal=(0, 0, 1))
    m.weld("glue", box, other, at=(0.5, 0, 0))
    for i, place in enumerate(((0, 2.5, 0), (0.3, 2, 0), (0, 1.8, 0.4), (-0.3, 2, -0.2))):
        m.rod(f"rod {i}", star.point(at=place), m.ground.point(np.add(place, (0, 0, 1))))
    m.particle("load", 0.1, at=other.point((0.2, 0, 0)))
    m.spring("spring", bob, other.center, stiffness=1.0)
    m.actuator("jack", bob, m.ground.point((3, 0, 0)), force=1.0)
    m.bushing("mount", m.ground, star, at=(0, 2, -0.1), stiffness=1.0)
    m.knife_edge("blade", other.point((0, 0, -0.2)), along=(1, 0, 0))
    return m


def test_every_shape_there_is():
    kinds = {shape.kind for m in (everything(), *(model() for model in IN_SPACE.values() if model is not zd.models.chain))
             for shape in m.system()._sketches([m.p0])[0]}
    assert kinds >= {*GLYPHS, *DOTS}
    ax = zd.plot.mechanism(everything())
    assert len(artist(ax, "spring")._segments3d) == 1
    plt.close(ax.figure)


def test_a_motion_with_its_path_and_a_film():
    sol = zd.simulate(zd.models.heavy_top(), 0.2, step=1e-3)
    ax = zd.plot.mechanism(sol, path="top.center", ghosts=3)
    path = [line for line in ax.lines if len(line.get_data_3d()[0]) == len(sol.t)]
    assert np.array_equal(np.array(path[0].get_data_3d()).T, sol["top.center.position"])
    assert len(artist(ax, "ghosts")._segments3d) == 3
    plt.close(ax.figure)
    film = zd.plot.animate(sol, fps=20, names=True)
    film._init_draw()
    film._draw_frame(3)
    parts = np.concatenate([each._segments3d for each in artists(film._fig.axes[0], "bar")])
    bar = parts[0, 0], parts[-1, 1]
    assert_close(np.sum(bar, axis=0), sol["top.center.position"][150] + sol["tip.position"][150], 1e-12, scale=1.0)
    plt.close(film._fig)


def arrows(ax):
    """Tail and tip of each arrow, (n, 2, 3): each is a shaft and four lines of its head."""
    return np.array(artist(ax, "forces")._segments3d[::5])


def test_forces_are_arrows_from_where_they_act():
    """A joint's at its point, in the drawing's axes; a spring's along itself, and a load's along its direction."""
    m = zd.Mechanism("hung", dimension=3, gravity=(0, 0, -9.81))
    box = m.body("box", 2.0, (0.1, 0.2, 0.15), at=(0.5, 0.1, -0.2), rotation=about((1, 2, 3), 0.4), com=(0.1, 0, 0.05))
    pin = m.spherical("pin", m.ground, box, at=(0, 0, 0))
    end = m.point("end", box, at=(0.8, 0.3, 0.1))
    m.spring("coil", m.ground.point((0.5, 0.2, 1.0)), end, stiffness=30.0, length=0.4)
    m.force("wind", end, along=(0, 3, 4), value=5.0, frame=box)
    m.bushing("mount", m.ground, box, at=(0.2, 0, 0), stiffness=2000.0)
    sol = zd.simulate(m, 0.2, step=1e-2)
    ax = zd.plot.mechanism(sol, forces=[pin, "coil", "wind", "mount"], force_scale=20.0, t=0.2)
    tails, tips = arrows(ax).transpose(1, 0, 2)
    there, above, turned = sol["end.position"][-1], np.array([0.5, 0.2, 1.0]), sol["box.rotation"][-1] @ sol["box.rotation"][0].T
    pull = sol["coil.force"][-1] * (above - there) / np.linalg.norm(above - there)
    assert_close(tails[:3], np.array([np.zeros(3), there, there]), 1e-9, scale=1.0)
    expected = np.array([sol["pin.force"][-1], pull, turned @ (0, 3, 4), sol["mount.force"][-1]])
    assert_close(20.0 * (tips - tails), expected, 1e-9, scale=np.abs(expected).max())
    assert {text.get_text() for text in ax.texts if text.get_label() == "_scale"} == {"2 N is 0.1 m long"}
    plt.close(ax.figure)


def test_the_force_of_what_rolls_is_at_its_contact():
    for name, floor in (("rolling_disc", "floor"), ("rattleback", "table")):
        sol = zd.simulate(IN_SPACE[name](), 0.3, step=1e-2)
        film = zd.plot.animate(sol, fps=10, forces=True)
        film._init_draw()
        film._draw_frame(2)
        ((tail, tip),) = arrows(film._fig.axes[0])
        force = sol[f"{floor}.force"][20]
        assert tail[2] == pytest.approx(0.0, abs=1e-9)
        assert_close(np.cross(tip - tail, force), np.zeros(3), 1e-9, scale=np.linalg.norm(force))
        plt.close(film._fig)


def test_what_is_not_drawn_in_space_says_so():
    sol = zd.simulate(zd.models.heavy_top(), 0.01, step=1e-3)
    with refused("wrong-name", "heavy_top"):
        zd.plot.mechanism(sol, path="nobody")
    with refused("wrong-dimension", "^ax must.*be 3D"):
        zd.plot.mechanism(sol, ax=plt.subplots()[1])
    plt.close("all")


@pytest.mark.parametrize("model", ["delta_robot", "double_wishbone", "stewart_platform", "planetary_gear", "snakeboard", "watt"])
def test_names_do_not_cover_each_other(model):
    """On the canvas, where the axes are as large as they are drawn: boxes of two names have no pixel in common."""
    ax = zd.plot.mechanism(getattr(zd.models, model)(), names=True)
    ax.figure.canvas.draw()
    boxes = [(text.get_text(), text.get_window_extent()) for text in ax.texts if text.get_text()]
    assert len(boxes) > 5
    assert not [(one, other) for i, (one, box) in enumerate(boxes) for other, second in boxes[:i] if box.overlaps(second)]


def test_what_is_near_covers_what_is_far():
    """A small plate in front of a large one, and one behind it, whichever was drawn first."""
    m = zd.Mechanism("plates", dimension=3)
    for k, y in enumerate((0.0, -1.0, 1.0)):
        body = m.body(f"plate {k}", 1.0, (0.1, 0.1, 0.1), at=(0, y, 0))
        size = 1.0 if k == 0 else 0.3
        for i, (x, z) in enumerate(((-1, -1), (1, -1), (1, 1), (-1, 1))):
            m.point(f"{k}{i}", body, at=(size * x, y, size * z))
            m.rod(f"rod {k}{i}", body.point(at=(size * x, y, size * z)), m.ground.point((size * x, y, 2.0)))
    ax = zd.plot.mechanism(m)
    ax.view_init(elev=0, azim=-90)
    ax.figure.canvas.draw()
    faces = sorted(artists(ax, "plate"), key=lambda each: each.zorder)
    far, large, near = (each.get_paths()[0].get_extents().width for each in faces)      # the near one seems wider
    assert far < near < large
    plt.close(ax.figure)


def test_z_points_down_where_gravity_does():
    axes = [zd.plot.mechanism(m) for m in (zd.models.whipple_bicycle(), zd.models.gyroscope())]
    assert [(ax.zaxis_inverted(), ax.yaxis_inverted()) for ax in axes] == [(True, True), (False, False)]
    for ax in axes:
        plt.close(ax.figure)


def test_faces_are_lit_by_their_normals():
    """Opposite faces of a box look the same, others do not; the lightest is the one whose normal is nearest to the light."""
    from zerodrift.plot.space_picture import FACES, LIGHT, _shaded
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    faces = [corners[list(each)] for each in FACES]
    tones = _shaded("#808080", faces)[:, 0]
    assert np.allclose(tones[::2], tones[1::2])
    assert len(np.unique(tones.round(9))) == 3
    brightest = faces[int(np.argmax(tones))]
    assert np.ptp(brightest[:, int(np.argmax(np.abs(LIGHT)))]) == 0
