"""Parameters of systems of all kinds: which names and values they may have."""

import numpy as np
import pytest

import zerodrift as zd
from bead import MASKED, bead
from native_systems import pendulum as native_pendulum
from support import refused


@pytest.mark.parametrize("name", ["t", "p", "v"])
def test_a_parameter_cannot_take_the_place_of_the_state(name, library):
    for make in (lambda: bead(parameters={"m": 1.0, "pull": np.zeros(2), name: np.zeros(2)}),
                 lambda: native_pendulum(library, parameters={name: 1.0}),
                 lambda: zd.native(library, symbol="pendulum", parameters={name: 1.0})):
        with refused("duplicate-name", f"parameters cannot have '{name}': t, p, v are time, coordinates and velocities"):
            make()
    with refused("unknown-choice", f"parameter must be one of 'm', 'pull', not '{name}'"):
        bead().with_parameters(**{name: 1.0})


def test_a_kind_whose_parameter_is_named_as_the_state_is_refused(library, monkeypatch):
    kind_at = zd._private.gateway.kind_at

    def renamed(address):
        kind = kind_at(address)
        kind.parameters = (kind.parameters[0]._replace(name="v"), *kind.parameters[1:])
        return kind

    monkeypatch.setattr(zd._private.gateway, "kind_at", renamed)
    with refused("compiled-function", r"zd_kind_pendulum of .*: parameters cannot have 'v'"):
        zd.native(library, symbol="pendulum")


def test_no_built_in_parameter_has_the_name_of_the_state():
    assert not {p.name for kind in zd._private.gateway.kinds().values() for p in kind.parameters} & {"t", "p", "v"}


@pytest.mark.parametrize("name", ["x", "x_dot", "t", "other"])
def test_a_symbolic_parameter_has_a_name_of_its_own(name):
    from sympy import Symbol
    from sympy.physics.mechanics import dynamicsymbols

    x = dynamicsymbols("x")
    for key in (name, Symbol(name, positive=True)):
        given = {"kinetic": Symbol("m") * x.diff() ** 2, "parameters": {"m": 1.0, key: 1.0}, "p0": [1.0]}
        if name == "other":
            assert zd.symbolic([x], **given).parameters["other"] == 1.0
        else:
            with refused("duplicate-name", f"parameter {name} is a coordinate, a velocity or time"):
                zd.symbolic([x], **given)


@pytest.mark.parametrize(("parameters", "code", "message"), [
    ([1, 2], "wrong-type", "parameters.*1, 2"),
    ("m", "wrong-type", "parameters.*'m'"),
    ({1: 2.0}, "wrong-type", "parameters.*not 1"),
    ({"m": "2.0"}, "wrong-type", "'m'.*'2.0'"),
    ({"m": np.array(["2.0"])}, "wrong-type", "'m'"),
    ({"m": MASKED}, "not-finite", "'m'"),
])
def test_what_parameters_cannot_be(parameters, code, message):
    with refused(code, message):
        bead(parameters=parameters)


def test_parameters_of_other_doors_are_a_dict(library):
    from sympy import Symbol
    from sympy.physics.mechanics import dynamicsymbols

    x = dynamicsymbols("x")
    for make in (lambda: native_pendulum(library, parameters=[1, 2]),
                 lambda: zd.native(library, symbol="pendulum", parameters="x"),
                 lambda: zd.symbolic([x], kinetic=Symbol("m") * x.diff() ** 2, parameters=[1, 2])):
        with refused("wrong-type", "parameters"):
            make()


def test_any_object_but_a_string_may_be_a_parameter():
    def profile(t):
        return np.array([0.0, -9.81])

    parameters = {"m": 2.0, "pull": np.array([0.0, -9.81]), "profile": profile}
    system = bead(force=lambda t, m, profile: m * profile(t), parameters=parameters)
    assert (zd.simulate(system, 0.2, step=0.02).p == zd.simulate(bead(), 0.2, step=0.02).p).all()
