"""Predicted cost of a step in joint and in absolute coordinates, the choice between them, and where it is reported."""

import re

import numpy as np
import pytest

import zerodrift as zd
from large_mechanisms import binary_tree, chain, chain_of_balls, four_bars, spatial_chain, spatial_linkages, spatial_star, star
from mechanisms import known
from watched import At, throw
from zerodrift.mechanisms.reports import cost


def cost_of(m, **options):
    return cost.cost(m.system("joint")._tables, **options)


@pytest.mark.parametrize("n", [1, 2, 3, 10])
def test_products_and_factors_of_a_chain(n):
    """Pins of two rows, three velocities a body, no fill: A W B^T of three pairs a body but the last, and L of n - 1 columns."""
    products = 2 * 3 * 2 * (3 * (n - 1) + 1)
    columns = (n - 1) * (2**3 / 6 + 2**2 * 2 + 2 * 2**2 / 2 + 2**2 + 2 * 2 * 2) + 2**3 / 6 + 2**2
    system = chain(n).system("absolute")
    work = system._core.structure_work(system.p0)
    assert work.products[0] == products
    assert work.factors[0] + work.solves[0] == pytest.approx(columns)
    assert (work.columns, work.blocks, work.rows, work.products[1], work.factors[1], work.solves[1]) == (n, n - 1, 2 * n, 0, 0, 0)
    assert (work.has_products, work.is_of_many, work.is_alike) == (1, 0, 1)


def test_what_has_no_structure_has_no_count():
    system = chain(3).system("joint")
    assert system._core.structure_work(system.p0).rows == 0


def test_the_least_pivot_is_that_of_dense_factors():
    """It is between the least eigenvalue and the root of the determinant, which is the product of all pivots."""
    system = four_bars(3).system("absolute")
    e = system.evaluate(system.p0, system.v0)
    S = e.C @ np.linalg.solve(e.M, e.C.T)
    share = system._core.structure_work(system.p0).share
    scaled = S / np.sqrt(np.outer(np.diag(S), np.diag(S)))
    assert np.linalg.eigvalsh(scaled)[0] <= share <= np.linalg.det(scaled) ** (1 / system.m)


def test_redundant_constraints_and_unequal_bodies_are_seen_in_the_drawing():
    m = four_bars(3)
    m.revolute("again", m.ground, "rod0.start")
    doubled = m.system("absolute")
    unequal = four_bars(3).system("absolute").with_parameters({"bar1.mass": 1e-3})
    assert doubled._core.structure_work(doubled.p0).share < cost.REDUNDANT
    assert unequal._core.structure_work(unequal.p0).is_alike == 0
    assert cost_of(m, exact=True).absolute > 3 * cost_of(four_bars(3), exact=True).absolute


@pytest.mark.parametrize(("m", "bodies", "n", "rows", "depths", "row_depths"), [
    (chain(4), 4, 4, 0, 1 + 2 + 3 + 4, 0), (binary_tree(3), 7, 7, 0, 1 + 2 * 2 + 4 * 3, 0), (star(5), 6, 6, 0, 1 + 5 * 2, 0),
    (four_bars(1), 3, 3, 2, 1 + 1 + 2, 2 * (2 + 1)), (four_bars(2), 5, 5, 4, 3 * 1 + 2 * 2, 4 * (2 + 1)),
    (chain_of_balls(2), 2, 6, 0, 1 + 2, 0), (spatial_linkages(1), 3, 4, 3, 1 + 1 + 2, 3 * (1 + 2))])
def test_parts_of_joint_coordinates(m, bodies, n, rows, depths, row_depths):
    dense, solves = n**3 / 6 + n**2 * rows / 2 + n * rows**2, n**2 + n * rows + rows**2
    system = m.system("joint")
    assert (system.nv, system.m) == (n, rows)
    np.testing.assert_allclose(cost.parts_of_joint(system._tables), [
        1, dense, solves, bodies, bodies * (m.dimension == 3), depths, row_depths, rows, 0])


def test_coordinates_along_the_tree_are_those_that_the_core_finds():
    m = zd.Mechanism("sorts")
    arm, cart = m.link("arm", (0, 0), (1, 0), mass=1.0), m.body("cart", 1.0, 1.0, at=(1, 1))
    m.body("free", 1.0, 1.0, at=(3, 3))
    bob = m.particle("bob", 1.0, at=(1, -1))
    m.particle("dust", 1.0, at=(4, 4))
    m.revolute("pin", arm.start, m.ground)
    m.prismatic("rail", cart, m.ground, axis=(1, 0))
    m.weld("weld", cart, m.body("box", 1.0, 1.0, at=(1, 2)), at=(1, 2))
    m.rod("rod", arm.end, bob)
    system = m.system("joint")
    assert system._tables.joint_coordinates() == system.nv == 1 + 1 + 0 + 3 + 2 + 2


@pytest.mark.parametrize(("m", "layout"), [
    (chain(1), "joint"), (chain(6), "joint"), (known.four_bar(), "joint"), (four_bars(1), "joint"), (star(16), "joint"),
    (zd.models.andrews(), "joint"), (chain(24), "absolute"), (chain(100), "absolute"),
    (four_bars(10), "absolute"), (star(300), "absolute"), (binary_tree(7), "absolute"),
    (spatial_chain(4), "joint"), (spatial_chain(60), "absolute"), (chain_of_balls(6), "absolute"), (spatial_star(12), "joint"),
    (spatial_linkages(2), "joint"), (spatial_linkages(24), "absolute"), (zd.models.heavy_top(), "joint"),
    (zd.models.rattleback(), "joint"),
    (zd.models.bennett(), "absolute"), (zd.models.hookes_joint(), "joint"), (zd.models.delta_robot(), "joint"),
    (zd.models.stewart_platform(), "joint"), (zd.models.whipple_bicycle(), "joint")],
    ids=lambda given: getattr(given, "name", given))
