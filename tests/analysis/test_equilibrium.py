"""Equilibria against closed forms, SciPy, long damped runs, and the balance of forces of every model."""

import numpy as np
import pytest
from scipy.optimize import brentq, minimize

import zerodrift as zd
from large_mechanisms import chain_of_hooks
from native_systems import needs_compiler
from support import OWN, refused
from zerodrift.analysis.relaxation import settled

G = 9.81


def pendulum(length=1.0):
    m = zd.Mechanism("pendulum", gravity=(0, -G))
    link = m.link("link", (0, 0), (length, 0), mass=2.0)
    m.revolute("pin", m.ground, link.start)
    return m


@pytest.mark.parametrize("layout", ["joint", "absolute"])
def test_a_pendulum_hangs(layout):
    eq = zd.equilibrium(pendulum(0.7).system(layout))
    assert eq["link.angle"] == pytest.approx(-np.pi / 2, abs=1e-12)
    assert eq["pin.force"] == pytest.approx([0.0, 2.0 * G], abs=1e-11)
    assert eq.frequencies == pytest.approx([np.sqrt(1.5 * G / 0.7) / (2 * np.pi)] * 2, rel=1e-12)
    assert eq.stable is True
    assert "stable" in repr(eq)
    assert "lowest frequency" in repr(eq)
    assert "pin.force = [ 0.   19.62] N" in repr(eq)


def test_the_upper_position_is_unstable_and_found_where_any_is_wanted():
    m = pendulum()
    m.start({"link.angle": 1.4})
    eq = zd.equilibrium(m, stability="any")
    assert eq["link.angle"] == pytest.approx(np.pi / 2, abs=1e-12)
    assert eq.stable is False
    assert eq.eigenvalues.real.max() == pytest.approx(np.sqrt(1.5 * G), rel=1e-12)
    m.start({"link.angle": np.pi / 2})      # exactly in balance: left downhill
    assert zd.equilibrium(m)["link.angle"] % (2 * np.pi) == pytest.approx(1.5 * np.pi, abs=1e-10)


def test_the_effort_that_holds_a_boom():
    m = pendulum()
    eq = zd.equilibrium(m, near={"link.angle": 0.4}, hold=["link.angle"])
    assert eq["link.angle"] == pytest.approx(0.4, abs=1e-13)
    assert eq.effort["link.angle"] == pytest.approx(2.0 * G / 2 * np.cos(0.4), rel=1e-12)
    assert "effort" in repr(eq)


def test_a_mass_between_springs_matches_scipy():
    m = zd.Mechanism("two springs", gravity=(0, -G))
    mass = m.particle("mass", 2.0, at=(0.3, -0.5))
    m.spring("a", m.ground.point((-1.0, 0.0)), mass, stiffness=60.0, length=0.8)
    m.spring("b", m.ground.point((1.0, 0.3)), mass, stiffness=40.0, length=0.9)

    def energy(q):
        return (30.0 * (np.hypot(q[0] + 1, q[1]) - 0.8)**2 + 20.0 * (np.hypot(q[0] - 1, q[1] - 0.3) - 0.9)**2 + 2.0 * G * q[1])

    expected = minimize(energy, [0.3, -0.5], tol=1e-14, options={"gtol": 1e-10}).x
    assert zd.equilibrium(m)["mass.position"] == pytest.approx(expected, abs=1e-7)      # SciPy's differences, 1e-8


def test_every_crank_of_a_four_bar_finds_its_equilibrium():
    """The lowest position of the mass centre: 100 random starts, against energy along the closed loop."""
    bar = zd.models.four_bar().system("joint")
    rest = zd.equilibrium(bar)
    energy = bar.evaluate(rest.p, np.zeros(3)).V
    for angle in np.random.default_rng(5).uniform(-np.pi, np.pi, 100):
        p, _ = zd.assemble(bar, {"crank.angle": angle})
        eq = zd.equilibrium(bar, near=p)
        assert eq.stable is True
        assert pytest.approx(energy, rel=1e-10) == bar.evaluate(eq.p, np.zeros(3)).V


