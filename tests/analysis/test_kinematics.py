"""Prescribed motions against closed forms, `zd.trace` and differences."""

import numpy as np
import pytest
from scipy.interpolate import make_interp_spline

import zerodrift as zd
from support import refused
from zerodrift.analysis.prescribed import prescribed

LAYOUTS = ["joint", "absolute"]


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_turn_of_a_four_bar_is_that_of_trace(layout):
    bar, angles, speed = zd.models.four_bar(), np.linspace(np.pi / 2, 2.5 * np.pi, 73), 10.0
    kin = zd.kinematics(bar.system(layout), {"crank.angle": angles}, speed=speed)
    traced = zd.trace(bar, "crank.angle", angles)
    for name in ("rocker.angle", "coupler.angle", "C.position.x"):
        assert kin[name] == pytest.approx(traced[name], abs=1e-12)
    assert kin["rocker.angular_velocity"] == pytest.approx(speed * traced.derivative("rocker.angle"), abs=1e-10)
    assert kin.t[-1] == pytest.approx(2 * np.pi / speed, rel=1e-14)
    assert kin[zd.transmission_angle(bar, "C")].shape == (73,)
    assert kin.success


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_slider_crank_in_closed_form(layout):
    r, length, omega = 0.1, 0.35, 7.0
    m = zd.Mechanism("slider-crank")        # no masses that matter
    crank = m.link("crank", (0, 0), (r, 0), mass=1.0)
    rod = m.link("rod", (r, 0), (r + length, 0), mass=1.0)
    slide = m.body("slide", 1.0, 1.0, at=(r + length, 0))
    m.revolute("A", m.ground, crank.start)
    m.revolute("B", crank.end, rod.start)
    m.revolute("C", rod.end, slide)
    m.prismatic("guide", m.ground, slide, axis=(1, 0))
    angle = np.linspace(0.3, 0.3 + 2 * np.pi, 50)
    kin = zd.kinematics(m.system(layout), {"crank.angle": angle}, speed=omega)
    root = np.sqrt(length**2 - (r * np.sin(angle))**2)
    tilt = r * np.sin(angle) * np.cos(angle) / root
    x = r * np.cos(angle) + root
    v = -r * omega * (np.sin(angle) + tilt)
    bend = r * (np.cos(2 * angle) / root + r**2 * np.sin(angle)**2 * np.cos(angle)**2 / root**3)
    a = -r * omega**2 * (np.cos(angle) + bend)
    assert kin["slide.position.x"] == pytest.approx(x, abs=1e-12)
    assert kin["slide.velocity.x"] == pytest.approx(v, abs=1e-11)
    assert kin["slide.acceleration.x"] == pytest.approx(a, abs=1e-9)


def robot(mass=1.0):
    m = zd.Mechanism("arm", gravity=(0, -9.81))
    upper = m.link("upper", (0, 0), (0.5, 0.1), mass=2.0 * mass, length=0.6)
    lower = m.link("lower", (0.5, 0.1), (0.8, 0.5), mass=mass, length=0.5)
    m.revolute("hip", m.ground, upper.start)
    m.revolute("knee", upper.end, lower.start)
    return m


CENTRE, RADIUS, TURN = np.array([0.55, 0.3]), 0.12, 3.0


def circle(t):
    return [CENTRE[0] + RADIUS * np.cos(TURN * t), CENTRE[1] + RADIUS * np.sin(TURN * t)]


@pytest.mark.parametrize("layout", LAYOUTS)
def test_inverse_kinematics_of_an_arm_in_closed_form(layout):
    t = np.linspace(0, 2.0, 60)
    kin = zd.kinematics(robot().system(layout), {"lower.end.position": circle}, t)
    x, y = circle(t)
    cosine = (x**2 + y**2 - 0.6**2 - 0.5**2) / (2 * 0.6 * 0.5)
    knee = np.arccos(cosine)
    upper = np.arctan2(y, x) - np.arctan2(0.5 * np.sin(knee), 0.6 + 0.5 * cosine)
    assert kin["upper.angle"] == pytest.approx(upper, abs=1e-11)
    assert kin["lower.angle"] == pytest.approx(upper + knee, abs=1e-11)
    away = np.stack([x, y], axis=1) - CENTRE
    assert kin["lower.end.acceleration"] == pytest.approx(-TURN**2 * away, abs=1e-10)
    assert kin.errors == {"lower.end.position": 0.0}


