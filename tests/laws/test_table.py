"""Laws from data: splines as SciPy's, prescribed motions with their speeds, and what is refused."""

import gc
import pickle

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import zerodrift as zd
from native_systems import needs_compiler
from support import assert_close, called, refused


@pytest.mark.parametrize("n", [2, 3, 4, 5, 30])
def test_a_table_is_the_spline_of_scipy(n):
    random = np.random.default_rng(n)
    x, y = np.cumsum(random.uniform(0.1, 1.0, n)), random.normal(size=n)
    given, known = zd.table(x, y), CubicSpline(x, y)
    at = np.linspace(x[0], x[-1], 101)
    assert_close([given(each) for each in at], known(at), 1e-12, scale=np.abs(y).max())


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


@pytest.mark.parametrize(("x", "y", "code", "message"), [
    ([0, 1, 1], [0, 1, 2], "not-increasing", r"x\[2\].*1"),
    ([0], [1], "shape", None),
    ([0, 1], [1, 2, 3], "shape", None),
    ([0, np.nan], [1, 2], "not-increasing", None),
])
def test_tables_that_are_refused(x, y, code, message):
    with refused(code, message):
        zd.table(x, y)


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
        zd.simulate(driven(lambda t: np.interp(t, [0, 1], [0, 1])), 0.5, step=0.1)
