"""`zd.fmu`: valid by FMPy, with the numbers of open runs, and the core's sentences as messages."""

import zipfile

import numpy as np
import pytest

import zerodrift as zd
from core_objects import needs_compiler

fmpy = pytest.importorskip("fmpy")
pytestmark = [needs_compiler, pytest.mark.filterwarnings("ignore")]       # FMPy opens files that it does not close
OUTPUTS = ["lower.end.position", "elbow.force", "upper.angle"]
STEP = 1e-3


def crane(torque=0.0, **more):
    m = zd.Mechanism("two links", gravity=(0, -9.81))
    upper, lower = m.link("upper", (0, 0), (0, -1), mass=1.0), m.link("lower", (0, -1), (0, -2), mass=1.0)
    pin = m.revolute("pin", m.ground, upper.start)
    m.revolute("elbow", upper.end, lower.start)
    m.motor("drive", pin, torque=torque)
    return m


@pytest.fixture(scope="module", params=["3.0", "2.0"])
def unit(request, tmp_path_factory):
    """File of a crane whose torque is an input."""
    path = tmp_path_factory.mktemp("fmu") / "crane 1.fmu"
    return zd.fmu(crane(), path, step=STEP, inputs=["drive.torque"], outputs=OUTPUTS, version=request.param)


def columns(result):
    return np.column_stack([result[name] for name in result.dtype.names[1:]])


def test_it_is_valid(unit):
    from fmpy.validation import validate_fmu

    assert validate_fmu(str(unit)) == []
    names = set(zipfile.ZipFile(unit).namelist())
    assert {"modelDescription.xml", "sources/block/plane.c", "sources/data.h"} <= names
    variables = {variable.name: variable for variable in fmpy.read_model_description(str(unit)).modelVariables}
    assert {"drive.torque", "lower.end.position[1]", "elbow.force[2]", "upper.angle"} <= set(variables)
    assert variables["elbow.force[1]"].unit == "N"


def test_a_constant_input_gives_the_numbers_of_simulate(unit):
    given = np.array([(0.0, 2.0), (2.0, 2.0)], dtype=[("time", float), ("drive.torque", float)])
    found = fmpy.simulate_fmu(str(unit), stop_time=1.0, step_size=0.01, output_interval=0.01, input=given)
    sol = zd.simulate(crane(2.0), 1.0, step=STEP, outputs=OUTPUTS, vector="baseline")
    expected = np.column_stack([sol[name] for name in OUTPUTS])[::10]
    np.testing.assert_allclose(columns(found)[1:], expected[1:], rtol=0, atol=1e-10)


def test_an_input_that_jumps_between_steps_gives_the_bits_of_an_open_run(unit):
    description = fmpy.read_model_description(str(unit))
    references = {variable.name: variable.valueReference for variable in description.modelVariables}
    slave = fmpy.instantiate_fmu(fmpy.extract(str(unit)), description, fmi_type="CoSimulation")
    three = description.fmiVersion == "3.0"
    if not three:
        slave.setupExperiment(startTime=0.0)
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    run = zd.Run(crane(), step=STEP, inputs=["drive.torque"], vector="baseline")
    put, get = (slave.setFloat64, slave.getFloat64) if three else (slave.setReal, slave.getReal)
    for i, torque in enumerate([1.0, -3.0, 0.5, 8.0]):
        put([references["drive.torque"]], [torque])
        run["drive.torque"] = torque
        slave.doStep(currentCommunicationPoint=0.05 * i, communicationStepSize=0.05)
        run.step(50)
        assert list(get([references["upper.angle"]])) == [run["upper.angle"]]
    slave.terminate()
    slave.freeInstance()


def test_failures_are_reported_with_the_sentence_of_the_core(unit):
    told = []
    given = np.array([(0.0, 2.0), (0.5, np.inf)], dtype=[("time", float), ("drive.torque", float)])
    with pytest.raises(Exception, match=r"DoStep|failed|status"):
        fmpy.simulate_fmu(str(unit), stop_time=1.0, step_size=0.1, output_interval=0.1, input=given,
                          logger=lambda *words: told.append(str(words)))
    assert "inputs must be finite numbers" in "".join(told)


def test_other_versions_are_refused(tmp_path):
    with pytest.raises(ValueError, match=r"version must be one of .3\.0., .2\.0., not .1\.0."):
        zd.fmu(crane(), tmp_path / "crane", step=STEP, version="1.0")
