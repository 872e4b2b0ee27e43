"""Systems derived with SymPy: the terms and motions of those written in C by hand, in every formulation and everywhere else."""

import functools
import os
import pickle
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import matplotlib.pyplot as plt
import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import dynamicsymbols

import tolerances as tol
import zerodrift as zd
from support import FORMULATIONS, SYSTEMS, assert_close, consistent_states, refused, violated_states
from symbolic_counterparts import GRAVITY, MASSES, VALUES, T, arm, bar, four_bar, knife_edge, rolling_disc, skate
from zerodrift.symbolics import progress_message
from zerodrift.symbolics.graph import blocks

WRITTEN = {name: functools.cache(function) for name, function in {
    "four_bar": four_bar, "arm": arm, "knife_edge": knife_edge, "skate": skate}.items() if name in SYSTEMS}


@pytest.fixture(params=WRITTEN)
def pair(request):
    """A symbolic system and its counterpart in C."""
    return WRITTEN[request.param](), SYSTEMS[request.param]


# ---- the same as in C ----


def test_the_terms_are_those_written_by_hand(pair):
    mine, core = pair
    for t, p, v in [*consistent_states(core), *violated_states(core)]:
        one, other = mine.evaluate(p, v, t), core.evaluate(p, v, t)
        for name in ("A", "M", "d", "f", "Phi", "C", "Phi_t", "xi", "V"):
            a, b = getattr(one, name), getattr(other, name)
            if a is None and b is None:
                continue
            a, b = (np.zeros_like(y) if x is None else x for x, y in ((a, b), (b, a)))
            assert_close(a, b, tol.SAME, scale=10.0, what=name)


def test_the_motion_is_that_of_the_system_in_c(pair, formulation):
    free = pair[1].nv > pair[1].m       # else there is nothing by which energy could be corrected
    mine, core = (zd.simulate(system, 0.5, step=0.01, formulation=formulation, energy=free) for system in pair)
    if core.system.name == "knife_edge" and formulation in ("mixed", "independent"):
        assert_close(mine.p, core.p, 1e-6)      # there the one in C brings its own D and has other variables
        return
    assert_close(mine.p, core.p, 1e-12)
    assert_close(mine.multipliers, core.multipliers, 1e-10)
    assert_close(mine.energy_input, core.energy_input, 1e-10)


@pytest.mark.parametrize("groups", [0, 1, 2])
def test_what_is_not_kept_is_computed_again(pair, groups, monkeypatch):
    """Groups of shared subexpressions beyond the limit of the cache are computed at every call."""
    monkeypatch.setattr(blocks, "GROUPS", groups)
    monkeypatch.setattr(sys.modules["zerodrift.symbolics.define"], "fingerprint", lambda expressions: None)
    mine, core = WRITTEN[pair[1].name].__wrapped__(), pair[1]
    a, b = (zd.simulate(system, 0.2, step=0.01) for system in (mine, core))
    assert_close(a.p, b.p, 1e-12)
    assert (mine._code.scratch == 0) == (groups == 0)


def test_what_was_derived_passes_every_check(pair):
    report = zd.check(pair[0])
    assert report, report


def test_a_closed_chain_of_ten_links():
    """In absolute angles its terms are known in closed form: sums over the links of cosines and sines of differences."""
    n, rng = 10, np.random.default_rng(7)
    a, lengths, masses = dynamicsymbols(f"a:{n}"), rng.uniform(0.5, 1.5, n), rng.uniform(0.5, 1.5, n)
    parameters = dict(zip([*sp.symbols(f"l:{n}"), *sp.symbols(f"m:{n}"), GRAVITY], [*lengths, *masses, 9.81], strict=True))
    kinetic = potential = x = y = sp.S.Zero
    for angle, length, mass in zip(a, sp.symbols(f"l:{n}"), sp.symbols(f"m:{n}"), strict=True):
        xm, ym = x + length * sp.cos(angle) / 2, y + length * sp.sin(angle) / 2
        kinetic += mass * (xm.diff(T) ** 2 + ym.diff(T) ** 2 + (length * angle.diff(T)) ** 2 / 12) / 2
        potential += mass * GRAVITY * ym
        x, y = x + length * sp.cos(angle), y + length * sp.sin(angle)
    system = zd.symbolic(a, kinetic=kinetic, potential=potential, constraints=[x, y], parameters=parameters)
    p, v = rng.normal(size=n), rng.normal(size=n)
    ahead = (np.triu(np.ones((n, n)), 1) + np.eye(n) / 2) * lengths[:, None]        # arm of link i under the weight of link j
    arms = ahead * masses @ ahead.T
    difference = p[:, None] - p
    terms = system.evaluate(p, v)
    assert_close(terms.M, arms * np.cos(difference) + np.diag(masses * lengths**2 / 12), tol.SAME)
    assert_close(terms.d, (arms * np.sin(difference)) @ v**2, tol.SAME)
    assert_close(terms.f, -9.81 * (ahead @ masses) * np.cos(p), tol.SAME)
    assert_close(terms.xi, np.array([np.cos(p), np.sin(p)]) @ (lengths * v**2), tol.SAME)


