"""Models with contacts against a program that shares nothing with the package, and against the literature."""

import math

import numpy as np
import pytest
import sympy as sp

import zerodrift as zd
from event_driven import Contact, Machine

G = 9.81
FINE = {"rtol": 1e-10, "atol": 1e-12}
T, Q, V = sp.Symbol("t"), sp.symbols("q1:4"), sp.Matrix(sp.symbols("v1:4"))


def velocity(place, count):
    """Velocity of a place (2,) that depends on the first coordinates."""
    return place.jacobian(Q[:count]) * V[:count, :]


def kinetic(mass, place, count):
    speed = velocity(place, count)
    return mass * speed.dot(speed) / 2


def direction(angle):
    return sp.Matrix([sp.cos(angle), sp.sin(angle)])


def test_a_trebuchet_from_rest_to_landing():
    """Angles of arm, hanger and sling until the sling lets go; then the projectile flies, and the arm hits the beam."""
    m = zd.models.trebuchet()
    sol = zd.simulate(m, 5.0, **FINE)
    arm, hanger, sling = Q
    axle, beam = sp.Matrix([0, 2.6]), -0.2 - math.pi / 2        # the arm's angle at the beam
    tip, end, middle = axle - 3.6 * direction(arm), axle + 1.2 * direction(arm), axle - 1.2 * direction(arm)
    weight, ball = end + direction(hanger - sp.pi / 2), tip + 2.8 * direction(sling)
    rotation = 15 * 4.8**2 / 12 * V[0]**2 / 2 + 15 * V[1]**2 / 2
    heights = 15 * middle[1] + 150 * weight[1]
    energy = kinetic(15, middle, 3) + kinetic(150, weight, 3) + rotation
    stop = Contact(arm - beam, None, 0.3)
    whole = Machine(Q, V, T, energy + kinetic(12, ball, 3), G * (heights + 12 * ball[1]),
                    [Contact(ball[1], velocity(ball, 3)[0], 0.0, (0.2, 0.2)), stop])

    def slips_off(t, y):
        return math.cos(0.2) + math.cos(y[0] - y[2])
    start = [math.asin((2.6 - 0.18) / 3.6), 0.0, -math.asin(0.18 / 2.8)]
    t, q, v, _, history = whole.run(start, np.zeros(3), 5.0, until=slips_off)
    times = [phase.t0 for phase in sol.phases]
    assert times[1:3] == pytest.approx([history[1][0], t], abs=1e-9)
    at = np.searchsorted(sol.t, t - 1e-7)
    assert sol["arm.angle"][at] == pytest.approx(q[0], abs=1e-6)
    # it lands where a thrown stone does, sliding to rest
    place, thrown = (np.array(sp.lambdify([Q, list(V)], each)(q, v), float).ravel() for each in (ball, velocity(ball, 3)))
    flight = (thrown[1] + math.sqrt(thrown[1]**2 + 2 * G * place[1])) / G
    speed = thrown[0] - 0.2 * math.hypot(thrown[1], math.sqrt(2 * G * place[1]))     # Coulomb's impulse where it lands
    landed = sol.impacts[sol.impacts["name"] == "trough"][0]
    assert landed["t"] == pytest.approx(t + flight, abs=1e-8)
    later = min(sol.t[-1] - landed["t"], speed / (0.2 * G))
    end = place[0] + thrown[0] * flight + speed * later - 0.1 * G * later**2
    assert sol["projectile.position.x"][-1] == pytest.approx(end, abs=1e-6)
    # the arm without it
    alone = Machine(Q[:2], V[:2, :], T, energy.subs(V[2], 0), G * heights, [stop])
    hits = [each.t for each in alone.run(q[:2], v[:2], 2.4, t=t)[3]]
    assert len(hits) == 3
    assert sol.impacts["t"][sol.impacts["name"] == "beam"][:3] == pytest.approx(hits[:3], abs=1e-7)
    assert abs(sol.energy_violation).max() < 1e-6
    pull = np.einsum("ij,ij->i", sol["sling.force"], sol["arm.start.position"] - sol["projectile.position"])
    assert pull[sol.t < t - 1e-9].min() > 0        # a rope can bear it


