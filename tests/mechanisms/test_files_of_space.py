"""Mechanisms in space in files: read again they are the same to the last bit, and what cannot be read is named with its place."""

import json

import numpy as np
import pytest
import sympy as sp

import zerodrift as zd
from every_model import IN_SPACE
from support import refused
from zerodrift.mechanisms.elements.frames import about
from zerodrift.mechanisms.files.space_from_json import IN_SPACE as MADE
from zerodrift.mechanisms.files.space_to_json import IN_SPACE as WRITTEN

TURNED = about((0.3, 0.6, -0.2), 0.7)      # so that no axis is one of the drawing's


def everything():
    """A mechanism with every kind of joint and force, whose numbers are not round ones."""
    m = zd.Mechanism("all sorts", dimension=3, gravity=(0.1, 0.2, -9.81), parameters={"k": 1 / 3})

    def box(name, *at):
        J = TURNED @ np.diag([0.3, 0.4, 0.5]) @ TURNED.T
        R = TURNED @ about((0, 1, 0.1), len(name) / 7)
        return m.body(name, 1.1, (J + J.T) / 2, at=at, rotation=R, com=(0.01, 0.02, -0.03))

    arm = m.link("arm", (0, 0, 0), (1, 0.3, 0.2), mass=1.1, length=1.05, thickness=0.03, normal=(0.1, 1, 0.3))
    bar = m.link("bar", arm.end, (1.7, -0.4, 0.1), mass=0.7, inertia=(0.01, 0.05, 0.05))
    names = ("one", "second", "third box", "d", "fifth", "disc", "ball", "egg")
    bodies = [box(name, i, 0.1 * i, -i / 3) for i, name in enumerate(names)]
    bob, bead = m.particle("bob", 0.2, at=(0, 2, 0.1)), m.particle("bead", 0.3, at=(4, 2, 1))
    m.particle("nut", 0.1, at=arm.end)
    eye = m.point("eye", bodies[0], at=(-2.1, 0.6, 0.3))
    hinge = m.revolute("hinge", m.ground, arm.start, axis=(0.1, 0.2, 1), damping=0.01)
    m.spherical("ball joint", arm.end, bar.start)
    rail = m.prismatic("rail", m.ground, bodies[0], axis=(1, 0.3, 0.2), damping=0.2)
    m.cylindrical("sleeve", bodies[0], bodies[1], axis=(1, 0.3, 2))
    m.screw("thread", m.ground, bodies[2], axis=(1, 0.3, 2), pitch=-0.013)
    m.universal("cross", bodies[2], bodies[3], at=(2, 1, 0.3), axes=((1, 2, 0.3), np.cross((1, 2, 0.3), (0.1, 0.2, 1))))
    m.planar("table", m.ground, bodies[4], normal=(0.1, 0.2, 1))
    m.weld("glue", bodies[4], bar.end)
    m.rod("string", m.ground.point((0.3, 3, 0.2)), bob)
    m.rod("brace", m.ground.point((2, 3, 0.1)), bob, length=2.4)
    m.slot("wire", bodies[1], bead, axis=(1, 2, 0.3))
    up = np.array([0.1, 0.05, 1.0]) / np.linalg.norm([0.1, 0.05, 1.0])
    axle = np.cross(up, (0.3, 1, 0.2))
    for body, shape in ((bodies[5], {"radius": 0.5, "axle": axle}), (bodies[6], {"radius": 0.4}),
                        (bodies[7], {"semiaxes": (0.3, 0.4, 0.5)})):
        reach = shape.get("radius") or np.linalg.norm((body.pose.rotation.T @ up) * shape["semiaxes"])
        m.rolling(f"floor of {body.name}", m.ground, body, at=body.pose.origin - reach * up, normal=up, **shape)
    m.knife_edge("blade", bodies[3].point((-0.1, 0.05, 0.2)), along=(1, 0.5, 0.1), normal=(0, 0.1, 1))
    m.gear("mesh", "hinge", m.revolute("other", m.ground, bar.end, axis=(0, 0.1, 1)), ratio=-1 / 3)
    m.rack_pinion("teeth", hinge, rail, ratio=0.07)
    m.coupler("cage", {bead.position.x: 1.0, bob.position.x: -0.1, bead.position.z: 0.3})
    x = sp.Symbol("x")
    m.constraint("mine", x**2 - sp.Symbol("bob.position.y") + sp.Symbol("k"), of={"x": bob.position.x})
    m.motor("turn", hinge, speed=sp.sin(sp.Symbol("t") / 3) + sp.pi)
    m.actuator("pump", eye, bead, force=x * 3, of={"x": bead.position.x})
    m.spring("coil", eye, bead, stiffness=10.1, damping=0.3)
    m.torsion_spring("clock", hinge, stiffness=0.7, angle=0.1, damping=1 / 30)
    m.bushing("mount", bodies[0], bodies[4], at=(0.3, 0.2, 0.1), axis=(1, 2, 0.3), stiffness=(10, 1 / 3, 20), damping=0.3,
              torsion=(1, 2, 1 / 7), torsion_damping=0.01)
    m.force("wind", bodies[3], along=(1, 3, 0.1), value=0.1 * x, of={"x": bob.position.x}, frame=bodies[3])
    m.torque("air", bodies[3], value=0.3, against=bodies[2], axis=(0.2, 1, 0.1))
    m.torque("twist", bodies[5], value=0.3, axis=(0.2, 1, 0.1), frame=bodies[5])
    m.start({bodies[5].rotation: TURNED, "bob.velocity": (0.1, 0.2, 0.3)}, wish={"arm.rotation": TURNED, "bead.position.x": 4.2})
    return m


