"""`zd.fmu`: valid by FMPy, with the numbers of open runs, and the core's sentences as messages."""

import struct
import subprocess
import sys
import zipfile

import numpy as np
import pytest

import zerodrift as zd
from core_objects import needs_compiler
from few_bodies import touching_bodies, two_links
from support import assert_close, refused, relay
from written_laws import machine_of_laws
from zerodrift.export import fmu_libraries
from zerodrift.symbolics.compile import compilers

fmpy = pytest.importorskip("fmpy")
pytestmark = [needs_compiler, pytest.mark.filterwarnings("ignore")]       # FMPy opens files that it does not close
AARCH64 = 183       # machine in the header of an ELF file
OUTPUTS = ["lower.end.position", "elbow.force", "upper.angle"]
STEP = 1e-3


@pytest.fixture(scope="module", params=["3.0", "2.0"])
def version(request):
    return request.param


@pytest.fixture(scope="module")
def unit(version, tmp_path_factory):
    """File of a crane whose torque is an input."""
    path = tmp_path_factory.mktemp("fmu") / "crane 1.fmu"
    return zd.fmu(two_links(), path, step=STEP, inputs=["drive.torque"], outputs=OUTPUTS, version=version)


class Opened:
    """An instance of a unit that is stepped, after its initialization with some inputs."""

    def __init__(self, unit, inputs=(), told=None):
        description = fmpy.read_model_description(str(unit))
        self.reference = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.slave = fmpy.instantiate_fmu(fmpy.extract(str(unit)), description, fmi_type="CoSimulation",
                                          **({} if told is None else {"logger": lambda *words: told.append(str(words))}))
        self.three, self.t = description.fmiVersion == "3.0", 0.0
        if not self.three:
            self.slave.setupExperiment(startTime=0.0)
        self.slave.enterInitializationMode()
        self.set(dict(inputs))
        self.slave.exitInitializationMode()

    def set(self, inputs):
        for name, value in inputs.items():
            (self.slave.setFloat64 if self.three else self.slave.setReal)([self.reference[name]], [value])

    def __getitem__(self, name):
        return float((self.slave.getFloat64 if self.three else self.slave.getReal)([self.reference[name]])[0])

    def step(self, steps, inputs=()):
        self.set(dict(inputs))
        self.slave.doStep(currentCommunicationPoint=self.t, communicationStepSize=steps * STEP)
        self.t += steps * STEP

    def call(self, name, *given):
        """Function for states, which FMPy names as the version of the standard does."""
        name = name if self.three else name.replace("FMUState", "FMUstate").replace("deserialize", "deSerialize")
        return getattr(self.slave, name)(*given)

    def close(self):
        self.slave.terminate()
        self.slave.freeInstance()


def columns(result):
    return np.column_stack([result[name] for name in result.dtype.names[1:]])


def test_it_is_valid(unit):
    from fmpy.validation import validate_fmu

    assert validate_fmu(str(unit)) == []
    names = set(zipfile.ZipFile(unit).namelist())
    assert {"modelDescription.xml", "sources/block/plane.c", "sources/data.h"} <= names
    description = fmpy.read_model_description(str(unit)).coSimulation
    assert description.canGetAndSetFMUstate
    assert description.canSerializeFMUstate
    variables = {variable.name: variable for variable in fmpy.read_model_description(str(unit)).modelVariables}
    assert {"drive.torque", "lower.end.position.x", "elbow.force.y", "upper.angle"} <= set(variables)
    assert variables["elbow.force.x"].unit == "N"


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_a_unit_without_inputs_and_outputs_is_valid(version, tmp_path):
    from fmpy.validation import validate_fmu

    assert validate_fmu(str(zd.fmu(two_links(), tmp_path / "crane", step=STEP, version=version))) == []


