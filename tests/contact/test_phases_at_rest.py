"""Equilibria and linearizations in the phase of contacts, against closed forms."""

import pickle

import numpy as np
import pytest

import zerodrift as zd
from contact.random_scenes import mechanism_of, scene_of
from contact.test_contacts import ball, rocking_block, slider

G = 9.81


def disc(slope=0.0, friction=0.5, stiffness=100.0):
    """A disc of 2 kg on a slope, on a spring along it."""
    along, normal = np.array([np.cos(slope), np.sin(slope)]), np.array([-np.sin(slope), np.cos(slope)])
    m = zd.Mechanism("disc", gravity=(0, -G))
    body = m.body("disc", 2.0, 0.01, at=0.1 * normal)
    m.contact("floor", body, m.ground.line((0, 0), along), radius=0.1, friction=friction)
    if stiffness:
        m.spring("spring", m.ground.point(0.1 * normal - along), body.point((0, 0)), stiffness=stiffness, length=1.0)
    return m


def test_a_ball_falls_to_the_floor():
    eq = zd.equilibrium(ball())
    assert eq.phase == {"floor": "closed"}
    assert eq["ball.position.y"] == pytest.approx(0, abs=1e-12)
    assert eq["floor.force"] == pytest.approx([0, 2 * G])
    assert "floor closed" in repr(eq)


def test_a_spring_that_holds_above_the_floor_leaves_it_open():
    m = zd.Mechanism("hung", gravity=(0, -G))
    grain = m.particle("grain", 2.0, at=(0.3, 1))
    m.contact("floor", grain, m.ground.line((0, 0), (1, 0)))
    spring = m.spring("spring", m.ground.point((0, 1)), grain, stiffness=100.0, length=0.5)
    eq = zd.equilibrium(m)
    assert eq.phase == {"floor": "open"}
    assert eq[spring.length] == pytest.approx(0.5 + 2 * G / 100)
    assert (2 * np.pi * eq.frequencies.max())**2 == pytest.approx(50)


@pytest.mark.parametrize(("lower", "angle"), [(-0.5, -0.5), (-2.0, -np.pi / 2)])
def test_a_pendulum_rests_on_its_stop_if_it_reaches_it(lower, angle):
    m = zd.Mechanism("pendulum", gravity=(0, -G))
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    pin = m.revolute("pin", m.ground, link.start)
    m.stop("stop", pin.angle, lower=lower)
    eq = zd.equilibrium(m)
    assert eq[pin.angle] == pytest.approx(angle, abs=1e-11)
    assert eq["stop.torque"] == pytest.approx(G / 2 * np.cos(angle), abs=1e-11)


@pytest.mark.parametrize(("bound", "angle"), [(6.0, 0.0), (2.0, -np.pi / 2)])
def test_friction_holds_where_it_suffices(bound, angle):
    m = zd.Mechanism("pendulum", gravity=(0, -G))
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    pin = m.revolute("pin", m.ground, link.start, friction_torque=bound)
    eq = zd.equilibrium(m)
    assert eq.phase == {"pin": "sticking"}
    assert eq[pin.angle] == pytest.approx(angle, abs=1e-9)
    assert eq["pin.torque"] == pytest.approx(G / 2 * np.cos(angle), abs=1e-9)


def test_a_block_in_a_groove_bears_on_both_flanks():
    m = zd.Mechanism("groove", gravity=(0, -G))
    grain = m.particle("grain", 1.0, at=(0.2, 1))
    m.contact("left", grain, m.ground.line((-np.cos(0.5), np.sin(0.5)), (0, 0)))
    m.contact("right", grain, m.ground.line((0, 0), (np.cos(0.9), np.sin(0.9))))
    eq = zd.equilibrium(m)
    assert [eq["left.force"], eq["right.force"]] == [
        pytest.approx(np.array(force)) for force in (G * np.sin(0.9) / np.sin(1.4) * np.array([np.sin(0.5), np.cos(0.5)]),
                                                     G * np.sin(0.5) / np.sin(1.4) * np.array([-np.sin(0.9), np.cos(0.9)]))]


@pytest.mark.parametrize("seed", [0, 2, 3, 4, 5, 8])
def test_a_run_stays_at_an_equilibrium(seed):
    system = mechanism_of(scene_of(seed)[1]).system()
    eq = zd.equilibrium(system)
    sol = zd.simulate(system, 0.2, p0=eq.p, v0=np.zeros(system.nv), step=0.01)
    assert abs(sol.p - eq.p).max() < 1e-7
    assert sol.phases[-1].state == eq.phase


def test_what_has_no_equilibrium_is_named():
    with pytest.raises(zd.EquilibriumFailed, match="floor closed"):
        zd.equilibrium(disc(0.3, friction=0.0, stiffness=0.0))
    with pytest.raises(ValueError, match="hold and v"):
        zd.equilibrium(ball(), hold=["ball.position.x"])


@pytest.mark.parametrize("slope", [0.0, 0.3])
def test_a_disc_that_sticks_rolls_on_its_spring(slope):
    m = disc(slope)
    eq = zd.equilibrium(m)
    lin = zd.linearize(m, eq, outputs=["floor.force"])
    assert lin.phase == {"floor": "sticking"}
    assert "phase: floor sticking" in repr(lin)
    assert (2 * np.pi * lin.frequencies)**2 == pytest.approx(100 / (2 + 0.01 / 0.1**2))
    assert len(pickle.loads(pickle.dumps(lin)).eigenvalues) == 2


def test_a_linearization_at_an_instant_is_that_of_its_phase():
    m, slide = slider(friction_force=4.0)
    m.spring("spring", m.ground.point((-1, 0)), m["block"].point((0, 0)), stiffness=50.0, length=1.0)
    m.start({slide.speed: 3.0})
    sol = zd.simulate(m, 1.0, rtol=1e-9, atol=1e-11)
    with pytest.warns(zd.AccuracyWarning):
        lin = zd.linearize(m, sol.at(0.05))
    assert lin.phase == {"slide": "sliding"}
    assert abs(lin.eigenvalues)**2 == pytest.approx([25, 25])
    assert lin.rate[1] * np.sqrt(0.5) == pytest.approx(-(4 + 50 * sol.at(0.05)["slide.displacement"]) / 2)


def test_a_block_stands_on_both_feet():
    m, half, height = rocking_block()
    eq = zd.equilibrium(m)
    assert eq.phase == {"left": "sticking", "right": "sticking"}
    assert eq["block.position.y"] == pytest.approx(height)
    assert eq["left.force"] == pytest.approx([0, 3 * G / 2], abs=1e-9)
    assert half


def test_a_single_state_is_in_the_phase_that_a_run_begins_with():
    m, _ = slider(friction_force=4.0)
    system = m.system("joint")
    vdot, _ = zd.acceleration(system, [0.0], [3.0])
    assert vdot == pytest.approx([-2.0])
    assert zd.Instant(system, 0.0, [0.0], [3.0])["slide.force"] == pytest.approx([-4, 2 * G])
    with pytest.raises(ValueError, match="impact"):
        zd.acceleration(ball().system("absolute"), [0.0, 0.0], [0.0, -1.0])


def test_drives_that_move_are_named():
    """The crank of the Geneva drive turns, and the shaker of the suspension starts with an acceleration of 0.06 * 11^2."""
    for model, acceleration in ((zd.models.geneva, "of 0"), (zd.models.suspension, r"of 7\.26")):
        with pytest.raises(zd.EquilibriumFailed, match=f"'drive' of .* moves at t = 0, .*acceleration {acceleration}"):
            zd.equilibrium(model())
