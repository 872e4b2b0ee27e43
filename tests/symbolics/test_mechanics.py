"""Systems from SymPy's mechanics equal those written by hand, with all coordinates and constraints."""

import functools

import numpy as np
import sympy as sp
from sympy.physics.mechanics import (
    KanesMethod,
    LagrangesMethod,
    Particle,
    PinJoint,
    Point,
    ReferenceFrame,
    RigidBody,
    System,
    dynamicsymbols,
    inertia,
)

import tolerances as tol
import zerodrift as zd
from support import SYSTEMS, assert_close, consistent_states, refused
from symbolic_counterparts import GRAVITY, GROUND, LENGTHS, MASSES, VALUES, rolling_disc

T = dynamicsymbols._t
FROM_ABSOLUTE = np.array([[1, 0, 0], [-1, 1, 0], [0, -1, 1.0]])     # angles of joints from those of links


def four_bar():
    """Three links on pin joints, closed by a constraint."""
    q, u = dynamicsymbols("q1:4"), dynamicsymbols("u1:4")
    wall = parent = RigidBody("wall")
    system, at = System.from_newtonian(wall), None
    for i, (length, mass) in enumerate(zip(LENGTHS, MASSES, strict=True)):
        link = RigidBody(f"link{i}", mass=mass)
        link.central_inertia = inertia(link.frame, 0, 0, mass * length**2 / 12)
        system.add_joints(PinJoint(f"joint{i}", parent, link, q[i], u[i], parent_point=at, child_point=-length / 2 * link.frame.x,
                                   joint_axis=parent.frame.z))
        parent, at = link, length / 2 * link.frame.x
    tip = parent.masscenter.locatenew("tip", at)
    gap = tip.pos_from(system.fixed_point) - GROUND * wall.frame.x
    system.add_holonomic_constraints(gap.dot(wall.frame.x), gap.dot(wall.frame.y))
    system.apply_uniform_gravity(-GRAVITY * wall.frame.y)
    system.q_ind, system.q_dep, system.u_ind, system.u_dep = [q[0]], q[1:], [u[0]], u[1:]
    return system


def weight():
    """V of the four-bar in the angles of its joints."""
    q, height, V, angle = dynamicsymbols("q1:4"), 0, 0, 0
    for each, length, mass in zip(q, LENGTHS, MASSES, strict=True):
        angle += each
        V += mass * GRAVITY * (height + length * sp.sin(angle) / 2)
        height += length * sp.sin(angle)
    return V


START = {"p0": FROM_ABSOLUTE @ SYSTEMS["four_bar"].p0, "v0": FROM_ABSOLUTE @ SYSTEMS["four_bar"].v0}


@functools.cache
def four_bar_of_joints():
    """The four-bar of the joints framework as a system, derived once."""
    system = zd.from_mechanics(four_bar(), potential=weight(), parameters=VALUES, **START)
    assert (system.nq, system.mh, system.mn) == (3, 2, 0)
    assert zd.check(system), zd.check(system)
    return system


def test_the_joints_framework(formulation):
    system = four_bar_of_joints()
    mine, core = (zd.simulate(each, 0.5, step=0.001, formulation=formulation) for each in (system, SYSTEMS["four_bar"]))
    assert_close(mine.p, core.p @ FROM_ABSOLUTE.T, tol.CONVERGED)
    assert_close(mine.multipliers, core.multipliers, 1e-6)
    assert np.abs(mine.energy_violation).max() < 1e-8


def test_kanes_method_with_dependent_coordinates_and_speeds():
    """Eliminated coordinates are restored, and rates of configuration constraints are not separate constraints."""
    framework = four_bar()
    framework.form_eoms()
    kane = zd.from_mechanics(framework.eom_method, parameters=VALUES, **START)
    joints = zd.from_mechanics(framework, parameters=VALUES, **START)
    assert (kane.nq, kane.nv, kane.mh, kane.mn) == (3, 3, 2, 0)
    assert not kane.has_energy
    for t, p, v in consistent_states(joints):
        for name in ("M", "d", "f", "C", "xi"):
            assert_close(getattr(kane.evaluate(p, v, t), name), getattr(joints.evaluate(p, v, t), name), tol.SAME, scale=10.0)


def disc():
    """A rolling disc with angular velocities for speeds, in Kane's equations."""
    yaw, lean, spin, x, y, z = q = dynamicsymbols("yaw lean spin x y z")
    u = dynamicsymbols("u1:7")
    m, R, g = sp.symbols("m R g")
    N = ReferenceFrame("N")
    level = N.orientnew("level", "Axis", [yaw, N.z])
    frame = level.orientnew("frame", "Axis", [lean, level.y])
    body = frame.orientnew("body", "Axis", [spin, frame.x])
    w = body.ang_vel_in(N)
    kinematics = [w.dot(axis) - each for axis, each in zip(frame, u[:3], strict=True)] + [
        each.diff(T) - speed for each, speed in zip((x, y, z), u[3:], strict=True)]
    w = u[0] * frame.x + u[1] * frame.y + u[2] * frame.z
    body.set_ang_vel(N, w)
    origin, centre = Point("origin"), Point("centre")
    origin.set_vel(N, 0)
    centre.set_pos(origin, x * N.x + y * N.y + z * N.z)
    velocity = u[3] * N.x + u[4] * N.y + u[5] * N.z
    centre.set_vel(N, velocity)
    thin = m * R**2 / 4
    rigid = RigidBody("disc", centre, body, m, (inertia(frame, 2 * thin, thin, thin), centre))
    contact = velocity + w.cross(-R * frame.z)
    height = z - R * sp.cos(lean)
    return KanesMethod(
        N, [yaw, lean, spin, x, y], u[:3], kd_eqs=kinematics, q_dependent=[z], configuration_constraints=[height],
        u_dependent=u[3:], velocity_constraints=[contact.dot(N.x), contact.dot(N.y), height.diff(T)], bodies=[rigid],
        forcelist=[(centre, -m * g * N.z)]), q, (m, R, g)


