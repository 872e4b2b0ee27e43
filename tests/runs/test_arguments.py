"""Settings, systems and starts that the core refuses, whoever calls it, instead of crashing or never ending."""

import numpy as np
import pytest

import zerodrift as zd
from support import handed
from zerodrift._private import gateway
from zerodrift._private.core import ffi


def created(options, core=None):
    pendulum = zd.systems.pendulum()
    gateway.Run(core or pendulum._core, options, pendulum.p0, pendulum.v0)


def between(core, options, p, v):
    t = np.array([options.t0, options.t1])
    return gateway.states_between(core, options, t, np.vstack([p, p]), np.vstack([v, v]), None, False, np.array([t.mean()]))


ADAPTIVE = gateway.ADAPTIVE_STEPS
DOP853 = list(zd.integrators()).index("dop853")


@pytest.mark.parametrize(("changed", "sentence"), [
    ({"formulation": -1}, "there is no such formulation"),
    ({"integrator": 99}, "there is no such integrator"),
    ({"t1": 0.0}, "t1 must be after t0"),
    ({"t1": np.nan}, "t1 must be after t0"),
    ({"t0": -1e308, "t1": 1e308}, "t1 must be after t0"),
    ({"step": -0.1}, "step must be finite"),
    ({"step": np.inf}, "step must be finite"),
    ({"step": np.nan}, "step must be finite"),
    ({"t0": 1e9, "t1": 2e9, "step": 1e-9}, "at least 16 times the rounding error of the time"),
    ({"step": 0.0}, "step must be finite"),
    ({"steps": 2}, "steps must be fixed or adaptive"),
    ({"steps": ADAPTIVE}, "this integrator must be given a step"),
    ({"steps": ADAPTIVE, "integrator": DOP853, "atol": 0.0}, "rtol and atol"),
    ({"steps": ADAPTIVE, "integrator": DOP853, "rtol": np.nan}, "rtol and atol"),
    ({"steps": ADAPTIVE, "integrator": DOP853, "rtol": 2.0, "atol": 1e-9}, "rtol at most 1"),
    ({"steps": ADAPTIVE, "integrator": DOP853, "first_step": -1.0}, "first_step and max_step"),
    ({"steps": ADAPTIVE, "integrator": DOP853, "max_step": np.nan}, "first_step and max_step"),
    ({"steps": ADAPTIVE, "integrator": DOP853, "max_steps": -1}, "max_steps must be at least 0"),
    ({"save_every": 0}, "save_every must be at least 1"),
    ({"t_eval": np.array([0.5, 0.5])}, "t_eval must increase, from t0 to t1"),
    ({"t_eval": np.array([0.5, 1.5])}, "t_eval must increase, from t0 to t1"),
    ({"t_eval": np.array([np.nan])}, "t_eval must increase, from t0 to t1"),
    ({"correction": {"baumgarte": {"alpha": 1.0, "beta": 2.0, "integral": 2.0}}}, r"less than alpha \* beta = 2, not 2"),
], ids=str)
def test_settings_that_the_core_refuses(changed, sentence):
    with pytest.raises(zd.ZerodriftError, match=sentence):
        created(handed(**changed))


# By the rule of a parameter: what it cannot be.
BROKEN = {"any": [np.nan, np.inf], "positive": [0.0, -1.0, np.nan, np.inf], "not negative": [-1.0, np.nan, np.inf],
          "choice": [-1.0, 0.5, 99.0, np.nan], "count": [0.0, -1.0, 1.5, 2.0**31, np.nan], "switch": [-1.0, 0.5, 2.0, np.nan]}
PARAMETERS = [(name, parameter) for name, card in zd.corrections().items() for parameter in card.parameters]


@pytest.mark.parametrize(("name", "parameter"), PARAMETERS, ids=[f"{name} {parameter.name}" for name, parameter in PARAMETERS])
def test_parameters_that_the_core_refuses(name, parameter):
    for value in BROKEN[parameter.rule]:
        with pytest.raises(zd.ZerodriftError, match=f"^{parameter.name} of '{name}' must be "):
            created(handed(correction={name: {parameter.name: value}}))


