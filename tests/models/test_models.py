"""`zd.models`: derived from energies, and compared with what was not: reference files, built-in systems, equations by hand."""

import itertools
import pickle
import subprocess
import sys

import numpy as np
import pytest
import scipy.integrate

import zerodrift as zd
from support import assert_close
from test_references import definition, end, falls_at_order_four, number, table

MODELS = {"andrews": zd.models.andrews, "bicycle": zd.models.bicycle, "slider_crank": zd.models.slider_crank,
          "closed_pendulum": zd.models.closed_pendulum, "closed_pendulum of 7": lambda: zd.models.closed_pendulum(7)}


@pytest.fixture(params=MODELS)
def model(request):
    return MODELS[request.param]()


# ---- all of them ----


def test_check(model):
    report = zd.check(model)
    assert report, report


def test_drawing(model):
    points = model.points(model.p0)
    assert points.ndim == 2
    assert points.shape[1] == 2
    assert np.isfinite(points).all()


def test_pickling(model):
    again = pickle.loads(pickle.dumps(model))
    ends = [zd.simulate(system, 0.01, step=1e-4).p[-1] for system in (model, again)]
    assert np.array_equal(*ends)


def test_every_model_is_tried():
    assert set(zd.models.__all__) <= set(MODELS)


def test_without_sympy():
    """What is needed is said, and only when it is needed."""
    code = ("import sys; sys.modules['sympy'] = None\nimport zerodrift as zd\n"
            "try:\n    zd.models.andrews\nexcept ImportError as error:\n    print(error)")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "pip install 'zerodrift[symbolic]'" in done.stdout


# ---- Andrews' mechanism ----


def andrews_end(prefix, t="03"):
    return number([definition("A03_andrews")[f"reference_t0_{t}"][f"{prefix}{i}"] for i in range(1, 8 if prefix != "lam" else 7)])


def test_andrews_starts_as_the_reference_does():
    given, system = definition("A03_andrews"), zd.models.andrews()
    assert_close(system.p0, number(given["initial_q"]), 1e-15)
    for name, value in given["parameters"].items():
        assert system.parameters.get(name, system.parameters.get(name.upper())) == float(value), name
    vdot, multipliers = zd.acceleration(system, system.p0, np.zeros(7))
    assert_close(vdot, number(given["initial_acc_check"]), 1e-12)
    assert_close(multipliers, number(given["initial_lambda_check"]), 1e-12)


def test_andrews_against_the_reference(formulation):
    steps = (1e-4, 5e-5, 2.5e-5, 5e-6)
    runs = [end(zd.models.andrews(), 0.03, step, formulation=formulation) for step in steps]
    falls_at_order_four(steps, [np.abs(run.p[-1] - andrews_end("q")).max() for run in runs])
    for run in runs:
        assert np.abs(run.position_violation).max() <= 1e-12


def test_andrews_to_the_last_digits(formulation):
    sol = zd.simulate(zd.models.andrews(), 0.03, step=1e-5, integrator="dop853", formulation=formulation)
    assert np.abs(sol.p[-1] - andrews_end("q")).max() < 1e-10      # the condition set; 1e-12 is reached
    assert_close(sol.v[-1], andrews_end("v"), 1e-11)
    assert_close(sol.multipliers[-1], andrews_end("lam"), 1e-10)
    assert_close(zd.acceleration(sol.system, sol.p[-1], sol.v[-1])[0], andrews_end("a"), 1e-10)
    assert np.abs(sol.position_violation).max() <= 1e-12
    assert np.abs(sol.velocity_violation).max() <= 1e-12
    assert np.abs(sol.energy_violation).max() <= 1e-12 * sol.energy_input[-1]


def test_andrews_along_the_way():
    reference = table("A03_andrews")
    sol = zd.simulate(zd.models.andrews(), reference["t"][-1], rtol=1e-12, atol=1e-12, integrator="dop853", t_eval=reference["t"])
    names = ("beta", "theta", "gamma", "phi", "delta", "omega", "eps")
    assert np.abs(sol.p - np.stack([reference[name] for name in names], axis=1)).max() < 1e-9
    assert_close(sol.v, np.stack([reference[f"{name}_d"] for name in names], axis=1), 1e-9)


