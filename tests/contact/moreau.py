"""Time stepping after Moreau and Jean for plane scenes of rigid bodies, in NumPy alone: independent of the package.

Bodies move in absolute coordinates (x, y, angle); joints are rows of two sides on velocities. A step solves, with theta = 1/2,

    M (v1 - v0) = h f + (G(q0) + G(q1))^T P / 2,      q1 = q0 + h (v0 + v1) / 2

for impulses P that obey, at the end of the step: joints G v1 = 0; contacts 0 <= Pn, complementary to
Gn v1 + e min(Gn v0, 0) >= 0 (Newton's restitution); Coulomb's law |Pt| <= mu Pn, opposite to the slip Gt v1; dry friction of
joints |P| <= F h. Steps are halved down to `finest` where a contact closes or passes the end of its shape, and to the root of h
finest where the slip of one changes its sign.
"""

import itertools
import math
import operator
from typing import NamedTuple

import numpy as np

from contact.shapes import Contact, side_of, touch, zone_of

GROUND = -1
STILL = 1e-9            # m/s, rad/s: below it a velocity is zero
CONVERGED = 1e-12       # change of impulses in an iteration, relative to the largest
SWEEPS = 300            # of projected Gauss-Seidel, after which all cases are tried
TOUCHES = 1e-6          # m: gap up to which a contact that was pressed still takes part


class Body(NamedTuple):
    """Rigid body, or particle with inertia 0: its position, angle and their rates at the start."""

    mass: float
    inertia: float
    q: tuple[float, float, float]
    v: tuple[float, float, float]


class Pin(NamedTuple):
    """Revolute joint of points of two bodies, with dry friction, and limits of the angle of the second relative to the first."""

    one: int
    on_one: tuple[float, float]
    other: int
    on_other: tuple[float, float]
    friction: float = 0.0
    lower: float | None = None
    upper: float | None = None
    e: float = 0.0


class Slider(NamedTuple):
    """Prismatic joint: a body moves along the line through `start` with this direction angle, of another body or the ground."""

    one: int
    start: tuple[float, float]
    angle: float
    other: int
    friction: float = 0.0
    lower: float | None = None
    upper: float | None = None
    e: float = 0.0


class Scene(NamedTuple):
    """Bodies, their joints and contacts."""

    gravity: tuple[float, float]
    bodies: list[Body]
    contacts: list[Contact]
    joints: list[Pin | Slider]


class Row(NamedTuple):
    """A row that may press: its gap, its row of G, that of its slip or None, and its laws."""

    gap: float
    normal: list[float]
    slip: list[float] | None
    e: float
    mu: float


def _frames(q):
    """Position, cosine and sine of each body, and of the ground at last, which is that of index -1."""
    return [(q[i], q[i + 1], math.cos(q[i + 2]), math.sin(q[i + 2])) for i in range(0, len(q), 3)] + [(0.0, 0.0, 1.0, 0.0)]


def _row(n, *parts):
    """Row of forces and moments on bodies."""
    row = [0.0] * n
    for body, force_x, force_y, moment in parts:
        if body != GROUND:
            row[3 * body] += force_x
            row[3 * body + 1] += force_y
            row[3 * body + 2] += moment
    return row


def _place(of, frames):
    """Point relative to its body, to the other body, and along and left of the shape's direction; cosine and sine of that."""
    x, y, c, s = frames[of.body]
    rx, ry = c * of.point[0] - s * of.point[1], s * of.point[0] + c * of.point[1]
    X, Y, C, S = frames[of.line]
    ca, sa = math.cos(of.angle), math.sin(of.angle)
    dx, dy = C * ca - S * sa, S * ca + C * sa
    ax, ay = C * of.start[0] - S * of.start[1], S * of.start[0] + C * of.start[1]
    fx, fy = x + rx - X, y + ry - Y
    along, across = dx * (fx - ax) + dy * (fy - ay), -dy * (fx - ax) + dx * (fy - ay)
    return rx, ry, fx, fy, along, across, dx, dy


