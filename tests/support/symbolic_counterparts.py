"""Systems in C, built in or of tests, derived a second time with SymPy, from their energies; and a rolling disc."""

import math

import sympy as sp
from sympy.physics.mechanics import dynamicsymbols

import zerodrift as zd
from support import OWN, SYSTEMS

T = dynamicsymbols._t
LENGTHS, MASSES = sp.symbols("l1:4"), sp.symbols("m1:4")
GROUND, GRAVITY = sp.symbols("l0 g")
VALUES = dict(zip([*LENGTHS, *MASSES, GROUND, GRAVITY], [0.3, 1.0, 0.6, 1.5, 5.0, 3.0, 1.0, 9.81], strict=True))


def bar(**options):
    """The paper's four-bar, by its energies. Links are slender rods."""
    angles = dynamicsymbols("alpha1:4")
    kinetic = potential = x = y = sp.S.Zero
    points = [(0, 0)]
    for angle, length, mass in zip(angles, LENGTHS, MASSES, strict=True):
        inertia = mass * length**2 / 12
        arm = sp.Matrix([sp.cos(angle), sp.sin(angle)]) * length
        middle = sp.Matrix([x, y]) + arm / 2
        kinetic += mass * middle.diff(T).dot(middle.diff(T)) / 2 + inertia * angle.diff(T) ** 2 / 2
        potential += mass * GRAVITY * middle[1]
        x, y = x + arm[0], y + arm[1]
        points.append((x, y))
    given = {"kinetic": kinetic, "potential": potential, "constraints": {"closure_x": x - GROUND, "closure_y": y},
             "points": points, "parameters": VALUES, "name": "bar"}
    return zd.symbolic(angles, **(given | options))


def four_bar():
    core = SYSTEMS["four_bar"]
    return bar(p0=core.p0, v0=core.v0)


def arm():
    core = OWN["arm"]
    x, y, angle = p = dynamicsymbols("x y angle")
    length, rate, amplitude, frequency = values = sp.symbols("length rate amplitude frequency")
    drive = rate * T + amplitude * sp.sin(frequency * T)
    return zd.symbolic(p, kinetic=x.diff(T)**2 + y.diff(T)**2 + angle.diff(T)**2 / 4, potential=2 * 9.81 * y,
                       constraints=[x - length * sp.cos(angle), y - length * sp.sin(angle), angle - drive],
                       parameters=dict(zip(values, core.parameters.values(), strict=True)), p0=core.p0, v0=core.v0,
                       name="arm")


def skate():
    core = OWN["skate"]
    x, y, z, heading = p = dynamicsymbols("x y z heading")
    along, across, vz, turning = v = dynamicsymbols("along across vz turning")
    dx, dy, dz, turn = rates = [q.diff(T) for q in p]
    s, c = sp.sin(heading), sp.cos(heading)
    return zd.symbolic(p, speeds=dict(zip(v, [dx * c + dy * s, dy * c - dx * s, dz, turn], strict=True)),
                       kinematics=dict(zip(rates, [along * c - across * s, along * s + across * c, vz, turning], strict=True)),
                       kinetic=0.75 * (dx**2 + dy**2 + dz**2) + 0.1 * turn**2, potential=1.5 * 9.81 * z,
                       constraints=[z / 12 - (x**2 + y**2) / 4], nonholonomic=[across], p0=core.p0, v0=core.v0)


def chaplygin_sleigh(mass=1.0, inertia=0.1, offset=0.1, heading=0.0, speed=-1.0, turn_rate=1.0):
    """Edge at the origin; inertia about the centre of mass, which is ahead by the offset."""
    x, y, phi, vx, vy, w = sp.symbols("x y phi vx vy w")
    m, J, a = sp.symbols("m J a")
    kinetic = m * ((vx - a * w * sp.sin(phi)) ** 2 + (vy + a * w * sp.cos(phi)) ** 2) / 2 + J * w**2 / 2
    return zd.symbolic([x, y, phi], speeds=[vx, vy, w], kinetic=kinetic, nonholonomic=[vy * sp.cos(phi) - vx * sp.sin(phi)],
                       parameters={m: mass, J: inertia, a: offset}, units=["m", "m", "rad"], p0=[0, 0, heading],
                       v0=[speed * math.cos(heading), speed * math.sin(heading), turn_rate])


def rolling_disc(lean=0.2, yaw_rate=0.4, spin_rate=6.0):
    """With angular velocities along the axes of the disc's frame, which does not spin, for speeds; its contact at the origin."""
    _, _, z, yaw, tilt, _ = p = dynamicsymbols("x y z yaw lean spin")
    vx, vy, vz, w1, w2, w3 = v = dynamicsymbols("vx vy vz w1:4")
    m, R, g = sp.symbols("m R g", positive=True)
    rates = [q.diff(T) for q in p]
    w = {w1: rates[5] - rates[3] * sp.sin(tilt), w2: rates[4], w3: rates[3] * sp.cos(tilt)}
    kinetic = m * sum(rate**2 for rate in rates[:3]) / 2 + m * R**2 / 4 * (w1**2 + (w2**2 + w3**2) / 2)
    kinematics = dict(zip(rates, [vx, vy, vz, w3 / sp.cos(tilt), w2, w1 + w3 * sp.tan(tilt)], strict=True))
    slip_x = vx - R * (w1 * sp.sin(yaw) + w2 * sp.cos(yaw) * sp.cos(tilt))
    slip_y = vy + R * (w1 * sp.cos(yaw) - w2 * sp.sin(yaw) * sp.cos(tilt))
    meaning, roll = dict(zip(v, rates[:3], strict=False)) | w, spin_rate - yaw_rate * math.sin(lean)
    return zd.symbolic(p, speeds=meaning, kinematics=kinematics, kinetic=kinetic, potential=m * g * z,
                       constraints=[z - R * sp.cos(tilt)], nonholonomic=[slip_x, slip_y],
                       parameters={m: 1.0, R: 0.5, g: 9.81}, p0=[math.sin(lean) / 2, 0, math.cos(lean) / 2, 0, lean, 0],
                       v0=[0, -roll / 2, 0, roll, 0, yaw_rate * math.cos(lean)])


