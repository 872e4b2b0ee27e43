"""`zd.fmu`: a mechanism as a functional mock-up unit, for co-simulation in other tools."""

from __future__ import annotations

import hashlib
import io
import re
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple, Unpack
from xml.sax.saxutils import quoteattr

import numpy as np

from .._private import checks, gateway
from .._private.gateway.mechanisms import blocks
from .._private.types import ArrayLike, Events, Measures, Settings, SystemLike
from .._private.writing import with_suffix, write_atomically
from ..errors import WrongValue
from ..runs.arguments.events import Watched
from ..systems.measure_values import component_names
from .block import Chosen, choose, written
from .c_source import core_of, data
from .core_files import CoreFiles
from .fmu_libraries import chosen_platforms, libraries
from .wasm import text

VERSIONS = ("3.0", "2.0")
OPENED = ("block/open_run/opened.c", "block/open_run/opened_states.c")
UNITS = {"m": 'm="1"', "rad": 'rad="1"', "s": 's="1"', "m/s": 'm="1" s="-1"', "rad/s": 'rad="1" s="-1"', "m/s^2": 'm="1" s="-2"',
         "rad/s^2": 'rad="1" s="-2"', "N": 'kg="1" m="1" s="-2"', "N m": 'kg="1" m="2" s="-2"', "W": 'kg="1" m="2" s="-3"',
         "J": 'kg="1" m="2" s="-2"'}


class Scalar(NamedTuple):
    """A variable of an FMU: value reference, name, "input" or "output", unit and start."""

    reference: int
    name: str
    causality: str
    unit: str
    start: float


def fmu(system: SystemLike, path: str | Path, *, step: float, inputs: Sequence[str] = (), outputs: Measures = (),
        events: Events | None = None, version: str = "3.0", platforms: Sequence[str] | None = None,
        p0: ArrayLike | None = None, v0: ArrayLike | None = None, t0: float = 0.0, **chosen: Unpack[Settings]) -> Path:
    """Write a mechanism as a functional mock-up unit (FMU) for co-simulation, as Simulink, Dymola and FMPy import it.

    The file has the mechanism as a block of data (see `block`), the core's sources, and a library for this platform, which the C
    compiler makes, or libraries for the `platforms`; the core is compiled once for the same methods and kept in the cache. The
    unit makes fixed steps; if those of the importer are not a whole number of them, the last one is shorter. Its state can be
    saved, restored and serialized; a restored unit continues with the same bits, in another process with the same library, too.

    Parameters
    ----------
    system : Mechanism or its system
    path : str or Path
        The suffix ``.fmu`` is added if it is missing.
    step : float
        Size of fixed steps, in s.
    inputs : list of str
        Forces, torques and speeds that are set from outside, such as ``"motor.torque"``; they must be given as numbers, which are
        their initial values. Forces are constant within a step of the importer; speeds are followed linearly over one step.
    outputs : list of measures or names
        Measures to read, vectors as a variable for each component: ``"pin.force.x"``, ``"pin.force.y"``.
    events : Event or measure, or a list of these, optional
        Measures, coordinates or velocities that reach a value. Where the importer allows it (``earlyReturnAllowed``), a step
        returns early at each of them, with its instant as ``lastSuccessfulTime``. A terminal one requests the end of the
        simulation, in FMI 2.0 by ``fmi2Discard``, in FMI 3.0 at the end of the step if this may not return early. What they
        set by `then`, a dict, are inputs, which have that value until it is set again, from outside or by an event.
    version : {"3.0", "2.0"}
        Version of the FMI standard.
    platforms : list of str, optional
        Platforms to compile for, by their names in the standard: ``"x86_64-linux"``, ``"aarch64-linux"``, ``"x86_64-windows"``,
        ``"aarch64-windows"``, ``"x86_64-darwin"``, ``"aarch64-darwin"``; in FMI 2.0 ``"linux64"``, ``"win64"``, ``"darwin64"``.
        The package ziglang compiles for each of them on every machine: ``pip install zerodrift[fmu]``. Those for Linux need glibc
        2.17 or later. By default this platform.
    p0, v0, t0, **chosen
        As in `block`.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    CompilationFailed
        Without a C compiler, or without ziglang for `platforms`; or if it fails.
    ValueError
        As `block`; or if a platform has no name in the standard.

    References
    ----------
    Functional Mock-up Interface for Model Exchange, Co-Simulation, and Scheduled Execution, version 3.0, https://fmi-standard.org.

    Examples
    --------
    >>> import tempfile, zerodrift as zd
    >>> bar = zd.models.four_bar()
    >>> with tempfile.TemporaryDirectory() as folder:       # doctest: +SKIP
    ...     zd.fmu(bar, folder + "/bar.fmu", step=0.001, outputs=["crank.angle"]).name
    'bar.fmu'
    """
    checks.choice("version", version, VERSIONS)
    names = None if platforms is None else chosen_platforms(platforms, version)
    step = checks.number("step", step, above=0, code="step-size")
    made = choose(system, p0, v0, t0, step, list(outputs), inputs, events=events, **chosen)
    _check_events(made.events, version)
    path = with_suffix(path, ".fmu")
    identifier = re.sub(r"\W", "_", path.stem, flags=re.ASCII)
    identifier = identifier if identifier[:1].isalpha() else f"m_{identifier}"
    content = _packed(made, identifier, version, names)
    write_atomically(path, lambda file: file.write(content))
    return path


