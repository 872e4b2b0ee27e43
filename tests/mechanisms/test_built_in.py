"""Mechanisms that are built in as well, written by hand: the same motion and the same reactions, in both coordinates."""

import numpy as np
import pytest

import energy_models
import tolerances as tol
import zerodrift as zd
from mechanism_tables import (
    Body,
    GeneralizedForce,
    Joint,
    OutputSpec,
    Quantity,
    Relation,
    Tabled,
    Tables,
    in_absolute_coordinates,
    kind,
)
from support import assert_close, solved

COORDINATES = pytest.mark.parametrize("absolute", [False, True], ids=["joint", "absolute"])


def started(tables, poses, rates, law=None, *, absolute=False, **options):
    """A system that starts with these poses and rates of its mass centres."""
    system = Tabled(tables, law=law, **options)
    system.p0, system.v0 = system._core.state(np.array(poses, dtype=float), np.array(rates, dtype=float))
    return in_absolute_coordinates(system, law, **options) if absolute else system


def measures_along(system, sol, name):
    """A measure at every sample."""
    rows = range(len(sol.t))
    vdot = [zd.acceleration(system, sol.p[i], sol.v[i], sol.t[i])[0] for i in rows]
    return np.array([system.measured(name, sol.t[i], sol.p[i], sol.v[i], vdot[i], sol.multipliers[i]) for i in rows])


# ---- the paper's four-bar ----

LENGTHS, MASSES = (0.3, 1.0, 0.6), (1.5, 5.0, 3.0)


def four_bar(p, v, drive=None, *, absolute=False):
    bodies = [Body(m, m * length**2 / 12, inboard=i) for i, (m, length) in enumerate(zip(MASSES, LENGTHS, strict=True))]
    ends = [(0.0, 0.0), *((length / 2, 0.0) for length in LENGTHS[:2]), (1.0, 0.0)]
    joints = [Joint(kind("revolute"), i, i + 1, ends[i], (-LENGTHS[i] / 2, 0.0)) for i in range(3)]
    joints.append(Joint(kind("revolute"), 0, 3, ends[3], (LENGTHS[2] / 2, 0.0)))
    measures = [OutputSpec("D.force", "N", "joint force", 3), OutputSpec("A.torque", "N m", "joint torque", 0)]
    relations = [] if drive is None else [Relation([0], law=0, joint=0)]
    measures += [OutputSpec("drive.torque", "N m", "drive", 0),
                 OutputSpec("drive.power", "W", "drive power", 0)][:2 * len(relations)]
    tables = Tables(bodies, joints, [Quantity("angle", 0, 1)], relations, (), measures, (0.0, -9.81))
    system = Tabled(tables, p, v, drive)
    return in_absolute_coordinates(system, drive) if absolute else system


def test_four_bar_has_the_terms_of_the_paper():
    built_in = zd.systems.four_bar()
    rng = np.random.default_rng(3)
    p, v = rng.normal(size=3), rng.normal(size=3)
    one, other = built_in.evaluate(p, v), four_bar(p, v).evaluate(p, v)
    for name in ("M", "d", "f", "Phi", "C", "xi", "V"):
        assert_close(getattr(other, name), getattr(one, name), tol.SAME, scale=1, what=name)


@COORDINATES
def test_four_bar_moves_as_the_one_built_in(absolute, formulation):
    built_in = zd.systems.four_bar()
    system = four_bar(built_in.p0, built_in.v0, absolute=absolute)
    options = {"step": 1e-3, "save_every": 250, "formulation": formulation}
    one, other = (zd.simulate(each, 0.5, **options) for each in (built_in, system))
    poses = np.array([system._core.poses(p)[0] for p in other.p])
    assert_close(poses[:, :, 2], one.p, tol.CONVERGED, scale=1)
    force = measures_along(system, other, "D.force")        # what holds the tip of link 3
    assert_close(force, -one.multipliers, tol.CONVERGED, scale=1)
    assert_close(other.kinetic_energy, one.kinetic_energy, tol.CONVERGED, scale=1)


