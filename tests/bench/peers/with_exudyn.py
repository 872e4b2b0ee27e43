"""Exudyn: planar rigid bodies and revolute joints, with each kind of integrator it has.

The implicit ones are the trapezoidal rule with constraints of index 2, the generalized-alpha method with constraints of index 3
and Newmark's with those of index 2, all with modified Newton iterations and the dense solver. The explicit ones are run as well.
"""

import exudyn as exu
import numpy as np
from exudyn import itemInterface
from problems import GRAVITY

from exudyn_runs import solved

STEPS = (2, 4, 8, 16, 32, 64, 128, 256)     # between outputs
SOLVERS = {     # type, spectral radius, index 2, Newmark
    "trapezoidal, index 2": (exu.DynamicSolverType.TrapezoidalIndex2, 1.0, True, True),
    "generalized alpha": (exu.DynamicSolverType.GeneralizedAlpha, 0.9, False, False),
    "Newmark, index 2": (exu.DynamicSolverType.GeneralizedAlpha, 1.0, True, True),
    "RK44": (exu.DynamicSolverType.RK44, 1.0, False, False),
}

exu.config.printToConsole = False


def sweeps(chain):
    """The settings of each method."""
    return {f"Exudyn {name}": [(name, k) for k in (STEPS if name != "RK44" else STEPS[4:5])] for name in SOLVERS}


def solve(chain, setting):
    """Angles (k, n) at the outputs, and seconds of the call of its solver."""
    name, steps = setting
    mbs, sensors, seconds = solved(_build, chain, SOLVERS[name], exu.LinearSolverType.EXUdense, steps, len(chain.outputs) - 1)
    return np.stack([mbs.GetSensorStoredData(sensor)[:, 3] for sensor in sensors], axis=1), seconds


def _build(mbs, chain):
    """The bodies, their joints and a sensor of each angle; the coordinates are those of the midpoints and the angles."""
    ground, sensors = mbs.AddObject(itemInterface.ObjectGround()), []
    before = mbs.AddMarker(itemInterface.MarkerBodyPosition(bodyNumber=ground))
    across = np.stack([-np.sin(chain.p0), np.cos(chain.p0)], axis=1) * (chain.lengths * chain.v0)[:, None]
    places, rates = chain.midpoints(chain.p0), across.cumsum(axis=0) - across / 2
    for i, length in enumerate(chain.lengths):
        node = mbs.AddNode(itemInterface.NodeRigidBody2D(initialCoordinates=[*places[i], chain.p0[i]],
                                                 initialVelocities=[*rates[i], chain.v0[i]]))
        body = mbs.AddObject(itemInterface.ObjectRigidBody2D(nodeNumber=node, mass=chain.masses[i],
                                                     inertia=chain.inertias[i]))
        middle, inner, outer = (mbs.AddMarker(itemInterface.MarkerBodyPosition(bodyNumber=body, localPosition=[x, 0, 0]))
                                for x in (0, -length / 2, length / 2))
        mbs.AddLoad(itemInterface.LoadForceVector(markerNumber=middle, loadVector=[0, -GRAVITY * chain.masses[i], 0]))
        mbs.AddObject(itemInterface.ObjectJointRevolute2D(markerNumbers=[before, inner]))
        sensors.append(mbs.AddSensor(itemInterface.SensorNode(nodeNumber=node, storeInternal=True, writeToFile=False,
                                                      outputVariableType=exu.OutputVariableType.Coordinates)))
        before = outer
    end = mbs.AddMarker(itemInterface.MarkerBodyPosition(bodyNumber=ground, localPosition=[chain.distance, 0, 0]))
    mbs.AddObject(itemInterface.ObjectJointRevolute2D(markerNumbers=[before, end]))
    mbs.Assemble()
    return sensors
