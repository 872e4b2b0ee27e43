"""omega h from far too small to far too large: what is unstable or unresolved is said, what is neither is not."""

import warnings

import numpy as np
import pytest

import energy_models
import zerodrift as zd
from support import INTEGRATORS, SYSTEMS, motion

OMEGA, STEPS = 10.0, 300
CARDS = zd.integrators()
EXPLICIT = [name for name in INTEGRATORS if CARDS[name].stability]


def oscillating(omega_h, integrator, damping=0.0, steps=STEPS):
    """A damped oscillator that declares no potential, and what was said of its motion."""
    system = zd.System(1, mass=[[1.0]], force=lambda p, v: -OMEGA**2 * p - 2 * damping * OMEGA * v, p0=[0.1])
    with np.errstate(all="ignore"):
        return listened(system, omega_h / OMEGA, steps, integrator)


def listened(system, h, steps, integrator, **options):
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        sol = zd.simulate(system, steps * h, step=h, integrator=integrator, on_failure="return", **options)
    return sol, [str(warning.message) for warning in said if warning.category in (zd.StabilityWarning, zd.AccuracyWarning)]


@pytest.mark.parametrize("omega_h", np.logspace(-3, 3, 25))
def test_the_oscillator_at_every_omega_h(integrator, omega_h):
    """Either its amplitude is right, or something is said: of the step, or of the energy; or of what it is late by."""
    sol, said = listened(zd.systems.oscillator(mass=1.0, stiffness=OMEGA**2), omega_h / OMEGA, STEPS, integrator)
    wrong = np.abs(np.hypot(sol.p[:, 0], sol.v[:, 0] / OMEGA) / 0.1 - 1).max()
    if not wrong < 3e-3:        # half of what the energy may be off by, and a little for what is not looked at
        assert said or not sol.success
    late = np.abs(sol.p[:, 0] / 0.1 - np.cos(OMEGA * sol.t)).max()
    if wrong < 2e-3 and omega_h < 1:
        assert sol.success
        assert not said or late > 0.05


def damped(t, damping):
    """The oscillation from 1, at rest; t in units of 1 / OMEGA."""
    if damping == 1:
        return (1 + t) * np.exp(-t)
    omega = np.sqrt(1 - damping**2)
    return np.exp(-damping * t) * (np.cos(omega * t) + damping / omega * np.sin(omega * t))


@pytest.mark.parametrize("damping", [0.1, 1.0])
def test_beyond_its_limit_each_explicit_method_grows_and_says_so(integrator, damping):
    if integrator not in EXPLICIT:
        pytest.skip("stable at any omega h")
    limit = CARDS[integrator].stability
    sol, said = oscillating(1.5 * max(limit, 3.4), integrator, damping, steps=40)
    assert sol.success
    assert "is stable for" in said[0]
    assert sol.stats["too_long"] > 0
    assert np.abs(sol.p[-1]) > 10 * np.abs(sol.p[0])
    sol, said = oscillating(0.5 * limit, integrator, damping)
    assert sol.success
    assert sol.stats["too_long"] == 0
    off = np.abs(sol.p[:, 0] - 0.1 * damped(OMEGA * sol.t, damping)).max()
    assert not said or off > 0.01       # a tenth of its amplitude: it is stable, but not resolved
    assert said or off < 0.05


@pytest.mark.parametrize("omega_h", [0.01, 0.3, 1.0, 3.0, 30.0])
def test_omega_h_is_what_it_is(integrator, omega_h):
    """The product omega h of a linear oscillation, to rounding, regardless of the method's error."""
    sol, _ = oscillating(omega_h, integrator, steps=20)
    assert abs(sol.stats["omega_h"] / omega_h - 1) < 1e-6


@pytest.mark.parametrize("omega_h", [3.0, 30.0, 1000.0])
def test_the_trapezoidal_rule_is_stable_where_it_resolves_nothing(omega_h):
    sol, said = oscillating(omega_h, "trapezoidal")
    assert sol.success
    assert np.abs(sol.p).max() <= 0.1 * (1 + 1e-9)
    assert "what moves so fast is stable, but wrong" in said[0]
    _, quiet = oscillating(0.1, "trapezoidal")
    assert not quiet


def stiff(omega):
    """A slow mass, and a light one that follows it by a hard spring and damper."""
    return zd.System(2, mass=np.eye(2), p0=[1.0, 1.0], parameters={"w": float(omega)},
                     force=lambda p, v, w: np.array([-p[0], w * w * (p[0] - p[1]) + 2 * w * (v[0] - v[1])]))


