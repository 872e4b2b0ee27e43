"""Angles of joints in space count turns: in measures, springs, drives, couplings, events and starts, by all formulations."""

import numpy as np
import pytest

import zerodrift as zd
from support import assert_close, refused
from tolerances import SAME
from zerodrift.mechanisms.elements.frames import about

R = about((0.3, 0.6, -0.2), 0.7)        # so that no axis of a mechanism is one of the drawing's
AXIS = R[:, 2]
EXACT = {"integrator": "dop853", "step": None, "rtol": 1e-11, "atol": 1e-11}


def wheels(count=1, **drawn):
    """Wheels on parallel axles, each with 0.5 kg m^2 about it."""
    m = zd.Mechanism("wheels", dimension=3, **drawn)
    for i in range(count):
        wheel = m.body(f"wheel{i}", 2.0, (0.3, 0.3, 0.5), at=R @ (i, 0, 0), rotation=R)
        m.revolute(f"pin{i}", m.ground, wheel.point((0, 0, 0)), axis=AXIS)
    return m


def flat(count=1):
    """The same in the plane."""
    m = zd.Mechanism("wheels")
    for i in range(count):
        m.revolute(f"pin{i}", m.ground, m.body(f"wheel{i}", 2.0, 0.5, at=(i, 0)).point((0, 0)))
    return m


def test_a_wheel_that_runs(formulation):
    """From rows that are turns apart, whatever is between them."""
    m = wheels()
    m.start({"pin0.speed": 7.0})
    sol = zd.simulate(m, 9.0, t_eval=[0.0, 2.0, 9.0], formulation=formulation, step=0.05, integrator="dop853")
    assert_close(sol["pin0.angle"], 7.0 * sol.t, 1e-9)
    assert_close(sol.p[:, -1], sol["pin0.angle"], SAME)
    assert sol.system.coordinates[-1] == ("pin0.angle", "rad")


def test_steps_of_more_than_half_a_turn():
    """No turn is lost as long as the motion is followed: here by 0.6 of a turn and more in each step."""
    m = wheels()
    m.start({"pin0.speed": 20.0})
    sol = zd.simulate(m, 6.0, step=0.2, integrator="dop853")
    assert_close(sol["pin0.angle"], 120.0 * sol.t / 6, 1e-3)
    coarse = zd.simulate(m, 6.0, step=0.05, integrator="rk4")
    assert abs(coarse["pin0.angle"][-1] - 120.0) < 1.0


def test_turns_are_counted_between_two_bodies():
    """The angle of a wheel on a tumbling body is the integral of the wheel's speed relative to it."""
    m = zd.Mechanism("gyrostat", dimension=3)
    body = m.body("body", 3.0, (0.4, 0.5, 0.6))
    wheel = m.body("wheel", 1.0, (0.1, 0.1, 0.2), rotation=R)
    m.revolute("axle", body, wheel, at=(0, 0, 0), axis=AXIS)
    m.start({"body.angular_velocity": (3.0, 1.0, -2.0), "axle.speed": -9.0})
    sol = zd.simulate(m, 5.0, step=2e-3, formulation="schur")
    summed = np.concatenate([[0], np.cumsum((sol["axle.speed"][1:] + sol["axle.speed"][:-1]) / 2 * np.diff(sol.t))])
    assert_close(sol["axle.angle"], summed, 1e-5)
    assert np.ptp(sol["axle.angle"]) > 6 * np.pi


def test_arms_of_a_cross_that_turn_over():
    """A gimbal of a cross without mass: its second arm spins, while the first swings."""
    m = zd.Mechanism("gimbal", dimension=3)
    rotor = m.body("rotor", 1.0, (0.2, 0.1, 0.1))
    m.universal("cross", m.ground, rotor, at=(0, 0, 0), axes=((0, 0, 1), (1, 0, 0)))
    m.start({"cross.angle1_speed": 0.3, "cross.angle2_speed": 12.0})
    sol = zd.simulate(m, 3.0, **EXACT)
    for angle in ("angle1", "angle2"):
        change = (sol[f"cross.{angle}_speed"][1:] + sol[f"cross.{angle}_speed"][:-1]) / 2 * np.diff(sol.t)
        assert_close(np.diff(sol[f"cross.{angle}"]), change, 0.02)
    assert sol["cross.angle2"][-1] > 10 * np.pi