def test_a_von_mises_truss_rests_where_its_closed_form_says():
    """Two springs of free length L over half a span b, a load at the apex: k (L / l - 1) 2 y = -load, both sides of the snap."""
    b, L, k, mass = 1.0, np.hypot(1.0, 0.3), 1000.0, 1.0
    m = zd.Mechanism("truss", gravity=(0, -G))
    apex = m.body("apex", mass, 1e-2, at=(0.0, 0.3))
    m.prismatic("rail", m.ground, apex, axis=(0, 1))
    m.spring("left", m.ground.point((-b, 0)), apex.point((0, 0)), stiffness=k, length=L)
    m.spring("right", m.ground.point((b, 0)), apex.point((0, 0)), stiffness=k, length=L)

    def force(y):
        return -2 * k * y * (1 - L / np.hypot(b, y)) - mass * G

    crest = np.sqrt((L * b**2)**(2 / 3) - b**2)          # limit points: d force / d y = 0
    upper, middle, lower = (brentq(force, *ends, xtol=1e-15) for ends in ((crest, 0.3), (-crest, crest), (-1, -crest)))
    assert zd.equilibrium(m)["apex.position.y"] == pytest.approx(upper, abs=1e-12)
    eq = zd.equilibrium(m, near={"apex.position.y": middle + 0.01}, stability="any")
    assert eq["apex.position.y"] == pytest.approx(middle, abs=1e-12)
    assert eq.stable is False
    assert zd.equilibrium(m, near={"apex.position.y": middle - 0.01})["apex.position.y"] == pytest.approx(lower, abs=1e-12)
    stiffness = 2 * k * (1 - L * b**2 / np.hypot(b, upper)**3)
    assert zd.equilibrium(m).stiffness == pytest.approx(np.array([[stiffness / mass]]), rel=1e-10)


# Chains have too many bodies for dense matrices; those of models with contacts are in tests/contact/test_phases_at_rest.py.
MODELS = sorted(set(dir(zd.models)) - {
    "anchor_escapement", "chain", "four_bars", "compass_gait", "geneva", "suspension", "trebuchet"})
FALLS = {"coin": "falls flat", "rolling_disc": "falls flat"}


@pytest.mark.parametrize("name", MODELS)
def test_each_model_balances(name):
    m = getattr(zd.models, name)()
    if name in FALLS:
        with pytest.raises(zd.EquilibriumFailed, match=r"a force of .* remains"):
            zd.equilibrium(m)
        m_any = zd.equilibrium(m, stability="any")
        assert m_any.stable is False
        return
    eq = zd.equilibrium(m)
    terms = eq.system.evaluate(eq.p, eq.v, eq.t)
    force = (0 if terms.f is None else terms.f) - (0 if terms.d is None else terms.d)
    left = force - (0 if terms.C is None else terms.C.T @ eq.multipliers)
    size = np.abs(force).max() + (0 if terms.C is None else np.abs(terms.C.T * eq.multipliers).max(initial=0.0))
    assert np.abs(left).max() <= 1e-10 * max(size, 1.0)     # N: models weigh kilograms
    if terms.Phi is not None:
        assert np.abs(terms.Phi).max(initial=0.0) < 1e-12


def test_free_directions_are_named():
    assert zd.equilibrium(zd.models.double_wishbone()).free == ("axle.angle",)
    assert zd.equilibrium(zd.models.flyball_governor()).free == ("bearing.angle",)
    wheels = {"rear axle.angle", "front axle.angle", "frame rotation about z", "frame.x", "frame.y"}
    assert set(zd.equilibrium(zd.models.whipple_bicycle()).free) == wheels     # nonholonomic: it may stand anywhere


def test_what_cannot_balance_is_named():
    m = zd.Mechanism("stone", gravity=(0, -G))
    m.particle("stone", 1.0, at=(0, 0))
    with pytest.raises(zd.EquilibriumFailed, match=r"stone must have a position .* balance.*'stone\.y' moves on without end"):
        zd.equilibrium(m)
    with refused("unknown-choice", "stability.*'stable', 'any'"):
        zd.equilibrium(m, stability="maybe")
    with refused("wrong-name", r"'stone\.angle'"):
        zd.equilibrium(m, hold=["stone.angle"])
    with refused("wrong-measure", "^hold must name quantities of positions, and 'stone.velocity.x' is one of velocities"):
        zd.equilibrium(m, hold=["stone.velocity.x"])


