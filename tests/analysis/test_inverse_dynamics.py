"""Efforts of prescribed motions against closed forms, energy, drives of the system, and simulations that they drive."""

import numpy as np
import pytest

import zerodrift as zd
from analysis.random_efforts import Driven, largest_error
from covering import draws, spread
from support import refused
from zerodrift.analysis.kinematic_result import Kinematics
from zerodrift.analysis.quantities import find
from zerodrift.analysis.state import state

G = 9.81
LAYOUTS = ["joint", "absolute"]


def arm(**motors):
    m = zd.Mechanism("arm", gravity=(0, -G))
    upper = m.link("upper", (0, 0), (0.6, 0), mass=2.0)
    lower = m.link("lower", (0.6, 0), (1.1, 0), mass=1.0)
    m.revolute("hip", m.ground, upper.start)
    m.revolute("knee", upper.end, lower.start)
    for joint, law in motors.items():
        m.motor(f"{joint} drive", joint, **law)
    return m


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("held", [False, True])
def test_forces_that_balance_leave_no_effort_missing(layout, held, recwarn):
    """At rest the forces cancel in each coordinate, except for rounding; a residual of that size is not a missing effort."""
    m = zd.Mechanism("pendulum", gravity=(0, -G))
    link = m.link("link", (0, 0), (0.7, 0.1), mass=1.5)
    m.revolute("pin", m.ground, link.start)
    m.torsion_spring("spring", "pin", stiffness=20.0)
    m.force("push", link.end, value=(0.3, 5.0))
    eq = zd.equilibrium(m.system(layout), hold=["pin.angle"] if held else ())
    inv = zd.inverse_dynamics(eq.system, 0.0, eq.p, eq.v, eq.vdot, efforts=list(eq.effort))
    assert not recwarn.list
    assert inv["pin.force"][0] == pytest.approx([-0.3, 1.5 * G - 5.0], rel=1e-12)


def swing(t):
    return 0.3 + 0.8 * np.sin(2.0 * t)


def bend(t):
    return 0.5 * np.cos(3.0 * t)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_torques_of_an_arm_from_lagrange(layout):
    """Two uniform links with absolute angles a and b; the knee's torque is that of b, the hip's the sum of both."""
    t = np.linspace(0, 2, 41)
    kin = zd.kinematics(arm().system(layout), {"hip.angle": swing, "knee.angle": bend}, t)
    inv = zd.inverse_dynamics(kin.system, kin)
    a, b = swing(t), swing(t) + bend(t)
    da, dda = 1.6 * np.cos(2 * t), -3.2 * np.sin(2 * t)
    db, ddb = da - 1.5 * np.sin(3 * t), dda - 4.5 * np.cos(3 * t)
    L, r, M, m = 0.6, 0.25, 2.0, 1.0
    of_a = ((M / 3 + m) * L**2 * dda + m * L * r * (np.cos(a - b) * ddb + np.sin(a - b) * db**2)
            + (M / 2 + m) * G * L * np.cos(a))
    of_b = m * 4 * r**2 / 3 * ddb + m * L * r * (np.cos(a - b) * dda - np.sin(a - b) * da**2) + m * G * r * np.cos(b)
    assert inv["knee.angle"] == pytest.approx(of_b, abs=1e-10)
    assert inv["hip.angle"] == pytest.approx(of_a + of_b, abs=1e-10)
    assert inv["hip.torque"].shape == (41,)      # of the joint, not of the effort
    named = zd.inverse_dynamics(kin.system, kin, efforts=["hip.torque", "knee.torque"])
    assert named["knee.torque"] == pytest.approx(of_b, abs=1e-10)
    assert inv.residual.max() < 1e-11
    assert (inv.rank == 2).all()
    assert "power" in repr(inv)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_drive_by_a_constraint_has_the_same_torque(layout):
    bar = zd.models.four_bar()
    t = np.linspace(0, 1, 21)

    def turn(t):
        return np.pi / 2 + 2.0 * t + 0.3 * np.sin(5 * t)

    kin = zd.kinematics(bar.system(layout), {"crank.angle": turn}, t)
    inv = zd.inverse_dynamics(kin.system, kin)
    driven = zd.models.four_bar()
    driven.start({"crank.angular_velocity": None, "crank.angle": None})
    driven.motor("drive", "A", angle=lambda t: 2.0 * t + 0.3 * np.sin(5 * t))
    sol = zd.simulate(driven.system(layout), 1.0, step=0.01, t_eval=t)
    assert inv["crank.torque"] == pytest.approx(sol["drive.torque"], abs=1e-7)      # the run is right to 1e-10 in its positions
    assert inv["C.force"] == pytest.approx(sol["C.force"], abs=1e-7)