def test_arrays_and_expressions_agree_with_callables_within_the_reported_error():
    sympy = pytest.importorskip("sympy")
    t, symbol = np.linspace(0, 1.0, 101), sympy.Symbol("t")
    m = robot()
    exact = zd.kinematics(m, {"lower.end.position": circle}, t)
    written = sympy.Matrix([CENTRE[0] + RADIUS * sympy.cos(TURN * symbol), CENTRE[1] + RADIUS * sympy.sin(TURN * symbol)])
    assert zd.kinematics(m, {"lower.end.position": written}, t).vdot == pytest.approx(exact.vdot, abs=1e-9)
    sampled = zd.kinematics(m, {"lower.end.position": np.stack(circle(t), axis=1)}, t)
    error = np.abs(sampled["lower.end.acceleration"] - exact["lower.end.acceleration"]).max()
    assert 0 < error <= sampled.errors["lower.end.position"] + 1e-9
    with pytest.warns(zd.AccuracyWarning, match="samples of .* must be closer"):
        zd.kinematics(m, {"lower.end.position": np.stack(circle(t), axis=1)[::20]}, t[::20])


def test_a_dead_point_ends_the_motion_at_its_limit():
    """Crank and coupler in one line, folded: a triangle of the sides 1 - 0.3, 0.6 and 1."""
    bar, limit = zd.models.four_bar(), -np.arccos((0.6**2 + 1 - 0.7**2) / (2 * 0.6))
    angles = np.concatenate([np.linspace(-1.4, limit - 1e-8, 20), limit + 1e-8 * np.arange(1, 4)])
    with pytest.warns(zd.LockedWarning, match=f"dead point, rocker.angle = {limit:.7f}"[:-1]):
        kin = zd.kinematics(bar, {"rocker.angle": angles})
    assert np.isfinite(kin["rocker.angle"]).sum() == 20
    assert np.isnan(kin["coupler.position"][-3:]).all()
    assert not kin.success
    assert "3 beyond a dead point" in repr(kin)


def test_drives_run_at_the_times_of_the_samples():
    m = robot()
    m.motor("knee drive", "knee", angle=lambda t: 0.4 * np.sin(2 * t))
    t = np.linspace(0, 1, 11)
    kin = zd.kinematics(m, {"upper.angle": lambda t: 0.2 + t}, t)
    assert kin["knee.angle"] == pytest.approx(0.4 * np.sin(2 * t), abs=1e-12)
    assert kin["knee.speed"] == pytest.approx(0.8 * np.cos(2 * t), abs=1e-11)
    assert kin["lower.angular_acceleration"] == pytest.approx(-1.6 * np.sin(2 * t), abs=1e-9)