def test_a_damped_run_ends_in_the_equilibrium():
    """A double pendulum with torsion springs and dampers, integrated until it rests."""
    m = zd.Mechanism("double", gravity=(0, -G))
    one = m.link("one", (0, 0), (1, 0.2), mass=1.0)
    two = m.link("two", (1, 0.2), (1.8, 0.9), mass=0.5)
    m.revolute("A", m.ground, one.start)
    m.revolute("B", one.end, two.start)
    m.torsion_spring("s", "A", stiffness=8.0, damping=3.0)
    m.torsion_spring("r", "B", stiffness=2.0, damping=0.5)
    eq = zd.equilibrium(m)
    sol = zd.simulate(m, 60.0, integrator="radau", rtol=1e-8, atol=1e-10, save_every=1000)
    assert eq["two.end.position"] == pytest.approx(sol["two.end.position"][-1], abs=1e-7)
    assert eq.stable is True
    assert (eq.eigenvalues.real < 0).all()


def test_a_chain_converges_to_the_catenary():
    """From 10 to 1,000 links, those from 100 on without dense matrices."""
    a = brentq(lambda a: 2 * a * np.sinh(0.5 / a) - 1.5, 0.05, 5, xtol=1e-15)
    sag, tension = a * (np.cosh(0.5 / a) - 1), G / 1.5 * a      # the level part of the tension
    counts, errors = np.array([10, 20, 40, 100, 300, 1000]), []
    for links in counts:
        eq = zd.equilibrium(chain_of_hooks(links))
        assert eq.stable is True
        assert eq["first.force.y"] == pytest.approx(G / 2, rel=1e-9)
        assert (eq.basis is None) == (links >= 100)
        errors.append((eq[f"l{links // 2}.start.position.y"] + sag, eq["first.force.x"] + tension))
    orders = np.diff(np.log(np.abs(errors)), axis=0) / -np.diff(np.log(counts))[:, None]
    assert orders == pytest.approx(np.full((5, 2), 2.0), abs=0.03)
    assert "sparse factors" in repr(eq)


def test_sparse_and_dense_matrices_have_the_same_equilibrium(monkeypatch):
    """A chain with springs across its links and to the ground."""
    m = chain_of_hooks(16)
    for i in (3, 9):
        m.spring(f"across {i}", m[f"l{i}"].start, m[f"l{i + 2}"].end, stiffness=40.0, length=0.1)
    m.spring("tie", m.ground.point((0.2, -1.0)), m["l5"].end, stiffness=10.0, length=0.2)
    system = m.system("absolute")
    dense = zd.equilibrium(system)
    monkeypatch.setattr("zerodrift.analysis.large.MANY", 10)
    sparse = zd.equilibrium(system)
    assert sparse.basis is None
    assert sparse.stable is dense.stable is True
    assert sparse.p == pytest.approx(dense.p, abs=1e-9)
    assert sparse["first.force"] == pytest.approx(dense["first.force"], rel=1e-8)
    assert zd.equilibrium(system, near=sparse.p).iterations <= 1
    with refused("wrong-value", "near must hold coordinates"):
        zd.equilibrium(system, near={"l5.angle": 0.1})


def test_a_chain_drawn_as_a_sketch_hangs_as_its_closed_form():
    """Slopes of n bars that are longer than drawn: tan(slope_i) = (i - (n - 1) / 2) w / H."""
    n, length = 400, 1.4 / 400
    x = np.linspace(0, 1, n + 1)
    y, m = -0.4 * np.sin(np.pi * x), zd.Mechanism("chain", gravity=(0, -9.81))
    last = m.ground.point((0, 0))
    for i in range(n):
        link = m.link(f"link{i}", (x[i], y[i]), (x[i + 1], y[i + 1]), mass=10 / n, length=length)
        m.revolute(f"pin{i}", last, link.start)
        last = link.end
    m.revolute("end", last, m.ground.point((1.0, 0)))
    slope = np.arange(n) - (n - 1) / 2
    low, high = 1e-6, 1e9
    for _ in range(200):        # bisection of H
        H = np.sqrt(low * high)
        low, high = (H, high) if (length / np.hypot(1, slope / H)).sum() < 1 else (low, H)
    sag = np.cumsum(length * (slope / H) / np.hypot(1, slope / H)).min()
    assert zd.equilibrium(m)[f"link{n // 2}.start.position.y"] == pytest.approx(sag, abs=1e-9)


