"""Each verb against what is known of it: couplings, rolling, blades, one's own constraints, drives, springs, bushings."""

import numpy as np
import pytest
import sympy as sp
from scipy.integrate import solve_ivp

import zerodrift as zd
from support import called, refused
from zerodrift.mechanisms.building.periodic_spline import periodic_spline
from zerodrift.systems.autodiff import Jet

LAYOUTS = ("joint", "absolute")
t = sp.Symbol("t")


def wheels(count, **given):
    """Wheels of 1 kg m^2 on pins of their own."""
    m = zd.Mechanism("wheels", **given)
    bodies = [m.body(f"wheel{i}", 1.0, 1.0, at=(i, 0)) for i in range(count)]
    return m, bodies, [m.revolute(f"pin{i}", m.ground, body.point((0, 0))) for i, body in enumerate(bodies)]


@pytest.fixture(params=LAYOUTS)
def layout(request):
    return request.param


def test_gears_turn_by_their_ratio(layout):
    """A torque T on the first of two wheels: angle'' = T / (J + r^2 J)."""
    m, _, pins = wheels(2)
    m.gear("mesh", *pins, ratio=-2.0)
    m.motor("drive", pins[0], torque=3.0)
    sol = zd.simulate(m.system(layout), 1.0, step=0.01)
    np.testing.assert_allclose(sol["pin0.angle"], 0.5 * 3.0 / 5.0 * sol.t**2, atol=1e-12)
    np.testing.assert_allclose(sol["pin1.angle"], -2.0 * sol["pin0.angle"], atol=1e-12)
    np.testing.assert_allclose(sol["drive.power"], 3.0 * sol["pin0.speed"], atol=1e-12)


def test_a_rack_moves_by_its_pinion(layout):
    m, _, pins = wheels(1)
    rack = m.prismatic("rack", m.ground, m.body("bar", 2.0, 0.1), axis=(1, 1))
    m.rack_pinion("teeth", pins[0], rack, ratio=0.5)
    m.motor("pull", rack, force=4.0)
    sol = zd.simulate(m.system(layout), 1.0, step=0.01)
    np.testing.assert_allclose(sol["rack.displacement"], 0.5 * 4.0 / (2.0 + 1.0 / 0.25) * sol.t**2, atol=1e-12)
    np.testing.assert_allclose(sol["bar.position"], np.sqrt(0.5) * sol["rack.displacement"][:, None] * [1, 1], atol=1e-12)


def test_a_coupler_of_coefficients_is_a_differential(layout):
    m, _, pins = wheels(3)
    m.coupler("cage", {pins[0].angle: 1.0, pins[1].angle: 1.0, pins[2].angle: -2.0})
    m.motor("drive", pins[2], torque=3.0)
    sol = zd.simulate(m.system(layout), 1.0, step=0.01)
    np.testing.assert_allclose(sol["pin2.angle"], 0.5 * 3.0 / 3.0 * sol.t**2, atol=1e-11)     # J + 2 J: the others turn alike
    np.testing.assert_allclose(sol["pin0.angle"], sol["pin2.angle"], atol=1e-11)


def table():
    angles = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    return angles, 0.1 * (1 - np.cos(angles))


@pytest.mark.parametrize(("profile", "error"), [(lambda angle: 0.1 * (1 - np.cos(angle)), 1e-12), (0.1 * (1 - sp.cos(t)), 1e-12),
                                                (table(), 1e-8)], ids=["callable", "sympy", "table"])
def test_a_cam_lifts_its_follower(layout, profile, error):
    m, _, pins = wheels(1)
    lift = m.prismatic("lift", m.ground, m.body("valve", 2.0, 0.1), axis=(0, 1))
    m.cam("cam", pins[0], lift, profile=profile)
    m.motor("drive", pins[0], speed=5.0)
    sol = zd.simulate(m.system(layout), 1.0, step=0.01)
    np.testing.assert_allclose(sol["lift.displacement"], 0.1 * (1 - np.cos(5 * sol.t)), atol=error)
    torque = 2.0 * 2.5 * np.cos(5 * sol.t) * 0.1 * np.sin(5 * sol.t)
    np.testing.assert_allclose(sol["drive.torque"], torque, atol=max(1e4 * error, 1e-9))


