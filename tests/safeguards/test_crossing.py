"""Configurations where constraints become dependent that are independent elsewhere: at a step's end, within a step, or nearly."""

import warnings
from collections import Counter

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import tolerances as tol
import zerodrift as zd
from covering import draws, spread
from support import FORMULATIONS, assert_close, refused

TURN = 2 * np.pi
STOPS = "a bifurcation"


# ---- a parallelogram lies flat ----


def parallelogram(steps=None, formulation="schur", *, ground=1.0, gravity=0.0, end=1.0, **options):
    """A turn of a crank: it and the rocker turn together, the coupler is always parallel to the ground."""
    system = zd.systems.four_bar(lengths=(ground, 0.3, 1, 0.3), gravity=gravity, crank_rate=TURN)
    return zd.simulate(system, end, step=steps and 1 / steps, formulation=formulation, **options)


def assert_parallel(sol, error=1e-8):
    """Another branch would turn the coupler by tenths of radians."""
    assert np.abs(sol.p[:, 1]).max() < error
    assert_close(sol.p[:, 0], np.pi / 2 + TURN * sol.t, error)


@pytest.mark.parametrize("steps", [100, 200, 53, 101, 137])
def test_a_parallelogram_stops(steps, formulation):
    """Flat at a quarter and at three quarters of the turn, at a step's end or within one."""
    with refused("bifurcation", r"^at t = 0\.25 \(step .* of .*a bifurcation: row 0 'closure_x' follows from the "
                                             r"others\); on_singular=\"continue\" takes the branch of least acc.*$") as caught:
        parallelogram(steps, formulation)
    sol = caught.value.solution
    assert_parallel(sol)
    assert 0.25 - 1 / steps - 1e-12 <= sol.t[-1] < 0.25


@pytest.mark.parametrize("steps", [100, 200, 53, 101, 137])
def test_a_parallelogram_goes_on(steps, formulation):
    sol = parallelogram(steps, formulation, on_singular="continue")
    assert_parallel(sol)
    assert sol.stats["rank_drops"] == 2
    assert "the rank dropped in 2 steps" in repr(sol)
    assert np.abs(sol.position_violation).max() < 1e-12
    assert np.abs(sol.velocity_violation).max() < 1e-11


@pytest.mark.parametrize("rtol", [1e-5, 1e-7, 1e-9, 1e-11])
@pytest.mark.parametrize("method", ["dormand_prince", "dop853"])
def test_a_parallelogram_by_steps_that_are_chosen(method, rtol, formulation):
    """Its motion is steady, so that steps would pass over half a turn and more."""
    sol = parallelogram(None, formulation, integrator=method, rtol=rtol, on_failure="return")
    assert_parallel(sol)
    assert not sol.success
    assert STOPS in sol.message
    assert abs(sol.t[-1] - 0.25) < 1e-3
    again = parallelogram(None, formulation, integrator=method, rtol=rtol, on_singular="continue")
    assert_parallel(again, 1e-7)
    assert again.stats["rank_drops"] >= 2


@pytest.mark.parametrize("steps", [400, 411])
def test_every_integrator_passes_it(steps, integrator):
    """Rates change abruptly beside the motion: the stages of radau's fixed steps may not be found there, and it stops then."""
    sol = parallelogram(steps, integrator=integrator, on_singular="continue", on_failure="return")
    if integrator == "radau" and not sol.success:
        assert "implicit 'radau' step were not solved" in sol.message
        return
    assert sol.success
    assert np.abs(sol.p[:, 1]).max() < 1e-6
    assert sol.stats["rank_drops"] == 2


@pytest.mark.pairs(steps=[100, 137], options={
    "none": {"stabilization": None}, "baumgarte": {"stabilization": "baumgarte"},
    "identity": {"stabilization": zd.Projection(metric="identity")}, "every 3": {"stabilization": zd.Projection(every=3)},
    "energy": {"energy": True}, "t_eval": {"t_eval": np.linspace(0, 1, 33)}, "events": {"events": lambda t, p, v: np.cos(p[0])}})
