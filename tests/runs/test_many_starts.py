"""Starts of many open runs by values of measures."""

import numpy as np
import pytest

import zerodrift as zd
from support import refused


def four_bar():
    m = zd.models.four_bar()
    for motor in m.motors:
        m.remove(motor)
    return m


@pytest.mark.parametrize("coordinates", ["joint", "absolute"])
def test_runs_start_as_assembled_individually(coordinates):
    m = four_bar()
    system = m.system(coordinates)
    runs = zd.ManyRuns(system, runs=5, step=1e-3)
    runs.step(10)
    before, where = runs.p.copy(), np.array([True, False, True, True, False])
    angles, speed = np.array([1.2, 1.4, 1.7]), np.array([0.5, 0.0, -0.3])
    runs.reset(start={"crank.angle": angles, "crank.angular_velocity": speed}, where=where)
    assert np.array_equal(runs.p[~where], before[~where])
    for i, angle, rate in zip(np.flatnonzero(where), angles, speed, strict=True):
        p, v = zd.assemble(system, {"crank.angle": angle, "crank.angular_velocity": rate})
        assert runs.p[i] == pytest.approx(p, abs=1e-12)
        assert runs.v[i] == pytest.approx(v, abs=1e-12)
    runs.reset(start={"crank.angle": 1.3})
    assert runs["crank.angle"] == pytest.approx(np.full(5, 1.3))


def test_vectors_and_drives_of_constant_speed():
    m = zd.models.slider_crank()
    stone = m.particle("stone", 1.0, at=(2, 2))
    runs = zd.ManyRuns(m, runs=3, step=1e-3)
    places = np.array([[1.0, 2.0], [3.0, 4.0], [5.0, 6.0]])
    runs.reset(start={stone.position: places, "stone.velocity": (1.0, 0.0), "crank.angle": [0.1, 0.2, 0.3]})
    assert runs["stone.position"] == pytest.approx(places)
    assert runs["stone.velocity"] == pytest.approx(np.tile([1.0, 0.0], (3, 1)))
    assert runs["crank.angle"] == pytest.approx([0.1, 0.2, 0.3])


def test_wrong_starts():
    runs = zd.ManyRuns(four_bar(), runs=3, step=1e-3)
    with refused("shape", "crank.angle"):
        runs.reset(start={"crank.angle": [1.2, 1.3]})
    with refused("conflicting-arguments", "start"):
        runs.reset(runs.p[0], start={"crank.angle": 1.2})
    with refused("wrong-type", "dict"):
        runs.reset(start=1.2)
    with pytest.raises(zd.InconsistentStart):
        runs.reset(start={"rocker.angle": 0.0, "crank.angle": 3.0})
