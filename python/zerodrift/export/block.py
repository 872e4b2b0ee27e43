"""`zd.block`: a mechanism as one block of data, which the core reads without Python."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple, Unpack

import numpy as np

from .._private import checks
from .._private.gateway.mechanisms import blocks
from .._private.gateway.mechanisms.element_tables import OutputSpec, law_sizes
from .._private.types import ArrayLike, Events, Measures, Settings, SystemLike
from ..errors import WrongType, WrongValue
from ..mechanisms.equations.measure_tables import read
from ..mechanisms.equations.space_tables import tables_of
from ..mechanisms.system import MechanismSystem
from ..runs.arguments import outputs as _outputs
from ..runs.arguments import settings
from ..runs.arguments.events import Watched, inputs_of
from ..runs.states.instant import start_of
from ..systems.base import core_of, system_of
from . import parameters as _parameters
from .grip import Grip
from .law_programs import Programs
from .levels import levels, measures_of
from .levels import sections as event_sections

MAX_MEASURES = 8192        # of a system of the core
TABLES = blocks.SECTIONS[:blocks.SECTIONS.index("start")]      # sections whose words parameters may change


class Chosen(NamedTuple):
    """A mechanism's system with its start, and what a block holds of its run."""

    system: MechanismSystem
    p: Any
    v: Any
    core_settings: Any              # a `zd_settings`
    outputs: tuple[str, ...] | None     # measures; None: all, and none is recorded
    inputs: tuple[str, ...]
    limits: Mapping[str, tuple[float, float]] = MappingProxyType({})       # of parameters
    watched: tuple[str, ...] = ()   # measures that are kept besides the outputs, and those of events
    events: tuple[Watched, ...] = ()
    has_grip: bool = False          # a force on a point of a body, see `grip`


def block(system: SystemLike, p0: ArrayLike | None = None, v0: ArrayLike | None = None, *, t0: float = 0.0,
          step: float | None = 0.01, outputs: Measures | None = None, inputs: Sequence[str] = (),
          events: Events | None = None, parameters: Mapping[str, tuple[float, float]] | None = None,
          **chosen: Unpack[Settings]) -> bytes:
    """A mechanism as one block of data: tables, user functions, start, measures, inputs, and the settings of a run.

    The core makes a system of it without Python. Its format is described in ``block.h`` of the core's sources: words of eight
    bytes, so that a program of a few hundred lines can write one, too. User functions are held as programs of elementary
    operations, tables as splines.

    Parameters
    ----------
    system : Mechanism or its system
        The tables of `Mechanism.system`, in its coordinates.
    p0, v0 : array_like (nq,), (nv,), optional
        Start; by default that of `simulate`.
    t0 : float
        Time of the start, in s.
    step : float or None
        Size of fixed steps, in s; None: adaptive steps.
    outputs : list of measures or names, optional
        Measures that a run records; other measures are left out. By default all measures are kept, and none is recorded.
    inputs : list of str
        Numbers that may be set between steps: forces and torques, such as ``"motor.torque"``, and speeds of motors,
        ``"drive.speed"``, which must be given as numbers.
    events : Event or measure, or a list of these, optional
        Measures, coordinates or velocities that reach a value. What they set by `then`, a dict, are inputs, which need not be
        named.
    parameters : dict of (float, float), optional
        Lengths, masses, stiffnesses and other numbers, by their paths, that a program may change within these limits.
    **chosen
        Formulation, integrator, corrections and tolerances, as `simulate` takes them.

    Returns
    -------
    bytes

    Raises
    ------
    ValueError
        If a user function cannot be recorded, or has a function that a block does not know; it is named.
    TypeError
        If the system is not that of a mechanism.

    Examples
    --------
    >>> import zerodrift as zd
    >>> m = zd.models.four_bar()
    >>> data = zd.block(m, step=0.01, outputs=["crank.angle"])
    >>> data[:7], len(data) % 8
    (b'zdblock', 0)
    """
    made = choose(system, p0, v0, t0, step, outputs, inputs, events=events, **chosen)
    return written(made._replace(limits=_parameters.ranges(parameters or {}, made.system.parameters)))