def test_it_is_noticed_whatever_else_is_done(steps, options, formulation):
    sol = parallelogram(steps, formulation, on_singular="stop", on_failure="return", **options)
    assert STOPS in sol.message
    assert_parallel(parallelogram(steps, formulation, on_singular="continue", **options))


def test_the_same_loop_twice():
    """Redundant rows, and a bifurcation of the others."""
    bar = zd.systems.four_bar(lengths=(1, 0.3, 1, 0.3), gravity=0, crank_rate=TURN)

    def closure(p):
        l = np.array([0.3, 1.0, 0.3])       # noqa: E741
        return np.array([l @ np.cos(p) - 1, l @ np.sin(p)])

    twice = zd.System(3, mass=lambda p: bar.evaluate(p).M, bias=lambda p, v: bar.evaluate(p, v).d, potential=0.0,
                      constraints=lambda p: np.concatenate([closure(p), 2 * closure(p)]), p0=bar.p0, v0=bar.v0)
    for steps in (40, 41):
        sol = zd.simulate(twice, 0.6, step=1 / steps, on_singular="continue")
        assert_parallel(sol, 1e-6)
        assert (sol.stats["rank"], sol.stats["rank_drops"]) == (2, 1)


# ---- a slider-crank of equal links, whose other branch has x = 0 ----


def crank(angle, rod, rates, gravity=0.0, moves=0.0):
    """A slider-crank of equal links, at these angles of crank and rod; its slider's guide moves along by moves t^2 / 2."""
    return zd.System(
        ["q", "x", "phi"], mass=np.diag([0.4, 0.7, 0.2]),
        force=lambda p: np.array([-gravity * np.cos(p[0]), 0.3 * gravity, 0.0]),
        potential=lambda p: gravity * (np.sin(p[0]) - 0.3 * p[1]),
        constraints=lambda p, t: np.array([p[1] - np.cos(p[0]) - np.cos(p[2]) - moves * t**2 / 2, np.sin(p[0]) + np.sin(p[2])]),
        p0=[angle, np.cos(angle) + np.cos(rod), rod], v0=rates)


def crank_acceleration(q, rate, gravity=0.0, moves=0.0):
    """Acceleration of q for phi = -q, x = 2 cos q + moves t^2 / 2, by Lagrange's equation of q alone."""
    s, c = np.sin(q), np.cos(q)
    return (-gravity * c - 0.6 * gravity * s + 1.4 * s * (moves - 2 * c * rate**2)) / (0.6 + 2.8 * s**2)


MOVES = [(0.0, 0.0), (3.0, 0.0), (3.0, 0.8)]
FLAT = np.pi / 2, -np.pi / 2


@pytest.mark.pairs(forces=MOVES, away=[0.0, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2])
def test_accelerations_at_and_near_a_bifurcation(away, forces, formulation):
    """Accelerations of the motion through the bifurcation; near it, to the fourth root of rounding, as limits.c derives."""
    gravity, moves = forces
    q, rate = FLAT[0] + away, 5.0
    system = crank(q, -q, [rate, -2 * np.sin(q) * rate, -rate], gravity, moves)
    vdot, _ = zd.acceleration(system, system.p0, system.v0, formulation=formulation, on_singular="continue")
    expected = crank_acceleration(q, rate, gravity, moves)
    assert_close(vdot[0], expected, 1e-8 if away in (0.0, 1e-2) else 5e-3, scale=rate**2)
    assert_close(vdot[2], -expected, 1e-8 if away in (0.0, 1e-2) else 5e-3, scale=rate**2)


