"""The exact motion of the four-bar: by another method, against the core's equations, and the core against it."""

import numpy as np
import pytest

import zerodrift as zd
from support import refused
from zerodrift.paper import FOUR_BAR, FOUR_BAR_REFERENCE, OSCILLATOR, reference
from zerodrift.studies.compare import difference

ANGLES = np.linspace(0, 2 * np.pi, 13)
STORED = 1e-8       # rad, rad/s: DOP853 at its least tolerance has some 2e-10, grown by the motion; libraries differ


def extrapolated(rates, y, span, levels=8):
    """A step of Gragg's method, extrapolated: another way of integration, of order 2 levels."""
    counts, table = [2 * (k + 1) for k in range(levels)], []
    for k, n in enumerate(counts):
        h, before, y_now = span / n, y, y + span / n * np.array(rates(0, y))
        for _ in range(n - 1):
            before, y_now = y_now, before + 2 * h * np.array(rates(0, y_now))
        row = [(before + y_now + h * np.array(rates(0, y_now))) / 2]
        for j in range(k):
            row.append(row[j] + (row[j] - table[k - 1][j]) / ((n / counts[k - 1 - j]) ** 2 - 1))
        table.append(row)
    return table[-1][-1]


def equation_of(bar):
    given = bar.parameters
    side = 1 if given["assembly"] == "open" else -1
    return reference.CrankEquation(given["lengths"], given["masses"], given["gravity"], side)


def test_the_stored_states_are_what_the_function_computes():
    pytest.importorskip("scipy")
    np.testing.assert_allclose(reference.four_bar_states(), reference.stored(), rtol=0, atol=STORED)


def test_the_file_is_what_the_script_writes(tmp_path, monkeypatch):
    monkeypatch.setattr(reference, "four_bar_states", reference.stored)
    reference.write(tmp_path / "again.csv")
    assert (tmp_path / "again.csv").read_bytes() == reference.FILE.read_bytes()


def test_another_method_gives_the_same_motion():
    rates, y = reference.equation().rates, reference.stored()[0]
    for exact in reference.stored()[1:]:
        for _ in range(2):
            y = extrapolated(rates, y, reference.SPACING / 2)
        np.testing.assert_allclose(y, exact, rtol=0, atol=STORED)


def test_energy_is_conserved():
    energies = [sum(reference.four_bar_energies(t)) for t in reference.four_bar_times()]
    assert np.ptp(energies) < 1e-9


@pytest.mark.parametrize("angle", ANGLES)
def test_derivatives_are_derivatives(angle):
    equation, h = reference.equation(), 1e-6
    inertia, potential = equation.inertia(angle), equation.potential(angle)
    for (_, derivative), function, factor in ((inertia, equation.inertia, 2), (potential, equation.potential, 1)):
        numerical = (function(angle + h)[0] - function(angle - h)[0]) / (2 * h)
        assert factor * derivative == pytest.approx(numerical, abs=1e-6)


@pytest.mark.parametrize("side", ["open", "crossed"])
@pytest.mark.parametrize("angle", ANGLES)
def test_one_degree_of_freedom_and_the_core_have_the_same_acceleration(angle, side):
    bar = zd.systems.four_bar(crank_angle=float(angle), crank_rate=2.0, assembly=side)
    equation = equation_of(bar)
    vdot, _ = zd.acceleration(bar, bar.p0, bar.v0)
    assert equation.rates(0, (angle, 2.0))[1] == pytest.approx(vdot[0], rel=1e-11, abs=1e-10)


@pytest.mark.parametrize("side", ["open", "crossed"])
@pytest.mark.parametrize("energy", [None, True])
def test_projected_solutions_converge_to_it_with_the_order_of_the_method(side, energy):
    """In half a turn, before the passage over the top, which makes errors grow by orders of magnitude."""
    pytest.importorskip("scipy")
    bar = zd.systems.four_bar(assembly=side)
    given, times = bar.parameters, np.arange(21) * 0.025
    exact = equation_of(bar).integrate(times, [given["crank_angle"], given["crank_rate"]])[:, 0]
    errors = []
    for step in (0.0125, 0.00625, 0.003125):
        sol = zd.simulate(bar, 0.5, step=step, energy=energy, save_every=round(0.025 / step))
        errors.append(np.abs(sol.p[:, 0] - exact).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(orders, zd.integrators()["rk4"].order, atol=0.15)


def test_both_corrections_converge_to_it_over_the_whole_time():
    errors = []
    for step in (0.0125, 0.00625, 0.003125):
        sol = zd.simulate(FOUR_BAR.system, FOUR_BAR.end, step=step, energy=True, save_every=round(0.025 / step))
        errors.append(np.abs(difference(sol, reference.four_bar, "alpha1")).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(orders, zd.integrators()["rk4"].order, atol=0.15)


def test_the_papers_reference_is_close_to_it():
    fine = zd.simulate(FOUR_BAR.system, FOUR_BAR.end, save_every=50, **FOUR_BAR_REFERENCE)
    assert np.abs(difference(fine, reference.four_bar)).max() < 1e-6


@pytest.mark.parametrize("t", [-0.025, 8.025, 0.01])
def test_only_stored_times_are_answered(t):
    with refused("out-of-range", r"^t must.*of 0\.025.*between 0.*and 8"):
        reference.four_bar(t)


def test_the_oscillator_satisfies_its_equation():
    system, h = OSCILLATOR.system, 1e-4
    for t in (0.3, 1.7):
        x, before, after = (reference.oscillator(t + dt)[0] for dt in (0, -h, h))
        acceleration = (after - 2 * x + before) / h**2
        assert acceleration == pytest.approx(-system.parameters["stiffness"] * x / system.parameters["mass"], abs=1e-6)
        T, V = reference.oscillator_energies(t)
        np.testing.assert_allclose(T + V, 0.05, rtol=1e-14)
        np.testing.assert_allclose(T, ((after - before) / (2 * h)) ** 2 / 2, atol=1e-7)