def test_a_periodic_spline_goes_through_its_table_and_is_smooth():
    rng = np.random.default_rng(0)
    angles, values = np.sort(rng.uniform(0, 6, 9)), rng.normal(size=9)
    spline = periodic_spline("profile", angles, values)
    np.testing.assert_allclose([spline(angle) for angle in angles], values, atol=1e-12)
    np.testing.assert_allclose([spline(angle + 4 * np.pi) for angle in angles], values, atol=1e-11)
    for knot in angles:
        before, after = (spline(Jet(knot + side, 0.0, 1.0, 0.0)) for side in (-1e-9, 1e-9))
        for part in ("value", "first", "second"):
            assert getattr(before, part) == pytest.approx(getattr(after, part), abs=1e-5)
    exact = periodic_spline("profile", *table())
    assert max(abs(exact(a) - 0.1 * (1 - np.cos(a))) for a in np.linspace(0, 20, 77)) < 1e-8


def test_a_table_may_end_where_its_turn_closes():
    angles, values = table()
    closed = periodic_spline("profile", np.append(angles, 2 * np.pi), np.append(values, values[0]))
    once = periodic_spline("profile", angles, values)
    assert [closed(angle) for angle in np.linspace(0, 20, 7)] == [once(angle) for angle in np.linspace(0, 20, 7)]
    for end, value in ((2 * np.pi, values[0] + 1e-3), (2 * np.pi + 0.1, values[0])):
        with refused("not-increasing"):
            periodic_spline("profile", np.append(angles, end), np.append(values, value))


def test_a_wheel_rolls_down_a_slope_without_slipping(layout):
    """A disc on the ground, pulled by gravity at 30 degrees: a = 2/3 g sin(30), friction a third of the pull."""
    g = 9.81 * np.array([0.5, -np.sqrt(0.75)])
    m = zd.Mechanism("wheel", gravity=g)
    wheel = m.body("wheel", *zd.inertia.disc(mass=2.0, radius=0.5), at=(0, 0.5))
    m.rolling("road", m.ground, wheel, radius=0.5, normal=(0, 1))
    sol = zd.simulate(m.system(layout), 1.0, step=0.01)
    x = 0.5 * 2 / 3 * g[0] * sol.t**2
    np.testing.assert_allclose(sol["wheel.position"], np.stack([x, 0.5 + 0 * x], axis=1), atol=1e-11)
    np.testing.assert_allclose(sol["wheel.angle"], -x / 0.5, atol=1e-11)
    np.testing.assert_allclose(sol["road.force"], np.tile([-2.0 * g[0] / 3, -2.0 * g[1]], (len(x), 1)), atol=1e-10)


def test_the_normal_of_a_road_is_against_gravity():
    m = zd.Mechanism("wall", gravity=(3.0, 0.0))
    road = m.rolling("road", m.ground, m.body("wheel", 1.0, 0.1, at=(-1, 0)), radius=1.0)
    np.testing.assert_allclose(road.normal, (-1, 0))


def test_a_blade_and_ones_own_nonholonomic_row_are_the_same(layout):
    """Caratheodory's and Chaplygin's sleigh: the built-in one, from a blade and from a row of one's own."""
    sols = []
    for own in (False, True):
        m = zd.Mechanism("sleigh")
        sleigh = m.body("sleigh", 1.0, 0.1, com=(0.3, 0), angle=0.2)
        if own:
            m.nonholonomic("blade", lambda a, u, v: u * np.sin(a) - v * np.cos(a),
                           of={"a": sleigh.angle, "u": sleigh.velocity.x, "v": sleigh.velocity.y})
        else:
            m.knife_edge("blade", sleigh.point((0, 0)), along=(np.cos(0.2), np.sin(0.2)))
        m.start({sleigh.angular_velocity: 2.0, sleigh.velocity.x: 0.5})
        sols.append(zd.simulate(m.system(layout), 2.0, step=1e-3))
    np.testing.assert_allclose(sols[0]["sleigh.position"], sols[1]["sleigh.position"], atol=1e-10)
    a, velocity = sols[0]["sleigh.angle"], sols[0]["sleigh.velocity"]
    assert np.abs(velocity[:, 0] * np.sin(a) - velocity[:, 1] * np.cos(a)).max() < 1e-12
    forward, turning = velocity[:, 0] * np.cos(a) + velocity[:, 1] * np.sin(a), sols[0]["sleigh.angular_velocity"]
    exact = solve_ivp(lambda t, y: [0.3 * y[1]**2, -0.3 * y[0] * y[1] / (0.1 + 0.09)], (0, 2), [forward[0], turning[0]],
                      rtol=1e-11, atol=1e-12)
    np.testing.assert_allclose((forward[-1], turning[-1]), exact.y[:, -1], atol=1e-8)


