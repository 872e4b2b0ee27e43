"""Random mechanisms against a model in plain NumPy: motion, and every reaction that is determined."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import zerodrift as zd
from covering import draws
from mechanisms.plain_mechanics import Model
from mechanisms.random_mechanisms import Maker

SECONDS = 0.2
FIXED = {"step": 5e-4, "save_every": 100}
CHOSEN = {"rtol": 1e-11, "atol": 1e-12, "t_eval": np.linspace(0.0, SECONDS, 5)}     # as the independent model chooses its steps
MOTION = 1e-7       # both integrate to 1e-10 and better, and motions of linkages multiply that
REACTION = 1e-7     # of the largest: solved from matrices of a condition up to 1e6


def poses(sol, maker):
    """The mass centres' poses (k, n) and their rates, from measures."""
    q, v = [], []
    for body in maker.bodies:
        angle, turning = sol[body.angle], sol[body.angular_velocity]
        c, s = np.cos(angle), np.sin(angle)
        com = body.center.local
        arm = np.stack([c * com[0] - s * com[1], s * com[0] + c * com[1]], axis=1)
        q += [*(sol[body.position] + arm).T, angle]
        v += [*(sol[body.velocity] + turning[:, None] * np.stack([-arm[:, 1], arm[:, 0]], axis=1)).T, turning]
    return np.array(q).T, np.array(v).T


def compare(seed, layout, formulation="augmented", steps=FIXED):
    """The largest difference in motion, and in determined reactions, of one random mechanism.

    Steps of fixed size have no control of their error: a linkage that whirls or passes a singular pose may need shorter ones.
    Whether a difference is that, and no other, is seen with steps that are chosen.
    """
    maker = Maker(seed)
    maker.start()
    model = Model(maker.d)
    sol = zd.simulate(maker.m.system(layout), SECONDS, integrator="dop853", formulation=formulation, **steps)
    q, v = poses(sol, maker)
    n = q.shape[1]

    def rate(t, y):
        return np.concatenate([y[n:], model.solve(t, y[:n], y[n:])[0]])

    exact = solve_ivp(rate, (0, SECONDS), np.concatenate([q[0], v[0]]), method="DOP853", rtol=1e-11, atol=1e-12)
    size = max(1.0, np.abs(v).max())
    motion = max(np.abs(q[-1] - exact.y[:n, -1]).max(), np.abs(v[-1] - exact.y[n:, -1]).max()) / size
    reaction = 0.0
    for i, joint in enumerate(maker.joints):
        for name, pick in ((f"{joint.name}.force", 0), (f"{joint.name}.torque", 1)):
            if name not in sol.system.measures:
                continue
            unique, ours = np.atleast_1d(sol.unique(name)), sol[name].reshape(len(sol.t), -1)
            for k, t in enumerate(sol.t):
                _, multipliers, C, owners = model.solve(t, q[k], v[k])
                told = np.atleast_1d(model.reaction(i, q[k], C, owners, multipliers, model.forces(t, q[k], v[k])[1])[pick])
                scale = max(1.0, np.abs(C * multipliers[:, None]).max(initial=0.0))
                reaction = max(reaction, np.abs((told - ours[k])[unique]).max(initial=0.0) / scale)
    return motion, reaction


def test_what_fixed_steps_do_not_resolve_is_warned_of():
    """A fast mechanism that is nearly singular as it starts: fixed steps are 6 % off and warn of it, chosen ones agree."""
    maker = Maker(948)
    maker.start()
    with pytest.warns(zd.AccuracyWarning, match="energy balance is off"):
        zd.simulate(maker.m.system("joint"), SECONDS, integrator="dop853", **FIXED)
    motion, reaction = compare(948, "joint", steps=CHOSEN)
    assert motion < MOTION
    assert reaction < REACTION


@pytest.mark.parametrize("seed", range(draws(8, 24)))
def test_random_mechanisms(seed):
    layout = ("joint", "absolute")[seed % 2]
    motion, reaction = compare(seed, layout)
    assert motion < MOTION
    assert reaction < REACTION