MODELS = [("four_bar", "crank.angle", 2.0), ("andrews", "K1.angle", 3.0), ("quarter_car", "body guide.displacement", 0.02),
          ("bennett", None, 0.0), ("slider_crank", "crank.angle", 1.0)]


@pytest.mark.parametrize(("name", "measure", "speed"), [each for each in MODELS if each[1]])
@pytest.mark.parametrize("layout", LAYOUTS)
def test_accelerations_under_the_efforts_are_those_prescribed(name, measure, speed, layout):
    system = getattr(zd.models, name)().system(layout)
    names = [measure] if name != "quarter_car" else [measure, "wheel guide.displacement"]
    first = {each: float(find(state(system, 0.0, *system.start_at(0.0)), each, "measure").value[0]) for each in names}
    motion = {each: (lambda t, each=each: first[each] + 0.1 * speed * np.sin(t)) for each in names}
    kin = zd.kinematics(system, motion, np.linspace(0, 1.0, 11))
    inv = zd.inverse_dynamics(system, kin)
    for i in range(len(kin)):
        terms = system.evaluate(kin.p[i], kin.v[i], kin.t[i])
        J = np.vstack([zd.jacobian(system, each, kin.p[i], t=kin.t[i]) for each in names])
        u = np.array([inv.efforts[each][i] for each in names])
        f = (0 if terms.f is None else terms.f) - (0 if terms.d is None else terms.d) + J.T @ u
        C = np.zeros((0, system.nv)) if terms.C is None else terms.C
        xi = np.zeros(len(C)) if terms.xi is None else terms.xi
        matrix = np.block([[terms.M, C.T], [C, np.zeros((len(C), len(C)))]])
        scale = 1 / np.sqrt(np.maximum(np.abs(matrix).max(axis=1), 1e-300))
        right = np.concatenate([f, xi]) * scale
        found = (scale * np.linalg.lstsq(matrix * scale * scale[:, None], right, rcond=1e-14)[0])[:system.nv]
        size = max(1.0, np.abs(kin.vdot[i]).max())
        assert found == pytest.approx(kin.vdot[i], abs=1e-8 * size)      # rounding over inertias of 1e-6 kg m^2


def test_power_is_the_rate_of_the_energy():
    bar = zd.models.four_bar().system("joint")
    t = np.linspace(0, 1, 201)
    kin = zd.kinematics(bar, {"crank.angle": lambda t: np.pi / 2 + 2 * np.sin(2 * t)}, t)
    inv = zd.inverse_dynamics(bar, kin)
    energy = []
    for p, v in zip(kin.p, kin.v, strict=True):
        terms = bar.evaluate(p, v)
        energy.append(v @ terms.M @ v / 2 + terms.V)
    e, h = np.array(energy), t[1]
    rate = (8 * (e[3:-1] - e[1:-3]) - (e[4:] - e[:-4])) / (12 * h)
    assert inv.power[2:-2] == pytest.approx(rate, abs=1e-4 * np.abs(rate).max())     # h^4 of the fifth derivative of the energy
    work = (inv.power[:-1] + inv.power[1:]) / 2 * h
    assert work.sum() == pytest.approx(e[-1] - e[0], rel=1e-4)     # the trapezoidal rule


def test_a_simulation_under_the_computed_torques_follows_the_motion():
    m = arm()
    system = m.system("joint")

    def torques(t):
        kin = zd.kinematics(system, {"hip.angle": swing, "knee.angle": bend}, [t, t + 1.0],
                            near={"hip.angle": swing(t), "knee.angle": bend(t)})
        return zd.inverse_dynamics(system, kin, efforts=["hip.torque", "knee.torque"])

    known = {}

    def torque(name):
        def law(t):
            if t not in known:
                inv = torques(t)
                known[t] = {each: float(inv[each][0]) for each in ("hip.torque", "knee.torque")}
            return known[t][name]
        return law

    driven = arm(hip={"torque": torque("hip.torque")}, knee={"torque": torque("knee.torque")})
    driven.start({"hip.angle": swing(0.0), "knee.angle": bend(0.0), "hip.speed": 1.6, "knee.speed": 0.0})
    sol = zd.simulate(driven.system("joint"), 0.2, step=0.005)
    assert sol["hip.angle"] == pytest.approx(swing(sol.t), abs=1e-9)
    assert sol["knee.angle"] == pytest.approx(bend(sol.t), abs=1e-9)