def _check_events(events: Sequence[Watched], version: str) -> None:
    for each in events:
        if each.terminal > 1:
            raise WrongValue(f"{each.name}.terminal must be True or False in an FMU, not {each.terminal}", "not-available")
        if version == "2.0" and not each.terminal and not each.then:
            raise WrongValue(f"{each.name} must be terminal in FMI 2.0, whose steps do not return early, or act", "not-available")


def _packed(made: Chosen, identifier: str, version: str, platforms: Sequence[str] | None) -> bytes:
    """The zip file."""
    scalars = _scalars(made)
    parts = (written(made), version.encode(), gateway.FINGERPRINT.encode())
    token = "{" + hashlib.sha256(b"".join(parts)).hexdigest()[:32] + "}"
    files = core_of(made, OPENED)
    own = {f"fmi{version[0]}.c": text(f"fmi{version[0]}.c"), "fmu.h": text("fmu.h"),
           "data.h": f'#define TOKEN "{token}"\n{data(made)}'}
    description = (_description3(made, identifier, token, scalars, bool(made.events)) if version == "3.0" else
                   _description2(made, identifier, token, scalars, files))
    binaries = libraries(files, own, version, platforms)
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("modelDescription.xml", description)
        for each in binaries:
            archive.writestr(f"binaries/{each.platform}/{identifier}{each.suffix}", each.content)
        for name, source in {**files.texts, **own}.items():
            archive.writestr(f"sources/{name}", source)
        if version == "3.0":
            archive.writestr("sources/buildDescription.xml", _build_description(identifier, files))
    return packed.getvalue()


# ---- the model description ----

def _scalars(made: Chosen) -> list[Scalar]:
    """Inputs and outputs with their value references; 0 is time."""
    core = blocks.BlockCore(written(made))
    watching = made.system._watching
    found = [Scalar(i, name, "input", core.input_unit(name), value) for i, (name, value) in enumerate(core.inputs.items(), 1)]
    for name in made.outputs or ():
        place = watching.find(name)
        assert place is not None        # as outputs are measures
        shape = place.pick(np.zeros((1, watching.known[name][1]))).shape[1:]
        found += [Scalar(i, each, "output", watching.unit(name) or "", 0.0)
                  for i, each in enumerate(component_names(name, shape), len(found) + 1)]
    return found


def _quoted(name: str) -> str:
    """Name in the structured convention: parts that are not identifiers stand between apostrophes."""
    return quoteattr(".".join(map(_part, name.split("."))))


def _part(part: str) -> str:
    if re.fullmatch(r"[A-Za-z_]\w*", part, re.ASCII):
        return part
    escaped = part.replace("\\", "\\\\").replace("'", "\\'")
    return f"'{escaped}'"


def _units(scalars: Sequence[Scalar]) -> str:
    used = sorted({scalar.unit for scalar in scalars} & set(UNITS) | {"s"})
    lines = "".join(f"    <Unit name={quoteattr(unit)}><BaseUnit {UNITS[unit]}/></Unit>\n" for unit in used)
    return f"  <UnitDefinitions>\n{lines}  </UnitDefinitions>\n"