def test_many_bodies_that_fall_are_refused(monkeypatch):
    m = zd.Mechanism("two stones", gravity=(0, -G))
    for i in range(2):
        m.body(f"stone {i}", 1.0, 1.0, at=(i, 0))
    m.revolute("pin", m["stone 0"], m["stone 1"], at=(0.5, 0))
    monkeypatch.setattr("zerodrift.analysis.large.MANY", 2)
    monkeypatch.setattr("zerodrift.analysis.large.ITERATIONS", 40)
    with pytest.raises(zd.EquilibriumFailed, match="two stones must have a position in which its forces balance"):
        zd.equilibrium(m.system("absolute"))


def test_too_many_coordinates_are_refused():
    with pytest.raises(zd.ZerodriftError, match="must have at most 1000 coordinates"):
        zd.equilibrium(zd.models.chain().system("absolute"))


def test_systems_of_all_kinds_have_equilibria():
    """Built in, of callables, and symbolic ones: the same pendulum on a rod."""
    sympy = pytest.importorskip("sympy")

    def of_callables():
        return zd.System(["x", "y"], mass=lambda p: 2.0 * np.eye(2), force=lambda p, v: np.array([0.0, -2.0 * G]),
                         constraints=lambda p: np.array([p[0]**2 + p[1]**2 - 1.0]), p0=[1.0, 0.0])

    def symbolic():
        x, y = sympy.symbols("x y")
        vx, vy = sympy.symbols("x_dot y_dot")
        return zd.symbolic([x, y], kinetic=vx**2 + vy**2, potential=2 * G * y, constraints=[x**2 + y**2 - 1], speeds=[vx, vy],
                           p0=[1.0, 0.0])

    for make in (zd.systems.pendulum, of_callables, symbolic):
        system = make()
        eq = zd.equilibrium(system)
        length = np.hypot(*eq.p)
        assert eq["y"] == pytest.approx(-length, abs=1e-12)
        assert eq.eigenvalues.imag.max() == pytest.approx(np.sqrt(9.81 / length), rel=1e-9)
        assert zd.linearize(system, eq).eigenvalues.imag.max() == pytest.approx(np.sqrt(9.81 / length), rel=1e-9)


def test_scales_do_not_vanish_with_the_position():
    eq = zd.equilibrium(zd.systems.oscillator(mass=2.0))
    assert abs(eq["x"]) < 1e-15
    assert eq.frequencies[0] == pytest.approx(np.sqrt(5.0) / (2 * np.pi), rel=1e-12)


@needs_compiler
def test_a_position_that_cannot_be_evaluated_is_not_an_equilibrium():
    """A skate on a hill, whose equations end at a rim."""
    with pytest.raises(zd.EquilibriumFailed):
        zd.equilibrium(OWN["skate"].with_parameters(curvature=-6.0, rim=1.0))


@pytest.mark.parametrize("name", ["four_bar", "closed_pendulum", "spatial_slider_crank"])
def test_integration_with_stops_comes_near_the_stable_position(name):
    """From the start, kinetic energy taken out at each maximum: close to the minimum of the potential energy."""
    system = getattr(zd.models, name)().system("joint")
    p, rest = np.array(system.start_at(0.0)[0]), np.zeros(system.nv)
    near = settled(system, p)
    lowest = system.evaluate(zd.equilibrium(system).p, rest).V
    first, last = (system.evaluate(each, rest).V for each in (p, near))
    assert last - lowest < 1e-4 * (first - lowest)
    assert np.abs(system.evaluate(near, rest).Phi).max(initial=0.0) < 1e-9
    assert zd.equilibrium(system, near=near).iterations <= 5


def test_a_vector_is_held_by_the_efforts_of_its_components():
    m = zd.Mechanism("stone", gravity=(0.5, -G))
    m.particle("stone", 2.0, at=(0.3, 0.4))
    eq = zd.equilibrium(m, hold=["stone.position"])
    assert eq.effort == pytest.approx({"stone.position.x": -1.0, "stone.position.y": 2.0 * G})
    assert eq["stone.position"] == pytest.approx([0.3, 0.4], abs=1e-14)
    assert "nothing is free to move" in repr(eq)
