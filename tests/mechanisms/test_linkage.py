"""Linkages from sketches: against circles intersected by hand, closed forms, and with every way to be wrong."""

import numpy as np
import pytest

import zerodrift as zd
from circles import complex_of, crossing, jansen_by_circles
from support import refused

CLOSED = 1e-13          # in m, of mechanisms of about one: some hundred units of rounding

SKETCH = {"Z": (0, 0), "Y": (-38, -7.8), "X": (15, 0), "V": (-19, 33), "U": (-15, -40), "W": (-72, 10), "T": (-60, -30),
          "F": (-20, -85)}
LENGTHS = {"ZX": 15, "XV": 50, "XU": 61.9, "YV": 41.5, "VW": 55.8, "YW": 40.1, "YU": 39.3, "WT": 39.4, "TU": 36.7, "TF": 65.7,
           "UF": 49}
LINKS = {"ground": "ZY", "crank": "ZX", "j": "XV", "k": "XU", "bed": "YVW", "c": "YU", "f": "WT", "foot": "UTF"}


def jansen(**options):
    return zd.linkage(SKETCH, LINKS, lengths=LENGTHS, scale=0.01, **options)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_jansens_leg_is_where_circles_meet_over_a_turn_of_the_crank(layout):
    leg = jansen(mass=0.5, gravity=(0, -9.81))
    leg.motor("drive", "Z", speed=-6.0)
    sol = zd.simulate(leg.system(layout), 1.05, step=0.005, stabilization=zd.Projection(tol=1e-14))
    assert np.ptp(sol["crank.angle"]) > 2 * np.pi
    for name, expected in jansen_by_circles(sol["crank.angle"]).items():
        assert np.abs(complex_of(sol, name) - expected).max() < CLOSED, name


def test_a_sketch_has_as_many_hinges_as_links_meet_but_one():
    joints = {joint.name: (joint.first.body.name, joint.second.body.name) for joint in jansen().joints}
    assert joints == {
        "Z": ("ground", "crank"), "Y bed": ("ground", "bed"), "Y c": ("ground", "c"), "X j": ("crank", "j"),
        "X k": ("crank", "k"), "V": ("j", "bed"), "U c": ("k", "c"), "U foot": ("k", "foot"), "W": ("bed", "f"),
        "T": ("f", "foot")}


def test_the_ground_comes_first_wherever_it_is_listed():
    m = zd.linkage({"A": (0, 0), "B": (1, 0)}, {"link": "AB", "ground": "A"})
    assert [body.name for body in m["A"].bodies] == ["ground", "link"]
    assert [body.name for body in m.bodies] == ["link"]


def test_names_of_points_may_be_words():
    m = zd.linkage({"left": (0, 0), "top": (0, 1), "right": (2, 0)},
                   {"ground": ("left", "right"), "crank": ["left", "top"], "rod": ("top", "right")},
                   lengths={("top", "right"): 2.5})
    assert m["rod"].length == 2.5
    assert [joint.name for joint in m.joints] == ["left", "top", "right"]


def peaucellier():
    cell = zd.linkage({"O": (0, 0), "A": (10, 0), "Q": (18, 5), "S": (20, 16), "R": (24, -5), "P": (25, 8)},
                      {"ground": "OA", **{link: link for link in ("OS", "OR", "AQ", "QS", "QR", "PS", "PR")}},
                      lengths={"OS": 25, "OR": 25, "QS": 12, "QR": 12, "PS": 12, "PR": 12, "AQ": 10}, scale=0.01, mass=0.2)
    cell.start({"AQ.angular_velocity": 2.0})
    return cell


def test_peaucelliers_cell_draws_a_straight_line_where_inversion_has_it():
    """OP OQ = 25^2 - 12^2, and Q is on a circle of radius 10 through O: P is on the line x = 481 / 20."""
    sol = zd.simulate(peaucellier(), 0.3, step=1e-3)
    assert np.ptp(sol["P.position"][:, 1]) > 0.05
    np.testing.assert_allclose(sol["P.position"][:, 0], 4.81 / 20, rtol=0, atol=CLOSED)


# ---- plates ----


def plate(points, lengths=None, ground="A", **options):
    return zd.linkage(points, {"ground": ground, "plate": "".join(points)}, lengths=lengths, **options)["plate"]


def places(body, m):
    """Points of a plate that is hinged at A alone, in its frame, from where they are measured at the start."""
    sol = zd.simulate(m, 1e-3, step=1e-3)
    at = {name: complex_of(sol, name)[0] for name in "BCD" if name in m._elements}
    return {name: (place - complex_of(sol, "A")[0]) * np.exp(-1j * sol[f"{body}.angle"][0]) for name, place in at.items()}