def test_names_and_sizes():
    system = rolling_disc()
    assert [x.name for x in system.coordinates] == ["x", "y", "z", "yaw", "lean", "spin"]
    assert [x.name for x in system.velocities] == ["vx", "vy", "vz", "w1", "w2", "w3"]
    assert (system.nq, system.nv, system.mh, system.mn) == (6, 6, 1, 2)
    assert [x.name for x in four_bar().velocities] == ["alpha1_dot", "alpha2_dot", "alpha3_dot"]
    assert repr(four_bar()) == "<zd.symbolic bar: 3 coordinates, 3 velocities, 2 holonomic and 0 nonholonomic constraints>"


# ---- what else can be given: zd.check compares derivatives and the balance of power ----


R, S = dynamicsymbols("r s")
DR, DS = R.diff(T), S.diff(T)
M, W, K = sp.symbols("m w k")
CONSTANTS = {M: 1.3, W: 2.0, K: 5.0}
BEAD = {"kinetic": M * (DR**2 + (W * R) ** 2) / 2, "potential": K * R**2 / 2}      # on a rod that turns at a given rate
GIVEN = {
    "kinetic energy at rest": ([R], BEAD),
    "kinetic energy that depends on time": ([R, S], {
        "kinetic": M * (1 + sp.sin(T) ** 2 / 2) * DR**2 / 2 + M * DS**2 + M * sp.cos(T) * R * DR + M * sp.sin(R) * DR * DS,
        "potential": K * R**2 / 2}),
    "potential that depends on time": ([R], {"kinetic": M * DR**2 / 2, "potential": K * (R - sp.sin(W * T)) ** 2 / 2}),
    "forces": ([R, S], {"kinetic": M * (DR**2 + R**2 * DS**2) / 2, "force": {R: -K * DR * abs(DR), DS: sp.cos(T) - DS},
                        "potential": sp.sin(S) * R}),
    "moving constraint": ([R, S], {"kinetic": M * (DR**2 + DS**2) / 2, "potential": M * S,
                                   "constraints": [sp.Eq(S * sp.cos(W * T), R * sp.sin(W * T))]}),
    "rheonomic nonholonomic constraint": ([R, S], {"kinetic": M * (DR**2 + DS**2) / 2,
                                                   "nonholonomic": [DS * sp.cos(R) - DR * sp.sin(T) - sp.cos(W * T) * R]}),
    "piecewise potential": ([R], {"kinetic": M * DR**2 / 2, "potential": sp.Piecewise((K * R**2, R > 0.3), (K * R**3, True))}),
    "mass and bias": ([R, S], {"mass": sp.diag(M, M * R**2), "bias": [-M * R * DS**2, 2 * M * R * DR * DS],
                               "potential": K * R**2, "force": [0, -DS]}),
    "mass without bias": ([R, S], {"mass": sp.diag(M, M * R**2), "potential": K * R**2}),
}


@pytest.mark.parametrize("name", GIVEN)
def test_whatever_is_given_is_derived_right(name):
    coordinates, given = GIVEN[name]
    size = len(coordinates)
    system = zd.symbolic(coordinates, parameters=CONSTANTS, p0=[0.7, 0.4][:size], v0=[0.3, -0.2][:size], **given)
    for t in (0.0, 0.3):
        report = zd.check(system, t=t)
        assert report, report
        assert "balance of power" in report.checks


