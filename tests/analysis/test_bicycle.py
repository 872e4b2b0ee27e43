"""Whipple's bicycle from its energies: published eigenvalues and matrices; and its steady turn beside certified runs."""

import functools
import json

import numpy as np
import pytest
from scipy.linalg import expm

import zerodrift as zd
from support import ROOT, drawn_in

pytest.importorskip("sympy")
PUBLISHED = json.loads((ROOT / "tests" / "references" / "bicycle_whipple.json").read_text(encoding="utf-8"))


@functools.cache
def symbolic_bicycle():
    from analysis.whipple import whipple

    system = whipple(1.0)
    if not system.compiled:
        pytest.skip("there is no compiler")
    return system


def at_speed(speed):
    system = symbolic_bicycle()
    return zd.linearize(system, (0.0, system.p0, speed * np.asarray(system.v0)))


@pytest.mark.parametrize("speed", range(11))
def test_published_eigenvalues_of_a_bicycle_from_its_energies(speed):
    expected = np.array([complex(float(re), float(im)) for re, im in PUBLISHED["eigenvalues"][str(speed)]])
    lin = at_speed(speed)
    assert len(lin.eigenvalues) == len(expected) == 4
    assert len(lin.ignored) == 6
    assert max(np.abs(lin.eigenvalues - each).min() for each in expected) < 1e-12 * np.abs(expected).max()


@pytest.mark.parametrize("speed", [0.0, 4.6])
def test_published_matrices_of_lean_and_steer(speed):
    """M q'' + v C1 q' + (g K0 + v^2 K2) q = 0; steer is about the axis down, lean to the right."""
    M, C1, K0, K2 = (np.array(PUBLISHED[name], dtype=float) for name in ("M", "C1", "K0", "K2"))
    expected = np.block([[np.zeros((2, 2)), np.eye(2)],
                         [-np.linalg.solve(M, 9.81 * K0 + speed**2 * K2), -np.linalg.solve(M, speed * C1)]])
    assert at_speed(speed).in_coordinates(["lean", "steer"]) == pytest.approx(expected, abs=1e-10 * np.abs(expected).max())


OUTPUTS = ["frame.position.z", "frame.angular_velocity.z", "steer.angle"]       # the same in all frames that turn about z


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_a_bicycle_in_a_steady_turn_against_differences_of_certified_runs(layout):
    turning = zd.models.whipple_bicycle(speed=5.0, roll_rate=0.0)
    eq = zd.equilibrium(turning.system(layout), v={"frame.angular_velocity.z": 0.4})
    lin = zd.linearize(eq.system, eq, outputs=OUTPUTS)
    assert eq["frame.angular_velocity.z"] == pytest.approx(0.4, rel=1e-12)
    assert abs(eq["steer.angle"]) > 0.05
    assert lin.rotation[2] == pytest.approx(0.4, rel=1e-9)
    z = drawn_in(lin.basis, np.random.default_rng(4))
    assert_motion_is_linear(lin, z, 0.1)


def assert_motion_is_linear(lin, z, seconds, apart=1e-4):
    """Outputs along exp(A t) z equal half the difference of two runs from states that are 2 z `apart`."""
    system = lin.system
    dp, dv = np.split(lin.basis @ z, [system.nq])
    times, sols = np.linspace(0, seconds, 5), []
    for sign in (1, -1):
        start = zd.project(system, lin.p + sign * apart * dp, lin.v + sign * apart * dv, projection=zd.Projection(tol=1e-13))
        ref = zd.reference(system, seconds, *start, t_eval=times, error=1e-10).solution
        sols.append(ref)
    for name, row in zip(lin.outputs, lin.C, strict=True):
        found = np.array([row @ expm(lin.A * t) @ z for t in times])
        expected = (sols[0][name] - sols[1][name]) / (2 * apart)
        assert found == pytest.approx(expected, abs=2e-6 * np.abs(expected).max()), name      # 1e-10 over 1e-4, and apart^2


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_a_precessing_top_against_differences_of_certified_runs(layout):
    mass, distance, axial, spin = 15.0, 1.0, 0.46875, 150.0
    top = zd.models.heavy_top(spin=spin, precession=mass * 9.81 * distance / (axial * spin))
    lin = zd.linearize(top.system(layout), outputs=["top.center.position.z", "top.angular_velocity.z"])
    assert not lin.rate.any()
    assert_motion_is_linear(lin, drawn_in(lin.basis, np.random.default_rng(4)), 0.1)


def test_the_steer_torque_that_holds_a_turn_is_that_of_the_published_stiffness():
    """(g K0 + v^2 K2) (lean, steer) = (0, torque) in a wide turn; yaw rate = v cos(tilt) steer / wheel base."""
    speed, yaw_rate = 4.6, 0.002
    K0, K2 = (np.array(PUBLISHED[name], dtype=float) for name in ("K0", "K2"))
    K = 9.81 * K0 + speed**2 * K2
    bicycle = zd.models.whipple_bicycle(speed=speed)
    eq = zd.equilibrium(bicycle, v={"rear axle.speed": -speed / 0.3, "frame.angular_velocity.z": yaw_rate}, hold=["steer.angle"])
    assert eq["rear axle.speed"] == pytest.approx(-speed / 0.3, rel=1e-12)
    assert abs(eq["steer.angle"]) == pytest.approx(yaw_rate * 1.02 / (speed * np.cos(np.pi / 10)), rel=1e-5)     # angles squared
    assert eq.effort["steer.angle"] / eq["steer.angle"] == pytest.approx(K[1, 1] - K[1, 0] * K[0, 1] / K[0, 0], rel=1e-5)
    lin = zd.linearize(bicycle, eq)
    assert not lin.rate.any()
    assert lin.rotation[2] == pytest.approx(yaw_rate, rel=1e-6)


@pytest.mark.parametrize(("value", "error"), [(float("nan"), "must be finite"), ("fast", "must be a real number"),
                                              ([1.0, 2.0], "must have shape")])
def test_speeds_of_a_steady_motion_are_checked(value, error):
    with pytest.raises((ValueError, TypeError), match=rf"v\['rear axle\.speed'\] {error}"):
        zd.equilibrium(zd.models.whipple_bicycle(), v={"rear axle.speed": value})


def test_hands_free_turns_have_one_speed_for_each_radius():
    bicycle = zd.models.whipple_bicycle()
    with pytest.raises(zd.EquilibriumFailed, match=r"most at '.*'; prescribe more speeds or fewer in v=, name in hold="):
        zd.equilibrium(bicycle, v={"rear axle.speed": -4.6 / 0.3, "frame.angular_velocity.z": 0.2})


def test_rotations_are_coordinates_of_a_linearization():
    K0, K2, M, C1 = (np.array(PUBLISHED[name], dtype=float) for name in ("K0", "K2", "M", "C1"))
    speed = 4.6
    lin = zd.linearize(zd.models.whipple_bicycle(), v={"rear axle.speed": -speed / 0.3})
    A = lin.in_coordinates(["frame rotation about x", "steer.angle"])
    assert A[2:, :2].diagonal() == pytest.approx(-np.linalg.solve(M, 9.81 * K0 + speed**2 * K2).diagonal(), rel=1e-8)
    assert A[2:, 2:].diagonal() == pytest.approx(-np.linalg.solve(M, speed * C1).diagonal(), rel=1e-8)
