"""Random plane scenes with contacts, stops and dry friction, by seed: as data, as mechanisms, and both answers compared."""

import math
import time
import warnings

import numpy as np

import zerodrift as zd
from contact.moreau import GROUND, Body, Pin, Scene, Slider, rows, simulate
from contact.random_shapes import SHAPED
from contact.shapes import Contact

END = 1.0               # s
SAMPLES = np.linspace(0, END, 51)
STEP = 2e-3             # s: of time stepping, where nothing happens
FINEST = 2.0**-14       # part of it, where a contact closes
PARTED = 1e-3           # m, rad: difference of its answers at h and h / 2, up to which the answers are compared
FACTOR, FLOOR = 5.0, 2e-5       # of the error: that difference, and what both have alike
FORMULATIONS = (None, "augmented", "nullspace", "schur", "mixed", "independent")
SCALES = ((1.0, 1.0), (30.0, 1e3), (1.0, 1.0), (0.01, 1e-3), (1.0, 1.0), (1e3, 1.0))
SLOW = 20.0             # s of a run
AT_ONCE = 0.1           # s


# ---- scenes ----

class Draw:
    """Random numbers of a scene, with one restitution and one friction, or others for each contact."""

    def __init__(self, seed):
        self.random = np.random.default_rng(seed)
        self.e, self.mu = self._law()
        self.is_alike = self.random.random() < 0.8

    def _law(self):
        e, mu = self.between(0.1, 0.9), self.between(0.05, 1.0)
        return (0.0, e)[self.chance(0.5)], (0.0, mu)[self.chance(0.6)]

    def between(self, low, high):
        return float(self.random.uniform(low, high))

    def chance(self, share):
        return bool(self.random.random() < share)

    def whole(self, low, high):
        return int(self.random.integers(low, high + 1))

    def contact(self, body, point, line=GROUND, start=(0.0, 0.0), angle=0.0, radius=0.0):
        e, mu = (self.e, self.mu) if self.is_alike else (self._law()[0], self._law()[1])
        return Contact(body, point, line, start, angle, radius, e, mu)

    def lines(self):
        """A floor, level or inclined, and perhaps a wall or a slope: (start, angle)."""
        floor = ((0.0, 0.0), (0.0, self.between(-0.4, 0.4))[self.chance(0.5)])
        wall = ((-1.0, 0.0), self.between(-math.pi / 2, -0.5))
        return [floor, wall][:1 + self.chance(0.5)]

    def speed(self, largest=2.0):
        return tuple(self.between(-largest, largest) for _ in range(2))


def _particles(d):
    lines = d.lines()
    bodies = [Body(d.between(0.2, 2), 0.0, (d.between(-0.4, 1), d.between(0.5, 1.2), 0.0), (*d.speed(), 0.0))
              for _ in range(d.whole(1, 3))]
    return bodies, [d.contact(i, (0, 0), GROUND, *line) for i in range(len(bodies)) for line in lines], []


def _box_size(d):
    a, b, mass = d.between(0.1, 0.4), d.between(0.1, 0.4), d.between(0.5, 2)
    return a, b, mass, mass * (a * a + b * b) / 3


def _box(d):
    a, b, mass, inertia = _box_size(d)
    corners = [(-a, -b), (a, -b), (a, b), (-a, b)]
    turned = (0.0, d.between(-1, 1))[d.chance(0.8)]
    body = Body(mass, inertia, (d.between(-0.3, 0.3), d.between(0.65, 1), turned), (*d.speed(), d.between(-3, 3) * bool(turned)))
    lines = d.lines()
    if len(lines) == 2:
        corners = corners[:3]
    return [body], [d.contact(0, corner, GROUND, *line) for corner in corners for line in lines], []


def _discs(d):
    lines, bodies, contacts = d.lines(), [], []
    for i in range(d.whole(1, 3)):
        radius, mass = d.between(0.05, 0.3), d.between(0.3, 2)
        bodies.append(Body(mass, mass * radius * radius * d.between(0.3, 1), (d.between(-0.2, 1), d.between(0.8, 1.3), 0.0),
                           (*d.speed(), d.between(-10, 10))))
        contacts += [d.contact(i, (0, 0), GROUND, *line, radius) for line in lines]
    return bodies, contacts, []


