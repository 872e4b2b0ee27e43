"""Linearizations against published eigenvalues, closed forms, periods of runs, and each other in all coordinates."""

import warnings

import numpy as np
import pytest
import scipy.signal

import zerodrift as zd
from support import drawn_in, refused

G = 9.81

# Eigenvalues in 1/s of the benchmark bicycle by speed in m/s: J. P. Meijaard, J. M. Papadopoulos, A. Ruina, A. L. Schwab,
# Linearized dynamics equations for the balance and steer of a bicycle, Proc. R. Soc. A 463 (2007), table 2; of pairs the upper.
PUBLISHED = {
    0.0: [-5.53094371765393, -3.13164324790656, 3.13164324790656, 5.53094371765393],
    1.0: [-7.11008014637441, -3.13423125066578, complex(3.52696170990069, 0.80774027519931)],
    2.0: [-8.67387984831737, -3.07158645641514, complex(2.68234517512745, 1.68066296590676)],
    3.0: [-10.3510146724592, -2.63366137253665, complex(1.70675605663974, 2.31582447384324)],
    4.0: [-12.1586142657644, -1.42944427361326, complex(0.413253315211241, 3.07910818603205)],
    5.0: [-14.0783896927982, complex(-0.775341882195842, 4.46486771378823), -0.322866429004087],
    6.0: [-16.0853712309803, complex(-1.52644486584142, 5.87673060598708), -0.00406690076970336],
    7.0: [-18.157884661252, complex(-2.13875644258363, 7.19525913329804), 0.102681705747664],
    8.0: [-20.2794089439457, complex(-2.69348683581095, 8.46037971396934), 0.143278797657129],
    9.0: [-22.4378855904086, complex(-3.21675402252491, 9.69377351531782), 0.157901840309173],
    10.0: [-24.624596350174, complex(-3.72016840437288, 10.9068113947629), 0.161053386531716],}
WEAVE, CAPSIZE = 4.2923825363411, 6.0242620153884       # m/s, equations (30) and (31) there


def bicycle(speed, layout="joint"):
    return zd.models.whipple_bicycle(speed=speed, roll_rate=0.0).system(layout)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("speed", PUBLISHED)
def test_published_eigenvalues_of_a_bicycle(speed, layout):
    lin = zd.linearize(bicycle(speed, layout))
    found = lin.eigenvalues[lin.eigenvalues.imag >= 0]
    expected = np.array(PUBLISHED[speed], dtype=complex)
    assert len(found) == len(expected)
    assert len(lin.ignored) == 6        # places and headings of the frame, turns of the wheels, and the speed
    assert max(np.abs(found - each).min() for each in expected) < 1e-12 * np.abs(expected).max()
    assert not lin.rate.any()


def test_weave_and_capsize_speeds_of_a_bicycle():
    def real_part(speed):
        values = zd.linearize(bicycle(speed)).eigenvalues
        return values[values.imag > 0].real.max()

    low, high = 4.29, 4.295     # the secant of a smooth function: three steps from 2.5e-3
    for _ in range(4):
        below, above = real_part(low), real_part(high)
        low, high = high, high - above * (high - low) / (above - below)
        if abs(high - low) < 1e-10:
            break
    assert high == pytest.approx(WEAVE, abs=1e-11)
    squares = np.array([25.0, 49.0])        # the product of all four is linear in the square of the speed
    products = np.array([np.prod(zd.linearize(bicycle(np.sqrt(each))).eigenvalues).real for each in squares])
    assert np.sqrt(np.interp(0.0, -products, squares)) == pytest.approx(CAPSIZE, abs=1e-11)


