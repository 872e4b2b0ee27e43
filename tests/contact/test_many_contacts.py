"""Uncoupled contacts, and friction of joints that other constraints block: against closed forms."""

import numpy as np
import pytest

import zerodrift as zd
from contact.space_scenes import mechanism_of, scene_of

G = 9.81
FRICTION = 0.3


@pytest.mark.parametrize(("boxes", "dimension", "options"), [
    (12, 2, {"rtol": 1e-8}), (12, 2, {"step": 0.01}), (5, 3, {"rtol": 1e-8})], ids=["plane", "fixed", "space"])
def test_each_box_slides_and_stops_as_if_it_were_alone(boxes, dimension, options):
    """v^2 / 2 mu g; together they have more contacts than one problem may have."""
    m = zd.Mechanism("boxes", gravity=(0, -G) if dimension == 2 else (0, 0, -G), dimension=dimension)
    floor = m.ground.line((0, 0), (1, 0)) if dimension == 2 else m.ground.plane((0, 0, 0), (0, 0, 1))
    speeds = 0.5 + 0.05 * np.arange(boxes)
    for i, speed in enumerate(speeds):
        inertia, at = (0.01, (i, 0.1)) if dimension == 2 else (np.diag([0.01, 0.01, 0.01]), (i, 0, 0.1))
        body = m.body(f"box{i}", 1.0 + i, inertia, at=at)
        corners = [(x, -0.1) for x in (-0.1, 0.1)] if dimension == 2 else [(x, y, -0.1) for x in (-0.1, 0.1) for y in (-0.1, 0.1)]
        for k, corner in enumerate(corners):
            m.contact(f"foot{i}{k}", body.point(corner), floor, friction=FRICTION)
        m.start({f"box{i}.velocity.x": float(speed)})
    sol = zd.simulate(m, 0.5, **options)
    moved = [sol[f"box{i}.position.x"][-1] - i for i in range(boxes)]
    assert np.abs(moved - speeds**2 / (2 * FRICTION * G)).max() < 1e-13     # rounding
    assert sum(word == "sticking" for word in sol.phases[-1].state.values()) == boxes * len(corners)


@pytest.mark.parametrize("pull", [1.0, 10.0])
@pytest.mark.parametrize("friction", [{"friction": 0.3, "radius": 0.05}, {"friction_torque": 8.0}], ids=["load", "bound"])
@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
def test_friction_of_a_joint_that_a_weld_holds_leaves_that_of_others_as_it_is(coordinates, friction, pull):
    """Its row is redundant, and rounding does not decide which row is left out."""
    m = zd.Mechanism("held", gravity=(0, -G))
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    m.revolute("pin", m.ground, link.start, **friction)
    m.weld("lock", m.ground, link, at=(0, 0), active=True)
    block = m.body("block", 1.0, 0.1, at=(10, 0))
    slide = m.prismatic("slide", m.ground, block, at=(10, 0), axis=(1, 0), friction_force=2.0)
    m.force("pull", block.point((0, 0)), value=pull, along=(1, 0))
    sol = zd.simulate(m.system(coordinates), 0.1, step=0.01)
    assert sol[slide.speed][-1] == pytest.approx(max(0.0, pull - 2.0) * 0.1, abs=1e-14)
    assert sol["slide.force.x"][-1] == pytest.approx(-min(pull, 2.0), abs=1e-13)
    assert sol["pin.angle"][-1] == pytest.approx(0.0, abs=1e-14)


def test_a_body_that_is_welded_stands_on_four_feet_beside_one_that_slides():
    m = zd.Mechanism("feet", gravity=(0, 0, -G), dimension=3)
    for name, x in (("held", 0.0), ("free", 1.0)):
        body = m.body(name, 1.0, np.diag([0.01, 0.01, 0.01]), at=(x, 0, 0.1))
        for k, (i, j) in enumerate(((1, 1), (1, -1), (-1, -1), (-1, 1))):
            m.contact(f"{name}{k}", body.point((0.1 * i, 0.1 * j, -0.1)), m.ground.plane((0, 0, 0), (0, 0, 1)), friction=FRICTION)
    m.weld("weld", m.ground, m["held"], at=(0, 0, 0.1), active=True)
    m.start({"free.velocity.x": 1.0})
    sol = zd.simulate(m, 0.5, rtol=1e-8)
    assert sol["free.position.x"][-1] == pytest.approx(1 + 1 / (2 * FRICTION * G), abs=1e-13)
    assert sol["held.position.x"][-1] == 0.0


