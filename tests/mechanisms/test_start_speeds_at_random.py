"""Start velocities of random driven mechanisms: equal in both coordinates, in plane and space, and with what is so already."""

import numpy as np
import pytest

import zerodrift as zd
from covering import draws
from mechanisms.random_mechanisms import Maker
from support import assert_close


class Driven(Maker):
    """A random mechanism that a drive moves, with particles that hang by rods and bodies that actuators push or that roll."""

    def __init__(self, seed):
        super().__init__(seed)
        while not self.m.motors:
            self._drive()
            if not self.m.motors:
                self._hinge()
        for i in range(self.random.integers(0, 3)):
            self._hang(f"P{i}")

    def _blade(self):
        pass

    _force = _effort = _spring = _blade

    def _hinge(self):
        self._joint("revolute", -1, self._apart(), self._place())
        self.free = [len(self.joints) - 1]

    def _hang(self, name):
        body, at, other = self.bodies[self.random.integers(len(self.bodies))], self._place(), self._place()
        kind = self.random.choice(["rod", "actuator", "body"])
        if kind == "rod":
            self.m.rod(f"{name} rod", body.point(at=other), self.m.particle(name, 1.0, at=at))
        elif kind == "actuator":
            length = np.linalg.norm(at - other)
            self.m.actuator(f"{name} cylinder", body.point(at=other), self.m.particle(name, 1.0, at=at),
                            length=lambda t: length + 0.3 * t)
        else:
            self.m.rod(f"{name} rod", body.point(at=other), self.m.body(name, 1.0, 0.1, at=self._place()).point(at=at))


def start(m, layout):
    """Instant at the start, and velocities and angular velocities of all bodies."""
    at = zd.Run(m.system(layout), step=1e-3)
    turning = [f"{body.name}.angular_velocity" for body in m.bodies if body.turns]
    velocity = np.concatenate([at[f"{body.name}.velocity"][:2] for body in m.bodies])
    return at, np.append(velocity, [np.ravel(at[name])[-1] for name in turning])


def maker(seed):
    """A mechanism whose drive can move, all groups of which hang on the ground."""
    while True:
        made = Driven(seed)
        connected = {-1}
        for _ in made.bodies:
            connected |= {body for _, *ends, _, _ in made.drawn if connected & {*ends} for body in ends}
        if len(connected) > len(made.bodies) and _can_start(made.m):
            return lambda: Driven(seed).m
        seed += 1000


def _can_start(m):
    try:
        start(m, "absolute")
    except zd.InconsistentStart:
        return False
    return True


@pytest.mark.parametrize("seed", range(draws(16, 200)))
def test_starts_do_not_depend_on_coordinates_or_dimension(seed):
    m = maker(seed)()
    _, known = start(m, "absolute")
    for each, layout in ((m, "joint"), (m.lifted(), "absolute"), (m.lifted(), "joint")):
        assert_close(start(each, layout)[1], known, 1e-8)


@pytest.mark.parametrize("seed", range(draws(16, 200)))
def test_holding_what_is_so_already_changes_nothing(seed):
    make = maker(seed)
    m, random = make(), np.random.default_rng(seed)
    at, known = start(m, "absolute")
    driven = {motor.joint.name for motor in m.motors}
    names = [f"{body.name}.velocity" for body in m.bodies]
    names += [f"{body.name}.angular_velocity" for body in m.bodies if body.turns]
    names += [f"{joint.name}.speed" for joint in m.joints if f"{joint.name}.speed" in m.measures and joint.name not in driven]
    values = {str(name): at[name] for name in random.choice(names, min(3, len(names)), replace=False)}
    for how in ("held", "wish"):
        for each, layout in ((make(), "absolute"), (make(), "joint")):
            each.start(**{how: values})
            assert_close(start(each, layout)[1], known, 1e-8)