def test_a_constant_input_gives_the_numbers_of_simulate(unit):
    given = np.array([(0.0, 2.0), (2.0, 2.0)], dtype=[("time", float), ("drive.torque", float)])
    found = fmpy.simulate_fmu(str(unit), stop_time=1.0, step_size=0.01, output_interval=0.01, input=given)
    sol = zd.simulate(two_links(2.0), 1.0, step=STEP, outputs=OUTPUTS, vector="baseline", closed_form=False)
    expected = np.column_stack([sol[name] for name in OUTPUTS])[::10]
    np.testing.assert_allclose(columns(found)[1:], expected[1:], rtol=0, atol=1e-10)


def test_recorded_functions_have_the_bits_of_simulate(tmp_path):
    m, names = machine_of_laws()
    unit = Opened(zd.fmu(m, tmp_path / "laws", step=STEP, outputs=names))
    unit.step(100)
    sol = zd.simulate(m, 0.1, step=STEP, outputs=names, vector="baseline", closed_form=False)
    assert [unit[name] for name in names] == [sol[name][-1] for name in names]
    unit.close()


def test_contacts_have_the_bits_of_simulate(tmp_path):
    m, names = touching_bodies()
    unit = Opened(zd.fmu(m, tmp_path / "bodies", step=STEP, outputs=names))
    for _ in range(30):
        unit.step(100)
    run = zd.Run(m, step=STEP, vector="baseline", closed_form=False)
    run.step(3000)
    for name in names:
        whole = np.atleast_1d(run[name])
        assert [unit[name if len(whole) == 1 else f"{name}.{axis}"] for axis in "xy"[:len(whole)]] == whole.tolist()
    unit.close()


def test_an_input_that_jumps_between_steps_gives_the_bits_of_an_open_run(unit):
    slave = Opened(unit)
    run = zd.Run(two_links(), step=STEP, inputs=["drive.torque"], vector="baseline")
    for torque in [1.0, -3.0, 0.5, 8.0]:
        run["drive.torque"] = torque
        slave.step(50, {"drive.torque": torque})
        run.step(50)
        assert slave["upper.angle"] == run["upper.angle"]
    slave.close()


@pytest.mark.parametrize(("drive", "value"), [("torque", 3.0), ("speed", 0.5)])
def test_a_restored_state_continues_with_the_same_bits(drive, value, version, tmp_path):
    """Saved after one step with a new input, so that a speed is on its way to it; the torque began with another one."""
    name = f"drive.{drive}"
    unit = zd.fmu(two_links(**{drive: 0.0}), tmp_path / "crane", step=STEP, inputs=[name], outputs=OUTPUTS, version=version)
    one, other = Opened(unit, {name: 0.25 if drive == "torque" else 0.0}), Opened(unit)     # the links start at rest
    one.step(30)
    one.step(1, {name: value})
    state = one.call("getFMUState")
    saved = bytes(one.call("serializeFMUState", state))
    expected = rest(one, drive)
    one.call("setFMUState", state)
    assert one[name] == value
    assert rest(one, drive) == expected
    one.call("freeFMUState", state)
    other.step(7)
    other.t = one.t
    other.call("setFMUState", other.call("deserializeFMUState", saved))
    assert rest(other, drive) == expected
    (tmp_path / "state").write_bytes(saved)
    program = f"import sys; sys.path[:0] = {sys.path!r}; import export.test_fmu as here; here.answer(*sys.argv[1:])"
    said = subprocess.run([sys.executable, "-W", "ignore", "-c", program, unit, tmp_path / "state", drive], check=True,
                          capture_output=True, text=True).stdout
    assert said.split()[-1] == expected
    one.close()
    other.close()


def rest(slave, drive):
    """Digits of the outputs over some steps from a state on, with inputs that jump."""
    start, found = slave.t, []
    for i, value in enumerate([None, 1.0, -2.0]):
        slave.step(20 + i, {} if value is None else {f"drive.{drive}": value})
        found += [slave[name].hex() for name in ("upper.angle", "elbow.force.x")]
    slave.t = start
    return ",".join(found)


