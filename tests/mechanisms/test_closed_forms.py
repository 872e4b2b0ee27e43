"""Joints, drives and forces against what is known of them in closed form, with their reactions, in both coordinates."""

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from mechanism_tables import (
    Body,
    GeneralizedForce,
    Joint,
    OutputSpec,
    Quantity,
    Relation,
    Tabled,
    Tables,
    in_absolute_coordinates,
    kind,
)
from support import assert_close

pytestmark = pytest.mark.parametrize("absolute", [False, True], ids=["joint", "absolute"])
FORCE, TORQUE = OutputSpec("force", "N", "joint force", 0), OutputSpec("torque", "N m", "joint torque", 0)


class Scene:
    """A mechanism at a state: its accelerations and measures there."""

    def __init__(self, absolute, tables, poses, rates, law=None, t=0.0, **options):
        self.system = Tabled(tables, law=law, **options)
        core = self.system._core
        self.system.p0, self.system.v0 = core.state(np.array(poses, dtype=float), np.array(rates, dtype=float))
        if absolute:
            self.system = in_absolute_coordinates(self.system, law, **options)
        system, self.t = self.system, t
        e = system.evaluate(t=t)
        psi = e.C @ system.v0 + (0 if e.Phi_t is None else e.Phi_t) if system.m else np.zeros(1)
        assert np.abs(psi).max() < tol.START
        if system.mh:
            assert np.abs(e.Phi).max() < tol.START
        self.vdot, self.multipliers = zd.acceleration(system, system.p0, system.v0, t, formulation="augmented")

    def __getitem__(self, name):
        return self.system.measured(name, self.t, self.system.p0, self.system.v0, self.vdot, self.multipliers)

    def close(self, **expected):
        for name, value in expected.items():
            assert_close(self[name], np.atleast_1d(np.asarray(value, dtype=float)), tol.REACTION, scale=1, what=name)


@pytest.mark.parametrize("swapped", [False, True])
def test_a_pendulum_pulls_at_its_pin(absolute, swapped):
    """Newton: F = m (a - g), for the ground as the first or as the second body of the joint."""
    m, J, c, angle, rate, g = 2.0, 0.3, 0.7, 0.4, 1.5, np.array([1.0, -9.81])
    e, n = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    joint = Joint(kind("revolute"), 0, 1, (0.2, 0.1), (-c, 0.0))
    if swapped:
        joint = joint._replace(first=1, second=0, point1=joint.point2, point2=joint.point1)
    scene = Scene(absolute, Tables([Body(m, J, inboard=0)], [joint], gravity=tuple(g), measures=[FORCE, TORQUE]),
                  [[*((0.2, 0.1) + c * e), angle]], [[*(c * rate * n), rate]])
    alpha = m * c * (n @ g) / (J + m * c**2)
    force = m * (c * alpha * n - c * rate**2 * e - g)
    scene.close(force=-force if swapped else force, torque=0)


@pytest.mark.parametrize("swapped", [False, True])
def test_a_bead_on_a_turning_arm(absolute, swapped):
    """A drive at constant speed: rddot = w^2 r, across m 2 w rdot, the drive's torque 2 m w r rdot; either way round."""
    m, r, rdot, w, angle = 1.5, 0.8, 0.6, 2.0, 0.3
    e, n = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    slide = Joint(kind("prismatic"), 1, 2, along=0.1, angle=0.25)
    if swapped:
        slide = slide._replace(first=2, second=1, axis=(-np.cos(0.25), np.sin(0.25)), angle=-0.25)
    quantities = [Quantity("angle", 0, 1), Quantity("along", *slide[1:3], axis=slide.axis, zero=0.1)]
    measures = [FORCE, TORQUE, OutputSpec("drive", "N m", "drive", 0), OutputSpec("power", "W", "drive power", 0),
                OutputSpec("main torque", "N m", "joint torque", 1), OutputSpec("displacement", "m", "values", 1),
                OutputSpec("acceleration", "m/s^2", "accelerations", 1)]
    tables = Tables([Body(1.0, 0.4, inboard=1), Body(m, 0.2, inboard=0)], [slide, Joint(kind("revolute"), 0, 1)], quantities,
                    [Relation([0], [1.0], constant=angle, slope=w, joint=1)], measures=measures)
    scene = Scene(absolute, tables, [[0, 0, angle], [*(r * e), angle + 0.25]], [[0, 0, w], [*(rdot * e + w * r * n), w]])
    force = 2 * m * w * rdot * n
    scene.close(displacement=r - 0.1, acceleration=w**2 * r, drive=2 * m * w * r * rdot, power=2 * m * w**2 * r * rdot)
    scene.close(force=-force if swapped else force, torque=-r * 2 * m * w * rdot if swapped else 0)
    scene.close(**{"main torque": 2 * m * w * r * rdot})