def test_the_ends_are_clear(m, layout):
    assert m.system().layout == layout


def test_loops_of_hinges_in_space_take_absolute_coordinates_although_they_cost_more():
    found = cost_of(zd.models.bennett(), exact=True)
    assert found.joint < found.absolute < found.allowed * found.joint
    assert f"takes absolute coordinates: {found.absolute:.3g} operations a step, in joint ones {found.joint:.3g}" in str(
        zd.models.bennett())


@pytest.mark.parametrize("make", [chain, four_bars, star])
def test_the_cheaper_is_taken_and_there_is_one_place_where_that_changes(make):
    taken = []
    for n in (1, 2, 3, 4, 6, 9, 14, 20, 30, 45, 70, 100, 150, 220):
        m = make(n)
        found = cost_of(m, exact=True)
        assert cost_of(m).taken == found.taken == m.system().layout
        assert (found.absolute < found.joint, found.allowed) == (found.taken == "absolute", 1)
        taken.append(found.taken)
    assert taken == sorted(taken, reverse=True)
    assert len(set(taken)) == 2


def test_what_absolute_coordinates_cannot_take_stays_in_joint_ones():
    m = chain(60)
    m.particle("tip", 0.0, at=(61, 0))
    m.revolute("end", "link59.end", "tip")
    assert cost_of(m).absolute == np.inf
    assert m.system().layout == "joint"
    assert chain(40).system().layout == "absolute"


def test_in_space_what_has_no_mass_stays_in_joint_coordinates():
    m = chain_of_balls(6)
    m.spherical("end", "link5.end", m.particle("tip", 0.0, at=(6, 0, 0)))
    assert cost_of(m).absolute == np.inf
    assert m.system().layout == "joint"
    assert zd.simulate(m, 1e-3, step=1e-3).system.layout == "joint"


def test_written_out_mechanisms_are_in_joint_coordinates():
    m = four_bars(5)
    assert m.system().layout == "absolute"
    assert m.system(compiled=True).layout == "joint"


def test_a_change_of_numbers_and_a_file_keep_the_coordinates(tmp_path):
    m = four_bars(10)
    assert m.with_parameters({"rod0.mass": 2.0}).layout == m.system().with_parameters({"rod0.mass": 2.0}).layout == "absolute"
    sol = zd.simulate(m, 0.01, step=1e-3)
    assert zd.load(sol.save(tmp_path / "motion")).system.layout == sol.system.layout == "absolute"


@pytest.mark.parametrize("m", [four_bars(10), four_bars(1)], ids=["absolute", "joint"])
def test_print_says_which_and_both_counts(m):
    found = cost_of(m, exact=True)
    taken, other = sorted(found[:2])
    assert re.search(rf" a simulation takes {m.system().layout} coordinates: ([\d.e+]+) operations a step, in "
                     rf"{'joint' if m.system().layout == 'absolute' else 'absolute'} ones ([\d.e+]+)$", str(m)).groups() == (
        f"{taken:.3g}", f"{other:.3g}")


# ---- long chains ----


def test_long_chains_in_joint_coordinates_say_what_they_cost():
    found = cost_of(chain(300))
    time = cost.in_words(cost.seconds(found.joint))
    assert repr(chain(300).system("joint")).endswith(
        f"constraints; a step takes about {time}, {found.joint / found.absolute:.3g} times as long as in absolute coordinates>")
    assert "times as long as in absolute coordinates>" in repr(chain_of_balls(20).system("joint"))
    assert found.ratio > 20
    for system in (chain(20).system("joint"), chain(300).system("absolute"), chain(300).system()):
        assert repr(system).endswith("constraints>")


@pytest.mark.parametrize("steps", [{"step": 1e-4}, {"rtol": 1e-6, "integrator": "dop853"}], ids=["fixed", "chosen"])
def test_a_run_of_one_says_so_before_it_starts(steps):
    system = chain(340).system("joint")
    start = {"p0": np.zeros(340), "v0": np.zeros(340), "on_failure": "return"}
    with (pytest.warns(zd.CostWarning, match=r"^a step takes about .*s, .* system\('absolute'\) has these \[zd:cost\]$") as told,
          pytest.raises(ZeroDivisionError)):
        zd.simulate(system, 1.0, progress=At(1, throw(ZeroDivisionError())), **start, **steps)
    assert [each.filename for each in told] == [__file__]


def test_short_runs_and_absolute_coordinates_say_nothing():
    system = chain(100).system("joint")
    zd.simulate(system, 1e-4, np.zeros(100), np.zeros(100), step=1e-4)
    assert system._what_it_costs(3) is None
    assert system._what_it_costs(None) is None
    assert "and 100000000 steps about " in chain(300).system("joint")._what_it_costs(10**8)
    assert chain(100).system()._what_it_costs(10**12) is None
    assert zd.systems.four_bar()._what_it_costs(10**12) is None


@pytest.mark.parametrize(("time", "words"), [(7200.0, "2 h"), (90.0, "1.5 min"), (2.0, "2 s"), (0.25, "250 ms"), (3e-6, "3 us")])
def test_times_in_words(time, words):
    assert cost.in_words(time) == words