def answer(unit, state, drive):
    """Print the rest of a run from a state in a file."""
    slave = Opened(unit)
    slave.t = 31 * STEP
    with open(state, "rb") as file:
        slave.call("setFMUState", slave.call("deserializeFMUState", file.read()))
    print(rest(slave, drive))


def test_a_state_that_is_damaged_is_refused_and_the_unit_goes_on(unit):
    told = []
    one, twin = Opened(unit, told=told), Opened(unit)
    for each in (one, twin):
        each.step(10, {"drive.torque": 2.0})
    saved = bytes(one.call("serializeFMUState", one.call("getFMUState")))
    for wrong, reason in ((saved[:-8], "must be whole"), (saved[:4], "must be whole"),
                          (saved[:-1] + bytes([saved[-1] ^ 1]), "must be unchanged")):
        told.clear()
        with pytest.raises(Exception, match=r"SetFMU[sS]tate|failed|status"):
            one.call("setFMUState", one.call("deserializeFMUState", wrong))
        assert reason in "".join(told)
    for each in (one, twin):
        each.step(10)
    assert one["upper.angle"] == twin["upper.angle"]
    one.close()
    twin.close()


def test_failures_are_reported_with_the_sentence_of_the_core(unit):
    told = []
    given = np.array([(0.0, 2.0), (0.5, np.inf)], dtype=[("time", float), ("drive.torque", float)])
    with pytest.raises(Exception, match=r"DoStep|failed|status"):
        fmpy.simulate_fmu(str(unit), stop_time=1.0, step_size=0.1, output_interval=0.1, input=given,
                          logger=lambda *words: told.append(str(words)))
    assert "inputs must be finite numbers" in "".join(told)


# ---- events ----

EVENTS = [zd.Event("upper.angle", value=-1.5), zd.Event("pin.speed", value=0.9, direction=1, terminal=True)]


def with_events(folder, version, events):
    """Unit of a crane with these events, and whose outputs are the quantities of `EVENTS`."""
    return zd.fmu(two_links(4.0), folder / "crane", step=STEP, inputs=["drive.torque"], outputs=["upper.angle", "pin.speed"],
                  events=events, version=version)


@pytest.fixture(scope="module")
def eventful(tmp_path_factory):
    return with_events(tmp_path_factory.mktemp("events"), "3.0", EVENTS)


def run_of(unit, **options):
    return fmpy.simulate_fmu(str(unit), stop_time=0.5, step_size=0.02, output_interval=0.02, **options)


def located():
    """Instants of the events by `simulate`, without input."""
    sol = zd.simulate(two_links(4.0), 0.5, step=STEP, events=EVENTS, vector="baseline", closed_form=False)
    return [float(times[0]) for times in sol.t_events]


def test_steps_return_early_at_events_where_the_importer_allows_it(eventful):
    passed, ended = located()
    assert fmpy.read_model_description(str(eventful)).coSimulation.mightReturnEarlyFromDoStep
    assert 0.02 < passed < ended < 0.48
    found = run_of(eventful, early_return_allowed=True)
    at = np.argmin(abs(found["time"] - passed))
    np.testing.assert_allclose([found["time"][at], found["time"][-1]], [passed, ended], rtol=0, atol=1e-9)
    np.testing.assert_allclose([found["upper.angle"][at], found["pin.speed"][-1]], [-1.5, 0.9], rtol=0, atol=1e-9)
    assert found["time"][at + 1] > found["time"][at] + 1e-3         # it is not located again


def test_without_early_return_the_end_is_requested_at_the_end_of_a_step(eventful):
    found, (_, ended) = run_of(eventful), located()
    assert 0 <= found["time"][-1] - ended < 0.02
    sol = zd.simulate(two_links(4.0), 0.5, step=STEP, outputs=["upper.angle"], vector="baseline", closed_form=False)
    np.testing.assert_allclose(found["upper.angle"][1:-1], sol["upper.angle"][20:20 * (len(found) - 1):20], rtol=0, atol=1e-12)