@pytest.mark.parametrize(("gravity", "moves"), MOVES)
def test_the_order_is_kept_through_a_bifurcation(gravity, moves, formulation):
    """It is met at a step's end, right after one, and in between."""
    start = np.array([0.3, TURN])
    exact = solve_ivp(lambda t, y: [y[1], crank_acceleration(*y, gravity, moves)], (0, 1), start, rtol=1e-12, atol=1e-12,
                      method="DOP853", dense_output=True, events=lambda t, y: y[0] - FLAT[0])
    flat = exact.t_events[0][0]
    system = crank(0.3, -0.3, [TURN, -2 * np.sin(0.3) * TURN, -TURN], gravity, moves)
    for shift in spread((0.0, 0.01, 0.4), 2):
        errors = []
        for steps in (20, 40, 80):
            step = flat / (steps + shift)
            sol = zd.simulate(system, 1.5 * flat, step=step, formulation=formulation, on_singular="continue")
            assert sol.stats["rank_drops"] == 1
            errors.append(abs(sol.p[-1, 0] - exact.sol(sol.t[-1])[0]))
        orders = np.log2(np.array(errors[:-1]) / errors[1:])
        assert np.all(orders > 3.5), errors


@pytest.mark.each_value
@pytest.mark.pairs(steps=[800, 777])
def test_a_slider_crank_turns(steps, formulation):
    """Four times through it: T = (0.6 + 2.8 sin^2 q) qdot^2 / 2 is constant."""
    def rate(q):
        return np.sqrt((0.6 + 2.8 * np.sin(0.3) ** 2) / (0.6 + 2.8 * np.sin(q) ** 2)) * TURN

    system = crank(0.3, -0.3, [TURN, -2 * np.sin(0.3) * TURN, -TURN])
    sol = zd.simulate(system, 2.0, step=2 / steps, formulation=formulation, on_singular="continue")
    exact = solve_ivp(lambda t, q: rate(q), (0, 2), [0.3], t_eval=sol.t, method="DOP853", rtol=1e-12, atol=1e-12).y[0]
    assert_close(sol.p[:, 0], exact, 1e-7)
    assert np.abs(sol.p[:, 0] + sol.p[:, 2]).max() < 1e-8
    assert sol.stats["rank_drops"] == np.sum(np.diff(np.floor((exact - FLAT[0]) / np.pi)) > 0)


@pytest.mark.parametrize("rates", [[1.0, -2.0, -1.0], [1.0, 0.0, 1.0]], ids=["x moves", "x rests"])
def test_a_start_at_a_bifurcation(rates, formulation):
    """Either branch, as the velocities say."""
    system = crank(*FLAT, rates)
    with refused("bifurcation", "row 1 follows"):
        zd.simulate(system, 1.0, step=0.01, formulation=formulation)
    sol = zd.simulate(system, 1.0, step=0.01, formulation=formulation, on_singular="continue")
    assert sol.stats["redundant"] == []
    assert sol.stats["rank"] == 2
    assert_close(sol.kinetic_energy, sol.kinetic_energy[0] * np.ones_like(sol.t), 1e-6)
    sign = np.sign(rates[2])
    assert_close(sol.p[:, 2] - FLAT[1], sign * (sol.p[:, 0] - FLAT[0]), 1e-9)


@pytest.mark.each_value
@pytest.mark.pairs(gravity=[3.0, -3.0])
def test_a_start_from_rest_at_a_bifurcation(gravity, formulation):
    """Gravity pulls the slider: along the branch on which it moves; on the other all would stay at rest."""
    system = crank(*FLAT, [0.0, 0.0, 0.0], gravity)
    vdot, _ = zd.acceleration(system, system.p0, system.v0, formulation=formulation, on_singular="continue")
    expected = crank_acceleration(FLAT[0], 0.0, gravity)
    assert_close(vdot, expected * np.array([1.0, -2.0, -1.0]), 1e-9)
    exact = solve_ivp(lambda t, y: [y[1], crank_acceleration(*y, gravity)], (0, 1), [FLAT[0], 0.0], method="DOP853",
                      rtol=1e-12, atol=1e-12)
    sol = zd.simulate(system, 1.0, step=0.005, formulation=formulation, on_singular="continue")
    assert_close(sol.p[-1, 0], exact.y[0, -1], 1e-9)
    assert np.abs(sol.energy_violation).max() < 1e-10


