"""Mechanisms as they are drawn: what is wrong is said at once, with its name, its value and what is allowed."""

import pickle

import numpy as np
import pytest
import sympy as sp

import tolerances as tol
import zerodrift as zd
from support import refused


@pytest.fixture
def m():
    return zd.Mechanism("m", gravity=(0, -9.81), parameters={"amplitude": 0.1})


@pytest.fixture
def link(m):
    return m.link("link", (0, 0), (1, 0), mass=1.0)


@pytest.fixture
def pin(m, link):
    return m.revolute("pin", m.ground, link.start)


# ---- names ----


@pytest.mark.parametrize("name", ["", " ", "a.b", " a", "a ", "é", "a\n"])
def test_a_name_is_letters_digits_and_blanks(m, name):
    with refused("wrong-value", r"name of a body must be of letters, digits, blanks inside, '_' and '-', not "):
        m.body(name, 1.0)


def test_a_name_is_a_string(m):
    with refused("wrong-type", "not 3"):
        m.body(3, 1.0)


@pytest.mark.parametrize("add", [
    lambda m: m.body("link", 1.0), lambda m: m.link("link", (0, 0), (1, 0)), lambda m: m.particle("link", 1.0, at=(0, 0)),
    lambda m: m.point("link", m.ground, (0, 0)), lambda m: m.ground.point((0, 0), name="link"),
    lambda m: m.revolute("link", m.ground, m["link"].start),
    lambda m: m.spring("ground", m.ground.point((0, 0)), m["link"].end, stiffness=1.0)])
def test_a_name_is_taken_once(m, link, add):
    with refused("duplicate-name", r"name '(link|ground)' is taken"):
        add(m)


def test_elements_are_found_by_name(m, link, pin):
    assert m["link"] is link
    assert (m.bodies, m.joints, m.motors) == ((link,), (pin,), ())
    with refused("wrong-name", "'rod'"):
        m["rod"]


# ---- bodies and points ----


@pytest.mark.parametrize(("add", "code", "error"), [
    (lambda m: m.body("b", -1.0), "out-of-range", "'b'.*least 0, not -1"),
    (lambda m: m.body("b", 1.0, -0.1), "out-of-range", "'b'.*least 0, not -0.1"),
    (lambda m: m.body("b", 1.0, at=(1, 2, 3)), "shape", "'b'.*2"),
    (lambda m: m.body("b", 1.0, com=(np.nan, 0)), "not-finite", "'b'"),
    (lambda m: m.link("l", (1, 1), (1, 1), 1.0), "geometry", "'l'"),
    (lambda m: m.link("l", (0, 0), (1, 1), 1.0, length=0.0), "out-of-range", "'l'.*than 0, not 0"),
    (lambda m: m.link("l", (0, 0), (1, 1), 1.0, inertia=-1.0), "out-of-range", "'l'.*least 0, not -1"),
    (lambda m: m.particle("p", -2.0, at=(0, 0)), "out-of-range", "'p'.*least 0, not -2"),
    (lambda m: m.prismatic("s", m.ground, m.body("b", 1.0), axis=(0, 0)), "geometry", "'s'"),
    (lambda m: m.slot("s", m.ground, m.particle("p", 1.0, at=(0, 0)), axis=(0, 0)), "geometry", "'s'"),
    (lambda m: m.knife_edge("k", m.body("b", 1.0), along=(0, 0)), "geometry", "'k'"),
    (lambda m: m.force("f", m.body("b", 1.0), along=(0, 0), value=1.0), "geometry", "'f'"),
    (lambda m: m.rolling("r", m.ground, m.body("b", 1.0), radius=-1.0), "out-of-range", "'r'.*than 0, not -1"),
    (lambda m: m.rod("r", m.ground.point((0, 0)), m.particle("p", 1.0, at=(0, 0))), "out-of-range", "'r'"),
    (lambda m: m.revolute("r", m.ground, m.body("b", 1.0), at=(0, 0), damping=-1.0), "out-of-range", "'r'.*least 0, not -1"),
])
def test_numbers_are_checked_where_they_are_given(m, add, code, error):
    with refused(code, error):
        add(m)


