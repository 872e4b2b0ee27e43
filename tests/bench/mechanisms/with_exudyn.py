"""Exudyn: planar rigid bodies and joints, with each kind of implicit integrator it has and its dense and sparse solvers.

They are the generalized-alpha method with constraints of index 3 and Newmark's with those of index 2, both with modified Newton
iterations. The trapezoidal rule of index 2 is Newmark's here.
"""

import exudyn as exu
import numpy as np
from drawings import Revolute
from exudyn import itemInterface

from exudyn_runs import solved

STEPS = (1, 2, 4, 8, 16, 32, 64, 128, 256)      # between outputs
SOLVERS = {     # type, spectral radius, index 2, Newmark
    "generalized alpha": (exu.DynamicSolverType.GeneralizedAlpha, 0.9, False, False),
    "Newmark, index 2": (exu.DynamicSolverType.GeneralizedAlpha, 1.0, True, True),
}
ALGEBRA = {"dense": exu.LinearSolverType.EXUdense, "sparse": exu.LinearSolverType.EigenSparse}

exu.config.printToConsole = False


def sweeps(drawing):
    """The settings of each method."""
    return {f"Exudyn {name}, {algebra}": [(name, algebra, k) for k in STEPS] for name in SOLVERS for algebra in ALGEBRA}


def solve(drawing, setting):
    """Displacements and rotations of the bodies, (k, n, 3), and time of the call of Exudyn's solver, s."""
    name, algebra, steps = setting
    mbs, sensors, seconds = solved(_build, drawing, SOLVERS[name], ALGEBRA[algebra], steps, drawing.count)
    return np.stack([mbs.GetSensorStoredData(sensor)[:, 1:4] for sensor in sensors], axis=1), seconds


def _build(mbs, drawing):
    """Bodies, joints, springs, loads, and a sensor of each body's coordinates, which count from the drawing."""
    ground, sensors, numbers = mbs.AddObject(itemInterface.ObjectGround()), [], {}
    centers = {None: np.zeros(2)}
    numbers[None] = ground
    for body in drawing.bodies:
        node = mbs.AddNode(itemInterface.NodeRigidBody2D(referenceCoordinates=[*body.center, 0.0]))
        numbers[body.name] = mbs.AddObject(itemInterface.ObjectRigidBody2D(nodeNumber=node, mass=body.mass, inertia=body.inertia))
        centers[body.name] = body.center
        sensors.append(mbs.AddSensor(itemInterface.SensorNode(nodeNumber=node, storeInternal=True, writeToFile=False,
                                                      outputVariableType=exu.OutputVariableType.Coordinates)))

    def marker(name, at, kind=itemInterface.MarkerBodyPosition):
        return mbs.AddMarker(kind(bodyNumber=numbers[name], localPosition=[*(at - centers[name]), 0.0]))

    for joint in drawing.joints:
        if isinstance(joint, Revolute):
            ends = [marker(joint.first, joint.at), marker(joint.second, joint.at)]
            mbs.AddObject(itemInterface.ObjectJointRevolute2D(markerNumbers=ends))
        else:
            at = centers[joint.second]
            ends = [marker(name, at, itemInterface.MarkerBodyRigid) for name in (None, joint.second)]
            mbs.AddObject(itemInterface.ObjectJointPrismatic2D(markerNumbers=ends))
    for spring in drawing.springs:
        ends = [marker(spring.first, spring.tail), marker(spring.second, spring.tip)]
        mbs.AddObject(itemInterface.ObjectConnectorSpringDamper(markerNumbers=ends, referenceLength=spring.length,
                                                        stiffness=spring.stiffness, damping=spring.damping))
    for body in drawing.bodies:
        middle = marker(body.name, body.center)
        mbs.AddLoad(itemInterface.LoadForceVector(markerNumber=middle, loadVector=[0, -drawing.gravity * body.mass, 0]))
    for name, moment in drawing.torques.items():
        middle = marker(name, centers[name], itemInterface.MarkerBodyRigid)
        mbs.AddLoad(itemInterface.LoadTorqueVector(markerNumber=middle, loadVector=[0, 0, moment]))
    mbs.Assemble()
    return sensors
