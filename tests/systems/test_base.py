"""Properties of every system: its printed summary."""

import re

import numpy as np
import pytest

import energy_models
import zerodrift as zd
from support import SYSTEMS

BAR = zd.systems.four_bar()


@pytest.mark.parametrize("kind", SYSTEMS)
def test_a_printed_system_says_what_it_is(kind):
    system = SYSTEMS[kind]
    text = str(system)
    assert text.startswith(f"{system.name}\n")
    for variable in (*system.coordinates, *system.velocities, *system.constraints):
        assert (f"{variable.name} [{variable.unit}]" if variable.unit else variable.name) in text
    for name in system.parameters:
        assert f"{name} = " in text
    assert f"freedom       {system.nv - system.m}\n" in text      # built-in systems have no redundant constraints
    assert repr(system) != text


def test_of_many_names_the_first_and_the_last_are_printed():
    system = zd.models.chain(30).system("absolute")
    text = str(system)
    assert "link 0.x [m]" in text
    assert "link 29.e3" in text
    assert "link 15.x" not in text
    shown = re.findall(r"([^,]*), \((\d+) more\), ", text)
    assert [int(number) for _, number in shown] == [number - 24 for number in (system.nq, system.nv, system.m)]
    assert len(text.splitlines()) < 40


def test_printed_systems_of_all_kinds():
    twice = zd.System(["x", "y"], mass=np.eye(2), units=["m", "m"], p0=[1.0, 0.0], parameters={"L": 1.0},
                      constraints=lambda p, L: np.array([p @ p - L, 2 * (p @ p - L)]))
    assert "x [m], y [m]" in str(twice)
    assert "freedom       1, redundant constraints at the start: 1" in str(twice)
    assert "L = 1.0" in str(twice)
    nowhere = zd.System(["x", "y"], mass=np.eye(2), constraints=lambda p: np.array([p @ p - 1.0]))
    assert "freedom       at least 1" in str(nowhere)
    assert "gravity = 9.81 m/s^2" in str(BAR)
    assert "coordinates" in str(energy_models.slider_crank())