def test_an_instant_of_a_change_costs_few_shorter_steps():
    """Four where the gap is a parabola of time: at the zero that is expected, and next to it."""
    m = zd.Mechanism("ball", gravity=(0, -G))
    ball = m.particle("ball", 1.0, at=(0, 0.05))
    m.contact("floor", ball, m.ground.line((0, 0), (1, 0)), restitution=1.0)
    sol = zd.simulate(m, 5.0, step=0.01)
    assert len(sol.impacts) == 25
    assert sol.stats["output_steps"] <= 6 * len(sol.impacts)


@pytest.mark.parametrize("count", [2, 3])
@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
def test_joints_that_stick_together_bear_a_force_within_their_bounds(coordinates, count):
    m = zd.Mechanism("sliders", gravity=(0, -G))
    block = m.body("block", 1.0, 0.1)
    bounds = np.arange(1.0, count + 1)
    for k, bound in enumerate(bounds):
        m.prismatic(f"s{k}", m.ground, block, at=(0, 0), axis=(1, 0) if k % 2 else (-1, 0), friction_force=float(bound))
    pull = 0.95 * bounds.sum()
    m.force("pull", block.point((0, 0)), value=pull, along=(1, 0))
    sol = zd.simulate(m.system(coordinates), 0.1, step=0.01)
    assert [sol[f"s{k}.force.x"][-1] for k in range(count)] == pytest.approx(-0.95 * bounds, rel=1e-12)
    assert sol["block.position.x"][-1] == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("options", [{"rtol": 1e-10}, {"step": 0.01}])
def test_an_impact_that_follows_an_action_at_its_instant_is_listed(options):
    """A rod is released from its pin as its end strikes the floor: against one released a little earlier."""
    impacts = []
    for height in (-0.5, -0.4999999):
        m = zd.Mechanism("rod", gravity=(0, -G))
        rod = m.link("rod", (0, 0), (1, 0), mass=1.0)
        m.revolute("pin", m.ground, rod.start, active=True)
        m.contact("floor", rod.end, m.ground.line((0, -0.5), (1, -0.5)), restitution=0.5)
        released = zd.Event("rod.end.position.y", value=height, direction=-1, then={"pin": False})
        sol = zd.simulate(m, 0.4, events=[released], **options)
        impacts.append(sol.impacts[0])
        assert np.abs(sol.energy_violation).max() < 1e-6
    assert list(impacts[0])[2:] == pytest.approx(list(impacts[1])[2:], rel=1e-6)    # the distance of the heights


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_a_speed_follows_its_input_through_a_change_of_phase(friction):
    """Within a fixed step, as the block on a belt begins to slide."""
    m = zd.Mechanism("belt", gravity=(0, -G))
    belt = m.body("belt", 10.0, 1.0)
    slide = m.prismatic("slide", m.ground, belt, at=(0, 0), axis=(1, 0))
    m.motor("drive", slide, speed=0.0)
    m.contact("on belt", m.particle("block", 2.0, at=(0, 0)), belt.line((0, 0), (1, 0)), friction=friction)
    run = zd.Run(m, step=0.01, inputs=["drive.speed"], record=True)
    run.step(5)
    run["drive.speed"] = 1.0
    run.step(5)
    sol = run.solution()
    assert sol[slide.displacement][-1] == pytest.approx(0.045, abs=1e-13)   # 1 m/s, half of it in the step of the ramp
    assert np.abs(sol.energy_violation).max() < 1e-12


@pytest.mark.parametrize(("seed", "closed"), [(59, 4), (87, 2)])
def test_bodies_in_space_come_to_rest_after_chatter(seed, closed):
    """A plate on three feet with a ball on it, at one instant in free fall together; a rod between floor and wall."""
    _, bodies, contacts = scene_of(seed)
    sol = zd.simulate(mechanism_of(bodies, contacts), 0.5 if seed == 87 else 0.1, rtol=1e-9, max_steps=2000)
    assert sum(word == "sticking" for word in sol.phases[-1].state.values()) == closed