def test_what_is_wrong_is_refused():
    m = robot()
    with pytest.raises(zd.SingularSystem, match=r"must determine all positions of arm, and leave 1 free: lower\.angle"):
        zd.kinematics(m, {"upper.angle": [0.1, 0.2]})
    with refused("wrong-measure", "motion"):
        zd.kinematics(m, {"upper.angular_velocity": [0.1, 0.2]})
    with refused("missing-argument", "t"):
        zd.kinematics(m, {"lower.end.position": circle})
    with refused("out-of-range", "speed"):
        zd.kinematics(m, {"upper.angle": [0.1, 0.2]}, speed=0.0)
    with refused("shape", "have 2.*not 1"):
        zd.kinematics(m, {"lower.end.position": [0.1, 0.2]})
    bar = zd.models.four_bar()
    with refused("not-available"):
        zd.kinematics(bar, {"crank.angle": [1.6, 1.7]})["A.force"]


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_what_reads_reactions_is_refused_and_other_forces_are_those_of_inverse_dynamics(dimension, layout):
    zero = (0.0,) * (dimension - 2)
    m = zd.Mechanism("scene", dimension=dimension, gravity=(0, -9.81, *zero))
    bar = m.link("bar", (0, 0, *zero), (1, 0.2, *zero), mass=2.0)
    pin = m.revolute("pin", m.ground, bar.start, damping=0.4, **({"axis": (0, 0, 1)} if dimension == 3 else {}))
    m.spring("coil", m.ground.point((1.5, 0.5, *zero)), bar.end, stiffness=60.0, length=0.2, damping=0.3)
    m.spring("law", m.ground.point((2, 0.5, *zero)), bar.end, force=lambda length, speed, t: length - speed + t)
    m.bushing("rubber", m.ground.point((0.5, 0, *zero)), bar.center, stiffness=5.0)
    m.motor("constant", pin, torque=3.0)
    m.force("drag", bar.end, along=(1, 0, *zero), value=lambda r: 0.1 * r, of={"r": pin.force.x})
    read = {"pin": "pin.force.x", "drag": "drag.force", "torque": "constant.torque", "coil": "coil.force",
            "push": "rubber.force.y", "end": "bar.end.acceleration.x", "angle": "pin.angle"}
    for name, measure in read.items():
        m.measure(f"own {name}", lambda x, t: 2 * x + t, of={"x": measure}, unit="N")
    system = m.system(layout)
    kin = zd.kinematics(system, {"pin.angle": np.sin}, np.linspace(0, 1, 5))
    inv = zd.inverse_dynamics(system, kin)
    for name in ("pin.force", "pin.force.x", "pin.torque", "drag.force", "own pin", "own drag"):
        with refused("not-available", name):
            kin[name]
        assert np.abs(inv[name]).max() > 0.1
    others = [f"own {name}" for name in read if name not in ("pin", "drag")]
    for name in ("coil.force", "law.force", "rubber.force", "rubber.torque", "constant.torque", "constant.power", *others):
        assert np.array_equal(kin[name], inv[name])
    assert kin["own angle"] == pytest.approx(2 * np.sin(kin.t) + kin.t, abs=1e-14)


def test_arrays_over_time_become_quintic_splines():
    """Beside SciPy's spline with the same derivatives at both ends, at samples with unequal distances."""
    t = np.sort(np.random.default_rng(2).uniform(0, 3, 40))
    given = np.column_stack([np.sin(2 * t), np.exp(-t)])
    found = prescribed("path", given, t, None)
    ends = [[(1, found.rate[i]), (2, found.second[i])] for i in (0, -1)]
    spline = make_interp_spline(t, given, 5, bc_type=tuple(ends))
    assert found.rate == pytest.approx(spline(t, 1), abs=1e-9)         # distances of 1e-3 amplify rounding
    assert found.second == pytest.approx(spline(t, 2), abs=1e-6)


def test_errors_of_arrays_over_time_are_reported_and_of_fourth_order():
    errors = []
    for count in (21, 41, 81):
        t = np.linspace(0, 2 * np.pi, count)
        found = prescribed("path", np.sin(t), t, None)
        errors.append(np.abs(found.second[:, 0] + np.sin(t)).max())
        assert errors[-1] < 2 * found.error < 1000 * errors[-1]
    assert np.log2(errors[0] / errors[1]) > 3.5
    assert np.log2(errors[1] / errors[2]) > 3.5


def test_a_quintic_is_its_own_spline():
    t, quintic = np.linspace(-1, 1, 12), np.polynomial.Polynomial([1.0, -2.0, 0.5, 3.0, -1.0, 2.0])
    found = prescribed("path", quintic(t), t, None)
    assert found.rate[:, 0] == pytest.approx(quintic.deriv()(t), abs=1e-11)
    assert found.second[:, 0] == pytest.approx(quintic.deriv(2)(t), abs=1e-9)
    assert found.error < 1e-9


def test_quantities_that_contradict_each_other_are_refused():
    with pytest.raises(zd.InconsistentStart, match=r"must agree with each other .* crank\.angle, rocker\.angle differ by"):
        zd.kinematics(zd.models.four_bar(), {"crank.angle": [1.6, 1.7], "rocker.angle": [1.6, 1.7]}, [0.0, 1.0])


def test_a_constant_rate_over_time_gives_no_warning(recwarn):
    zd.kinematics(zd.models.four_bar(), {"crank.angle": np.linspace(1.6, 2.0, 200)}, np.linspace(0, 1, 200))
    assert not recwarn.list


