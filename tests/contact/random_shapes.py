"""Kinds of random plane scenes with segments, arcs and circles; see `random_scenes.py`."""

import math

from contact.moreau import GROUND, Body, Pin, Slider


def _disc(d, at, speed=2.0, radius=None):
    radius = radius or d.between(0.05, 0.2)
    mass = d.between(0.2, 2)
    v = (*d.speed(speed), d.between(-8, 8)) if speed else (0.0, 0.0, 0.0)
    return radius, Body(mass, mass * radius**2 * d.between(0.3, 0.9), (*at, 0.0), v)


def _shaped(d, body, line, start, radius, shape, size, angle=0.0, half=math.pi, point=(0.0, 0.0)):
    return d.contact(body, point, line, start, angle, radius)._replace(shape=shape, size=size, half=half)


def _polar(r, angle):
    return r * math.cos(angle), r * math.sin(angle)


def _balls(d):
    """Two or three discs that hit one another and a floor."""
    many, bodies, contacts, radii = d.whole(2, 3), [], [], []
    for i in range(many):
        x = d.between(-0.1, 0.1) + (0.35 * i if d.chance(0.5) else 0.0)
        radius, body = _disc(d, (x, 0.25 + 0.45 * i * d.between(0.9, 1.1)))
        bodies, radii = [*bodies, body], [*radii, radius]
        contacts += [_shaped(d, i, k, (0.0, 0.0), radius, "circle", radii[k]) for k in range(i)]
    return bodies, contacts + [d.contact(i, (0, 0), radius=radii[i]) for i in range(many)], []


def _bowl(d):
    """A disc or a point in a bowl or a hole of the ground, perhaps with another one."""
    size, half, bodies, contacts, radii = d.between(0.6, 1.2), d.between(0.5, 1.8), [], [], []
    shape = ("arc", "circle")[d.chance(0.3)]
    for i in range(d.whole(1, 2)):
        a = -math.pi / 2 + d.between(0.2, 0.9) * min(half, 1.3) * (-1, 1)[i]
        radius = d.between(0.05, 0.15) if i or d.chance(0.6) else 0.0
        rests = d.chance(0.4)
        away = size - radius - (0.0 if rests else d.between(0.02, 0.2))
        turning = d.between(-3, 3)
        _, body = _disc(d, _polar(away, a), radius=radius or 0.1)
        if rests:
            body = body._replace(v=(-away * math.sin(a) * turning, away * math.cos(a) * turning, 0.0))
        bodies, radii = [*bodies, body], [*radii, radius]
        contacts.append(_shaped(d, i, GROUND, (0, 0), radius, shape, -size, -math.pi / 2, half if shape == "arc" else math.pi))
    if len(bodies) == 2 and d.chance(0.7):
        contacts.append(_shaped(d, 1, 0, (0, 0), radii[1], "circle", radii[0]))
    return bodies, contacts, []


def _hill(d):
    """A disc or a point on a hill of the ground, and a floor."""
    size, half, radius = d.between(0.3, 0.7), d.between(0.4, 1.5), d.between(0.05, 0.2) if d.chance(0.6) else 0.0
    a, away = math.pi / 2 + d.between(-0.8, 0.8) * half, size + radius + (0.0, d.between(0.02, 0.3))[d.chance(0.5)]
    _, body = _disc(d, _polar(away, a), radius=radius or 0.1)
    if away == size + radius:
        turning = d.between(-1, 1)
        body = body._replace(v=(-away * math.sin(a) * turning, away * math.cos(a) * turning, 0.0))
    contacts = [_shaped(d, 0, GROUND, (0, 0), radius, "arc", size, math.pi / 2, half), d.contact(0, (0, 0), radius=radius)]
    return [body], contacts[:d.whole(1, 2)], []


def _table(d):
    """A disc, a point or a box on a table that ends, and a floor below."""
    high, tilt, end = d.between(0.2, 0.8), (0.0, d.between(-0.3, 0.3))[d.chance(0.5)], d.between(0.05, 0.4)
    c, s = math.cos(tilt), math.sin(tilt)
    above, push = (0.0, d.between(0.02, 0.3))[d.chance(0.4)], d.between(0.2, 3)
    if d.chance(0.7):
        radius = d.between(0.05, 0.2) if d.chance(0.7) else 0.0
        mass, points = d.between(0.3, 2), [(0.0, 0.0)]
        inertia, over, radii = mass * (radius or 0.1)**2 / 2, radius + above, [radius]
    else:
        a, b, mass = d.between(0.05, 0.2), d.between(0.05, 0.2), d.between(0.3, 2)
        inertia, over, radii, points = mass * (a * a + b * b) / 3, b + above, [0.0, 0.0], [(-a, -b), (a, -b)]
    body = Body(mass, inertia, (-end * c - over * s, high - end * s + over * c, tilt), (push * c, push * s, 0.0))
    turn = tilt + (math.pi if d.chance(0.5) else 0.0)       # its right side, or its left one
    start = (-c, high - s) if turn == tilt else (0.0, high)
    both = list(zip(points, radii, strict=True))
    contacts = [_shaped(d, 0, GROUND, start, radius, "segment", 1.0, turn, point=at) for at, radius in both]
    if d.chance(0.6):
        contacts += [d.contact(0, at, radius=radius) for at, radius in both]
    return [body], contacts, []