def _double_pendulum(d):
    l1, l2, a1, a2, w1, w2 = (d.between(*limits) for limits in ((0.3, 0.7), (-1.4, 1.4), (-3, 3)) for _ in "12")
    x, y, top = math.cos(a1) * l1, math.sin(a1) * l1, 1.5
    c, s = math.cos(a2) * l2 / 2, math.sin(a2) * l2 / 2
    m1, m2 = d.between(0.3, 2), d.between(0.3, 2)
    bodies = [Body(m1, m1 * l1 * l1 / 12, (x / 2, top + y / 2, a1), (-y * w1 / 2, x * w1 / 2, w1)),
              Body(m2, m2 * l2 * l2 / 12, (x + c, top + y + s, a2), (-y * w1 - s * w2, x * w1 + c * w2, w2))]
    dry = d.between(0.1, 1) if d.chance(0.3) else 0.0
    joints = [Pin(GROUND, (0, top), 0, (-l1 / 2, 0), dry), Pin(0, (l1 / 2, 0), 1, (-l2 / 2, 0))]
    if d.chance(0.3):
        joints[1] = joints[1]._replace(lower=a2 - a1 - d.between(0.1, 1), upper=a2 - a1 + d.between(0.1, 1), e=d.e)
    tip = d.contact(1, (l2 / 2, 0), GROUND, (-0.2, 0), -math.pi / 2)
    elbow = d.contact(0, (l1 / 2, 0), GROUND, (-0.15, 0), -math.pi / 2)
    floor = d.contact(1, (l2 / 2, 0), GROUND, (0, top - d.between(0.6, 0.95) * (l1 + l2)), 0.0)
    return bodies, [tip, elbow, floor][:d.whole(1, 3)], joints


def _slider(d):
    tilt, mass, dry = (0.0, d.between(-0.5, 0.5))[d.chance(0.5)], d.between(0.3, 2), d.between(0.5, 4) if d.chance(0.4) else 0.0
    u = d.between(-3, 3)
    bodies = [Body(mass, 0.1, (0.0, 0.0, 0.0), (u * math.cos(tilt), u * math.sin(tilt), 0.0))]
    limits = {"lower": -d.between(0.05, 0.4), "upper": d.between(0.05, 0.4)}
    joints = [Slider(GROUND, (0, 0), tilt, 0, dry, **limits, e=d.e)]
    contacts = []
    if d.chance(0.7):
        length, a, w, m = d.between(0.3, 0.8), d.between(-3, 0), d.between(-4, 4), d.between(0.2, 1)
        x, y = math.cos(a) * length / 2, math.sin(a) * length / 2
        v = bodies[0].v
        bodies.append(Body(m, m * length * length / 12, (x, y, a), (v[0] - y * w, v[1] + x * w, w)))
        pin = Pin(0, (0, 0), 1, (-length / 2, 0), d.between(0.05, 0.5) if d.chance(0.3) else 0.0)
        if d.chance(0.4):
            pin = pin._replace(lower=a - d.between(0.2, 1), upper=a + d.between(0.2, 1), e=d.e)
        joints.append(pin)
        if d.chance(0.5):
            contacts.append(d.contact(1, (length / 2, 0), GROUND, (0, min(-0.6 * length, 2 * y - 0.02)), 0.0))
    return bodies, contacts, joints


def _incline(d):
    a, b, mass, inertia = _box_size(d)
    tilt, push = d.between(-0.7, 0.7), d.between(-2, 2) if d.chance(0.5) else 0.0
    c, s = math.cos(tilt), math.sin(tilt)
    body = Body(mass, inertia, (-s * b, c * b, tilt), (push * c, push * s, 0.0))
    feet = [-a, a] if d.chance(0.6) else [-a, d.between(-a / 2, a / 2), a]
    return [body], [d.contact(0, (x, -b), GROUND, (0, 0), tilt) for x in feet], []