@pytest.mark.parametrize("method", ["dormand_prince", "dop853"])
def test_stiffness_is_noticed_by_adaptive_steps(method):
    with pytest.warns(zd.StabilityWarning, match=f"stiff for '{method}'"):
        held = zd.simulate(stiff(1e3), 3.0, rtol=1e-5, atol=1e-8, integrator=method)
    assert held.stats["stiff"] > 0
    free = zd.simulate(stiff(1.0), 3.0, rtol=1e-5, atol=1e-8, integrator=method)
    assert free.stats["stiff"] == 0
    assert held.stats["steps"] > 20 * free.stats["steps"]


def test_a_stiff_spring_in_a_mechanism():
    """The slider-crank with a spring a million times harder: the same words."""
    hard = energy_models.slider_crank(stiffness=1e6, rest_length=1.2)
    sol, said = listened(hard, 0.02, 100, "rk4")
    assert said or not sol.success
    fine, said = listened(hard, 1e-4, 100, "rk4")
    assert fine.success
    assert not said


def test_what_blows_up_is_reported_why():
    with pytest.raises(zd.Diverged, match=r"too long for 'rk4' to be stable \(omega h = 10, stable below 2\.7\d\)"):
        zd.simulate(zd.systems.oscillator(stiffness=1e6), 10.0, step=0.01)


def test_energy_that_is_numerical_is_said():
    with pytest.warns(zd.AccuracyWarning, match=r"^the energy balance is off by 1\.2 of the largest kinetic energy: some steps"):
        motion(SYSTEMS["oscillator"], 50.0, 1000, integrator="euler")


def whole_turns(energy, step):
    """The paper's four-bar over its 8 s: by how many turns it is wrong, and whether that is said."""
    bar = zd.systems.four_bar()
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        sol = zd.simulate(bar, 8.0, step=step, energy=energy)
    exact = zd.simulate(bar, 8.0, rtol=1e-10, atol=1e-10, integrator="dop853", t_eval=sol.t)
    return np.abs(sol.p - exact.p).max() / (2 * np.pi), any(warning.category is zd.AccuracyWarning for warning in said)


@pytest.mark.parametrize("energy", [None, True])
def test_turns_that_are_lost_are_said(energy):
    for step in (0.002, 0.005, 0.01, 0.02, 0.032, 0.04, 0.05, 0.08, 0.1):
        turns, said = whole_turns(energy, step)
        assert said or turns < 0.5
        assert turns > 0.005 or not said, f"{turns:g} turns with steps of {step:g} s"


@pytest.mark.parametrize(("hardness", "damping", "method"), [(1e6, 0.0, "rk4"), (1e6, 0.0, "heun"), (1e4, 1e4, "heun")])
def test_corrections_that_an_unstable_step_makes_fail_name_it(formulation, hardness, damping, method):
    """A pendulum in Cartesian coordinates, to which a mass is tied too hard for the step."""
    def force(p, v):
        pull = hardness * (p[2] - p[0]) + damping * (v[2] - v[0])
        return np.array([pull, -9.81, -pull])

    system = zd.System(3, mass=np.eye(3), p0=[1.0, 0.0, 1.1], force=force,
                       constraints=lambda p: np.array([p[0]**2 + p[1]**2 - 1]) / 2)
    expected = f"the step is too long for {method!r} to be stable .omega h = "
    with pytest.raises((zd.CorrectionFailed, zd.StepFailed), match=expected):
        zd.simulate(system, 1.0, step=0.01, integrator=method, formulation=formulation)
    assert zd.simulate(system, 0.004, step=2e-5, integrator=method, formulation=formulation).success


def test_a_step_that_is_stable_is_not_called_unstable(bar):
    with pytest.raises(zd.CorrectionFailed) as failed:
        zd.simulate(bar, 8.0, step=0.2, stabilization=zd.Projection(max_iterations=1, tol=1e-14))
    assert "stable" not in str(failed.value)