def choose(system: Any, p0: Any, v0: Any, t0: float, step: float | None, outputs: Any, inputs: Sequence[str],
           events: Any = None, **chosen: Any) -> Chosen:
    """Check the arguments of `block`."""
    t0 = checks.number("t0", t0)
    system, p0, v0 = start_of(system, p0, v0, t0)
    if core_of(checks.instance("system", system_of(system), MechanismSystem, "a mechanism or its system")).functions:
        raise WrongValue(f"user functions must depend on t, positions and velocities in a block, and some of {system.name} read "
                         "reactions", "not-portable")
    p, v = system._state_or_start(p0, v0, t=t0)
    unknown = chosen.keys() - set(settings.DEFAULTS) | chosen.keys() & {"t_eval", "save_every", "closed_form", "vector"}
    if unknown:
        hint = ": parameters of an FMU or of C source are fixed, and inputs= change" if "parameters" in unknown else ""
        raise WrongType(f"{min(unknown)!r} must be an argument of the export or an option of simulate{hint}", "wrong-name")
    core_settings = settings.plan(
        system, (t0, t0 + 1), settings.Arguments(step=step, closed_form=False, vector="baseline", **chosen)).core_settings
    names = None if outputs is None else _measures(_outputs.names(outputs, system), system)
    inputs, found = tuple(dict.fromkeys([*_inputs(inputs), *inputs_of(events, system)])), levels(events, system)
    watched = measures_of(found, list(system._watching.known))
    return Chosen(system, p, v, core_settings, names, inputs, watched=watched, events=found)


def _measures(names: Sequence[str], system: MechanismSystem) -> tuple[str, ...]:
    """Names of whole measures, each once, in their order."""
    known = list(system._watching.known)
    found = []
    for name in names:
        place = system._watching.find(name)
        if place is None:
            raise WrongValue(f"outputs of a block must be measures of the mechanism, not {name!r}", "wrong-name")
        found.append(known[place.number])
    return tuple(dict.fromkeys(found))


def _inputs(inputs: Any) -> tuple[str, ...]:
    if isinstance(inputs, str) or not isinstance(inputs, Sequence) or not all(isinstance(name, str) for name in inputs):
        raise WrongType(f"inputs must be a list of names, not {checks.shown(inputs)}")
    return tuple(inputs)


def written(chosen: Chosen, words: _parameters.Words | None = None) -> bytes:
    """The block of these choices; `words` are those of `table_words`, if they have been computed before."""
    system, texts = chosen.system, blocks.Texts()
    tables = system._started_tables
    sections, counts, measures = _tables(chosen, tables, texts)
    sections |= {
        "start": [*chosen.p.tolist(), *chosen.v.tolist()], "outputs": [measures.index(name) for name in chosen.outputs or ()],
        "settings": blocks.settings(chosen.core_settings), "methods": blocks.methods(chosen.core_settings, texts),
        "names": [texts.offset(name) for name in (*(body.name for body in tables.parts), *(joint.name for joint in tables.joints),
                                                  *tables.relation_names)],
        **event_sections(chosen.events, list(system._watching.known), measures, chosen.inputs, system),
        **_parameter_sections(chosen, words or table_words(chosen), sections, counts, texts)}
    return blocks.assembled(system._drawing.dimension, sections, counts, texts)


def _tables(chosen: Chosen, tables: Any, texts: blocks.Texts) -> tuple[dict[str, list[float]], dict[str, int], list[str]]:
    """Sections of the tables, of user functions and of inputs; numbers of entries; and names of measures."""
    quantities, observed = read(tables)
    if chosen.outputs is not None:
        read_by = {name for row in observed for name in row.reads}      # formulas are kept, with what they read
        wanted = {*chosen.outputs, *chosen.watched, *read_by, *(name.rpartition(".")[0] for name in read_by)}
        observed = [row for row in observed if row.kind == "formula" or row.name in wanted]
        quantities, observed = _kept(len(tables.quantities), quantities, observed)
    packed, grip = tables.written(quantities, observed), None
    if chosen.has_grip:
        grip = Grip(chosen.system._drawing.dimension, len(quantities), len(tables.forces), len(tables.parts))
        packed = grip.added(packed)._replace(measures=[*observed, grip.measure])
    measures = [row.name for row in packed.measures]
    if len(measures) > MAX_MEASURES:
        raise WrongValue(f"outputs must be given for a mechanism with more than {MAX_MEASURES} measures, "
                         f"as {chosen.system.name} has", "missing-argument")
    packed, inputs, programs = _with_inputs(chosen, tables, packed, texts)
    inputs += grip.inputs(texts) if grip else []
    sections = {**blocks.tables(packed, texts), **vars(programs), "inputs": inputs}
    counts = {"bodies": len(packed.bodies), "joints": len(packed.joints), "quantities": len(packed.quantities),
              "terms": len(sections["terms"]) // 2, "relations": len(packed.relations), "forces": len(packed.forces),
              "measures": len(packed.measures), "groups": len(packed.groups)}
    return sections, counts, measures


