"""Mechanisms in space as tables of the core, without `zd.Mechanism`: random ones, and ones with exactly known motions."""

import numpy as np
from scipy.spatial.transform import Rotation

from zerodrift._private.gateway.mechanisms.space import joint_kinds

KINDS = joint_kinds()


def random_frame(rng):
    """Three directions, right-handed."""
    return tuple(map(tuple, Rotation.random(random_state=rng).as_matrix()))


def shape_of(frame, semiaxes):
    """Shape matrix of an ellipsoid with these semiaxes along the rows of a frame, (3, 3) m^2."""
    D = np.array(frame).T * semiaxes
    return tuple(map(tuple, D @ D.T))


def unit(rng):
    vector = rng.normal(size=3)
    return tuple(vector / np.linalg.norm(vector))


def random_state(core, rng):
    """Anywhere, with any velocities: p (nq,), v (nv,)."""
    poses = [[*rng.normal(size=3), *Rotation.random(random_state=rng).as_quat(scalar_first=True)] for _ in core.tables.bodies]
    return core.state(np.array(poses))[0], rng.normal(size=core.nv)


def exactly_moved(core, p, step):
    """Positions after a motion (nv,) of constant velocities: along straight lines, and about axes of the bodies' own."""
    poses, rates = core.poses(p, step)
    turned = Rotation.from_quat(poses[:, 3:], scalar_first=True) * Rotation.from_rotvec(rates[:, 3:])
    q = turned.as_quat(scalar_first=True)
    q *= np.where((q * poses[:, 3:]).sum(axis=1) < 0, -1.0, 1.0)[:, None]
    return core.state(np.hstack([poses[:, :3] + rates[:, :3], q]), angles=core.angles(p))[0]