def test_a_plate_has_the_given_sides_and_those_that_are_drawn():
    m = zd.linkage({"A": (1, 2), "B": (2, 2), "C": (1.5, 1), "D": (1, 3)}, {"ground": "A", "plate": "ABCD"},
                   lengths={"AB": 5, "BC": 3, "CA": 4, "CD": 6})
    found = places("plate", m)
    assert found["B"] == pytest.approx(5.0, abs=CLOSED)
    assert found["C"] == pytest.approx(crossing(0, 5, 4, 3, -1), abs=CLOSED)
    drawn = (1 + 3j) - (1.5 + 1j)       # the way from C to D
    assert found["D"] == pytest.approx(found["C"] + 6 * drawn / abs(drawn), abs=CLOSED)


def test_lengths_may_be_given_in_any_order_of_points():
    """C follows from D, which comes behind it."""
    m = zd.linkage({"A": (0, 0), "B": (4, 0), "C": (2, 2), "D": (3, -1)}, {"ground": "A", "plate": "ABCD"},
                   lengths={"AB": 4, "AD": 3, "BD": 3, "CD": 3, "BC": 3})
    found = places("plate", m)
    assert found["D"] == pytest.approx(crossing(0, 4, 3, 3, -1), abs=CLOSED)
    assert found["C"] == pytest.approx(crossing(found["D"], 4, 3, 3, 1), abs=CLOSED)


@pytest.mark.parametrize(("AC", "BC", "place"), [(0.1, 0.2, 0.1), (0.4, 0.1, 0.4), (0.1, 0.4, -0.1), (0.3, 0.6, -0.3)])
def test_points_in_line_are_in_line(AC, BC, place):
    """Lengths whose sums agree to rounding, from a sketch that is not in line."""
    m = zd.linkage({"A": (0, 0), "B": (1, 0), "C": (0.5, 0.5)}, {"ground": "A", "plate": "ABC"},
                   lengths={"AB": 0.3, "AC": AC, "BC": BC})
    assert places("plate", m)["C"] == pytest.approx(place, abs=CLOSED)


def test_a_plate_has_its_mass_on_its_sides():
    """Against Simpson's rule, which is exact for moments of second order."""
    corners = {"A": (0.0, 0.0), "B": (0.4, 0.0), "C": (0.1, 0.3), "D": (-0.1, 0.2)}
    body = plate(corners, mass=2.0)
    at = np.array(list(corners.values()))
    ends = np.roll(at, -1, axis=0)
    lengths = np.linalg.norm(ends - at, axis=1)
    masses = 2.0 * np.concatenate([weight * lengths / lengths.sum() for weight in (1 / 6, 2 / 3, 1 / 6)])
    spots = np.vstack([at, (at + ends) / 2, ends])
    com = masses @ spots / 2.0
    assert body.mass == 2.0
    np.testing.assert_allclose(body.center.local, com, rtol=1e-14)
    assert body.inertia == pytest.approx(masses @ ((spots - com) ** 2).sum(axis=1), rel=1e-14)


def test_the_mass_of_a_link_may_be_its_own():
    m = jansen(mass={"bed": 2.0, "crank": 0.5, "foot": 1.0})
    assert [m[link].mass for link in ("crank", "j", "bed", "foot")] == [0.5, 0.0, 2.0, 1.0]
    assert m["crank"].inertia == pytest.approx(0.5 * 0.15**2 / 12, rel=1e-14)


# ---- what else can be done with a linkage ----


def test_the_ground_is_drawn_to_the_last_bit_and_takes_lengths():
    points = {"A": (0.1, 0.2), "B": (0.1, 1.1), "C": (0.95, 1.3), "D": (0.95, 0.3)}
    links = {"ground": "AD", "a": "AB", "b": "BC", "c": "CD"}
    assert tuple(zd.linkage(points, links)["D"].first.local) == (0.95, 0.3)
    moved = zd.linkage(points, links, lengths={"AD": 1.0})["D"].first.local - points["A"]
    np.testing.assert_allclose(moved, np.array([0.85, 0.1]) / np.hypot(0.85, 0.1), rtol=1e-14)


def test_a_linkage_is_saved_and_read_to_the_last_bit(tmp_path):
    leg = jansen()
    again = zd.load(leg.save(tmp_path / "leg"))
    assert again.system().p0.tobytes() == leg.system().p0.tobytes()


