"""The terms of mechanisms in space: against differences along exact motions, and against an independent model of bodies."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from many_bodies import components
from space_tables import KINDS, exactly_moved, random_frame, random_state, shape_of, unit
from support import assert_close, refused
from zerodrift._private.gateway.mechanisms.plane import GeneralizedForce, OutputSpec, Relation
from zerodrift._private.gateway.mechanisms.space import QUANTITY_KINDS, Body, Joint, Quantity, SpaceCore, Tables

H = 1e-5            # s: of central differences, whose error is some H^2 and round-off over H
NEAR = 3e-8         # that error, of terms of order one to ten
SPEEDS = ("slip", "glide", "spin", "turn", "shear", "orbit", "orbit across")


def quantities(rng):
    made = []
    for kind in QUANTITY_KINDS:
        a, o, _ = random_frame(rng)
        shape = random_frame(rng) if kind == "rotation" else shape_of(random_frame(rng), (0.4, 0.7, 0.2))
        made.append(Quantity(kind, 1, 2, *rng.normal(size=(2, 3)).tolist(), a, o, unit(rng), shape, 0.1))
    return made


def everything(rng):
    """Three bodies, a joint of each kind between any two of them, relations, forces, and each marker quantity as a measure."""
    bodies = [Body(rng.uniform(1, 2), tuple(rng.uniform(1, 1.5, 3))) for _ in range(3)]
    joints = [Joint(kind.number, *ends, *rng.normal(size=(2, 3)).tolist(), random_frame(rng), random_frame(rng), (0.3, 0.5, 0.8),
                    0.3, 0.2)
              for kind in KINDS.values() for ends in ((0, 1), (1, 2), (3, 2))]
    place = {kind: i for i, kind in enumerate(QUANTITY_KINDS)}
    forces = [GeneralizedForce("spring", place["distance"], 3.0, 0.2), GeneralizedForce("spring", place["along"], 2.0),
              GeneralizedForce("spring", place["rotation"], 1.5, 0.3),
               *(GeneralizedForce("constant", place[kind], value=value)
                 for kind, value in zip(SPEEDS, (1.2, 2.0, -1.5, 0.7, 0.9, 0.4, -0.6), strict=True))]
    relations = [Relation([place["angle"], place["along"]], [0.3, 1.0], 0.1, 0.2),
                 Relation([place["turn"], place["glide"]], [1.0, 0.5], 0.3, nonholonomic=True)]
    measures = [OutputSpec(f"{kind} {quantity}", "", quantity, i) for i, kind in enumerate(QUANTITY_KINDS)
                for quantity in ("values", "rates")]
    return SpaceCore(Tables(bodies, joints, quantities(rng), relations, forces, measures, (0.3, -0.2, -9.81)))


def derivative(function, core, p, v):
    """By time, along a motion whose velocities do not change."""
    return (function(exactly_moved(core, p, H * v)) - function(exactly_moved(core, p, -H * v))) / (2 * H)


@pytest.fixture(params=range(3))
def case(request):
    rng = np.random.default_rng(request.param)
    core = everything(rng)
    return core, *random_state(core, rng)


def test_rows_are_derivatives(case):
    """C v is the derivative of Phi, and -xi that of C v at constant v."""
    core, p, v = case
    terms = core.evaluate(0.3, p, v)
    values = derivative(lambda p: core.evaluate(0.3, p, v)["Phi"], core, p, v)
    assert_close((terms["C"] @ v)[: core.mh], values, NEAR)
    assert_close(-terms["xi"], derivative(lambda p: core.evaluate(0.3, p, v)["C"] @ v, core, p, v), NEAR)


def test_kinematics_are_those_of_quaternions(case):
    core, p, v = case
    pdot, bodies = core.evaluate(0.0, p, v)["A"] @ v, core.nq - len(core.angles(p))
    assert_close(pdot[:bodies], derivative(lambda p: p, core, p, v)[:bodies], NEAR)


def test_angles_of_joints_follow_their_bodies():
    """By the rate that a hinge has which keeps its axis, whichever way both bodies turn, and to what their attitudes say."""
    rng = np.random.default_rng(5)
    frames = random_frame(rng), random_frame(rng)
    joints = [Joint(KINDS[kind].number, *ends, frame1=frames[0], frame2=frames[1]) for kind, ends in
              (("revolute", (0, 1)), ("cylindrical", (1, 2)), ("universal", (2, 1)))]
    core = SpaceCore(Tables([Body(1.0, (1.0, 1.1, 1.2))] * 2, joints))
    F1, F2 = (Rotation.from_matrix(np.transpose(frame)) for frame in frames)     # of each body's axes in the joint's frame

    def turned(angle):
        return F1 * Rotation.from_rotvec([angle, 0, 0]) * F2.inv()

    one, other = turned(25.0), turned(25.0) * turned(-40.0)
    poses = np.array([[0, 0, 0, *R.as_quat(scalar_first=True)] for R in (one, other)])
    p = core.state(poses, angles=np.array([27.0, -42.0, 0, 0]))[0]
    assert_close(core.angles(p)[:2], np.array([25.0, -40.0]), 1e-14)
    axis = 0.3 * np.array(frames[1][0])
    v = np.concatenate([np.zeros(3), axis, np.zeros(3), turned(-40.0).inv().apply(axis) - 1.1 * np.array(frames[1][0])])
    assert_close((core.evaluate(0.0, p, v)["A"] @ v)[-4:-2], np.array([0.3, -1.1]), 1e-13)


def test_forces_do_the_work_that_energy_says(case):
    core, p, v = case
    terms = core.evaluate(0.0, p, v)
    assert_close(terms["f"] @ v, terms["power"] - derivative(lambda p: core.evaluate(0.0, p, v)["V"], core, p, v), NEAR)
    assert abs(terms["d"] @ v) < 1e-12      # gyroscopic forces do none


def test_mass_and_bias_are_those_of_euler(case):
    core, p, v = case
    terms = core.evaluate(0.0, p, v)
    momentum = (np.diag(terms["M"]) * v).reshape(-1, 6)
    assert_close(terms["d"].reshape(-1, 6)[:, 3:], np.cross(v.reshape(-1, 6)[:, 3:], momentum[:, 3:]), 1e-14)
    assert_close(np.diag(terms["M"]), np.concatenate([[body.mass] * 3 + list(body.inertia) for body in core.tables.bodies]), 0.0)


@pytest.mark.parametrize("kind", QUANTITY_KINDS)
def test_quantities(case, kind):
    core, p, v = case
    index = {measure.name: i for i, measure in enumerate(core.measures)}
    value, rate = (core.measure_at(index[f"{kind} {quantity}"], 0.0, p, v) for quantity in ("values", "rates"))

    def read(quantity):
        return derivative(lambda p: core.measure_at(index[f"{kind} {quantity}"], 0.0, p, v)["value"], core, p, v)

    assert_close(rate["value"], value["row"] @ v, 1e-13, scale=1.0)
    assert_close(rate["bias"], read("rates"), NEAR, scale=1.0)
    if kind not in SPEEDS:
        assert_close(value["rate"], read("values"), NEAR, scale=1.0)


def test_components_are_read_without_zeros(case):
    core, p, v = case
    which = [(i, j) for i, measure in enumerate(core.measures) if core.measure_depends(i) != "accelerations"
             for j in range(measure.size)]
    found = components(core, p, v, which)
    assert len(which) >= 2 * len(QUANTITY_KINDS) - len(SPEEDS)
    for (i, j), value, ends, parts in zip(which, *found, strict=True):
        expected, row = core.measure_at(i, 0.0, p, v), np.zeros(core.nv)
        for at, part in zip(ends, parts, strict=True):
            if at >= 0:
                row[at : at + 6] += part
        assert value == expected["value"][j]
        assert_close(row, expected["row"][j], 1e-15, scale=1.0)


def test_quantities_say_what_they_are(case):
    """From poses alone, by other means."""
    core, p, v = case
    poses, _ = core.poses(p)
    R = [Rotation.identity(), *(Rotation.from_quat(q, scalar_first=True) for q in poses[:, 3:])]
    at = [np.zeros(3), *poses[:, :3]]
    for i, quantity in enumerate(core.tables.quantities):
        P = at[quantity.first] + R[quantity.first].apply(quantity.point1)
        Q = at[quantity.second] + R[quantity.second].apply(quantity.point2)
        a, o, b = R[quantity.first].apply(quantity.a), R[quantity.first].apply(quantity.o), R[quantity.second].apply(quantity.b)
        own = R[quantity.second].inv().apply(o)
        expected = {"x": (Q - P)[0], "y": (Q - P)[1], "z": (Q - P)[2], "along": a @ (Q - P), "cosine": a @ b,
                    "angle": np.arctan2(o @ b, a @ b), "distance": np.linalg.norm(Q - P),
                    "clearance": o @ (Q - P) - np.sqrt(np.abs(own @ quantity.shape @ own))}.get(quantity.kind)
        if quantity.kind == "rotation":
            slack = Rotation.from_matrix(np.transpose(quantity.shape))
            expected = a @ (R[quantity.second] * slack * R[quantity.first].inv()).as_rotvec()
        if expected is not None:
            assert_close(core.measure_at(2 * i, 0.0, p, v)["value"][0] + quantity.zero, expected, 1e-13, scale=1.0)


def test_particles_have_places_alone():
    rod = Joint(KINDS["rod"].number, 0, 1, length=1.0)
    ball = Joint(KINDS["spherical"].number, 2, 1, point1=(0.0, 0.0, 0.5))
    core = SpaceCore(Tables([Body(2.0, is_particle=True), Body(1.0, (1.0, 1.0, 1.0))], [rod, ball], gravity=(0.0, 0.0, -1.0)))
    assert (core.nq, core.nv, core.m, core.quaternions) == (10, 9, 4, (6,))
    p = np.array([0.6, 0.0, -0.8, 0.6, 0.0, -1.3, 1.0, 0.0, 0.0, 0.0])
    terms = core.evaluate(0.0, p, np.zeros(9))
    assert_close(terms["Phi"], np.zeros(4), 1e-15, scale=1.0)
    assert_close(terms["C"][0], np.array([0.6, 0.0, -0.8, *np.zeros(6)]), 1e-15)
    assert_close(terms["f"], np.array([0.0, 0, -2, 0, 0, -1, 0, 0, 0]), 1e-15)


@pytest.mark.parametrize(("change", "message"), [
    ({"bodies": []}, "at least one body"),
    ({"bodies": [Body(-1.0)]}, "body 1: its mass must be at least 0, not -1"),
    ({"bodies": [Body(1.0, (1.0, -2.0, 1.0))]}, "body 1: its inertia must be at least 0, not -2"),
    ({"bodies": [Body(1.0, (1.0, 2.0, 1.0), True)]}, "body 1: the inertia of a particle must be 0"),
    ({"joints": [Joint(99, 0, 1)]}, "joint 0: its kind must be from 0 to .*, not 99"),
    ({"joints": [Joint(0, 0, 3)]}, "joint 0: its bodies must be from 0 to 1, not 0 and 3"),
    ({"joints": [Joint(0, 1, 1)]}, "joint 0: its bodies must differ, and both are 1"),
    ({"bodies": [Body(1.0, is_particle=True)], "joints": [Joint(KINDS["spherical"].number, 0, 1, point2=(1.0, 0, 0))]},
     "joint 0: its point on a particle must be the mass centre"),
    ({"quantities": [Quantity("x", 0, 2)]}, "marker quantity 0: its bodies must be from 0 to 1, not 0 and 2"),
    ({"bodies": [Body(1.0, is_particle=True)], "quantities": [Quantity("x", 0, 1, point2=(1.0, 0, 0))]},
     "marker quantity 0: its point on a particle must be the mass centre"),
    ({"quantities": [Quantity("angle", 0, 1, counted=1)]},
     "marker quantity 0: it must count the turns of an angle of a joint, not of angle 0"),
    ({"quantities": [Quantity("x", 0, 0)], "relations": [Relation([0], [1.0])]}, "row 0: it must depend on a body, not"),
])
def test_tables_that_contradict_themselves(change, message):
    with refused("wrong-value", message):
        SpaceCore(Tables(**{"bodies": [Body(1.0, (1.0, 1.0, 1.0))]} | change))


def test_a_kind_of_quantity_that_there_is_not(monkeypatch):
    monkeypatch.setitem(QUANTITY_KINDS, "none", 99)
    with refused("wrong-value", r"marker quantity 0: its kind must be from 0 to \d+, not 99"):
        SpaceCore(Tables([Body(1.0, (1.0, 1.0, 1.0))], quantities=[Quantity("none", 0, 1)]))