def _contact(of, frames, n, side):
    rx, ry, fx, fy, along, across, c, s = _place(of, frames)
    gap, (u, w) = touch(of, along, across, side)
    dx, dy = c * w + s * u, s * w - c * u        # along the shape where it touches, which has its normal on the left
    normal = _row(n, (of.body, -dy, dx, dy * ry + dx * rx), (of.line, dy, -dx, -(dx * fx + dy * fy)))
    tx, ty = rx + of.radius * dy, ry - of.radius * dx       # to the material point that touches
    bx, by = fx + of.radius * dy, fy - of.radius * dx
    slip = _row(n, (of.body, dx, dy, dy * tx - dx * ty), (of.line, -dx, -dy, dx * by - dy * bx)) if of.mu else None
    return Row(gap, normal, slip, of.e, of.mu)


def _zones(scene, q):
    frames = _frames(q.tolist())
    return [zone_of(of, *_place(of, frames)[4:6]) for of in scene.contacts]


def sides_at(scene, q, sides):
    """Sides of all contacts from which their points may come, which they had at last."""
    frames = _frames(q.tolist())
    return [side_of(of, *_place(of, frames)[4:6], side) for of, side in zip(scene.contacts, sides, strict=True)]


def _joint(of, q, frames):
    """Rows of a joint on velocities, and the value and row of its coordinate."""
    n = len(q)
    if isinstance(of, Pin):
        _, _, c, s = frames[of.one]
        rx, ry = c * of.on_one[0] - s * of.on_one[1], s * of.on_one[0] + c * of.on_one[1]
        _, _, c, s = frames[of.other]
        tx, ty = c * of.on_other[0] - s * of.on_other[1], s * of.on_other[0] + c * of.on_other[1]
        rows = [_row(n, (of.other, 1, 0, -ty), (of.one, -1, 0, ry)), _row(n, (of.other, 0, 1, tx), (of.one, 0, -1, -rx))]
        turned = q[3 * of.one + 2] if of.one != GROUND else 0.0
        return rows, q[3 * of.other + 2] - turned, _row(n, (of.other, 0, 0, 1), (of.one, 0, 0, -1))
    X, Y, C, S = frames[of.one]
    ca, sa = math.cos(of.angle), math.sin(of.angle)
    dx, dy = C * ca - S * sa, S * ca + C * sa
    ax, ay = C * of.start[0] - S * of.start[1], S * of.start[0] + C * of.start[1]
    x, y, _, _ = frames[of.other]
    fx, fy = x - X, y - Y
    rows = [_row(n, (of.other, -dy, dx, 0), (of.one, dy, -dx, -(dx * fx + dy * fy))),
            _row(n, (of.other, 0, 0, 1), (of.one, 0, 0, -1))]
    return rows, dx * (fx - ax) + dy * (fy - ay), _row(n, (of.other, dx, dy, 0), (of.one, -dx, -dy, dx * fy - dy * fx))


def rows(scene, q, sides=None):
    """All rows at q: G of the joints, of what may press, and of dry friction in joints."""
    sides = sides or sides_at(scene, q, [0] * len(scene.contacts))
    q = q.tolist()
    frames = _frames(q)
    joints, pressing, dry = [], [], []
    pressing += [_contact(each, frames, len(q), side) for each, side in zip(scene.contacts, sides, strict=True)]
    for each in scene.joints:
        both, value, along = _joint(each, q, frames)
        joints += both
        if each.lower is not None:
            pressing.append(Row(value - each.lower, along, None, each.e, 0.0))
        if each.upper is not None:
            pressing.append(Row(each.upper - value, [-x for x in along], None, each.e, 0.0))
        if each.friction:
            dry.append(along)
    return joints, pressing, dry


# ---- impulses ----

def _one(mu, bn, bt, nn, nt, tn, tt):
    """Impulses of one contact by its law: its velocities without them, and their part of A."""
    if bn >= 0:
        return 0.0, 0.0
    det = nn * tt - nt * tn
    if det > 1e-12 * nn * tt:
        pn, pt = (-bn * tt + bt * nt) / det, (-bt * nn + bn * tn) / det
        if pn >= 0 and abs(pt) <= mu * pn:
            return pn, pt
    for sign in (1, -1):
        slope = nn - sign * mu * nt
        if slope <= 0:
            continue
        pn = -bn / slope
        if sign * (bt + (tn - sign * mu * tt) * pn) >= 0:
            return pn, -sign * mu * pn
    return -bn / nn, 0.0