def test_a_suspension_on_a_shaker_leaves_it_and_hits_its_stops():
    sol = zd.simulate(zd.models.suspension(), 1.2, **FINE)
    height, angle = Q[:2]       # of the pivot, and of the arm
    long, low = math.hypot(0.5, 0.15), math.atan2(-0.15, 0.5)
    wheel, mount = sp.Matrix([0, height]) + long * direction(angle), sp.Matrix([0.5, height + 0.45])
    strut = sp.sqrt((mount - wheel).dot(mount - wheel))
    rate = (sp.Matrix([strut]).jacobian(Q[:2]) * V[:2, :])[0]
    free = 0.15 + 0.45 + 300 * G / 20e3
    contacts = [Contact(angle - low + 0.16, None, 0.3), Contact(low + 0.14 - angle, None, 0.3),
                Contact(wheel[1] - 0.3 - 0.06 * (1 - sp.cos(11 * T)))]
    other = Machine(Q[:2], V[:2, :], T, 150 * V[0]**2 + kinetic(40, wheel, 2),
                    G * (300 * height + 40 * wheel[1]) + 10e3 * (strut - free)**2, contacts,
                    [-1200 * rate * sp.diff(strut, each) for each in Q[:2]])
    _, q, _, impacts, _ = other.run([0.45, low], np.zeros(2), 1.2)
    mine = {round(t, 6) for t in sol.impacts["t"]}
    assert np.unique(sol.impacts["t"])[[0, 1, 2, 3]] == pytest.approx([each.t for each in impacts[:4]], abs=1e-9)
    assert {round(each.t, 6) for each in impacts if 2 in each.contacts} <= mine
    assert len({each.contacts for each in impacts}) == 3        # below, above together with the tyre, and the tyre
    assert sol["pivot.angle"][-1] + low == pytest.approx(q[1], abs=1e-6)      # within the rest speed, at which bounces end


@pytest.mark.parametrize(("arguments", "digits"), [
    ({}, 5e-4),         # Goswami's compass on 3 degrees, to the digits of its start, whose deviations halve at each step
    # Garcia's simplest walker, feet a thousandth of the hip, as computed by Bhounsule: 0.200161072169750, -0.199906060087682,
    # 0.400322144339512, -0.015805473227965 (angle of the legs and its rate between each other)
    ({"leg_mass": 1.0, "hip_mass": 1e3, "foot_distance": 0.0, "slope": 0.009, "gravity": 1.0, "angle": 0.200161072169750,
      "stance_speed": -0.199906060087682, "swing_speed": -0.199906060087682 + 0.015805473227965}, 1e-9)])
def test_a_walker_repeats_the_step_of_the_literature(arguments, digits):
    m = zd.models.compass_gait(**arguments)
    sol = zd.simulate(m, 4.1, **FINE) if not arguments else zd.simulate(m, 12.0, **FINE)
    normal = math.pi / 2 - arguments.get("slope", math.radians(3))
    start = {"angle": 0.27104, "stance_speed": -1.0918, "swing_speed": -0.3772}
    expected = [arguments.get(name, value) for name, value in start.items()]
    assert len(sol.impacts) >= 3
    for impact in sol.impacts[:3]:
        after = np.flatnonzero(sol.t == impact["t"])[-1]
        stance = impact["name"].split()[0]
        swing = {"left": "right", "right": "left"}[stance]
        found = [sol[f"{stance}.angle"][after] - normal, *(sol[f"{leg}.angular_velocity"][after] for leg in (stance, swing))]
        assert found == pytest.approx(expected, abs=2 * digits)
    assert sol.phases[-1].state["fall"] == "open"


def test_a_walker_between_samples_stands_where_its_feet_were_joined():
    times = np.linspace(0.003, 2.4, 50)
    walk, same = (zd.simulate(zd.models.compass_gait(), 2.5, step=0.005, **more) for more in ({}, {"t_eval": times}))
    for found, expected in zip(walk(times), (same.p, same.v), strict=True):
        np.testing.assert_allclose(found, expected, atol=1e-10)