def test_kanes_method_with_quasi_velocities():
    """The disc by its energy, its coordinates and speeds in another order."""
    method, _, (m, R, g) = disc()
    mine = zd.from_mechanics(method, parameters={m: 1.0, R: 0.5, g: 9.81}, potential=m * g * dynamicsymbols("z"))
    assert (mine.nq, mine.nv, mine.mh, mine.mn) == (6, 6, 1, 2)
    core = rolling_disc()
    order = [3, 4, 5, 0, 1, 2]
    for t, p, v in consistent_states(core):
        a, b = mine.evaluate(p[order], v[order], t), core.evaluate(p, v, t)
        assert_close(a.M, b.M[np.ix_(order, order)], tol.SAME, scale=1.0)
        assert_close(a.A, b.A[np.ix_(order, order)], tol.SAME, scale=1.0)
        assert_close(zd.acceleration(mine, p[order], v[order])[0], zd.acceleration(core, p, v)[0][order], 1e-12, scale=10.0)
    mine = mine.starting(core.p0[order], core.v0[order])
    assert zd.check(mine), zd.check(mine)
    a, b = (zd.simulate(system, 1.0, step=0.001) for system in (mine, core))
    assert_close(a.p, b.p[:, order], tol.CONVERGED)


def test_lagranges_method_with_forces_and_both_kinds_of_constraints():
    x, y, phi = q = dynamicsymbols("x y phi")
    m, J, a, c = sp.symbols("m J a c")
    N = ReferenceFrame("N")
    body = N.orientnew("body", "Axis", [phi, N.z])
    edge = Point("edge")
    edge.set_vel(N, x.diff(T) * N.x + y.diff(T) * N.y)
    vx, vy = x.diff(T) - a * phi.diff(T) * sp.sin(phi), y.diff(T) + a * phi.diff(T) * sp.cos(phi)
    L = m * (vx**2 + vy**2) / 2 + J * phi.diff(T) ** 2 / 2 - m * y
    method = LagrangesMethod(L, q, hol_coneqs=[x - sp.sin(y)], nonhol_coneqs=[y.diff(T) * sp.cos(phi) - x.diff(T) * sp.sin(phi)],
                             forcelist=[(edge, -c * edge.vel(N)), (body, -c * phi.diff(T) * N.z)], frame=N)
    given = {"parameters": {m: 1.2, J: 0.1, a: 0.1, c: 0.3}, "p0": [np.sin(0.3), 0.3, 0.4], "v0": [0.0, 0.0, 1.0]}
    one = zd.from_mechanics(method, **given)
    other = zd.symbolic(
        q, kinetic=L + m * y, potential=m * y, constraints=[x - sp.sin(y)], force=[-c * each.diff(T) for each in q],
        nonholonomic=[y.diff(T) * sp.cos(phi) - x.diff(T) * sp.sin(phi)], **given)
    assert (one.mh, one.mn) == (1, 1)
    assert zd.check(one), zd.check(one)
    for name in ("M", "d", "f", "Phi", "C", "xi", "V", "power"):
        assert_close(getattr(one.evaluate(v=[1.0, 2.0, 3.0]), name), getattr(other.evaluate(v=[1.0, 2.0, 3.0]), name), tol.SAME,
                     scale=1.0)


def test_a_potential_of_ones_own_for_a_lagrangian():
    """The part of the Lagrangian that the given potential does not contain is differentiated as a kinetic energy."""
    q, k = dynamicsymbols("q"), sp.Symbol("k")
    system = zd.from_mechanics(LagrangesMethod(q.diff(T) ** 2 / 2 - k * q**2 - q, [q]), potential=k * q**2, parameters={k: 2.0})
    terms = system.evaluate([3.0])
    assert (float(terms.V), (terms.f - terms.d).item()) == (18.0, -13.0)
    assert zd.check(system, [3.0])


def test_what_cannot_be_is_refused():
    q, u, w = dynamicsymbols("q u w")
    N, P = ReferenceFrame("N"), Point("P")
    P.set_vel(N, u * N.x)
    particle = Particle("particle", P, 1)
    with refused("wrong-type", "method"):
        zd.from_mechanics(particle)
    with refused("missing-argument"):
        zd.from_mechanics(KanesMethod(N, [q], [u], kd_eqs=[q.diff(T) - u]))
    with refused("expression", "kinematics 0"):
        zd.from_mechanics(KanesMethod(N, [q], [u], kd_eqs=[q.diff(T) - u - 1], bodies=[particle]))
    with refused("expression"):
        zd.from_mechanics(KanesMethod(N, [q], [u], kd_eqs=[q.diff(T) - u], u_auxiliary=[w], bodies=[particle]))
    with refused("missing-argument"):
        zd.from_mechanics(LagrangesMethod(q.diff(T) ** 2, [q], forcelist=[(P, N.x)]))