def _sweeps(A, b, laws, P):
    """Projected Gauss-Seidel, each contact with its friction at once, from impulses P; None if it does not converge."""
    rows, right, P = A.tolist(), b.tolist(), P.tolist()
    for _ in range(SWEEPS):
        change = 0.0
        for kind, i, t, bound in laws:
            Ai, was = rows[i], P[i]
            velocity = right[i] + sum(map(operator.mul, Ai, P))
            if t >= 0:
                At, along = rows[t], P[t]
                slip = right[t] + sum(map(operator.mul, At, P))
                P[i], P[t] = _one(bound, velocity - Ai[i] * was - Ai[t] * along, slip - At[i] * was - At[t] * along,
                                  Ai[i], Ai[t], At[i], At[t])
                change = max(change, abs(P[t] - along))
            elif Ai[i] > 0:
                value = was - velocity / Ai[i]
                P[i] = max(0.0, value) if kind == "one" else min(bound, max(-bound, value))
            change = max(change, abs(P[i] - was))
        if change <= CONVERGED * max(map(abs, P)):
            return np.array(P)
    return None


def _case(A, b, laws, case):
    """Impulses of a case, and its largest wrong sign."""
    unknown, E, fixed = [], np.zeros((len(b), len(b))), np.zeros(len(b))
    for (kind, i, t, bound), state in zip(laws, case, strict=True):
        if kind == "dry" and state != "stick":
            fixed[i] = -state * bound
        elif state != "open":
            E[i, i] = 1.0
            unknown.append(i)
            if t >= 0 and state == "stick":
                E[t, t] = 1.0
                unknown.append(t)
            elif t >= 0:
                E[t, i] = -state * bound
    P = fixed
    if unknown:
        part, right = (A @ E)[unknown][:, unknown], -(b + A @ fixed)[unknown]
        full = np.zeros(len(b))
        full[unknown] = right / part[0] if len(unknown) == 1 else np.linalg.lstsq(part, right, rcond=1e-11)[0]
        P = fixed + E @ full
    w = b + A @ P
    wrong = np.abs(w[unknown]).max() if unknown else 0.0
    for (kind, i, t, bound), state in zip(laws, case, strict=True):
        at = i if kind == "dry" else t
        if kind == "one":
            wrong = max(wrong, -w[i], -P[i] * A[i, i])
        if state == "stick":
            wrong = max(wrong, (abs(P[at]) - bound * (1 if kind == "dry" else P[i])) * A[at, at])
        elif state in (1, -1):
            wrong = max(wrong, -state * w[at])
    return P, wrong


def solve(A, b, laws, known):
    """Impulses by the laws: (kind, row, row of friction or -1, bound); `known`: what was right at last, by the laws' rows."""
    key = tuple(tuple(law[:3]) for law in laws)
    fine = 1e-11 * max(1e-30, np.abs(b).max())
    case = known.get(key)
    if case:
        P, wrong = _case(A, b, laws, case)
        if wrong <= fine:
            return P
    if len(laws) > 1:
        P = _sweeps(A, b, laws, known.get((key, "impulses"), np.zeros(len(b))))
        if P is not None:
            known[key, "impulses"] = P
            return P
    best, found = math.inf, None
    options = [(["open"] if kind == "one" else []) + (["press"] if kind == "one" and t < 0 else ["stick", 1, -1])
               for kind, _, t, _ in laws]
    for case in itertools.product(*options):
        P, wrong = _case(A, b, laws, case)
        if wrong < best:
            best, found = wrong, P
            known[key] = case
            if best <= fine:
                break
    return found


# ---- a step ----

def _candidates(pressing, pressing0, pressed):
    """Contacts that would penetrate at the end of the step, or were pressed and still touch."""
    return [k for k, row in enumerate(pressing) if row.gap < 0 or (pressed[k] and pressing0[k].gap < TOUCHES and
                                                                    row.gap < math.inf)]


def _laws(scene, pressing, taking, h):
    """Laws of the impulses of contacts and of dry friction: normal rows, their friction, dry friction."""
    many, laws = len(taking), [["one", i, -1, pressing[k].mu] for i, k in enumerate(taking)]
    for law, k in zip(laws, taking, strict=True):
        if pressing[k].slip is not None:
            law[2] = many
            many += 1
    for each in scene.joints:
        if each.friction:
            laws.append(["dry", many, -1, h * each.friction])
            many += 1
    return laws


def _rows_of(joints, pressing, dry, taking):
    slips = [pressing[k].slip for k in taking if pressing[k].slip is not None]
    return np.array(joints + [pressing[k].normal for k in taking] + slips + dry)