def test_the_place_of_a_hinge_is_measured_held_and_named_in_laws():
    cell = peaucellier()
    cell.start({"P.position.y": 0.05, "AQ.angular_velocity": None, "P.velocity.y": 0.3})
    cell.force("push", cell["PS"].start, along=(0, 1), value=lambda y: -40.0 * y, of={"y": "P.position.y"})
    sol = zd.simulate(cell, 0.1, step=1e-3)
    np.testing.assert_allclose((sol["P.position"][0, 1], sol["P.velocity"][0, 1]), (0.05, 0.3), rtol=1e-12)
    np.testing.assert_array_equal(sol["P.position"], sol["PR.start.position"])
    np.testing.assert_array_equal(sol["P.velocity"], sol["PR.start.velocity"])
    np.testing.assert_array_equal(sol["push.force"], -40.0 * sol["P.position"][:, 1])


def test_a_hinge_of_a_particle_has_a_place_and_no_angle():
    m = zd.Mechanism("pendulum", gravity=(0, -9.81))
    link, bob = m.link("link", (0, 0), (1, 0), mass=1.0), m.particle("bob", 1.0, at=(1, 0))
    m.revolute("top", m.ground, link.start)
    tip = m.revolute("tip", link.end, bob)
    sol = zd.simulate(m, 0.1, step=0.01)
    np.testing.assert_array_equal(sol[tip.position], sol["bob.position"])
    np.testing.assert_array_equal(sol[tip.velocity], sol["bob.velocity"])
    assert {"tip.position", "tip.velocity"} <= set(m.system().measures)


# ---- what is refused ----

FOUR = {"A": (0, 0), "B": (0, 1), "C": (2, 1), "D": (2, 0)}
BARS = {"ground": "AD", "crank": "AB", "coupler": "BC", "rocker": "CD"}


def test_links_that_do_not_reach_are_reported_with_their_loop_and_what_stays_open():
    """1, 0.5 and 0.25 m between pins that are 2 m apart: 0.25 m are missing."""
    with pytest.raises(zd.CorrectionFailed, match=r"the loop of ground, crank, coupler, rocker, through A, B, C, D, cannot "
                                                  r"close: it stays open by 0\.25 m at 'C'"):
        zd.linkage(FOUR, BARS, lengths={"AB": 1.0, "BC": 0.5, "CD": 0.25})


@pytest.mark.parametrize(("change", "sentence"), [
    ({"XV": 200}, r"the loop of ground, crank, j, bed, through Z, Y bed, X j, V, cannot close: it stays open by 1\.05 m at 'V'"),
    ({"WT": 200}, r"the loop of .*bed, f, .*foot.* cannot close: it stays open by \d\.\d+ m at '[TW]'"),
    ({"YU": 1, "XU": 3}, r"the loop of ground, crank, k, c, .* cannot close: it stays open by 0\.\d+ m at 'U")])
def test_of_several_loops_the_one_that_stays_open_is_reported(change, sentence):
    """The first: X and V are at most 0.388 + 0.15 + 0.415 m apart, and j, between them, is 2 m long."""
    with pytest.raises(zd.CorrectionFailed, match=sentence):
        zd.linkage(SKETCH, LINKS, lengths={**LENGTHS, **change}, scale=0.01)


@pytest.mark.parametrize("angle", [0.3, 1.2, 2.9])
def test_the_gap_is_the_missing_length_wherever_links_are_drawn(angle):
    turned = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    places = {name: tuple(np.add(place, (0.3, -0.2) if name == "C" else 0) @ turned) for name, place in FOUR.items()}
    with pytest.raises(zd.CorrectionFailed, match=r"it stays open by 0\.25 m at 'C'"):
        zd.linkage(places, BARS, lengths={"AB": 1.0, "BC": 0.5, "CD": 0.25})


def test_the_loop_that_is_reported_cannot_close_alone():
    """Crank, coupler and two more links, 6 m in line, from A to a pin that is 10 m away; the four-bar can close."""
    places, links = FOUR | {"E": (6, 0), "F": (10, 0)}, BARS | {"ground": "ADF", "near": "CE", "far": "EF"}
    with pytest.raises(zd.CorrectionFailed, match=r"the loop of ground, .*, cannot close: it stays open by 4 m at "):
        zd.linkage(places, links, lengths={"AB": 1.0, "BC": 2.0, "CD": 1.0, "CE": 1.5, "EF": 1.5, "DF": 8.0})


def test_what_is_massless_may_be_drawn_and_driven():
    m = zd.linkage(FOUR, BARS, mass=0.0)
    assert "can move without moving any mass" in str(m)
    m.motor("drive", "A", speed=1.0)
    assert "freedom 0" in str(m)