def _kept(own: int, quantities: Sequence[Any], observed: Sequence[OutputSpec]) -> tuple[list[Any], list[OutputSpec]]:
    """These measures, and the marker quantities of the elements, which are the first `own`, and of these measures."""
    kept, found = list(quantities[:own]), []
    for row in observed:
        of_quantities = row.kind in ("values", "rates", "accelerations") and row.first >= own
        found.append(row._replace(first=len(kept)) if of_quantities else row)
        kept += quantities[row.first:row.first + row.size] if of_quantities else []
    return kept, found


def table_words(chosen: Chosen) -> _parameters.Words:
    """Words of the tables of a block, as functions of changed parameters."""
    system = chosen.system

    def words(changed: Mapping[str, float]) -> np.ndarray:
        other = system._with(dict(changed)) if changed else system
        tables = system._started_tables if not changed else tables_of(
            other._drawing, other._numbers, in_tree=system.layout == "joint", starts=system._start.drives)
        found = _tables(chosen, tables, blocks.Texts())[0]
        return np.concatenate([np.asarray(found[name], dtype=float) for name in TABLES])

    return _parameters.computed_once(words)


def _parameter_sections(chosen: Chosen, words: _parameters.Words, sections: Mapping[str, list[float]], counts: Mapping[str, int],
                        texts: blocks.Texts) -> dict[str, list[float]]:
    """Sections of parameters, and of the words that they change."""
    system, limits = chosen.system, chosen.limits
    found, products = _parameters.effects(words, limits)
    first = 4 + len(blocks.SECTIONS)
    found = [each + first if i % 3 == 0 else each for i, each in enumerate(found)]
    entries = [number for name, (least, most) in limits.items()
               for number in (texts.offset(name), texts.offset(""), system.parameters[name], least, most)]
    if chosen.has_grip:
        drawing, width = system._drawing, len(sections["quantities"]) // counts["quantities"]
        grip = Grip(drawing.dimension, counts["quantities"] - drawing.dimension, 0, counts["bodies"])
        begin = first + sum(len(sections[name]) for name in TABLES[:TABLES.index("quantities")])
        more = grip.effects(begin, width, len(limits), len(products) // 7)
        entries, found, products = entries + grip.parameters(texts), found + more[0], products + more[1]
    return {"parameters": entries, "effects": found, "products": products}


def _with_inputs(chosen: Chosen, tables: Any, packed: Any, texts: blocks.Texts) -> tuple[Any, list[float], Programs]:
    """Tables whose driven speeds read inputs, the section of inputs, and the programs of all user functions."""
    programs, sizes = Programs(), law_sizes(packed)
    for i, row in enumerate(tables.laws.rows):
        programs.add(row, sizes[i][0])
    relations, found = list(packed.relations), []
    for name in chosen.inputs:
        kind, index = _target(name, tables)
        value = packed.forces[index].value if kind == "force" else relations[index].slope
        if kind == "speed":
            law = programs.add_speed(name)
            relations[index], index = relations[index]._replace(nonholonomic=True, constant=0.0, slope=0.0, law=law), law
        unit = next((row.unit for row in tables.observed if row.name == name), "rad/s" if kind == "speed" else "N")
        found += [texts.offset(name), texts.offset(unit), blocks.INPUTS[kind], index, value]
    return packed._replace(relations=relations), found, programs


def _target(name: str, tables: Any) -> tuple[str, int]:
    """Member that an input sets, a force or a speed, and its index in the tables."""
    owner, _, quantity = name.rpartition(".")
    if quantity in ("force", "torque", "value"):
        values = (each.first for each in tables.observed if each.kind == "force value" and each.scale > 0
                  and each.name.rpartition(".")[0] == owner)
        index = next(values, None)
        if index is not None and tables.forces[index].kind == "constant":
            return "force", index
    if quantity == "speed" and owner in tables.relation_names:
        index = tables.relation_names.index(owner)
        relation = tables.relations[index]
        if relation.law < 0 and len(relation.quantities) == 1 and tables.drawing.elements[owner].drives == "speed":
            return "speed", index
    raise WrongValue("inputs must name forces, torques and speeds that are given as numbers, such as 'motor.torque', "
                     f"not {name!r}", "wrong-name")