@pytest.mark.parametrize(("given", "code", "error"), [
    ({"along": (0, 1)}, "missing-argument", "'f'.*0.0, -10.0"),
    ({"value": 5.0}, "missing-argument", "'f'.*0.0, -10.0"),
    ({"value": (0, 5.0), "along": (0, 1)}, "conflicting-arguments", "'f'"),
    ({"value": (0, 5.0, 1.0)}, "shape", "'f'.*2"),
    ({"value": (0, 0)}, "geometry", "'f'"),
])
def test_a_force_without_direction_or_magnitude_is_refused_with_what_is_missing(m, given, code, error):
    body = m.body("b", 1.0)
    with refused(code, error):
        m.force("f", body, **given)
    with refused("missing-argument"):
        m.force("f", body, (0, 1))      # as it is typed first


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_force_given_as_a_vector_is_its_magnitude_along_its_direction(dimension):
    vector = np.array([3.0, -4.0, 12.0])[:dimension]
    forces = []
    for given in ({"value": vector}, {"value": float(np.linalg.norm(vector)), "along": vector / 7}):
        m = zd.Mechanism("one body", dimension=dimension)
        body = m.body("b", 1.0, 0.1, angle=0.3) if dimension == 2 else m.body("b", 1.0, np.eye(3))
        m.force("f", body, **given)
        system = m.system()
        forces.append(system.evaluate(system.p0, system.v0).f)
    np.testing.assert_allclose(forces[0], forces[1], rtol=tol.SAME)
    np.testing.assert_allclose(forces[0][:dimension], vector, rtol=tol.SAME)


@pytest.mark.parametrize("name", ["a.b", "t", "p", "two words"])
def test_parameters_have_names_that_callables_can_take(name):
    with pytest.raises(ValueError, match=r"parameters"):
        zd.Mechanism("m", parameters={name: 1.0})


def test_a_point_has_one_place(m, link):
    for given in ({}, {"local": (0, 0), "at": (0, 0)}):
        with refused("conflicting-arguments", "'link'"):
            link.point(**given)


def test_only_named_points_have_measures(m, link):
    assert link.point((0.5, 0), name="P").position.x.name == "P.position.x"
    with refused("wrong-attribute", "link.point"):
        _ = link.point((0.5, 0)).position


def test_a_particle_has_no_angle(m):
    with refused("wrong-attribute", "'bob'"):
        _ = m.particle("bob", 1.0, at=(0, 0)).angle


def test_the_frame_of_a_link(m):
    link = m.link("link", (1, 1), (1, 3), mass=12.0)
    np.testing.assert_allclose((link.length, link.inertia, link.pose.angle), (2.0, 4.0, np.pi / 2))
    np.testing.assert_allclose(link.point((0.5, 0)).drawn, (1, 1.5), atol=1e-15)
    np.testing.assert_allclose(link.point(at=(0, 1)).local, (0, 1), atol=1e-15)


# ---- joints ----


def test_a_joint_joins_two_bodies(m, link):
    with refused("wrong-element", "'j'.*'link'"):
        m.revolute("j", link.start, link.end)
    with refused("wrong-element", "'s'.*'link'"):
        m.spring("s", link.start, link.end, stiffness=1.0)


def test_two_bodies_need_a_place(m, link):
    with refused("missing-argument", "'j'.*'ground' and 'link'"):
        m.revolute("j", m.ground, link)
    with refused("conflicting-arguments", "'j'"):
        m.revolute("j", m.ground, link.start, at=(0, 0))


def test_points_belong_to_the_mechanism(m, link):
    stranger = zd.Mechanism("other").link("link", (0, 0), (1, 0), mass=1.0)
    with refused("wrong-element", "second.*'m'"):
        m.revolute("j", m.ground, stranger.start)
    with refused("wrong-type", "second.*link.end or body.point"):
        m.revolute("j", m.ground, (0, 0))
    with refused("wrong-element", "first.*'link'.*link.point"):
        m.rod("r", link, m.ground.point((0, 0)))