def isolated():
    """A point mass that x^2 + y^2 = 0 holds to a line: no branch leads away from it."""
    return zd.System(3, mass=np.eye(3), force=np.array([1.0, 2.0, 3.0]), potential=0.0, p0=np.zeros(3), v0=np.zeros(3),
                     constraints=lambda p: np.array([p[0] ** 2 + p[1] ** 2]))


@pytest.mark.parametrize("name", FORMULATIONS)
def test_where_there_is_no_branch(name):
    """The minimum acceleration is taken, or an error is raised where independent velocities need a branch."""
    system = isolated()
    if name not in ("mixed", "independent"):
        vdot, _ = zd.acceleration(system, system.p0, system.v0, formulation=name, on_singular="continue")
        assert_close(vdot, [1.0, 2.0, 3.0], tol.STEPPED)
    else:
        with refused("bifurcation", r"independent velocities require the branch .* none was found"):
            zd.simulate(system, 1.0, step=0.01, formulation=name, on_singular="continue")


def test_a_velocity_along_no_branch(formulation):
    """To first order it satisfies the constraints; to second order nothing does."""
    for on_singular in ("stop", "continue"):
        with refused("contradicting-constraints", "row 1 requires another acceleration at this velocity"):
            zd.simulate(crank(*FLAT, [1.0, -1.0, 0.0]), 1.0, step=0.01, formulation=formulation, on_singular=on_singular)


# ---- nearly ----


@pytest.mark.parametrize("off", [s * 10.0**k for k in (-10, -8, -6, -4, -2) for s in (1, -1)])
def test_no_motion_near_a_bifurcation_is_wrong_in_silence(off):
    """With a ground a little longer or shorter the crank turns back, or the coupler swings over: a sharp turn where the
    parallelogram would go straight on. Runs whose steps are too long for it stop, or are warned of.
    """
    exact = parallelogram(integrator="dop853", rtol=1e-11, atol=1e-11, ground=1 + off, end=0.5).p[-1]
    outcomes = Counter()
    for name in FORMULATIONS:
        for steps in spread((53, 100, 400, 1003), 2):
            for options in ({}, {"on_singular": "continue"}, {"energy": True}):
                with warnings.catch_warnings(record=True) as said:
                    warnings.simplefilter("always")
                    sol = parallelogram(steps, name, ground=1 + off, end=0.5, on_failure="return", **options)
                right = sol.success and np.abs(sol.p[-1] - exact).max() < 0.05
                outcomes["stopped" if not sol.success else "warned" if said else "right" if right else "wrong"] += 1
    assert outcomes["wrong"] == 0, outcomes
    assert outcomes["right"] > draws(12, 30) or abs(off) < 1e-3, outcomes
    assert outcomes["stopped"] > draws(2, 5) or abs(off) > 1e-7, outcomes


def loop_of_hinges(dimension, ground, angle, rate):
    """Nearly a parallelogram; in space three of its rows are redundant."""
    def at(x):
        return (*x, 0.0)[:dimension]

    crank_end, hinge = 0.3 * np.array([np.cos(angle), np.sin(angle)]), np.array([ground, 0.0])
    far, along = np.linalg.norm(hinge - crank_end), (hinge - crank_end) / np.linalg.norm(hinge - crank_end)
    part = (1 - 0.3**2 + far**2) / (2 * far)
    rocker_end = crank_end + part * along + np.sqrt(1 - part**2) * np.array([-along[1], along[0]])
    loop = zd.Mechanism("loop", dimension=dimension, gravity=(0, -9.81, 0)[:dimension])
    crank = loop.link("crank", at((0, 0)), at(crank_end), mass=1.0)
    coupler = loop.link("coupler", at(crank_end), at(rocker_end), mass=2.0)
    rocker = loop.link("rocker", at(hinge), at(rocker_end), mass=1.5)
    axis = {"axis": (0, 0, 1)} if dimension == 3 else {}
    for name, one, other, place in (("A", loop.ground, crank, (0, 0)), ("B", crank, coupler, crank_end),
                                    ("C", coupler, rocker, rocker_end), ("D", loop.ground, rocker, hinge)):
        loop.revolute(name, one, other, at=at(place), **axis)
    loop.start({"A.speed": rate})
    return loop


