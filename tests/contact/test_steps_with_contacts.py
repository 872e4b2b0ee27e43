"""Contacts within a step: seen however short they are, and without samples where all stay open."""

import math

import numpy as np
import pytest

import zerodrift as zd

G = 9.81


def rotor(height=None):
    m = zd.Mechanism("rotor", gravity=(0, 0))
    arm = m.body("arm", 1.0, 0.1)
    pin = m.revolute("pin", m.ground, arm.point((0, 0)))
    if height:
        m.contact("hit", arm.point((1, 0)), m.ground.line((0, -height), (1, -height)), restitution=1.0)
        m.stop("far", pin.angle, upper=1e3)
    m.start({arm.angular_velocity: 20.0})
    return m


@pytest.mark.parametrize("settings", [{"rtol": 1e-6}, {"rtol": 1e-3, "formulation": "independent"}, {"step": 0.4}], ids=str)
def test_a_contact_is_seen_in_steps_of_several_turns(settings):
    """Without a force the error alone would allow adaptive steps of any number of turns."""
    sol = zd.simulate(rotor(0.5), 10.0, **settings)
    first, between = 7 * math.pi / 6 / 20, 4 * math.pi / 3 / 20
    assert sol.impacts["t"] == pytest.approx(first + between * np.arange(len(sol.impacts)), abs=1e-11)
    assert len(sol.impacts) == 1 + int((10 - first) / between)


@pytest.mark.parametrize("settings", [{"step": 1e-3}, {"rtol": 1e-8, "max_step": 0.01}], ids=str)
def test_contacts_out_of_reach_cost_no_evaluation(settings):
    """Their gaps and rates at the ends of a step show that they stay open in it."""
    far, free = (zd.simulate(each, 0.1, closed_form=False, **settings) for each in (rotor(1.5), rotor()))
    assert far.stats["evaluations"] <= free.stats["evaluations"] + 10


@pytest.mark.parametrize("depth", [5e-5, 1e-9])
def test_a_contact_that_opens_within_the_step_in_which_it_closes_is_seen(depth):
    """A ball would pass a ceiling by this much between two steps, at both of which it is below."""
    step, top = 0.01, 0.105
    m = zd.Mechanism("ball", gravity=(0, -G))
    ball = m.particle("ball", 2.0, at=(0, 0))
    ceiling = G * top**2 / 2 - depth
    m.contact("ceiling", ball, m.ground.line((0, ceiling), (-1, ceiling)), restitution=0.5)
    m.start({ball.velocity: (0, G * top)})
    sol = zd.simulate(m, 0.2, step=step)
    speed = math.sqrt(2 * G * depth)
    assert sol.impacts["t"] == pytest.approx([top - speed / G], abs=1e-10)
    assert sol.v[-1, 1] == pytest.approx(-0.5 * speed - G * (0.2 - sol.impacts["t"][0]), abs=1e-9)