@pytest.mark.parametrize("slots", [4, 6])
def test_a_geneva_drive_has_the_angle_and_the_force_of_the_closed_form(slots):
    """The wheel's angle is atan(a sin, C - a cos) of the crank's while the pin is in a slot; what turns it is the pin's force."""
    a, half = 0.05, math.pi / slots
    distance, speed = a / math.sin(half), 2 * math.pi
    radius, inertia = distance * math.cos(half), 0.25 * (distance * math.cos(half))**2
    sol = zd.simulate(zd.models.geneva(slots=slots), 2.0, rtol=1e-11, atol=1e-13)
    crank = sol["shaft.angle"] + math.pi
    turn = np.round(crank / (2 * math.pi))
    inside = abs(crank - 2 * math.pi * turn) < math.pi / 2 - half - 1e-3
    angle = -2 * half * (turn - 0.5) - np.arctan2(a * np.sin(crank), distance - a * np.cos(crank))
    assert sol["axle.angle"][inside] == pytest.approx(angle[inside], abs=1e-9)
    assert abs(sol["wheel.angular_velocity"][abs(crank - math.pi) < math.pi / 2]).max() < 1e-12
    assert sol["axle.angle"][-1] == pytest.approx(-4 * half, abs=1e-9)
    squared = distance**2 + a**2 - 2 * distance * a * np.cos(crank)
    turning = a * distance * speed**2 * np.sin(crank) * (distance**2 - a**2) / squared**2       # second derivative of atan
    force = inertia * turning / np.sqrt(squared)
    for i in range(2):
        at = inside & (turn == i + 1)
        assert np.linalg.norm(sol[f"slot {i + 1}.force"][at], axis=1) == pytest.approx(abs(force[at]), rel=1e-6, abs=1e-7)
    assert np.allclose(sol.impacts["energy_lost"], 0, atol=1e-20)
    assert radius == pytest.approx(math.sqrt(distance**2 - a**2))


def seen_from(place, angle, origin):
    """Coordinates (2,) of a place in a frame that is turned about an origin."""
    x, y = place - origin
    return sp.Matrix([sp.cos(angle) * x + sp.sin(angle) * y, sp.cos(angle) * y - sp.sin(angle) * x])


@pytest.mark.parametrize(("restitution", "within"), [(0.0, 1e-9), (0.3, 1e-5)])      # bounces end at different speeds
def test_an_anchor_escapement_ticks_like_one_tooth_after_the_other(restitution, within):
    """A tooth on its pallet until it drops off the end; then the next one, half a pitch behind, on the other pallet."""
    radius, pitch, lift, drop = 0.04, 2 * math.pi / 15, math.radians(3), math.radians(2)
    side, push = 2.25 * pitch, pitch / 4 - drop / 2
    swing, turn = Q[:2]         # of the pendulum, and of the tooth clockwise from the top
    tooth = seen_from(radius * sp.Matrix([sp.sin(turn), sp.cos(turn)]), swing, sp.Matrix([0, radius / math.cos(side)]))
    energy = 0.5 * 0.25**2 * V[0]**2 / 2 + 0.5 * 0.02 * radius**2 * V[1]**2 / 2
    machines, ends = [], []
    for sign in (-1, 1):        # entry, exit
        start, end = (tooth.subs({swing: by * lift, turn: sign * side + at}).evalf() for by, at in ((-sign, -push), (sign, push)))
        along = (end - start) / (end - start).norm()
        gap = along[1] * (tooth - end)[0] - along[0] * (tooth - end)[1]
        contact = Contact(gap, along.dot(velocity(tooth, 2)), restitution, (0.1, 0.1))
        machines.append(Machine(Q[:2], V[:2, :], T, energy, -0.5 * G * 0.25 * sp.cos(swing), [contact], [-1e-3 * V[0], 2e-3]))
        ends.append(sp.lambdify([Q[:2]], along.dot(tooth - end)))
    m = zd.models.anchor_escapement(restitution=restitution)
    at = m["entry 1"].second.drawn
    sol = zd.simulate(m, 1.6, **FINE)
    q, v, t, found = np.array([math.radians(7), math.atan2(*at)]), np.zeros(2), 0.0, []
    for tick in range(4):
        t, q, v, impacts, _ = machines[tick % 2].run(
            q, v, 1.6, t=t, until=lambda t, y, end=ends[tick % 2]: end(y[:2]), rest=1e-7, max_step=0.01)
        found.append(impacts[:4])
        q[1] += (-5 if tick % 2 else 4) * pitch * (t < 1.6)
    assert t == 1.6
    expected = [each.t for impacts in found for each in impacts]
    assert len(expected) == (16 if restitution else 4)
    hits = sol.impacts["t"]
    assert [hits[abs(hits - each).argmin()] for each in expected] == pytest.approx(expected, abs=within)
    assert sol["pivot.angle"][-1] == pytest.approx(q[0], abs=within)