def test_a_body_and_a_point_meet_where_the_point_is_drawn(m, link):
    other = m.body("other", 1.0, at=(1, 1), angle=np.pi / 2)
    joint = m.revolute("j", link.end, other)
    np.testing.assert_allclose(joint.second.local, (-1, 0), atol=1e-15)


@pytest.mark.parametrize("add", [
    lambda m, p: m.prismatic("j", m.ground, p, axis=(1, 0)), lambda m, p: m.weld("j", m.ground.point((0, 0)), p),
    lambda m, p: m.revolute("j", m.ground.point((0, 0)), p, damping=1.0),
    lambda m, p: m.slot("j", p, m.ground.point((0, 0)), axis=(1, 0)),
    lambda m, p: m.motor("j", m.revolute("r", m.ground.point((0, 0)), p), speed=1.0),
    lambda m, p: m.torque("j", p, value=1.0), lambda m, p: m.knife_edge("j", p, along=(1, 0))])
def test_what_needs_an_orientation_refuses_a_particle_by_name(m, add):
    with refused("wrong-element"):
        add(m, m.particle("bob", 1.0, at=(0, 0)))


# ---- drives and laws ----


@pytest.mark.parametrize("given", [{}, {"angle": 1.0, "speed": 2.0}])
def test_a_motor_has_one_law(m, pin, given):
    with refused("conflicting-arguments", "'drive'"):
        m.motor("drive", pin, **given)


def test_a_motor_drives_what_the_joint_has(m, pin):
    with refused("wrong-element", "'drive'.*'pin'"):
        m.motor("drive", pin, displacement=1.0)


def test_two_motors_on_one_freedom_are_named(m, pin):
    m.motor("torque", pin, torque=1.0)
    m.motor("one", pin, speed=1.0)
    with refused("prescribed-twice", "'one' and 'two'.*'pin'"):
        m.motor("two", pin, angle=1.0)


def test_a_start_against_a_motor_names_both(m, pin):
    m.motor("drive", pin, speed=1.0)
    with refused("prescribed-twice", "'pin.speed'.*'drive'"):
        m.start({pin.speed: 2.0})


def test_callables_that_ask_for_what_is_not_there(m, link, pin):
    with refused("user-function", "'drive'.*'x'"):
        m.motor("drive", pin, torque=lambda x: x, of={"s": pin.angle})
    with refused("user-function", "'f'.*'y'"):
        m.force("f", link, along=(1, 0), value=sp.Symbol("y"))
    with refused("wrong-name", "'f'.*'rod.angle'.*'rod'.*'m'"):
        m.force("f", link, along=(1, 0), value=lambda a: a, of={"a": "rod.angle"})
    with refused("wrong-type", "'f'"):
        m.force("f", link, along=(1, 0), value=lambda a: a, of=[pin.angle])


@pytest.mark.parametrize("measure", ["link.colour", "link.angle.x", "link.position", "pin.force", "pin.displacement",
                                     "link.position.z"])
def test_laws_depend_on_scalar_measures_of_positions_and_velocities(m, link, pin, measure):
    with refused("wrong-measure"):
        m.force("f", link, along=(1, 0), value=lambda a: a, of={"a": measure})


def test_drives_and_holonomic_constraints_do_not_depend_on_velocities(m, link, pin):
    with refused("wrong-measure", "'pin.speed'"):
        m.motor("drive", pin, speed=lambda w: w, of={"w": pin.speed})
    with refused("wrong-measure", "'link.velocity.x'"):
        m.constraint("c", lambda u: u, of={"u": link.velocity.x})


def test_a_nonholonomic_constraint_is_linear(m, link):
    m.nonholonomic("c", lambda u: u**2, of={"u": link.velocity.x})
    with refused("user-function", "'c'"):
        m.system()


