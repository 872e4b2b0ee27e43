"""Mechanisms that are known from elsewhere, against what is known of them."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import zerodrift as zd
from mechanisms import known
from reference_files import definition, number

LAYOUTS = ("joint", "absolute")


@pytest.mark.parametrize("layout", LAYOUTS)
def test_the_papers_four_bar_moves_as_the_one_built_in(layout, formulation):
    """To 1e-8 rad after a second in which both are off by less than 1e-9."""
    sol = zd.simulate(known.four_bar().system(layout), 1.0, step=1e-3, formulation=formulation)
    built_in = zd.simulate(zd.systems.four_bar(), 1.0, step=1e-3, formulation=formulation)
    ours = np.stack([sol[f"{name}.angle"] for name in ("crank", "coupler", "rocker")], axis=1)
    np.testing.assert_allclose(ours, built_in.p, atol=1e-8)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_the_multipliers_of_the_papers_four_bar_are_the_force_in_its_pin(layout):
    """The paper's rows close the loop at D: what the rocker exerts on the ground there is its multipliers."""
    sol = zd.simulate(known.four_bar().system(layout), 0.5, step=1e-3)
    built_in = zd.simulate(zd.systems.four_bar(), 0.5, step=1e-3)
    size = np.abs(built_in.multipliers).max()
    assert min(np.abs(sol["D.force"] - sign * built_in.multipliers).max() for sign in (1, -1)) < 1e-8 * size
    assert sol.unique("D.force").all()


@pytest.mark.parametrize("layout", LAYOUTS)
def test_andrews_mechanism_to_the_literatures_digits(layout):
    sol = zd.simulate(known.andrews().system(layout), 0.03, step=2e-5, integrator="dop853")
    beta, K2, gamma, K4, delta, K6, epsilon = (sol[f"K{i}.angle"][-1] for i in (1, 2, 3, 4, 5, 6, 7))
    told = np.array([beta, K2 - beta, gamma, K4 - delta, delta, K6 - epsilon, epsilon])
    reference = definition("A03_andrews")["reference_t0_03"]
    published = number([reference[f"q{i}"] for i in range(1, 8)])
    np.testing.assert_allclose(told, published, rtol=0, atol=1e-9)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_jansens_leg_closes_from_its_sketch(layout):
    system = known.jansen().system(layout)
    assert np.abs(system.evaluate().Phi).max() < 1e-13
    sol = zd.simulate(system, 0.2, step=1e-3)
    np.testing.assert_allclose(sol["ZX.angle"], -6.0 * sol.t, atol=1e-12)


def test_jansens_leg_is_on_the_branch_of_its_sketch():
    """Every triangle of joints goes round the same way as in the sketch."""
    sol = zd.simulate(known.jansen(), 0.001, step=0.001)
    placed = {"Y": known.JANSEN["Y"], "X": known.JANSEN["X"]}
    placed |= {end[-1]: 100 * sol[f"{end}.end.position"][0] for end in ("XV", "XU", "YW", "WT", "TF")}
    for corners in ("XVY", "XUY", "YVW", "WTU", "TUF"):
        areas = []
        for places in (known.JANSEN, placed):
            a, b, c = (np.array(places[corner], dtype=float) for corner in corners)
            areas.append(np.linalg.det([b - a, c - a]))
        assert areas[0] * areas[1] > 0, corners


@pytest.mark.parametrize("layout", LAYOUTS)
def test_peaucelliers_path_is_straight(layout):
    sol = zd.simulate(known.peaucellier().system(layout), 0.3, step=1e-3)
    P = sol["PS.start.position"]
    assert np.ptp(P[:, 1]) > 0.05
    assert np.ptp(P[:, 0]) < 1e-13


@pytest.mark.parametrize(("n", "layout"), [(1, "joint"), (3, "joint"), (3, "absolute")])
def test_parallelograms_in_a_row_against_their_pendulum(n, layout):
    """N bars that stay level and N + 1 cranks at one angle: J angle'' = -g cos(angle) ((N + 1) / 2 + N), J = (N + 1) / 3 + N."""
    inertia, weight = (n + 1) / 3 + n, 9.81 * ((n + 1) / 2 + n)
    sol = zd.simulate(known.four_bars(n).system(layout), 0.6, step=1e-3)
    exact = solve_ivp(lambda t, y: [y[1], -weight / inertia * np.cos(y[0])], (0, 0.6), [np.pi / 2, -1.0], method="DOP853",
                      rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose([sol[f"crank{i}.angle"][-1] for i in range(n + 1)], exact.y[0, -1], atol=1e-9)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_driven_slider_crank_against_its_closed_form(layout):
    """Position, velocity of the piston, and the drive's torque by the balance of power."""
    sol = zd.simulate(known.slider_crank().system(layout), 0.25, step=1e-3, formulation="augmented")
    a, r, length, w = 30.0 * sol.t, 0.1, 0.3, 30.0
    root = np.sqrt(length**2 - (r * np.sin(a))**2)
    x = r * np.cos(a) + root
    speed = w * (-r * np.sin(a) - r**2 * np.sin(a) * np.cos(a) / root)
    np.testing.assert_allclose(sol["slide.displacement"], x - 0.4, atol=1e-12)
    np.testing.assert_allclose(sol["slide.speed"], speed, atol=1e-10)
    energy = sol.kinetic_energy + 0.5 * 2e3 * ((0.7 - x) - 0.25)**2
    gas, damper = -50.0 * np.exp(-20 * (x - 0.4)) * speed, -5.0 * speed**2
    power = np.gradient(energy, sol.t, edge_order=2) - gas - damper
    assert np.abs(power - sol["drive.power"])[2:-2].max() < 2e-3 * np.abs(power).max()     # differences over a step of 1 ms
    np.testing.assert_allclose(sol["drive.power"], sol["drive.torque"] * w, rtol=1e-12)
    assert np.abs(sol["slide.force"][:, 0]).max() < 1e-9 * np.abs(sol["slide.force"]).max()
    np.testing.assert_allclose(sol["spring.force"], 2e3 * ((0.7 - x) - 0.25) - 5.0 * speed, atol=1e-7)