def test_table_of_a_bicycle():
    lin = zd.linearize(zd.models.whipple_bicycle(), v={"frame.velocity.x": 4.6})
    text = repr(lin)
    assert "damping ratio" in text
    assert "steer.angle" in text
    assert "ignored: rear axle.angle" in text


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_nutation_of_a_precessing_top(layout):
    """A top with its axis level: frequency from the second derivative of the effective potential of its nutation."""
    mass, distance, axial, across, spin = 15.0, 1.0, 0.46875, 0.234375, 150.0
    tip = across + mass * distance**2
    slow = mass * G * distance / (axial * spin)       # steady precession with a level axis
    top = zd.models.heavy_top(spin=spin, precession=slow)
    lin = zd.linearize(top.system(layout))
    import sympy

    angle = sympy.Symbol("angle")
    p_phi, p_psi = tip * slow, axial * spin
    potential = (p_phi - p_psi * sympy.cos(angle))**2 / (2 * tip * sympy.sin(angle)**2) + mass * G * distance * sympy.cos(angle)
    expected = np.sqrt(float(potential.diff(angle, 2).subs(angle, sympy.pi / 2)) / tip)
    assert np.abs(lin.eigenvalues - 1j * expected).min() < 1e-9 * expected
    assert lin.rotation == pytest.approx([0.0, 0.0, slow], rel=1e-9, abs=1e-9)
    assert len(lin.eigenvalues) == 2


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_a_free_rotor_nutates_in_fixed_axes(layout):
    """Rotation vectors that do not spin with the body: I3 / I1 times the spin."""
    m = zd.Mechanism("rotor", dimension=3)
    m.body("rotor", 1.0, inertia=(2.0, 2.0, 3.0))
    m.start({"rotor.angular_velocity.z": 5.0})
    lin = zd.linearize(m.system(layout))
    assert sorted(lin.eigenvalues.imag) == pytest.approx([-7.5, 7.5], rel=1e-12)
    assert len(lin.ignored) == 10


def test_frequency_of_a_four_bar_is_that_of_small_oscillations():
    """Periods of three oscillations, extrapolated to zero energy; the period is an analytic function of the energy."""
    bar = zd.models.four_bar().system("joint")
    rest = zd.equilibrium(bar)
    lin = zd.linearize(bar, rest)
    periods, energies = [], []
    for amplitude in (0.08, 0.04, 0.02):
        p, v = zd.assemble(bar, {"crank.angle": rest["crank.angle"] + amplitude, "crank.angular_velocity": 0.0})

        def speed(t, p, v):
            return v[0]

        speed.direction, speed.terminal = -1, 2
        sol = zd.simulate(bar, 10.0, p, v, integrator="dop853", rtol=1e-13, atol=1e-15, events=[speed])
        periods.append(float(np.diff(sol.t_events[0]).mean()))
        energies.append(bar.evaluate(p, np.zeros(3)).V - bar.evaluate(rest.p, np.zeros(3)).V)
    small = np.polyfit(energies, periods, 2)[-1]
    assert 1 / lin.frequencies[0] == pytest.approx(small, rel=1e-9)


@pytest.mark.parametrize("name", ["four_bar", "double_wishbone"])
def test_accelerations_of_every_formulation_have_the_spectrum(name, formulation):
    """A from fourth-order differences of accelerations at states on the constraints; the basis does not move at rest."""
    system = getattr(zd.models, name)().system("joint")
    if formulation not in zd.formulations(system):
        pytest.skip("the system does not have what it needs")
    eq = zd.equilibrium(system)
    lin = zd.linearize(system, eq)

    def flow(state):
        p, v = zd.project(system, *np.split(state, [system.nq]), projection=zd.Projection(tol=1e-13))
        vdot, _ = zd.acceleration(system, p, v, 0.0, formulation)
        return np.concatenate([v if (A := system.evaluate(p, v).A) is None else A @ v, vdot])

    here, h, columns = np.concatenate([eq.p, eq.v]), 1e-3, []
    for column in lin.basis.T:
        step = h * column / max(1.0, np.abs(column).max())
        change = 8 * (flow(here + step) - flow(here - step)) - flow(here + 2 * step) + flow(here - 2 * step)
        columns.append(np.linalg.lstsq(lin.basis, change / 12, rcond=None)[0] * np.abs(column).max(initial=1.0) / h)
    found = np.linalg.eigvals(np.array(columns).T)
    size = np.abs(lin.eigenvalues).max()
    assert max(np.abs(found - each).min() for each in lin.eigenvalues) < 1e-7 * size