def _plank(d):
    half, mass = d.between(0.5, 1), d.between(1, 3)
    tilt, high = d.between(-0.3, 0.3), 0.6
    c, s = math.cos(tilt), math.sin(tilt)
    bodies = [Body(mass, mass * half * half / 3, (0.0, high, tilt), (0.0, 0.0, 0.0))]
    joints = [Pin(GROUND, (0, high), 0, (0, 0), d.between(0.2, 2) if d.chance(0.3) else 0.0)]
    contacts = [d.contact(0, (x, 0), GROUND, (0, high - half * d.between(0.35, 0.9)), 0.0) for x in (-half, half)]
    for _ in range(d.whole(1, 2)):
        radius = d.between(0.05, 0.2) if d.chance(0.5) else 0.0
        at, above, m = d.between(-0.6, 0.6) * half, radius + (0.0, d.between(0.05, 0.5))[d.chance(0.6)], d.between(0.2, 1.5)
        rests = above == radius
        bodies.append(Body(m, m * radius * radius / 2, (at * c - above * s, high + at * s + above * c, 0.0),
                           (0.0, 0.0, 0.0) if rests else (*d.speed(1.0), 0.0)))
        contacts.append(d.contact(len(bodies) - 1, (0, 0), 0, (0.0, 0.0), 0.0, radius))
    return bodies, contacts, joints


def _on_a_block(d):
    a, b, mass, inertia = _box_size(d)
    above, push = (0.0, d.between(0.01, 0.3))[d.chance(0.5)], d.between(-2, 2)
    bodies = [Body(mass, inertia, (0.0, b + above, 0.0), (push, 0.0, 0.0))]
    contacts = [d.contact(0, (x, -b)) for x in (-a, a)]
    for _ in range(d.whole(1, 2)):
        radius, m = d.between(0.03, 0.15) if d.chance(0.5) else 0.0, d.between(0.1, 1.5)
        over = radius + (0.0, d.between(0.05, 0.4))[d.chance(0.6)]
        x, speed = d.between(-0.9, 0.9) * a, d.between(-1, 1)
        bodies.append(Body(m, m * radius * radius / 2, (x, 2 * b + above + over, 0.0), (speed, 0.0, 0.0)))
        contacts.append(d.contact(len(bodies) - 1, (0, 0), 0, (0.0, b), 0.0, radius))
    return bodies, contacts, []


def _bar(d):
    half, mass, turned = d.between(0.2, 0.6), d.between(0.3, 2), d.between(-1.2, 1.2)
    body = Body(mass, mass * half * half / 3, (d.between(0.0, 0.4), d.between(0.62, 1), turned), (*d.speed(), d.between(-4, 4)))
    return [body], [d.contact(0, (x, 0), GROUND, *line) for x in (-half, half) for line in d.lines()], []


def _slider_crank(d):
    r, length, a = d.between(0.15, 0.3), d.between(0.5, 0.9), d.between(-3, 3)
    x, y = r * math.cos(a), r * math.sin(a)
    b = math.asin(-y / length)
    end = x + length * math.cos(b)
    m1, m2, m3 = (d.between(0.3, 2) for _ in "123")
    bodies = [Body(m1, m1 * r * r / 12, (x / 2, y / 2, a), (0.0, 0.0, 0.0)),
              Body(m2, m2 * length * length / 12, ((x + end) / 2, y / 2, b), (0.0, 0.0, 0.0)),
              Body(m3, 0.05, (end, 0.0, 0.0), (0.0, 0.0, 0.0))]
    slider = Slider(GROUND, (0, 0), 0.0, 2, d.between(0.3, 2) if d.chance(0.4) else 0.0)
    if d.chance(0.7):
        slider = slider._replace(lower=end - d.between(0.02, 0.2), e=d.e)
    if d.chance(0.5):
        slider = slider._replace(upper=end + d.between(0.02, 0.2), e=d.e)
    joints = [Pin(GROUND, (0, 0), 0, (-r / 2, 0)), Pin(0, (r / 2, 0), 1, (-length / 2, 0)), Pin(1, (length / 2, 0), 2, (0, 0)),
              slider]
    floor = min(y, 0) - d.between(0.01, 0.1)
    return bodies, [d.contact(0, (r / 2, 0), GROUND, (0, floor), 0.0)] * (floor > -r or d.chance(0.3)), joints


KINDS = (_particles, _box, _discs, _double_pendulum, _slider, _incline, _plank, _on_a_block, _bar, _slider_crank)
LINES = 1000            # seeds of scenes without other shapes; later ones have them
MAX_CONTACTS = 6


