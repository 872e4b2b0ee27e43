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
    """The paper's four-bar, by its energies; `drive` prescribes alpha1. Links are slender rods."""
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


# ---- with the parameters that the built-in systems hand to their closed-form functions, in that order ----


def of_parameters(*names):
    """Symbols, and any values for them that nothing is special of: those of the built-in system are set later."""
    symbols = sp.symbols(names)
    return symbols, dict(zip(symbols, [0.7 + 0.1 * i for i in range(len(symbols))], strict=True))


def four_bar_of_parameters(drive=None, more=()):
    """With the energies of section 4.1, in which like terms are collected: what is written from these has less to compute."""
    core = SYSTEMS["driven_four_bar" if more else "four_bar"]
    inertias = sp.symbols("J1:4")
    values = [1.0, 0.3, 1.0, 0.6, 1.5, 5.0, 3.0, 0.01125, 5 / 12, 0.09, 9.81]
    parameters = dict(zip([GROUND, *LENGTHS, *MASSES, *inertias, GRAVITY], values, strict=True)) | dict(more)
    angles, beyond = dynamicsymbols("alpha1:4"), [sum(MASSES[i + 1:]) for i in range(3)]
    kinetic = sum((J + (m / 4 + after) * length**2) * angle.diff(T) ** 2 / 2
                  for angle, length, m, J, after in zip(angles, LENGTHS, MASSES, inertias, beyond, strict=True))
    kinetic += sum((MASSES[j] / 2 + beyond[j]) * LENGTHS[i] * LENGTHS[j] * sp.cos(angles[j] - angles[i])
                   * angles[i].diff(T) * angles[j].diff(T) for i, j in ((0, 1), (0, 2), (1, 2)))
    potential = sum((m / 2 + after) * length * GRAVITY * sp.sin(angle)
                    for angle, length, m, after in zip(angles, LENGTHS, MASSES, beyond, strict=True))
    closure = [sum(length * of(angle) for angle, length in zip(angles, LENGTHS, strict=True)) for of in (sp.cos, sp.sin)]
    constraints = [closure[0] - GROUND, closure[1]] + ([] if drive is None else [angles[0] - drive])
    return zd.symbolic(angles, kinetic=kinetic, potential=potential, constraints=constraints, parameters=parameters, p0=core.p0,
                       v0=core.v0)


def driven_four_bar_of_parameters():
    angle, rate, amplitude, frequency = more = sp.symbols("angle rate amplitude frequency")
    drive = angle + rate * T + amplitude * sp.sin(frequency * T)
    return four_bar_of_parameters(drive, zip(more, [float(sp.pi / 2), 1.0, 0.3, 2.0], strict=True))


def pendulum_of_parameters():
    core = SYSTEMS["pendulum"]
    x, y, vx, vy = sp.symbols("x y vx vy")
    (length, mass, gravity, _, _), values = of_parameters("length", "mass", "gravity", "angle", "rate")
    return zd.symbolic([x, y], speeds=[vx, vy], kinetic=mass * (vx**2 + vy**2) / 2, potential=mass * gravity * y,
                       constraints=[(x**2 + y**2 - length**2) / (2 * length)], parameters=values | {length: 1.0, gravity: 9.81},
                       units=["m", "m"], p0=core.p0, v0=core.v0)