def test_more_efforts_than_freedoms_are_the_least():
    """Crank and rocker of a four-bar both driven: torques in proportion to the squares of their weights times their rates."""
    bar = zd.models.four_bar()
    kin = zd.kinematics(bar, {"crank.angle": [1.6, 1.7, 1.8]}, speed=1.0)
    one = zd.inverse_dynamics(bar, kin)
    inv = zd.inverse_dynamics(bar, kin, efforts=["crank.angle", "rocker.angle"], weights={"rocker.angle": 2.0})
    ratio = kin["rocker.angular_velocity"] / kin["crank.angular_velocity"]
    assert inv["rocker.torque"] == pytest.approx(4.0 * ratio * inv["crank.torque"], rel=1e-9)
    assert inv["crank.torque"] + ratio * inv["rocker.torque"] == pytest.approx(one["crank.torque"], rel=1e-9)
    assert (inv.rank == 1).all()


def test_fewer_efforts_than_freedoms_are_named():
    t = np.linspace(0, 1, 5)
    kin = zd.kinematics(arm(), {"hip.angle": swing, "knee.angle": bend}, t)
    with pytest.warns(zd.AccuracyWarning, match=r"cannot drive this motion of arm: .* is missing at (upper|lower)\.angle"):
        inv = zd.inverse_dynamics(arm(), kin, efforts=["knee.torque"])
    assert (inv.residual > 1.0).all()
    assert (inv.rank == 1).all()


def test_a_stewart_platform_by_virtual_work():
    """Forces in the legs of a platform that stands: sum of force times Jacobian equals the weight of all bodies."""
    m = zd.models.stewart_platform()
    eq = zd.equilibrium(m)
    drives = [f"drive {i}.force" for i in range(6)]
    system = eq.system
    strokes = [f"stroke {i}.displacement" for i in range(6)]
    legs = np.vstack([zd.jacobian(system, each, eq.p) for each in strokes])
    free = np.linalg.svd(system.evaluate(eq.p, eq.v).C[:-6])[2][15:].T      # the last six constraints are the drives
    weight = system.evaluate(eq.p, eq.v).f
    forces = np.linalg.solve(free.T @ legs.T, -free.T @ weight)
    assert np.array([eq[each] for each in drives]) == pytest.approx(forces, rel=1e-9)


def test_motions_that_violate_constraints_are_refused():
    bar = zd.models.four_bar().system("joint")
    p, v = bar.start_at(0.0)
    vdot = zd.acceleration(bar, p, v)[0]
    assert zd.inverse_dynamics(bar, 0.0, p, v, vdot, efforts=["crank.angle"])["crank.torque"] == pytest.approx([0.0], abs=1e-9)
    for wrong, what in (((p + 0.1, v, vdot), "(3), positions"), ((p, v + 0.1, vdot), "(5), velocities"),
                        ((p, v, vdot + 1.0), "(6), accelerations")):
        with pytest.raises(zd.InconsistentStart, match=what.replace("(", r"\(").replace(")", r"\)")):
            zd.inverse_dynamics(bar, 0.0, *wrong, efforts=["crank.angle"])
    with refused("conflicting-arguments", "efforts"):
        zd.inverse_dynamics(bar, 0.0, p, v, vdot)


@pytest.mark.parametrize("in_space", [False, True])
@pytest.mark.parametrize("layout", LAYOUTS)
def test_efforts_of_random_mechanisms_give_the_accelerations(layout, in_space):
    """200 mechanisms with all draws; nearly dependent rows multiply the rounding of one of them, which is 1.5e-11."""
    errors = np.array([largest_error(seed, in_space, layout) for seed in range(draws(25, 100))], dtype=float)
    assert (errors < 1e-11).sum() >= len(errors) - 1
    assert errors.max() < 1e-10


FOLLOWED = spread([(2, False, "joint"), (2, False, "absolute"), (3, False, "absolute"), (3, False, "joint"), (1, True, "joint"),
                   (4, False, "joint"), (4, False, "absolute"), (2, True, "joint"), (5, True, "joint"), (6, True, "joint"),
                   (1, True, "absolute"), (4, True, "absolute")], 5)