@COORDINATES
def test_four_bar_with_a_driven_crank(absolute):
    """The drive is a law of time with its two derivatives; its torque is that of the paper's terms at the rates it prescribes."""
    built_in = zd.systems.four_bar(crank_rate=2.2)

    def law(number, t, x, xdot):
        return [x[0] - built_in.p0[0] - t - 0.4 * np.sin(3 * t), 1.0, -1 - 1.2 * np.cos(3 * t), 3.6 * np.sin(3 * t)]

    system = four_bar(built_in.p0, built_in.v0, law, absolute=absolute)
    sol = zd.simulate(system, 0.5, step=1e-3, save_every=250)
    torque = measures_along(system, sol, "drive.torque")
    for t, p, found in zip(sol.t, sol.p, torque[:, 0], strict=True):
        alpha = system._core.poses(p)[0][:, 2]
        assert abs(law(0, t, alpha, None)[0]) < tol.CONVERGED
        crank, C = np.eye(3)[:1], built_in.evaluate(alpha).C
        e = built_in.evaluate(alpha, np.linalg.solve(np.vstack([C, crank]), [0, 0, 1 + 1.2 * np.cos(3 * t)]))
        lam = solved(e.M, np.vstack([C, crank]), e.f - e.d, [*e.xi, -3.6 * np.sin(3 * t)])[1]
        assert_close(found, -lam[2], tol.CONVERGED, scale=1)
    assert_close(measures_along(system, sol, "A.torque"), torque, tol.SAME, scale=1)
    rates = 1 + 1.2 * np.cos(3 * sol.t)
    assert_close(measures_along(system, sol, "drive.power")[:, 0], torque[:, 0] * rates, tol.CONVERGED, scale=1)
    energy = sol.kinetic_energy + sol.potential_energy
    assert_close(sol.energy_input, energy - energy[0], tol.CONVERGED, scale=1)


# ---- the others ----


@COORDINATES
def test_pendulum_on_a_rod(absolute):
    built_in = zd.systems.pendulum(length=0.7, mass=1.3, angle=1.0, rate=0.5)
    tables = Tables([Body(1.3, is_particle=True)], [Joint(kind("rod"), 0, 1, length=0.7)], gravity=(0.0, -9.81),
                    measures=[OutputSpec("rod.tension", "N", "joint tension", 0)])
    system = started(tables, [[*built_in.p0, 0]], [[*built_in.v0, 0]], absolute=absolute)
    one, other = (zd.simulate(each, 0.5, step=1e-3, save_every=250) for each in (built_in, system))
    assert_close(other.p, one.p, tol.CONVERGED, scale=1)
    assert_close(measures_along(system, other, "rod.tension"), one.multipliers, tol.CONVERGED, scale=1)


@COORDINATES
def test_slider_crank_with_spring_damper_and_force(absolute):
    """A crank without mass but with inertia, a rod with its mass at the slider, which is a point in a slot."""
    by_energies = energy_models.slider_crank().starting(v0=[1.0, -0.5, 0.0])
    bodies = [Body(0.0, 1.0, inboard=0), Body(1.0, 2.0, inboard=1)]
    joints = [Joint(kind("revolute"), 0, 1), Joint(kind("revolute"), 1, 2, (0.5, 0.0), (-1.0, 0.0)), Joint(kind("slot"), 0, 2)]
    quantities = [Quantity("distance", 1, 2, (0.25, 0.0), (-0.5, 0.0), zero=1.0), Quantity("glide", 0, 2, point2=(1.0, 0.0))]
    forces = [GeneralizedForce("spring", 0, 1.0, 1.0), GeneralizedForce("constant", 1, value=1.0)]
    (crank, x, rod), (crank_dot, x_dot, rod_dot) = by_energies.p0, by_energies.v0
    system = started(Tables(bodies, joints, quantities, (), forces), [[0, 0, crank], [x, 0, rod]],
                     [[0, 0, crank_dot], [x_dot, 0, rod_dot]], absolute=absolute)
    options = {"formulation": "augmented"} if absolute else {}      # its mass matrix is singular: the crank has no mass
    one = zd.simulate(by_energies, 2.0, step=1e-3, save_every=500)
    other = zd.simulate(system, 2.0, step=1e-3, save_every=500, **options)
    poses = np.array([system._core.poses(p)[0] for p in other.p])
    assert_close(poses[:, 0, 2], one.p[:, 0], tol.CONVERGED, scale=1)
    assert_close(poses[:, 1, [0, 2]], one.p[:, 1:], tol.CONVERGED, scale=1)


def test_knife_edge_on_a_slope():
    built_in = zd.systems.knife_edge(speed=0.4)
    weight = 9.81 * np.sin(built_in.parameters["incline"])
    tables = Tables([Body(1.25, 0.13)], [Joint(kind("knife_edge"), 1, 1)], gravity=(weight, 0.0),
                    measures=[OutputSpec("edge.force", "N", "joint force", 0)])
    system = Tabled(tables, built_in.p0, built_in.v0)
    one, other = (zd.simulate(each, 1.0, step=1e-3, save_every=250) for each in (built_in, system))
    assert_close(other.p, one.p, tol.CONVERGED, scale=1)
    phi, lam = one.p[:, 2], one.multipliers[:, 0]
    across = -lam[:, None] * np.column_stack([np.sin(phi), -np.cos(phi)])       # with the row of the one built in
    assert_close(measures_along(system, other, "edge.force"), across, tol.CONVERGED, scale=1)
