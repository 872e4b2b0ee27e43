"""Random scenes of contacts in space, by seed: as data, as mechanisms, and both answers compared, as of plane scenes."""

import math

import numpy as np

import zerodrift as zd
from contact.moreau_in_space import GRAVITY, GROUND, Body, Contact, cross, rows, simulate, turned
from contact.random_scenes import FORMULATIONS, SAMPLES, Draw, compared

STEPS = ({"rtol": 1e-9, "atol": 1e-11}, {"rtol": 1e-7, "atol": 1e-9, "integrator": "radau"},
         {"rtol": 1e-9, "atol": 1e-11, "integrator": "dormand_prince"}, {"step": 1e-3, "integrator": "rk4"})


class Space(Draw):
    """Random numbers of a scene in space, whose contacts have one restitution and one friction."""

    def vector(self, largest):
        return self.random.uniform(-largest, largest, 3)

    def up(self, largest=0.5):
        """Normal of a plane whose slope is at most this angle."""
        a, b = self.between(-largest, largest), self.between(-math.pi, math.pi)
        return np.array([math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a)])

    def body(self, x, v=(0, 0, 0), w=(0, 0, 0), size=0.1, R=None, *, is_ball=False):
        mass, (a, b, c) = self.between(0.3, 2), size**2 * self.random.uniform(0.2, 0.5, 3)
        inertia = mass * (np.full(3, 0.4 * size**2) if is_ball else np.array([b + c, a + c, a + b]))
        axes = turned(np.eye(3), self.vector(2)) if R is None else R
        return Body(mass, inertia, x, axes, np.array(v, float), np.array(w, float))

    def plane(self, body, point=(0, 0, 0), radius=0.0, normal=(0, 0, 1.0), at=(0, 0, 0), other=GROUND):
        return Contact(body, np.array(point), radius, other, np.array(at), np.array(normal), 0.0, self.e, self.mu)

    def sphere(self, body, radius, size, other=GROUND):
        return Contact(body, np.zeros(3), radius, other, np.zeros(3), None, size, self.e, self.mu)


def _axes(n):
    t = cross(n) @ (0, 1.0, 0)
    t = t / math.sqrt(t @ t)
    return np.array([t, cross(n) @ t, n]).T


def _along(n, v):
    return v - n * (n @ v)


def _ball(d):
    n, r, wall, rests = d.up(), d.between(0.05, 0.2) * d.chance(0.8), _axes(d.up(3.0))[:, 0] * (1, 1, 0), d.chance(0.4)
    v, x = d.vector(2), n * (r + d.between(0.1, 0.5) * (not rests))
    body = d.body(x, _along(n, v) if rests else v, d.vector(15), r, is_ball=d.chance(0.6))
    body = body if r else body._replace(R=np.eye(3), w=np.zeros(3))
    planes = [d.plane(0, radius=r, normal=n), d.plane(0, radius=r, normal=wall / np.linalg.norm(wall), at=-0.6 * wall)]
    return [body], planes[:d.whole(1, 2)]


def _tetrahedron(d):
    s, r, n = d.between(0.1, 0.3), d.between(0.01, 0.05) * d.chance(0.4), d.up(0.4)
    corners = s / 1.7 * np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    return [d.body(n * (s + r + d.between(0.05, 0.4)), d.vector(1.5), d.vector(5), s)], [d.plane(0, c, r, n) for c in corners]


def _stool(d):
    n, h = d.up(0.6), d.between(0.05, 0.3)
    feet = [(d.between(0.1, 0.3) * math.cos(a), d.between(0.1, 0.3) * math.sin(a), -h) for a in (0, 2.1, 4.2)]
    body = d.body(h * n, _along(n, d.vector(1.5)) * d.chance(0.7), n * d.between(-4, 4) * d.chance(0.7), 0.2, _axes(n))
    return [body], [d.plane(0, foot, 0.0, n) for foot in feet]


def _bowl(d):
    """A ball in a bowl or on a dome."""
    r, side = d.between(0.05, 0.2), (1, -1)[d.chance(0.5)]
    size, gap, n, v = side * d.between(0.4, 1.2), d.between(0.05, 0.3) * d.chance(0.5), side * d.up(0.7), d.vector(1.5)
    body = d.body(n * (abs(size) + side * (r + gap)), v if gap else _along(n, v), d.vector(10), r, is_ball=True)
    return [body], [d.sphere(0, r, size)]


def _two(d):
    r, s, n = d.between(0.05, 0.2), d.between(0.05, 0.2), d.up(0.2)
    top = r * n + d.up() * (r + s + d.between(0, 0.3) * d.chance(0.6))
    bodies = [d.body(r * n, size=r, is_ball=True), d.body(top, w=d.vector(10) * d.chance(0.5), size=s, is_ball=True)]
    return bodies, [d.plane(0, radius=r, normal=n), d.plane(1, radius=s, normal=n), d.sphere(1, s, r, 0)]


