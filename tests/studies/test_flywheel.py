"""`zd.flywheel` against the energy of a turn by quadrature, where the speed follows from the angle alone."""

import numpy as np
import pytest

import zerodrift as zd
from support import refused

R, L, PISTON, CRANK, F, SPEED = 0.1, 0.35, 40.0, 0.8, 9000.0, 12.0


def shaper(dimension=2, drive=True, damping=0.0):
    """A slider-crank whose massless rod pushes a ram, which cuts on its way out."""
    space = (0.0,) * (dimension - 2)
    axis = {"axis": (0, 0, 1)} if space else {}
    m = zd.Mechanism("shaper", dimension=dimension)
    inertia = np.diag([0.5, 0.5, CRANK]) if space else CRANK
    crank = m.body("crank", 5.0, inertia)
    rod = m.link("rod", (R, 0, *space), (R + L, 0, *space), mass=0.0)
    ram = m.particle("ram", PISTON, at=(R + L, 0, *space))
    main = m.revolute("main", m.ground, crank, at=(0, 0, *space), damping=damping, **axis)
    if space:
        m.revolute("pin", crank.point((R, 0, 0)), rod.start, **axis)
        m.slot("guide", m.ground, ram, axis=(1, 0, 0))
        m.spherical("wrist", rod.end, ram)
    else:
        m.revolute("pin", crank.point((R, 0)), rod.start)
        m.revolute("wrist", rod.end, ram)
        m.slot("guide", m.ground, ram, axis=(1, 0))
    m.force("cut", ram, value=lambda v: -F if v > 0 else 0.0, along=(1, 0, *space), of={"v": ram.velocity.x})
    if drive:
        m.motor("drive", main, speed=SPEED)
    m.start({main.angle: 0.0})
    return m


def fluctuation(J, cells=20000):
    """Fluctuation and mean speed over a turn at unit mean, by the energy as a function of the angle, and the torque."""
    a = np.linspace(0, 2 * np.pi, cells + 1)
    root = np.sqrt(L**2 - (R * np.sin(a))**2)
    slope = -R * np.sin(a) - R**2 * np.sin(a) * np.cos(a) / root
    x = R * np.cos(a) + root
    work = np.where(a <= np.pi, 0.0, -F * (x - x[cells // 2]))
    torque = -work[-1] / (2 * np.pi)
    energy, inertia = work + torque * a, CRANK + J + PISTON * slope**2

    def speeds(start):
        return np.sqrt(2 * (start + energy) / inertia)

    def mean(start):
        weights = np.ones(cells + 1)
        weights[[0, -1]] = 0.5
        return cells / float((weights / speeds(start)).sum())

    low, high = -energy.min() + 1e-6, 10 * (CRANK + J + PISTON * R**2) * SPEED**2 + 10 * np.ptp(energy)
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (low, middle) if mean(middle) > SPEED else (middle, high)
    w = speeds(middle)
    return (w.max() - w.min()) / SPEED, torque, np.ptp(energy)


@pytest.mark.parametrize("wanted", [0.02, 0.2])
def test_the_run_has_the_fluctuation_by_the_energy(wanted):
    found = zd.flywheel(shaper(), "main.angle", speed=SPEED, fluctuation=wanted)
    assert fluctuation(found.inertia)[0] == pytest.approx(wanted, rel=1e-6)
    assert found.fluctuation == pytest.approx(wanted, rel=1e-8)
    assert found.torque == pytest.approx(fluctuation(found.inertia)[1], rel=1e-7)


def test_the_formula_is_of_constant_speed():
    """T - Tmean of a prescribed speed, integrated over the turn."""
    found = zd.flywheel(shaper(), "main.angle", speed=SPEED)
    a = np.linspace(0, 2 * np.pi, 20001)
    sol = zd.simulate(shaper(), 2 * np.pi / SPEED, t_eval=a / SPEED, rtol=1e-10, atol=1e-10)
    torque = sol["drive.torque"]
    torque[[0, 10000, 20000]] = np.nan      # the cut begins and ends there
    cell = np.nanmean([torque[1:], torque[:-1]], axis=0) * np.diff(a)
    excess = np.cumsum(cell - cell.mean())
    assert found.energy == pytest.approx(np.ptp(excess), rel=1e-4)
    assert found.formula == found.energy / (0.02 * SPEED**2)
    assert found.torque == pytest.approx(cell.sum() / (2 * np.pi), rel=1e-6)


def test_the_plane_and_space_agree_and_a_drive_does_not_matter():
    plain = zd.flywheel(shaper(), "main.angle", speed=SPEED, fluctuation=0.1)
    for other in (zd.flywheel(shaper(3), "main.angle", speed=SPEED, fluctuation=0.1),
                  zd.flywheel(shaper(drive=False), "crank.angle", speed=SPEED, fluctuation=0.1)):
        assert other.inertia == pytest.approx(plain.inertia, rel=1e-7)
        assert other.torque == pytest.approx(plain.torque, rel=1e-7)


def test_a_load_that_depends_on_the_speed():
    """The mean torque of a bearing with damping is the damping times the mean speed, to the square of the fluctuation."""
    plain, damped = (zd.flywheel(shaper(damping=each), "main.angle", speed=-SPEED, fluctuation=0.02) for each in (0.0, 3.0))
    assert damped.torque - plain.torque == pytest.approx(-3.0 * SPEED, rel=2e-4)
    end = damped.sol
    again = zd.simulate(end.system, end.t[-1], end.p[-1], end.v[-1], rtol=1e-10, atol=1e-10, max_step=1e-3)
    w = again["crank.angular_velocity"]
    assert np.ptp(w) / SPEED == pytest.approx(0.02, rel=1e-4)


def test_a_machine_that_needs_none():
    found = zd.flywheel(shaper(), "main.angle", speed=1000 * SPEED, fluctuation=0.9)
    assert found.inertia == 0
    assert 0 < found.fluctuation < 0.9


@pytest.mark.parametrize(("what", "code"), [({"shaft": "guide.displacement"}, "wrong-measure"), ({"speed": 0.0}, "out-of-range"),
                                        ({"fluctuation": 2.0}, "out-of-range")])
def test_wrong_arguments(what, code):
    given = {"shaft": "main.angle", "speed": SPEED} | what
    with refused(code, next(iter(what))):
        zd.flywheel(shaper(), given.pop("shaft"), **given)
