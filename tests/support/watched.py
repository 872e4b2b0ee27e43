"""A pendulum in Python whose every call is watched, so that something may happen at any of them."""

import numpy as np

import zerodrift as zd


def pendulum(watch=lambda: None):
    """In Python, every callable of it watched."""
    def watched(function):
        def call(p, v):
            watch()
            return function(p, v)
        return call

    return zd.System(
        ["x", "y"], mass=watched(lambda p, v: np.eye(2)), force=watched(lambda p, v: np.array([0.0, -9.81])),
        bias=watched(lambda p, v: np.zeros(2)), constraints=watched(lambda p, v: np.array([p @ p - 1]) / 2),
        jacobian=watched(lambda p, v: p[None]), xi=watched(lambda p, v: -np.array([v @ v])),
        kinematics=watched(lambda p, v: np.eye(2)), potential=watched(lambda p, v: 9.81 * p[1]),
        power=watched(lambda p, v: 0.0), p0=[1.0, 0.0])


class At:
    """Does something when it is called the k-th time."""

    def __init__(self, k, action):
        self.k, self.action, self.calls = k, action, 0

    def __call__(self, *_):
        self.calls += 1
        if self.calls == self.k:
            self.action()


def throw(error):
    """A function that does."""
    def raise_it():
        raise error
    return raise_it
