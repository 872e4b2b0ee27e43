"""Laws from data: splines as SciPy's, prescribed motions with their speeds, and what is refused."""

import contextlib
import gc
import pickle
import tempfile
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline, PPoly, make_interp_spline, make_smoothing_spline

import zerodrift as zd
from native_systems import COMPILER, needs_compiler
from support import assert_close, called, refused
from zerodrift.laws.table import from_json


@pytest.mark.parametrize("n", [2, 3, 4, 5, 30])
def test_a_table_is_the_spline_of_scipy(n):
    random = np.random.default_rng(n)
    x, y = np.cumsum(random.uniform(0.1, 1.0, n)), random.normal(size=n)
    given, known = zd.table(x, y), CubicSpline(x, y)
    at = np.linspace(x[0], x[-1], 101)
    assert_close([given(each) for each in at], known(at), 1e-12, scale=np.abs(y).max())


X, Y = np.array([-1.0, 0.5, 2.0, 2.5, 4.0]), np.array([3.0, -1.0, 2.0, 2.5, 3.0])
INSIDE = {"smooth": CubicSpline(X, Y), "linear": lambda at: np.interp(at, X, Y),
          "steps": lambda at: Y[np.clip(np.searchsorted(X, at, side="right") - 1, 0, 4)]}
SLOPES = {"smooth": INSIDE["smooth"](X[[0, -1]], 1), "linear": [-4 / 1.5, 0.5 / 1.5], "steps": [0.0, 0.0]}


def expected(kind, beyond, at):
    within, (first, last) = np.clip(at, X[0], X[-1]), SLOPES[kind] if beyond == "line" else (0.0, 0.0)
    if beyond == "period":
        within = X[0] + (at - X[0]) % (X[-1] - X[0])
        return CubicSpline(X, Y, bc_type="periodic")(within) if kind == "smooth" else INSIDE[kind](within)
    return INSIDE[kind](within) + first * np.minimum(at - X[0], 0) + last * np.maximum(at - X[-1], 0)


@pytest.mark.parametrize("beyond", ["error", "hold", "line", "period"])
@pytest.mark.parametrize("kind", INSIDE)
def test_kinds_and_ends(kind, beyond):
    given = zd.table(X, Y, kind=kind, beyond=beyond)
    at = X if beyond == "error" else np.array([-9.0, -1.5, *X[:-1], 4.1, 13.0])
    at = np.concatenate([at, np.linspace(-1, 3.9, 50)])
    assert_close([given(each) for each in at], expected(kind, beyond, at), 1e-12, scale=3.0)
    restored = pickle.loads(pickle.dumps(given))
    assert [restored(each) for each in at] == [given(each) for each in at]
    assert repr(restored) == repr(given)


def test_periods_of_angles_add_whole_turns():
    """A crank that turns unevenly: twice about in a period."""
    t = np.linspace(0, 1, 9)
    turning = zd.table(t, 4 * np.pi * t + 0.1 * np.sin(2 * np.pi * t), beyond="period")
    assert_close([turning(at + 3) - turning(at) for at in t], np.full(9, 12 * np.pi), 1e-14)
    assert_close(turning(-0.5) + 4 * np.pi, turning(0.5), 1e-14)
    sol = zd.simulate(driven(turning), 2.6, step=0.01, integrator="dop853")
    known = CubicSpline(t, 0.1 * np.sin(2 * np.pi * t) * (t < 1), bc_type="periodic")
    assert_close(sol["pin.angle"], 4 * np.pi * sol.t + known(sol.t % 1), 1e-12, scale=1.0)
    assert_close(sol["pin.speed"], 4 * np.pi + known(sol.t % 1, 1), 1e-10, scale=1.0)
    assert_close(sol["link.angular_acceleration"], known(sol.t % 1, 2), 1e-9, scale=4.0)


# ---- noise ----

NOISY = np.sort(np.random.default_rng(1).uniform(0, 2, 200))
NOISE = np.random.default_rng(2).normal(size=200) / 50