def test_links_of_andrews_keep_their_lengths():
    system = zd.models.andrews()
    sol = zd.simulate(system, 0.03, step=1e-4)
    q = system.parameters
    lengths = [q["rr"], q["d"], q["e"], q["zt"], q["u"], q["zf"], q["ss"]]
    for p in sol.p[::30]:
        assert_close(np.linalg.norm(np.diff(system.points(p)[:8], axis=0), axis=1), np.array(lengths), 1e-10)


def test_parameters_of_andrews():
    assert zd.models.andrews(mom=0.05).parameters["mom"] == 0.05
    with pytest.raises(ValueError, match=r"parameter must be one of 'm1', .*, not 'moment'"):
        zd.models.andrews(moment=1.0)


# ---- closed pendulum ----

LINKS = (4, 5, 6, 8, 10)


@pytest.mark.parametrize("links", [3, *LINKS])
def test_closed_pendulum_against_equations_by_hand(links):
    """Slender links: M_ij = m L^2 (n - max(i, j) - 1/2) cos(theta_i - theta_j), and n - i - 2/3 where i = j, from i = 0."""
    system = zd.models.closed_pendulum(links, length=0.7, mass=1.3)
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
    mine = zd.models.closed_pendulum(3)
    bar = zd.systems.four_bar(lengths=[2.0, 1.0, 1.0, 1.0], masses=[1.0, 1.0, 1.0], crank_angle=mine.p0[0])
    sols = [zd.simulate(system, 2.0, mine.p0, np.zeros(3), step=1e-3) for system in (mine, bar)]
    assert_close(sols[0].p, sols[1].p, 1e-10)
    assert_close(sols[0].kinetic_energy, sols[1].kinetic_energy, 1e-9)


@pytest.mark.parametrize("links", LINKS)
def test_closed_pendulum_for_a_hundred_seconds(links):
    """The motion is chaotic and not to be had twice; the constraints hold, and the energy stays."""
    sol = zd.simulate(zd.models.closed_pendulum(links), 100.0, step=0.002)
    assert sol.t[-1] == 100.0
    assert np.abs(sol.position_violation).max() <= 1e-12
    assert np.abs(sol.velocity_violation).max() <= 1e-12
    assert np.abs(sol.energy_violation).max() < 2e-3 * sol.kinetic_energy.max()
    assert sol.kinetic_energy[-5000:].max() > 0.5 * sol.kinetic_energy.max()      # and it moves to the end


@pytest.mark.parametrize("links", LINKS)
def test_energy_of_the_closed_pendulum_falls_at_the_order_of_the_method(links, formulation):
    system = zd.models.closed_pendulum(links)
    errors = [np.abs(zd.simulate(system, 2.0, step=step, formulation=formulation).energy_violation).max()
              for step in (0.001, 0.0005, 0.00025)]
    orders = [np.log2(coarse / fine) for coarse, fine in itertools.pairwise(errors)]
    assert orders[-1] > 3.7, errors


@pytest.mark.parametrize("links", [4, 5, 8, 12, 30])
def test_start_of_the_closed_pendulum(links):
    """An arch, of which no link has wound up, and from which a run can start."""
    system = zd.models.closed_pendulum(links)
    assert (np.diff(system.p0) < 0).all()
    assert np.abs(system.p0).max() < 2.5
    assert zd.simulate(system, 0.01, step=0.005).success
    joints = system.points(system.p0)
    assert_close(joints[0], np.zeros(2), 1e-15)
    assert_close(joints[-1], np.array([system.parameters["span"], 0.0]), 1e-11)
    assert (joints[1:-1, 1] > 0).all()
    assert (system.parameters["span"] - links) % 2 == 1     # the links cannot line up


@pytest.mark.parametrize(("wrong", "error", "message"), [
    ({"links": 2}, ValueError, "links must be between 3 and"),
    ({"links": 2.5}, TypeError, r"links must be a whole number, not 2\.5"),
    ({"links": 4, "span": 4.0}, ValueError, r"span must be less than 4 links of 1 m together, 4 m, not 4"),
    ({"length": 0.0}, ValueError, "length must be greater than 0"),
    ({"mass": "1"}, TypeError, "parameter 'mass' must be a real number, not '1'"),
])
def test_wrong_closed_pendulums(wrong, error, message):
    with pytest.raises(error, match=message):
        zd.models.closed_pendulum(**wrong)