@pytest.mark.parametrize("wire", [lambda x, y: y - x**2, sp.Symbol("y") - sp.Symbol("x") ** 2], ids=["callable", "sympy"])
def test_a_bead_on_a_wire_of_ones_own(layout, wire):
    m = zd.Mechanism("bead", gravity=(0, -9.81))
    bead = m.particle("bead", 0.5, at=(1, 1))
    m.constraint("wire", wire, of={"x": bead.position.x, "y": bead.position.y})

    def fall(t, y):     # (1 + 4 x^2) x'' + 4 x x'^2 + 2 g x = 0
        return [y[1], -(4 * y[0] * y[1]**2 + 2 * 9.81 * y[0]) / (1 + 4 * y[0]**2)]

    sol = zd.simulate(m.system(layout), 1.0, step=1e-3)
    exact = solve_ivp(fall, (0, 1), [1.0, 0.0], method="DOP853", rtol=1e-11, atol=1e-12).y[:, -1]
    np.testing.assert_allclose(sol["bead.position"][-1], [exact[0], exact[0]**2], atol=1e-8)


@pytest.mark.parametrize("law", [lambda t: 0.4 * np.sin(3 * t), 0.4 * sp.sin(3 * t)], ids=["callable", "sympy"])
def test_drives_by_angle_follow_their_law(layout, law):
    m, _, pins = wheels(1)
    m.motor("drive", pins[0], angle=law)
    sol = zd.simulate(m.system(layout), 1.0, step=0.01)
    np.testing.assert_allclose(sol["pin0.angle"], 0.4 * np.sin(3 * sol.t), atol=1e-12)
    np.testing.assert_allclose(sol["drive.torque"], -3.6 * np.sin(3 * sol.t), atol=1e-9)
    np.testing.assert_allclose(sol["drive.power"], -3.6 * np.sin(3 * sol.t) * 1.2 * np.cos(3 * sol.t), atol=1e-9)


def test_a_drive_of_speed_may_depend_on_time_parameters_and_positions(layout):
    """Angle' = c (1 - angle): angle = 1 - exp(-c t)."""
    m, _, pins = wheels(1, parameters={"c": 2.0})
    m.motor("drive", pins[0], speed=lambda c, angle: c * (1 - angle), of={"angle": pins[0].angle})
    sol = zd.simulate(m.system(layout), 1.0, step=1e-3)
    np.testing.assert_allclose(sol["pin0.angle"], 1 - np.exp(-2 * sol.t), atol=1e-9)
    np.testing.assert_allclose(sol["drive.torque"], -4 * np.exp(-2 * sol.t), atol=1e-8)
    np.testing.assert_allclose(zd.simulate(m.with_parameters(c=1.0), 1.0, step=1e-3)["pin0.angle"][-1], 1 - np.exp(-1), atol=1e-9)


def test_efforts_may_depend_on_velocities(layout):
    m, bodies, pins = wheels(1)
    m.torque("air", bodies[0], value=lambda w: -0.5 * w, of={"w": bodies[0].angular_velocity})
    m.motor("brake", pins[0], torque=-0.25 * sp.Symbol("pin0.speed"))
    m.start({pins[0].speed: 2.0})
    sol = zd.simulate(m.system(layout), 1.0, step=0.01)
    np.testing.assert_allclose(sol["pin0.speed"], 2 * np.exp(-0.75 * sol.t), rtol=1e-9)
    np.testing.assert_allclose(sol["air.torque"], -0.5 * sol["pin0.speed"], rtol=1e-12)
    np.testing.assert_allclose(sol["brake.torque"], -0.25 * sol["pin0.speed"], rtol=1e-12)
    assert np.abs(sol.energy_violation).max() < 1e-9