@pytest.mark.parametrize(("changed", "sentence"), [
    ({"nq": 0}, "1 to 8192 coordinates"),
    ({"nv": 10**9}, "1 to 8192 coordinates"),
    ({"mh": -1}, "at most 8192 constraints"),
    ({"mn": 8193}, "at most 8192 constraints"),
    ({"mn": 2, "provides": sum(gateway.TERMS[name].bit for name in ("M", "Phi", "C", "xi", "D", "gamma"))},
     "a complement D must not have more constraints than velocities"),
    ({"scratch": -1}, "scratch"),
    ({"provides": 0}, r"must have evaluate\(\) and provide M"),
    ({"nv": 3}, "as many velocities as coordinates"),
    ({"provides": gateway.TERMS["M"].bit}, "must provide Phi"),
    ({"provides": gateway.TERMS["M"].bit | gateway.TERMS["Phi"].bit}, "must provide C and xi"),
    ({"without": "gamma"}, "must provide both the complement D and gamma, or neither"),
], ids=str)
def test_systems_that_the_core_refuses(changed, sentence):
    core = zd.systems.pendulum()._core
    without = changed.pop("without", None)
    if without:
        core.c.provides = core.c.provides & ~gateway.TERMS["D"].bit & ~gateway.TERMS["gamma"].bit | gateway.TERMS["D"].bit
    for name, value in changed.items():
        setattr(core.c, name, value)
    for call in (lambda: created(handed(), core), lambda: gateway.acceleration(core, 0, 0, 0.0, np.zeros(2), np.zeros(2)),
                 lambda: gateway.project(core, handed(), 0.0, np.zeros(2), np.zeros(2)),
                 lambda: between(core, handed(), np.zeros(2), np.zeros(2))):
        with pytest.raises(zd.ZerodriftError, match=sentence):
            call()


def test_an_energy_correction_without_potential_is_refused_by_the_core():
    core = zd.System(1, mass=[[1.0]], p0=[0.0])._core
    with pytest.raises(zd.ZerodriftError, match=r"^energy correction needs V \(potential energy in J\) \[zd:"):
        between(core, handed(correction={"energy": {}}), np.zeros(1), np.zeros(1))


def test_a_start_that_is_not_finite_is_refused_by_the_core():
    core = zd.System(1, mass=[[1.0]], p0=[0.0])._core
    for p, v in ((np.nan, 0.0), (0.0, np.inf)):
        with pytest.raises(zd.Diverged):
            gateway.Run(core, handed(), np.array([p]), np.array([v]))


ACTION = ffi.new("zd_action[]", 1)


@pytest.mark.parametrize(("changed", "sentence"), [
    ({"count": -1}, "at most 8192 events"),
    ({"count": 9000}, "at most 8192 events"),
    ({"evaluate": ffi.NULL, "known": ffi.NULL}, r"events must have the function evaluate\(\)"),
    ({"actions": 1, "action": ACTION}, "actions must be at existing events"),
    ({"count": 1, "direction": ffi.NULL}, "events must have the arrays direction and terminal"),
], ids=["negative", "many", "no function", "no action", "no direction"])
def test_events_that_the_core_refuses(bar, changed, sentence):
    watcher = gateway.Watcher(bar._core, [])
    for name, value in changed.items():
        setattr(watcher.c, name, value)
    with pytest.raises(zd.ZerodriftError, match=sentence):
        gateway.Run(bar._core, handed(), bar.p0, bar.v0, watcher)


def test_a_step_by_an_integrator_that_does_not_suit_is_refused_by_the_core():
    edge = zd.systems.knife_edge()
    options = handed(integrator=list(zd.integrators()).index("rattle"))
    with pytest.raises(zd.ZerodriftError, match="rattle"):
        between(edge._core, options, edge.p0, edge.v0)
