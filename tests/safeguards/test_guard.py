"""Steps too long to be corrected: shortened iterations, parts of steps, and branches that are not left in silence."""

import numpy as np
import pytest

import zerodrift as zd
from covering import draws
from support import SYSTEMS, motion, refused
from turning_cranks import LENGTHS, side

TRIALS = 250


def random_runs(seed, trials, **options):
    """Four-bars from anywhere, with steps from short to absurd."""
    rng = np.random.default_rng(seed)
    for _ in range(trials):
        bar = zd.systems.four_bar(lengths=LENGTHS[rng.integers(3)], assembly=["open", "crossed"][rng.integers(2)],
                                  crank_angle=rng.uniform(-3, 3), crank_rate=rng.normal() * 10 ** rng.uniform(0, 1))
        h = 10 ** rng.uniform(-2, 0.3)
        yield h, zd.simulate(bar, 30 * h, step=h, on_failure="return", **options)


@pytest.mark.each_value
@pytest.mark.filterwarnings("ignore::zerodrift.StabilityWarning")
def test_no_run_changes_branch(formulation, integrator):
    """Whatever the step: a run stays where it was assembled, or stops. And short steps need no help."""
    ends = {True: 0, False: 0}
    for h, sol in random_runs(2002, TRIALS // 12, formulation=formulation, integrator=integrator):
        assert (side(sol) == side(sol)[0]).all()
        assert sol.success == (sol.status == 0)
        ends[sol.success] += 1
        if h * np.abs(sol.v).max() < 0.05:
            assert sol.success
            assert sol.stats["subdivided"] == sol.stats["damped"] == 0
    assert all(ends.values())


@pytest.mark.filterwarnings("ignore::zerodrift.StabilityWarning")
def test_a_step_too_long_is_made_in_parts(bar):
    """And then is what the parts would have been."""
    start = bar.p0, 10 * bar.v0
    sol = zd.simulate(bar, 0.32, *start, step=0.32)
    assert sol.stats["subdivided"] == 1
    assert sol.stats["steps"] == 1
    parts = [zd.simulate(bar, 0.32, *start, step=0.32 / n).p[-1] for n in (2, 4, 8)]
    assert min(np.abs(sol.p[-1] - part).max() for part in parts) < 1e-12


def test_where_parts_do_not_help_the_run_stops_with_what_is_left(bar):
    with refused("branch-jump", "is divided") as caught:
        zd.simulate(bar, 8.0, step=2.0)
    sol = caught.value.solution
    assert (side(sol) == side(sol)[0]).all()
    with refused("correction-failed", r"left max \|Phi\| = .* of its size after 1 iterations.* \(tolerance 1e-15\)"):
        motion(bar, 8.0, 16, stabilization=zd.Projection(tol=1e-15, max_iterations=1))


@pytest.mark.filterwarnings("ignore::zerodrift.StabilityWarning")
def test_a_branch_that_would_be_left_is_named():
    """The crank is thrown so that one step carries links far around; what is found there is another assembly or nonsense."""
    bar, found = zd.systems.four_bar(crank_rate=40.0), []
    for h in np.linspace(0.05, 0.3, draws(13, 26)):
        sol = zd.simulate(bar, 5 * h, step=h, integrator="euler", on_failure="return")
        assert (side(sol) == side(sol)[0]).all()
        found.append(sol.message)
    assert any("on (or near) another assembly branch" in message for message in found)
    assert issubclass(zd.BranchJump, zd.CorrectionFailed)


@pytest.mark.filterwarnings("ignore::zerodrift.StabilityWarning")
def test_adaptive_steps_do_not_change_branch_either():
    for rate in (1.0, 20.0, -35.0):
        bar = zd.systems.four_bar(crank_rate=rate)
        sol = zd.simulate(bar, 2.0, rtol=0.5, atol=0.5, first_step=1.0, integrator="dormand_prince", on_failure="return")
        assert (side(sol) == side(sol)[0]).all()


def test_assembling_from_far_away_converges_by_shortened_iterations(bar):
    """Newton's full iterations do not, from some of these guesses; shortened ones do, from nearly all."""
    rng, full, shortened = np.random.default_rng(5), 0, 0
    for _ in range(200):
        guess = rng.uniform(-np.pi, np.pi, 3)
        try:
            p, _ = zd.assemble(bar, guess, max_iterations=20)
        except zd.ZerodriftError:
            continue
        assert np.abs(bar.evaluate(p).Phi).max() <= 1e-12
        shortened += 1
        full += newton(bar, guess)
    assert shortened > 195
    assert full < shortened


def newton(bar, p, iterations=20):
    """True if the undamped iteration (25a) converges, in NumPy."""
    for _ in range(iterations):
        e = bar.evaluate(p)
        if np.abs(e.Phi).max() <= 1e-12:
            return True
        weighted = np.linalg.solve(e.M, e.C.T)
        p = p - weighted @ np.linalg.solve(e.C @ weighted, e.Phi)
    return False


@pytest.mark.parametrize("name", SYSTEMS)
def test_ordinary_steps_are_left_alone(name):
    sol = motion(SYSTEMS[name], 1.0, 50)
    assert sol.stats["damped"] == sol.stats["subdivided"] == sol.stats["too_long"] == sol.stats["stiff"] == 0
    assert (sol.energy_skipped == 0).all()