def _plate(d):
    """A ball on a plate that slides on three feet."""
    r, feet = d.between(0.05, 0.15), [(0.4 * math.cos(a), 0.4 * math.sin(a), -0.3) for a in (0.3, 2.3, 4.5)]
    bodies = [d.body(np.array([0, 0, 0.3]), d.vector(1) * (1, 1, 0), (0, 0, d.between(-2, 2)), 0.4, np.eye(3)),
              d.body(np.array([0.05, 0.02, 0.35 + r + 0.1 * d.chance(0.5)]), w=d.vector(8), size=r, is_ball=True)]
    return bodies, [d.plane(0, foot) for foot in feet] + [d.plane(1, radius=r, at=(0, 0, 0.05), other=0)]


def _rod(d):
    """A rod between floor and wall."""
    half, a, b, rests = d.between(0.3, 0.6), d.between(0.5, 1.2), d.between(-0.5, 0.5), d.chance(0.6)
    along = np.array([math.cos(a) * math.cos(b), math.cos(a) * math.sin(b), -math.sin(a)])
    body = d.body(half * along * (1, 0, -1) + (0 if rests else 0.1), d.vector(1) * (not rests), size=half, R=_axes(along))
    body = body._replace(inertia=body.mass * half**2 * np.array([0.3, 0.3, 0.01]))
    return [body], [d.plane(0, (0, 0, s * half), 0.0, n) for s in (-1, 1) for n in ((0, 0, 1.0), (1.0, 0, 0))]


def _pendulum(d):
    n, w, half, r, out = d.up(0.7), d.vector(3), d.between(0.2, 0.4), 0.03 * d.chance(0.5), _axes(d.up(3.0))[:, 0]
    joint = Contact(0, np.array([0, 0, half]), 0.0, GROUND, np.zeros(3))
    wall = d.plane(0, (0, 0, -half), r, out, -2 * half * n - out * (r + d.between(0.02, 0.2)))
    return [d.body(-half * n, cross(w) @ n * -half, w, half, _axes(n))], [joint, wall]


def _top(d):
    n, h, r = d.up(0.3), d.between(0.04, 0.1), d.between(0.005, 0.02)
    return [d.body(np.array([0, 0, r]) + h * n, w=n * d.between(20, 60), size=h, R=_axes(n))], [d.plane(0, (0, 0, -h), r)]


KINDS = (_ball, _tetrahedron, _stool, _bowl, _two, _plate, _rod, _pendulum, _top)


def scene_of(seed):
    """Kind, bodies and contacts of a seed, without penetration at the start."""
    kind = KINDS[seed % len(KINDS)]
    for attempt in range(1000):
        bodies, contacts = kind(Space((seed, attempt)))
        if min(rows(bodies, contacts, [body.x for body in bodies], [body.R for body in bodies])[0]) > -1e-12:
            return kind.__name__[1:], bodies, contacts
    raise AssertionError(f"no scene of seed {seed}")


def mechanism_of(scene, contacts):
    """The same scene as a mechanism."""
    m = zd.Mechanism("scene", gravity=GRAVITY, dimension=3)
    bodies = [m.body(f"b{k}", b.mass, np.diag(b.inertia), at=b.x, rotation=b.R) if any(b.inertia) else
              m.particle(f"b{k}", b.mass, b.x) for k, b in enumerate(scene)] + [m.ground]
    for i, c in enumerate(contacts):
        of, point = bodies[c.other], bodies[c.body].point(c.point) if any(scene[c.body].inertia) else bodies[c.body]
        if c.mu is None:
            m.spherical(f"c{i}", of.point(c.at), point)
        else:
            at = of.point(c.at)
            shape = of.plane(at, c.normal) if c.normal is not None else of.sphere(at, abs(c.size), outside=c.size > 0)
            m.contact(f"c{i}", point, shape, radius=c.radius, restitution=c.e, friction=c.mu)
    hung = {c.body for c in contacts if c.mu is None}
    for k, b in enumerate(scene):
        m.start({} if k in hung else {bodies[k].velocity: b.v})
        m.start({bodies[k].angular_velocity: b.w} if any(b.inertia) else {})
    return m


def motion_of(scene, contacts, layout, settings):
    """Positions and axes (samples, 12 bodies) of a run of the scene, and the solution."""
    sol, parts = zd.simulate(mechanism_of(scene, contacts).system(layout), SAMPLES[-1], t_eval=SAMPLES, **settings), []
    for k, body in enumerate(scene):
        axes = sol[f"b{k}.rotation"] if any(body.inertia) else np.tile(np.eye(3), (len(sol.t), 1, 1))
        parts += [sol[f"b{k}.position"], axes.reshape(-1, 9)]
    return np.hstack(parts), sol


def settings_of(seed):
    """Coordinates and settings of the run of a seed: adaptive and fixed steps, all formulations."""
    turn = seed // len(KINDS)
    return ("joint", "absolute")[turn % 2], {**STEPS[turn // 2 % 4], "formulation": FORMULATIONS[turn // 8 % len(FORMULATIONS)]}


def outcome(seed):
    """Kind of the scene, finding and details."""
    kind, *scene = scene_of(seed)
    return compared(kind, lambda: motion_of(*scene, *settings_of(seed)), lambda step: simulate(*scene, SAMPLES, step))