def test_a_terminal_event_discards_the_step_in_the_second_version(tmp_path):
    unit, (_, ended) = with_events(tmp_path, "2.0", EVENTS[1:]), located()
    told = []
    found = run_of(unit, logger=lambda *words: told.append(str(words)))     # FMPy would go on calling that of the last unit
    np.testing.assert_allclose([found["time"][-1], found["pin.speed"][-1]], [ended, 0.9], rtol=0, atol=1e-9)
    assert "ended by event 0" in "".join(told)
    with refused("not-available", r"events\[0\] must be terminal in FMI 2\.0"):
        with_events(tmp_path, "2.0", EVENTS)


@pytest.mark.parametrize("early", [False, True])
def test_events_set_inputs(tmp_path, version, early):
    m, events = relay()
    unit = zd.fmu(m, tmp_path / "relay", step=STEP, outputs=["pin.angle"], events=events, version=version)
    found = fmpy.simulate_fmu(str(unit), stop_time=5.0, step_size=0.05, output_interval=0.05,
                              **({"early_return_allowed": early} if version == "3.0" else {}))
    sol = zd.simulate(m, 5.0, step=STEP, events=events, vector="baseline", closed_form=False)
    tolerance = 1e-8 if early else 0.0      # early: steps begin at events
    assert_close(found["pin.angle"][-1], sol["pin.angle"][-1], tolerance, scale=1.0)


def test_events_of_units_are_quantities_that_reach_a_value(tmp_path):
    with refused("not-portable", "not a function of several"):
        with_events(tmp_path, "3.0", lambda t, p, v: p[0])
    with refused("not-available", "terminal must be True or False"):
        with_events(tmp_path, "3.0", zd.Event("pin.speed", value=0.3, terminal=2))


def test_other_versions_are_refused(tmp_path):
    with refused("unknown-choice", "version"):
        zd.fmu(two_links(), tmp_path / "crane", step=STEP, version="1.0")


# ---- other platforms ----


def test_ziglang_compiles_for_a_platform_that_is_named(tmp_path, monkeypatch):
    """Without the core, which takes half a minute, and the C library: `tests/stress/fmu_platforms.py` takes all."""
    from fmpy.validation import validate_fmu

    pytest.importorskip("ziglang")
    monkeypatch.setattr(fmu_libraries.core_build, "compiled", lambda *_, **__: b"!<arch>\n")
    monkeypatch.setattr(fmu_libraries, "FLAGS", (*fmu_libraries.FLAGS, "-nostdlib"))
    unit = zd.fmu(two_links(), tmp_path / "crane", step=STEP, platforms=["aarch64-linux", "aarch64-linux"])
    with zipfile.ZipFile(unit) as archive:
        binaries = [name for name in archive.namelist() if name.startswith("binaries/")]
        library = archive.read("binaries/aarch64-linux/crane.so")
    assert binaries == ["binaries/aarch64-linux/crane.so"]
    assert library[:4] == b"\x7fELF"
    assert struct.unpack_from("<H", library, 18)[0] == AARCH64
    assert all(name in library for name in (b"fmi3InstantiateCoSimulation\0", b"fmi3DoStep\0", b"fmi3GetShiftFraction\0"))
    assert validate_fmu(str(unit)) == []


def test_platforms_are_named_as_the_standard_does(tmp_path, monkeypatch):
    def written(**options):
        return zd.fmu(two_links(), tmp_path / "crane", step=STEP, **options)

    with refused("unknown-choice", "platforms of FMI 3.0"):
        written(platforms=["win64"])
    with refused("unknown-choice", "platforms of FMI 2.0"):
        written(platforms=["aarch64-linux"], version="2.0")
    for wrong in ("x86_64-linux", []):
        with pytest.raises(TypeError, match="platforms must be a list of names"):
            written(platforms=wrong)
    monkeypatch.setattr(compilers, "zig", lambda: None)
    with pytest.raises(zd.CompilationFailed, match=r"pip install zerodrift\[fmu\]"):
        written(platforms=["x86_64-windows"])