def test_damping_acts_through_the_joint(layout):
    m = zd.Mechanism("damped")
    slide = m.prismatic("slide", m.ground, m.body("block", 2.0, 0.1), axis=(1, 0), damping=3.0)
    m.start({slide.speed: 1.0})
    sol = zd.simulate(m.system(layout), 1.0, step=0.01)
    np.testing.assert_allclose(sol["slide.speed"], np.exp(-1.5 * sol.t), rtol=1e-9)
    np.testing.assert_allclose(sol["slide.force"][:, 0], -3.0 * sol["slide.speed"], rtol=1e-9)


def test_springs_pull_where_they_are_stretched(layout):
    m = zd.Mechanism("spring")
    block = m.body("block", 1.0, 0.1, at=(2, 0))
    m.prismatic("slide", m.ground, block, axis=(1, 0))
    spring = m.spring("spring", m.ground.point((0, 0)), block.point((0, 0)), stiffness=4.0, length=1.5)
    sol = zd.simulate(m.system(layout), 1.0, step=0.01)
    np.testing.assert_allclose(sol[spring.length], 1.5 + 0.5 * np.cos(2 * sol.t), atol=1e-8)
    np.testing.assert_allclose(sol[spring.force], 2.0 * np.cos(2 * sol.t), atol=1e-7)
    assert m.with_parameters({"spring.length": 2.0}).parameters["spring.length"] == 2.0
    assert zd.simulate(m.with_parameters({"spring.length": 2.0}), 0.5, step=0.1)["spring.force"] == pytest.approx(0.0, abs=1e-12)


def test_a_torsion_spring_turns_the_second_body(layout):
    m, _, pins = wheels(1)
    m.torsion_spring("spring", pins[0], stiffness=4.0, angle=0.5)
    sol = zd.simulate(m.system(layout), 1.0, step=0.01)
    np.testing.assert_allclose(sol["pin0.angle"], 0.5 * (1 - np.cos(2 * sol.t)), atol=1e-8)
    np.testing.assert_allclose(sol["spring.torque"], 2.0 * np.cos(2 * sol.t), atol=1e-7)


def test_a_bushing_is_slack_as_drawn_and_springs_along_its_axes(layout):
    m = zd.Mechanism("engine")
    engine = m.body("engine", 2.0, 0.5, at=(1, 1), angle=0.3)
    m.bushing("mount", m.ground, engine, at=(1, 1), stiffness=(8.0, 18.0), torsion=2.0)
    assert np.abs(zd.acceleration(m.system(layout), m.system(layout).p0, m.system(layout).v0)[0]).max() < 1e-14
    m.start({engine.position: (1.1, 1.2), engine.angle: 0.4})
    sol = zd.simulate(m.system(layout), 1.0, step=0.01)
    exact = np.stack([1 + 0.1 * np.cos(2 * sol.t), 1 + 0.2 * np.cos(3 * sol.t)], axis=1)
    np.testing.assert_allclose(sol["engine.position"], exact, atol=1e-7)
    np.testing.assert_allclose(sol["engine.angle"], 0.3 + 0.1 * np.cos(2 * sol.t), atol=1e-8)


def test_a_particle_on_a_body_is_part_of_it(layout):
    """A rod of 3 kg and 1 m with 2 kg at its end: J = 3/3 + 2 about the pin."""
    m = zd.Mechanism("pendulum", gravity=(0, -9.81))
    link = m.link("link", (0, 0), (1, 0), mass=3.0)
    bob = m.particle("bob", 2.0, at=link.end)
    m.revolute("pin", m.ground, link.start)
    system = m.system(layout)
    vdot, _ = zd.acceleration(system, system.p0, system.v0)
    turning = [i for i, variable in enumerate(system.velocities) if variable.name == "link.angular_velocity"]
    np.testing.assert_allclose(vdot[turning], -9.81 * (1.5 + 2.0) / 3.0, rtol=1e-12)
    np.testing.assert_allclose(zd.simulate(system, 0.1, step=0.1)[bob.position][0], (1, 0), atol=1e-15)