@pytest.mark.parametrize("noise", [1e-5, 0.02, 0.3])
def test_noise_is_the_distance_of_the_smoothing_spline(noise):
    y = np.sin(3 * NOISY) + NOISE
    given = zd.table(NOISY, y, noise=noise)
    off = np.array([given(t) for t in NOISY]) - y
    assert_close(np.sqrt(np.mean(off**2)), noise, 1e-7)
    weight = float(repr(given).partition("smoothing parameter ")[2].strip(">"))
    at = np.linspace(NOISY[0], NOISY[-1], 77)
    assert_close([given(t) for t in at], make_smoothing_spline(NOISY, y, lam=weight)(at), 1e-5, scale=1.0)


def test_noise_above_that_of_a_line_gives_the_line():
    given = zd.table(NOISY, 2 + 3 * NOISY + NOISE, noise=0.03)
    slope, value = np.polyfit(NOISY, 2 + 3 * NOISY + NOISE, 1)
    assert_close([given(t) for t in NOISY], value + slope * NOISY, 1e-12)
    assert repr(given).endswith("smoothing parameter inf>")


def test_measured_motions_take_few_steps():
    """2,001 samples of a motion: through all of them, steps would follow the noise."""
    t = np.linspace(0, 2, 2001)
    angle = np.sin(3 * t) + 1e-3 * np.random.default_rng(3).normal(size=t.size)
    sol = zd.simulate(driven(zd.table(t, angle, noise=1e-3)), 1.9, rtol=1e-6, atol=1e-6)
    assert sol.stats["steps"] < 1500
    assert_close(sol["pin.angle"], np.sin(3 * sol.t), 2e-3, scale=1.0)
    assert_close(sol["pin.speed"][5:-5], 3 * np.cos(3 * sol.t[5:-5]), 0.1, scale=1.0)


# ---- grids ----

A, B = np.linspace(-2, 2, 6), np.array([0.0, 0.3, 1.0, 1.5])
Z = np.sin(A)[:, None] * np.cos(B) + A[:, None] * B**2 - 3


def on_grid(a, b):
    return CubicSpline(B, CubicSpline(A, Z, axis=0)(a))(b)


def test_a_grid_is_a_spline_in_each_argument():
    given = zd.table((A, B), Z, argument=("a", "b"))
    assert_close([given(a, b=b) for a in (-2, 0.3, 1.9) for b in (0, 0.7, 1.5)],
                 [on_grid(a, b) for a in (-2, 0.3, 1.9) for b in (0, 0.7, 1.5)], 1e-13, scale=5.0)
    linear = zd.table((A, B), Z, argument=("a", "b"), kind="linear", beyond="hold")
    for a, b in ((-2.5, 0.5), (0.1, 0.2), (9.0, 9.0)):
        assert_close(linear(b=b, a=a), np.interp(b, B, [np.interp(a, A, column) for column in Z.T]), 1e-13)
    assert repr(linear) == "<table of 6 x 4 points, a = -2 ... 2, b = 0 ... 1.5, linear, hold>"
    with refused("out-of-range", "from b = 0 to 1.5"):
        given(0.0, 2.0)


def test_a_force_on_a_grid_is_its_spline():
    """A force that depends on place and time, against an integration of SciPy's splines."""
    m = thrown(zd.table((A, B), Z, argument=("x", "t")), 1.0)
    times = np.linspace(0, 1.2, 13)
    known = solve_ivp(lambda t, y: [y[1], on_grid(y[0], t)], (0, 1.2), [0.0, 1.0], t_eval=times, rtol=1e-11, atol=1e-11)
    for system in (m.system(), m.system(compiled=False), there_and_back(m), pickle.loads(pickle.dumps(m.system()))):
        sol = zd.simulate(system, 1.2, t_eval=times, rtol=1e-10, atol=1e-10)
        assert_close(sol["guide.displacement"], known.y[0], 1e-8, scale=1.0)
    with refused("out-of-range", "from x = -2 to 2"):
        zd.simulate(m, 1.7, step=0.01)


@pytest.mark.parametrize(("x", "z", "argument", "code"), [
    ((A, B), Z.T, ("a", "b"), "shape"), ((A, B), Z, "a", "shape"), ((A, B, B), Z, ("a", "b"), "shape"),
    ((A, B[::-1]), Z, ("a", "b"), "not-increasing"), ((A, B), Z + np.nan, ("a", "b"), "shape")])
def test_grids_that_are_refused(x, z, argument, code):
    with refused(code):
        zd.table(x, z, argument=argument)


# ---- mechanisms ----


