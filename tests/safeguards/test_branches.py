"""Runs that reach their end on another assembly branch are reported; motions through dead points are not."""

import warnings

import numpy as np
import pytest

import zerodrift as zd
from zerodrift.runs.states import branches


def four_bar(a, b, c, d, angle, bend, speed):
    """A drawing with a crank from (0, 0), a coupler, and a rocker to (d, 0)."""
    B = a * np.array([np.cos(angle), np.sin(angle)])
    across = np.array([d, 0]) - B
    length = np.hypot(*across)
    turn = np.arctan2(*across[::-1]) + bend * np.arccos((b * b + length**2 - c * c) / (2 * b * length))
    C = B + b * np.array([np.cos(turn), np.sin(turn)])
    m = zd.Mechanism("four-bar", gravity=(0, -9.81))
    crank, coupler, rocker = m.link("crank", (0, 0), B, 1.0), m.link("coupler", B, C, 1.0), m.link("rocker", C, (d, 0), 1.0)
    m.revolute("A", m.ground, crank.start), m.revolute("B", crank.end, coupler.start), m.revolute("C", coupler.end, rocker.start)
    m.revolute("D", rocker.end, m.ground.point((d, 0)))
    m.start({"A.speed": speed})
    return m


def sides(sol):
    """The side of the coupler on which the rocker is hinged: that of a crank-rocker's branch."""
    u = sol["coupler.end.position"] - sol["coupler.start.position"]
    w = sol["rocker.end.position"] - sol["coupler.start.position"]
    return np.sign(u[:, 0] * w[:, 1] - u[:, 1] * w[:, 0])


def run(mechanism, kind, **options):
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        sol = zd.simulate(mechanism.system(kind), 4.0, on_failure="return", **options)
    return sol, [str(each.message) for each in caught]


def place_on_other_branch(sol, other, k):
    """The samples of one run up to k, and of the mirrored drawing after it."""
    p = np.vstack([sol.p[:k], other.p[k:]])
    return type("Samples", (), {"system": sol.system, "t": sol.t, "p": p, "v": sol.v, "stats": sol.stats})


@pytest.mark.parametrize("angle", [-2.0, 0.4, 1.5])
def test_samples_of_two_branches_are_distinguished(angle):
    """A crank-rocker and its other assembly: the motion from one cannot reach the other."""
    shape = (0.5, 1.5, 1.2, 1.4)
    sol, _ = run(four_bar(*shape, angle, 1, 3.0), "absolute", step=0.02)
    other, _ = run(four_bar(*shape, angle, -1, 3.0), "absolute", step=0.02)
    assert branches.changed_at(sol) is None
    assert branches.changed_at(other) is None
    for k in (1, 70, 200):
        assert branches.changed_at(place_on_other_branch(sol, other, k)) == sol.t[k - 1]


def test_motions_through_dead_points_stay_on_their_branch():
    """Four-bars of all kinds with steps from short to long; the side is invariant of those whose crank turns fully."""
    rng, rockers, passed = np.random.default_rng(5), 0, 0
    for _ in range(40):
        a, b, c, d = rng.uniform(0.2, 2, 4)
        angle, bend, speed = rng.uniform(-3, 3), rng.choice([-1, 1]), rng.normal() * 6
        reach = a * a + d * d - 2 * a * d * np.cos(angle)
        if not (b - c)**2 * 1.1 < reach < (b + c)**2 * 0.9:
            continue
        kind, step = str(rng.choice(["joint", "absolute"])), 10 ** rng.uniform(-2.3, -1.3)
        sol, _ = run(four_bar(a, b, c, d, angle, bend, speed), kind, step=step)
        if not sol.success:
            continue
        turns = (a - d)**2 > (b - c)**2 and (a + d)**2 < (b + c)**2
        changed = (sides(sol) != sides(sol)[0]).any()
        rockers, passed = rockers + turns, passed + (changed and not turns)
        assert (branches.changed_at(sol) is not None) == bool(turns and changed)
    assert rockers >= 5
    assert passed >= 3


@pytest.mark.parametrize("step", [0.1, 0.2, 0.5])
@pytest.mark.parametrize("stabilization", [None, "baumgarte"])
def test_samples_that_drift_off_the_constraints_are_on_no_branch(step, stabilization):
    """A coarse pendulum drifts out of its circle; without a projection no correction can lead to another branch."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        sol = zd.simulate(zd.systems.pendulum(), 10.0, step=step, stabilization=stabilization, on_failure="return")
    assert not any("assembly branch" in str(each.message) for each in caught)
    if stabilization is None:
        assert np.abs(sol.position_violation).max() > 1e-3      # otherwise there was nothing to mistake
        assert any("energy balance" in str(each.message) for each in caught)


# a, b, c, d, angle, bend and speed of crank-rockers, with steps that are too long
ELSEWHERE = [
    ((0.2301980967052394, 1.6497441234101353, 0.9225342846813929, 1.2123196872010795, -2.2248183660035994, -1, 21.55987622184009),
     {"step": 0.011480432194508727, "integrator": "midpoint", "formulation": "nullspace", "on_singular": "continue"}),
    ((1.9158378852799463, 1.7911684972940476, 0.7461491505004438, 0.4977464137346689, 2.8984706804154827, 1, -9.935165523656783),
     {"step": 0.1830273226980775, "integrator": "rk4", "formulation": "augmented", "on_singular": "continue", "energy": True}),
    ((0.23919145384896778, 1.0646021261999117, 1.3842767101191673, 1.7813660745584796, -0.437910236727304, 1, 7.341308395457775),
     {"step": 0.1633959671452358, "integrator": "midpoint", "formulation": "schur"}),
]


@pytest.mark.parametrize(("drawing", "options"), ELSEWHERE)
def test_a_run_on_another_branch_is_reported(drawing, options):
    """Either the run stops or stays on its branch, or the step in which it left is named."""
    sol, said = run(four_bar(*drawing), "absolute", **options)
    side = sides(sol)
    left = np.flatnonzero(side != side[0])
    named = [each for each in said if "another assembly branch" in each]
    assert bool(named) == bool(sol.success and len(left))
    if named:
        assert f"from t = {sol.t[left[0] - 1]:.6g} " in named[0]