def test_kinetic_energy_at_rest_is_centrifugal_force():
    """The bead flies outwards as cosh, and what the rod does for it is counted."""
    system = zd.symbolic([R], **(BEAD | {"potential": 0}), parameters=CONSTANTS, p0=[1.0], v0=[0.0])
    sol = zd.simulate(system, 1.0, step=0.002)
    assert_close(sol.p[:, 0], np.cosh(2.0 * sol.t), 1e-9)
    assert_close(sol.energy_input, 0.5 * 1.3 * (2.0 * np.sinh(2.0 * sol.t)) ** 2, 1e-9)


def test_kinematics_that_depend_on_time():
    """Velocities along axes that turn at a given rate, with a force along one of them."""
    x, y = dynamicsymbols("x y")
    u1, u2 = sp.symbols("u1 u2")
    c, s = sp.cos(W * T), sp.sin(W * T)
    system = zd.symbolic(
        [x, y], speeds=[u1, u2], kinematics=[c * u1 - s * u2, s * u1 + c * u2], kinetic=M * (x.diff(T) ** 2 + y.diff(T) ** 2) / 2,
        potential=K * (x**2 + y**2) / 2, force=[1 - u1, 0], parameters=CONSTANTS, p0=[1.0, 0.2], v0=[0.3, 0.1])
    assert zd.check(system, t=0.4), zd.check(system, t=0.4)
    plain = zd.symbolic(
        [x, y], kinetic=M * (x.diff(T) ** 2 + y.diff(T) ** 2) / 2, potential=K * (x**2 + y**2) / 2,
        force=sp.Matrix([c, s]) * (1 - c * x.diff(T) - s * y.diff(T)), parameters=CONSTANTS, p0=[1.0, 0.2], v0=[0.3, 0.1])
    a, b = (zd.simulate(each, 1.0, step=0.001) for each in (system, plain))
    assert_close(a.p, b.p, tol.CONVERGED)
    assert_close(a.energy_input, b.energy_input, tol.CONVERGED)


def test_a_matrix_will_do_for_kinematics():
    x, y = dynamicsymbols("x y")
    u = sp.symbols("u1 u2")
    A = sp.Matrix([[1, sp.sin(x)], [0, 1]])
    given = {"speeds": u, "kinetic": x.diff(T) ** 2 + y.diff(T) ** 2}
    one, other = (zd.symbolic([x, y], kinematics=each, **given) for each in (A, [u[0] + sp.sin(x) * u[1], u[1]]))
    assert_close(one.evaluate([0.3, 0.1], [1.0, 2.0]).M, other.evaluate([0.3, 0.1], [1.0, 2.0]).M, tol.SAME)


def test_only_what_there_is_is_computed():
    terms = zd.symbolic([R], kinetic=DR**2 / 2, potential=None).evaluate([1.0])
    assert repr(terms) == "Terms(M (1, 1))"
    assert "ZD_POTENTIAL" not in zd.symbolic([R], kinetic=DR**2 / 2, potential=None).c_source
    assert not zd.symbolic([R], kinetic=DR**2 / 2, potential=None).has_energy


# ---- parameters and the start ----


def test_parameters_are_changed_without_deriving_or_compiling(monkeypatch):
    system = four_bar()
    for module, name in (("zerodrift.symbolics.define", "_derive"), ("zerodrift.symbolics.compile.shared_library", "library")):
        monkeypatch.setattr(sys.modules[module], name, None)
    heavy = system.with_parameters(m2=8.0)
    assert_close(heavy.evaluate().M, zd.systems.four_bar(masses=(1.5, 8.0, 3.0)).evaluate().M, tol.SAME)
    assert (system.parameters["m2"], heavy.parameters["m2"]) == (5.0, 8.0)
    assert heavy.c_source == system.c_source
    monkeypatch.undo()
    again = pickle.loads(pickle.dumps(heavy))
    assert again.parameters == heavy.parameters
    assert np.array_equal(again.evaluate().M, heavy.evaluate().M)
    assert_close(bar(parameters=VALUES | {MASSES[1]: 8.0}).evaluate(system.p0).M, heavy.evaluate().M, tol.SAME)
    with refused("unknown-choice", "parameter.*'l1'.*'mass'"):
        system.with_parameters(mass=1.0)
    with refused("not-finite", "'m2'"):
        system.with_parameters(m2=np.inf)