def test_samples_within_reach_after_a_dead_point_are_found_again():
    bar, limit = zd.models.four_bar(), -np.arccos((0.6**2 + 1 - 0.7**2) / (2 * 0.6))
    there = np.linspace(-1.4, limit + 0.05, 40)
    angles = np.concatenate([there, there[::-1]])
    with pytest.warns(zd.LockedWarning, match="dead point"):
        kin = zd.kinematics(bar, {"rocker.angle": angles}, 0.1 * np.arange(80))
    assert (np.isfinite(kin["crank.angle"]) == (angles < limit)).all()
    assert kin["crank.angle"][-1] == pytest.approx(kin["crank.angle"][0], abs=1e-12)


def test_rates_that_contradict_each_other_are_refused():
    m, t = robot(), np.linspace(0, 1, 11)
    m.motor("knee drive", "knee", angle=lambda t: 0.4 * np.sin(2 * t))
    with pytest.raises(zd.InconsistentStart, match=r"at t = .* rates differ by"):
        zd.kinematics(m, {"upper.angle": lambda t: 0.2 + t, "knee.angle": 0.4 * np.sin(2 * t)}, t)


@pytest.mark.parametrize("speed", [1.0, 100.0, 1e4])
@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_steady_turn_with_redundant_constraints_is_consistent(layout, speed):
    """Accelerations of the angles of coupled cranks are zero: differences of terms of the size of the squared speed."""
    m = zd.Mechanism("coupled cranks")
    cranks = [m.link(f"crank {x}", (x, 0), (x, 1), mass=1.0) for x in range(3)]
    rod = m.link("rod", (0, 1), (2, 1), mass=1.0)
    for x, crank in enumerate(cranks):
        m.revolute(f"axle {x}", m.ground, crank.start)
        m.revolute(f"pin {x}", crank, rod, at=(x, 1))
    kin = zd.kinematics(m.system(layout), {"crank 0.angle": np.linspace(np.pi / 2, 3.0, 30)}, speed=speed)
    assert kin["crank 2.angular_velocity"] == pytest.approx(speed, rel=1e-12)
    assert np.abs(kin["crank 2.angular_acceleration"]).max() < 1e-9 * speed**2


def test_rates_are_derivatives_of_the_positions():
    """Differences of eighth order over time, at samples that need an iteration more and at those that do not."""
    h, weights = 1e-3, np.array([1 / 280, -4 / 105, 1 / 5, -4 / 5, 0, 4 / 5, -1 / 5, 4 / 105, -1 / 280])
    t = h * np.arange(300)
    kin = zd.kinematics(zd.models.four_bar(), {"crank.angle": lambda t: np.pi / 2 + 3 * t + 0.2 * np.sin(5 * t)}, t)
    for rates, values in ((kin.v, kin.p), (kin.vdot, kin.v)):
        found = np.array([np.convolve(column, weights[::-1], "valid") for column in values.T]).T / h
        assert rates[4:-4] == pytest.approx(found, abs=1e-10 * max(1.0, np.abs(rates).max()))


def test_functions_are_called_once_with_all_times_where_they_take_arrays():
    t, calls = np.linspace(0.0, 1.0, 50), []

    def smooth(t):
        calls.append(t)
        return [0.3 * np.sin(2 * t) + np.exp(-t), 0.5, t**2]

    def in_parts(t):
        return [0.3 * np.sin(2 * t) + np.exp(-t), 0.5, t**2 if t < 0.5 else t * t]

    found, expected = (prescribed("path", function, t, None) for function in (smooth, in_parts))
    assert len(calls) == 2
    for name in ("value", "rate", "second"):
        assert getattr(found, name) == pytest.approx(getattr(expected, name), abs=1e-15)