def _lever(d):
    """Discs and points on a hinged plank, that leave it over its ends."""
    half, mass, high, tilt = d.between(0.3, 0.7), d.between(0.5, 3), 0.6, d.between(-0.3, 0.3)
    c, s = math.cos(tilt), math.sin(tilt)
    bodies, contacts = [Body(mass, mass * half * half / 3, (0.0, high, tilt), (0.0, 0.0, 0.0))], []
    joint = Pin(GROUND, (0, high), 0, (0, 0), d.between(0.2, 2) if d.chance(0.3) else 0.0)
    if d.chance(0.5):
        joint = joint._replace(lower=-d.between(0.3, 0.8), upper=d.between(0.3, 0.8), e=d.e)
    for i in range(d.whole(1, 2)):
        radius = d.between(0.05, 0.15) if d.chance(0.7) else 0.0
        at, over = (0.1 + 0.85 * d.random.random()) * half * (-1, 1)[i], radius + (0.0, d.between(0.05, 0.4))[d.chance(0.5)]
        _, body = _disc(d, (at * c - over * s, high + at * s + over * c), 0.0 if over == radius else 1.0, radius or 0.1)
        bodies.append(body)
        contacts.append(_shaped(d, i + 1, 0, (-half, 0), radius, "segment", 2 * half))
    return bodies, contacts, [joint]


def _moving_hole(d):
    """A disc in a hole, or on a round top, of a slider that moves on a line."""
    size, tilt, u = d.between(0.2, 0.5), d.between(-0.3, 0.3), d.between(-1, 1)
    base = Body(d.between(0.5, 3), 0.2, (0.0, 0.0, 0.0), (u * math.cos(tilt), u * math.sin(tilt), 0.0))
    is_hole = d.chance(0.6)
    radius = d.between(0.2, 0.97) * size if is_hole else d.between(0.05, 0.2)
    away = (size - radius if is_hole else size + radius) + d.between(0, 0.3) * (size - radius) * (-1 if is_hole else 1)
    a = -math.pi / 2 + d.between(-1, 1) if is_hole else math.pi / 2 + d.between(-0.5, 0.5)
    _, ball = _disc(d, _polar(away, a), 1.0, radius)
    joint = Slider(GROUND, (0, 0), tilt, 0, lower=-d.between(0.1, 0.5), upper=d.between(0.1, 0.5), e=d.e)
    return [base, ball], [_shaped(d, 1, 0, (0, 0), radius, "circle", -size if is_hole else size)], [joint]


def _pegs(d):
    """A disc, or a bar with round ends, that falls between pegs and short segments."""
    if d.chance(0.5):
        radius, body = _disc(d, (d.between(-0.1, 0.1), d.between(0.5, 0.7)))
        points = [(0.0, 0.0)]
    else:
        half, mass, radius = d.between(0.1, 0.3), d.between(0.3, 2), d.between(0.03, 0.08)
        body = Body(mass, mass * half * half / 3, (d.between(-0.1, 0.1), d.between(0.6, 0.9), d.between(-1, 1)),
                    (*d.speed(1), d.between(-3, 3)))
        points = [(-half, 0.0), (half, 0.0)]
    pegs = [((-0.3, 0.0), "circle", d.between(0, 0.1)), ((0.25, d.between(-0.1, 0.1)), "segment", d.between(0.1, 0.4)),
            ((d.between(-0.1, 0.1), -0.3), "circle", d.between(0, 0.05))][:6 // len(points)]
    return [body], [_shaped(d, 0, GROUND, at, radius, shape, size, d.between(-0.5, 0.5), point=point)
                    for point in points for at, shape, size in pegs], []


def _ramp(d):
    """A disc or a point that slides down an arc, on a segment that is flush with it, and off its end."""
    size, half, length = d.between(0.3, 0.8), d.between(0.2, 0.6), d.between(0.1, 0.6)
    radius = d.between(0.03, 0.1) if d.chance(0.6) else 0.0
    a, away = -math.pi / 2 - d.between(0.3, 0.9) * 2 * half, size - radius
    turning = d.between(0, 2)
    _, body = _disc(d, _polar(away, a), 0.0, radius or 0.1)
    body = body._replace(v=(-away * math.sin(a) * turning, away * math.cos(a) * turning, 0.0))
    return [body], [_shaped(d, 0, GROUND, (0, 0), radius, "arc", -size, -math.pi / 2 - half, half),
                    _shaped(d, 0, GROUND, (0, -size), radius, "segment", length)], []


SHAPED = (_balls, _bowl, _hill, _table, _lever, _moving_hole, _pegs, _ramp)