def test_the_start_can_be_changed_and_is_requested():
    system = bar()
    with refused("missing-argument"):
        zd.simulate(system, 1.0, step=0.01)
    core = SYSTEMS["four_bar"]
    again = system.starting(core.p0, core.v0)
    assert_close(zd.simulate(again, 0.1, step=0.01).p, zd.simulate(core, 0.1, step=0.01).p, 1e-13)
    with refused("shape", "^p0 must.*3"):
        system.starting([1.0])


# ---- an ordinary system ----


def test_drawings_are_those_of_the_system_in_c():
    mine, core = four_bar(), SYSTEMS["four_bar"]
    assert_close(mine.points(mine.p0), core.points(core.p0), tol.SAME)
    assert rolling_disc().points(rolling_disc().p0) is None
    zd.plot.mechanism(zd.simulate(mine, 0.2, step=0.01)).figure.canvas.draw()
    plt.close("all")


def test_several_threads_run_one_system_at_once():
    system = four_bar()

    def final(formulation):
        return zd.simulate(system, 1.0, step=0.001, formulation=formulation).p[-1]

    with ThreadPoolExecutor(4) as pool:
        together = list(pool.map(final, FORMULATIONS * 2))
    assert all((a == final(name)).all() for a, name in zip(together, FORMULATIONS * 2, strict=True))


def test_work_precision_and_saved_solutions(tmp_path):
    system = four_bar()
    measured = zd.work_precision(system, 0.2, steps=[0.02, 0.01], formulations=["schur"], integrators=["rk4"])
    assert len(measured.rows) == 2
    sol = zd.simulate(system, 0.1, step=0.01)
    sol.save(tmp_path / "sol.npz")
    assert zd.load(tmp_path / "sol.npz").system.name == "bar"


ELSEWHERE = """
import pickle, sys
sys.modules["sympy"] = None         # whoever imports it fails
import zerodrift as zd
system = pickle.load(sys.stdin.buffer)
print(system.compiled, system.parameters["g"], *zd.simulate(system, 0.5, step=0.01).p[-1].tolist(), *system.points(system.p0)[1])
"""


def test_pickled_into_a_fresh_process_without_sympy_and_with_an_empty_cache(tmp_path):
    system = four_bar().with_parameters(g=9.0)
    said = subprocess.run([sys.executable, "-c", ELSEWHERE], input=pickle.dumps(system), capture_output=True, check=True,
                          env=os.environ | {"ZERODRIFT_CACHE": str(tmp_path)}).stdout.decode().split()
    assert said[:2] == ["True", "9.0"]
    assert [float(x) for x in said[2:5]] == zd.simulate(system, 0.5, step=0.01).p[-1].tolist()
    assert [float(x) for x in said[5:]] == system.points(system.p0)[1].tolist()
    assert list(tmp_path.glob("*.so"))
    same = pickle.loads(pickle.dumps(system))
    assert same.parameters == system.parameters
    assert (same.p0 == system.p0).all()


def test_progress_is_shown_when_it_takes_long(monkeypatch, capsys):
    given = {"kinetic": DR**2 / 2, "potential": sp.cos(R), "name": "slow"}
    zd.symbolic([R], **given)
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(progress_message, "PATIENCE", 0.0)
    zd.symbolic([R], **(given | {"potential": sp.cos(R) / 2}))
    assert re.search(r"zerodrift: slow: compiling \(\d s so far\)", capsys.readouterr().err)
    zd.symbolic([R], **(given | {"potential": sp.cos(R) / 3}), progress=False)
    assert capsys.readouterr().err == ""


def test_without_sympy_the_extra_is_named():
    code = "import sys; sys.modules['sympy'] = None; import zerodrift as zd; zd.symbolic"
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False).stderr
    assert "symbolic systems need SymPy: pip install 'zerodrift[symbolic]' [zd:missing-package]" in said
