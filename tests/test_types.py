"""Types that editors and type checkers read: declarations of what is made or imported on demand, signatures, and completions.

Completions are those of jedi, which IPython and many editors ask; it reads the sources and runs nothing.
"""

import inspect

import jedi
import pytest

import zerodrift as zd
from stubs import STUBS

CODE = """import zerodrift as zd
m = zd.Mechanism("pendulum", gravity=(0, -9.81))
link = m.link("link", (0, 0), (1, 0), mass=1.0)
pin = m.revolute("pin", m.ground, link.start)
spring = m.spring("spring", m.ground.point((0, -1)), link.end, stiffness=10.0)
sol = zd.simulate(m, 1.0)
eq = zd.equilibrium(m)
lin = zd.linearize(m)
run = zd.Run(m, step=0.01)
many = zd.ManyRuns(m, runs=4, step=0.01)
ens = zd.ensemble(m, 1.0)
"""
PUBLIC = [name for name in zd.__all__ if callable(getattr(zd, name)) and not (
    inspect.isclass(getattr(zd, name)) and issubclass(getattr(zd, name), BaseException))]
WITHOUT_CLASS = {"numba_signature"}      # a type of numba
METHODS = {"integrator=", "rtol=", "formulation=", "stabilization=", "closed_form="}
COMPLETIONS = {     # what a user writes, and some of the names that an editor offers then
    "zd.": {"Mechanism", "simulate", "Run", "linearize", "equilibrium", "ensemble", "models", "plot", "Projection"},
    "zd.li": {"linearize", "linkage"},
    "zd.systems.": {"four_bar", "pendulum"},
    "zd.models.": {"jansen", "four_bar", "gyroscope"},
    "zd.plot.": {"measures", "mechanism", "motion"},
    "m.": {"link", "body", "revolute", "spring", "motor", "start", "system", "lifted"},
    "m.re": {"revolute"},
    "link.": {"start", "end", "angle", "center", "angular_velocity", "length"},
    "link.end.": {"position", "velocity", "acceleration"},
    "link.end.position.": {"x", "y"},
    "pin.": {"angle", "speed", "force", "torque", "transmission_angle"},
    "pin.force.": {"x", "y"},
    "spring.": {"force", "length", "stiffness"},
    "sol.": {"t", "p", "v", "at", "save", "stats", "to_csv", "multipliers", "position_violation", "energy_violation"},
    "sol.at(0.5).": {"p", "v", "vdot", "multipliers"},
    "sol.system.": {"coordinates", "evaluate", "nq", "with_parameters"},
    "eq.": {"p", "effort", "stiffness", "frequencies", "stable", "eigenvalues"},
    "lin.": {"A", "B", "modes", "frequencies", "frequency_response", "in_coordinates"},
    "run.": {"step", "advance_to", "inputs", "save", "restore", "solution"},
    "many.": {"step", "reset", "failed", "messages", "t"},
    "ens.": {"failed", "messages", "to_pandas", "to_xarray", "save"},
    "zd.errors.": {"StepFailed", "ZerodriftError"},
    "zd.simulate(m, 1.0, ": {"step=", "t_eval=", "events=", "outputs=", "inputs=", "control=", "save_to=", *METHODS},
    "zd.Run(m, ": {"step=", "inputs=", "control=", "record=", "t0=", *METHODS},
    "zd.ManyRuns(m, ": {"runs=", "step=", "inputs=", *METHODS},
    "zd.ensemble(m, 1.0, ": {"parameters=", "outputs=", "executor=", "step=", "t_eval=", "events=", *METHODS},
    "zd.fmu(m, 'm.fmu', ": {"step=", "inputs=", "outputs=", "integrator="},
    "zd.simulate(m, 1.0, stabilization=zd.Projection(": {"tol=", "metric=", "every="},
    "zd.systems.four_bar(": {"lengths=", "gravity=", "assembly="},
    "zd.models.jansen(": {"speed=", "scale="},
    "m.revolute('B', m.ground, link.end, ": {"at=", "axis=", "damping=", "cut="},
    "m.motor('drive', pin, ": {"speed=", "torque=", "angle=", "of="},
    "zd.linearize(m, ": {"at=", "inputs=", "outputs="},
    "zd.equilibrium(m, ": {"near=", "hold=", "stability="}}


@pytest.mark.parametrize("path", STUBS, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_declarations_are_those_of_the_package(path):
    """Written anew by ``python tests/support/stubs.py``; names of the core's tables among them."""
    assert path.read_text(encoding="utf-8") == STUBS[path]()


def test_the_signature_of_simulate_is_read_in_ten_lines():
    lines = inspect.getsource(zd.simulate).splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("def "))
    assert next(i for i, line in enumerate(lines) if line.endswith(":")) - first < 10
    assert len(str(inspect.signature(zd.simulate))) < 800       # ten lines of a terminal, in `help`


@pytest.fixture(autouse=True, scope="module")
def own_cache(tmp_path_factory):
    """Files that jedi keeps, apart from those of other processes, which may be half written."""
    kept, jedi.settings.cache_directory = jedi.settings.cache_directory, tmp_path_factory.mktemp("jedi")
    yield
    jedi.settings.cache_directory = kept



@pytest.mark.parametrize("written", COMPLETIONS)
def test_an_editor_completes_what_a_user_writes(written):
    found = {each.name for each in jedi.Script(CODE + written).complete()}
    assert found >= COMPLETIONS[written]


@pytest.mark.parametrize("name", PUBLIC)
def test_every_public_function_completes_with_its_arguments_and_its_result(name):
    params = [each for signature in jedi.Script(CODE + f"zd.{name}(").get_signatures() for each in signature.params]
    asked = inspect.signature(getattr(zd, name)).parameters.values()
    assert {each.name for each in asked if each.kind is not each.VAR_KEYWORD} <= {each.name for each in params}
    untyped = [each.name for each in params if each.description.endswith(": Any") or ": Any=" in each.description]
    assert not untyped
    found = jedi.Script(CODE + f"found = zd.{name}()\nfound").infer()
    assert bool(found) is (name not in WITHOUT_CLASS)
