"""Elements on marker quantities, alike in the plane and in space: refusals, resulting terms, arguments of user functions."""

import numpy as np
import pytest

from support import refused
from zerodrift._private.gateway.mechanisms import element_tables, plane, space
from zerodrift._private.gateway.mechanisms.element_tables import GeneralizedForce, OutputSpec, Relation

BODIES = {plane: plane.Body(1.5, 1.0), space: space.Body(1.5, (1.0, 1.0, 1.0))}
CORES = {plane: plane.PlaneCore, space: space.SpaceCore}
AXES = {plane: ("x", "y"), space: ("x", "y", "z")}


@pytest.fixture(params=[plane, space], ids=["plane", "space"])
def room(request):
    return request.param


def core(room, law=None, know_time=True, **tables):
    """One body, and marker quantities of its place."""
    quantities = [room.Quantity(axis, 0, 1) for axis in AXES[room]]
    return CORES[room](room.Tables([BODIES[room]], quantities=quantities, **tables), law, laws_know_time=know_time)


def measure(quantity, index, size=1, term=0):
    return {"measures": [OutputSpec("it", "", quantity, index, size, term=term)]}


def law(number, t, x, xdot):
    return [t, *x, *xdot, 0.0]


@pytest.mark.parametrize("relation", [Relation([3]), Relation([-1]), Relation([]), Relation([0], law=0), Relation([0], joint=0)])
def test_relations_are_of_what_there_is(room, relation):
    with refused("wrong-value", "relation 0: its marker quantities, user function and joint must exist"):
        core(room, relations=[relation])


@pytest.mark.parametrize("force", [
    GeneralizedForce("spring", 3), GeneralizedForce("law", 0), GeneralizedForce("constant", 0, law=0),
    GeneralizedForce("spring", 0, joint=0), GeneralizedForce("law", 0, law=0, inputs=[3])])
def test_generalized_forces_are_of_what_there_is(room, force):
    with refused("wrong-value", "generalized force 0: its kind, marker quantities, user function and joint must exist"):
        core(room, law, forces=[force])


@pytest.mark.parametrize("wrong", [
    measure("values", 3), measure("values", 0, 4), measure("rates", 0, 0), *(measure(f"joint {what}", 0)
                                                                            for what in ("force", "torque", "tension")),
    *(measure(quantity, 1) for quantity in ("force value", "force power", "force sum", "drive", "drive power")),
    measure("force sum", 0, 2), measure("drive", 0, term=2)])
def test_measures_are_of_what_there_is(room, wrong):
    with refused("wrong-value", "measure it: the entries that it measures must exist"):
        core(room, forces=[GeneralizedForce("constant", 0)], relations=[Relation([0])], **wrong)


def test_a_quantity_that_there_is_not(room, monkeypatch):
    monkeypatch.setitem(element_tables.OUTPUT_KINDS, "none", 99)
    with refused("wrong-value", "measure it: the entries that it measures must exist"):
        core(room, **measure("none", 0))


@pytest.mark.parametrize(("tables", "Phi_t", "power", "timeless"), [
    ({}, False, False, True),
    ({"relations": [Relation([0], constant=1.0)]}, False, False, True),
    ({"relations": [Relation([0], slope=1.0)]}, True, False, False),
    ({"relations": [Relation([0], constant=1.0, nonholonomic=True)]}, True, False, True),
    ({"relations": [Relation([0], law=0)]}, True, False, False),
    ({"forces": [GeneralizedForce("spring", 0, 1.0)]}, False, False, True),
    ({"forces": [GeneralizedForce("spring", 0, 1.0, 1.0)]}, False, True, True),
    ({"forces": [GeneralizedForce("constant", 0, value=1.0)]}, False, True, True),
])
def test_which_terms_there_are(room, tables, Phi_t, power, timeless):
    made = core(room, law if any(row.law >= 0 for row in tables.get("relations", ())) else None, **tables)
    terms = made.evaluate(0.0, made.origin, np.zeros(made.nv))
    assert ("Phi_t" in terms, "power" in terms, made.timeless) == (Phi_t, power, timeless)


def test_a_law_that_knows_no_time(room):
    made = core(room, law, know_time=False, relations=[Relation([0], law=0)])
    assert made.timeless
    assert "Phi_t" not in made.evaluate(0.0, made.origin, np.zeros(made.nv))


def test_the_longest_law_has_room(room):
    """User functions of two marker quantities and of six, which are called one after the other."""
    calls = []

    def law(number, t, x, xdot):
        calls.append((number, list(x), list(xdot)))
        return [sum(x)]

    forces = [GeneralizedForce("law", 0, law=0, inputs=[0, 1]), GeneralizedForce("law", 1, law=1, inputs=[1, 0] * 3)]
    made = core(room, law, forces=forces).for_run()
    p, v = made.origin, np.zeros(made.nv)
    p[:2], v[:2] = (0.3, 0.4), (1.0, 2.0)
    terms = made.evaluate(0.0, p, v)
    np.testing.assert_allclose(terms["f"][:2], [0.7, 2.1], rtol=1e-15)
    assert terms["power"] == pytest.approx(0.7 * 1.0 + 2.1 * 2.0, rel=1e-15)
    assert (0, [0.3, 0.4], [1.0, 2.0]) in calls
    assert (1, [0.4, 0.3] * 3, [2.0, 1.0] * 3) in calls


def test_the_sum_of_several_forces(room):
    """Springs along all axes: what they do to the body is what acts on it, and minus the gradient of what they store."""
    axes = len(AXES[room])
    springs = [GeneralizedForce("spring", i, 2.0 + i) for i in range(axes)]
    made = core(room, forces=springs, **measure("force sum", 0, axes))
    p, v = made.origin, np.zeros(made.nv)
    p[:axes] = [0.3, -0.2, 0.5][:axes]
    force = made.measure_at(0, 0.0, p, v)["value"]
    np.testing.assert_allclose(force, [-spring.stiffness * x for spring, x in zip(springs, p, strict=False)], rtol=1e-15)
    np.testing.assert_allclose(made.evaluate(0.0, p, v)["f"][:axes], force, rtol=1e-15)      # two sums of the same terms
