"""Positions by the values of a measure, against closed forms and simulations; and what is refused."""

import pickle

import numpy as np
import pytest
import sympy as sp

import zerodrift as zd
from support import refused
from tolerances import EPS
from zerodrift.errors import InconsistentStart, SingularSystem
from zerodrift.tracing import walk

CLOSED = 1e-12      # SOLVED times the conditions of the mechanisms here, some ten; a thousandth from a dead point a hundred


def linkage(a, b, c, d, **sketch):
    """A four-bar with crank a, coupler b, rocker c and ground d, drawn roughly."""
    points = {"A": (0, 0), "B": (0.6 * a, 0.8 * a), "C": (d, c), "D": (d, 0)} | sketch
    return zd.linkage(points, {"ground": "AD", "crank": "AB", "coupler": "BC", "rocker": "DC"},
                      lengths={"AB": a, "BC": b, "DC": c, "AD": d}, mass=1.0)


def angles(a, b, c, d, crank, side):
    """Coupler's and rocker's angle in closed form; side 1: C is to the left of B D, -1: to its right."""
    B = a * np.array([np.cos(crank), np.sin(crank)])
    f, direction = np.hypot(d - B[0], -B[1]), np.arctan2(-B[1], d - B[0])
    coupler = direction + side * np.arccos(np.clip((b * b + f * f - c * c) / (2 * b * f), -1, 1))
    C = B + b * np.array([np.cos(coupler), np.sin(coupler)])
    return coupler, np.arctan2(C[1], C[0] - d)


def apart(first, second):
    """The largest difference of angles, whole turns left out."""
    return np.abs((first - second + np.pi) % (2 * np.pi) - np.pi).max()


NOT_GRASHOF = (1.0, 1.6, 1.3, 2.2)
LIMIT = float(np.arccos((1.0 + 2.2**2 - (1.6 + 1.3)**2) / (2 * 2.2)))      # coupler and rocker in one line


def test_a_four_bar_through_both_dead_points():
    m = linkage(*NOT_GRASHOF)
    there, back = np.linspace(0.3, LIMIT - 1e-3, 60), np.linspace(LIMIT - 1e-3, 1e-3 - LIMIT, 120)
    values = np.concatenate([there, [LIMIT], back, [-LIMIT], back[::-1]])
    side = np.concatenate([np.ones(61), -np.ones(121), np.ones(120)])
    trace = zd.trace(m, "crank.angle", values, through=True)
    expected = np.array([angles(*NOT_GRASHOF, *each) for each in zip(values, side, strict=True)])
    regular = np.abs(np.abs(values) - LIMIT) > 1e-9
    assert np.abs(trace["crank.angle"] - values).max() < 4 * EPS
    for name, column in (("coupler.angle", 0), ("rocker.angle", 1)):
        assert apart(trace[name][regular], expected[regular, column]) < CLOSED
    assert [point.value for point in trace.dead_points] == pytest.approx([LIMIT, -LIMIT], rel=1e-15)
    assert [point.before for point in trace.dead_points] == [61, 182]
    dead = np.flatnonzero(~regular)     # where arccos loses half of the digits; there the two links are in one line
    assert apart(trace["coupler.angle"][dead], trace["rocker.angle"][dead] + np.pi) < CLOSED
    assert np.isinf(trace.slopes[dead]).all()
    assert np.isfinite(np.delete(trace.slopes, dead, axis=0)).all()


def test_values_in_any_order_stay_between_the_dead_points():
    values = np.array([0.3, 2.0, -2.0, 0.3, 0.3, -1.0, LIMIT])
    trace = zd.trace(linkage(*NOT_GRASHOF), "crank.angle", values)
    expected = [angles(*NOT_GRASHOF, value, 1)[1] for value in values[:-1]]
    assert apart(trace["rocker.angle"][:-1], np.array(expected)) < CLOSED
    assert np.array_equal(trace.p[0], trace.p[3])
    assert trace.dead_points == ()


def test_the_whole_branch():
    m = linkage(*NOT_GRASHOF)
    trace = zd.trace(m, "crank.angle", count=41)
    assert len(trace) == 43
    assert [point.value for point in trace.dead_points] == pytest.approx([LIMIT, -LIMIT], rel=1e-15)
    assert [trace.values[point.before] for point in trace.dead_points] == [point.value for point in trace.dead_points]
    assert np.abs(trace.p[-1] - trace.p[0]).max() < CLOSED
    assert max(np.abs(trace.system.evaluate(p).Phi).max() for p in trace.p) < CLOSED
    reach = zd.reach(m, "crank.angle")
    assert (reach.low, reach.high) == pytest.approx((-LIMIT, LIMIT), rel=1e-15)
    assert not reach.turns_fully
    assert 2.0 in reach
    assert 2.2 not in reach
    assert repr(reach) == "<reach of crank.angle: -2.195 ... 2.195 rad, between dead points>"


