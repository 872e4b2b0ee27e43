"""Names stand for what they name, wherever a verb takes a joint, a body or a point."""

import numpy as np
import pytest

import zerodrift as zd
from support import refused

VERBS = {       # what each adds, given a function that makes what it names of a name
    "revolute": lambda m, of: m.revolute("new", of("base.end"), of("arm.start")),
    "revolute of bodies": lambda m, of: m.revolute("new", of("base"), of("arm"), at=of("P")),
    "prismatic": lambda m, of: m.prismatic("new", of("ground"), of("arm"), axis=(1, 0)),
    "prismatic at a point": lambda m, of: m.prismatic("new", of("ground"), of("P"), axis=(1, 0)),
    "weld": lambda m, of: m.weld("new", of("base"), of("arm.end")),
    "rod": lambda m, of: m.rod("new", of("P"), of("bob")),
    "slot": lambda m, of: m.slot("new", of("base"), of("bob"), axis=(1, 0)),
    "rolling": lambda m, of: m.rolling("new", of("ground"), of("arm"), radius=0.5, at=of("P")),
    "knife_edge": lambda m, of: m.knife_edge("new", of("arm"), along=(1, 0)),
    "motor": lambda m, of: m.motor("new", of("shaft"), speed=1.0),
    "spring": lambda m, of: m.spring("new", of("P"), of("arm.end"), stiffness=1.0),
    "torsion_spring": lambda m, of: m.torsion_spring("new", of("shaft"), stiffness=1.0, angle=0.1),
    "bushing": lambda m, of: m.bushing("new", of("base"), of("arm.end"), stiffness=1.0),
    "force": lambda m, of: m.force("new", of("arm"), along=(0, 1), value=1.0, frame=of("base")),
    "force at a point": lambda m, of: m.force("new", of("arm.end"), along=(0, 1), value=1.0),
    "torque": lambda m, of: m.torque("new", of("arm"), value=1.0, against=of("base")),
    "gear": lambda m, of: m.gear("new", of("shaft"), of("knee"), ratio=2.0),
    "rack_pinion": lambda m, of: m.rack_pinion("new", of("shaft"), of("rail"), ratio=2.0),
    "cam": lambda m, of: m.cam("new", of("shaft"), of("rail"), profile=np.sin),
    "body": lambda m, of: m.body("new", 1.0, 0.1, at=of("P")),
    "link": lambda m, of: m.link("new", of("base.end"), of("P"), mass=1.0),
    "particle": lambda m, of: m.particle("new", 1.0, at=of("arm.end")),
    "point": lambda m, of: m.point("new", of("arm"), at=of("P")),
}


@pytest.fixture
def machine():
    """A base with an arm, and what else there is to be named."""
    m = zd.Mechanism("machine")
    base, arm = m.link("base", (0, 0), (1, 0), mass=1.0), m.link("arm", (1, 0), (2, 0.5), mass=1.0)
    m.revolute("shaft", m.ground, base.start)
    m.revolute("knee", base.end, arm.start)
    m.particle("bob", 1.0, at=(3, 1))
    m.prismatic("rail", m.ground, m.body("cart", 1.0, 0.1), axis=(1, 0))
    m.point("P", base, (0.5, 0.2))
    return m


def things(m):
    return {"base.end": m["base"].end, "arm.start": m["arm"].start, "arm.end": m["arm"].end}


@pytest.mark.parametrize("add", VERBS.values(), ids=VERBS)
def test_a_name_is_what_it_names(machine, add):
    add(machine, lambda name: name)
    named = machine.system("absolute")
    del machine._elements["new"]
    add(machine, lambda name: things(machine).get(name) or machine[name])
    given = machine.system("absolute")
    assert named.parameters == given.parameters
    assert named.measures == given.measures
    assert named._first_core.tables == given._first_core.tables


@pytest.mark.parametrize("name", ["sahft", "kne", "arm.and", "arm.start.x", "", "Q"])
def test_a_name_that_there_is_not_is_answered_with_close_ones(machine, name):
    closest = {"sahft": "shaft", "kne": "knee", "arm.and": "arm.end, ", "arm.start.x": "arm.start"}
    close = f"the closest of 13 names (is|are) {closest[name]}" if name in closest else "there are ground, base, arm, "
    with refused("wrong-name", f"joint of motor 'drive' names '{name}', which is not an element of 'machine'; {close}"):
        machine.motor("drive", name, speed=1.0)


def test_a_name_of_something_else_is_refused(machine):
    with refused("wrong-type", "'drive'"):
        machine.motor("drive", "arm", speed=1.0)
    with refused("wrong-element", "first.*'base'"):
        machine.rod("rod", "base", "bob")
    with refused("wrong-type", "first.*'machine'.*arm.end"):
        machine.rolling("wheel", "arm.end", "bob", radius=1)