@pytest.mark.parametrize(("seed", "in_space", "layout"), FOLLOWED)
def test_random_mechanisms_follow_a_motion_whose_efforts_are_computed_in_each_stage(seed, in_space, layout):
    """Independent velocities are prescribed; positions after 0.2 s beside their integral by another program."""
    driven = Driven(seed, in_space, layout)
    sol = zd.simulate(driven.system(), 0.2, step=0.01, integrator="dop853", formulation="augmented")
    assert np.abs(sol.p[-1] - sol.p[0]).max() > 0.01
    assert sol.v[-1] == pytest.approx(driven.velocities(0.2, sol.p[-1]), abs=1e-9)
    assert sol.p[-1] == pytest.approx(driven.positions(0.2), abs=1e-9)


def test_masses_are_those_of_the_system_that_is_given():
    bar = zd.models.four_bar()
    kin = zd.kinematics(bar.system("joint"), {"crank.angle": np.linspace(1.6, 2.0, 20)}, speed=1.0)
    masses = {name: 2 * value for name, value in bar.system("joint").parameters.items() if name.endswith((".mass", ".inertia"))}
    light, heavy = (zd.inverse_dynamics(each, kin)["crank.angle"] for each in (bar, bar.with_parameters(masses)))
    assert heavy == pytest.approx(2 * light, rel=1e-9)
    with refused("wrong-element", "motion.*slider_crank.*four_bar"):
        zd.inverse_dynamics(zd.models.slider_crank(), kin)
    of_another_kind = zd.kinematics(zd.systems.four_bar(), {"alpha1": [1.5, 1.6]}, speed=1.0)
    with refused("wrong-element", "motion must be one of four_bar in its coordinates"):
        zd.inverse_dynamics(zd.models.four_bar(), of_another_kind)


def test_an_effort_along_nothing_is_refused():
    bar = zd.models.four_bar()
    kin = zd.kinematics(bar, {"crank.angle": [1.6, 1.7]}, speed=1.0)
    with refused("wrong-measure", r"'A\.force'"):
        zd.inverse_dynamics(bar, kin, efforts=["A.force"])      # a revolute joint: a torque acts along its angle, no force
    with pytest.warns(zd.AccuracyWarning, match="nothing drives this motion of four_bar: .* is missing at crank.angle"):
        zd.inverse_dynamics(bar, kin, efforts=[])
    with refused("not-finite", "^p must"):
        zd.inverse_dynamics(bar, 0.0, [np.nan] * 3, [0.0] * 3, [0.0] * 3, efforts=["crank.angle"])


@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("angle", [0.0, np.pi])
def test_a_piston_cannot_drive_its_crank_at_a_dead_point(angle, layout):
    """The constraints take up what acts there: its part along the motion is the rounding of sin(pi), not a small part of it."""
    m = zd.Mechanism("engine")
    crank, rod = m.link("crank", (0, 0), (0.1, 0), mass=0.5), m.link("rod", (0.1, 0), (0.4, 0), mass=0.3)
    piston = m.particle("piston", 0.4, at=(0.4, 0))
    m.revolute("O", m.ground, crank.start)
    m.revolute("P", crank.end, rod.start)
    m.revolute("W", rod.end, piston)
    m.slot("S", m.ground, piston, axis=(1, 0))
    m.torque("load", crank, value=1.0)
    system = m.system(layout)
    kin = zd.kinematics(system, {"crank.angle": [angle, angle + np.pi / 2]}, speed=10.0)
    with pytest.warns(zd.AccuracyWarning, match=r"piston\.position\.x cannot drive this motion of engine"):
        inv = zd.inverse_dynamics(system, kin, efforts=["piston.position.x"])
    assert inv.rank.tolist() == [0, 1]
    assert inv["piston.position.x"][0] == 0.0
    assert inv["piston.position.x"][1] * kin["piston.velocity.x"][1] == pytest.approx(
        zd.inverse_dynamics(system, kin).power[1], rel=1e-9)
    with refused("missing-argument", "^motion must have rates, .*give t or speed to zd.kinematics"):
        zd.inverse_dynamics(system, zd.kinematics(system, {"crank.angle": [0.0, 0.5]}))