@pytest.mark.parametrize("off", [-1.4901644640105651e-09, -3.860264840669051e-07])
def test_a_choice_that_comes_back_reversed_hides_no_bifurcation(off, formulation):
    """With all links in line, the axis of a rotation that the chosen constraints leave to redundant ones lies there too: they are
    reversed twice as they pass it.
    """
    place = 1 + off, 1.5577951322998254, 8.790239812924861
    exact = zd.simulate(loop_of_hinges(2, *place).system("joint"), 0.5, integrator="dop853", rtol=1e-11, atol=1e-11)
    for step in (0.013893485314687357, 0.0135, 0.0142):
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            sol = zd.simulate(loop_of_hinges(3, *place).system("absolute"), 0.5, step=step, formulation=formulation,
                              integrator="rk4", energy=True, on_failure="return")
        assert sol.stats["redundant"]
        is_right = sol.success and all(abs(sol[name][-1] - exact[name][-1]) < 0.05 for name in ("A.angle", "D.angle"))
        assert is_right or said or not sol.success, (step, sol["A.angle"][-1], sol["D.angle"][-1])


@pytest.mark.parametrize("ground", [1.000001, 1.0001, 1.01, 0.9999])
def test_adaptive_steps_follow_a_sharp_turn(ground, formulation):
    """With the longer ground the crank, which the system itself takes for independent, turns back."""
    exact = parallelogram(integrator="dop853", rtol=1e-11, atol=1e-11, ground=ground, end=0.5).p[-1]
    sol = parallelogram(integrator="dormand_prince", rtol=1e-9, atol=1e-9, ground=ground, end=0.5, formulation=formulation)
    assert sol.stats["steps"] < 500
    assert_close(sol.p[-1], exact, 1e-4)


def test_what_to_do_is_a_setting(tmp_path):
    with refused("unknown-choice", r"on_singular must be 'stop' or 'continue'|on_singular"):
        parallelogram(100, on_singular="guess")
    sol = parallelogram(100, on_singular="continue")
    again = zd.load(sol.save(tmp_path / "motion"))
    assert again.settings["on_singular"] == "continue"
    assert again.stats["rank_drops"] == 2
    assert repr(again) == repr(sol)
    assert np.array_equal(zd.simulate(sol.system, sol.t_span, **sol.settings).p, sol.p)


# ---- what may fail on the way ----


class Refused(Exception):
    """Raised by a system."""


@pytest.mark.parametrize("on_singular", ["stop", "continue"])
@pytest.mark.parametrize("options", [{"step": 0.05}, {"step": 0.047}, {"rtol": 1e-5, "integrator": "dormand_prince"}], ids=str)
def test_an_exception_at_any_evaluation_near_a_bifurcation(options, on_singular, formulation):
    """Whatever was being looked for there, it is that exception that comes out."""
    calls, last = 0, np.inf

    def constraints(p):
        nonlocal calls
        calls += 1
        if calls >= last:
            raise Refused(f"call {calls}")
        return np.array([p[1] - np.cos(p[0]) - np.cos(p[2]), np.sin(p[0]) + np.sin(p[2])])

    system = zd.System(3, mass=np.diag([0.4, 0.7, 0.2]), potential=0.0, constraints=constraints,
                       p0=[FLAT[0] - 0.2, 2 * np.sin(0.2), 0.2 - FLAT[0]], v0=[2.0, -4 * np.cos(0.2), -2.0])
    run = {"formulation": formulation, "on_singular": on_singular, **options}
    zd.simulate(system, 0.2, on_failure="return", **run)
    calls = 0
    sol = zd.simulate(system, 0.2, on_failure="return", **run)
    assert sol.success == (on_singular == "continue")
    whole = calls
    for last in range(2, whole, max(1, whole // draws(6, 60))):
        calls = 0
        with pytest.raises(Refused, match=f"call {last}"):
            zd.simulate(system, 0.2, **run)