def driven(law):
    m = zd.Mechanism("crank", gravity=(0, -9.81))
    link = m.link("link", (0, 0), (1, 0), mass=1.0)
    pin = m.revolute("pin", m.ground, link.start)
    m.motor("drive", pin, angle=law)
    return m


@pytest.mark.parametrize("make", [zd.table, CubicSpline])
def test_a_prescribed_motion_has_the_derivatives_of_the_spline(make):
    t = np.linspace(0, 2, 21)
    sol = zd.simulate(driven(make(t, np.sin(3 * t))), 2.0, step=0.01, integrator="dop853")
    known = CubicSpline(t, np.sin(3 * t))
    assert_close(sol["pin.angle"], known(sol.t), 1e-12, scale=1.0)
    assert_close(sol["pin.speed"], known(sol.t, 1), 1e-11, scale=1.0)
    assert_close(sol["link.angular_acceleration"], known(sol.t, 2), 1e-10, scale=1.0)


def test_a_force_from_measured_data():
    """A spring of measured stiffness, F = -20 x exactly: the oscillator of 20 rad^2/s^2."""
    m = zd.Mechanism("spring")
    body = m.body("body", 1.0, at=(0.1, 0))
    guide = m.prismatic("guide", m.ground, body, axis=(1, 0), at=(0, 0))
    x = np.linspace(-1, 1, 41)
    m.force("spring", body, along=(1, 0), value=zd.table(x, -20 * x, argument="x"), of={"x": guide.displacement})
    m.start({"guide.displacement": 0.1})
    sol = zd.simulate(m, 2.0, rtol=1e-10, atol=1e-10)
    assert_close(sol["guide.displacement"], 0.1 * np.cos(np.sqrt(20) * sol.t), 1e-8, scale=1.0)


def arm(drive, spring):
    """Two links: the first follows a motion, and a torque that depends on the second angle acts on the other."""
    m = zd.Mechanism("arm", gravity=(0, -9.81))
    first, second = m.link("first", (0, 0), (1, 0), mass=1.0), m.link("second", (1, 0), (1, 1), mass=1.0)
    pin, elbow = m.revolute("pin", m.ground, first.start), m.revolute("elbow", first.end, second.start)
    m.motor("drive", pin, angle=drive)
    m.torque("spring", second, value=spring, of={"q": elbow.angle})
    return m


TIMES, ANGLES = np.linspace(0, 2, 21), np.linspace(-30, 30, 61)


def motion():
    return zd.table(TIMES, np.sin(3 * TIMES) / 2)


def stiffening():
    return zd.table(ANGLES, -ANGLES - ANGLES**3 / 100, argument="q")


@pytest.mark.parametrize("compiled", [None, pytest.param(True, marks=needs_compiler)])
@pytest.mark.parametrize("other", ["table", "expression"])
def test_tables_are_in_closed_form(compiled, other):
    """As functions of Python that call the same tables, by matrices; with an expression of SymPy beside, too."""
    q = pytest.importorskip("sympy").Symbol("q")
    tables, spring = (motion(), stiffening()), -q - q**3 / 100
    m = arm(tables[0], tables[1] if other == "table" else spring)
    asked = arm(called(lambda t: tables[0](t)), called(lambda q: tables[1](q)) if other == "table" else spring)
    ours, theirs = zd.simulate(m.system(compiled=compiled), 2.0, step=0.01), zd.simulate(asked, 2.0, step=0.01)
    assert ours.stats["closed_form_steps"] == ours.stats["steps"]
    assert theirs.stats["closed_form_steps"] == 0
    assert_close(ours.p, theirs.p, 1e-10, scale=1.0)
    assert_close(ours["pin.torque"], theirs["pin.torque"], 1e-8, scale=abs(theirs["pin.torque"]).max())