def test_a_start_is_led_to_values_that_leave_freedoms():
    m = robot()
    kin = zd.kinematics(m, {"lower.end.position": circle}, np.linspace(0, 1, 5), near={"lower.end.position.x": 0.6})
    expected = zd.kinematics(m, {"lower.end.position": circle}, np.linspace(0, 1, 5))
    assert kin["knee.angle"] == pytest.approx(expected["knee.angle"])
    with pytest.raises(zd.CorrectionFailed, match=r"can move to .*the way to lower\.end\.position ends at \[0\.9"):
        zd.kinematics(m, {"lower.end.position": circle}, [0.0, 1.0], near={"lower.end.position": [1.5, 0.9]})


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_a_sample_in_a_flat_pose_is_a_dead_point(layout):
    """A parallelogram: in its flat pose two branches meet, and rates of either satisfy the constraints."""
    m = zd.Mechanism("parallelogram", gravity=(0, -9.81))
    crank = m.link("crank", (0, 0), (0.3, 0.3), mass=1.0)
    coupler = m.link("coupler", crank.end, (1.3, 0.3), mass=1.0)
    rocker = m.link("rocker", coupler.end, (1, 0), mass=1.0)
    for name, first, second in (("A", m.ground, crank.start), ("B", crank.end, coupler.start), ("C", coupler.end, rocker.start),
                                ("D", rocker.end, m.ground)):
        m.revolute(name, first, second)
    with pytest.warns(zd.LockedWarning, match="1 samples beyond it are NaN"):
        kin = zd.kinematics(m.system(layout), {"crank.angle": np.linspace(1.0, -1.0, 21)}, speed=-1.0)
    assert np.flatnonzero(np.isnan(kin.p[:, 0])).tolist() == [10]
    others = np.delete(kin["rocker.angular_velocity"], 10)
    assert others == pytest.approx(-1.0, abs=1e-9)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_drives_alone_determine_a_motion(layout):
    """An arm with two driven hinges, whose motion and torques are known by the composition of its turns."""
    m, t = robot(), np.linspace(0, 1, 101)
    m.motor("hip drive", "hip", angle=lambda t: 0.2 * t**2)
    m.actuator("lift", m.ground.point((0.0, 1.0)), m["lower"].end, length=lambda t: 0.95 + 0.05 * np.sin(2 * t))
    kin = zd.kinematics(m.system(layout), t=t)
    tip, velocity = kin["lower.end.position"], kin["lower.end.velocity"]
    away, length, rate = tip - [0.0, 1.0], 0.95 + 0.05 * np.sin(2 * t), 0.1 * np.cos(2 * t)
    assert np.hypot(*away.T) == pytest.approx(length, abs=1e-12)
    assert (away * velocity).sum(axis=1) == pytest.approx(length * rate, abs=1e-11)
    assert (away * kin["lower.end.acceleration"]).sum(axis=1) == pytest.approx(
        rate**2 - 0.2 * length * np.sin(2 * t) - (velocity**2).sum(axis=1), abs=1e-9)
    assert kin["upper.angular_acceleration"] == pytest.approx(np.full(101, 0.4), abs=1e-9)
    inv, held = zd.inverse_dynamics(m.system(layout), kin), robot()
    same = zd.kinematics(held, {"hip.angle": lambda t: 0.2 * t**2, "knee.angle": kin["knee.angle"]}, t)
    other = zd.inverse_dynamics(held, same)
    power = inv["hip drive.torque"] * kin["hip.speed"] + inv["lift.force"] * rate
    expected = other["hip.angle"] * kin["hip.speed"] + other["knee.angle"] * kin["knee.speed"]
    assert power == pytest.approx(expected, abs=1e-6)
    assert "its drives: 101 samples" in repr(kin)


def test_what_drives_leave_free_is_named():
    m = robot()
    m.motor("hip drive", "hip", angle=lambda t: t)
    with pytest.raises(zd.SingularSystem, match=r"drives must determine all positions of arm, and leave 1 free: lower\.angle"):
        zd.kinematics(m, t=[0.0, 1.0])
    with refused("missing-argument", "t"):
        zd.kinematics(m)


def test_drives_that_come_to_a_dead_point_are_warned_of():
    """A triangle of sides 1, 1 and a length beyond 2, at t = 0.5."""
    m = zd.Mechanism("reach")
    first = m.link("first", (0, 0), (1, 0), mass=1.0)
    second = m.link("second", (1, 0), (1, 1), mass=1.0)
    m.revolute("A", m.ground, first.start)
    m.revolute("B", first.end, second.start)
    m.motor("turn", "A", angle=0.0)
    m.actuator("pull", m.ground.point((0, 0)), second.end, length=lambda t: np.sqrt(2) + (4 - 2 * np.sqrt(2)) * t)
    with pytest.warns(zd.LockedWarning, match=r"dead point, t = 0\.5: 4 samples"):
        zd.kinematics(m, t=np.linspace(0, 0.9, 10) - 1e-3 * (np.arange(10) == 5))