def test_a_wheel_rolls_down_a_slope(absolute):
    """A third of the weight's pull is friction; both act at the contact, so that there is no torque."""
    m, R, slope, v = 3.0, 0.4, 0.3, 1.2
    e, n = np.array([np.cos(slope), -np.sin(slope)]), np.array([np.sin(slope), np.cos(slope)])
    joint = Joint(kind("rolling"), 0, 1, (0.5, 0.2), axis=tuple(e), length=R, angle=0.7)
    scene = Scene(absolute, Tables([Body(m, m * R**2 / 2)], [joint], [Quantity("along", 0, 1, axis=tuple(e))],
                                   gravity=(0.0, -9.81),
                                   measures=[FORCE, TORQUE, OutputSpec("acceleration", "", "accelerations", 0)]),
                  [[*((0.5, 0.2) + R * n), 0.7]], [[*(v * e), -v / R]])
    pull = m * 9.81 * np.sin(slope)
    scene.close(acceleration=2 / 3 * pull / m, force=m * 9.81 * np.cos(slope) * n - pull / 3 * e, torque=0)


def test_a_weld_holds_force_and_torque(absolute):
    """A bar that turns at constant speed without gravity holds the bar welded to it by m w^2 r inward."""
    m, w, angle = 2.0, 3.0, 0.6
    e = np.array([np.cos(angle), np.sin(angle)])
    joints = [Joint(kind("weld"), 1, 2, (0.5, 0.0), (-0.3, 0.1), angle=0.4), Joint(kind("revolute"), 0, 1)]
    to_second = np.array([0.5, 0]) - [np.cos(0.4) * -0.3 - np.sin(0.4) * 0.1, np.sin(0.4) * -0.3 + np.cos(0.4) * 0.1]
    turned = np.array([[e[0], -e[1]], [e[1], e[0]]])
    at = turned @ to_second
    tables = Tables([Body(1.0, 1.0, inboard=1), Body(m, 0.5, inboard=0)], joints, measures=[FORCE, TORQUE])
    scene = Scene(absolute, tables, [[0, 0, angle], [*at, angle + 0.4]], [[0, 0, w], [-w * at[1], w * at[0], w]])
    force = -m * w**2 * at
    arm = at - turned @ [0.5, 0]
    scene.close(force=force, torque=arm[0] * force[1] - arm[1] * force[0])


def test_a_particle_at_a_revolute(absolute):
    """It adds its mass at the point, and has a force but no angle."""
    m, M, J, c, length, w = 0.7, 1.2, 0.2, 0.5, 0.9, 2.5
    joints = [Joint(kind("revolute"), 1, 2, (length - c, 0.0)), Joint(kind("revolute"), 0, 1, point2=(-c, 0.0))]
    tables = Tables([Body(M, J, inboard=1), Body(m, is_particle=True, inboard=0)], joints, gravity=(0.0, -9.81),
                    measures=[FORCE, TORQUE])
    scene = Scene(absolute, tables, [[c, 0, 0], [length, 0, 0]], [[0, c * w, w], [0, length * w, 0]])
    alpha = -9.81 * (M * c + m * length) / (J + M * c**2 + m * length**2)
    scene.close(force=[-m * length * w**2, m * (length * alpha + 9.81)], torque=0)


