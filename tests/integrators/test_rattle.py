"""RATTLE: its equations in NumPy, what it preserves, its order where forces depend on v and constraints on t, what it refuses."""

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from four_bar_in_python import force as weight
from four_bar_in_python import four_bar as bar_in_python
from spinning_body import body
from support import SYSTEMS, along, assert_close, consistent_states, difference, motion, numbers, refused

HOLONOMIC = {name: system for name, system in SYSTEMS.items() if "rattle" in zd.integrators(system)}
each = pytest.mark.parametrize("mechanism", HOLONOMIC.values(), ids=HOLONOMIC)


def step(system, t, p, v, h, integrator="rattle"):
    """A single one, not corrected."""
    sol = zd.simulate(system, (t, t + h), p, v, step=h, integrator=integrator, stabilization=None)
    return sol.p[-1], sol.v[-1]


def chain():
    """Two rods with absolute angles, swinging freely: M varies, and the motion is chaotic."""
    m = np.array([[2.0, 1.0], [1.0, 1.0]])
    return zd.System(2, mass=lambda p: m * np.cos(p[:, None] - p), bias=lambda p, v: m * np.sin(p[:, None] - p) @ v**2,
                     force=lambda p: -9.81 * np.diag(m) * np.sin(p), potential=lambda p: -9.81 * np.diag(m) @ np.cos(p),
                     p0=[2.0, 1.4], v0=[0.5, -1.0], name="chain")


CONSERVATIVE = SYSTEMS["four_bar"], SYSTEMS["pendulum"], chain()


# ---- the equations ----


def lagrangian_force(system, t, p, w):
    """F = f + dT/dp, the latter by differences of T."""
    e = system.evaluate(p, w, t)
    slope = np.array([along(lambda q: 0.5 * w @ numbers(system, t, q, w).M @ w, (p, axis)) for axis in np.eye(system.nq)])
    return slope + (0 if e.f is None else e.f)


@each
def test_its_equations(mechanism):
    """Up to impulses along the constraints, for F from the kinetic energy, of which the core knows only d and M."""
    h = 0.01
    for t, p0, v0 in consistent_states(mechanism):
        p1, v1 = step(mechanism, t, p0, v0, h)
        w, start, end = (p1 - p0) / h, numbers(mechanism, t, p0, v0), numbers(mechanism, t + h, p1, v1)
        mean = (start.M + end.M) / 2 @ w
        for e, momentum, sign, state in ((start, start.M @ v0, 1, (t, p0)), (end, end.M @ v1, -1, (t + h, p1))):
            defect = momentum + sign * h / 2 * lagrangian_force(mechanism, *state, w) - mean
            impulse = np.linalg.lstsq(e.C.T, defect, rcond=None)[0] if mechanism.m else np.zeros(0)
            assert_close(defect - e.C.T @ impulse, 0 * defect, tol.DIFFERENCE, scale=np.abs(mean).max())
        assert np.abs(end.Phi).max(initial=0) <= 1e-14      # the rounding of angles and lengths of a few
        assert np.abs(end.C @ v1 + end.Phi_t).max(initial=0) <= 1e-13 * (1 + np.abs(v1).max())


def test_on_the_oscillator_it_is_leapfrog():
    """With m = 1: v <- v - h/2 k x, x <- x + h v, v <- v - h/2 k x."""
    x, v, h, k = 0.1, 0.0, 0.05, 10.0
    sol = zd.simulate(zd.systems.oscillator(), 100 * h, step=h, integrator="rattle")
    for row in range(101):
        assert_close([sol.p[row, 0], sol.v[row, 0]], [x, v], tol.STEPPED, scale=0.1)
        v -= h / 2 * k * x
        x += h * v
        v -= h / 2 * k * x


# ---- what is preserved ----


def area(system, t, p, v, h, integrator):
    """The symplectic form of all pairs of a few variations that satisfy the constraints, before a step and after it."""
    rng = np.random.default_rng(3)
    before, after = [], []
    for _ in range(3):
        dp, dv = rng.normal(size=(2, system.nv))

        def varied(s, dp=dp, dv=dv):
            start = zd.project(system, p + s * dp, v + s * dv, t, projection=zd.Projection(tol=1e-14))
            states = start, step(system, t, *start, h, integrator)
            return np.array([[q, numbers(system, t, q, w).M @ w] for q, w in states])

        for form, (q, momentum) in zip((before, after), difference(varied, 0.0), strict=True):
            form.append((q, momentum))
    return [np.array([a[0] @ b[1] - b[0] @ a[1] for a in form for b in form]) for form in (before, after)]


