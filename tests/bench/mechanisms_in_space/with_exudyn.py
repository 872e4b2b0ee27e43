"""Exudyn: rigid bodies and joints, with each kind of implicit integrator it has, dense and sparse.

What it cannot do: steps chosen by an error bound where there are constraints, and redundant rows, of which these mechanisms have
none. Its order is two. Bodies turn by Euler parameters.
"""

import exudyn as exu
import numpy as np
from exudyn import itemInterface
from exudyn.utilities import RigidBodyInertia

from exudyn_runs import solved

STEPS = (1, 2, 4, 8, 16, 32, 64, 128)      # between outputs
SOLVERS = {     # type, spectral radius, index 2, Newmark
    "generalized alpha": (exu.DynamicSolverType.GeneralizedAlpha, 0.9, False, False),
    "Newmark, index 2": (exu.DynamicSolverType.GeneralizedAlpha, 1.0, True, True),
}
ALGEBRA = {"dense": exu.LinearSolverType.EXUdense, "sparse": exu.LinearSolverType.EigenSparse}
HELD = {"revolute": [1, 1, 1, 1, 1, 0], "prismatic": [0, 1, 1, 1, 1, 1], "universal": [1, 1, 1, 0, 0, 1],
        "spherical": [1, 1, 1, 0, 0, 0]}       # displacements and rotations along the joint's axes

exu.config.printToConsole = False


def sweeps(drawing):
    """The settings of each method."""
    return {f"Exudyn {name}, {algebra}": [(name, algebra, k) for k in STEPS] for name in SOLVERS for algebra in ALGEBRA}


def solve(drawing, setting):
    """Positions and rotation matrices of the bodies, (k, n, 12), and time of the call of Exudyn's solver, s."""
    name, algebra, steps = setting
    mbs, sensors, seconds = solved(_build, drawing, SOLVERS[name], ALGEBRA[algebra], steps, drawing.count)
    placed = [np.hstack([mbs.GetSensorStoredData(place)[:, 1:4], mbs.GetSensorStoredData(turned)[:, 1:10]])
              for place, turned in sensors]
    return np.stack(placed, axis=1), seconds


def _build(mbs, drawing):
    """Bodies, joints, springs, and sensors of each body's place and rotation."""
    numbers, sensors = {None: mbs.AddObject(itemInterface.ObjectGround())}, []
    for body in drawing.bodies:
        inertia = RigidBodyInertia(mass=body.mass, inertiaTensor=body.inertia)
        made = mbs.CreateRigidBody(inertia=inertia, referencePosition=list(body.center), gravity=[0, 0, -drawing.gravity])
        numbers[body.name] = made
        sensors.append([mbs.AddSensor(itemInterface.SensorBody(bodyNumber=made, storeInternal=True, writeToFile=False,
                                                               outputVariableType=what))
                        for what in (exu.OutputVariableType.Position, exu.OutputVariableType.RotationMatrix)])

    def marker(name, place, kind=itemInterface.MarkerBodyRigid):
        return mbs.AddMarker(kind(bodyNumber=numbers[name], localPosition=list(place - drawing.center(name))))

    for joint in drawing.joints:
        frame = _frame(joint)
        ends = [marker(name, joint.at) for name in (joint.first, joint.second)]
        mbs.AddObject(itemInterface.GenericJoint(markerNumbers=ends, constrainedAxes=HELD[joint.kind], rotationMarker0=frame,
                                                 rotationMarker1=frame))
    for rod in drawing.rods:
        ends = [marker(rod.first, rod.tail, itemInterface.MarkerBodyPosition),
                marker(rod.second, rod.tip, itemInterface.MarkerBodyPosition)]
        mbs.AddObject(itemInterface.DistanceConstraint(markerNumbers=ends, distance=float(np.linalg.norm(rod.tip - rod.tail))))
    for spring in drawing.springs:
        ends = [marker(spring.first, spring.tail, itemInterface.MarkerBodyPosition),
                marker(spring.second, spring.tip, itemInterface.MarkerBodyPosition)]
        mbs.AddObject(itemInterface.SpringDamper(markerNumbers=ends, referenceLength=spring.length, stiffness=spring.stiffness,
                                                 damping=spring.damping))
    mbs.Assemble()
    return sensors


def _frame(joint):
    """The joint's axes: x along a slider, z along a hinge; of a universal the arms are x and y."""
    if joint.kind == "spherical":
        return np.eye(3)
    axis = joint.axes[0] / np.linalg.norm(joint.axes[0])
    side = joint.axes[1] if joint.kind == "universal" else np.cross(axis, np.eye(3)[int(np.argmin(np.abs(axis)))])
    side = side / np.linalg.norm(side)
    if joint.kind == "revolute":
        return np.stack([side, np.cross(axis, side), axis], axis=1)
    return np.stack([axis, side, np.cross(axis, side)], axis=1)
