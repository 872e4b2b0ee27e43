"""Optional members of a system besides its terms are refused where malformed, from any source."""

import re

import numpy as np
import pytest

import zerodrift as zd
from native_systems import GIVEN, PENDULUM, compile_text, needs_compiler
from support import handed, refused
from zerodrift._private import gateway
from zerodrift._private.core import ffi, lib

ANY = 1     # the address of some function, which is not called here


class Made:
    """A `zd_system` of three bodies with 2, 1 and 3 velocities, two holonomic groups of rows and a nonholonomic one."""

    def __init__(self, **changed):
        self.kept = []
        self.c = ffi.new("zd_system *", {"nq": 6, "nv": 6, "mh": 3, "mn": 1})
        self.c.provides = lib.ZD_M | lib.ZD_PHI | lib.ZD_C | lib.ZD_XI | changed.pop("provides", 0)
        self.c.evaluate = ffi.cast("zd_evaluate *", ANY)
        structure = {"blocks": 3, "coordinates": [2, 1, 3], "velocities": [2, 1, 3], "mass": [0, 3, 1], "groups": 3,
                     "rows": [1, 2, 1], "first": [0, 1, 3, 6], "block": [0, 0, 2, 0, 1, 2]} | changed.pop("structure", {})
        self.c.structure = self.of("zd_structure", {
            key: value if isinstance(value, int) else ffi.NULL if value is None else self.array("int", value)
            for key, value in structure.items()})
        for name, value in changed.items():
            setattr(self.c, name, value(self) if callable(value) else value)

    def keep(self, made):
        self.kept.append(made)
        return made

    def of(self, kind, content):
        return self.keep(ffi.new(f"{kind} *", content))

    def array(self, kind, content):
        return self.keep(ffi.new(f"{kind}[]", content))

    def text(self, characters):
        return self.array("char", characters.encode())

    def function(self, kind, member):
        """Some function of the type that a member of a structure has."""
        types = dict(ffi.typeof(kind).fields)
        return ffi.cast(types[member].type, ANY)

    @property
    def refusal(self):
        message = ffi.new("char[]", 512)
        status = lib.zd_check_system(self.c, message, 512)
        assert status == (0 if message[0] == b"\0" else lib.ZD_BAD_ARGUMENT)
        return ffi.string(message).decode()


def listed(member, *content):
    return lambda made: made.array(member, list(content))


ELIMINATION = {"solve": [0, 1, 1, 1], "row": [3, 0, 1, 2], "column": [5, 0, 1, 2]}


def closed_form(*sets, **changed):
    """Each with four orders, which eliminate one row and then three for four of six velocities."""
    def make(made):
        tables = ELIMINATION | changed
        order = {name: ffi.NULL if values is None else made.array("int", values) for name, values in tables.items()
                 if name in ("solve", "row", "column")}
        functions = {name: made.function("zd_elimination", name) for name in ("accelerate", "correct") if name not in changed}
        order |= {"solves": changed.get("solves", 2)} | functions
        orders = made.array("zd_elimination", [order] * 4)
        return made.array("zd_closed_form", [{"orders": 1, "lanes": 1, "order": orders} | each for each in sets])
    return make


def embedding(function):
    """A set of one order, for formulations in independent velocities, that brings this function besides its correction."""
    def make(made):
        order = {"solves": 2} | {name: made.array("int", values) for name, values in ELIMINATION.items()}
        order |= {name: made.function("zd_elimination", name) for name in ("correct", function)}
        return made.array("zd_closed_form", [{"lanes": 1, "embeddings": 1, "embedding": made.array("zd_elimination", [order])}])
    return make


def measures(*measures, **changed):
    def make(made):
        listed = [{"name": made.text("x"), "unit": made.text("m"), "size": 1} | each for each in measures]
        content = {"count": len(listed), "measure": made.array("zd_measure", listed),
                   "evaluate": made.function("zd_measures", "evaluate")}
        return made.of("zd_measures", content | changed)
    return make


def inputs(*initial, name="torque", kind=lib.ZD_EFFORT):
    return lambda made: made.array("zd_input", [
        {"name": made.text(name), "unit": made.text("N m"), "kind": kind, "initial": value} for value in initial])


def groups(*rows, name="lock", **changed):
    return lambda made: made.array("zd_group", [
        {"name": made.text(name), "first": first, "rows": count, "is_active": 1, "kind": lib.ZD_TWO_SIDED} | changed
        for first, count in rows])


def brought(kind, member, **changed):
    return lambda made: made.of(kind, {member: made.function(kind, member)} | changed)


def quaternions(*first):
    return {"provides": lib.ZD_A, "quaternions": len(first), "quaternion": listed("int", *first)}


