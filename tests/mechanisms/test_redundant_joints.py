"""Constraints that the tree of joint coordinates satisfies: braces within welded bodies, second hinges, bearings and rails."""

import warnings

import numpy as np
import pytest

import zerodrift as zd

FORMULATIONS = list(zd.formulations())
FINE = {"integrator": "dop853", "rtol": 1e-10, "atol": 1e-10}
AGREE = 1e-7        # of motions at these tolerances, over a second; forces are a hundred times as large as positions here


def braced(kind, seed):
    """A pendulum of two bodies that are welded together, and a brace between them at random places."""
    random = np.random.default_rng(seed)
    a, b, c, p, q = random.uniform(-1, 1, (5, 2))
    m = zd.Mechanism("braced", gravity=(0, -9.81))
    arm, leg = m.link("arm", a, b, mass=1.0), m.link("leg", b, c, mass=1.0)
    m.revolute("hinge", m.ground, arm.start)
    m.weld("corner", arm.end, leg.start)
    between = arm.point(at=p), leg.point(at=q)
    ends = {"rod": between, "actuator": between, "slot": (arm, leg.point(at=p))}
    length = float(np.linalg.norm(p - q))
    given = {"rod": {}, "actuator": {"length": length}, "slot": {"axis": q}, "prismatic": {"axis": q, "at": p}}
    getattr(m, kind)("brace", *ends.get(kind, (arm, leg)), **given.get(kind, {"at": p}))
    return m


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kind", ["rod", "actuator", "slot", "prismatic", "revolute", "weld"])
def test_a_brace_within_welded_bodies_changes_nothing(kind, seed):
    m = braced(kind, seed)
    runs = [zd.simulate(m.system(each), 1.0, t_eval=np.linspace(0, 1, 11), **FINE) for each in ("absolute", "joint")]
    assert runs[1].stats["rank"] == 0
    np.testing.assert_allclose(runs[1]["leg.end.position"], runs[0]["leg.end.position"], atol=AGREE)
    np.testing.assert_allclose(runs[1]["hinge.force"], runs[0]["hinge.force"], atol=1e3 * AGREE)


def test_it_swings_as_without_the_brace(formulation):
    swings = zd.simulate(braced("rod", 5), 1.0, step=0.01, formulation=formulation)
    assert np.ptp(swings["arm.angle"]) > 0.5
    assert abs(swings.energy_violation).max() < 1e-5


def on_two(kind, axis, at, apart):
    """A body that is held twice along one axis."""
    m = zd.Mechanism(kind, dimension=3, gravity=(0, 0, -9.81))
    body = m.body("b", 2.0, (0.3, 0.2, 0.1), at=(0.2, -0.3, 0.4))
    first, second = {"shaft": ("revolute", "cylindrical"), "door": ("revolute",) * 2, "drawer": ("prismatic",) * 2}[kind]
    getattr(m, first)("first", m.ground, body, at=at, axis=axis)
    getattr(m, second)("second", m.ground, body, at=at + apart, axis=axis)
    m.start({"first.speed": 2.0})
    return m


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kind", ["shaft", "door", "drawer"])
def test_a_second_bearing_or_rail_at_any_place(kind, seed):
    random = np.random.default_rng(seed)
    axis, at = random.standard_normal(3), random.uniform(-0.8, 0.8, 3)
    axis /= np.linalg.norm(axis)
    m = on_two(kind, axis, at, np.array([0.1, 0.2, 0.3]) if kind == "drawer" else 0.5 * axis)
    want = zd.simulate(m.system("absolute"), 0.3, t_eval=np.linspace(0, 0.3, 7), **FINE)
    for formulation in FORMULATIONS:
        sol = zd.simulate(m.system("joint"), 0.3, t_eval=np.linspace(0, 0.3, 7), formulation=formulation, **FINE)
        np.testing.assert_allclose(sol["b.position"], want["b.position"], atol=AGREE)