def pulled(law, coordinates="joint"):
    """A block of 2 kg with another one on a pin, pulled along the floor by a force that reads the reaction of the pin."""
    m = zd.Mechanism("pulled", gravity=(0, -G))
    block, load = m.body("block", 2.0, 0.1, at=(0, 0)), m.body("load", 2.0, 0.1, at=(0, 0))
    for k, x in enumerate((-0.1, 0.1)):
        m.contact(f"foot{k}", block.point((x, 0)), m.ground.line((0, 0), (1, 0)), friction=0.2)
    m.revolute("pin", block, load, at=(0, 0))
    m.force("pull", block.point((0, 0)), along=(1, 0), value=law, of={"n": "pin.force.y"})
    return m.system(coordinates)


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
def test_laws_that_read_reactions_decide_what_slides(coordinates):
    """The pin bears 2 g once the feet are pressed: 0.3 of it holds within 0.2 * 4 g, 0.5 does not."""
    sol = zd.simulate(pulled(lambda n: 0.3 * n, coordinates), 1.0, step=0.01)
    assert sol["block.velocity.x"][-1] == pytest.approx(0, abs=1e-15)
    sol = zd.simulate(pulled(lambda n: 0.5 * n, coordinates), 1.0, step=0.01)
    assert sol["block.velocity.x"][-1] == pytest.approx((0.5 * 2 - 0.2 * 4) * G / 4, rel=1e-12)
    assert sol["load.acceleration"][-1] == pytest.approx([(0.5 * 2 - 0.2 * 4) * G / 4, 0], abs=1e-12)
    assert sol["pin.force"][-1] == pytest.approx([(0.5 * 2 - 0.2 * 4) * G / 2, 2 * G], rel=1e-12)


@pytest.mark.parametrize(("pull", "slides"), [(3.0, 0.0), (7.0, 7.0 - 0.6 * G)])
def test_a_law_that_presses_holds_what_slid_without_it(pull, slides):
    """N = 2 g with half of it from the law; the pull is beyond 0.3 g."""
    m = zd.Mechanism("pressed", gravity=(0, -G))
    body = m.particle("body", 1.0, at=(0, 0))
    m.contact("floor", body, m.ground.line((0, 0), (1, 0)), friction=0.3)
    m.force("press", body, along=(0, -1), value=lambda n: 0.5 * n, of={"n": "floor.force.y"})
    m.force("pull", body, along=(1, 0), value=pull)
    sol = zd.simulate(m, 1.0, step=0.01)
    assert sol["body.velocity.x"][-1] == pytest.approx(slides, abs=1e-12)
    assert sol["floor.force.y"][-1] == pytest.approx(2 * G, rel=1e-12)


def test_friction_read_by_a_law_holds_another_body():
    """The friction of one block, 0.6 g, of which 0.4 pull another that holds 0.3 g."""
    m = zd.Mechanism("two", gravity=(0, -G))
    one, two, line = m.particle("one", 1.0, at=(0, 0)), m.particle("two", 2.0, at=(1, 0)), m.ground.line((0, 0), (1, 0))
    m.contact("a", one, line, friction=0.3)
    m.contact("b", two, line, friction=0.3)
    m.force("on two", two, along=(1, 0), value=lambda n: n, of={"n": "a.force.y"})
    m.force("on one", one, along=(1, 0), value=lambda f: 0.4 * f, of={"f": "b.force.x"})
    sol = zd.simulate(m, 1.0, step=0.01)
    assert sol["one.velocity.x"][-1] == 0
    assert sol["two.velocity.x"][-1] == pytest.approx((1 - 0.6) * G / 2, rel=1e-12)


def test_laws_that_lead_from_each_state_to_another_are_named():
    """Each of two blocks is pulled by 4 N and, in opposite senses, by 2.5 times the friction of the other one."""
    m = zd.Mechanism("two", gravity=(0, -G))
    for k in range(2):
        m.contact(f"c{k}", m.particle(f"b{k}", 1.0, at=(k, 0)), m.ground.line((0, 0), (1, 0)), friction=0.3)
    for k, sign in enumerate((1, -1)):
        m.force(f"pull{k}", m[f"b{k}"], along=(1, 0), value=4.0)
        m.force(f"cross{k}", m[f"b{k}"], along=(1, 0), value=lambda f, sign=sign: 2.5 * sign * f, of={"f": f"c{1 - k}.force.x"})
    with pytest.raises(zd.NoUniqueMotion, match="must agree with the forces that laws read"):
        zd.simulate(m, 1.0, step=0.01)


@pytest.mark.parametrize("height", [0.0, 1.0])
def test_laws_read_the_force_of_a_contact(height):
    """A particle that is pulled with half the force by which it is pressed to the floor, from its landing on."""
    m = zd.Mechanism("fed", gravity=(0, -G))
    body = m.particle("body", 2.0, at=(0, height))
    m.contact("floor", body, m.ground.line((0, 0), (1, 0)), friction=0.2)
    m.force("pull", body, along=(1, 0), value=lambda n: 0.5 * n, of={"n": "floor.force.y"})
    sol = zd.simulate(m, 1.0, step=0.01)
    assert sol["body.velocity.x"][-1] == pytest.approx(0.3 * G * (1 - np.sqrt(2 * height / G)), rel=1e-12)
    assert sol["pull.force"][-1] == pytest.approx(G)
    assert np.abs(sol.energy_violation).max() < 1e-12