FITTING = {
    "structure": {},
    "structure without masses": {"structure": {"mass": None}},
    "structure with a kinematic matrix": {"provides": lib.ZD_A, "nq": 7, "structure": {"coordinates": [2, 2, 3]}},
    "no constraints": {"mh": 0, "mn": 0, "structure": {"groups": 0}},
    "operations": {"operations": lambda made: made.of("zd_operations", {})},
    "closed_form": {"closed_forms": 3, "closed_form": closed_form({"lanes": 4}, {"orders": 4}, {"unit": 2})},
    "direct, embedding": {"closed_forms": 1, "closed_form": embedding("embed")},
    "series": {"series": brought("zd_series", "evaluate")},
    "jacobian": {"jacobian": brought("zd_jacobian", "evaluate", scratch=5)},
    "measures": {"measures": measures({}, {"size": 3, "depends": 2})},
    "residuals": {"residuals": brought("zd_residuals", "evaluate", scratch=5)},
    "inputs": {"inputs": 2, "input": inputs(0.0, 3.0)},
    "groups": {"groups": 2, "group": groups((0, 1), (1, 2))},
    "quaternions": quaternions(2),
}


@pytest.mark.parametrize("what", FITTING)
def test_what_fits_is_taken(what):
    assert Made(**FITTING[what]).refusal == ""


def in_structure(**changed):
    return {"structure": changed}