@pytest.mark.parametrize("name", ["four_bar", "closed_pendulum", "double_wishbone", "quarter_car", "andrews", "heavy_top"])
def test_spectra_are_the_same_in_all_coordinates(name):
    m = getattr(zd.models, name)()
    spectra = []
    for layout in ("joint", "absolute"):
        system = m.system(layout)
        lin = zd.linearize(system, zd.equilibrium(system))
        spectra.append((lin.eigenvalues, len(lin.ignored)))
    (one, zeros), (other, zeros_too) = spectra
    assert zeros == zeros_too
    assert len(one) == len(other)
    assert max((np.abs(other - each).min() for each in one), default=0.0) < 1e-9 * np.abs(one).max(initial=1.0)


def test_redundant_constraints_change_nothing():
    def lifted(extra):
        m = zd.models.four_bar().lifted()       # loops of hinges in space have redundant constraints
        if extra:
            m.rod("brace", m["crank"].end, m.ground.point((0, 0, 0)))
        return m

    spectra = []
    for extra in (False, True):
        system = lifted(extra).system("absolute")
        spectra.append(zd.linearize(system, zd.equilibrium(system)).eigenvalues)
    plane = zd.models.four_bar()
    spectra.append(zd.linearize(plane, zd.equilibrium(plane)).eigenvalues)
    assert spectra[0] == pytest.approx(spectra[2], rel=1e-8)
    assert spectra[1] == pytest.approx(spectra[2], rel=1e-8)


def driven_pendulum():
    m = zd.Mechanism("pendulum", gravity=(0, -G))
    link = m.link("link", (0, 0), (0, -2.0), mass=3.0)
    m.revolute("pin", m.ground, link.start, damping=0.7)
    return m


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_inputs_outputs_and_responses_in_closed_form(layout):
    mass, length, damping = 3.0, 2.0, 0.7
    inertia, weight = mass * length**2 / 3, mass * G * length / 2
    system = driven_pendulum().system(layout)
    lin = zd.linearize(system, zd.equilibrium(system), inputs=["pin.torque"], outputs=["link.angle", "pin.force.x"])
    assert lin.inputs == ("pin.torque",)
    assert pytest.approx(np.array([[0.0], [mass * length / 2 / inertia]]), abs=1e-10) == lin.D
    omega = np.array([0.3, 2.0, 5.0])
    angle = 1 / (weight + 1j * omega * damping - inertia * omega**2)
    expected = np.column_stack([angle, -mass * length / 2 * omega**2 * angle])
    assert lin.frequency_response(omega)[:, :, 0] == pytest.approx(expected, rel=1e-10)
    _, step = scipy.signal.step(scipy.signal.StateSpace(lin.A, lin.B, lin.C[:1], lin.D[:1]), T=np.linspace(0, 60, 400))
    assert step[-1] == pytest.approx(1 / weight, rel=1e-2)
    assert lin.in_coordinates(["link.angle"]) == pytest.approx(
        np.array([[0, 1], [-weight / inertia, -damping / inertia]]), abs=1e-10)
    assert lin.damping == pytest.approx([damping / 2 / np.sqrt(inertia * weight)] * 2, rel=1e-10)


def test_an_undamped_resonance_is_infinite():
    lin = zd.linearize(zd.systems.oscillator(stiffness=4.0), (0.0, [0.0], [0.0]), inputs=["x"], outputs=["x"])
    found = lin.frequency_response([1.0, 2.0, 3.0])[:, 0, 0]
    assert found[[0, 2]] == pytest.approx([1 / 3, -1 / 5], rel=1e-9)
    assert np.abs(found[1]) > 1e9           # as far as A is the exact one, infinite
    m = zd.Mechanism("stone")
    m.particle("stone", 1.0, at=(0, 0))
    free = zd.linearize(m, inputs=["stone.position.x"], outputs=["stone.position.x"])
    found = free.frequency_response([0.0, 2.0])[:, 0, 0]
    assert np.isinf(np.abs(found[0]))
    assert found[1] == pytest.approx(-1 / 4, rel=1e-12)