def test_parts_without_a_joint_to_the_ground_get_the_heaviest_as_their_root():
    m = zd.Mechanism("free", gravity=(0, -9.81))
    light, heavy = m.link("light", (0, 0), (1, 0), mass=1.0), m.link("heavy", (1, 0), (2, 0), mass=5.0)
    m.revolute("hinge", light.end, heavy.start)
    names = [variable.name for variable in m.system().coordinates]
    assert names == ["light.angle", "heavy.x", "heavy.y", "heavy.angle"]
    sol = zd.simulate(m, 0.5, step=0.01)
    np.testing.assert_allclose(sol["heavy.position"][-1], (1, -9.81 / 8), atol=1e-10)


def test_a_weld_that_is_cut_is_rows():
    def made(**options):
        m = zd.Mechanism("bracket", gravity=(0, -9.81))
        arm = m.link("arm", (0, 0), (1, 0), mass=1.0)
        m.revolute("pin", m.ground, arm.start)
        m.weld("glue", arm.end, m.link("tool", (1, 0), (1, 0.5), mass=0.3).start, **options)
        return m

    tree, cut = made().system("joint"), made(cut=True).system("joint")
    assert (tree.m, cut.m) == (0, 3)
    one, other = (zd.simulate(system, 0.1, step=1e-3) for system in (tree, cut))
    for measure in ("arm.angle", "tool.end.position", "glue.force", "glue.torque"):
        np.testing.assert_allclose(one[measure], other[measure], rtol=0, atol=1e-9)
    with refused("wrong-type", "'wire'.*not 0"):
        made().slot("wire", "arm", "tool.end", axis=(1, 0), cut=0)


def test_cut_says_where_a_loop_is_closed():
    m = zd.Mechanism("linkage")
    a, b, c = m.link("a", (0, 0), (0, 1), 1.0), m.link("b", (0, 1), (2, 1.5), 1.0), m.link("c", (2, 1.5), (2, 0), 1.0)
    m.revolute("A", m.ground, a.start)
    m.revolute("B", a.end, b.start, cut=True)
    m.revolute("C", b.end, c.start)
    m.revolute("D", c.end, m.ground.point((2, 0)))
    assert [variable.name for variable in m.system().constraints] == ["B.x", "B.y"]
    with refused("wrong-type", "'E'.*not 1"):
        m.revolute("E", m.ground, b.end, cut=1)


def test_what_a_callable_raises_says_where(layout):
    m, bodies, _ = wheels(1)

    def broken(t):
        raise RuntimeError("no")

    m.torque("air", bodies[0], value=broken)
    with pytest.raises(RuntimeError, match="no") as caught:
        zd.simulate(m.system(layout), 1.0, step=0.1)
    assert caught.value.__notes__ == ["in value of torque 'air', called at t = 0"]


def test_what_a_callable_returns_is_a_number():
    m, bodies, _ = wheels(1)
    m.torque("air", bodies[0], value=lambda: [1.0, 2.0])
    with refused("wrong-type", "'air'.*0"):
        zd.simulate(m, 1.0, step=0.1)


@pytest.mark.parametrize("motion", [called(lambda t: np.interp(t, [0, 1], [0, 1])), called(lambda t: np.floor(t) + t),
                                    called(lambda t: t % 2), lambda t: np.sinc(t)])
def test_prescribed_motions_have_derivatives(motion):
    m, _, joints = wheels(1)
    m.motor("drive", joints[0], angle=motion)
    with refused("user-function", r"'drive'.*np\.interp, np\.floor"):
        zd.simulate(m, 1.0, step=0.1)