@pytest.mark.parametrize(("changed", "sentence"), [
    (in_structure(blocks=0), "structure: there must be 1 to 6 blocks"),
    (in_structure(blocks=7), "structure: there must be 1 to 6 blocks"),
    (in_structure(velocities=None), "structure: there must be 1 to 6 blocks"),
    (in_structure(velocities=[2, 0, 4]), "block 1 must have at least one coordinate and one velocity, not 1 and 0"),
    (in_structure(coordinates=[2, -1, 5]), "block 1 must have at least one coordinate and one velocity, not -1 and 1"),
    (in_structure(velocities=[2, 1, 2**31 - 1]), "block 2 must have .*, not 3 and 2147483647"),
    (in_structure(velocities=[2, 2, 2]), "block 1 .* must provide a kinematic matrix"),
    (in_structure(velocities=[2, 1, 2], coordinates=[2, 1, 2]),
     "the blocks must have the 6 coordinates and 6 velocities of the system, not 5 and 5"),
    (in_structure(mass=[0, 4, 0]), "the mass of block 1 must be .*, not 4"),
    (in_structure(groups=-1), "at most 4 groups, .*, not -1"),
    (in_structure(groups=5), "at most 4 groups, .*, not 5"),
    (in_structure(rows=None), "each with its rows and the blocks it touches"),
    (in_structure(rows=[0, 3, 1]), "group 0 must have at least one row, and at most the 4 of 4 that remain, not 0"),
    (in_structure(rows=[1, 2, 2]), "group 2 must have at least one row, and at most the 1 of 4 .*, not 2"),
    (in_structure(rows=[1, 3, 1]), "the rows of group 1 must all be holonomic, or all nonholonomic"),
    (in_structure(groups=2), "the groups must have the 4 rows of the system, not 3"),
    (in_structure(first=[1, 2, 3, 6]),
     "group 0 must touch at least one block, the first group from 0 on, not those at 1 to 1 of the list"),
    (in_structure(first=[0, 1, 1, 6]), "group 1 must touch .* not those at 1 to 0"),
    (in_structure(first=[0, 1, 3, 9]), "group 2 must touch .* not those at 3 to 8"),
    (in_structure(block=[3, 0, 2, 0, 1, 2]), "the blocks of group 0 must increase, from 0 to 2 at most; it touches block 3"),
    (in_structure(block=[0, 2, 0, 0, 1, 2]), "the blocks of group 1 must increase, .* touches block 0"),
    ({"provides": lib.ZD_COMPLEMENT | lib.ZD_GAMMA}, "must not provide a complement D of its own"),
    ({"operations": brought("zd_operations", "add_weighted")},
     "operations: subtract_weighted and add_weighted must come together"),
    ({"operations": brought("zd_operations", "subtract_weighted")},
     "operations: subtract_weighted and add_weighted must come together"),
    ({"closed_forms": 1}, "closed_form: there must be at most one set .*, not 1 sets"),
    ({"closed_form": closed_form({})}, "closed_form: there must be at most one set .*, not 0 sets"),
    ({"closed_forms": 13, "closed_form": closed_form(*[{}] * 13)}, "closed_form: there must be .*, not 13 sets"),
    ({"closed_forms": 1, "closed_form": closed_form({"orders": 5})},
     "set 0 must have arrays of up to 4 orders of elimination, .* not of 5 and 0"),
    ({"closed_forms": 1, "closed_form": closed_form({"orders": 0})}, "set 0 must have an order of elimination"),
    ({"closed_forms": 2, "closed_form": closed_form({}, {"lanes": 3})}, "set 1 must have 1, 2, 4 or 8 lanes, not 3"),
    ({"closed_forms": 2, "closed_form": closed_form({}, {})}, "set 1 must be the only one with 1 lanes"),
    ({"closed_forms": 2, "closed_form": closed_form({}, {"unit": 3})}, "the vector unit of set 1 must be from 0 to 2, not 3"),
    ({"closed_forms": 1, "closed_form": closed_form({"order": ffi.NULL})}, "set 0 must have arrays .* not of 1 and 0$"),
    ({"closed_forms": 1, "closed_form": closed_form({"embeddings": 1})}, "set 0 must have arrays .* not of 1 and 1$"),
    ({"closed_forms": 1, "closed_form": closed_form({"embeddings": 5})}, "set 0 must have arrays .* not of 1 and 5$"),
    ({"closed_forms": 1, "closed_form": embedding("accelerate")}, "order 0 of set 0 must eliminate 4 rows"),
    *[({"closed_forms": 1, "closed_form": closed_form({}, **changed)}, "order 0 of set 0 must eliminate 4 rows") for changed in (
        {"accelerate": None}, {"correct": None}, {"row": None}, {"solves": 0}, {"solves": 5}, {"solves": 1},
        {"row": [3, 0, 1, 4]}, {"row": [3, 0, 1, 1]}, {"column": [5, 0, 1, 6]}, {"column": [5, 0, 0, 1]},
        {"solve": [0, 1, 0, 1]}, {"solve": [0, 2, 2, 2]})],
    ({"series": lambda made: made.of("zd_series", {})}, r"series: they must have evaluate\(\)"),
    ({"series": brought("zd_series", "evaluate", scratch=-1)}, "series: .*not -1"),
    ({"jacobian": lambda made: made.of("zd_jacobian", {})}, r"jacobian: it must have evaluate\(\)"),
    ({"jacobian": brought("zd_jacobian", "evaluate", scratch=-1)}, "jacobian: .*not -1"),
    ({"measures": measures({}, evaluate=ffi.NULL)}, "measures: there must be 0 to 1048576, .*, not 1"),
    ({"measures": measures(count=-1)}, "measures: there must be 0 to 1048576, .*, not -1"),
    ({"measures": measures({}, scratch=-1)}, "measures: their scratch must be a size, not -1"),
    ({"measures": measures({"name": ffi.NULL})}, "measure 0 must have a name and a unit"),
    ({"measures": measures({"size": 0})}, "x must have 1 to 8192 components, not 0"),
    ({"measures": measures({"depends": 3})}, "x must depend on positions, velocities or accelerations"),
    ({"residuals": lambda made: made.of("zd_residuals", {})}, r"residuals: they must have evaluate\(\)"),
    ({"magnitudes": lambda made: ffi.cast("void *", 1), "magnitudes_scratch": -1}, "their scratch must be a size, not -1"),
    ({"inputs": 1}, "inputs: there must be 0 to 8192, .*, not 1"),
    ({"inputs": -1}, "inputs: there must be 0 to 8192, .*, not -1"),
    ({"inputs": 1, "input": inputs(0.0, name="")}, "input 0 must have a name"),
    ({"inputs": 1, "input": inputs(0.0, kind=2)}, "torque must be an effort or a speed"),
    ({"inputs": 1, "input": inputs(np.nan)}, "the initial value of torque must be finite"),
    ({"groups": 1025, "group": groups((0, 1))}, "groups: there must be 0 to 1024, .*, not 1025"),
    ({"groups": 1}, "groups: there must be 0 to 1024, .*, not 1"),
    ({"groups": 1, "group": groups((0, 1), name="")}, "group 0 must have a name"),
    ({"groups": 1, "group": groups((2, 3))}, "lock must have rows among the system's 4, .*, not 3 rows from row 2 on"),
    ({"groups": 1, "group": groups((2, 2))}, "lock must have rows of one kind, holonomic or not"),
    ({"groups": 1, "group": groups((0, 1), kind=lib.ZD_ONE_SIDED)}, "lock must have a sign of 1 or -1"),
    ({"groups": 1, "group": groups((0, 1), kind=lib.ZD_ONE_SIDED, sign=1, restitution=2.0)}, "restitution of 'lock' must be"),
    ({"groups": 1, "group": groups((0, 1), kind=lib.ZD_FRICTION, friction=(1, 2))}, "friction of 'lock' must be at least 0"),
    ({"groups": 1, "group": groups((0, 1), kind=lib.ZD_FRICTION, normal=1)}, "the normal of lock must be a one-sided group"),
    ({"groups": 1, "group": groups((0, 1), kind=lib.ZD_FRICTION, loads=2, load=3)}, "the load of lock must be multipliers"),
    ({"quaternions": 1}, "quaternions: there must be 0 to 1, each with its first coordinate, not 1"),
    ({"quaternions": -1}, "quaternions: there must be .*, not -1"),
    ({"quaternions": 2, "quaternion": listed("int", 0, 2)}, "quaternions: there must be 0 to 1, .*, not 2"),
    ({"quaternions": 1, "quaternion": listed("int", 0)}, "quaternions: .*must have a kinematic matrix"),
    (quaternions(3), r"quaternion 0 must be four of the 6 coordinates, .*; it begins at p\[3\]"),
    (quaternions(-1), r"quaternion 0 must be .*; it begins at p\[-1\]"),
    (quaternions(1, 4) | {"nq": 8, "structure": {"coordinates": [2, 2, 4]}},
     r"quaternion 1 must be .*, after those of the previous one; it begins at p\[4\]"),
    (quaternions(1) | {"lengths": listed("int", *[0] * 4, 1, *[0] * 7)},
     r"p\[4\] is in quaternion 0, and must not be declared a length"),
    ({"followers": 1}, r"followers: there must be 0 to \d+, after the other coordinates, with follow\(\), not 1"),
    (quaternions(1) | {"nq": 7, "followers": 1}, r"followers: there must be 0 to 6, .*, not 1"),
    (quaternions(1) | {"nq": 7, "followers": 1, "follow": lambda made: made.function("zd_system", "follow")},
     "followers: their rates must be in A, or, for a system with structure, in times_A"),
], ids=lambda value: value if isinstance(value, str) else "")
def test_what_is_malformed_is_refused(changed, sentence):
    refusal = Made(**changed).refusal
    assert re.search(sentence, refusal), refusal