TURN = np.linspace(-np.pi, np.pi, 9)
LAWS = {"linear, hold": (lambda: zd.table([-1, 0, 1], [2, 0, -2], argument="q", kind="linear", beyond="hold"),
                         lambda q: np.interp(q, [-1, 0, 1], [2, 0, -2])),
        "steps, hold": (lambda: zd.table([-1, 0, 1], [2, 1, -2], argument="q", kind="steps", beyond="hold"),
                        lambda q: 2.0 if q < 0 else 1.0 if q < 1 else -2.0),
        "line": (lambda: zd.table([-0.1, 0, 0.1], [1, 0, -1], argument="q", beyond="line"), lambda q: -10 * q),
        "period": (lambda: zd.table(TURN, np.sin(2 * TURN), argument="q", beyond="period"),
                   lambda q: CubicSpline(TURN, np.r_[np.sin(2 * TURN)[:-1], np.sin(-2 * np.pi)], bc_type="periodic")(
                       (q + np.pi) % (2 * np.pi) - np.pi))}


@pytest.mark.parametrize("name", LAWS)
def test_kinds_and_ends_on_each_path(name):
    """By matrices, in closed form, compiled, from a file and in lanes, against functions of NumPy and SciPy."""
    make, called = LAWS[name]
    m = arm(motion(), make())
    known = zd.simulate(arm(CubicSpline(TIMES, np.sin(3 * TIMES) / 2), called), 2.0, step=0.01)
    assert np.ptp(known["elbow.angle"]) > 1
    systems = [m.system(), m.system(compiled=False), there_and_back(m).system(), pickle.loads(pickle.dumps(m.system()))]
    runs = [zd.simulate(system, 2.0, step=0.01) for system in systems]
    runs += [zd.simulate(systems[0], 2.0, step=0.01, closed_form=False)]
    if COMPILER:
        runs += [zd.simulate(m.system(compiled=True), 2.0, step=0.01)]
    for sol in runs:
        assert_close(sol.p, known.p, 1e-10, scale=1.0)
        assert_close(sol["spring.torque"], known["spring.torque"], 1e-8, scale=1.0)
    many = zd.ManyRuns(systems[0], runs=20, step=0.01)
    many.step(200)
    assert_close(many.p, np.tile(known.p[-1], (20, 1)), 1e-10, scale=1.0)


def there_and_back(m):
    with tempfile.TemporaryDirectory() as folder:
        return zd.load(m.save(Path(folder) / "m"))


KINK = np.array([0.0, 1.0, 2.0]), np.array([0.0, 1.0, 0.0])
RAMP = zd.table(*KINK, kind="linear")
REFUSED = {"angle": lambda m, pin, law: m.motor("drive", pin, angle=law),
           "length": lambda m, pin, law: m.actuator("cylinder", m.ground.point((0, -2)), m["link"].end, length=law),
           "coupler": lambda m, pin, law: m.coupler("gear", law, of={"t": pin.angle}),
           "constraint": lambda m, pin, law: m.constraint("own", law, of={"t": pin.angle}),
           "cam": lambda m, pin, law: m.cam("cam", pin, "link.end.position.y", profile=law)}


@pytest.mark.parametrize("verb", REFUSED)
def test_speeds_that_jump_are_refused_where_they_are_prescribed(verb):
    """Kinks and steps, ends with a slope that hold, and splines of SciPy that have a kink."""
    kinked = PPoly(np.array([[1.0, -1.0], [0.0, 1.0]]), np.array([0.0, 1.0, 2.0]))
    for law, where in ((RAMP, 1), (zd.table(*KINK, kind="steps"), 1), (zd.table(*KINK, beyond="hold"), 0), (kinked, 1)):
        if law is kinked and verb == "cam":
            continue
        m = zd.Mechanism("refusing")
        pin = m.revolute("pin", m.ground, m.link("link", (0, 0), (1, 0), mass=1.0).start)
        with refused("user-function", f"^.*'.*speed, .* jumps at t = {where}: .*smooth"):
            REFUSED[verb](m, pin, law)


def test_smooth_tables_may_be_prescribed_and_jumping_forces_be_given():
    m = zd.Mechanism("taking")
    pin = m.revolute("pin", m.ground, m.link("link", (0, 0), (1, 0), mass=1.0).start)
    m.torque("torque", "link", value=zd.table(*KINK, kind="steps"))
    with refused("user-function", "speed of motor"):
        m.motor("drive", pin, speed=zd.table(*KINK, kind="steps"))
    m.motor("drive", pin, speed=RAMP)
    for beyond in ("error", "line", "period"):
        assert driven(zd.table(*KINK, beyond=beyond))
    rests = zd.table([0, 1, 2, 3], [1, 1, 1, 1], beyond="hold")
    assert_close(zd.simulate(driven(rests), 5.0, step=0.5)["pin.angle"], np.ones(11), 1e-12)