# ---- slider-crank ----


def test_slider_crank_is_the_built_in_one(formulation):
    """Which loses energy as the reference file says."""
    mine, built_in = zd.models.slider_crank(), zd.systems.slider_crank()
    assert_close(mine.p0, built_in.p0, 1e-15)
    sols = [zd.simulate(system, 10.0, step=0.0025, save_every=100, formulation=formulation) for system in (mine, built_in)]
    assert_close(sols[0].p, sols[1].p, 1e-10)
    assert_close(sols[0].energy_input, sols[1].energy_input, 1e-10)
    reference = table("sundials_slider_crank")
    assert_close(sols[0].p, np.stack([reference[name] for name in ("q", "x", "p")], axis=1), 1e-9)


def test_a_slider_crank_that_cannot_turn():
    with pytest.raises(ValueError, match=r"rod must be longer than the crank of 0\.5 m, not 0\.4"):
        zd.models.slider_crank(rod=0.4)


# ---- bicycle ----


def bicycle_by_hand(system, t_eval):
    """Its motion by two equations of balance for the speed u along the frame and the rate of steer, with yaw' = u tan(steer) / w.

    For u: (m + m_f) u' + (m b^2 + J + m_f w^2) k yaw'' + J_f k (yaw'' + steer'') = F, with k = tan(steer) / w.
    For steer: J_f (yaw'' + steer'') = torque.
    """
    q = system.parameters

    def rate(t, y):
        _, _, yaw, steer, u, steer_rate = y
        k, slope = np.tan(steer) / q["wheelbase"], 1 / (np.cos(steer)**2 * q["wheelbase"])
        torque = -q["stiffness"] * (steer - q["amplitude"] * np.sin(q["frequency"] * t)) - q["damping"] * steer_rate
        turning = q["mass"] * q["centre"]**2 + q["inertia"] + q["fork_mass"] * q["wheelbase"]**2
        along = q["mass"] + q["fork_mass"] + turning * k**2
        u_rate = (q["thrust"] - turning * k * u * slope * steer_rate - k * torque) / along
        yaw_rate_rate = u_rate * k + u * slope * steer_rate
        return [u * np.cos(yaw), u * np.sin(yaw), u * k, steer_rate, u_rate, torque / q["fork_inertia"] - yaw_rate_rate]

    start = [*system.p0, system.v0[0], 0.0]
    return scipy.integrate.solve_ivp(rate, (0, t_eval[-1]), start, method="DOP853", rtol=1e-12, atol=1e-12, t_eval=t_eval).y.T


@pytest.mark.parametrize("given", [{}, {"thrust": 60.0, "damping": 0.0, "frequency": 4.0, "speed": 2.0}], ids=str)
def test_bicycle_against_equations_by_hand(given, formulation):
    system = zd.models.bicycle(**given)
    sol = zd.simulate(system, 10.0, step=0.0025, save_every=100, formulation=formulation)
    expected = bicycle_by_hand(system, sol.t)
    assert_close(sol.p, expected[:, :4], 1e-8)
    assert_close(np.hypot(*sol.v[:, :2].T), expected[:, 4], 1e-8)
    assert np.abs(sol.velocity_violation).max() <= 1e-12
    assert np.abs(sol.energy_violation).max() < 1e-7 * sol.kinetic_energy.max()


def test_a_bicycle_whose_handlebar_is_let_go_keeps_its_energy():
    system = zd.models.bicycle(amplitude=0.0, damping=0.0)
    sol = zd.simulate(system, 10.0, [0.0, 0.0, 0.0, 0.3], [3.0, 0.0, 3.0 * np.tan(0.3) / 1.1, 0.0], step=0.002)
    total = sol.kinetic_energy + sol.potential_energy
    assert_close(total, np.full(len(total), total[0]), 1e-7)
    assert np.ptp(sol.potential_energy) > 0.1
