"""Constraints, forces and measures along marker quantities, in the plane and in space, as tables for the core."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, Generic, NamedTuple

from ....errors import WrongValue
from ... import checks
from ...core import ffi, lib
from ...rotations import COMPONENTS
from ..base import Card, card_of, text

if TYPE_CHECKING:
    from typing_extensions import TypeVar

    Scalar = TypeVar("Scalar", default=float)
else:
    from typing import TypeVar

    Scalar = TypeVar("Scalar")      # a float, or a node of a graph

Component = TypeVar("Component")
Triple = tuple[Component, Component, Component]
ZERO: Any = 0.0
MAX_READS = lib.ZD_MAX_READS    # components that a formula reads, at most
FORCE_KINDS = {"spring": lib.ZD_FORCE_SPRING, "constant": lib.ZD_FORCE_CONSTANT, "law": lib.ZD_FORCE_LAW,
               "separation": lib.ZD_FORCE_SEPARATION}
GROUP_KINDS = {"two-sided": lib.ZD_TWO_SIDED, "absent": lib.ZD_TWO_SIDED,
               "one-sided": lib.ZD_ONE_SIDED, "friction": lib.ZD_FRICTION, "one-way": lib.ZD_ONE_WAY}
OUTPUT_KINDS = {
    "values": lib.ZD_VALUES, "rates": lib.ZD_RATES, "accelerations": lib.ZD_ACCELERATIONS, "joint force": lib.ZD_JOINT_FORCE,
    "joint torque": lib.ZD_JOINT_TORQUE, "joint tension": lib.ZD_JOINT_TENSION, "force value": lib.ZD_FORCE_VALUE,
    "force power": lib.ZD_FORCE_POWER, "drive": lib.ZD_DRIVE_VALUE, "drive power": lib.ZD_DRIVE_POWER,
    "force sum": lib.ZD_FORCE_SUM, "torque sum": lib.ZD_TORQUE_SUM, "formula": lib.ZD_FORMULA,
    "sum": lib.ZD_SUM, "sum of rates": lib.ZD_SUM_OF_RATES, "sum of accelerations": lib.ZD_SUM_OF_ACCELERATIONS,
    "angular momentum": lib.ZD_ANGULAR_MOMENTUM, "inertia torque": lib.ZD_INERTIA_TORQUE}


def three(components: Iterable[Component]) -> Triple[Component]:
    """Components of a vector, or rows of a frame, of which there must be three."""
    x, y, z = components
    return x, y, z


class ElementQuantity(NamedTuple):
    """A marker quantity of a kind of force element; in space with the indices of the directions of both bodies' frames."""

    kind: str
    zero: str | None            # "along", "across", "angle", "length": the value as drawn is subtracted; None: nothing is
    of_first: int = 0
    of_second: int = 0


class ElementKind(NamedTuple):
    """A kind of force element; see `zd_plane_element_kind` and `zd_space_element_kind`."""

    number: int
    card: Card
    quantities: tuple[ElementQuantity, ...]
    is_spring: bool
    axes: int                   # 0; 1: the user gives an axis; 3: an axis and a normal are optional
    at_joint: bool
    measure: str | None
    sign: int


class Relation(NamedTuple, Generic[Scalar]):
    """A `zd_relation`: sum of coefficients times marker quantities - constant - slope t = 0, or a user function."""

    quantities: Sequence[int]
    coefficients: Sequence[Scalar] = ()     # without a law
    constant: Scalar = ZERO
    slope: Scalar = ZERO
    nonholonomic: bool = False
    law: int = -1
    joint: int = -1             # to whose force and torque it contributes as its drive


class GeneralizedForce(NamedTuple, Generic[Scalar]):
    """A `zd_generalized_force`; `kind` is a key of FORCE_KINDS."""

    kind: str
    quantity: int
    stiffness: Scalar = ZERO
    damping: Scalar = ZERO
    value: Scalar = ZERO
    law: int = -1
    inputs: Sequence[int] = ()  # marker quantities that the law depends on
    joint: int = -1             # to whose force and torque it contributes
    reads: Sequence[str] = ()   # reactions that the law takes after these
    what: str = ""              # name of the law in messages, such as "torque of motor 'drive'"
    relation: int = -1          # between whose teeth it acts