def slider_crank_of_parameters():
    core = SYSTEMS["slider_crank"]
    q, x, phi = p = dynamicsymbols("q x phi")
    names = ["crank", "rod", "J1", "m", "J2", "k", "c", "relaxed", "force", "angle", "rate"]
    (a, b, J1, m, J2, k, c, relaxed, force, _, _), values = of_parameters(*names)
    values |= {a: 0.5, b: 1.0, J1: 1.0, m: 1.0, J2: 2.0, k: 1.0, c: 1.0, relaxed: 1.0, force: 1.0}
    dx, dy = x - (a * sp.cos(q) + b * sp.cos(phi)) / 2, -(a * sp.sin(q) + b * sp.sin(phi)) / 2
    spring = sp.sqrt(dx**2 + dy**2)
    kinetic = (J1 * q.diff(T)**2 + m * x.diff(T)**2 + J2 * phi.diff(T)**2) / 2
    potential = k * (spring - relaxed)**2 / 2 - force * (x + b * sp.cos(phi))
    closure = [x - a * sp.cos(q) - b * sp.cos(phi), -a * sp.sin(q) - b * sp.sin(phi)]
    damping = [-c * spring.diff(T) * spring.diff(each) for each in p]
    return zd.symbolic(p, kinetic=kinetic, potential=potential, force=damping, constraints=closure, parameters=values,
                       units=["rad", "m", "rad"], p0=core.p0, v0=core.v0)


def chaplygin_sleigh_of_parameters():
    core = SYSTEMS["chaplygin_sleigh"]
    x, y, phi, vx, vy, w = sp.symbols("x y phi vx vy w")
    (m, inertia, a, *_), values = of_parameters("m", "I", "a", "heading", "speed", "turn_rate")
    kinetic = m * ((vx - a * w * sp.sin(phi)) ** 2 + (vy + a * w * sp.cos(phi)) ** 2) / 2 + inertia * w**2 / 2
    return zd.symbolic([x, y, phi], speeds=[vx, vy, w], kinetic=kinetic, nonholonomic=[vy * sp.cos(phi) - vx * sp.sin(phi)],
                       parameters=values | {m: 1.0, inertia: 0.1, a: 0.1}, units=["m", "m", "rad"], p0=core.p0, v0=core.v0)


def oscillator_of_parameters():
    core = SYSTEMS["oscillator"]
    x, vx = sp.symbols("x vx")
    (mass, stiffness, _, _), values = of_parameters("mass", "stiffness", "x0", "v0")
    return zd.symbolic([x], speeds=[vx], kinetic=mass * vx**2 / 2, potential=stiffness * x**2 / 2, parameters=values, units=["m"],
                       p0=core.p0, v0=core.v0)


def knife_edge_of_parameters():
    core = SYSTEMS["knife_edge"]
    x, y, phi, vx, vy, w = sp.symbols("x y phi vx vy w")
    (m, inertia, weight), values = of_parameters("m", "I", "weight")
    return zd.symbolic([x, y, phi], speeds=[vx, vy, w], kinetic=m * (vx**2 + vy**2) / 2 + inertia * w**2 / 2,
                       potential=-weight * x, nonholonomic=[vx * sp.sin(phi) - vy * sp.cos(phi)], parameters=values,
                       units=["m", "m", "rad"], p0=core.p0, v0=core.v0)


def vertical_disc_of_parameters():
    core = SYSTEMS["vertical_disc"]
    x, y, phi, theta, vx, vy, turn, roll = sp.symbols("x y phi theta vx vy turn roll")
    (m, R, axle, diameter, *_), values = of_parameters("m", "R", "Ia", "It", "heading", "turn_rate", "roll_rate")
    return zd.symbolic([x, y, phi, theta], speeds=[vx, vy, turn, roll],
                       kinetic=(m * (vx**2 + vy**2) + diameter * turn**2 + axle * roll**2) / 2,
                       nonholonomic=[vx - R * roll * sp.cos(phi), vy - R * roll * sp.sin(phi)], parameters=values,
                       units=["m", "m", "rad", "rad"], p0=core.p0, v0=core.v0)


def knife_edge_of_incline():
    """With the angle of the plane, of which the weight along it is computed."""
    core = SYSTEMS["knife_edge"]
    x, y, phi, vx, vy, w = sp.symbols("x y phi vx vy w")
    (m, inertia, g, incline), values = of_parameters("m", "I", "g", "incline")
    return zd.symbolic([x, y, phi], speeds=[vx, vy, w], kinetic=m * (vx**2 + vy**2) / 2 + inertia * w**2 / 2,
                       potential=-m * g * sp.sin(incline) * x, nonholonomic=[vx * sp.sin(phi) - vy * sp.cos(phi)],
                       parameters=values, units=["m", "m", "rad"], p0=core.p0, v0=core.v0)


