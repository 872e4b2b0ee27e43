"""Methods of `Mechanism` made from the core's tables. `table_verbs.pyi` declares them for editors and type checkers.

A kind of joint or force element that is added to a table has its method here. Handwritten, in `joint_verbs` and `force_verbs`,
are only those whose arguments no entry of a table describes.
"""

from __future__ import annotations

from ..elements.forces import Spring
from ..elements.joints import BY_ROW, Joint, Prismatic, Revolute, Rod, Weld
from ..elements.space_joints import BY_KIND
from ..elements.table_forces import FORCES_BY_ROW, made_force
from .registry import Elements
from .table_force_verbs import force_verb
from .table_joint_verbs import verb

BY_HAND = ("slot", "rolling", "knife_edge")
PLANE: dict[str, type[Joint]] = {joint.kind: joint for joint in (Revolute, Prismatic, Weld, Rod)} | BY_ROW
JOINTS = tuple(kind for kind in dict.fromkeys((*PLANE, *BY_KIND)) if kind not in BY_HAND)


class TableVerbs(Elements):
    """Joints and force elements by kind."""


for _kind in JOINTS:
    setattr(TableVerbs, _kind, verb(PLANE.get(_kind), BY_KIND.get(_kind)))
setattr(TableVerbs, Spring.kind, force_verb(made_force(Spring.kind), Spring.from_values))
for _kind, _force in FORCES_BY_ROW.items():
    setattr(TableVerbs, _kind, force_verb(_force))