class OutputSpec(NamedTuple):
    """A `zd_output_spec`: a measure by its name; `kind` is a key of OUTPUT_KINDS."""

    name: str
    unit: str
    kind: str
    first: int                  # index of the first marker quantity, the joint, generalized force, relation or user function
    size: int = 1               # number of marker quantities, or of generalized forces in a sum
    scale: float = 1.0
    term: int = 0               # of drives: along which of the relation's marker quantities
    reads: Sequence[str] = ()   # scalar measures and components that a formula reads
    terms: Sequence[int] = ()   # marker quantities of a sum, with their coefficients; -1: of the value 1
    coefficients: Sequence[Any] = ()

    def components(self, dimension: int) -> int:
        """Number of components in the plane or in space."""
        if self.kind in ("values", "rates", "accelerations"):
            return self.size
        if self.kind in ("joint force", "force sum") or self.kind.startswith("sum"):
            return dimension
        return 2 * dimension - 3 if self.kind.endswith(("torque", "torque sum", "momentum")) else 1


class Group(NamedTuple):
    """A `zd_element_group`: constraints that are switched together; `kind` is a key of GROUP_KINDS."""

    name: str
    owner: str                  # "joint" or "relation"
    number: int
    component: int
    rows: int
    kind: str
    sign: int = 1
    is_active: bool = False
    normal: int = 0             # 1 + index of the group of one side that bounds the friction
    loads: tuple[float, ...] = ()       # factors of the multipliers of first rows of the joint `load`, which bound it otherwise
    load: int = 0
    at_ends: bool = False       # True: by |F + M| + |F - M| of their halves, not by their norm
    scale: float = 0.0          # unit of the value, 1 of an angle; 0: the characteristic length
    value: float = 0.0
    restitution: float = 0.0
    friction: tuple[float, float] = (0.0, 0.0)
    range: int = 0              # 1 + relation of the coordinate along a bounded shape; 0: it is unbounded
    opposite: int = 0           # 1 + index of the group of its opposite side; 0: none
    limits: tuple[float, float] = (0.0, 0.0)    # of that coordinate


def _written_groups(tables: Any) -> tuple[Any, Any]:
    """A `zd_element_group *`, and what must live as long as it."""
    names = [ffi.new("char[]", group.name.encode()) for group in tables.groups]
    return ffi.new("zd_element_group[]", [
        (name, lib.ZD_OF_JOINT if group.owner == "joint" else lib.ZD_OF_RELATION, group.number, group.component,
         group.rows, GROUP_KINDS[group.kind], group.sign, group.is_active, group.normal, group.load, 0, len(group.loads),
         (*group.loads, 0.0, 0.0, 0.0, 0.0)[:4], group.at_ends, group.scale, group.value, group.restitution, group.friction,
         group.range, group.opposite, *group.limits)
        for name, group in zip(names, tables.groups, strict=True)]), names


def component_places(measures: Iterable[OutputSpec], dimension: int) -> dict[str, tuple[int, int]]:
    """Index and component of each scalar measure, and of each component of a vector, by name."""
    found: dict[str, tuple[int, int]] = {}
    for i, each in enumerate(measures):
        axes = COMPONENTS.get(each.components(dimension))
        parts = [f"{each.name}.{axis}" for axis in axes] if axes else [each.name]
        found |= {name: (i, component) for component, name in enumerate(parts)}
    return found


class Row(NamedTuple):
    """Origin of a constraint: a joint (component: index among its constraints), or a relation."""

    owner: str                  # "joint" or "relation"
    number: int
    component: int


def rows_of(rows: Any, m: int) -> tuple[Row, ...]:
    """Origin of each constraint, from a `zd_constraint_owner *`."""
    return tuple(Row("joint" if rows[i].owner == lib.ZD_OF_JOINT else "relation", rows[i].index, rows[i].component)
                 for i in range(m))


def law_sizes(tables: Any) -> dict[int, tuple[int, int]]:
    """Number of marker quantities that each user function takes, and number of values that it returns, by its index."""
    sizes = {force.law: (len(force.inputs) + len(force.reads), 1) for force in tables.forces if force.law >= 0}
    sizes |= {each.first: (len(each.reads), 1) for each in tables.measures if each.kind == "formula"}
    return sizes | {row.law: (len(row.quantities), len(row.quantities) + 3) for row in tables.relations if row.law >= 0}


