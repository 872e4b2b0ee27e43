"""Tables that contradict themselves, and laws that fail: each way to fail is reached."""

import numpy as np
import pytest

import zerodrift as zd
from mechanism_tables import Body, GeneralizedForce, Joint, OutputSpec, Quantity, Tabled, Tables, kind
from support import refused

BODY, POINT = Body(1.0, 1.0), Body(1.0, is_particle=True)
PIN = Joint(kind("revolute"), 0, 1)
TURN = Quantity("angle", 0, 1)

REFUSED = [
    (Tables([]), "must have at least one body"),
    (Tables([Body(-1.0)]), "body 1: its mass must be at least 0, not -1"),
    (Tables([Body(1.0, float("nan"))]), "body 1: its inertia must be at least 0, not nan"),
    (Tables([Body(1.0, 1.0, True)]), "body 1: the inertia of a particle must be 0"),
    (Tables([BODY._replace(inboard=0)]), "body 1: its inboard joint must be at least -1 and below 0, not 0"),
    (Tables([BODY, BODY._replace(inboard=0)], [PIN]), "body 2: its inboard joint 0 must connect it"),
    (Tables([BODY._replace(inboard=0)], [PIN._replace(kind=kind("slot"))]),
     "body 1: its inboard joint 0 must be of a kind for trees, not a slot"),
    (Tables([POINT._replace(inboard=0)], [PIN._replace(kind=kind("weld"))]),
     "its inboard joint 0 must not be a weld, as a particle has no angle"),
    (Tables([BODY._replace(inboard=0)] * 2, [PIN._replace(first=2)]),
     "joint 0 must be the inboard joint of one body, not of bodies 1 and 2"),
    (Tables([BODY._replace(inboard=0), BODY._replace(inboard=1)], [PIN._replace(first=2)] * 2),
     "the tree of inboard joints must have no loop"),
    (Tables([BODY], [PIN._replace(kind=99)]), "joint 0: its kind must be from 0 to .*, not 99"),
    (Tables([BODY], [PIN._replace(second=2)]), "joint 0: its bodies must be from 0 to 1, not 0 and 2"),
    (Tables([BODY], [PIN._replace(first=1)]), "joint 0: its bodies must differ, and both are 1"),
    (Tables([POINT], [PIN._replace(point2=(1.0, 0.0))]), "joint 0: its point on a particle must be the mass centre"),
    (Tables([BODY], quantities=[TURN._replace(first=-1)]), "marker quantity 0: its bodies must be from 0 to 1, not -1 and 1"),
    (Tables([POINT], quantities=[Quantity("x", 1, 0, (0.0, 1.0))]),
     "marker quantity 0: its point on a particle must be the mass centre"),
]


@pytest.mark.parametrize(("tables", "sentence"), REFUSED)
def test_tables_that_contradict_themselves_are_refused(tables, sentence):
    with refused("wrong-value", sentence):
        Tabled(tables)


def hinged(law, **options):
    tables = Tables([BODY._replace(inboard=0)], [PIN], [TURN], measures=[OutputSpec("torque", "N m", "force value", 0)],
                    forces=[GeneralizedForce("law", 0, law=0, inputs=[0])], **options)
    return Tabled(tables, np.zeros(1), np.ones(1), law)


def test_a_law_that_fails_ends_the_run_with_its_error():
    def law(number, t, x, xdot):
        return [1.0 / (0.5 - t) if t < 0.4 else 1 / 0]

    with pytest.raises(ZeroDivisionError):
        zd.simulate(hinged(law), 1.0, step=0.01)
    system = hinged(law)
    with pytest.raises(ZeroDivisionError):
        system.measured("torque", 0.5, system.p0, system.v0)
    with pytest.raises(ZeroDivisionError):
        system._core.measure_at(0, 0.5, system.p0, system.v0)


def test_a_law_of_the_wrong_size_is_refused():
    with refused("shape", "law 0.*give 1.*2"):
        zd.simulate(hinged(lambda number, t, x, xdot: [1.0, 2.0]), 1.0, step=0.01)


def test_a_reaction_needs_accelerations():
    tables = Tables([BODY._replace(inboard=0)], [PIN], measures=[OutputSpec("force", "N", "joint force", 0)])
    system = Tabled(tables, np.zeros(1), np.ones(1))
    with refused("not-available"):
        system.measured("force", 0, system.p0, system.v0)
    with refused("not-available"):
        system._core.measure_at(0, 0.0, system.p0, system.v0)
