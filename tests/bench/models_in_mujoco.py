"""Mechanisms as models of MuJoCo: bodies, joints, loops and springs as drawn; other forces are left out, motors are servos.

A tree of joints comes first, in an order that leaves hinges and balls to close loops, which `connect` closes, twice along the
axis of a hinge in space. A rod is a tendon whose length an equality keeps. Rolling, knife edges, cams, gears and constraints of
the user's own have no counterpart.
"""

import mujoco
import numpy as np

AXES = np.eye(3)
KINDS = {       # in the order in which joints enter the tree
    "Slot": (("slide", 0), ("hinge", 2)), "Prismatic": (("slide", 0),), "SpacePrismatic": (("slide", 0),),
    "SpaceCylindrical": (("slide", 0), ("hinge", 0)), "SpaceUniversal": (("hinge", 0), ("hinge", 1)), "Revolute": (("hinge", 2),),
    "SpaceRevolute": (("hinge", 0),), "SpaceSpherical": (("ball", 0),),
}
WITHOUT = ("KnifeEdge", "SpaceRolling", "Coupling")     # elements that MuJoCo lacks


def in_space(vector):
    """A vector of the plane or of space in space."""
    return np.append(vector, 0.0) if len(vector) == 2 else np.asarray(vector, float)


def rotation(body):
    """Matrix of a drawn body."""
    if hasattr(body.pose, "rotation"):
        return body.pose.rotation
    c, s = np.cos(body.pose.angle), np.sin(body.pose.angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def place(point):
    """Place of a point of a body in the drawing."""
    return in_space(point.body.pose.origin) + rotation(point.body) @ in_space(point._local)


def axis(joint, number):
    """Axis of a joint in the drawing: of its first body, or, of the second of a universal joint, of its second one."""
    if hasattr(joint, "frames"):
        frame, body = (joint.frames[number], (joint.first.body, joint.second.body)[number])
        return rotation(body) @ frame[:, number]
    return AXES[2] if number == 2 else rotation(joint.first.body) @ in_space(AXES[0][:2] if joint.axis is None else joint.axis)


def vector(values):
    """Numbers of an attribute."""
    return " ".join(repr(float(each)) for each in values)


class Model:
    """The text of a model, from the elements of a drawing."""

    def __init__(self, drawing):
        self.elements = drawing.elements.values()
        self.bodies = [each for each in self.elements if hasattr(each, "pose")]
        joints = [each for each in self.elements if type(each).__name__ in KINDS]
        joints.sort(key=lambda joint: list(KINDS).index(type(joint).__name__))
        self.tree, self.closing = self._tree(joints)
        self.equalities, self.tendons, self.sites = [], [], {body.name: [] for body in self.bodies}
        self.done = []      # names of bodies that are in the text
        self.gravity = in_space(drawing.gravity)

    def _tree(self, joints):
        """Joints of the tree and those that close loops."""
        root, tree, closing = {body.name: body.name for body in self.bodies}, [], []

        def top(name):
            while root[name] != name:
                name = root[name]
            return name

        for joint in joints:
            ends = [top(point.body.name) for point in (joint.first, joint.second)]
            (closing if ends[0] == ends[1] else tree).append(joint)
            root[ends[1]] = ends[0]
        return tree, closing

    def text(self):
        """XML of the model; frames of bodies stand as drawn."""
        world = self._below(self.bodies[0], np.zeros(3), np.eye(3))
        for body in self.bodies:        # what no joint reaches is free
            if body.name not in self.done and not getattr(body, "attachment", None):
                world += self._body(body, "<freejoint/>", np.zeros(3), np.eye(3))
        for joint in self.closing:
            self._close(joint)
        for each in self.elements:
            kind = type(each).__name__
            if kind == "SpaceRod" or (kind == "Spring" and each.law is None):
                self._tendon(each, stiff=kind == "Spring")
        return f"""<mujoco><compiler angle="radian" balanceinertia="true" autolimits="true"/>
          <option gravity="{vector(self.gravity)}"><flag contact="disable"/></option>
          <worldbody>{self._with_sites(world)}</worldbody><tendon>{"".join(self.tendons)}</tendon>
          <equality>{"".join(self.equalities)}</equality><actuator>{self._servos()}</actuator></mujoco>"""

    def _below(self, body, origin, turned):
        """Sites and branches of a body whose frame is drawn there."""
        self.done.append(body.name)
        text = f"@{body.name}@"
        for each in self.tree:
            ends = each.first.body, each.second.body
            other = ends[body is ends[0]]
            if body in ends and other.name not in self.done:
                text += self._body(other, self._joints(each, other), origin, turned)
        for each in self.bodies:
            if getattr(each, "attachment", None) and each.attachment.body is body and each.name not in self.done:
                text += self._body(each, "", origin, turned)
        return text

    def _body(self, body, joints, origin, turned):
        """A body in a frame that is drawn at `origin`, with its branches; without inertia it has a billionth of its mass."""
        own, at = rotation(body), in_space(body.pose.origin)
        inertia, mass = np.asarray(body.inertia, float), max(body.mass, 1e-6)
        moments, axes = np.linalg.eigh((inertia if inertia.ndim == 2 else inertia * np.eye(3)) + 1e-9 * mass * np.eye(3))
        axes[:, 2] *= np.sign(np.linalg.det(axes))
        return (f'<body name="{body.name}" pos="{vector(turned.T @ (at - origin))}" quat="{vector(quaternion(turned.T @ own))}">'
                f'{joints}<inertial mass="{mass!r}" pos="{vector(in_space(body._com))}" diaginertia="{vector(moments)}" '
                f'quat="{vector(quaternion(axes))}"/>{self._below(body, at, own)}</body>')

    def _joints(self, joint, body):
        own, at = rotation(body), in_space(body.pose.origin)
        pos, damping = own.T @ (place(joint.first) - at), f' damping="{joint.damping!r}"' if joint.damping else ""
        return "".join(f'<joint name="{joint.name}{i or ""}" type="{kind}" pos="{vector(pos)}"{damping}'
                       + ("" if kind == "ball" else f' axis="{vector(own.T @ axis(joint, number))}"') + "/>"
                       for i, (kind, number) in enumerate(KINDS[type(joint).__name__]))

    def _close(self, joint):
        at, along = place(joint.first), [np.zeros(3)]
        if type(joint).__name__ == "SpaceRevolute":
            along.append(0.1 * axis(joint, 0))
        for each in along:
            names = []
            for point in (joint.first, joint.second):
                own, origin = rotation(point.body), in_space(point.body.pose.origin)
                names.append(self._site(point.body, own.T @ (at + each - origin)))
            self.equalities.append(f'<connect site1="{names[0]}" site2="{names[1]}"/>')

    def _tendon(self, element, *, stiff):
        sites = [self._site(point.body, in_space(point._local)) for point in (element.first, element.second)]
        name = f"tendon {element.name}"
        rest = {"springlength": element.free_length, "stiffness": element.stiffness, "damping": element.damping} if stiff else {}
        given = " ".join(f'{key}="{float(value)!r}"' for key, value in rest.items())
        self.tendons.append(f'<spatial name="{name}" {given}><site site="{sites[0]}"/><site site="{sites[1]}"/></spatial>')
        if not stiff:
            self.equalities.append(f'<tendon tendon1="{name}" />')

    def _site(self, body, local):
        sites = self.sites[body.name]
        sites.append(f'<site name="{body.name} {len(sites)}" pos="{vector(local)}"/>')
        return f"{body.name} {len(sites) - 1}"

    def _with_sites(self, world):
        for name, sites in self.sites.items():
            world = world.replace(f"@{name}@", "".join(sites))
        return world

    def _servos(self):
        names = {joint.name for joint in self.tree}
        return "".join(f'<velocity joint="{each.joint.name}" kv="1"/>' for each in self.elements
                       if type(each).__name__ == "Motor" and each.joint.name in names)


def quaternion(R):
    """Unit quaternion (w, x, y, z) of a rotation matrix."""
    found = np.zeros(4)
    mujoco.mju_mat2Quat(found, np.ascontiguousarray(R).ravel())
    return found


def described(m):
    """XML of a mechanism; None: it has elements that MuJoCo lacks."""
    drawing = m._drawing()
    lacks = any(type(each).__name__ in WITHOUT for each in drawing.elements.values())
    return None if lacks else Model(drawing).text()