def test_the_governor_turns_at_the_angle_of_its_closed_form():
    for layout in ("joint", "absolute"):
        system = zd.models.flyball_governor().system(layout)
        for speed in (12.5, 20.0):
            eq = zd.equilibrium(system, v={"bearing.speed": speed})
            hang = np.arccos((2.0 + 5.0) * G / (2.0 * 0.25 * speed**2))
            drawn = np.arccos((2.0 + 5.0) * G / (2.0 * 0.25 * 14.0**2))
            assert eq["hinge 0.angle"] == pytest.approx(hang - drawn, abs=1e-10)
            assert eq["hinge 1.angle"] == pytest.approx(hang - drawn, abs=1e-10)
            assert eq["bearing.speed"] == pytest.approx(speed, rel=1e-12)
            assert eq.stable is None        # undamped: eigenvalues on the imaginary axis


def test_an_instant_of_a_motion_is_flagged():
    with pytest.warns(zd.AccuracyWarning, match="not in an equilibrium or a steady motion"):
        lin = zd.linearize(zd.models.four_bar())
    assert lin.rate.any()
    with pytest.warns(zd.AccuracyWarning, match="not in an equilibrium or a steady motion"):     # by its jerk: it passes 0
        passing = zd.linearize(zd.systems.oscillator(), (0.0, [0.0], [0.3]))
    assert passing.basis @ passing.rate == pytest.approx([0.3, 0.0], abs=1e-15)
    assert "A is that of an instant" in repr(passing)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("what_acts", ["gravity", "spring"])
def test_the_rounding_of_an_equilibrium_is_not_a_motion(what_acts, layout):
    """Forces that cancel in joint coordinates leave nothing but rounding, to which no acceleration of their own compares."""
    m = zd.Mechanism("pendulum", gravity=(0, -G) if what_acts == "gravity" else (0, 0))
    link = m.link("link", (0, 0), (0, -1), mass=1.0)
    m.revolute("pin", m.ground, link.start)
    if what_acts == "spring":
        m.spring("spring", m.ground.point((2.1, 1.3)), link.end, stiffness=1e4, length=0.1)
    rest = zd.equilibrium(m.system(layout))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        lin = zd.linearize(rest.system, (0.0, rest.p, rest.v))
    assert not lin.rate.any()
    assert zd.linearize(rest.system, rest).eigenvalues == pytest.approx(lin.eigenvalues, rel=1e-9)
    for v in ({}, {"pin.speed": 0.0}):
        assert zd.equilibrium(rest.system, near=rest.p, v=v)["link.angle"] == pytest.approx(rest["link.angle"], abs=1e-9)


def slopes(function, at, h=1e-3):
    """Jacobian by central differences of fourth order: errors of h^4 = 1e-12 and of rounding, 1e-16 / h."""
    return np.array([(8 * (function(at + e) - function(at - e)) - function(at + 2 * e) + function(at - 2 * e)) / (12 * h)
                     for e in h * np.eye(len(at))]).T


def at_an_instant(system, at=None):
    with pytest.warns(zd.AccuracyWarning, match="A is that of an instant"):
        return zd.linearize(system, at)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_a_pendulum_passes_its_lowest_point(layout):
    m = zd.Mechanism("pendulum", gravity=(0, -G))
    link = m.link("link", (0, 0), (0, -1), mass=1.0)
    m.revolute("pin", m.ground, link.start)
    m.start({"link.angular_velocity": 2.0})
    system = m.system(layout)
    lin = at_an_instant(system)
    assert lin.in_coordinates(["link.angle"]) == pytest.approx(np.array([[0, 1], [-1.5 * G, 0]]), abs=1e-9)
    p, v = system.start_at(0.0)
    assert lin.basis @ lin.rate == pytest.approx(np.concatenate([v, zd.acceleration(system, p, v)[0]]), abs=1e-11)


