"""Andrews' mechanism, from bodies and joints and from its energies, against the reference of the test set for initial values."""

import numpy as np
import pytest

import energy_models
import known_motions
import zerodrift as zd
from reference_files import definition, end, falls_at_order_four, number, table
from support import assert_close, refused


def andrews_end(prefix, t="03"):
    return number([definition("A03_andrews")[f"reference_t0_{t}"][f"{prefix}{i}"] for i in range(1, 8 if prefix != "lam" else 7)])


def test_andrews_starts_as_the_reference_does():
    given, system = definition("A03_andrews"), energy_models.andrews()
    assert_close(system.p0, number(given["initial_q"]), 1e-15)
    for name, value in given["parameters"].items():
        assert system.parameters.get(name, system.parameters.get(name.upper())) == float(value), name
    vdot, multipliers = zd.acceleration(system, system.p0, np.zeros(7))
    assert_close(vdot, number(given["initial_acc_check"]), 1e-12)
    assert_close(multipliers, number(given["initial_lambda_check"]), 1e-12)


def test_andrews_against_the_reference(formulation):
    steps = (1e-4, 5e-5, 2.5e-5, 5e-6)
    runs = [end(energy_models.andrews(), 0.03, step, formulation=formulation) for step in steps]
    falls_at_order_four(steps, [np.abs(run.p[-1] - andrews_end("q")).max() for run in runs])
    for run in runs:
        assert np.abs(run.position_violation).max() <= 1e-12


def test_andrews_to_the_last_digits(formulation):
    sol = zd.simulate(energy_models.andrews(), 0.03, step=1e-5, integrator="dop853", formulation=formulation)
    assert np.abs(sol.p[-1] - andrews_end("q")).max() < 1e-10      # the condition set; 1e-12 is reached
    assert_close(sol.v[-1], andrews_end("v"), 1e-11)
    assert_close(sol.multipliers[-1], andrews_end("lam"), 1e-10)
    assert_close(zd.acceleration(sol.system, sol.p[-1], sol.v[-1])[0], andrews_end("a"), 1e-10)
    assert np.abs(sol.position_violation).max() <= 1e-12
    assert np.abs(sol.velocity_violation).max() <= 1e-12
    assert np.abs(sol.energy_violation).max() <= 1e-12 * sol.energy_input[-1]


def test_andrews_along_the_way():
    reference = table("A03_andrews")
    sol = zd.simulate(energy_models.andrews(), reference["t"][-1], rtol=1e-12, atol=1e-12, integrator="dop853",
                      t_eval=reference["t"])
    names = ("beta", "theta", "gamma", "phi", "delta", "omega", "eps")
    assert np.abs(sol.p - np.stack([reference[name] for name in names], axis=1)).max() < 1e-9
    assert_close(sol.v, np.stack([reference[f"{name}_d"] for name in names], axis=1), 1e-9)


def test_links_of_andrews_keep_their_lengths():
    system = energy_models.andrews()
    sol = zd.simulate(system, 0.03, step=1e-4)
    q = system.parameters
    lengths = [q["rr"], q["d"], q["e"], q["zt"], q["u"], q["zf"], q["ss"]]
    for p in sol.p[::30]:
        assert_close(np.linalg.norm(np.diff(system.points(p)[:8], axis=0), axis=1), np.array(lengths), 1e-10)


def test_bodies_and_joints_along_the_way():
    """Their angles are sums of the literature's; the force that the spring pulls with is that of its length."""
    reference = table("A03_andrews")
    sol = zd.simulate(zd.models.andrews(), reference["t"][-1], rtol=1e-12, atol=1e-12, integrator="dop853", t_eval=reference["t"])
    assert known_motions.andrews(sol) < 1e-9
    assert_close(sol["K1.angular_velocity"], reference["beta_d"], 1e-9)
    assert np.abs(sol.energy_violation).max() <= 1e-11 * sol.energy_input[-1]


def test_parameters_of_bodies_and_joints():
    system = zd.models.andrews(mom=0.05, m3=0.03).system()
    assert system.parameters["K3.mass"] == 0.03
    with refused("unknown-choice", "parameter.*'moment'.*mom"):
        zd.models.andrews(moment=1.0)
    with refused("wrong-type", "'mom'.*'much'"):
        zd.models.andrews(mom="much")


def test_parameters_of_andrews():
    assert energy_models.andrews(mom=0.05).parameters["mom"] == 0.05
    with refused("unknown-choice", "parameter.*'moment'.*mom"):
        energy_models.andrews(moment=1.0)


def test_samples_within_steps_that_are_far_too_long():
    """Samples need a series of their own where variables change within a step: the former one ended the process."""
    with pytest.raises(zd.CorrectionFailed):
        zd.simulate(energy_models.andrews(), 0.03, step=0.03 / 16, t_eval=np.linspace(0, 0.03, 400), integrator="taylor",
                    formulation="independent")