def test_springs_dampers_and_their_measures(absolute):
    """A particle on a spring with a damper, measured in tension; the damper's joint has its part in the joint's force."""
    m, k, c, x, v = 1.5, 20.0, 3.0, 0.9, -0.7
    quantities = [Quantity("distance", 0, 1, zero=0.5), Quantity("along", 0, 2)]
    measures = [FORCE, OutputSpec("tension", "N", "force value", 0, scale=-1.0), OutputSpec("power", "W", "force power", 1),
                OutputSpec("acceleration", "", "accelerations", 1)]
    tables = Tables([Body(m, is_particle=True), Body(2.0, 1.0, inboard=0)], [Joint(kind("prismatic"), 0, 2)], quantities, (),
                    [GeneralizedForce("spring", 0, k, c), GeneralizedForce("spring", 1, damping=c, joint=0)], measures,
                    (0.0, -2.0))
    scene = Scene(absolute, tables, [[x, 0, 0], [x, 0, 0]], [[v, 0, 0], [v, 0, 0]])
    scene.close(tension=k * (x - 0.5) + c * v, power=-c * v**2, acceleration=-c * v / 2.0, force=[-c * v, 4.0])
    e = scene.system.evaluate()
    assert pytest.approx(k * (x - 0.5) ** 2 / 2, rel=tol.SAME) == e.V
    assert e.power == pytest.approx(-2 * c * v**2, rel=tol.SAME)


def test_a_slot_and_a_rod(absolute):
    """A particle in a slot, pulled by a rod from above: statics, and what the rod adds when it moves."""
    m, height, length, v = 2.0, 0.6, 1.0, 0.5
    x = np.sqrt(length**2 - height**2)
    joints = [Joint(kind("slot"), 0, 1), Joint(kind("rod"), 0, 2, (x, height), length=height),
              Joint(kind("slot"), 0, 2, (x, 0.0), axis=(0, 1))]
    tables = Tables([Body(m, is_particle=True), Body(m, is_particle=True)], joints, gravity=(1.0, -9.81),
                    measures=[FORCE, TORQUE, OutputSpec("tension", "N", "joint tension", 1),
                              OutputSpec("rod", "N", "joint force", 1)])
    scene = Scene(absolute, tables, [[0.3, 0, 0], [x, 0, 0]], [[v, 0, 0], [0, 0, 0]])
    scene.close(force=[0, m * 9.81], torque=0, tension=m * 9.81, rod=[0, m * 9.81])


def test_gears_and_racks_are_relations(absolute):
    """Torque on the first of two wheels in gear, the second drives a rack: one inertia, as seen from the first."""
    J1, J2, m, ratio, radius, torque = 0.3, 0.8, 2.0, -0.5, 0.2, 4.0
    joints = [Joint(kind("revolute"), 0, 1), Joint(kind("revolute"), 0, 2, (1.0, 0.0)),
              Joint(kind("prismatic"), 0, 3, axis=(0.0, 1.0))]
    quantities = [Quantity("angle", 0, 1), Quantity("angle", 0, 2), Quantity("along", 0, 3, axis=(0.0, 1.0))]
    relations = [Relation([1, 0], [1.0, -ratio]), Relation([2, 1], [1.0, -radius])]
    measures = [OutputSpec("alpha", "", "accelerations", 0), OutputSpec("rack", "", "accelerations", 2),
                OutputSpec("tooth", "N", "drive", 1)]
    tables = Tables([Body(1.0, J1, inboard=0), Body(1.0, J2, inboard=1), Body(m, 1.0, inboard=2)], joints, quantities, relations,
                    [GeneralizedForce("constant", 0, value=torque)], measures)
    scene = Scene(absolute, tables, [[0, 0, 0], [1, 0, 0], [0, 0, 0]], np.zeros((3, 3)))
    alpha = torque / (J1 + ratio**2 * (J2 + radius**2 * m))
    scene.close(alpha=alpha, rack=radius * ratio * alpha, tooth=m * radius * ratio * alpha)