@pytest.mark.parametrize("profile", [([0, 1], [0, 1]), ([0, 2, 1], [0, 1, 2]), ([0, 3, 6.3], [0, 1, 2]), ([0, 1, 2],), 3.0,
                                     sp.Symbol("a") * sp.Symbol("b")])
def test_the_profile_of_a_cam_is_checked(m, pin, profile):
    with pytest.raises((ValueError, TypeError), match=r"of (profile of )?'cam'"):
        m.cam("cam", pin, "link.angle", profile=profile)


@pytest.mark.parametrize("ratio", [0.0, np.inf])
def test_gears_have_a_ratio(m, link, pin, ratio):
    other = m.revolute("other", link.end, m.link("next", (1, 0), (2, 0), mass=1.0).start)
    with pytest.raises(ValueError, match=r"ratio of 'gear' must"):
        m.gear("gear", pin, other, ratio=ratio)
    with refused("wrong-element", "'gear'.*'pin'"):
        m.gear("gear", pin, pin, ratio=1.0)


# ---- start ----


def test_a_start_names_what_there_is(m, link, pin):
    with refused("wrong-name", "'rod.angle'.*'rod'.*'m'"):
        m.start({"rod.angle": 1.0})
    with refused("wrong-type", "crank.angle.*not 3"):
        m.start({3: 1.0})
    for name, first in (("link.angel", "link.angle"), ("pin", "pin"), ("pin.force", "pin"), ("link.end.velocty", "link.end.vel")):
        with refused("wrong-name", rf"start must name a measure .*, not '{name}'; .*can be given: {first}"):
            m.start({"link.angle": 9.0, name: 1.0})
    with refused("shape", r"wish\['link.position'\].*have 2.*not 1"):
        m.start(wish={link.position: 1.0})
    np.testing.assert_allclose(m.system().p0, [0.0])      # nothing of what was refused is kept


def test_later_starts_add_replace_and_take_back(m, link, pin):
    m.start({link.angle: 0.5, "pin.speed": 1.0})
    m.start({"link.angle": 0.25, pin.speed: None})
    np.testing.assert_allclose(m.system().p0, [0.25])
    np.testing.assert_allclose(m.system().v0, [0.0])


# ---- snapshots ----


def test_what_is_added_later_changes_no_system(m, link, pin):
    system = m.system()
    m.spring("spring", m.ground.point((0, 1)), link.end, stiffness=1.0)
    assert "spring.force" not in system.measures
    assert "spring.force" in m.system().measures
    assert system.nq == 1


def test_a_system_can_be_pickled(m, link, pin):
    m.motor("drive", pin, torque=0.3)
    m.force("wind", link, along=(1, 0), value=sp.Symbol("t") * sp.Symbol("amplitude") + sp.Symbol("pin.angle"))
    system = m.with_parameters({"link.mass": 2.0})
    again = pickle.loads(pickle.dumps(system))
    runs = [zd.simulate(each, 1.0, step=0.01) for each in (system, again)]
    assert (runs[0].p == runs[1].p).all()
    assert again.parameters == system.parameters


def test_coordinates_are_one_of_two(m, link, pin):
    with refused("unknown-choice", "coordinates.*'joint', 'absolute', not 'relative'"):
        m.system("relative")


def test_numbers_change_by_path_and_what_follows_from_them(m, link, pin):
    changed = m.with_parameters({"link.length": 2.0, "link.mass": 3.0}, amplitude=0.5).parameters
    assert changed["link.inertia"] == 1.0
    assert changed["amplitude"] == 0.5
    for path, value, error in (("link.mass", -1.0, "must be at least 0"), ("link.length", 0.0, "must be greater than 0"),
                               ("link.colour", 1.0, "must be one of")):
        with pytest.raises(ValueError, match=error):
            m.with_parameters({path: value})


def test_a_state_is_for_systems_alone(m, link, pin):
    with refused("conflicting-arguments", "'m'"):
        zd.simulate(m, 1.0, [0.0], step=0.1)
    assert zd.simulate(m.system("joint"), 1.0, [0.3], step=0.1).p[0, 0] == 0.3