@pytest.mark.parametrize("method", ["dormand_prince", "dop853"])
@pytest.mark.parametrize("step", [None, 0.01])
def test_rows_at_turning_points_say_nothing_of_the_kinetic_energy(method, step):
    """Half a turn apart there is none: "off by 7.2e+10 of the largest kinetic energy" was said of adaptive steps."""
    oscillator = zd.systems.oscillator(mass=1.0, stiffness=OMEGA**2)
    control = {"rtol": 1e-6, "atol": 1e-9} if step is None else {"step": step}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sol = zd.simulate(oscillator, 20 * np.pi / OMEGA, t_eval=np.arange(21) * np.pi / OMEGA, integrator=method, **control)
    total = sol.potential_energy[0]
    assert sol.kinetic_energy.max() < 1e-3 * total
    assert 0.5 * total < sol.stats["largest_kinetic"] < 1.01 * total


def test_where_nothing_moves_nothing_is_divided_by_its_energy():
    """A potential that changes in time, whose power is left out: the balance is off, of nothing."""
    system = zd.System(["x"], mass=[[1.0]], potential=lambda t: 2.0 * t, p0=[0.0])
    with pytest.warns(zd.AccuracyWarning, match=r"^the energy balance is off by 4 J, and nothing was seen to move: "):
        zd.simulate(system, 2.0, step=0.1)


@pytest.mark.parametrize(("potential", "force"), [(lambda p: p[0]**2 / 2, lambda p, v: -p - 0.2 * v),
                                                  (lambda p: -p[0]**2 / 2, lambda p: -p)],
                         ids=["a damper without power", "a potential of the wrong sign"])
def test_energy_that_is_not_that_of_the_forces_is_a_cause_of_systems_with_their_own(potential, force):
    """No tolerance removes the error of the balance; `check`, which the warning names, does find its cause."""
    system = zd.System(["x"], mass=[[1.0]], force=force, potential=potential, p0=[1.0], v0=[0.0])
    with pytest.warns(zd.AccuracyWarning, match=r"; or potential and power are not those of the forces: zd\.check\(system\)"):
        zd.simulate(system, 5.0, rtol=1e-10)
    assert "balance of power" in str(zd.check(system)).partition("\n")[2]


def test_energy_that_is_derived_is_not_a_cause():
    _, said = listened(SYSTEMS["oscillator"], 0.05, 1000, "euler")
    assert any("energy balance" in each for each in said)
    assert not any("zd.check" in each for each in said)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_motion_prescribed_throughout_is_exact_at_any_step(dimension):
    """The energy balance is off by the quadrature of the motor's work alone; without corrections the motion is, too."""
    more, axis = (0.0,) * (dimension - 2), {"axis": (0, 0, 1)} if dimension == 3 else {}
    m = zd.Mechanism("driven arms", dimension=dimension, gravity=(0, -9.81, 0)[:dimension])
    crank, rod = (m.link(name, (*a, *more), (*b, *more), mass=1.0) for name, a, b in
                  (("crank", (0, 0), (0.0, 0.5)), ("rod", (0.0, 0.5), (1.2, 0.0))))
    m.revolute("A", m.ground, crank.start, **axis)
    m.revolute("B", crank.end, rod.start, **axis)
    m.motor("drive", "A", speed=2 * np.pi)
    m.motor("second", "B", speed=-3 * np.pi)
    sol, said = listened(m, 0.1, 10, "heun")
    assert not said
    assert np.abs(sol["A.angle"] - sol["A.angle"][0] - 2 * np.pi * sol.t).max() < 1e-9
    assert np.abs(sol.energy_violation).max() > 0.005 * sol.kinetic_energy.max()
    assert listened(m, 0.1, 10, "heun", stabilization=None)[1]


@pytest.mark.parametrize("dimension", [2, 3])
def test_nothing_is_said_of_what_rests_to_rounding(dimension):
    """Springs at their natural length, on which nothing acts: adaptive steps let roundings grow up to the tolerance."""
    place = (0.3, 0.4, 0.1)[:dimension]
    for stiffness in (1e2, 1e4, 1e6):
        m = zd.Mechanism("at rest", dimension=dimension)
        link = m.link("link", (0.1, 0.2, 0)[:dimension], place, mass=0.7)
        m.revolute("pin", m.ground, link.start, **({"axis": (0, 0, 1)} if dimension == 3 else {}))
        m.spring("spring", link.end, m.ground.point((1.1, 0.7, 0.3)[:dimension]), stiffness=stiffness)
        for layout in ("joint", "absolute"):
            with warnings.catch_warnings():
                warnings.simplefilter("error", zd.AccuracyWarning)
                sol = zd.simulate(m.system(layout), 1.0)
            assert np.abs(sol.p - sol.p[0]).max() < 1e-7
