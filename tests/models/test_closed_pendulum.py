"""Closed pendulums, from bodies and joints and from their energies, against equations by hand and the built-in four-bar."""

import itertools

import numpy as np
import pytest

import energy_models
import known_motions
import zerodrift as zd
from support import assert_close

LINKS = (4, 5, 6, 8, 10)


@pytest.mark.parametrize("links", [3, *LINKS])
def test_closed_pendulum_against_equations_by_hand(links):
    """Slender links: M_ij = m L^2 (n - max(i, j) - 1/2) cos(theta_i - theta_j), and n - i - 2/3 where i = j, from i = 0."""
    system = energy_models.closed_pendulum(links, length=0.7, mass=1.3)
    rng, i = np.random.default_rng(links), np.arange(links)
    p, v = rng.normal(size=(2, links))
    share = links - np.maximum.outer(i, i) - 0.5 - np.eye(links) / 6
    terms, difference = system.evaluate(p, v), p[:, None] - p
    assert_close(terms.M, 1.3 * 0.49 * share * np.cos(difference), 1e-13)
    assert_close(terms.d, 1.3 * 0.49 * (share * np.sin(difference)) @ v**2, 1e-13)
    assert_close(terms.f, -1.3 * 9.81 * 0.7 * (links - i - 0.5) * np.cos(p), 1e-13)
    assert_close(terms.C, 0.7 * np.array([-np.sin(p), np.cos(p)]), 1e-14)
    assert_close(terms.xi, 0.7 * np.array([np.cos(p), np.sin(p)]) @ v**2, 1e-13)


def test_closed_pendulum_of_three_links_is_the_built_in_four_bar():
    mine = energy_models.closed_pendulum(3)
    bar = zd.systems.four_bar(lengths=[2.0, 1.0, 1.0, 1.0], masses=[1.0, 1.0, 1.0], crank_angle=mine.p0[0])
    sols = [zd.simulate(system, 2.0, mine.p0, np.zeros(3), step=1e-3) for system in (mine, bar)]
    assert_close(sols[0].p, sols[1].p, 1e-10)
    assert_close(sols[0].kinetic_energy, sols[1].kinetic_energy, 1e-9)


@pytest.mark.parametrize("links", LINKS)
def test_closed_pendulum_for_a_hundred_seconds(links):
    """The motion is chaotic and not to be had twice; the constraints hold, and the energy stays."""
    sol = zd.simulate(energy_models.closed_pendulum(links), 100.0, step=0.002)
    assert sol.t[-1] == 100.0
    assert np.abs(sol.position_violation).max() <= 1e-12
    assert np.abs(sol.velocity_violation).max() <= 1e-12
    assert np.abs(sol.energy_violation).max() < 1e-2 * sol.kinetic_energy.max()       # 2.4e-3 was the most that was seen
    assert sol.kinetic_energy[-5000:].max() > 0.5 * sol.kinetic_energy.max()      # and it moves to the end


@pytest.mark.each_value
@pytest.mark.pairs(links=LINKS)
def test_energy_of_the_closed_pendulum_falls_at_the_order_of_the_method(links, formulation):
    system = energy_models.closed_pendulum(links)
    errors = [np.abs(zd.simulate(system, 2.0, step=step, formulation=formulation).energy_violation).max()
              for step in (0.001, 0.0005, 0.00025)]
    orders = [np.log2(coarse / fine) for coarse, fine in itertools.pairwise(errors)]
    assert orders[-1] > 3.7, errors


@pytest.mark.parametrize("links", [4, 5, 8, 30])
def test_start_of_the_closed_pendulum(links):
    """An arch, of which no link has wound up, and from which a run can start."""
    system = energy_models.closed_pendulum(links)
    assert (np.diff(system.p0) < 0).all()
    assert np.abs(system.p0).max() < 2.5
    assert zd.simulate(system, 0.01, step=0.005).success
    joints = system.points(system.p0)
    assert_close(joints[0], np.zeros(2), 1e-15)
    assert_close(joints[-1], np.array([system.parameters["span"], 0.0]), 1e-11)
    assert (joints[1:-1, 1] > 0).all()
    assert (system.parameters["span"] - links) % 2 == 1     # the links cannot line up


@pytest.mark.parametrize("links", [3, 6])
def test_bodies_and_joints_are_the_pendulum_of_energies(links):
    energies = energy_models.closed_pendulum(links, length=0.7)
    sols = [zd.simulate(each, 0.3, step=0.005, integrator="dop853")
            for each in (zd.models.closed_pendulum(links, length=0.7), energies)]
    angles = np.stack([sols[0][f"link{i + 1}.angle"] for i in range(links)], axis=1)
    assert known_motions.closed_pendulum(sols[0], links, length=0.7) < 1e-9
    assert_close(angles[0], energies.p0, 1e-11)
    assert_close(angles, sols[1].p, 1e-9)
    force = sols[0][f"pin{links}.force"]        # what the chain does to the ground, which the closing rows' multipliers are
    assert min(np.abs(force - sign * sols[1].multipliers).max() for sign in (1, -1)) < 1e-7 * np.abs(force).max()


@pytest.mark.parametrize(("wrong", "error", "message"), [
    ({"links": 2}, ValueError, "links must be between 3 and"),
    ({"links": 2.5}, TypeError, r"links must be a whole number, not 2\.5"),
    ({"links": 4, "span": 4.0}, ValueError, r"span must be less than 4 links of 1 m together, 4 m, not 4"),
    ({"length": 0.0}, ValueError, "length must be greater than 0"),
    ({"mass": "1"}, TypeError, "mass must be a real number, not '1'"),
])
def test_wrong_closed_pendulums(wrong, error, message):
    with pytest.raises(error, match=message):
        zd.models.closed_pendulum(**wrong)
