"""Runs that start in an equilibrium: `m.start(equilibrium=True)`, and what `zd.equilibrium` returns in place of p0."""

import numpy as np
import pytest

import zerodrift as zd
from support import refused

G = 9.81


def suspension(**start):
    """A wheel and a body on springs that are drawn without load, over a road that is driven."""
    m = zd.Mechanism("suspension", gravity=(0, -G))
    road = m.body("road", 1.0, 1.0, at=(0, 0))
    body = m.body("body", 300.0, 1.0, at=(0, 1.0))
    m.prismatic("bump", m.ground, road, axis=(0, 1))
    m.prismatic("guide", m.ground, body, axis=(0, 1))
    m.spring("strut", road.point((0, 0)), body.point((0, 0)), stiffness=20e3, length=1.0, damping=100.0)
    m.motor("profile", "bump", displacement=lambda t: 0.1 * np.sin(3.0 * t))
    m.start(**start)
    return m


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_a_suspension_starts_at_its_ride_height(layout):
    system = suspension(equilibrium=True).system(layout)
    sol = zd.simulate(system, 0.01, step=0.001)
    assert sol["guide.displacement"][0] == pytest.approx(-300.0 * G / 20e3, abs=1e-12)
    assert sol["bump.speed"][0] == pytest.approx(0.3, abs=1e-12)       # the drive runs
    assert sol["guide.speed"][0] == pytest.approx(0.0, abs=1e-12)
    assert zd.simulate(system.with_parameters({"body.mass": 150.0}), 0.01, step=0.01)["guide.displacement"][0] == pytest.approx(
        -150.0 * G / 20e3, abs=1e-12)


def test_a_start_in_equilibrium_is_taken_back():
    m = suspension(equilibrium=True)
    m.start(equilibrium=False)
    assert zd.simulate(m, 0.01, step=0.01)["guide.displacement"][0] == pytest.approx(0.0, abs=1e-12)
    with refused("wrong-type", "equilibrium"):
        m.start(equilibrium="yes")


def test_held_speeds_are_kept():
    m = zd.Mechanism("cart", gravity=(0, -G))
    cart = m.body("cart", 5.0, 1.0, at=(0, 0))
    mass = m.body("mass", 1.0, 1.0, at=(0, 1.0))
    m.prismatic("track", m.ground, cart, axis=(1, 0))
    m.prismatic("mast", cart, mass, axis=(0, 1))
    m.spring("spring", cart.point((0, 0)), mass.point((0, 0)), stiffness=400.0, length=1.0)
    m.start({"cart.velocity.x": 3.0}, equilibrium=True)
    sol = zd.simulate(m, 1.0, step=0.01)
    assert sol["mast.displacement"] == pytest.approx(np.full(101, -G / 400.0), abs=1e-9)
    assert sol["cart.velocity.x"] == pytest.approx(np.full(101, 3.0), abs=1e-9)


def test_a_file_keeps_the_start(tmp_path):
    m = zd.models.double_wishbone()
    m.start(equilibrium=True)
    m.save(tmp_path / "wishbone.json")
    other = zd.load(tmp_path / "wishbone.json")
    assert other.p0 == pytest.approx(m.p0, abs=1e-12)
    assert abs(zd.acceleration(other.system(), other.p0, 0 * other.v0)[0]).max() < 1e-6


def test_an_ensemble_starts_each_run_in_its_equilibrium():
    m = zd.Mechanism("hanging", gravity=(0, -G))
    mass = m.body("mass", 1.0, 1.0, at=(0, -1.0))
    m.prismatic("guide", m.ground, mass, axis=(0, 1))
    m.spring("spring", m.ground.point((0, 0)), mass.point((0, 0)), stiffness=100.0, length=1.0)
    m.start(equilibrium=True)
    masses = np.array([1.0, 2.0, 3.0])
    ens = zd.ensemble(m, 0.1, parameters={"mass.mass": masses}, step=0.01, outputs=["guide.displacement"])
    for run, each in enumerate(masses):
        assert ens["guide.displacement"][run] == pytest.approx(np.full(11, -each * G / 100.0), abs=1e-10)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_an_equilibrium_is_a_start(layout):
    m = zd.models.four_bar()
    eq = zd.equilibrium(m.system(layout))
    for given in (m, eq.system):
        sol = zd.simulate(given, 0.2, eq, step=0.01)
        assert np.abs(sol["crank.angle"] - eq["crank.angle"]).max() < 1e-11
    with refused("conflicting-arguments", "^v0 must"):
        zd.simulate(m, 0.2, eq, np.zeros(3), step=0.01)
    with refused("wrong-element", "^p0 must.*closed_pendulum"):
        zd.simulate(zd.models.closed_pendulum(), 0.2, eq, step=0.01)


def test_a_steady_motion_is_a_start():
    eq = zd.equilibrium(zd.models.flyball_governor(), v={"bearing.speed": 20.0})
    sol = zd.simulate(eq.system, 0.5, eq, step=0.002)
    assert np.abs(sol["slide.displacement"] - eq["slide.displacement"]).max() < 1e-8


def test_a_start_with_a_running_drive_meets_it():
    m = suspension()
    eq = zd.equilibrium(m)
    assert eq["bump.speed"] == 0.0      # drives stand in an equilibrium
    assert zd.simulate(m, 0.01, eq, step=0.01)["bump.speed"][0] == pytest.approx(0.3, abs=1e-12)


def test_an_instant_of_a_run_is_read_by_name_started_from_and_linearized():
    sol = zd.simulate(zd.models.four_bar(), 1.0, step=0.01, integrator="dop853")
    now = sol.at(0.5)
    assert now["A.force"] == pytest.approx(sol["A.force"][50], rel=1e-12)
    assert now["crank.angle"] == sol["crank.angle"][50]
    assert (now.t, now["crank.angular_velocity"]) == (0.5, pytest.approx(sol["crank.angular_velocity"][50], rel=1e-12))
    on = zd.simulate(zd.models.four_bar(), 0.5, now, step=0.01, integrator="dop853")
    assert on["crank.angle"][-1] == pytest.approx(sol["crank.angle"][-1], rel=1e-12)
    with pytest.warns(zd.AccuracyWarning, match="not in an equilibrium"):
        assert zd.linearize(zd.models.four_bar(), now).A.shape == (2, 2)
    with refused("wrong-name", r"'A\.forse'"):
        _ = now["A.forse"]
    with refused("conflicting-arguments", "^v0 must"):
        zd.simulate(zd.models.four_bar(), 0.5, now, now.v, step=0.01)
