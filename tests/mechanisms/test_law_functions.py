"""Laws that are expressions, as programs: what the same laws say in Python, which differentiates them by other means."""

import pickle

import numpy as np
import pytest
import sympy as sp

import support
import zerodrift as zd
from zerodrift._private.gateway.mechanisms.element_tables import law_sizes
from zerodrift.errors import ZerodriftError
from zerodrift.mechanisms.equations import function_programs
from zerodrift.mechanisms.equations.function_calls import Laws
from zerodrift.symbolics.compile import compilers

t, x, u, k = sp.symbols("t x u k")
FUNCTION_ROUNDING = 1e-12  # of sines and products in another order, over some hundred steps
WAVE = 0.3 * sp.sin(2.5 * t + 0.2) * sp.exp(-0.4 * t) + k * t**2
BENT = sp.Piecewise((x**3, x < 0.1), (sp.sqrt(x + 1.5) ** 3 + sp.Max(x, 0.25), True))
PLACE, RATE = "body.position.x", "body.velocity.x"


def motion(m, guide):
    m.motor("drive", guide, displacement=WAVE)


def speed(m, guide):
    m.motor("drive", guide, speed=WAVE + k * BENT, of={"x": "other.position.y"})


def holonomic(m, guide):
    m.constraint("law", BENT - sp.Symbol("other.position.x") * sp.cos(x * t) + k * t + x**0.5, of={"x": PLACE})


def nonholonomic(m, guide):
    m.nonholonomic("law", sp.cos(k * x + t) * u - 0.2 * sp.Symbol("other.velocity.y") + x * t + 0.5, of={"x": PLACE, "u": RATE})


def effort(m, guide):
    m.motor("drive", guide, force=-k * u * abs(u) - 2.0 * sp.sign(u) * BENT + sp.Mod(t, 0.7), of={"x": PLACE, "u": RATE})


def cam(m, guide):
    wheel = m.body("wheel", 1.0, guide.second.body.inertia, at=guide.second.body.pose.origin)
    axis = {"axis": (0, 0, 1)} if len(m.gravity) == 3 else {}
    hinge = m.revolute("hinge", m.ground, wheel, at=wheel.pose.origin, **axis)
    m.cam("law", hinge, "other.position.y", profile=0.1 * (1 - sp.cos(3.0 * x)) ** 2 + 0.1)


def integers(m, guide):
    m.motor("drive", guide, force=-x, of={"x": PLACE})


KINDS = [motion, speed, holonomic, nonholonomic, effort, cam, integers]


def scene(kind, dimension):
    m = zd.Mechanism("scene", dimension=dimension, gravity=(0, -9.81, 0)[:dimension], parameters={"k": 0.7})
    inertia = 0.3 if dimension == 2 else (0.1, 0.2, 0.3)
    body = m.body("body", 1.5, inertia, at=(0.2, 0.0, 0.0)[:dimension])
    m.particle("other", 0.5, at=(0.4, 0.3, 0.1)[:dimension])
    kind(m, m.prismatic("guide", m.ground, body, axis=(1, 0, 0)[:dimension]))
    return m


def systems(make, monkeypatch, layout=None):
    """One whose laws are programs, and one that asks Python for them."""
    compiled = make().system(layout)
    assert all(compiled._core._law.programs(law_sizes(compiled._core.tables)))
    with monkeypatch.context() as patched:
        patched.setattr(function_programs, "program", lambda row, k: None)
        asked = make().system(layout)
        assert not any(asked._core._law.programs(law_sizes(asked._core.tables)))
    return compiled, asked


def called(monkeypatch):
    """List of the numbers of user functions that the core calls in Python from now on."""
    asked, call = [], Laws.__call__
    monkeypatch.setattr(Laws, "__call__", lambda self, number, *at: asked.append(number) or call(self, number, *at))
    return asked


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_says_what_it_says_in_python(kind, layout, dimension, monkeypatch):
    compiled, other = systems(lambda: scene(kind, dimension), monkeypatch, layout)
    asked, random = called(monkeypatch), np.random.default_rng(3)
    for time in (0.0, 0.3, 1.9):
        core, v = compiled._core, random.uniform(-1, 1, compiled.nv)
        p = core.origin + random.uniform(0.05, 0.9, compiled.nq)        # what turns need not turn by a unit quaternion here
        terms = core.evaluate(time, p, v)
        assert not asked
        expected = other._core.evaluate(time, p, v)
        assert asked
        assert terms.keys() == expected.keys() >= ({"power"} if kind in (effort, integers) else {"C", "xi"})
        for name, value in expected.items():
            np.testing.assert_allclose(terms[name], value, rtol=FUNCTION_ROUNDING, atol=FUNCTION_ROUNDING, err_msg=name)
        asked.clear()