def test_a_dead_point_can_be_where_values_begin():
    m = linkage(*NOT_GRASHOF)
    for first, inside in ((LIMIT, 1.0), (-LIMIT, 1.0)):
        trace = zd.trace(m, "crank.angle", [first, inside], through=True)
        assert apart(trace["rocker.angle"][1], angles(*NOT_GRASHOF, inside, 1)[1]) < CLOSED


def test_a_crank_of_grashofs_kind_turns():
    lengths = (0.3, 1.0, 0.6, 1.0)
    m = linkage(*lengths)
    assert zd.reach(m, "crank.angle").turns_fully
    assert repr(zd.reach(m, "crank.angle")) == "<reach of crank.angle: turns fully>"
    turn = zd.trace(m, m["crank"].angle)
    assert len(turn) == 361
    assert turn.values[-1] - turn.values[0] == pytest.approx(2 * np.pi, rel=1e-15)
    expected = np.array([angles(*lengths, value, 1) for value in turn.values])
    assert apart(turn["rocker.angle"], expected[:, 1]) < CLOSED
    far = zd.trace(m, "crank.angle", [turn.values[0], 40.0, -40.0])
    assert apart(far["coupler.angle"], np.array([angles(*lengths, value, 1)[0] for value in far.values])) < CLOSED


def test_random_four_bars():
    """A crank turns back where coupler and rocker are in line, folded or stretched, whichever bar is the shortest."""
    rng, kinds = np.random.default_rng(1), set()
    for lengths in rng.uniform(0.2, 2.0, (8, 4)):
        a, b, c, d = lengths
        if lengths.max() > lengths.sum() / 2 - 0.01:
            continue
        low, high = ((a * a + d * d - span**2) / (2 * a * d) for span in (b + c, abs(b - c)))     # of the crank's cosine
        reach = zd.reach(linkage(*lengths), "crank.angle")
        kinds.add(kind := (low > -1, high < 1))
        assert reach.turns_fully == (kind == (False, False))
        expected = [cosine for cosine in (low, high) if -1 < cosine < 1]
        found = np.sort(np.cos([point.value for point in reach.dead_points]))
        assert np.abs(found - np.sort(expected * 2 if len(expected) == 1 else expected)).max(initial=0.0) < CLOSED
    assert len(kinds) > 2


def test_dead_centres_of_a_slider_crank():
    """The crank turns, and its slider has a dead centre where crank and rod are in one line."""
    r, length = 0.5, 1.2
    m = zd.Mechanism("slider-crank")
    crank, rod = m.link("crank", (0, 0), (0, r), mass=1.0), m.link("rod", (0, r), (1, 0), mass=1.0, length=length)
    piston = m.particle("piston", 1.0, at=(1, 0))
    m.revolute("main", m.ground, crank.start)
    m.revolute("pin", crank.end, rod.start)
    m.revolute("wrist", rod.end, piston)
    m.slot("slide", m.ground, piston, axis=(1, 0))
    turn = zd.trace(m, crank.angle, np.linspace(0, 2 * np.pi, 61))
    s = r * np.sin(turn.values)
    x = r * np.cos(turn.values) + np.sqrt(length**2 - s**2)
    assert np.abs(turn["piston.position.x"] - x).max() < CLOSED
    rate = -s - s * r * np.cos(turn.values) / np.sqrt(length**2 - s**2)
    assert np.abs(turn.derivative("piston.position.x") - rate).max() < CLOSED
    assert np.abs(turn.derivative(piston.position) - np.column_stack([rate, 0 * rate])).max() < CLOSED
    reach = zd.reach(m, "piston.position.x")
    assert (reach.low, reach.high) == pytest.approx((length - r, length + r), rel=1e-14)
    assert len(zd.trace(m, "piston.position.x").dead_points) == 2


def test_positions_are_those_of_a_simulation():
    """Jansen's leg at the angles that its motor goes through."""
    leg = zd.models.jansen()
    sol = zd.simulate(leg, 1.0, step=1e-3)
    turn = zd.trace(leg, "crank.angle", sol["crank.angle"][::50])
    assert np.abs(turn["F.position"] - sol["F.position"][::50]).max() < 10 * CLOSED      # corrected to 1e-12
    speed = sol["F.velocity"][::50] / sol["crank.angular_velocity"][::50, None]
    assert np.abs(turn.derivative("F.position") - speed).max() < 1e-9       # of velocities by differences of thousandths
    absolute = zd.trace(leg.system("absolute"), "crank.angle", turn.values)
    assert absolute.p.shape == (len(turn), 21)
    assert np.abs(absolute["F.position"] - turn["F.position"]).max() < CLOSED
    assert np.abs(absolute.derivative("F.position") - turn.derivative("F.position")).max() < CLOSED