def test_a_run_of_it_is_refused():
    core = zd.systems.pendulum()._core
    core.c.inputs = 1
    for call in (lambda: gateway.Run(core, handed(), np.zeros(2), np.zeros(2)),
                 lambda: gateway.acceleration(core, 0, 0, 0.0, np.zeros(2), np.zeros(2))):
        with pytest.raises(zd.ZerodriftError, match="inputs: there must be"):
            call()


@needs_compiler
def test_a_library_that_describes_what_does_not_fit_is_refused(tmp_path):
    text = PENDULUM.read_text().replace(".evaluate = pendulum,\n    },", ".evaluate = pendulum, .groups = 1,\n    },")
    library = compile_text(text, tmp_path / "malformed.so")
    with refused("compiled-function", r"zd_kind_pendulum of .*malformed\.so: groups: there must be 0 to 1024, .*, not 1"):
        zd.native(library, symbol="pendulum", parameters={})


@needs_compiler
def test_a_library_of_an_earlier_version_must_be_compiled_again(tmp_path):
    text = PENDULUM.read_text().replace("ZD_INTERFACE_VERSION;", "3;")
    library = compile_text(text, tmp_path / "earlier.so")
    with refused("compiled-function", r"earlier\.so is 3, and this core has version 12 of the interface: compile it again"):
        zd.native(library, ["x", "y"], symbol="pendulum", **GIVEN)


INPUTS = """static const zd_input input[] = {{"wind", "N", ZD_EFFORT, 3.0}, {"lift", "N", ZD_EFFORT, 1.0}};
const zd_kind zd_kind_pendulum"""
DRIVEN = PENDULUM.read_text().replace("out->f[0] = 0;", "out->f[0] = out->inputs[0];").replace(
    "out->f[1] = -m * g;", "out->f[1] = -m * g + 2 * out->inputs[1];").replace("const zd_kind zd_kind_pendulum", INPUTS).replace(
    ".evaluate = pendulum,\n    },", ".evaluate = pendulum, .inputs = 2, .input = input,\n    },")


@needs_compiler
def test_inputs_have_their_initial_values(tmp_path):
    """A constant force is the same as weight in its direction: m (x, y)'' = (3, 2 - m g) - C^T lambda."""
    system = zd.native(compile_text(DRIVEN, tmp_path / "driven.so"), symbol="pendulum", parameters={})
    x, y = 0.6, -0.8
    vdot, multipliers = zd.acceleration(system, [x, y], [0.0, 0.0])
    tangent = np.array([-y, x])
    assert vdot == pytest.approx(tangent * (tangent @ [3.0, 2.0 - 9.81]), abs=1e-14)
    assert multipliers == pytest.approx(x * 3.0 + y * (2.0 - 9.81), abs=1e-13)
    assert system.evaluate([x, y], [0.0, 0.0]).f == pytest.approx([3.0, 2.0 - 9.81], abs=1e-15)