@pytest.mark.parametrize("damping", [0.0, 0.3])
def test_a_torsion_pendulum_over_several_turns(formulation, damping):
    """From five turns on: theta'' = -(k theta + c theta') / I."""
    m = wheels()
    m.torsion_spring("wire", "pin0", stiffness=2.0, angle=1.0, damping=damping)
    m.start({"pin0.angle": 1.0 + 10 * np.pi})
    sol = zd.simulate(m, 4.0, step=0.02, integrator="dop853", formulation=formulation)
    decay, fast = damping / (2 * 0.5), np.sqrt(2.0 / 0.5 - (damping / (2 * 0.5)) ** 2)
    theta = 10 * np.pi * np.exp(-decay * sol.t) * (np.cos(fast * sol.t) + decay / fast * np.sin(fast * sol.t))
    assert_close(sol["pin0.angle"] - 1.0, theta, 1e-7)
    assert_close(sol["wire.torque"], -2.0 * (sol["pin0.angle"] - 1.0) - damping * sol["pin0.speed"], 1e-12)
    assert np.abs(sol.energy_violation).max() < 1e-5 * 2.0 * (10 * np.pi) ** 2


def coupled(m):
    """Three wheels coupled by their angles, in the plane or in space."""
    m.gear("teeth", "pin0", "pin1", ratio=-np.sqrt(2))
    m.coupler("law", lambda a, b: b - a - 0.1 * np.sin(a) ** 2, of={"a": "pin1.angle", "b": "pin2.angle"})
    m.torsion_spring("coil", "pin2", stiffness=0.2, damping=0.05)
    m.motor("drive", "pin0", torque=lambda t: 12 * np.cos(0.5 * t))
    return m


@pytest.mark.parametrize("wanted", ["schur", "independent"])
def test_couplings_over_many_turns_are_those_of_the_plane(wanted):
    """A gear whose ratio is that of no whole numbers, and a law of angles."""
    space, plane = (zd.simulate(system, 4.0, step=0.05, integrator="dop853", formulation=wanted)
                    for system in (coupled(wheels(3)), coupled(flat(3)).system("absolute")))
    for name in ("pin0.angle", "pin1.angle", "pin2.angle", "teeth.torque", "law.torque", "coil.torque"):
        assert_close(space[name], plane[name], 1e-5)
    assert np.ptp(space["pin1.angle"]) > 6 * np.pi


def valve(m, up, **guided):
    """A cam of a table that lifts a valve, at constant speed."""
    lift = m.body("valve", 0.4, (0.1, 0.1, 0.1) if m.dimension == 3 else 0.1, at=up)
    m.prismatic("lift", m.ground, lift, axis=up, **guided)
    angles = np.linspace(0, 2 * np.pi, 24, endpoint=False)
    m.cam("cam", "pin0", "lift", profile=(angles, 0.01 * np.exp(np.cos(angles))))
    m.motor("drive", "pin0", speed=15.0)
    return m


def test_a_cam_over_many_turns():
    sol = zd.simulate(valve(wheels(), R @ (0, 1, 0)), 2.0, step=0.01)
    twin = zd.simulate(valve(flat(), (0.0, 1.0)).system("absolute"), 2.0, step=0.01)
    angle = 15.0 * sol.t
    assert_close(sol["pin0.angle"], angle, 1e-10)
    assert_close(sol["lift.displacement"] - sol["lift.displacement"][0], 0.01 * (np.exp(np.cos(angle)) - np.e), 1e-5, scale=0.02)
    for name in ("lift.displacement", "cam.force", "cam.cam_torque", "drive.torque"):
        assert_close(sol[name], twin[name], 1e-7)


def test_a_start_many_turns_on():
    m = wheels()
    m.start({"pin0.angle": 20.0})
    assert_close(m.system().p0[-1:], np.array([20.0]), 1e-12)
    m = wheels()
    m.motor("drive", "pin0", angle=lambda t: 20.0 + t)
    assert_close(zd.simulate(m, 0.1, step=0.05)["pin0.angle"], np.array([20.0, 20.05, 20.1]), 1e-11)