def bolted(turn, times):
    """Two bodies that one hinge or two hinges join, drawn at an angle."""
    m = zd.Mechanism("bolted", gravity=(0, -9.81))
    c, s = np.cos(turn), np.sin(turn)
    one, two, *hinges = [np.array([c * x - s * y, s * x + c * y]) for x, y in [(0, 0), (0.3, 0), (0.4, 0.1), (0.9, 0.0)]]
    first = m.link("one", one, one + np.array([c, s]), mass=1.0)
    second = m.link("two", two, two + np.array([c - 0.2 * s, s + 0.2 * c]), mass=1.0)
    m.revolute("axle", m.ground, first.start)
    if times == 1:
        m.weld("bolt", first, second, at=hinges[0])
    for name, at in zip(("left", "right"), hinges[:times if times > 1 else 0], strict=False):
        m.revolute(name, first, second, at=at)
    m.start({"one.angular_velocity": 3.0})
    return m


@pytest.mark.parametrize("turn", [0.0, 1.1, 2.9])
def test_the_constraint_that_is_left_out_follows_the_motion(turn, formulation):
    """Each constraint of the second hinge vanishes at some angle, and the other one holds there."""
    at = np.linspace(0, 5, 6)
    want = zd.simulate(bolted(turn, 1), 5.0, t_eval=at, **FINE)
    sol = zd.simulate(bolted(turn, 2).system("joint"), 5.0, t_eval=at, formulation=formulation, **FINE)
    np.testing.assert_allclose(sol["one.angle"], want["one.angle"], atol=1e-6)
    assert sol.stats["steps"] < 3 * want.stats["steps"]


def on_balls(balls):
    m = zd.Mechanism("balls", dimension=3, gravity=(0, 0, -9.81))
    inner = m.body("inner", 1.0, (0.1, 0.2, 0.3), at=(0.3, 0, 0))
    outer = m.body("outer", 1.5, (0.3, 0.2, 0.1), at=(0.6, 0.2, 0.1))
    m.spherical("ball 0", m.ground, inner, at=(0, 0.1, 0))
    m.revolute("hinge", inner, outer, at=(0.5, 0, 0), axis=(0, 0, 1))
    for i in range(1, balls):
        m.spherical(f"ball {i}", m.ground, inner, at=(0, 0.1, 0))
    m.start({"inner.angular_velocity": (1.0, 2.0, 3.0)})
    return m


def test_reactions_read_after_a_run_are_those_that_were_recorded(formulation):
    at = np.linspace(0, 0.5, 6)
    want = zd.simulate(on_balls(1).system("joint"), 0.5, t_eval=at, **FINE)
    how = {"t_eval": at, "formulation": formulation, **FINE}
    sol = zd.simulate(on_balls(2).system("joint"), 0.5, **how)
    recorded = zd.simulate(on_balls(2).system("joint"), 0.5, outputs=["hinge.force"], **how)
    np.testing.assert_allclose(sol["hinge.force"], want["hinge.force"], atol=1e-6)
    np.testing.assert_allclose(sol["hinge.force"], recorded["hinge.force"], atol=1e-9)
    np.testing.assert_allclose(sol["ball 0.force"] + sol["ball 1.force"], want["ball 0.force"], atol=1e-6)
    assert sol.unique("hinge.force").all()
    assert not sol.unique("ball 0.force").any()


def test_a_formula_of_reactions_is_unique_if_these_are():
    m = on_balls(2)
    for name, joint in (("whole", "hinge"), ("part", "ball 0")):
        m.measure(name, lambda x, y, z: np.sqrt(x**2 + y**2 + z**2),
                  of=dict(zip("xyz", (f"{joint}.force.{axis}" for axis in "xyz"), strict=True)))
    sol = zd.simulate(m, 0.1, step=0.01, outputs=["part"])
    assert sol.unique("whole")
    assert not sol.unique("part")
    for name, joint in (("whole", "hinge"), ("part", "ball 0")):
        np.testing.assert_allclose(sol[name], np.linalg.norm(sol[f"{joint}.force"], axis=1), rtol=1e-9)