def test_a_cam_may_be_a_table():
    """Lift 0.3 sin^2 of half the angle, through thirty points of it."""
    angle = np.linspace(0, 2 * np.pi, 31)
    m = zd.Mechanism("valve")
    shaft, valve = m.body("shaft", 1.0, 0.1), m.body("valve", 0.1)
    turn = m.revolute("turn", m.ground, shaft.point((0, 0)))
    lift = m.prismatic("lift", m.ground, valve, axis=(0, 1))
    m.cam("cam", turn, lift, profile=zd.table(angle, 0.3 * np.sin(angle / 2)**2, argument="angle", beyond="period"))
    m.start({"turn.speed": 7.0})
    for each in (m, there_and_back(m)):
        sol = zd.simulate(each, 3.0, step=0.01)
        assert_close(sol["lift.displacement"], 0.3 * np.sin(sol["turn.angle"] / 2)**2, 1e-5, scale=1.0)


def test_tables_live_as_long_as_systems_and_copies_of_these():
    expected = zd.simulate(arm(motion(), stiffening()), 2.0, step=0.01).p
    system = arm(motion(), stiffening()).system()
    copy = pickle.loads(pickle.dumps(system))
    many, alone = zd.ManyRuns(copy, runs=5, step=0.01), zd.Run(copy, step=0.01)
    gc.collect()
    for each in (many, alone):
        each.step(200)
    assert np.array_equal(zd.simulate(system, 2.0, step=0.01).p, expected)
    assert np.array_equal(alone.p, expected[-1])
    assert np.array_equal(many.p, np.tile(expected[-1], (5, 1)))


def test_orders_of_elimination_do_not_depend_on_where_tables_stand():
    """Two tables of different numbers have two entries in a cache, and the same one in any process."""
    tables = (zd.table(TIMES, size * np.sin(3 * TIMES)) for size in (1, 2, 1))
    one, other, again = (arm(table, -1.0).system()._closed_form[1]._key() for table in tables)
    assert one == again != other


@pytest.mark.parametrize("compiled", [None, False, pytest.param(True, marks=needs_compiler)])
def test_beyond_its_ends_a_table_is_an_error_that_says_where(compiled):
    with refused("out-of-range", r"the table goes from t = 0 to 1, and its value at 1\.\d+"):
        zd.simulate(driven(zd.table([0, 1], [0, 1])).system(compiled=compiled), 2.0, step=0.3)


def thrown(law, speed, at=0.0):
    """A mass of 1 kg on a line, with a force that depends on its place."""
    m = zd.Mechanism("thrown")
    body = m.body("body", 1.0, at=(at, 0))
    guide = m.prismatic("guide", m.ground, body, axis=(1, 0), at=(0, 0))
    m.force("brake", body, along=(1, 0), value=law, of={"x": guide.displacement})
    m.start({"guide.displacement": at, "guide.speed": speed})
    return m


BRAKE = zd.table([-1, 0, 1], [-2, -2, -2], argument="x")      # x = speed t - t^2, whose largest value is speed^2 / 4


def at_largest(x):
    return thrown(BRAKE, 2 * np.sqrt(x))


ENDS = r"the table goes from x = -1 to 1, and its value at 1\.\d+"


@pytest.mark.parametrize("settings", [{"rtol": 1e-6, "atol": 1e-6}, {"step": 0.005}], ids=["adaptive", "fixed"])
@pytest.mark.parametrize("compiled", [None, False, pytest.param(True, marks=needs_compiler)])
def test_the_end_of_an_accepted_step_may_be_beyond_by_ten_tolerances(compiled, settings):
    """Ten times 2e-6, and with fixed steps 1e-9 of the table's width."""
    allowed = 2e-5 if "rtol" in settings else 2e-9
    settings = {"max_step": 0.005, **settings} if "rtol" in settings else settings
    sol = zd.simulate(at_largest(1 + 0.9 * allowed).system(compiled=compiled), 1.5, **settings)
    assert sol["guide.displacement"].max() > 1
    assert_close(sol["brake.force"], np.full_like(sol.t, -2), 1e-12, scale=1.0)
    assert_close(sol.at(1.0)["body.acceleration.x"], -2, 1e-12, scale=1.0)
    with refused("out-of-range", ENDS) as caught:
        zd.simulate(at_largest(1 + 4 * allowed).system(compiled=compiled), 1.5, **settings)
    assert any("'brake', called at t = " in note for note in caught.value.__notes__)
    assert 0.99 < caught.value.solution.t[-1] < 1