@pytest.mark.parametrize("mechanism", [*CONSERVATIVE, SYSTEMS["oscillator"]], ids=lambda system: system.name)
def test_it_is_symplectic(mechanism):
    """The form dp ^ d(M v) on the constraints is carried along, to what differences resolve; not so by the trapezoidal rule."""
    for t, p, v in consistent_states(mechanism, 2):
        before, after = area(mechanism, t, p, v, 0.05, "rattle")
        assert np.abs(before).max() > 1e-2
        assert_close(after, before, 1e-8)
        if mechanism.name != "oscillator":      # where it does, too
            with pytest.raises(AssertionError):
                assert_close(*area(mechanism, t, p, v, 0.05, "trapezoidal"), 1e-6)


@pytest.mark.parametrize("mechanism", CONSERVATIVE, ids=lambda system: system.name)
def test_it_is_reversible(mechanism):
    """With the velocities turned around it goes back to where it came from. RK4 does not."""
    def returned(integrator):
        there = motion(mechanism, 1.0, 50, integrator=integrator)
        back = zd.simulate(mechanism, 1.0, there.p[-1], -there.v[-1], step=1 / 50, integrator=integrator)
        return np.abs(back.p[-1] - there.p[0]).max()

    assert returned("rattle") < 1e-10       # round-off, grown with the motion
    assert returned("rk4") > 1e-7


@pytest.mark.parametrize(("mechanism", "h"), [(zd.systems.pendulum(angle=2.0), 0.02), (SYSTEMS["four_bar"], 0.01)],
                         ids=["pendulum", "four_bar"])
def test_energy_over_a_hundred_thousand_steps(mechanism, h):
    """It goes up and down with the motion and stays where it is; RK4 loses in each fifth what it lost in the first."""
    def fifths(integrator):
        sol = zd.simulate(mechanism, 1e5 * h, step=h, integrator=integrator, save_every=10)
        return sol.energy_violation[1:].reshape(5, -1)

    kept, lost = fifths("rattle"), fifths("rk4")
    assert np.ptp(kept.mean(axis=1)) < 0.002 * np.abs(kept).max()
    assert np.ptp(np.abs(kept).max(axis=1)) < 0.01 * np.abs(kept).max()
    drift = np.diff(lost.mean(axis=1))
    assert (drift < 0).all()
    assert np.ptp(drift) < 0.1 * np.abs(drift).max()
    assert np.abs(drift).min() > 10 * np.ptp(kept.mean(axis=1))


# ---- order two wherever it is accepted ----


def driven_pendulum():
    """The pivot moves, the air brakes."""
    return zd.System(["x", "y"], mass=np.eye(2), force=lambda v: np.array([0, -9.81]) - 0.5 * v,
                     constraints=lambda t, p: np.array([(p[0] - 0.2 * np.sin(3 * t)) ** 2 + p[1] ** 2 - 1]) / 2,
                     potential=lambda p: 9.81 * p[1], power=lambda v: -0.5 * v @ v, p0=[0.6, -0.8], v0=[0.6, 0.0])


def growing_mass():
    """M of t: d has Mdot v."""
    return zd.System(1, mass=lambda t: np.array([[1 + 0.4 * np.sin(3 * t)]]), bias=lambda t, v: 1.2 * np.cos(3 * t) * v,
                     force=lambda p: -10 * p, p0=[0.3], v0=[1.0])


def braked_bar():
    """Friction in the joints, M of p."""
    return bar_in_python(force=lambda p, v, L, m, g: weight(p, L, m, g) - 0.4 * v, power=lambda v: -0.4 * v @ v)


def gyroscope():
    """A force across the velocity, declared as part of d."""
    turn = np.array([[0.0, 3.0], [-3.0, 0.0]])
    return zd.System(2, mass=lambda p: np.diag([1 + p[1] ** 2, 1.0]), force=lambda p: -5 * p, p0=[1.0, 0.5], v0=[0.0, 1.0],
                     bias=lambda p, v: turn @ v + np.array([2 * p[1] * v[0] * v[1], -p[1] * v[0] ** 2]))