def test_what_is_held_where_there_are_two_freedoms():
    m = zd.linkage({"A": (0, 0), "B": (0, 1), "C": (1, 2), "D": (2, 1), "E": (2, 0)},
                   {"ground": "AE", "left": "AB", "leftarm": "BC", "rightarm": "DC", "right": "ED"}, mass=1.0)
    m.motor("first", "A", speed=1.0)
    m.motor("second", "E", angle=sp.sin(sp.Symbol("t")))
    values = np.linspace(1.2, 1.9, 8)

    def closed(left, right):
        B, D = np.array([np.cos(left), np.sin(left)]), np.array([2 + np.cos(right), np.sin(right)])
        middle, half = (B + D) / 2, np.hypot(*(D - B)) / 2
        return middle + np.sqrt(2 - half**2) * np.array([-(D - B)[1], (D - B)[0]]) / (2 * half)

    for hold, right in ((["right.angle"], np.pi / 2), ({"right.angle": 1.1}, 1.1), ({m["right"].angle: 2.0}, 2.0),
                        ("right.angle", np.pi / 2)):
        trace = zd.trace(m, "left.angle", values, hold=hold)
        assert np.abs(trace["right.angle"] - right).max() < CLOSED
        assert np.abs(trace["C.position"] - [closed(value, right) for value in values]).max() < CLOSED
    assert zd.reach(m, "left.angle", hold=["right.angle"]).high < np.pi
    with pytest.raises(SingularSystem, match=r"has 2 freedoms without its motors .* hold 1 measure more, such as hold=\['E"):
        zd.trace(m, "A.angle", values)
    with pytest.raises(SingularSystem, match="has no freedom without its motors, and 'right"):
        zd.trace(m, "C.position.x", hold=["right.angle", "left.angle"])
    with pytest.raises(InconsistentStart, match=r"'C.position.y'"):
        zd.trace(m, "left.angle", hold={"C.position.y": 9.0})


@pytest.mark.parametrize("third", [False, True], ids=["plain", "redundant"])
def test_a_parallelogram_through_its_change_points(third):
    """Flat, it could go on as an antiparallelogram; it does not. With a third crank one row follows from the others."""
    points = {"A": (0, 0), "B": (0.6, 0.8), "C": (2.6, 0.8), "D": (2, 0), "E": (1.6, 0.8), "F": (1, 0)}
    links = {"ground": "AFD", "crank": "AB", "coupler": "BEC", "rocker": "DC"} | ({"third": "FE"} if third else {})
    if not third:
        points = {name: points[name] for name in "ABCD"}
        links |= {"ground": "AD", "coupler": "BC"}
    m = zd.linkage(points, links, mass=1.0)
    for values in (None, np.arange(9) * np.pi / 4):
        turn = zd.trace(m, "crank.angle", values)
        assert np.abs(turn["rocker.angle"] - turn["crank.angle"]).max() < CLOSED


def test_a_kite_at_its_change_point():
    """There Newton's matrix is singular, and positions are interpolated; the kite stays one, symmetric in B D."""
    m = linkage(1, 1, 2, 2, C=(1.2, 1.0))
    aside = np.array([-0.3, -1e-3, -1e-6, 0.0, 1e-6, 1e-3, 0.3])
    trace = zd.trace(m, "crank.angle", np.pi + aside)
    B = np.column_stack([np.cos(np.pi + aside), np.sin(np.pi + aside)])
    towards = np.array([2.0, 0.0]) - B
    C = 2 * (B - (np.sum(B * towards, axis=1) / np.sum(towards**2, axis=1))[:, None] * towards)     # A mirrored in the line B D
    assert np.abs(trace["C.position"] - C).max() < CLOSED
    assert np.isfinite(trace.slopes).all()


def test_a_dead_point_that_is_a_bifurcation_too():
    """Peaucellier's cell folds where both corners meet on the line of its symmetry."""
    cell = zd.models.peaucellier()
    reach = zd.reach(cell, "A.angle")
    limit = 2 * np.arccos((0.25 - 0.12) / 0.2)
    assert (reach.low, reach.high) == pytest.approx((-limit, limit), rel=1e-9)      # interpolated