def test_every_number_is_the_same_to_the_last_bit(tmp_path):
    m = everything()
    again = zd.load(m.save(tmp_path / "m"))
    mine, its = (each.system()._measuring.tables for each in (m, again))
    for name in mine._fields:
        assert repr(getattr(mine, name)) == repr(getattr(its, name)), name
    assert again.save(tmp_path / "again").read_bytes() == (tmp_path / "m.json").read_bytes()
    assert again._held["disc.rotation"].tobytes() == m._held["disc.rotation"].tobytes()
    elements = json.loads((tmp_path / "m.json").read_text())["elements"]
    assert set(WRITTEN) == set(MADE) <= {element["kind"] for element in elements}


@pytest.mark.parametrize("name", IN_SPACE)
def test_models_in_space_are_read_as_they_were(name, tmp_path):
    one = IN_SPACE[name](**({"links": 4} if name == "chain" else {}))
    other = zd.load(one.save(tmp_path / name))
    assert other.save(tmp_path / "again").read_bytes() == (tmp_path / f"{name}.json").read_bytes()
    ends = [zd.simulate(m, 0.002, step=0.001) for m in (one, other)]
    assert ends[0].p.tobytes() == ends[1].p.tobytes()
    assert ends[0].v.tobytes() == ends[1].v.tobytes()


def test_a_solution_keeps_its_mechanism(tmp_path):
    """With its changed numbers; so all can be read from it."""
    system = zd.models.heavy_top().with_parameters({"top.mass": 12.0})
    sol = zd.simulate(system, 0.01, step=1e-3)
    again = zd.load(sol.save(tmp_path / "motion"))
    assert again["tip.force"].tobytes() == sol["tip.force"].tobytes()
    assert again["top.rotation"].tobytes() == sol["top.rotation"].tobytes()
    assert again.system.parameters["top.mass"] == 12.0


WRONG = [
    ("body", {"rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 2]]}, "rotation of 'one' must be a rotation"),
    ("body", {"inertia": [[1, 0, 0], [0, 1, 0], [0, 0, 3]]}, "inertia of 'one' must be that of a body"),
    ("link", {"rotation": np.eye(3).tolist()}, "rotation must have the link along its first column"),
    ("link", {"thickness": -1.0}, "thickness of 'arm' must be greater than 0"),
    ("revolute", {"frames": [np.eye(3).tolist()]}, "frames must be two matrices"),
    ("revolute", {"frames": [np.eye(3).tolist(), about((1, 0, 0), 1.0).tolist()]}, "frames must be the same in the drawing"),
    ("revolute", {"frames": 3.0}, "frames must be two matrices"),
    ("screw", {"length": 0.0}, "length must not be 0: it is the pitch"),
    ("rolling", {"semiaxes": [1.0, 2.0]}, "semiaxes must"),
    ("torque", {"axis": [1.0, 1.0, 0.0]}, "axis must have length 1"),
    ("torque", {"frame": "nobody"}, "frame names 'nobody'"),
    ("revolute", {"colour": 1}, "has the key 'colour', which is not known"),
    ("planar", {"first": "nobody"}, "names 'nobody'"),
]


@pytest.mark.parametrize(("kind", "changed", "said"), WRONG, ids=[f"{kind}-{i}" for i, (kind, _, _) in enumerate(WRONG)])
def test_what_cannot_be_read_is_named_with_its_place(kind, changed, said, tmp_path):
    path = everything().save(tmp_path / "m")
    told = json.loads(path.read_text())
    element = next(element for element in told["elements"] if element["kind"] == kind)
    element.update(changed)
    path.write_text(json.dumps(told))
    with refused("unreadable-file", rf"element \d+ \({kind} '{element['name']}'\).* ?{said}"):
        zd.load(path)