def test_an_anchor_escapement_comes_to_the_swing_at_which_its_weight_pays_for_what_is_lost():
    """From two starts; without friction, what is lost is that of the air and of the impacts."""
    swings = []
    for angle in (0.1, 0.2):
        m = zd.models.anchor_escapement(bob_mass=0.03, torque=2e-3, damping=3e-3, friction=0.0, restitution=0.0, angle=angle)
        sol = zd.simulate(m, 8.0, rtol=1e-7, events=[zd.Event(m["pivot"].angle, direction=-1)])
        begin, end = sol.t_events[0][[-4, -1]]
        inside = (sol.t >= begin) & (sol.t <= end)
        swings.append(np.ptp(sol["pivot.angle"][inside]))
    assert swings[0] == pytest.approx(swings[1], rel=1e-4)
    t = np.linspace(begin, end, 401)
    air = 3e-3 * np.trapezoid([sol(each)[1][1]**2 for each in t], t)
    lost = sol.impacts["energy_lost"][(sol.impacts["t"] > begin) & (sol.impacts["t"] < end)]
    assert len(lost) == 6
    assert air + lost.sum() == pytest.approx(3 * 2 * math.pi / 15 * 2e-3, rel=5e-4)       # in three swings there and back


def test_a_geneva_drive_whose_pin_has_play_in_its_slot():
    """The round pin on one side of the slot, then on the other: the wheel's angle and the pin's force in closed form."""
    a, half, speed, mass, pin, play = 0.05, math.pi / 4, 2 * math.pi, 0.5, 0.004, 1e-4
    apart, radius = a / math.sin(half), a / math.tan(half)
    m = zd.Mechanism("Geneva")
    crank = m.link("crank", (0, 0), (-a, 0), mass=0.0)
    wheel = m.body("wheel", mass, mass * radius**2 / 2, at=(apart, 0))
    shaft = m.revolute("shaft", m.ground, crank.start)
    m.revolute("axle", m.ground, wheel.point((0, 0)))
    m.motor("drive", shaft, speed=speed)
    outward = np.array([math.cos(math.pi + half), math.sin(math.pi + half)])
    for name, side in (("left", 1), ("right", -1)):
        ends = (np.array([apart, 0]) + r * outward + side * (pin + play) * np.array([-outward[1], outward[0]])
                for r in (apart - a - pin, radius))
        m.contact(name, crank.end, wheel.segment(*ends), radius=pin)
    lock = m.weld("lock", m.ground, wheel, at=(apart, 0), active=True)
    m.latch("detent", lock, until=m.measure("enters", lambda angle: angle - math.pi + math.pi / 4, of={"angle": shaft.angle}))
    sol = zd.simulate(m, 0.6, **FINE)
    turn = sp.Symbol("turn")
    distance = sp.sqrt(apart**2 + a**2 - 2 * apart * a * sp.cos(turn))
    crank_angle = sol["shaft.angle"] - math.pi
    for name, side in (("right left", 1), ("left right", -1)):
        angle = -half - sp.atan2(a * sp.sin(turn), apart - a * sp.cos(turn)) + side * sp.asin(play / distance)
        force = mass * radius**2 / 2 * speed**2 * sp.diff(angle, turn, 2) / sp.sqrt(distance**2 - play**2)
        phase, = [each for each in sol.phases if each.state[name] == "closed" and each.t1 - each.t0 > 0.02]
        inside = (sol.t > phase.t0) & (sol.t < phase.t1)
        assert inside.sum() > 5
        found = sp.lambdify(turn, [angle, sp.Abs(force)])(crank_angle[inside])
        assert sol["axle.angle"][inside] == pytest.approx(found[0], abs=1e-10)
        assert np.linalg.norm(sol[f"{name.split()[0]}.force"][inside], axis=1) == pytest.approx(found[1], rel=1e-9)