@pytest.mark.parametrize("speeds", [(1.2, -2.0), (0.0, 0.0)])
def test_an_instant_of_a_double_pendulum_has_the_jacobian_of_its_equations(speeds):
    m = zd.Mechanism("double pendulum", gravity=(0, -G))
    upper, lower = m.link("upper", (0, 0), (0.7, 0), mass=1.3), m.link("lower", (0.7, 0), (1.2, 0), mass=0.8)
    m.revolute("A", m.ground, upper.start)
    m.revolute("B", upper.end, lower.start)
    system = m.system("joint")
    start = np.array([0.3, -0.8, *speeds])

    def flow(state):
        return np.concatenate([state[2:], zd.acceleration(system, state[:2], state[2:])[0]])

    lin = at_an_instant(system, (0.0, start[:2], start[2:]))
    expected = slopes(flow, start)
    assert lin.basis @ lin.A @ np.linalg.inv(lin.basis) == pytest.approx(expected, abs=1e-8 * np.abs(expected).max())
    assert lin.basis @ lin.rate == pytest.approx(flow(start), abs=1e-11 * np.abs(flow(start)).max())


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_an_instant_of_a_four_bar(layout):
    """In the crank's angle the Jacobian of the reduced equation of motion; in z, that of N^+ (v, vdot), along the crank."""
    system = zd.models.four_bar().system(layout)
    now = zd.simulate(system, 0.7, step=2e-3).at(0.7)

    def state(crank):
        p, v = zd.assemble(system, {"crank.angle": crank[0], "crank.angular_velocity": crank[1]})
        return np.concatenate([p, v])

    def flow(crank):
        p, v = np.split(state(crank), [system.nq])
        return np.concatenate([v, zd.acceleration(system, p, v)[0]])

    crank = np.array([now["crank.angle"], now["crank.angular_velocity"]])
    lin = at_an_instant(system, (0.0, *np.split(state(crank), [system.nq])))
    row = np.ravel(zd.jacobian(system, "crank.angle", now.p))       # the same in all positions
    expected = slopes(lambda at: row @ np.reshape(flow(at), (2, -1)).T, crank)
    assert expected[0] == pytest.approx([0, 1], abs=1e-11)
    assert lin.in_coordinates(["crank.angle"]) == pytest.approx(expected, abs=1e-8 * np.abs(expected).max())
    (W, _), (Y, V) = (np.hsplit(part, 2) for part in np.vsplit(lin.basis, 2))
    M = zd.mass_matrix(system, now.p)
    inverse = np.vstack([np.hstack([W.T @ M, 0 * W.T]), V.T @ M @ np.hstack([-Y @ W.T @ M, np.eye(system.nv)])])
    assert inverse @ lin.basis == pytest.approx(np.eye(2), abs=1e-11)
    left, right = lin.A @ slopes(lambda at: inverse @ state(at), crank), slopes(lambda at: inverse @ flow(at), crank)
    assert left == pytest.approx(right, abs=1e-8 * np.abs(right).max())
    assert lin.basis @ lin.rate == pytest.approx(flow(crank), abs=1e-10 * np.abs(flow(crank)).max())


def test_an_instant_of_a_tumbling_body_is_that_of_euler_s_equations():
    """Rotations x = 2 e, twice the vector part of the quaternion, from I w' = -w x I w in the body's axes."""
    inertia, spin = np.array([1.0, 2.0, 3.0]), np.array([1.0, -0.5, 2.0])
    m = zd.Mechanism("rotor", dimension=3)
    m.body("rotor", 1.0, inertia=tuple(inertia))
    m.start({f"rotor.angular_velocity.{axis}": value for axis, value in zip("xyz", spin, strict=True)})

    def flow(y):
        e, e_dot = y[:3] / 2, y[3:] / 2
        e0 = np.sqrt(1 - e @ e)
        e0_dot = -e @ e_dot / e0
        w = 2 * (e0 * e_dot - e0_dot * e - np.cross(e, e_dot))         # in the body's axes
        w_dot = -np.cross(w, inertia * w) / inertia
        e_ddot = (e0_dot * w + np.cross(e_dot, w) + e0 * w_dot + np.cross(e, w_dot)) / 2
        return np.concatenate([y[3:], 2 * e_ddot])

    names = [f"rotor rotation about {axis}" for axis in "xyz"]
    found = at_an_instant(m.system("joint")).in_coordinates(names)
    assert found == pytest.approx(slopes(flow, np.concatenate([np.zeros(3), spin])), abs=1e-9)
    with refused("wrong-measure", "^names must be independent quantities that determine their motion"):
        at_an_instant(m.system("joint")).in_coordinates(names[:1])


