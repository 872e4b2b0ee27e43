"""The governor against two equations by hand, the chain against one of the plane, and what every model in space can do."""

import inspect
import pickle

import numpy as np
import pytest
import scipy.integrate

import zerodrift as zd
from every_model import IN_SPACE, assert_right
from support import assert_close, refused
from zerodrift._private.rotations import rotation_of

EXACT = {"integrator": "dop853", "step": None, "rtol": 1e-11, "atol": 1e-11}
FEW = {"chain": {"links": 4}}


def governor_by_hand(theta, rate, speed, t_eval, m=2.0, M=5.0, arm=0.25, J=0.02, ball=0.4 * 2.0 * 0.04**2):
    """Lagrange's equation for the angle of the arms; what turns keeps its angular momentum."""
    def inertia(theta):
        return J + 2 * m * (arm * np.sin(theta))**2 + 2 * ball

    momentum = inertia(theta) * speed

    def change(t, y):
        theta, rate = y
        s, c, w = np.sin(theta), np.cos(theta), momentum / inertia(theta)
        moment = 2 * m * arm**2 * s * c * w**2 - 2 * (m + M) * 9.81 * arm * s - 4 * M * arm**2 * s * c * rate**2
        return [rate, moment / (2 * m * arm**2 + 2 * ball + 4 * M * arm**2 * s**2)]

    y = scipy.integrate.solve_ivp(change, (0, t_eval[-1]), [theta, rate], method="DOP853", rtol=1e-12, atol=1e-12,
                                  t_eval=t_eval).y
    return y[0], momentum / inertia(y[0])


@pytest.mark.parametrize("lift", [0.0, 0.2])
def test_the_governor_by_hand(lift):
    """In equilibrium, by the formula, and where it swings."""
    sol = zd.simulate(zd.models.flyball_governor(lift=lift), 1.0, t_eval=np.linspace(0, 1, 21), **EXACT)
    theta = np.arccos((2.0 + 5.0) * 9.81 / (2.0 * 0.25 * 14.0**2))
    expected, turning = governor_by_hand(theta, lift / (2 * 0.25 * np.sin(theta)), 14.0, sol.t)
    assert_close(sol["slide.displacement"], 0.5 * (np.cos(theta) - np.cos(expected)), 1e-9, scale=0.1)
    assert_close(sol["bearing.speed"], turning, 1e-8)
    assert (np.ptp(expected) > 0.01) == (lift > 0)


def test_a_governor_that_is_too_slow():
    with refused("out-of-range", "speed.*than 11.7192.*not 5"):
        zd.models.flyball_governor(speed=5.0)


def test_a_chain_that_falls_in_a_plane_is_one_of_the_plane():
    space, plane = zd.models.chain(5, length=2.0, coils=0.0), zd.Mechanism("chain", gravity=(0, -9.81))
    along, last = 0.4 * np.array([np.cos(0.3), -np.sin(0.3)]), plane.ground.point((0, 0))
    for i in range(5):
        J = 2.0 * 0.4**2 * (1 / 12 + 1 / 1600)
        link = plane.link(f"link {i}", i * along, (i + 1) * along, 2.0, inertia=J)
        plane.revolute(f"ball {i}", last, link.start)
        last = link.end
    one, other = (zd.simulate(m, 1.0, step=5e-3, integrator="dop853", save_every=20) for m in (space, plane))
    assert_close(one["link 4.end.position"][:, [0, 2]], other["link 4.end.position"], 1e-9)
    assert_close(one["ball 2.force"][:, [0, 2]], other["ball 2.force"], 1e-7)


def test_a_long_chain_keeps_its_energy_and_its_momentum():
    """About the vertical, about which it does not begin to turn as a whole."""
    sol = zd.simulate(zd.models.chain(1000), 0.05, step=1e-3, save_every=50)
    assert np.abs(sol.position_violation).max() < 1e-9
    assert np.abs(sol.energy_violation).max() < 1e-7 * sol.kinetic_energy[-1]
    x, v = sol.p[-1].reshape(1000, 7), sol.v[-1].reshape(1000, 6)
    own = v[:, 3:] * 0.01 * 0.01**2 * np.array([1e-2 / 8, 1 / 12 + 1e-2 / 16, 1 / 12 + 1e-2 / 16])
    turning = sum(rotation_of(q)[2] @ spin for q, spin in zip(x[:, 3:], own, strict=True))
    about = 0.01 * (x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0])
    assert abs(about.sum() + turning) < 1e-9 * np.abs(about).sum()


# ---- what all can do ----


@pytest.mark.parametrize("name", IN_SPACE)
def test_it_is_checked_drawn_pickled_and_says_what_it_is(name):
    m = IN_SPACE[name](**FEW.get(name, {}))
    assert m.dimension == 3
    assert m.name == name
    system = m.system()
    if system.nv < 50:      # else it takes seconds
        assert_right(system)
    points = system.points(system.p0)
    assert points.shape[1] == 3
    assert np.isfinite(points[~np.isnan(points).all(axis=1)]).all()
    again = pickle.loads(pickle.dumps(system))
    ends = [zd.simulate(each, 0.01, step=1e-3).p[-1] for each in (system, again)]
    assert np.array_equal(*ends)
    for section in ("Parameters", "Returns", "Examples"):
        assert f"\n{section}\n---" in inspect.getdoc(IN_SPACE[name])
    assert "References\n---" in inspect.getdoc(IN_SPACE[name])


@pytest.mark.parametrize("name", IN_SPACE)
def test_what_is_not_a_number_or_negative_is_named_by_its_argument(name):
    for argument in inspect.signature(IN_SPACE[name]).parameters:
        for wrong in ("much", np.nan, [1.0, 2.0], True):
            with pytest.raises((ValueError, TypeError), match=argument):
                IN_SPACE[name](**{argument: wrong})
        if argument.rpartition("_")[2] in ("mass", "inertia", "stiffness", "damping", "radius", "length", "arm", "crank", "rod"):
            with refused("out-of-range", argument):
                IN_SPACE[name](**{argument: -0.1})


@pytest.mark.parametrize("layout", ["absolute", "joint"])
def test_a_motion_in_space_has_a_certified_reference(layout):
    """Which compares it with one of a system whose terms are off by rounding, with angles that follow as well."""
    found = zd.reference(zd.models.bennett().system(layout), 0.05, error=1e-9)
    assert found.error <= 1e-9
    assert np.ptp(found.solution["B.angle"]) > 0.05