def kind_of(seed):
    """Function that draws the scene of a seed."""
    return KINDS[seed % len(KINDS)] if seed < LINES else SHAPED[seed % len(SHAPED)]


def scene_of(seed):
    """Kind and scene of a seed, without penetration at the start and with one to six contacts and stops."""
    for attempt in range(1000):
        draw = Draw((seed, attempt))
        kind = kind_of(seed)
        scene = Scene((0.0, -9.81), *kind(draw))
        pressing = rows(scene, np.array([body.q for body in scene.bodies]).ravel())[1]
        if 1 <= len(pressing) <= MAX_CONTACTS and all(row.gap > -1e-12 for row in pressing):
            return kind.__name__[1:], scene
    raise AssertionError(f"no scene of seed {seed}")


def scaled(scene, length, mass):
    """The same motion in a scene whose lengths and masses are so many times larger."""
    def larger(point):
        return tuple(length * x for x in point)

    bodies = [Body(mass * each.mass, mass * length**2 * each.inertia, *((*larger(of[:2]), of[2]) for of in (each.q, each.v)))
              for each in scene.bodies]
    contacts = [each._replace(point=larger(each.point), start=larger(each.start), radius=length * each.radius,
                              size=length * each.size)
                for each in scene.contacts]
    joints = []
    for each in scene.joints:
        if isinstance(each, Pin):
            joints.append(each._replace(on_one=larger(each.on_one), on_other=larger(each.on_other),
                                        friction=mass * length**2 * each.friction))
        else:
            limits = {word: length * limit for word in ("lower", "upper") if (limit := getattr(each, word)) is not None}
            joints.append(each._replace(start=larger(each.start), friction=mass * length * each.friction, **limits))
    return Scene(larger(scene.gravity), bodies, contacts, joints)


# ---- as a mechanism ----

def _join(m, name, joint, scene, bodies):
    """Adds a joint with its stop and the speed at the start."""
    one, other, second = bodies[joint.one], bodies[joint.other], scene.bodies[joint.other]
    dry = (joint.friction, joint.friction)
    if isinstance(joint, Pin):
        made = m.revolute(name, one.point(joint.on_one), other.point(joint.on_other),
                          **{"friction_torque": dry} if joint.friction else {})
        turned, turns = (0.0, 0.0) if joint.one == GROUND else (scene.bodies[joint.one].q[2], scene.bodies[joint.one].v[2])
        measure, drawn, rate = made.angle, second.q[2] - turned, second.v[2] - turns
    else:
        direction = math.cos(joint.angle), math.sin(joint.angle)
        made = m.prismatic(name, one.point(joint.start), other, axis=direction,
                           **{"friction_force": dry} if joint.friction else {})
        measure = made.displacement
        drawn, rate = np.dot(direction, np.subtract(second.q[:2], joint.start)), np.dot(direction, second.v[:2])
    limits = {word: limit - drawn for word, limit in (("lower", joint.lower), ("upper", joint.upper)) if limit is not None}
    if limits:
        m.stop(f"{name}-stop", measure, restitution=joint.e, **limits)
    if rate:
        m.start({made.speed: rate})


def _shape(of, contact):
    """Shape of a contact on its body."""
    start, angle, size, shape = contact.start, contact.angle, contact.size, contact.shape
    at = of.point(start)

    def on_it(turn):
        return of.point(np.add(start, (abs(size) * math.cos(angle + turn), abs(size) * math.sin(angle + turn))))

    if shape == "circle":
        return of.circle(at, abs(size), outside=size >= 0)
    if shape == "arc":
        return of.arc(at, on_it(-contact.half), on_it(contact.half), outside=size > 0)
    end = of.point(np.add(start, (math.cos(angle) * (size or 1), math.sin(angle) * (size or 1))))
    return of.segment(at, end) if shape == "segment" else of.line(at, end)