def rolling_disc_of_parameters():
    core = SYSTEMS["rolling_disc"]
    x, y, z, yaw, lean, spin = sp.symbols("x y z yaw lean spin")
    vx, vy, vz, w1, w2, w3 = v = sp.symbols("vx vy vz w1:4")
    (m, R, weight, axle, diameter), values = of_parameters("m", "R", "weight", "Ia", "It")
    moment = axle * w1 + diameter * w3 * sp.tan(lean)       # W x (I w): Euler's equations in axes that do not spin
    s, c = sp.sin, sp.cos
    return zd.symbolic([x, y, z, yaw, lean, spin], speeds=v, mass=sp.diag(m, m, m, axle, diameter, diameter),
                       bias=[0, 0, 0, 0, w3 * moment, -w2 * moment], potential=weight * z,
                       kinematics=[vx, vy, vz, w3 / c(lean), w2, w1 + w3 * s(lean) / c(lean)],
                       constraints=[z - R * c(lean)],
                       nonholonomic=[vx - R * (w1 * s(yaw) + w2 * c(yaw) * c(lean)),
                                     vy + R * (w1 * c(yaw) - w2 * s(yaw) * c(lean))],
                       parameters=values, p0=core.p0, v0=core.v0)


# Series of systems without closed-form functions, and those in double-double arithmetic that have other numbers.
WITH_SERIES_ALONE = {"series": {"rolling_disc": rolling_disc_of_parameters}, "precise": {"knife_edge": knife_edge_of_incline}}
OF_PARAMETERS = {"four_bar": four_bar_of_parameters, "driven_four_bar": driven_four_bar_of_parameters,
                 "pendulum": pendulum_of_parameters, "slider_crank": slider_crank_of_parameters,
                 "chaplygin_sleigh": chaplygin_sleigh_of_parameters, "oscillator": oscillator_of_parameters,
                 "knife_edge": knife_edge_of_parameters, "vertical_disc": vertical_disc_of_parameters}

# Of each parameter another value than that functions are written with.
CHANGED = {
    "four_bar": {"lengths": (1.1, 0.35, 0.9, 0.7), "masses": (1.0, 2.0, 4.0), "inertias": (0.02, 0.3, 0.1), "gravity": 5.0},
    "driven_four_bar": {"lengths": (1.1, 0.35, 0.9, 0.7), "masses": (1.0, 2.0, 4.0), "gravity": 5.0, "crank_rate": 0.7,
                        "amplitude": 0.2, "frequency": 3.0, "crank_angle": 1.0},
    "pendulum": {"length": 0.7, "mass": 2.0, "gravity": 5.0, "rate": 1.0},
    "slider_crank": {"crank": 0.4, "rod": 1.3, "crank_inertia": 0.5, "mass": 2.0, "rod_inertia": 0.3, "stiffness": 3.0,
                     "damping": 0.5, "relaxed_length": 0.8, "force": 2.0, "crank_rate": 1.0},
    "chaplygin_sleigh": {"mass": 2.0, "inertia": 0.3, "offset": -0.2, "speed": 1.0},
    "oscillator": {"mass": 2.0, "stiffness": 3.0, "x0": 0.5, "v0": -1.0},
    "knife_edge": {"mass": 2.0, "inertia": 0.3, "gravity": 5.0, "incline": 0.3, "heading": 0.5, "speed": 1.0, "turn_rate": 2.0},
    "vertical_disc": {"mass": 2.0, "radius": 0.4, "axle_inertia": 0.3, "diameter_inertia": 0.1, "heading": 0.5, "turn_rate": 3.0},
}