def test_events_of_angles():
    m = wheels()
    m.motor("drive", "pin0", speed=2.0)
    events = [zd.Event("pin0.angle", value=7.0), zd.Event(lambda a: np.sin(a), of={"a": "pin0.angle"})]
    sol = zd.simulate(m, 5.0, step=0.02, events=events)
    assert_close(sol.t_events[0], np.array([3.5]), 1e-10)
    assert_close(sol.t_events[1][-3:], np.pi * np.array([1, 2, 3]) / 2, 1e-10)


def test_a_screw_whose_angle_is_driven():
    """Through five turns, each as far on as its pitch says."""
    m = zd.Mechanism("bolt", dimension=3)
    bolt = m.body("bolt", 1.0, (0.1, 0.2, 0.2), rotation=R)
    m.screw("thread", m.ground, bolt, axis=AXIS, pitch=0.01)
    m.motor("drive", "thread", angle=lambda t: 31.0 * t)
    sol = zd.simulate(m, 1.0, step=0.01)
    assert_close(sol["thread.displacement"], 0.01 * 31.0 * sol.t / (2 * np.pi), 1e-10)
    assert_close(sol["bolt.position"], np.outer(sol["thread.displacement"], AXIS), 1e-11, scale=0.05)


def test_a_saved_state_has_its_turns():
    """A run goes on from a row with the same bits."""
    m = wheels()
    m.torsion_spring("wire", "pin0", stiffness=2.0)
    m.start({"pin0.angle": 25.0})
    system = m.system()
    whole = zd.simulate(system, 1.0, step=0.01)
    rest = zd.simulate(system, (0.5, 1.0), whole.p[50], whole.v[50], step=0.01)
    assert_close(rest["pin0.angle"], whole["pin0.angle"][50:], SAME)


def test_what_follows_cannot_be_held():
    system = wheels().system("absolute")
    with refused("wrong-measure", r"'pin0\.angle'"):
        zd.assemble(system, system.p0, hold=("pin0.angle",))
    assert_close(zd.assemble(system, system.p0, hold=("wheel0.x",))[0], system.p0, SAME)


def test_the_kinematic_matrix_has_the_rates_of_angles():
    system = wheels(2).system("absolute")
    v = np.random.default_rng(0).normal(size=system.nv)
    A = system.evaluate().A
    assert_close(system.product("A", v), A @ v, SAME)
    x = np.random.default_rng(1).normal(size=system.nq)
    assert_close(system.product("A", x, transposed=True), A.T @ x, SAME)
    assert_close((A @ v)[-2:], v.reshape(2, 6)[:, 5], SAME)


@pytest.mark.parametrize("swapped", [False, True])
def test_joint_coordinates_count_the_same_turns(swapped):
    """Springs, laws and starts, of joints that are taken forwards and backwards."""
    m = zd.Mechanism("pair", dimension=3)
    wheel, hand = m.body("wheel", 2.0, (0.3, 0.3, 0.5), rotation=R), m.body("hand", 0.5, (0.1, 0.1, 0.1), rotation=R)
    m.revolute("pin", m.ground, wheel, at=(0, 0, 0), axis=AXIS)
    m.revolute("on", *((wheel, hand) if not swapped else (hand, wheel)), at=(0, 0, 0), axis=AXIS)
    m.torsion_spring("wire", "on", stiffness=0.5)
    m.coupler("law", lambda a, b: b - 0.5 * a - 0.1 * np.sin(a), of={"a": "pin.angle", "b": "on.angle"})
    m.start({"pin.angle": 30.0, "pin.speed": 1.0})
    sols = [zd.simulate(m.system(layout), 1.0, step=0.02, integrator="dop853") for layout in ("absolute", "joint")]
    for name in ("pin.angle", "on.angle", "wire.torque", "law.torque"):
        assert_close(sols[1][name], sols[0][name], 1e-8)
    assert abs(sols[1]["on.angle"][0]) > 4 * np.pi