def test_what_is_wrong_is_refused():
    bar = zd.models.four_bar()
    rest = zd.equilibrium(bar)
    with refused("wrong-name", r"'A\.fource'"):
        zd.linearize(bar, rest, outputs=["A.fource"])
    with pytest.raises(zd.InconsistentStart, match="must satisfy the constraints"):
        zd.linearize(bar, (0.0, rest.p + 0.1, rest.v))
    with refused("wrong-type", "^at must"):
        zd.linearize(bar, 3)
    with refused("wrong-measure", "names.*be 1"):
        zd.linearize(bar, rest).in_coordinates(["crank.angle", "rocker.angle"])
    with refused("wrong-measure", "^names must be quantities of positions, and 'crank.angular_velocity' is a velocity"):
        zd.linearize(bar, rest).in_coordinates(["crank.angular_velocity"])


def test_pictures_of_modes_and_root_loci():
    import matplotlib as mpl

    mpl.use("Agg")
    speeds = [2.0, 4.0, 6.5]
    lins = [zd.linearize(bicycle(speed)) for speed in speeds]
    ax = zd.plot.root_locus(lins, speeds, label="speed [m/s]")
    assert len(ax.collections[0].get_offsets()) == 12
    assert ax.get_xlabel() == "real part [1/s]"
    bar = zd.models.four_bar()
    ax = zd.plot.mode(zd.linearize(bar, zd.equilibrium(bar)), 0, amplitude=0.1)
    assert len(ax.lines) == 3       # both extremes, and the rest position
    with refused("out-of-range", "index.*of 2"):
        zd.plot.mode(zd.linearize(bar, zd.equilibrium(bar)), 2)
    assert zd.plot.mode(lins[1], 1).lines


def test_a_boom_that_an_effort_holds():
    """A link at the angle a under a constant torque: inertia z'' = weight sin(a) z, unstable above the horizontal."""
    m = zd.Mechanism("boom", gravity=(0, -G))
    link = m.link("boom", (0, 0), (1.5, 0), mass=2.0)
    m.revolute("foot", m.ground, link.start)
    eq = zd.equilibrium(m, near={"boom.angle": 0.5}, hold=["boom.angle"])
    lin = zd.linearize(m, eq)
    assert (lin.eigenvalues**2).real == pytest.approx([1.5 * G / 1.5 * np.sin(0.5)] * 2, rel=1e-10)


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_a_disc_that_rolls_in_a_circle_against_differences_of_runs(layout):
    """Height and turning, which do not depend on the frame, along exp(A t) and in two runs that start apart."""
    from scipy.linalg import expm

    system = zd.models.rolling_disc().system(layout)
    p, v = system.start_at(0.0)
    outputs = ["disc.position.z", "disc.angular_velocity.z"]
    lin = zd.linearize(system, (0.0, p, v), outputs=outputs)
    assert lin.rotation[2] == pytest.approx(zd.simulate(system, 1e-3, step=1e-3)["disc.velocity.x"][-1] / -v[1] / 1e-3, rel=1e-5)
    z = drawn_in(lin.basis, np.random.default_rng(2))
    dp, dv = np.split(lin.basis @ z, [system.nq])
    apart, sols = 1e-5, []
    for sign in (1, -1):
        start = zd.project(system, p + sign * apart * dp, v + sign * apart * dv, projection=zd.Projection(tol=1e-13))
        sols.append(zd.simulate(system, 0.6, *start, step=1e-3, save_every=100))
    for name, row in zip(outputs, lin.C, strict=True):
        found = np.array([row @ expm(lin.A * t) @ z for t in sols[0].t])
        expected = (sols[0][name] - sols[1][name]) / (2 * apart)
        assert found == pytest.approx(expected, abs=1e-6 * np.abs(expected).max())


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_the_steady_circle_of_a_disc_is_routh_s(layout):
    radius, mass = 0.5, 1.0
    C, A = mass * radius**2 / 2, mass * radius**2 / 4
    disc = zd.models.rolling_disc(nudge=0.05).system(layout)
    eq = zd.equilibrium(disc, v={"disc.angular_velocity.z": 0.9})
    assert eq["disc.angular_velocity.z"] == pytest.approx(0.9, rel=1e-12)
    turning = zd.linearize(eq.system, eq).rotation[2]
    sine = eq["disc.position.z"] / radius       # of the angle between axle and vertical
    cosine = np.sqrt(1 - sine**2)
    spin = (0.9 - turning * sine**2) / cosine       # from the part of the angular velocity about the vertical
    assert spin * turning * sine * (C + mass * radius**2) == pytest.approx(
        cosine * (A * turning**2 * sine - mass * G * radius), rel=1e-9)