@pytest.mark.parametrize("given", [([0.0, 1.0], [0.0, 1.0]), np.zeros((2, 2)), {"t": 1.0}])
def test_laws_are_numbers_functions_or_expressions(given):
    m, _, joints = wheels(1)
    with refused("wrong-type", "'drive'"):
        m.motor("drive", joints[0], angle=given)


# ---- events ----


def pendulum():
    m = zd.Mechanism("pendulum", gravity=(0, -9.81), parameters={"low": -0.5})
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    m.revolute("pin", m.ground, link.start)
    return m, link


@pytest.mark.parametrize("event", [
    lambda link: zd.Event(link.end.position.y, value=-0.5), lambda link: zd.Event("pin.angle", value=-np.pi / 6),
    lambda link: zd.Event(lambda y, low: y - low, of={"y": link.end.position.y}),
    lambda link: zd.Event(lambda t, p: p[0] + np.pi / 6 + 0 * t)])
def test_events_are_measures_or_functions_of_them(layout, event):
    """When the end is half a metre down: where it is then, and how fast, by the balance of energy."""
    m, link = pendulum()
    event = event(link)
    if layout == "absolute" and callable(event.what) and event.of is None:
        event = zd.Event(lambda p: p[2] + np.pi / 6)
    sol = zd.simulate(m.system(layout), 1.0, step=0.01, events=[event, "link.angle"])
    assert len(sol.t_events[0]) in (1, 2)       # the end is as low again on the other side
    angle = sol.p_events[0][0][-1]
    np.testing.assert_allclose(angle, -np.pi / 6, atol=1e-12)
    np.testing.assert_allclose(sol.v_events[0][0][-1], -np.sqrt(3 * 9.81 * 0.5), rtol=1e-7)


def test_a_terminal_event_ends_the_run_and_a_direction_counts():
    m, link = pendulum()
    sol = zd.simulate(m, 2.0, step=0.01, events=zd.Event(link.end.position.y, value=-0.5, direction=1, terminal=True))
    assert sol.status == 4
    np.testing.assert_allclose(sol["link.angle"][-1], -5 * np.pi / 6, atol=1e-12)


@pytest.mark.parametrize(("event", "code", "error"), [
    (zd.Event("link.position"), "wrong-measure", "events.*'link.position'"),
    (zd.Event("pin.force"), "wrong-measure", "events.*'pin.force.x'"),
    (zd.Event("rod.angle"), "unknown-choice", "events"),
    (zd.Event(3), "wrong-type", "events.*not 3"),
    (zd.Event(lambda x: x), "user-function", "'x'"), (3, "wrong-type", "events")])
def test_events_that_there_are_not(event, code, error):
    with refused(code, error):
        zd.simulate(pendulum()[0], 1.0, step=0.1, events=event)


def test_events_of_other_systems_by_the_names_of_their_coordinates():
    bar = zd.systems.four_bar()
    sol = zd.simulate(bar, 1.0, step=0.01, events=[zd.Event("alpha1", value=2.0), "alpha2_dot"])
    assert abs(sol.p_events[0][0][0] - 2.0) < 1e-12
    assert abs(sol.v_events[1][0][1]) < 1e-12


def test_a_parameter_is_added_to_those_of_the_mechanism():
    """Laws name both; a wheel on its pin is braked as exp(-(mu + c) t)."""
    m, _, pins = wheels(1, parameters={"c": 0.1})
    m.parameter("mu", 0.3)
    m.motor("brake", pins[0], torque=lambda mu, c, speed: -(mu + c) * speed)
    m.start({"pin0.speed": 2.0})
    assert " parameters: c = 0.1, mu = 0.3\n" in str(m)
    for mu, system in ((0.3, m), (0.7, m.with_parameters(mu=0.7))):
        sol = zd.simulate(system, 1.0, step=0.01)
        np.testing.assert_allclose(sol["pin0.speed"], 2 * np.exp(-(mu + 0.1) * sol.t), rtol=1e-9)
    for name, code in (("mu", "duplicate-name"), ("t", "duplicate-name"), ("a b", "wrong-value"), (3, "wrong-type")):
        with refused(code):
            m.parameter(name, 1.0)
    with refused("wrong-type"):
        m.parameter("nu", "much")
