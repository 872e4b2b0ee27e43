"""Methods of `Mechanism` made from the core's tables. `table_verbs.pyi` declares them for editors and type checkers.

A kind of joint or force element that is added to a table has its method here. Handwritten, in `joint_verbs` and `force_verbs`,
are only those whose arguments no entry of a table describes:

* `rolling`: in space the body is given by a radius, a radius and an axle, or semiaxes, and must touch the plane as drawn.
* `force`: its value may be a vector, which has the direction as well; it acts in the frame of a third body.
* `torque`: it acts on one body, and against the ground, another body, or nothing, with an axis of a third one.
* `motor`, `actuator`: not kinds of elements; the argument that is given makes a constraint or a force of them.
"""

from __future__ import annotations

from ..._private.verbs import verb as named
from ..elements.forces import Bushing, Spring, TorsionSpring
from ..elements.joints import BY_ROW, Joint, KnifeEdge, Prismatic, Revolute, Rod, Slot, Weld
from ..elements.space_joints import BY_KIND
from ..elements.table_forces import FORCES_OF_TABLE, TableForce
from .registry import Elements
from .table_force_verbs import force_verb
from .table_joint_verbs import verb

BY_HAND = ("rolling",)
PLANE: dict[str, type[Joint]] = {joint.kind: joint for joint in (Revolute, Prismatic, Weld, Rod, Slot, KnifeEdge)} | BY_ROW
JOINTS = tuple(kind for kind in dict.fromkeys((*PLANE, *BY_KIND)) if kind not in BY_HAND)
FORCES: dict[str, type[TableForce]] = {force.kind: force for force in (Spring, TorsionSpring, Bushing)} | FORCES_OF_TABLE


class TableVerbs(Elements):
    """Joints and force elements by kind."""


for _kind in JOINTS:
    setattr(TableVerbs, _kind, named(verb(PLANE.get(_kind), BY_KIND.get(_kind))))
for _kind, _force in FORCES.items():
    setattr(TableVerbs, _kind, named(force_verb(_force)))