@pytest.mark.parametrize("layout", LAYOUTS)
def test_samples_of_one_call_are_those_of_single_calls(layout):
    """Samples beyond a dead point, which are not known, lie between them."""
    system = zd.models.slider_crank().system(layout)
    t = np.linspace(0, 1, 9)
    kin = zd.kinematics(system, {"crank.angle": lambda t: 1.0 + 0.5 * np.sin(3 * t)}, t)
    moving = [np.array(each) for each in (kin.p, kin.v, kin.vdot)]
    for each in moving:
        each[4] = np.nan
    inv = zd.inverse_dynamics(system, Kinematics(system, t, *moving, {}, ("crank.angle",)))
    assert np.isnan(inv["crank.angle"][4])
    assert inv.rank.tolist() == [1, 1, 1, 1, 0, 1, 1, 1, 1]
    for i in [0, 3, 5, 8]:
        one = zd.inverse_dynamics(system, t[i], kin.p[i], kin.v[i], kin.vdot[i], efforts=["crank.torque"])
        assert inv["crank.angle"][i] == pytest.approx(one["crank.torque"][0], rel=1e-13)
        assert inv.multipliers[i] == pytest.approx(one.multipliers[0], rel=1e-12, abs=1e-13)
        assert inv.power[i] == pytest.approx(one.power[0], rel=1e-13)


@pytest.mark.parametrize("name", ["bennett", "hookes_joint", "planetary_gear"])
@pytest.mark.parametrize("layout", LAYOUTS)
def test_multipliers_of_redundant_constraints_are_the_least(name, layout):
    """In units of 1 / sqrt(C M^-1 C^T), from NumPy's least squares."""
    system = getattr(zd.models, name)().system(layout)
    p, v = system.start_at(0.0)
    terms = system.evaluate(p, v)
    vdot = np.linalg.lstsq(terms.C, terms.xi, rcond=1e-9)[0]
    names = [each.name for each in system.velocities]
    inv = zd.inverse_dynamics(system, 0.0, p, v, vdot, efforts=names)
    force = np.array([inv[each][0] for each in names]) - terms.M @ vdot
    force += (0.0 if terms.f is None else terms.f) - (0.0 if terms.d is None else terms.d)
    size = np.sqrt(np.diag(terms.C @ np.linalg.solve(terms.M, terms.C.T)))
    size[size < 1e-9] = 1.0     # constraints that the tree satisfies
    expected = np.linalg.lstsq((terms.C / size[:, None]).T, force, rcond=1e-9)[0] / size
    assert np.linalg.matrix_rank(terms.C, tol=1e-9) < system.m
    assert inv.multipliers[0] == pytest.approx(expected, rel=1e-9, abs=1e-10 * np.abs(expected).max())


def test_multipliers_of_redundant_constraints_of_what_has_no_mass():
    """Norms of the constraints take the place of the metric of the masses: lambda and 2 lambda of z and 2 z make the force."""
    def mass(p):
        return np.diag([1.0, 0.0])

    system = zd.System(["x", "z"], mass=mass, force=lambda t, p, v: np.array([0.0, -5.0]), p0=[0, 0], v0=[0, 0],
                       constraints=lambda p: p[1] * np.array([1.0, 2.0]), jacobian=lambda p: np.array([[0.0, 1.0], [0.0, 2.0]]),
                       xi=lambda t, p, v: np.zeros(2))
    inv = zd.inverse_dynamics(system, 0.0, [0, 0], [0, 0], [3, 0], efforts=["x"])
    assert inv.multipliers[0] == pytest.approx([-2.5, -1.25])
    assert inv["x"] == pytest.approx([3.0])
    free = zd.System(["x", "z"], mass=mass, p0=[0, 0], v0=[0, 0])
    with refused("singular-system", "has no mass"):
        zd.inverse_dynamics(free, 0.0, [0, 0], [0, 0], [3, 0], efforts=["x"])


def test_a_later_sample_that_violates_a_constraint_is_named():
    bar = zd.models.four_bar().system("joint")
    kin = zd.kinematics(bar, {"crank.angle": np.linspace(1.6, 2.0, 5)}, speed=0.4)
    vdot = np.array(kin.vdot)
    vdot[3, 2] += 1.0
    with pytest.raises(zd.InconsistentStart, match=r"\(6\), accelerations, of four_bar: at t = 0.75 it violates 'C\.[xy]' by"):
        zd.inverse_dynamics(bar, kin.t, kin.p, kin.v, vdot, efforts=["crank.angle"])


@pytest.mark.parametrize("name", ["four_bar", "heavy_top"])
def test_no_samples_need_no_efforts(name):
    system = getattr(zd.models, name)().system()
    none = [np.zeros((0, size)) for size in (system.nq, system.nv, system.nv)]
    inv = zd.inverse_dynamics(system, [], *none, efforts=[system.velocities[0].name])
    assert inv[system.velocities[0].name].shape == inv.residual.shape == (0,)
    assert inv.multipliers.shape == (0, system.m)
