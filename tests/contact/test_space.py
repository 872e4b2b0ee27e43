"""Contacts with planes and spheres, and friction in two directions: against closed forms, and equations of a few lines."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import zerodrift as zd

G = 9.81
R = 0.1         # m: radius of the ball


def ball(position, *, mass=1.0):
    m = zd.Mechanism("ball", gravity=(0, 0, -G), dimension=3)
    return m, m.body("ball", mass, np.full(3, 0.4 * mass * R**2), at=position)


def moving(m, body, v, w=(0.0, 0.0, 0.0)):
    """Starts a body with a velocity and an angular velocity."""
    m.start({f"{body.name}.{what}.{axis}": float(value) for what, vector in (("velocity", v), ("angular_velocity", w))
             for axis, value in zip("xyz", vector, strict=True)})


def slope(angle):
    """Directions down a slope, along it and its normal, as columns."""
    return np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])


def on_feet(feet, friction, angle, v=(0.0, 0.0), spin=0.0, height=0.2, reach=0.15):
    """A body on feet around its mass centre, and the directions of the slope."""
    axes = slope(angle)
    m = zd.Mechanism("stool", gravity=(0, 0, -G), dimension=3)
    body = m.body("b", 2.0, np.diag([0.02, 0.02, 0.03]), at=height * axes[:, 2], rotation=axes)
    for k in range(feet):
        c, s = np.cos(2 * np.pi * k / feet), np.sin(2 * np.pi * k / feet)
        foot = body.point((reach * c, reach * s, -height))
        m.contact(f"foot{k}", foot, m.ground.plane((0, 0, 0), axes[:, 2]), friction=friction)
    moving(m, body, axes[:, :2] @ v, spin * axes[:, 2])
    return m, axes


def states(sol):
    return [tuple(phase.state.values()) for phase in sol.phases]


def test_ball_slides_until_it_rolls():
    m, body = ball((0, 0, R))
    m.contact("floor", body, m.ground.plane((0, 0, 0), (0, 0, 1)), radius=R, friction=0.3)
    v, w = np.array([2.0, 1.0, 0.0]), np.array([5.0, 0.0, 3.0])
    moving(m, body, v, w)
    sol = zd.simulate(m, 1.0, rtol=1e-10)
    slip = v + np.cross(w, (0, 0, -R))      # its direction stays; it ends after 2 |slip| / (7 mu g)
    assert states(sol) == [("sliding",), ("sticking",)]
    assert sol.phases[0].t1 == pytest.approx(2 * np.linalg.norm(slip) / (7 * 0.3 * G), abs=1e-8)
    assert np.abs(sol["ball.velocity"][-1] - (v - slip * 2 / 7)).max() < 1e-9
    assert sol["ball.angular_velocity"][-1][2] == pytest.approx(3.0, abs=1e-8)      # no friction about the normal
    during = sol["floor.force"][0]
    assert np.abs(during - [*(-0.3 * G * slip[:2] / np.linalg.norm(slip)), G]).max() < 1e-12
    assert np.abs(sol.energy_violation).max() < 1e-8


@pytest.mark.parametrize(("friction", "states_seen"), [(0.2, [("sliding",)]), (0.5, [("sliding",), ("sticking",)])])
def test_point_slides_on_a_slope_in_a_curve(friction, states_seen):
    angle, v = np.radians(20), np.array([-1.0, 0.5])
    axes = slope(angle)
    m, body = ball((0, 0, 0))
    m.contact("slope", body.center, m.ground.plane((0, 0, 0), axes[:, 2]), friction=friction)
    moving(m, body, axes[:, :2] @ v)
    sol = zd.simulate(m, 2.0, rtol=1e-9, atol=1e-12)
    down = np.array([G * np.sin(angle), 0.0])

    def equations(_, y):
        return [*y[2:], *(down - friction * G * np.cos(angle) * y[2:] / np.hypot(*y[2:]))]

    def rests(_, y):
        return np.hypot(*y[2:]) - 1e-7
    rests.terminal = True
    own = solve_ivp(equations, (0, 2), [0, 0, *v], rtol=1e-12, atol=1e-14, events=rests)
    assert states(sol) == states_seen
    assert np.abs(axes[:, :2].T @ sol["ball.position"][-1] - own.y[:2, -1]).max() < 1e-8
    if len(states_seen) == 2:
        assert sol.phases[0].t1 == pytest.approx(own.t[-1] + 1e-7 / (G * (friction * np.cos(angle) - np.sin(angle))), abs=1e-6)


def particle_on_a_floor(x, y, v=(0.0, 0.0)):
    """A particle of 1 kg under horizontal forces of time, with friction of 0.3."""
    m = zd.Mechanism("particle", gravity=(0, 0, -G), dimension=3)
    body = m.particle("b", 1.0, (0, 0, 0))
    m.contact("floor", body, m.ground.plane((0, 0, 0), (0, 0, 1)), friction=0.3)
    m.force("x", body, along=(1, 0, 0), value=x)
    m.force("y", body, along=(0, 1, 0), value=y)
    m.start({body.velocity: (*v, 0.0)})
    return m


@pytest.mark.parametrize("method", ["rk4", "heun"])
def test_fixed_steps_where_slip_begins(method):
    """A force 10 t that turns by 3 rad/s: the slip begins with it where it is 0.3 g, and slowly."""
    def push(t):
        return 10 * t * np.array([np.cos(3 * t), np.sin(3 * t)])

    def equations(t, y):
        return [*y[2:], *(push(t) - 0.3 * G * y[2:] / np.hypot(*y[2:]))]
    begin = 0.03 * G
    own = solve_ivp(equations, (begin, 0.8), [0, 0, *(1e-9 * push(begin))], method="Radau", rtol=1e-11, atol=1e-13)
    m = particle_on_a_floor(lambda t: 10 * t * np.cos(3 * t), lambda t: 10 * t * np.sin(3 * t))
    sol = zd.simulate(m, 0.8, step=1e-3, integrator=method)
    assert states(sol) == [("sticking",), ("sliding",)]
    assert np.abs(sol["b.position"][-1][:2] - own.y[:2, -1]).max() < 1e-6


@pytest.mark.parametrize("settings", [{"rtol": 1e-9, "atol": 1e-12}, {"step": 0.01}])
def test_states_between_samples_where_slip_has_turned(settings):
    m = particle_on_a_floor(lambda t: 6 * np.cos(2 * t), lambda t: 6 * np.sin(2 * t), (2.0, 0.0))
    times = [0.2345, 1.1111, 1.4987]
    sol, saved = zd.simulate(m, 1.5, **settings), zd.simulate(m, 1.5, t_eval=times, **settings)
    assert sol["b.velocity"][-1][:2] @ sol["b.velocity"][0][:2] < 0
    assert np.array_equal([sol.at(t)["b.position"] for t in times], saved["b.position"])


@pytest.mark.parametrize("feet", [3, 4])
def test_feet_share_friction_up_to_its_whole_bound(feet):
    for tangent, holds in ((0.2999, True), (0.31, False)):
        m, axes = on_feet(feet, 0.3, np.arctan(tangent))
        sol = zd.simulate(m, 1.0)
        fell = axes[:, 0] @ (sol["b.position"][-1] - sol["b.position"][0])
        if holds:
            assert fell == pytest.approx(0, abs=1e-13)
            assert states(sol) == [("sticking",) * feet]
        else:
            angle = np.arctan(tangent)
            assert fell == pytest.approx(0.5 * G * (np.sin(angle) - 0.3 * np.cos(angle)), abs=1e-6)


@pytest.mark.parametrize("feet", [3, 4])
def test_feet_spin_down_and_slide_straight(feet):
    m, _ = on_feet(feet, 0.3, 0.0, spin=3.0)
    sol = zd.simulate(m, 0.2, rtol=1e-9)
    assert sol.phases[0].t1 == pytest.approx(3.0 * 0.03 / (0.3 * 2.0 * G * 0.15), abs=1e-7)
    m, _ = on_feet(feet, 0.3, 0.0, v=(1.0, 0.0))
    sol = zd.simulate(m, 0.5, rtol=1e-9)
    assert sol.phases[0].t1 == pytest.approx(1 / (0.3 * G), abs=1e-8)
    assert np.abs(sol["b.position"][-1] - [1 / (0.6 * G), 0, 0.2]).max() < 1e-8
    assert set(states(sol)[-1]) == {"sticking"}


def test_twist_that_feet_resist():
    for torque, holds in ((0.999, True), (1.001, False)):
        m, _ = on_feet(3, 0.3, 0.0)
        m.torque("twist", "b", value=torque * 0.3 * 2.0 * G * 0.15, axis=(0, 0, 1))
        sol = zd.simulate(m, 0.2)
        assert (set(states(sol)[-1]) == {"sticking"}) == holds


def test_oblique_bounce():
    mu, e = 0.15, 0.7
    m, body = ball((0, 0, 1.0), mass=2.0)
    m.contact("floor", body, m.ground.plane((0, 0, 0), (0, 0, 1)), radius=R, friction=mu, restitution=e)
    v, w = np.array([1.0, 0.5, -1.0]), np.array([3.0, -40.0, 5.0])
    moving(m, body, v, w)
    sol = zd.simulate(m, 0.6, rtol=1e-10)
    t = (-1 + np.sqrt(1 + 2 * G * (1 - R))) / G
    assert sol.impacts["t"][0] == pytest.approx(t, abs=1e-12)
    into, slip = 1 + G * t, (v + np.cross(w, (0, 0, -R)))[:2]
    change = -mu * (1 + e) * into * slip / np.linalg.norm(slip)     # it slides all the time
    assert np.linalg.norm(change) < 2 / 7 * np.linalg.norm(slip)
    assert np.abs(sol["ball.velocity"][-1][:2] - (v[:2] + change)).max() < 1e-12
    assert np.abs(sol.energy_violation).max() < 1e-12


def test_ball_rolls_in_a_bowl():
    centre, path, angle = np.array([0, 0, 1.0]), 0.9, 1e-3     # rad, whose square the closed form neglects
    m, body = ball(centre + path * np.array([np.sin(angle), 0, -np.cos(angle)]))
    m.contact("bowl", body, m.ground.sphere(centre, 1.0, outside=False), radius=R, friction=0.5)
    sol = zd.simulate(m, 3.0, rtol=1e-11, atol=1e-14)
    assert sol["ball.position.x"][-1] == pytest.approx(path * angle * np.cos(3 * np.sqrt(G / (1.4 * path))), abs=3e-9)
    assert states(sol) == [("sticking",)]
    moving(m, body, (0, 2.0, 0), np.cross((-np.sin(angle), 0, np.cos(angle)), (0, 2.0 / R, 0)))
    sol = zd.simulate(m, 2.0, rtol=1e-9)
    assert np.ptp(np.linalg.norm(sol["ball.position"] - centre, axis=1)) < 1e-12
    assert np.abs(sol.energy_violation).max() < 1e-7


def test_ball_hits_a_dome():
    m, body = ball((0.05, 0.02, 1.5))
    m.contact("dome", body, m.ground.sphere((0, 0, 0), 0.5), radius=R, friction=0.2, restitution=0.6)
    sol = zd.simulate(m, 0.6)
    assert sol.impacts["t"][0] == pytest.approx(np.sqrt(2 * (1.5 - np.sqrt(0.36 - 0.05**2 - 0.02**2)) / G), abs=1e-12)
    assert np.abs(sol.energy_violation).max() < 1e-12


@pytest.mark.parametrize("shape", ["plane", "outside", "inside"])
def test_constraints_of_contacts_of_two_moving_bodies(shape):
    """Gap, momentum and energy along a motion, and friction against the slip, from positions and velocities alone."""
    place, axes = np.array([0.1, 0.2, 0.3]), slope(0.4)
    reach = {"plane": R, "outside": 0.4, "inside": 0.8}[shape]
    towards = axes @ (np.array([0, 0, 1.0]) if shape == "plane" else np.array([0.6, 0.0, 0.8]))
    m = zd.Mechanism("two", gravity=(0, 0, 0), dimension=3)
    plate = m.body("plate", 3.0, np.diag([0.2, 0.3, 0.4]), at=place, rotation=axes)
    body = m.body("ball", 1.0, np.diag([0.004, 0.005, 0.006]), at=place + reach * towards)
    touched = {"plane": plate.plane(place, axes[:, 2]), "outside": plate.sphere(place, 0.3),
               "inside": plate.sphere(place, 0.9, outside=False)}[shape]
    m.contact("touch", body, touched, radius=R, friction=0.2)
    push = 20.0 if shape == "inside" else -20.0
    m.force("push", body.center, value=push, along=towards)
    m.force("hold", plate.center, value=-push, along=towards)
    w = (0.5, -1.0, 0.7)
    v = np.cross(w, reach * towards) + 0.4 * axes[:, 1]
    m.start({f"{name}.{axis}": value
             for name, vector in (("plate.angular_velocity", w), ("ball.angular_velocity", w), ("ball.velocity", v))
             for axis, value in zip("xyz", vector, strict=True)})
    sol = zd.simulate(m, 0.01, rtol=1e-11, atol=1e-13)
    assert states(sol) == [("sliding",)]
    apart = sol["ball.position"] - sol["plate.position"]
    if shape == "plane":
        normals = sol["plate.rotation"].reshape(-1, 3, 3)[:, :, 2]
        gap = np.einsum("ij,ij->i", apart, normals) - R
    else:
        gap = np.linalg.norm(apart, axis=1) - reach
    assert np.abs(gap).max() < 1e-12
    force = sol["touch.force"]
    momentum = sol["ball.velocity"] * 1.0 + sol["plate.velocity"] * 3.0
    assert np.ptp(momentum, axis=0).max() < 1e-11
    assert np.abs(sol.energy_violation).max() < 1e-10
    tangential = force - np.einsum("ij,ij->i", force, _normal(sol, shape, apart))[:, None] * _normal(sol, shape, apart)
    pressed = np.linalg.norm(force - tangential, axis=1)
    assert np.abs(np.linalg.norm(tangential, axis=1) - 0.2 * pressed).max() < 1e-9
    way = -R * _normal(sol, shape, apart) * (-1 if shape == "inside" else 1)
    slip = (sol["ball.velocity"] + np.cross(sol["ball.angular_velocity"], way) - sol["plate.velocity"]
            - np.cross(sol["plate.angular_velocity"], apart + way))
    along = np.einsum("ij,ij->i", tangential, slip) / (np.linalg.norm(tangential, axis=1) * np.linalg.norm(slip, axis=1))
    assert np.abs(along + 1).max() < 1e-12


def _normal(sol, shape, apart):
    """Unit vectors from the plate to the ball."""
    if shape == "plane":
        return sol["plate.rotation"].reshape(-1, 3, 3)[:, :, 2]
    return apart / np.linalg.norm(apart, axis=1)[:, None]


# ---- friction of joints ----


def pendulum(dimension):
    def place(*xy):
        return xy if dimension == 2 else (*xy, 0.0)
    m = zd.Mechanism("pendulum", gravity=place(0, -G), dimension=dimension)
    body = m.body("b", 2.0, 0.1 if dimension == 2 else np.diag([0.2, 0.3, 0.1]), at=place(0.5, 0))
    m.revolute("pin", m.ground, body, at=place(0, 0), friction=(0.3, 0.2), radius=0.05,
               **({} if dimension == 2 else {"axis": (0, 0, 1)}))
    return m


def slider(dimension, guide):
    def place(*xy):
        return xy if dimension == 2 else (*xy, 0.0)
    m = zd.Mechanism("slider", gravity=place(0, -G), dimension=dimension)
    body = m.body("b", 2.0, 0.1 if dimension == 2 else np.diag([0.2, 0.3, 0.1]), at=place(0, 0.1))
    slide = m.prismatic("slide", m.ground, body, at=place(0, 0), axis=place(np.cos(0.4), -np.sin(0.4)), friction=(0.25, 0.2),
                        guide=guide)
    m.force("pull", body.point(place(0, 0.3)), value=3.0, along=place(1, 0))
    m.start({slide.speed: 1.0})
    return m


def test_friction_of_a_pin_in_space_is_that_in_the_plane():
    flat, solid = (zd.simulate(pendulum(dimension), 3.0, rtol=1e-9) for dimension in (2, 3))
    assert solid["pin.angle"][-1] == pytest.approx(flat["pin.angle"][-1], abs=1e-7)
    assert np.abs(solid["pin.force"][-1][:2] - flat["pin.force"][-1]).max() < 1e-5
    assert states(flat) == states(solid)


@pytest.mark.parametrize("guide", [None, 0.3])
def test_friction_of_a_slider_in_space_is_that_in_the_plane(guide):
    flat, solid = (zd.simulate(slider(dimension, guide), 1.0, rtol=1e-9) for dimension in (2, 3))
    assert solid["slide.displacement"][-1] == pytest.approx(flat["slide.displacement"][-1], abs=1e-9)
    assert states(flat) == states(solid)


def test_friction_of_a_slider_counts_both_directions_and_both_ends():
    """A push at a height, and a force from the side: m a = P - mu (|F/2 + f| + |F/2 - f|), with f across for M / l."""
    mu, guide, side, height, push = 0.2, 0.4, 7.0, 0.3, 30.0
    m = zd.Mechanism("slider", gravity=(0, 0, -G), dimension=3)
    body = m.body("b", 2.0, np.diag([0.2, 0.3, 0.1]), at=(0, 0, 0))
    m.prismatic("slide", m.ground, body, at=(0, 0, 0), axis=(1, 0, 0), friction=mu, guide=guide)
    m.force("push", body.point((0, 0, height)), value=push, along=(1, 0, 0))
    m.force("side", body.point((0, 0, 0)), value=side, along=(0, 1, 0))
    sol = zd.simulate(m, 0.1)
    F, f = np.array([side, -2.0 * G]), np.array([0.0, push * height / guide])      # along y and z
    friction = mu * sum(np.linalg.norm(F / 2 + sign * f) for sign in (1, -1))
    assert sol["slide.acceleration"][-1] == pytest.approx((push - friction) / 2.0, abs=1e-12)


def test_pin_counts_both_directions_of_its_radial_force():
    mu, radius, axial = 0.2, 0.05, 11.0
    m = zd.Mechanism("pin", gravity=(0, 0, 0), dimension=3)
    body = m.body("b", 2.0, np.diag([0.2, 0.3, 0.1]), at=(0, 0, 0))
    m.revolute("pin", m.ground, body, at=(0, 0, 0), axis=(0, 0, 1), friction=mu, radius=radius)
    m.force("load", body.point((0, 0, 0)), value=np.linalg.norm([3, 4, axial]), along=(3, 4, axial))
    m.torque("drive", body, value=0.5, axis=(0, 0, 1))
    sol = zd.simulate(m, 0.1)
    assert sol["pin.acceleration"][-1] == pytest.approx((0.5 - mu * radius * 5.0) / 0.1, abs=1e-12)


# ---- files, states and refusals ----


def test_files_and_states_carry_contacts_in_space(tmp_path):
    m, body = ball((0, 0, 0.5))
    m.contact("floor", body, m.ground.plane((0, 0, 0), (0, 0, 1)), radius=R, friction=(0.3, 0.2), restitution=0.5)
    m.contact("dome", body, m.ground.sphere((0.02, 0.01, 0), 0.2), radius=R)
    m.save(tmp_path / "ball.json")
    sol, other = zd.simulate(m, 1.0), zd.simulate(zd.load(tmp_path / "ball.json"), 1.0)
    assert np.array_equal(sol["ball.position"], other["ball.position"])
    assert states(sol) == states(other)
    run = zd.Run(m)
    run.advance_to(0.7)
    kept = run.save()
    run.advance_to(1.0)
    end = run["ball.position"]
    run.restore(kept)
    run.advance_to(1.0)
    assert np.array_equal(run["ball.position"], end)


def test_shapes_of_the_other_dimension_are_refused():
    m, body = ball((0, 0, R))
    with pytest.raises(ValueError, match=r"a shape in space must be plane\(\) or sphere\(\) of the body, not a line"):
        m.ground.line((0, 0), (1, 0))
    flat = zd.Mechanism("flat")
    with pytest.raises(ValueError, match=r"a shape in the plane must be line\(\), .*, not a sphere"):
        flat.ground.sphere((0, 0), 1.0)
    with pytest.raises(TypeError, match=r"shape of 'a' must be a shape of a body, body.plane\(point, normal\)"):
        m.contact("a", body, "floor")
    with pytest.raises(ValueError, match="normal of a plane must not be zero"):
        m.ground.plane((0, 0, 0), (0, 0, 0))


# ---- forces that are not determined ----


@pytest.mark.parametrize(("friction", "holds"), [(0.3, True), (0.25, False)])
def test_ladder_between_floor_and_wall(friction, holds):
    """Steeper than atan((1 - mu^2) / (2 mu)), where both ends slide, it holds; its forces are not determined."""
    length = 2.0
    tangent = 1.7       # of its angle from the floor: (1 - mu^2) / (2 mu) is 1.52 and 1.88
    foot, top = (np.array(each) * length / np.hypot(1, tangent) for each in ((1.0, 0, 0), (0, 0, tangent)))
    along = (top - foot) / length
    axes = np.stack([along, [0, 1, 0], np.cross(along, [0, 1, 0])], axis=1)
    m = zd.Mechanism("ladder", gravity=(0, 0, -G), dimension=3)
    body = m.body("b", 5.0, np.diag([0.05, 1.7, 1.7]), at=(foot + top) / 2, rotation=axes)
    m.contact("foot", body.point((-length / 2, 0, 0)), m.ground.plane((0, 0, 0), (0, 0, 1)), friction=friction)
    m.contact("wall", body.point((length / 2, 0, 0)), m.ground.plane((0, 0, 0), (1, 0, 0)), friction=friction)
    sol = zd.simulate(m, 0.3)
    assert (states(sol) == [("sticking", "sticking")]) == holds
    assert (np.abs(sol["b.velocity"][-1]).max() < 1e-12) == holds


def test_pendulum_whose_end_sticks():
    m = zd.Mechanism("pendulum", gravity=(0, 0, -G), dimension=3)
    body = m.body("b", 1.0, np.diag([0.01, 0.08, 0.08]), at=(0.5, 0, 0))
    m.spherical("pin", m.ground.point((0, 0, 0)), body.point((-0.5, 0, 0)))
    m.contact("floor", body.point((0.5, 0, 0)), m.ground.plane((0, 0, -0.8), (0, 0, 1)), friction=0.2)
    m.start({"b.angular_velocity.z": 0.3})
    sol = zd.simulate(m, 1.0)
    assert states(sol) == [("open",), ("sticking",)]
    assert np.abs(sol["b.angular_velocity"][-1]).max() < 1e-12


def test_direction_of_an_impulse_is_found():
    """A point that slides down a slope hits a wall: the impulses, by sweeps of the projected Gauss-Seidel method."""
    mu, e = 0.107, 0.444
    normal = np.array([0.2939268519047165, 0.09211788890820324, 0.9513786313936627])
    m = zd.Mechanism("point", gravity=(0, 0, -G), dimension=3)
    point = m.particle("p", 1.0, at=(0, 0, 0))
    m.contact("slope", point, m.ground.plane((0, 0, 0), normal), friction=mu)
    m.contact("wall", point, m.ground.plane((0.3, 0, 0), (-1, 0, 0)), friction=mu, restitution=e)
    m.start({"p.velocity.y": 0.4, "p.velocity.z": -0.4 * normal[1] / normal[2]})
    sol = zd.simulate(m, 1.0)
    i = int(np.flatnonzero(sol.t == sol.impacts["t"][0])[0])
    before, after = sol["p.velocity"][i], sol["p.velocity"][i + 1]
    z, wall = np.zeros((2, 3)), np.array([-1.0, 0, 0])
    for _ in range(2000):
        for k, (n, restitution) in enumerate(((normal, 0.0), (wall, e))):
            v = before + z.sum(axis=0)
            N = max(0.0, z[k] @ n - (v + restitution * before) @ n)
            across = z[k] - z[k] @ n * n - (v - v @ n * n)
            z[k] = N * n + across * min(1.0, mu * N / max(np.linalg.norm(across), 1e-300))
    assert np.abs(after - before - z.sum(axis=0)).max() < 1e-9


@pytest.mark.parametrize("settings", [{}, {"rtol": 1e-9}, {"integrator": "radau"}], ids=str)
def test_slip_that_turns_as_it_ends(settings):
    """A ball that slides across a slope until it rolls: with equal friction, one solution for all methods."""
    angle = 0.3
    axes = slope(angle)
    m, body = ball(R * axes[:, 2])
    m.contact("slope", body, m.ground.plane((0, 0, 0), axes[:, 2]), radius=R, friction=0.3)
    moving(m, body, axes[:, :2] @ (0.3, 1.0))
    sol = zd.simulate(m, 1.0, **settings)
    mu, down = 0.3 * G * np.cos(angle), np.array([G * np.sin(angle), 0.0])

    def equations(_, y):        # velocity of the centre, and slip
        friction = -mu * y[2:] / np.hypot(*y[2:])
        return [*(down + friction), *(down + 3.5 * friction)]

    def rolls(_, y):
        return np.hypot(*y[2:]) - 1e-9
    rolls.terminal = True
    own = solve_ivp(equations, (0, 1), [0.3, 1.0, 0.3, 1.0], rtol=1e-12, atol=1e-14, events=rolls)
    assert states(sol)[0] == ("sliding",)
    assert states(sol)[-1] == ("sticking",)
    rolling = own.y[:2, -1] + down * 5 / 7 * (1.0 - own.t[-1])
    assert np.abs(axes[:, :2].T @ sol["ball.velocity"][-1] - rolling).max() < 2e-6