@pytest.mark.each_value
@pytest.mark.pairs(make={each.__name__: each for each in (driven_pendulum, growing_mass, braked_bar, gyroscope, chain)},
                   stabilization={str(each): each for each in (None, "projection", zd.Baumgarte(10, 25, 20))})
def test_order_two_against_another_method(make, stabilization):
    system = make()
    exact = zd.simulate(system, 0.5, step=1 / 400, integrator="dop853")
    runs = [motion(system, 0.5, n, integrator="rattle", stabilization=stabilization) for n in (25, 50, 100)]
    for quantity in ("p", "v"):
        errors = [np.abs(getattr(run, quantity)[-1] - getattr(exact, quantity)[-1]).max() for run in runs]
        assert abs(np.log2(errors[1] / errors[2]) - 2) <= tol.ORDER, quantity


def test_a_bias_may_stand_in_the_force():
    with_bias = chain()
    m = np.array([[2.0, 1.0], [1.0, 1.0]])
    without = zd.System(2, mass=lambda p: m * np.cos(p[:, None] - p), p0=with_bias.p0, v0=with_bias.v0,
                        force=lambda p, v: -9.81 * np.diag(m) * np.sin(p) - m * np.sin(p[:, None] - p) @ v**2)
    one, other = (zd.simulate(system, 1.0, step=0.01, integrator="rattle") for system in (with_bias, without))
    np.testing.assert_allclose(other.p, one.p, atol=1e-11)      # rounding of the iteration, which a hundred steps multiply


def test_energy_input_is_integrated_along():
    """With the order of the method, for friction and moving constraints at once."""
    system = driven_pendulum()
    exact = zd.simulate(system, 0.5, step=1 / 400, integrator="dop853").energy_input[-1]
    errors = [abs(motion(system, 0.5, n, integrator="rattle").energy_input[-1] - exact) for n in (50, 100)]
    assert abs(np.log2(errors[0] / errors[1]) - 2) <= tol.ORDER


# ---- between rows, and where it cannot go ----


def test_steps_however_short(bar):
    """Steps so short that Phi / h is only rounding; events and samples within a step need such."""
    for h in (1e-5, 1e-9, 1e-14):
        p, v = step(bar, 0.0, bar.p0, bar.v0, h)
        vdot, _ = zd.acceleration(bar, bar.p0, bar.v0)
        assert_close(p, bar.p0 + h * bar.v0, 1e-9)
        assert_close(v, bar.v0 + h * vdot, 1e-8)
        assert np.abs(bar.evaluate(p, v).Phi).max() < 1e-15


@pytest.mark.parametrize(("mechanism", "reason"), [
    *((SYSTEMS[name], "are nonholonomic constraints") for name in SYSTEMS if name not in HOLONOMIC),
    (body(), "is a kinematic matrix"),
], ids=lambda value: getattr(value, "name", None))
def test_what_it_refuses(mechanism, reason):
    assert "rattle" not in zd.integrators(mechanism)
    with pytest.raises(zd.UnsuitedIntegrator, match=f"'rattle' must have a holonomic system .* here there {reason}"):
        zd.simulate(mechanism, 1.0, step=0.1, integrator="rattle")


def test_holonomic_systems_are_taken():
    assert {"four_bar", "pendulum", "oscillator"} <= set(HOLONOMIC)
    assert all(system.mn == 0 for system in HOLONOMIC.values())


def test_a_step_far_too_large(bar):
    with refused("implicit-step", "'rattle' .*; try a smaller step"):
        zd.simulate(bar, 8.0, step=0.5, integrator="rattle")


def test_large_steps_are_solved(bar):
    """A twentieth of a second, as in the paper, and a tenth: here the leading matrix alone would not lead to w."""
    for h in (0.05, 0.1):
        sol = zd.simulate(bar, 8.0, step=h, integrator="rattle")
        assert sol.stats["implicit_iterations"] <= 12 * sol.stats["steps"]
        assert np.abs(sol.position_violation).max() < 1e-14