def test_laws_of_ones_own_are_followed():
    """A constraint by a callable is included, and its exceptions are raised."""
    m = zd.Mechanism("two cranks")
    for name, x in (("first", 0), ("second", 2)):
        link = m.link(name, (x, 0), (x + 1, 0), mass=1.0)
        m.revolute(f"pin {name}", m.ground, link.start)
    m.constraint("law", lambda a, b: b - np.sin(a), of={"a": "first.angle", "b": "second.angle"})
    trace = zd.trace(m, "first.angle", np.linspace(-3, 3, 7))
    assert np.abs(trace["second.angle"] - np.sin(trace.values)).max() < CLOSED
    assert zd.reach(m, "second.angle").high == pytest.approx(1.0, abs=1e-14)


def test_a_single_link():
    m = zd.Mechanism("crank")
    link = m.link("link", (0, 0), (1, 0), mass=0.0)
    m.revolute("pin", m.ground, link.start)
    turn = zd.trace(m, "link.angle", count=5)
    assert np.abs(turn["link.end.position"] - [[1, 0], [0, 1], [-1, 0], [0, -1], [1, 0]]).max() < CLOSED
    with refused("wrong-value", r"starts in a dead point of 'link.end.position.x', at 1, .* start aside"):
        zd.trace(m, "link.end.position.x", [0.5])


def test_what_a_trace_is():
    m = linkage(*NOT_GRASHOF)
    trace = zd.trace(m, "crank.angle", [0.5, 2.0, 0.0], through=True)
    assert repr(trace) == ("<trace of linkage: 3 positions, crank.angle from 0.5 to 0 rad, through dead points at 2.19456 rad>")
    copied = pickle.loads(pickle.dumps(trace))
    assert np.array_equal(copied["C.position"], trace["C.position"])
    assert not trace.p.flags.writeable
    assert {"crank.angle", "C.position"} <= set(trace._ipython_key_completions_())
    with refused("wrong-name", "'C.plaice'"):
        _ = trace["C.plaice"]
    with refused("not-available"):
        _ = trace["C.velocity"]
    with refused("not-available", "'C.force'"):
        trace.derivative("C.force")


@pytest.mark.parametrize(("values", "through", "code", "said"), [
    ([0.0, 2.5], False, "out-of-range", r"values\[1\].*2.5.*'crank.angle'.*is 2.1945"),
    ([0.0, -2.5], False, "out-of-range", r"values\[1\].*-2.5.*is -2.194555933"),
    ([0.0, 2.0, -3.0], True, "out-of-range", r"values\[2\].*-3.*is -2.194555933"),
    ([0.0, 2.5], True, "out-of-range", r"values\[1\].*2.5"),
    ([2.5, 0.0], True, "out-of-range", r"values\[0\].*2.5"),
    ([], False, "shape", "values"),
    ([[0.0]], False, "shape", "values"),
    ([0.0, np.nan], False, "not-finite", "values"),
])
def test_values_that_cannot_be(values, through, code, said):
    with refused(code, said):
        zd.trace(linkage(*NOT_GRASHOF), "crank.angle", values, through=through)


def test_values_that_turn_back_where_there_is_no_dead_point():
    with refused("not-increasing", r"values\[2\].*0.5.*'crank.angle'"):
        zd.trace(linkage(0.3, 1.0, 0.6, 1.0), "crank.angle", [0.4, 1.0, 0.5], through=True)


@pytest.mark.parametrize(("arguments", "options", "code", "said"), [
    (("krank.angle",), {}, "wrong-name", "'krank.angle'"),
    (("crank.angle.x",), {}, "wrong-name", None),
    (("C.force",), {}, "wrong-name", None),
    (("crank.angular_velocity",), {}, "wrong-measure", None),
    (("C.position",), {}, "wrong-measure", "C.position.x and C.position.y"),
    ((3,), {}, "wrong-type", "measure"),
    (("crank.angle",), {"hold": {"C.position": (1, 2)}}, "wrong-measure", "^hold must"),
    (("crank.angle",), {"hold": {"rocker.angle": "up"}}, "wrong-type", "hold"),
    (("crank.angle",), {"hold": 5}, "wrong-type", "^hold must"),
    (("crank.angle",), {"through": 1}, "wrong-type", "through"),
    (("crank.angle",), {"count": 1}, "out-of-range", "count.*between 2"),
    (("crank.angle", ["a"]), {}, "wrong-type", "values"),
])
def test_other_arguments_that_are_wrong(arguments, options, code, said):
    with refused(code, said):
        zd.trace(linkage(*NOT_GRASHOF), *arguments, **options)


