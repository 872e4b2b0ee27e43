"""Built-in systems derived a second time with SymPy, from their energies."""

import sympy as sp
from sympy.physics.mechanics import dynamicsymbols

import zerodrift as zd
from support import SYSTEMS

T = dynamicsymbols._t
LENGTHS, MASSES = sp.symbols("l1:4"), sp.symbols("m1:4")
GROUND, GRAVITY = sp.symbols("l0 g")
VALUES = dict(zip([*LENGTHS, *MASSES, GROUND, GRAVITY], [0.3, 1.0, 0.6, 1.5, 5.0, 3.0, 1.0, 9.81], strict=True))


def bar(drive=None, **options):
    """The paper's four-bar, by its energies; `drive` prescribes alpha1."""
    angles = dynamicsymbols("alpha1:4")
    kinetic = potential = x = y = sp.S.Zero
    points = [(0, 0)]
    for angle, length, mass in zip(angles, LENGTHS, MASSES, strict=True):
        arm = sp.Matrix([sp.cos(angle), sp.sin(angle)]) * length
        middle = sp.Matrix([x, y]) + arm / 2
        kinetic += mass * middle.diff(T).dot(middle.diff(T)) / 2 + mass * length**2 / 12 * angle.diff(T) ** 2 / 2
        potential += mass * GRAVITY * middle[1]
        x, y = x + arm[0], y + arm[1]
        points.append((x, y))
    constraints = {"closure_x": x - GROUND, "closure_y": y} | ({} if drive is None else {"drive": angles[0] - drive})
    given = {"kinetic": kinetic, "potential": potential, "constraints": constraints, "points": points, "parameters": VALUES,
             "name": "bar"}
    return zd.symbolic(angles, **(given | options))


def four_bar():
    core = SYSTEMS["four_bar"]
    return bar(p0=core.p0, v0=core.v0)


def driven_four_bar():
    core = SYSTEMS["driven_four_bar"]
    rate, amplitude, frequency = sp.symbols("rate amplitude frequency")
    drive = sp.pi / 2 + rate * T + amplitude * sp.sin(frequency * T)
    return bar(drive, parameters=VALUES | {rate: 1.0, amplitude: 0.3, frequency: 2.0}, p0=core.p0, v0=core.v0)


def chaplygin_sleigh():
    core = SYSTEMS["chaplygin_sleigh"]
    x, y, phi, vx, vy, w = sp.symbols("x y phi vx vy w")
    m, inertia, a = sp.symbols("m I a")
    kinetic = m * ((vx - a * w * sp.sin(phi)) ** 2 + (vy + a * w * sp.cos(phi)) ** 2) / 2 + inertia * w**2 / 2
    return zd.symbolic([x, y, phi], speeds=[vx, vy, w], kinetic=kinetic, nonholonomic=[vy * sp.cos(phi) - vx * sp.sin(phi)],
                       parameters={m: 1.0, inertia: 0.1, a: 0.1}, p0=core.p0, v0=core.v0)


def rolling_disc():
    """With angular velocities along the axes of the disc's frame for speeds."""
    core = SYSTEMS["rolling_disc"]
    _, _, z, yaw, lean, _ = p = dynamicsymbols("x y z yaw lean spin")
    vx, vy, vz, w1, w2, w3 = v = dynamicsymbols("vx vy vz w1:4")
    m, R, g = sp.symbols("m R g", positive=True)
    rates = [q.diff(T) for q in p]
    w = {w1: rates[5] - rates[3] * sp.sin(lean), w2: rates[4], w3: rates[3] * sp.cos(lean)}
    kinetic = m * sum(rate**2 for rate in rates[:3]) / 2 + m * R**2 / 4 * (w1**2 + (w2**2 + w3**2) / 2)
    kinematics = dict(zip(rates, [vx, vy, vz, w3 / sp.cos(lean), w2, w1 + w3 * sp.tan(lean)], strict=True))
    slip_x = vx - R * (w1 * sp.sin(yaw) + w2 * sp.cos(yaw) * sp.cos(lean))
    slip_y = vy + R * (w1 * sp.cos(yaw) - w2 * sp.sin(yaw) * sp.cos(lean))
    meaning = dict(zip(v, rates[:3], strict=False)) | w
    return zd.symbolic(p, speeds=meaning, kinematics=kinematics, kinetic=kinetic, potential=m * g * z,
                       constraints=[z - R * sp.cos(lean)], nonholonomic=[slip_x, slip_y],
                       parameters={m: 1.0, R: 0.5, g: 9.81}, p0=core.p0, v0=core.v0)