def _unit(scalar: Scalar) -> str:
    return f" unit={quoteattr(scalar.unit)}" if scalar.unit in UNITS else ""


def _start(scalar: Scalar) -> str:
    return f" start={quoteattr(repr(scalar.start))}" if scalar.causality == "input" else ""


def _heading(made: Chosen, version: str, token: str) -> str:
    return (f'<?xml version="1.0" encoding="UTF-8"?>\n<fmiModelDescription fmiVersion="{version}" '
            f'modelName={quoteattr(made.system.name)} {token} '
            f'generationTool="zerodrift {gateway.FINGERPRINT[:12]}" variableNamingConvention="structured">\n')


def _experiment(made: Chosen) -> str:
    return f'  <DefaultExperiment startTime="{made.core_settings.t0!r}" stepSize="{made.core_settings.step!r}"/>\n'


def _description3(made: Chosen, identifier: str, token: str, scalars: Sequence[Scalar], has_events: bool) -> str:
    variables = "".join(
        f'    <Float64 name={_quoted(each.name)} valueReference="{each.reference}" causality="{each.causality}" '
        f'variability="continuous"{_unit(each)}{_start(each)}/>\n' for each in scalars)
    outputs = [each.reference for each in scalars if each.causality == "output"]
    structure = "".join(f'    <{kind} valueReference="{reference}"/>\n' for kind in ("Output", "InitialUnknown")
                        for reference in outputs)
    early = ' mightReturnEarlyFromDoStep="true"' if has_events else ""
    return (f"""{_heading(made, "3.0", f"instantiationToken={quoteattr(token)}")}  <CoSimulation modelIdentifier="{identifier}"\
 canHandleVariableCommunicationStepSize="true" canGetAndSetFMUState="true" canSerializeFMUState="true"{early}/>
{_units(scalars)}{_experiment(made)}  <ModelVariables>
    <Float64 name="time" valueReference="0" causality="independent" variability="continuous" unit="s"/>
{variables}  </ModelVariables>
  <ModelStructure>
{structure}  </ModelStructure>
</fmiModelDescription>
""")


def _description2(made: Chosen, identifier: str, token: str, scalars: Sequence[Scalar], files: CoreFiles) -> str:
    variables = "".join(
        f'    <ScalarVariable name={_quoted(each.name)} valueReference="{each.reference}" causality="{each.causality}" '
        f'variability="continuous"><Real{_unit(each)}{_start(each)}/>'
        "</ScalarVariable>\n" for each in scalars)
    unknowns = "".join(f'      <Unknown index="{i}"/>\n' for i, each in enumerate(scalars, 2) if each.causality == "output")
    kinds = ("Outputs", "InitialUnknowns") if unknowns else ()
    structure = "".join(f"    <{kind}>\n{unknowns}    </{kind}>\n" for kind in kinds)
    sources = "".join(f'      <File name="{name}"/>\n' for name in ["fmi2.c", *files.sources])
    return (f"""{_heading(made, "2.0", f"guid={quoteattr(token)}")}  <CoSimulation modelIdentifier="{identifier}"\
 canHandleVariableCommunicationStepSize="true" canGetAndSetFMUstate="true" canSerializeFMUstate="true">
    <SourceFiles>
{sources}    </SourceFiles>
  </CoSimulation>
{_units(scalars)}{_experiment(made)}  <ModelVariables>
    <ScalarVariable name="time" valueReference="0" causality="independent" variability="continuous">\
<Real unit="s"/></ScalarVariable>
{variables}  </ModelVariables>
  <ModelStructure>
{structure}  </ModelStructure>
</fmiModelDescription>
""")


def _build_description(identifier: str, files: CoreFiles) -> str:
    sources = "".join(f'      <SourceFile name="{name}"/>\n' for name in ["fmi3.c", *files.sources])
    return (f"""<?xml version="1.0" encoding="UTF-8"?>
<fmiBuildDescription fmiVersion="3.0">
  <BuildConfiguration modelIdentifier="{identifier}">
    <SourceFileSet language="C11" compilerOptions="-ffp-contract=off">
{sources}      <IncludeDirectory name="."/>
    </SourceFileSet>
  </BuildConfiguration>
</fmiBuildDescription>
""")