def _reading(tables: Any) -> tuple[Any, Any]:
    """A `zd_reading`, NULL where no user function reads reactions, and what must live as long as it."""
    forces = sorted((force for force in tables.forces if force.law >= 0), key=lambda force: force.law)
    if not any(force.reads for force in forces):
        return ffi.NULL, ()
    known = list(tables.reactions)
    pairs = [(force.law, known.index(name)) for force in forces for name in force.reads if name in known]
    texts = {force.law: ffi.new("char[]", force.what.encode()) for force in forces}
    functions = 1 + max(law_sizes(tables))
    names = ffi.new("const char *[]", [texts.get(i, ffi.NULL) for i in range(functions)])
    reactions, reads = ffi.new("zd_read_reaction[]", list(tables.reactions.values())), ffi.new("zd_read[]", pairs)
    reading = ffi.new("zd_reading *", {"functions": functions, "count": len(known), "reads": len(pairs), "reaction": reactions,
                                       "read": reads, "name": names})
    return reading, (reading, reactions, reads, names, texts)


def _place(measure: str, read: str, places: dict[str, tuple[int, int]]) -> tuple[int, float]:
    if read not in places:
        raise WrongValue(f"measure {measure!r} must depend on scalar measures, and {read!r} is not one; "
                         f"{checks.closest(read, places)}", "wrong-measure")
    return places[read]


def written_elements(tables: Any, has_laws: bool, laws_know_time: bool) -> tuple[dict[str, Any], Any]:
    """Fields of a `zd_elements`, and the words that must live as long as the objects made from it."""
    terms: list[tuple[int, float]] = []
    relations, forces = [], []
    for row in tables.relations:
        relations.append((len(terms), len(row.quantities), row.nonholonomic, row.law, row.constant, row.slope, row.joint))
        terms += zip(row.quantities, row.coefficients or [1.0] * len(row.quantities), strict=True)
    for force in tables.forces:
        forces.append((FORCE_KINDS[force.kind], force.quantity, force.stiffness, force.damping, force.value, force.law,
                       len(terms) if force.relation < 0 else force.relation, len(force.inputs), force.joint))
        terms += ((quantity, 1.0) for quantity in force.inputs)
    units = {unit: ffi.new("char[]", unit.encode()) for unit in {row.unit for row in tables.measures}}
    names = [ffi.new("char[]", row.name.encode()) for row in tables.measures]
    measures, places = [], component_places(tables.measures if any(each.reads for each in tables.measures) else (),
                                            len(tables.gravity))
    for name, each in zip(names, tables.measures, strict=True):
        of_terms = len(each.reads) or len(each.terms)
        reads = (of_terms, each.scale, len(terms)) if of_terms or each.kind == "formula" else each[4:7]
        measures.append((name, units[each.unit], OUTPUT_KINDS[each.kind], each.first, *reads))
        terms += (_place(each.name, read, places) for read in each.reads)
        terms += zip(each.terms, each.coefficients, strict=True)
    reading, kept = _reading(tables)
    groups, of_groups = _written_groups(tables)
    elements = {
        "reading": reading, "terms": len(terms), "relations": len(relations), "forces": len(forces), "measures": len(measures),
        "term": ffi.new("zd_quantity_term[]", terms), "relation": ffi.new("zd_relation[]", relations),
        "force": ffi.new("zd_generalized_force[]", forces), "measure": ffi.new("zd_output_spec[]", measures),
        "law": lib.zd_law_in_python if has_laws else ffi.NULL, "length": tables.length,
        "laws_know_time": has_laws and laws_know_time, "groups": len(groups), "group": groups}
    return elements, (names, units, kept, groups, of_groups)


def element_kinds(count: int, kind_of: Any, quantities: Any) -> dict[str, ElementKind]:
    """A table of force elements by name; `quantities` reads those of an entry."""
    return {kind.card.name: kind for kind in (
        ElementKind(number, card_of(c.card), quantities(c), bool(c.is_spring), c.axes, bool(c.at_joint),
                    text(c.measure) if c.measure else None, c.sign) for number in range(count) for c in [kind_of(number)])}