def test_a_cam_is_a_law_of_an_angle(absolute):
    """A follower at lift h (1 - cos a): on a cam at constant speed its force is m h w^2 cos a + m g."""
    m, h, w, a = 1.1, 0.05, 7.0, 0.8

    def law(number, t, x, xdot):
        angle, rate = x[1], xdot[1]
        return [x[0] - h * (1 - np.cos(angle)), 1.0, -h * np.sin(angle), 0.0, -h * np.cos(angle) * rate**2]

    joints = [Joint(kind("revolute"), 0, 1), Joint(kind("prismatic"), 0, 2, axis=(0.0, 1.0))]
    quantities = [Quantity("angle", 0, 1), Quantity("along", 0, 2, axis=(0.0, 1.0))]
    relations = [Relation([1, 0], law=0), Relation([0], [1.0], constant=a, slope=w, joint=0)]
    measures = [OutputSpec("contact", "N", "drive", 0), OutputSpec("torque", "N m", "drive", 1)]
    tables = Tables([Body(1.0, 0.1, inboard=0), Body(m, 1.0, inboard=1)], joints, quantities, relations, (),
                    measures, (0.0, -9.81))
    lift, rate = h * (1 - np.cos(a)), h * np.sin(a) * w
    scene = Scene(absolute, tables, [[0, 0, a], [0, lift, 0]], [[0, 0, w], [0, rate, 0]], law, laws_know_time=False)
    contact = m * (h * w**2 * np.cos(a) + 9.81)
    scene.close(contact=contact, torque=contact * rate / w)


def test_a_speed_that_is_a_function_of_time_and_of_measures(absolute):
    """A nonholonomic drive, rate = 2 + sin t + 3 x of another body's place: its torque is J d/dt of that."""
    J, t, x, xdot = 0.6, 0.9, 0.4, -1.1

    def law(number, t, values, rates):
        return [0.0, 1.0, 0.0, -(2 + np.sin(t) + 3 * values[1]), -(np.cos(t) + 3 * rates[1])]

    quantities = [Quantity("angle", 0, 1), Quantity("x", 0, 2)]
    tables = Tables([Body(1.0, J, inboard=0), Body(1.0, is_particle=True)], [Joint(kind("revolute"), 0, 1)],
                    quantities, [Relation([0, 1], nonholonomic=True, law=0, joint=0)],
                    measures=[TORQUE, OutputSpec("drive", "N m", "drive", 0)])
    scene = Scene(absolute, tables, [[0, 0, 0.2], [x, 0, 0]], [[0, 0, 2 + np.sin(t) + 3 * x], [xdot, 0, 0]], law, t)
    torque = J * (np.cos(t) + 3 * xdot)
    scene.close(torque=torque, drive=torque)


def test_a_constant_speed_may_be_nonholonomic(absolute):
    """Without a law: sum of rates = constant + slope t."""
    tables = Tables([Body(1.0, 0.5, inboard=0)], [Joint(kind("revolute"), 0, 1)], [Quantity("angle", 0, 1)],
                    [Relation([0], [2.0], 3.0, 4.0, nonholonomic=True, joint=0)], measures=[TORQUE])
    scene = Scene(absolute, tables, [[0, 0, 0]], [[0, 0, (3.0 + 4.0 * 0.5) / 2]], t=0.5)
    scene.close(torque=0.5 * 4.0 / 2)


def test_a_force_by_a_law_of_positions_velocities_and_time(absolute):
    """A motor's torque, and a force that turns with a body: on that body nothing acts."""
    def law(number, t, x, xdot):
        return [[3 * x[0] - xdot[0] + t], [5.0 * x[0]]][number]

    angle, rate, t = 0.7, 1.3, 0.4
    quantities = [Quantity("angle", 0, 1), Quantity("glide", 1, 2, axis=(0.0, 1.0))]
    forces = [GeneralizedForce("law", 0, law=0, inputs=[0], joint=0), GeneralizedForce("law", 1, law=1, inputs=[0])]
    measures = [FORCE, TORQUE, OutputSpec("alpha", "", "accelerations", 2), OutputSpec("push", "", "accelerations", 3, 2),
                OutputSpec("power", "W", "force power", 0)]
    quantities += [Quantity("angle", 0, 1), Quantity("x", 0, 2), Quantity("y", 0, 2)]
    bodies = [Body(1.0, 0.5, inboard=0), Body(2.0, is_particle=True)]
    tables = Tables(bodies, [Joint(kind("revolute"), 0, 1)], quantities, (), forces, measures)
    scene = Scene(absolute, tables, [[0, 0, angle], [1, 1, 0]], [[0, 0, rate], [0, 0, 0]], law, t)
    torque = 3 * angle - rate + t
    push = 5 * angle / 2 * np.array([-np.sin(angle), np.cos(angle)])
    scene.close(alpha=torque / 0.5, torque=torque, force=[0, 0], push=push, power=torque * rate)