REFUSED = [
    ({"points": [(0, 0)]}, "wrong-type", "points.*0, 0"),
    ({"points": {1: (0, 0)}}, "wrong-type", "points.*not 1"),
    ({"points": {**FOUR, "B": (0, 1, 2)}}, "shape", r"points\['B'\].*2.*3"),
    ({"points": {**FOUR, "E": (0, 1)}}, "wrong-value", "point 'E' belongs to no link"),
    ({"points": {**FOUR, "crank": (0, 1)}, "links": {**BARS, "rocker": ("C", "D", "crank")}}, "duplicate-name",
     "'crank'"),
    ({"links": [("A", "B")]}, "wrong-type", "links"),
    ({"links": {"crank": "AB"}}, "missing-argument", "links.*'ground'.*'crank'"),
    ({"links": {**BARS, "coupler": "BE"}}, "wrong-name", r"links\['coupler'\].*'E'"),
    ({"links": {**BARS, "coupler": 7}}, "wrong-type", r"links\['coupler'\]"),
    ({"links": {**BARS, "stub": "B"}}, "shape", r"links\['stub'\].*'B'"),
    ({"links": {**BARS, "ground": ""}}, "shape", r"links\['ground'\].*''"),
    ({"links": {**BARS, "coupler": "BCB"}}, "duplicate-name", r"links\['coupler'\].*'BCB'"),
    ({"links": {**BARS, "a.b": "AC"}}, "wrong-value", "name of a link must be of letters"),
    ({"lengths": [1.0]}, "wrong-type", "lengths"),
    ({"lengths": {"AC": 2.0}}, "wrong-name", r"lengths\['AC'\]"),
    ({"lengths": {"AE": 2.0}}, "wrong-name", "'E'"),
    ({"lengths": {"crank": 2.0}}, "wrong-name", "'crank'"),
    ({"lengths": {3: 2.0}}, "wrong-type", "lengths.*not 3"),
    ({"lengths": {"ABC": 2.0}}, "wrong-value", "lengths must be between two points, such as 'AD', not 'ABC'"),
    ({"lengths": {"AA": 2.0}}, "wrong-value", "lengths must be between two points, such as 'AD', not 'AA'"),
    ({"lengths": {"AB": 2.0, "BA": 2.0}}, "duplicate-name", "'A' and 'B'"),
    ({"lengths": {"AB": 0.0}}, "out-of-range", r"lengths\['AB'\].*than 0, not 0"),
    ({"mass": -1.0}, "out-of-range", "^mass must.*least 0, not -1"),
    ({"mass": {"arm": 1.0}}, "wrong-name", "'arm'"),
    ({"mass": {"ground": 1.0}}, "wrong-name", "'ground'"),
    ({"mass": {"crank": -1.0}}, "out-of-range", r"mass\['crank'\].*least 0, not -1"),
    ({"scale": 0.0}, "out-of-range", "scale.*than 0, not 0"),
    ({"points": {**FOUR, "B": (0, 0)}}, "geometry", "'A' and 'B'.*'crank'"),
]


@pytest.mark.parametrize(("change", "code", "sentence"), REFUSED)
def test_what_cannot_be_is_refused_by_name(change, code, sentence):
    with refused(code, sentence):
        zd.linkage(**{"points": FOUR, "links": BARS, **change})


PLATES = [
    ({"AB": 2, "AC": 1, "BC": 0.5}, (1, 1), "lengths of link 'plate' make no triangle: AC 1, BC 0.5, AB 2"),
    ({"AC": 3, "BC": 0.5}, (1, 1), "lengths of link 'plate' make no triangle: AC 3, BC 0.5, AB 1"),
    ({"AC": 1, "BC": 1}, (0.5, 0), "point 'C' of link 'plate' is drawn in line with 'A' and 'B'"),
    ({"AC": 1}, (0, 0), "points 'A' and 'C' of link 'plate' must be two places in the sketch"),
]


@pytest.mark.parametrize(("lengths", "C", "sentence"), PLATES)
def test_plates_that_cannot_be_are_reported_with_their_lengths(lengths, C, sentence):
    with refused("geometry", sentence):
        plate({"A": (0, 0), "B": (1, 0), "C": C}, lengths)


def test_lengths_that_contradict_each_other_are_reported():
    with refused("geometry", r"'plate'.*'C' and 'D'.*are 1.*not 1\.5"):
        plate({"A": (0, 0), "B": (1, 0), "C": (1, 1), "D": (0, 1)},
              {"AB": 1, "AC": np.sqrt(2), "BC": 1, "AD": 1, "BD": np.sqrt(2), "CD": 1.5})