def test_open_runs_end_with_the_table_in_lanes_as_alone():
    """Runs that reach the end keep the state before it, and the others go on."""
    system, speeds = thrown(BRAKE, 0.0).system(), np.linspace(1.5, 2.5, 20)[:, None]
    many = zd.ManyRuns(system, v0=speeds, runs=20, step=0.01)
    alone = [zd.Run(system, v0=speed, step=0.01) for speed in speeds]
    many.step(150)
    for run, speed in zip(alone, speeds[:, 0], strict=True):
        with contextlib.nullcontext() if speed < 2 else refused("out-of-range", ENDS):
            run.step(150)
    assert np.array_equal(many.failed, speeds[:, 0] > 2)
    assert np.array_equal(many.t, [run.t for run in alone])
    assert np.array_equal(many.p, [run.p for run in alone])


def test_states_of_ones_own_must_be_within_the_ends():
    system, beyond = at_largest(0.5).system(), thrown(BRAKE, 0.0, at=1.1)
    for read in (lambda: zd.Instant(system, 0.0, [1.1], [0.0]), lambda: zd.linearize(system, at=(0.0, [1.1], [0.0])),
                 lambda: zd.simulate(beyond, 1.0), lambda: zd.Run(beyond, step=0.1), lambda: zd.equilibrium(beyond)):
        with refused("out-of-range", "from x = -1 to 1"):
            read()
    crank = driven(zd.table([0, 1], [0, 1]))
    for read in (lambda: zd.Instant(crank, 1.5), lambda: zd.kinematics(crank, {"pin.angle": lambda t: t}, t=np.linspace(0, 2, 5)),
                 lambda: zd.inverse_dynamics(system, zd.kinematics(system, {"guide.displacement": lambda t: t}, t=[0.0, 1.1]))):
        with refused("out-of-range", "from [tx] = -?[01] to 1"):
            read()