def mechanism_of(scene):
    """The same scene as a mechanism."""
    m = zd.Mechanism("scene", gravity=scene.gravity)
    bodies = [m.body(f"b{i}", mass, inertia, at=q[:2], angle=q[2]) if inertia else m.particle(f"b{i}", mass, q[:2])
              for i, (mass, inertia, q, _) in enumerate(scene.bodies)]
    bodies.append(m.ground)
    for i, joint in enumerate(scene.joints):
        _join(m, f"j{i}", joint, scene, bodies)
    for i, contact in enumerate(scene.contacts):
        body, of = bodies[contact.body], bodies[contact.line]
        point = body.point(contact.point) if scene.bodies[contact.body].inertia else body
        m.contact(f"c{i}", point, _shape(of, contact), radius=contact.radius, restitution=contact.e, friction=contact.mu)
    hung = {joint.other for joint in scene.joints}
    for i, (_, inertia, _, v) in enumerate(scene.bodies):
        if i not in hung:
            m.start({bodies[i].velocity: v[:2], **({bodies[i].angular_velocity: v[2]} if inertia else {})})
    return m


def motion_of(scene, layout, settings, length=1.0, mass=1.0):
    """Positions and angles (samples, 3 bodies) of a run of the scene in this scale, and the solution."""
    if "atol" in settings:
        settings = settings | {"atol": settings["atol"] * min(length, 1.0)}
    sol = zd.simulate(mechanism_of(scaled(scene, length, mass)).system(layout), END, t_eval=SAMPLES, **settings)
    q = np.empty((len(sol.t), 3 * len(scene.bodies)))
    for i, body in enumerate(scene.bodies):
        q[:, 3 * i:3 * i + 2] = sol[f"b{i}.position"] / length
        q[:, 3 * i + 2] = sol[f"b{i}.angle"] if body.inertia else 0.0
    return q, sol


def settings_of(seed):
    """Coordinates and settings of the run of a seed: adaptive and fixed steps, all formulations."""
    turn = seed // len(KINDS)
    steps = ({"rtol": 1e-9, "atol": 1e-11}, {"step": 1e-3, "integrator": "rk4"},
             {"rtol": 1e-9, "atol": 1e-11, "integrator": "dormand_prince"}, {"step": 5e-4, "integrator": "heun"})[turn // 2 % 4]
    return ("joint", "absolute")[turn % 2], {**steps, "formulation": FORMULATIONS[turn // 8 % len(FORMULATIONS)]}


def scale_of(seed):
    """Factors of lengths and of masses of the mechanism of a seed, whose motion must not depend on them."""
    return SCALES[seed // 7 % len(SCALES)]


def outcome(seed):
    """Kind of the scene, finding and details."""
    kind, scene = scene_of(seed)
    return compared(kind, lambda: motion_of(scene, *settings_of(seed), *scale_of(seed)),
                    lambda step: simulate(scene, SAMPLES, step, step * FINEST)[0])


def compared(kind, run, stepping):
    """Kind of a scene, finding and details, from its run and its time stepping, functions of nothing and of the step."""
    details = {"kind": kind, "compared": 0.0}
    begin = time.process_time()
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            q, sol = run()
    except zd.ZerodriftError as error:
        refused = getattr(error, "solution", None)
        return "refused", details | {"why": f"{type(error).__name__}: {error}"} | (
            {"until": float(refused.t[-1]) if len(refused.t) else 0.0} if refused is not None else {})
    details["s"] = time.process_time() - begin
    for finer in (1, 4, 16):        # where they differ, or its answers part at once, time stepping has another chance
        details |= compare(q, stepping, STEP / finer) | {"finer": finer}
        if details["ratio"] <= 1 and details["compared"] > AT_ONCE:
            break
    word = "agree" if details["ratio"] <= 1 else "disagree"
    return ("slow" if details["s"] > SLOW else word), details | {"phases": len(sol.phases)}


def compare(q, stepping, step):
    """Comparison with time stepping: until when, largest share of its error and the time of it."""
    coarse, fine = stepping(step), stepping(step / 2)
    error = np.maximum.accumulate(np.abs(coarse - fine).max(axis=1))
    parted = ~(error <= PARTED)
    count = int(np.argmax(parted)) if parted.any() else len(SAMPLES)
    away = np.abs(q - fine).max(axis=1)[:count]
    ratio = away / (FACTOR * error[:count] + FLOOR)
    worst = int(np.argmax(ratio > 1)) if (ratio > 1).any() else int(np.argmax(ratio))
    return {"compared": float(SAMPLES[count - 1]), "ratio": float(ratio.max()), "at": float(SAMPLES[worst]),
            "away": float(away[worst]), "error": float(error[worst])}