@pytest.mark.parametrize("model", [zd.models.stewart_platform, zd.models.cam_follower, zd.models.double_wishbone])
def test_models_move_as_by_python(model, monkeypatch):
    compiled, other = systems(model, monkeypatch)
    asked = called(monkeypatch)
    sol = zd.simulate(compiled, 0.1, step=2e-3)
    assert np.isfinite(sol[compiled.measures[-1]]).all()
    assert not asked
    expected = zd.simulate(other, 0.1, step=2e-3)
    assert asked
    for ours, theirs in ((sol.p, expected.p), (sol.v, expected.v)):
        assert np.abs(ours - theirs).max() <= FUNCTION_ROUNDING * np.abs(theirs).max()


def test_other_parameters_are_not_written_again(monkeypatch):
    first = scene(motion, 2).system()
    zd.simulate(first, 0.1, step=0.01)
    monkeypatch.setattr(function_programs, "Lowering", lambda *_: pytest.fail("written again"))
    changed = first.with_parameters(k=0.1)
    sol = zd.simulate(changed, 1.0, step=0.01)
    assert sol["guide.displacement"] == pytest.approx(0.3 * np.sin(2.5 * sol.t + 0.2) * np.exp(-0.4 * sol.t) + 0.1 * sol.t**2,
                                                      abs=FUNCTION_ROUNDING)


def test_what_is_pickled_or_saved_is_written_again(tmp_path, monkeypatch):
    system = scene(motion, 3).system()
    sol = zd.simulate(system, 0.2, step=0.01)
    asked = called(monkeypatch)
    for again in (pickle.loads(pickle.dumps(system)), zd.load(sol.save(tmp_path / "motion")).system):
        assert np.array_equal(zd.simulate(again, 0.2, step=0.01).p, sol.p)
    assert not asked


def test_no_compiler_is_needed(monkeypatch):
    monkeypatch.setattr(compilers, "find", lambda: None)
    monkeypatch.setattr(function_programs, "_programs", {})
    asked = called(monkeypatch)
    zd.simulate(scene(effort, 2), 0.2, step=0.01)
    assert not asked


def test_what_c_has_not_is_left_to_python(monkeypatch):
    """Beside a law that is a program."""
    class Bump(sp.Function):
        def _pythoncode(self, printer):
            return f"cos({printer._print(self.args[0])})"

        _scipycode = _numpycode = _pythoncode

    m = scene(motion, 2)
    m.force("odd", "other", along=(1, 0), value=support.called(lambda t: np.cos(t)))
    system, asked = m.system(), called(monkeypatch)
    zd.simulate(system, 0.1, step=0.01)
    assert set(asked) == {1}
    other = scene(lambda m, guide: m.motor("drive", guide, force=Bump(t)), 2)
    assert "Bump" in other["drive"].law.why_called
    push = zd.simulate(other, 0.1, step=0.01)["drive.force"]
    assert push == pytest.approx(np.cos(np.linspace(0, 0.1, 11)), abs=1e-15)


@pytest.mark.filterwarnings("ignore:invalid value encountered in log")
def test_what_has_no_finite_value_is_reported_in_the_words_of_the_law():
    m = scene(lambda m, guide: m.motor("drive", guide, force=sp.log(0.15 - t)), 2)
    with pytest.raises((ZerodriftError, ValueError), match=r"force of motor 'drive'"):
        zd.simulate(m, 1.0, step=0.01)


NUMBERS = {}


@pytest.mark.parametrize(("law", "error"), [(lambda t: NUMBERS["a"], KeyError), (lambda t: 1.0 / (0 * t), ZeroDivisionError)])
@pytest.mark.parametrize(("where", "add"), [
    ("force of motor 'drive'", lambda m, guide, law: m.motor("drive", guide, force=law)),
    ("value of force 'push'", lambda m, guide, law: m.force("push", m["body"].center, along=(1, 0), value=law)),
    ("stiffness of spring 'k'", lambda m, guide, law: m.spring("k", m.ground.point((5, 5)), m["body"].center, stiffness=law)),
    ("force.x of bushing 'b'", lambda m, guide, law: m.bushing("b", m.ground, m["body"], at=(1, 1), force=(law, 0.0)))])
def test_a_function_that_raises_is_named_with_its_element(law, error, where, add):
    """Its own error, with a note; print(m) says that the mechanism cannot start."""
    m = scene(lambda m, guide: add(m, guide, law), 2)
    with pytest.raises(error) as raised:
        zd.simulate(m, 1.0, step=0.01)
    assert any(f"in {where}, called at t = 0" in note for note in raised.value.__notes__)
    assert f"in {where}, called at t = 0" in str(m)
    with support.refused("not-portable", where):
        m.save("nowhere")


@pytest.mark.parametrize("name", ["lambda", "class", "a b", "1a"])
def test_parameters_that_no_function_can_name(name):
    with support.refused("wrong-value", "names that a callable can take"):
        zd.Mechanism("m", parameters={name: 1.0})
    with support.refused("wrong-value", "names that a callable can take"):
        zd.Mechanism("m").parameter(name, 1.0)