def test_what_is_not_a_mechanism():
    with refused("wrong-type", "system"):
        zd.trace(zd.systems.four_bar(), "alpha1")


def test_what_has_no_end(monkeypatch):
    monkeypatch.setattr(walk, "LARGEST_COUNT", 100)
    monkeypatch.setattr(walk, "LARGEST_COUNT_TO_A_VALUE", 100)
    m = zd.Mechanism("rail")
    m.prismatic("slide", m.ground, m.body("cart", 1.0), axis=(1, 0), at=(0, 0))
    assert zd.trace(m, "slide.displacement", [0.0, 7.0])["cart.position.x"] == pytest.approx([0.0, 7.0], abs=1e-14)
    with refused("out-of-range", "from 0.*'slide.displacement'.*to 1"):
        zd.trace(m, "slide.displacement", [1e4])
    with refused("missing-argument"):
        zd.reach(m, "slide.displacement")
    with refused("not-increasing"):
        zd.trace(m, "slide.displacement", [0.0, 1.0, 0.5], through=True)


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
def test_forces_of_a_mechanism_at_rest(coordinates):
    """The effort is the slope of the potential energy, and the ground bears the weight and the spring."""
    m = zd.Mechanism("lift", gravity=(0, -9.81))
    crank, rod = m.link("crank", (0, 0), (0.1, 0.2), mass=2.0), m.link("rod", (0.1, 0.2), (0.6, 0), mass=3.0)
    ram = m.particle("ram", 5.0, at=(0.6, 0))
    main = m.revolute("main", m.ground, crank.start)
    m.revolute("pin", crank.end, rod.start)
    m.revolute("wrist", rod.end, ram)
    m.slot("guide", m.ground, ram, axis=(1, 0))
    m.spring("spring", m.ground.point((1, 0)), ram, stiffness=400.0, length=0.3)
    m.motor("drive", main, speed=3.0)
    values = np.linspace(0.3, 2.5, 2001)
    traced = zd.trace(m.system(coordinates), crank.angle, values, forces=True)
    height = 2.0 * traced["crank.center.position.y"] + 3.0 * traced["rod.center.position.y"]
    V = 9.81 * height + 200.0 * (1.0 - traced["ram.position.x"] - 0.3)**2
    slope = (V[:-4] - 8 * V[1:-3] + 8 * V[3:-1] - V[4:]) / (12 * (values[1] - values[0]))
    assert traced["effort"][2:-2] == pytest.approx(slope, abs=1e-9 * np.abs(slope).max())
    assert traced.unit_of("effort") == "N m"
    pull = 400.0 * (1.0 - traced["ram.position.x"] - 0.3)
    assert traced["spring.force"] == pytest.approx(pull, rel=1e-12)
    bearing = traced["main.force"] + traced["guide.force"]
    assert bearing[:, 0] == pytest.approx(-pull, rel=1e-9)
    assert bearing[:, 1] == pytest.approx(np.full(2001, 10.0 * 9.81), rel=1e-9)


def jack():
    m = zd.Mechanism("jack", gravity=(0, -9.81))
    m.revolute("A", m.ground, m.link("arm", (0, 0), (1, 0), mass=2.0).start)
    m.actuator("cylinder", m.ground.point((0.0, -0.5)), m["arm"].point((0.6, 0)), length=0.7)
    return m


def test_forces_of_a_cylinder_that_is_traced_or_holds():
    """Its force is the derivative of the weight's energy by its length, by the cosine rule."""
    lengths = np.linspace(0.6, 1.0, 9)
    traced = zd.trace(jack(), "cylinder.length", lengths, forces=True)
    assert traced["effort"] == pytest.approx(2.0 * 9.81 * 0.5 * 2 * lengths / (2 * 0.5 * 0.6), rel=1e-9)
    heights = traced["arm.center.position"][:, 1]
    by_height = zd.trace(jack(), "arm.center.position.y", heights, forces=["cylinder.length"])
    assert by_height["effort"] == pytest.approx(traced["effort"], rel=1e-8)
    assert by_height["A.force"] == pytest.approx(traced["A.force"], rel=1e-8)
    plain = zd.trace(jack(), "arm.center.position.y", heights, forces=True)
    assert plain["effort"] == pytest.approx(np.full(9, 2.0 * 9.81), rel=1e-8)


def test_a_trace_without_forces_has_none():
    with refused("not-available", "main.force"):
        zd.trace(zd.models.slider_crank(), "crank.angle", [0.1, 0.2])["main.force"]