@pytest.mark.parametrize("settings", [{}, {"rtol": 1e-8, "atol": 1e-10}, {"integrator": "radau"}, {"step": 0.01}],
                         ids=["default", "accurate", "radau", "fixed"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_motion_that_settles_at_the_end_of_a_table_goes_on(dimension, settings):
    """0.2 w' = 4 - 0.08 w: w = 50 (1 - exp(-0.4 t)). Trial stages go beyond 50, where the table ends."""
    m = zd.Mechanism("fan", dimension=dimension)
    rotor = m.body("rotor", 1.0, 0.2 if dimension == 2 else (0.2,) * 3)
    shaft = m.revolute("shaft", m.ground, rotor, at=(0.0,) * dimension, **({"axis": (0, 0, 1)} if dimension == 3 else {}))
    m.motor("motor", shaft, torque=zd.table([0.0, 20.0, 50.0], [4.0, 2.4, 0.0], argument="w"), of={"w": shaft.speed})
    sol = zd.simulate(m, 90.0, **settings)
    assert_close(sol["shaft.speed"], 50 * (1 - np.exp(-0.4 * sol.t)), 5e-4, scale=1.0)


@pytest.mark.parametrize(("x", "y", "code", "message"), [
    ([0, 1, 1], [0, 1, 2], "not-increasing", r"x\[2\].*1"),
    ([0], [1], "shape", None),
    ([0, 1], [1, 2, 3], "shape", None),
    ([0, np.nan], [1, 2], "not-increasing", None),
])
def test_tables_that_are_refused(x, y, code, message):
    with refused(code, message):
        zd.table(x, y)


@pytest.mark.parametrize(("options", "code", "message"), [
    ({"beyond": "zero"}, "unknown-choice", "beyond"), ({"kind": "cubic"}, "unknown-choice", "kind"),
    ({"beyond": "period"}, "out-of-range", "0 and 1"), ({"noise": 0.0}, "out-of-range", "noise"),
    ({"noise": 1.0, "kind": "linear"}, "conflicting-arguments", "noise"), ({"argument": 1}, "wrong-type", "argument")])
def test_options_that_are_refused(options, code, message):
    with refused(code, message):
        zd.table([0, 1, 2], [0, 1, 1], **options)


@pytest.mark.parametrize("spoilt", [
    {"products": []}, {"products": [[]]}, {"products": [[[[0, 1, 2, 3, 4]]]]}, {"products": 1}, {"arguments": ["a", "a"]},
    {"products": [[[[1, 0, 0, 0, 0], [0, 0, 0, 0, 0]]]]}, {"arguments": [1]},
    {"products": [[[[0, 0, 0, 0, np.nan], [1, 0, 0, 0, 0]]]]},
    {"products": [[[0, 1, 2]]]}, {"arguments": None}, {"products": None}], ids=str)
def test_tables_in_files_are_checked(spoilt):
    with pytest.raises((ValueError, TypeError)):
        from_json(zd.table(X, Y).to_json() | spoilt)


@pytest.mark.parametrize("heading", ["", "t,angle\n", "\ufefft [s], angle [rad]\r\n"])
def test_a_table_from_a_csv_file(tmp_path, heading):
    (tmp_path / "motion.csv").write_text(heading + "0,0\n0.5,0.2\n1,0.1\n\n", encoding="utf-8")
    given, known = zd.table(tmp_path / "motion.csv"), zd.table([0, 0.5, 1], [0, 0.2, 0.1])
    assert [given(t) for t in (0, 0.3, 0.9)] == [known(t) for t in (0, 0.3, 0.9)]
    assert repr(zd.table(str(tmp_path / "motion.csv"))) == repr(known)


@pytest.mark.parametrize(("text", "code", "message"), [
    ("t,x\n0,1\n1,2,3\n", "unreadable-file", "line 3.*'1,2,3'"),
    ("0;1\n1;2\n2;3\n", "unreadable-file", "line 2"),
    ("", "shape", None),
])
def test_files_that_are_not_tables(tmp_path, text, code, message):
    (tmp_path / "motion.csv").write_text(text, encoding="utf-8")
    with refused(code, message):
        zd.table(tmp_path / "motion.csv")
    with refused("wrong-type", "x and y"):
        zd.table([0, 1])
    with refused("conflicting-arguments"):
        zd.table(tmp_path / "motion.csv", [0, 1])


def test_functions_without_derivatives_name_the_table():
    with refused("user-function", r"zd\.table"):
        zd.simulate(driven(called(lambda t: np.interp(t, [0, 1], [0, 1]))), 0.5, step=0.1)


def test_a_motion_of_straight_lines_is_refused():
    with refused("user-function", "no jump of its speed.*t = 0.*smooth"):
        driven(lambda t: np.interp(t, [0, 1], [0, 1]))


@pytest.mark.parametrize("closed_form", [None, False])
def test_a_cam_by_a_table_has_its_slopes_on_every_path(closed_form):
    """Its products read a spline several times: positions and speeds are those of the quintic through the points."""
    m = zd.Mechanism("cam")
    turn = m.revolute("turn", m.ground, m.body("shaft", 1.0, 0.1).point((0, 0)))
    lift = m.prismatic("lift", m.ground, m.body("tappet", 0.2, 0.01, at=(4, 1)), axis=(0, 1), at=(4, 1))
    angles = np.linspace(0, 2 * np.pi, 13)[:-1]
    values = 0.1 * np.sin(angles) + 0.05 * np.cos(2 * angles)
    m.cam("cam", turn, lift, profile=(angles, values))
    m.motor("drive", turn, speed=2.0)
    sol = zd.simulate(m, 3.0, step=0.01, closed_form=closed_form)
    known = make_interp_spline(np.append(angles, 2 * np.pi), np.append(values, values[0]), k=5, bc_type="periodic")
    angle = sol["turn.angle"]
    lifted = sol["lift.displacement"] - sol["lift.displacement"][0]
    assert_close(lifted, known(angle % (2 * np.pi)) - known(0.0), 1e-10, scale=1.0)
    assert_close(sol["lift.speed"], 2.0 * known(angle % (2 * np.pi), 1), 1e-9, scale=1.0)
    assert_close(sol["tappet.acceleration.y"], 4.0 * known(angle % (2 * np.pi), 2), 1e-7, scale=1.0)
