"""Properties of every model of `zd.models`; the motion of each is compared in the file of its name."""

import inspect
import pickle
import subprocess
import sys

import numpy as np
import pytest

import zerodrift as zd
from every_model import MECHANISMS, MODELS, assert_right
from support import assert_close, refused


@pytest.fixture(params=[*MODELS, *(f"{name}, from bodies" for name in MECHANISMS)])
def model(request):
    name = request.param.removesuffix(", from bodies")
    return MODELS[name]() if name == request.param else MECHANISMS[name]().system()


def test_check(model):
    if model._groups:
        with refused("not-available", "active at all times"):
            zd.check(model)
    else:
        assert_right(model)


def test_drawing(model):
    points = model.points(model.p0)
    assert points.ndim == 2
    assert points.shape[1] == 2
    assert np.isfinite(points[~np.isnan(points).all(axis=1)]).all()      # where the pen is lifted, both are nan


def test_pickling(model):
    again = pickle.loads(pickle.dumps(model))
    ends = [zd.simulate(system, 0.01, step=1e-4).p[-1] for system in (model, again)]
    assert np.array_equal(*ends)


@pytest.mark.parametrize("name", MECHANISMS)
def test_saved_and_read_it_is_the_same_to_the_last_bit(name, tmp_path):
    """Tables, start, and the state after some steps; and the model that was read is saved as the same file."""
    one = MECHANISMS[name]()
    other = zd.load(one.save(tmp_path / name))
    assert other.save(tmp_path / "again").read_bytes() == (tmp_path / f"{name}.json").read_bytes()
    for layout in ("joint", "absolute"):
        first, second = one.system(layout), other.system(layout)
        assert first.measures == second.measures
        assert first.parameters == second.parameters
        assert first.p0.tobytes() == second.p0.tobytes()
        assert first.v0.tobytes() == second.v0.tobytes()
    ends = [zd.simulate(m, 0.005, step=0.0005) for m in (one, other)]
    assert ends[0].p.tobytes() == ends[1].p.tobytes()
    assert ends[0].v.tobytes() == ends[1].v.tobytes()


@pytest.mark.parametrize("name", MECHANISMS)
def test_it_moves_alike_in_both_kinds_of_coordinates(name):
    """In absolute ones all joints are constraints; `augmented` takes bodies that have no mass."""
    m = MECHANISMS[name]()
    step = 1e-4 if name == "andrews" else 2e-3
    sols = [zd.simulate(m.system(layout), 5 * step, step=step, formulation="augmented", integrator="dop853")
            for layout in ("joint", "absolute")]
    for body in m.bodies:
        for what in ("position", "angle", "velocity") if body.turns else ("position", "velocity"):
            assert_close(*(sol[f"{body.name}.{what}"] for sol in sols), 1e-9, scale=1.0, what=f"{body.name}.{what}")


@pytest.mark.parametrize("name", MECHANISMS)
def test_every_model_is_from_bodies_and_joints_and_says_so(name):
    m = MECHANISMS[name]()
    assert isinstance(m, zd.Mechanism)
    assert m.name == name
    assert m.bodies
    assert m.joints
    system = m.system()
    assert m.p0.tobytes() == system.p0.tobytes()
    assert m.v0.tobytes() == system.v0.tobytes()
    assert m.points(m.p0).tobytes() == system.points(system.p0).tobytes()
    assert m.evaluate().M.tobytes() == system.evaluate().M.tobytes()
    for section in ("Parameters", "Returns", "Examples"):
        assert f"\n{section}\n---" in inspect.getdoc(MECHANISMS[name])


def arguments(name):
    """The names of a model's arguments; Andrews' are those of the literature."""
    parameters = inspect.signature(MECHANISMS[name]).parameters.items()
    return [argument for argument, parameter in parameters if parameter.kind is not parameter.VAR_KEYWORD]


@pytest.mark.parametrize("name", MECHANISMS)
def test_what_is_not_a_number_is_named_by_its_argument(name):
    for argument in arguments(name):
        for wrong in ("much", np.nan, [1.0, 2.0, 3.0, 4.0, 5.0], True):
            with pytest.raises((ValueError, TypeError), match=argument):
                MECHANISMS[name](**{argument: wrong})


SIZES = ("mass", "inertia", "stiffness", "damping", "density", "crank", "rod", "arm", "length", "scale")


@pytest.mark.parametrize("name", [name for name in MECHANISMS if name != "andrews"])
def test_what_cannot_be_negative_is_named(name):
    for argument in arguments(name):
        if argument.rpartition("_")[2] in SIZES:
            with refused("out-of-range", rf"{argument} must be (at least|greater than) "):
                MECHANISMS[name](**{argument: -0.1})


@pytest.mark.parametrize("name", [name for name in MECHANISMS if name != "andrews"])
def test_unknown_arguments_are_named(name):
    with refused("wrong-type", rf"{name}\(\): got an unexpected keyword argument 'colour'"):
        MECHANISMS[name](colour="red")


def test_without_sympy():
    """The error names SymPy, and is raised only where SymPy is needed."""
    code = """if True:
        import sys
        sys.modules["sympy"] = None
        import zerodrift as zd
        print(zd.simulate(zd.models.andrews(), 0.001, step=1e-4).t[-1])
        for use in (zd.models.watt, zd.models.cam_follower, zd.models.pantograph):
            try:
                use()
            except ImportError as error:
                print(error)"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.startswith("0.001\n")
    assert done.stdout.count("pip install 'zerodrift[symbolic]'") == 3