@pytest.mark.parametrize("names", [None, ["steer.angle", "frame rotation about x"]])
def test_a_reduced_linearization_has_the_same_responses_and_eigenvalues(names):
    """A bicycle at 5 m/s, whose place and heading nothing depends on."""
    lin = zd.linearize(zd.models.whipple_bicycle(speed=5.0, roll_rate=0.0), inputs=["steer.torque"], outputs=["steer.angle"])
    if names and names[1] not in lin.names:
        names = ["steer.angle", next(each for each in lin.names if "rotation about x" in each or "roll" in each)]
    reduced = lin.reduced(names)
    assert reduced.ignored == ()
    assert len(reduced.A) == len(lin.eigenvalues) == 4 < len(lin.A)
    assert np.sort_complex(reduced.eigenvalues) == pytest.approx(np.sort_complex(lin.eigenvalues), rel=1e-8)
    omega = [0.3, 2.0, 11.0]
    assert reduced.frequency_response(omega) == pytest.approx(lin.frequency_response(omega), rel=1e-8)
    scipy = pytest.importorskip("scipy.linalg")
    X = scipy.solve_continuous_are(reduced.A, reduced.B, np.eye(4), np.eye(1))
    assert np.linalg.eigvals(reduced.A - reduced.B @ reduced.B.T @ X).real.max() < -0.1
    if names:
        assert reduced.names[:2] == tuple(names)
        assert reduced.A[:2] == pytest.approx(np.eye(4)[2:], abs=1e-9)
        assert pytest.approx(lin.in_coordinates(names), rel=1e-12) == reduced.A


def test_outputs_that_depend_on_ignorable_coordinates_are_named():
    m = zd.Mechanism("cart", gravity=(0, -9.81))
    cart, pole = m.body("cart", 1.0, 0.1), m.link("pole", (0, 0), (0, 1), mass=0.1)
    m.prismatic("rail", m.ground, cart, axis=(1, 0))
    m.revolute("pin", cart.point((0, 0)), pole.start)
    lin = zd.linearize(m, inputs=["rail.force"], outputs=["pin.angle", "rail.displacement"])
    with refused("wrong-measure", "rail.displacement"):
        lin.reduced()
    reduced = zd.linearize(m, inputs=["rail.force"], outputs=["pin.angle"]).reduced(["pin.angle"])
    half, total = 0.5, 1.1        # (J + m l^2) a - m l x'' = m g l theta, with x'' from the sum of all forces, about the centre
    inertia = 0.1 / 3 - (0.1 * half)**2 / total
    assert pytest.approx(np.array([[0, 1], [0.1 * 9.81 * half / inertia, 0]]), rel=1e-6, abs=1e-9) == reduced.A
    assert reduced.B[1, 0] == pytest.approx(0.1 * half / total / inertia, rel=1e-6)
    assert pytest.approx(np.array([[1.0, 0.0]])) == reduced.C