def with_a_handle(hinges):
    """A door whose axis is not upright, with a handle that swings on it."""
    m = zd.Mechanism("door", dimension=3, gravity=(0, 0, -9.81))
    door = m.body("door", 20.0, (3.0, 2.0, 1.0), at=(0.4, 0, 1.0))
    for i in range(hinges):
        m.revolute(f"hinge {i}", m.ground, door, at=(0.07 * i, 0, 0.3 + 1.4 * i), axis=(0.05, 0, 1))
    handle = m.link("handle", (0.7, 0, 1.0), (0.7, -0.1, 0.8), mass=1.0)
    m.revolute("pin", door, handle.start, axis=(0, 1, 0))
    m.start({"hinge 0.speed": 2.0, "pin.speed": 1.0})
    return m


def test_what_a_door_carries_is_known_and_how_its_hinges_share_their_own_load_is_not(formulation):
    how = {"t_eval": np.linspace(0, 0.5, 6), "formulation": formulation, **FINE}
    want, sol = (zd.simulate(with_a_handle(hinges).system("joint"), 0.5, **how) for hinges in (1, 2))
    np.testing.assert_allclose(sol["pin.force"], want["pin.force"], atol=1e-6)
    np.testing.assert_allclose(sol["hinge 0.force"] + sol["hinge 1.force"], want["hinge 0.force"], atol=1e-5)      # of 208 N
    assert sol.unique("pin.force").all()
    assert not sol.unique("hinge 0.force").all()


def test_a_certificate_of_a_braced_pendulum_holds():
    m = braced("rod", 5)
    found = zd.reference(m, 1.0, error=1e-9, t_eval=[1.0])
    want = zd.simulate(m.system("absolute"), 1.0, rtol=1e-12, atol=1e-12, integrator="dop853", t_eval=[1.0])
    assert abs(found.solution["arm.angle"] - want["arm.angle"]).max() < found.error


def locked_on_rails(bodies):
    """Bodies on a hinge and in a slot each, which together lock them with one constraint too many, and a pendulum."""
    random = np.random.default_rng(3)
    m = zd.Mechanism("locked", dimension=3, gravity=(0, 0, -9.81))
    for i in range(bodies):
        body = m.body(f"b{i}", 1.0, (0.3, 0.2, 0.1), at=random.normal(size=3))
        m.revolute(f"hinge {i}", m.ground, body, at=random.normal(size=3), axis=random.normal(size=3))
        m.slot(f"slot {i}", m.ground, body.point(at=random.normal(size=3)), axis=random.normal(size=3))
    bob = m.body("bob", 1.0, (0.3, 0.2, 0.1), at=(1, 0, 0))
    m.revolute("pin", m.ground, bob, at=(0, 0, 0), axis=(0, 1, 0))
    return m.system("absolute")


@pytest.mark.parametrize("bodies", [4, 6])
def test_constraints_of_what_cannot_move_are_counted_among_few_and_many(bodies, formulation):
    """Above forty constraints they are found by a random velocity, which is rounding error where nothing can move."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", zd.AccuracyWarning)
        sol = zd.simulate(locked_on_rails(bodies), 0.3, formulation=formulation, **FINE)
    assert sol.stats["rank"] == 6 * bodies + 5
    assert len(sol.stats["redundant"]) == bodies
    free = zd.simulate(locked_on_rails(0), 0.3, **FINE)
    np.testing.assert_allclose(sol["bob.position"][-1], free["bob.position"][-1], atol=AGREE)


def test_contradictions_among_welded_bodies_are_refused():
    """A cylinder cannot lengthen between bodies that are welded together."""
    m = zd.Mechanism("pulled apart", gravity=(0, -9.81))
    arm, leg = m.link("arm", (0, 0), (1, 0), mass=1.0), m.link("leg", (1, 0), (1, 1), mass=1.0)
    m.revolute("hinge", m.ground, arm.start)
    m.weld("corner", arm.end, leg.start)
    m.actuator("jack", arm.start, leg.end, length=lambda t: np.sqrt(2) + 0.1 * t)
    with pytest.raises((zd.ZerodriftError, ValueError), match="jack"):
        zd.simulate(m.system("joint"), 1.0, step=0.01)
