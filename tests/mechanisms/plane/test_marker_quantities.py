"""Marker quantities against what they are said to be, in NumPy, and the tables of joints and elements."""

import numpy as np
import pytest

import tolerances as tol
from many_bodies import components
from mechanism_tables import KINDS, TREE, Body, OutputSpec, Quantity, Tabled, Tables, rotation
from support import along, assert_close
from zerodrift._private.gateway.mechanisms.plane import QUANTITY_KINDS, element_kinds

FIRST, SECOND, AXIS, ZERO = (0.3, -0.4), (-0.2, 0.7), (0.6, 0.8), 0.25
INTEGRABLE = sorted(QUANTITY_KINDS.keys() - {"glide", "skid", "shear", "orbit"})


def points(poses):
    """P, Q, e and n of two bodies."""
    (r1, a1), (r2, a2) = ((pose[:2], pose[2]) for pose in poses)
    e = rotation(a1) @ AXIS
    return r1 + rotation(a1) @ FIRST, r2 + rotation(a2) @ SECOND, e, np.array([-e[1], e[0]])


READINGS = {
    "x": lambda poses: (points(poses)[1] - points(poses)[0])[0],
    "y": lambda poses: (points(poses)[1] - points(poses)[0])[1],
    "angle": lambda poses: poses[1][2] - poses[0][2],
    "along": lambda poses: (points(poses)[1] - points(poses)[0]) @ points(poses)[2],
    "across": lambda poses: (points(poses)[1] - points(poses)[0]) @ points(poses)[3],
    "distance": lambda poses: np.linalg.norm(points(poses)[1] - points(poses)[0]),
}


def quantityd(which, first=1, second=2):
    """Two free bodies, and measures of a marker quantity between them."""
    quantity = Quantity(which, first, second, FIRST, SECOND, AXIS, ZERO)
    measures = [OutputSpec(name, "", name, 0, scale=-2.0) for name in ("values", "rates", "accelerations")]
    return Tabled(Tables([Body(1, 1), Body(1, 1)], quantities=[quantity], measures=measures))


@pytest.fixture
def state():
    rng = np.random.default_rng(7)
    return rng.normal(size=6), rng.normal(size=6), rng.normal(size=6)


def test_readings_are_there_for_all_kinds():
    assert sorted(READINGS) == INTEGRABLE


@pytest.mark.parametrize("which", INTEGRABLE)
def test_a_quantity_reads_what_it_says(which, state):
    p, v, vdot = state
    system = quantityd(which)

    def value(p):
        return np.array([-2 * (READINGS[which](p.reshape(2, 3)) - ZERO)])

    assert_close(system.measured("values", 0, p, v), value(p), tol.SAME, scale=1)
    assert_close(system.measured("rates", 0, p, v), along(value, (p, v)), tol.DIFFERENCE, scale=1)
    rate = along(lambda p, v: system.measured("rates", 0, p, v), (p, v), (v, vdot))
    assert_close(system.measured("accelerations", 0, p, v, vdot), rate, tol.DIFFERENCE, scale=1)


@pytest.mark.parametrize(("which", "direction"), [("glide", 2), ("skid", 3)])
@pytest.mark.parametrize("ends", [(1, 2), (2, 2), (0, 1)])
def test_a_gliding_point_is_measured_along_an_axis_of_the_first_body(which, direction, ends, state):
    p, v, vdot = state
    system = quantityd(which, *ends)
    first, second = ends

    def frame(p):
        poses = np.vstack([np.zeros(3), p.reshape(2, 3)])
        return points([poses[first], poses[second]])

    speed = along(lambda p: frame(p)[1], (p, v))
    assert_close(system.measured("rates", 0, p, v), np.array([-2 * frame(p)[direction] @ speed]), tol.DIFFERENCE, scale=1)
    rate = along(lambda p, v: system.measured("rates", 0, p, v), (p, v), (v, vdot))
    assert_close(system.measured("accelerations", 0, p, v, vdot), rate, tol.DIFFERENCE, scale=1)


@pytest.mark.parametrize("ends", [(1, 2), (0, 1)])
def test_shear_is_the_velocity_of_a_point_relative_to_the_first_body_there(ends, state):
    p, v, vdot = state
    system, bodies = quantityd("shear", *ends), [np.vstack([np.zeros(3), x.reshape(2, 3)]) for x in (p, v)]
    (_, (q, qdot)), (r, rdot) = (tuple(each[end] for each in bodies) for end in ends), (each[ends[0]] for each in bodies)
    arm = rotation(q[2]) @ SECOND
    there = q[:2] + arm - r[:2]
    speed = qdot[:2] + qdot[2] * np.array([-arm[1], arm[0]]) - rdot[:2] - rdot[2] * np.array([-there[1], there[0]])
    assert_close(system.measured("rates", 0, p, v), np.array([-2 * np.array(AXIS) @ speed]), tol.SAME, scale=1)
    rate = along(lambda p, v: system.measured("rates", 0, p, v), (p, v), (v, vdot))
    assert_close(system.measured("accelerations", 0, p, v, vdot), rate, tol.DIFFERENCE, scale=1)


@pytest.mark.parametrize("which", sorted(QUANTITY_KINDS))
def test_a_measure_tells_its_row_and_bias(which, state):
    p, v, vdot = state
    system = quantityd(which)
    of_rate, acceleration = system._core.measure_at(1, 0.0, p, v), system.measured("accelerations", 0, p, v, vdot)
    assert_close(of_rate["row"] @ v, of_rate["value"], tol.SAME, scale=1)
    assert_close(of_rate["row"] @ vdot + of_rate["bias"], acceleration, tol.SAME, scale=1)
    of_value = system._core.measure_at(0, 0.0, p, v)
    assert_close(of_value["rate"], of_rate["value"], tol.SAME)
    assert np.array_equal(of_value["row"], of_rate["row"])
    assert [system._core.measure_depends(i) for i in range(3)] == ["positions", "velocities", "accelerations"]


@pytest.mark.parametrize("which", sorted(QUANTITY_KINDS))
@pytest.mark.parametrize("ends", [(1, 2), (2, 2), (0, 1)])
def test_components_are_read_without_zeros(which, ends, state):
    p, v, _ = state
    core = quantityd(which, *ends)._core
    found = components(core, p, v, [(1, 0), (0, 0)])
    for i, measure in enumerate((1, 0)):
        expected, row = core.measure_at(measure, 0.0, p, v), np.zeros(core.nv)
        for at, part in zip(found.at[i], found.row[i], strict=True):
            if at >= 0:
                row[at : at + 3] += part
        assert found.value[i] == expected["value"][0]
        assert_close(row, expected["row"][0], tol.SAME)


# ---- the tables ----


def test_the_tables_introduce_their_rows():
    for table in (KINDS, element_kinds()):
        for name, row in table.items():
            assert row.card.name == name
            assert row.card.summary.endswith(".")
            assert row.card.equations
    assert {name: KINDS[name].inboard for name in TREE} == {"revolute": "turns", "prismatic": "slides", "weld": "fixed"}


@pytest.mark.parametrize("name", TREE)
def test_rows_and_coordinate_of_a_tree_joint_make_three(name):
    """Constraints and coordinate of a tree joint add up to the three relative freedoms of two bodies in the plane."""
    assert len(KINDS[name].rows) + (KINDS[name].inboard != "fixed") == 3


def test_holonomic_rows_come_first():
    for row in KINDS.values():
        flags = [one.nonholonomic for one in row.rows]
        assert flags == sorted(flags)