def _impulses(joints, A, b, laws, known):
    """Impulses of all rows, those of the joints eliminated."""
    j = joints
    if not j:
        return solve(A, b, laws, known)
    half = np.linalg.solve(A[:j, :j], np.column_stack([A[:j, j:], b[:j]]))
    P = np.zeros(len(b))
    if laws:
        P[j:] = solve(A[j:, j:] - A[j:, :j] @ half[:, :-1], b[j:] - A[j:, :j] @ half[:, -1], laws, known)
    P[:j] = -half[:, -1] - half[:, :-1] @ P[j:]
    return P


def _step(scene, masses, forces, q, v, h, pressed, start, known, sides):
    """State at the end of a step of size h, what is pressed, its rows, and whether a contact closes in it and a slip turns."""
    joints0, pressing0, dry0 = start
    free, j = v + h * forces, len(joints0)
    q1, v1, P, taking = q + h * v + h * h / 2 * forces, free, None, []
    for sweep in range(5):
        joints, pressing, dry = rows(scene, q1, sides)
        if sweep == (1 if j else 0):
            taking = _candidates(pressing, pressing0, pressed)
        laws = _laws(scene, pressing, taking, h)
        if j or laws:
            G1, G0 = _rows_of(joints, pressing, dry, taking), _rows_of(joints0, pressing0, dry0, taking)
            B = ((G0 + G1) / 2 / masses).T
            b = G1 @ free
            for i, k in enumerate(taking):
                b[j + i] += pressing[k].e * min(0.0, float(G0[j + i] @ v))
            P = _impulses(j, G1 @ B, b, laws, known)
            v1 = free + B @ P
        last, q1 = q1, q + h / 2 * (v + v1)
        if sweep >= (2 if j else 1) and np.abs(q1 - last).max() < 1e-9 * h:
            break
    now, turns = [False] * len(pressing), False
    closes = any(pressed) and any(is_pressed and one != other for is_pressed, one, other in
                                  zip(pressed, _zones(scene, q), _zones(scene, q1), strict=False))
    for i, k in enumerate(taking):
        if P[j + i] > 0:
            now[k] = True
            closes |= float(np.dot(pressing0[k].normal, v)) < -STILL
            if pressing[k].slip is not None:
                turns |= _sign(np.dot(pressing0[k].slip, v)) != _sign(np.dot(pressing[k].slip, v1))
    for row0, row in zip(dry0, dry, strict=True):
        turns |= _sign(np.dot(row0, v)) != _sign(np.dot(row, v1))
    sides = sides_at(scene, q1, sides)
    return q1, v1, now, rows(scene, q1, sides), closes, turns, sides


def _sign(value):
    return 0 if abs(value) < STILL else math.copysign(1, value)


def simulate(scene, t_eval, h, finest, most=10**6):
    """Positions and velocities (samples, 3 bodies) at these times, from 0 on; NaN after `most` steps.

    h is the largest step in s, `finest` the smallest.
    """
    q, v = (np.array(given, float).ravel() for given in zip(*((body.q, body.v) for body in scene.bodies), strict=True))
    masses = np.array([x for body in scene.bodies for x in (body.mass, body.mass, body.inertia or 1.0)])
    forces = np.array([x for body in scene.bodies for x in (*scene.gravity, 0.0)])
    sides, known = sides_at(scene, q, [0] * len(scene.contacts)), {}
    start = rows(scene, q, sides)
    pressed = [False] * len(start[1])
    found_q, found_v = np.full((len(t_eval), len(q)), np.nan), np.full((len(t_eval), len(q)), np.nan)
    t, size, steps, medium = 0.0, h, 0, math.sqrt(h * finest)
    for i, end in enumerate(t_eval):
        while t < end - 1e-14:
            rest = end - t
            step = rest if size >= rest else size if 2 * size <= rest else rest / 2
            while True:
                steps += 1
                q1, v1, now, rows1, closes, turns, sides1 = _step(scene, masses, forces, q, v, step, pressed, start, known, sides)
                if not ((closes and step > finest) or (turns and step > medium)):
                    break
                step /= 2
            if steps > most:
                return found_q, found_v
            if step < rest:
                size = min(h, 2 * step)
            t = end if step == rest else t + step
            q, v, pressed, start, sides = q1, v1, now, rows1, sides1
        found_q[i], found_v[i] = q, v
    return found_q, found_v