# ---- with the parameters that the built-in systems hand to their closed-form functions, in that order ----


def of_parameters(*names):
    """Symbols, and any values for them that nothing is special of: those of the built-in system are set later."""
    symbols = sp.symbols(names)
    return symbols, dict(zip(symbols, [0.7 + 0.1 * i for i in range(len(symbols))], strict=True))


def four_bar_of_parameters():
    """With the energies of section 4.1, in which like terms are collected: what is written from these has less to compute."""
    core = SYSTEMS["four_bar"]
    inertias = sp.symbols("J1:4")
    values = [1.0, 0.3, 1.0, 0.6, 1.5, 5.0, 3.0, 0.01125, 5 / 12, 0.09, 9.81]
    parameters = dict(zip([GROUND, *LENGTHS, *MASSES, *inertias, GRAVITY], values, strict=True))
    angles, beyond = dynamicsymbols("alpha1:4"), [sum(MASSES[i + 1:]) for i in range(3)]
    kinetic = sum((J + (m / 4 + after) * length**2) * angle.diff(T) ** 2 / 2
                  for angle, length, m, J, after in zip(angles, LENGTHS, MASSES, inertias, beyond, strict=True))
    kinetic += sum((MASSES[j] / 2 + beyond[j]) * LENGTHS[i] * LENGTHS[j] * sp.cos(angles[j] - angles[i])
                   * angles[i].diff(T) * angles[j].diff(T) for i, j in ((0, 1), (0, 2), (1, 2)))
    potential = sum((m / 2 + after) * length * GRAVITY * sp.sin(angle)
                    for angle, length, m, after in zip(angles, LENGTHS, MASSES, beyond, strict=True))
    closure = [sum(length * of(angle) for angle, length in zip(angles, LENGTHS, strict=True)) for of in (sp.cos, sp.sin)]
    return zd.symbolic(angles, kinetic=kinetic, potential=potential, constraints=[closure[0] - GROUND, closure[1]],
                       parameters=parameters, p0=core.p0, v0=core.v0)


def pendulum_of_parameters():
    core = SYSTEMS["pendulum"]
    x, y, vx, vy = sp.symbols("x y vx vy")
    (length, mass, gravity, _, _), values = of_parameters("length", "mass", "gravity", "angle", "rate")
    return zd.symbolic([x, y], speeds=[vx, vy], kinetic=mass * (vx**2 + vy**2) / 2, potential=mass * gravity * y,
                       constraints=[(x**2 + y**2 - length**2) / (2 * length)], parameters=values | {length: 1.0, gravity: 9.81},
                       units=["m", "m"], p0=core.p0, v0=core.v0)


def oscillator_of_parameters():
    core = SYSTEMS["oscillator"]
    x, vx = sp.symbols("x vx")
    (mass, stiffness, _, _), values = of_parameters("mass", "stiffness", "x0", "v0")
    return zd.symbolic([x], speeds=[vx], kinetic=mass * vx**2 / 2, potential=stiffness * x**2 / 2, parameters=values, units=["m"],
                       p0=core.p0, v0=core.v0)


def knife_edge_of(weight, *names):
    """With the weight along its plane as an expression of the parameters that are behind the mass and the inertia."""
    core = SYSTEMS["knife_edge"]
    x, y, phi, vx, vy, w = sp.symbols("x y phi vx vy w")
    (m, inertia, *others), values = of_parameters("m", "I", *names)
    return zd.symbolic([x, y, phi], speeds=[vx, vy, w], kinetic=m * (vx**2 + vy**2) / 2 + inertia * w**2 / 2,
                       potential=-weight(m, *others) * x, nonholonomic=[vx * sp.sin(phi) - vy * sp.cos(phi)],
                       parameters=values, units=["m", "m", "rad"], p0=core.p0, v0=core.v0)


def knife_edge_of_parameters():
    return knife_edge_of(lambda m, weight: weight, "weight")


def knife_edge():
    mass, inertia, gravity, incline, *_ = SYSTEMS["knife_edge"].parameters.values()
    return knife_edge_of_parameters().with_parameters(m=mass, I=inertia, weight=mass * gravity * math.sin(incline))


def knife_edge_of_incline():
    """With the angle of the plane, of which the weight along it is computed."""
    return knife_edge_of(lambda m, g, incline: m * g * sp.sin(incline), "g", "incline")


OF_PARAMETERS = {"four_bar": four_bar_of_parameters, "pendulum": pendulum_of_parameters, "oscillator": oscillator_of_parameters,
                 "knife_edge": knife_edge_of_parameters}
PRECISE = {"knife_edge": knife_edge_of_incline}     # series in double-double arithmetic that have other numbers

# Of each parameter another value than that functions are written with.
CHANGED = {
    "four_bar": {"lengths": (1.1, 0.35, 0.9, 0.7), "masses": (1.0, 2.0, 4.0), "inertias": (0.02, 0.3, 0.1), "gravity": 5.0},
    "pendulum": {"length": 0.7, "mass": 2.0, "gravity": 5.0, "rate": 1.0},
    "oscillator": {"mass": 2.0, "stiffness": 3.0, "x0": 0.5, "v0": -1.0},
    "knife_edge": {"mass": 2.0, "inertia": 0.3, "gravity": 5.0, "incline": 0.3, "heading": 0.5, "speed": 1.0, "turn_rate": 2.0},
}
