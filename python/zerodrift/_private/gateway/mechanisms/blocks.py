"""Blocks: a mechanism's tables as words of eight bytes, and the core's reader of them; see csrc/block/block.h."""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ....errors import WrongValue
from ...core import ffi, lib
from ..base import MESSAGE_SIZE, cards, doubles, error_of, text
from ..systems import CoreSystem
from . import plane, space

SECTIONS = ("gravity", "bodies", "joints", "quantities", "terms", "relations", "forces", "measures", "groups", "laws",
            "instructions", "results", "numbers", "splines", "knots", "start", "outputs", "inputs", "settings", "methods",
            "names", "parameters", "effects", "products", "events", "actions", "texts")
VERSION = lib.ZD_BLOCK_VERSION
# by the names of operations in `symbolics.graph.lowering`, and of functions
OPERATIONS = {"+": lib.ZD_CODE_PLUS, "-": lib.ZD_CODE_MINUS, "*": lib.ZD_CODE_TIMES, "/": lib.ZD_CODE_OVER,
              "negative": lib.ZD_CODE_NEGATIVE, "root": lib.ZD_CODE_ROOT, "power": lib.ZD_CODE_POWER, "<": lib.ZD_CODE_LESS,
              "<=": lib.ZD_CODE_LESS_EQUAL, ">": lib.ZD_CODE_GREATER, ">=": lib.ZD_CODE_GREATER_EQUAL, "==": lib.ZD_CODE_EQUAL,
              "!=": lib.ZD_CODE_UNEQUAL, "and": lib.ZD_CODE_AND, "or": lib.ZD_CODE_OR, "not": lib.ZD_CODE_NOT,
              "choose": lib.ZD_CODE_CHOOSE}
FUNCTIONS = {name: getattr(lib, f"ZD_CODE_{code or name.upper()}") for name, code in {
    "Pow": "POWER", "zd_spline_at": "SPLINE", "sin": "", "cos": "", "tan": "", "asin": "", "acos": "", "atan": "", "atan2": "",
    "sinh": "", "cosh": "", "tanh": "", "asinh": "", "acosh": "", "atanh": "", "exp": "", "log": "", "Abs": "ABS",
    "floor": "", "ceiling": "", "erf": "", "erfc": "", "expm1": "", "hypot": "", "log1p": "", "log2": "", "log10": "",
    "gamma": "", "loggamma": "", "fmod": ""}.items()}
TABLES = {"formulations": lib.ZD_FORMULATIONS, "integrators": lib.ZD_INTEGRATORS, "corrections": lib.ZD_CORRECTIONS}
INPUTS = {"force": lib.ZD_INPUT_FORCE, "speed": lib.ZD_INPUT_SPEED}


class Texts:
    """Texts of a block, each once."""

    def __init__(self) -> None:
        self._offsets: dict[str, int] = {}
        self._bytes = bytearray()

    def offset(self, word: str) -> float:
        """Place of a text, added at first use."""
        if word not in self._offsets:
            self._offsets[word] = len(self._bytes)
            self._bytes += word.encode() + b"\0"
        return float(self._offsets[word])

    def words(self) -> np.ndarray:
        """All texts as words of eight bytes, the last one filled with zero bytes."""
        return np.frombuffer(bytes(self._bytes) + b"\0" * (-len(self._bytes) % 8), "<f8")


def tables(written: plane.Tables | space.Tables, texts: Texts) -> dict[str, list[float]]:
    """Sections with the tables of a mechanism: the members of the core's structures in their order."""
    core = space.SpaceCore if isinstance(written, space.Tables) else plane.PlaneCore
    packed, _words = core.written_tables(written)
    elements = packed["elements"]
    arrays = {"bodies": packed["body"], "joints": packed["joint"], "quantities": packed["quantity"], "terms": elements["term"],
              "relations": elements["relation"], "forces": elements["force"], "measures": elements["measure"],
              "groups": elements["group"]}
    found = {name: [number for entry in array for number in _numbers(entry, texts)] for name, array in arrays.items()}
    return {"gravity": [*(float(each) for each in packed["gravity"]), elements["length"]], **found}


def _numbers(value: Any, texts: Texts) -> list[float]:
    """Numbers of a structure, an array, a text or a number."""
    if not isinstance(value, ffi.CData):
        return [float(value)]
    kind = ffi.typeof(value)
    if kind.kind == "struct":
        return [number for name, _ in kind.fields for number in _numbers(getattr(value, name), texts)]
    if kind.kind == "array":
        return [number for each in value for number in _numbers(each, texts)]
    return [texts.offset(text(value))]


def methods(core_settings: Any, texts: Texts) -> list[float]:
    """Section with the methods of a run, from its settings, a `zd_settings`."""
    chosen = [("formulations", core_settings.formulation, core_settings.of_formulation),
              ("integrators", core_settings.integrator, core_settings.of_integrator)]
    chosen += [("corrections", row, core_settings.correction[row]) for row in range(len(cards("corrections")))
               if core_settings.correction[row].given]
    found: list[float] = []
    for table, row, given in chosen:
        card = lib.zd_entry_card(TABLES[table], row)
        given = given if given.given else lib.zd_initial(card)
        found += [TABLES[table], texts.offset(text(card.name)), *given.value]
    return found


def method_names(core_settings: Any) -> dict[str, list[str]]:
    """Names of the formulation, the integrator and the corrections of settings, by table."""
    rows = {"formulations": [core_settings.formulation], "integrators": [core_settings.integrator],
            "corrections": [row for row in range(len(cards("corrections"))) if core_settings.correction[row].given]}
    return {table: [text(lib.zd_entry_card(TABLES[table], row).name) for row in found] for table, found in rows.items()}


def settings(core_settings: Any) -> list[float]:
    """Section with the steps of a run, from its settings."""
    names = ("t0", "step", "rtol", "atol", "first_step", "max_step", "max_move", "max_steps", "on_singular")
    return [float(getattr(core_settings, name)) for name in names]


WIDTHS = {"laws": 7, "instructions": 4, "splines": 2, "knots": 5, "inputs": 5, "settings": 9, "methods": 2 + lib.ZD_ROW_VALUES,
          "parameters": 5, "effects": 3, "products": 7, "events": 6, "actions": 3}


def assembled(dimension: int, sections: Mapping[str, Sequence[float]], counts: Mapping[str, int], texts: Texts) -> bytes:
    """Bytes of a block (csrc/block/block.h): header, then the sections, by name.

    `counts` has the number of entries of each section whose width depends on the dimension; others are counted by `WIDTHS`.
    """
    parts = [np.asarray(sections.get(name, ()), dtype="<f8") for name in SECTIONS[:-1]] + [texts.words()]
    entries = [counts.get(name, len(part) // WIDTHS.get(name, 1)) for name, part in zip(SECTIONS, parts, strict=True)]
    size = 4 + len(SECTIONS) + sum(len(part) for part in parts)
    header = b"zdblock\0" + struct.pack(f"<{3 + len(SECTIONS)}d", VERSION, size, dimension, *entries)
    return header + b"".join(part.tobytes() for part in parts)


def of_joints(written: plane.Tables | space.Tables, names: Sequence[str]) -> bytes:
    """Block of bodies and joints alone; `names` are theirs, in this order."""
    texts = Texts()
    sections = tables(written._replace(quantities=[], relations=[], forces=[], measures=[], groups=[]), texts)
    counts = {"bodies": len(written.bodies), "joints": len(written.joints)}
    dimension = 3 if isinstance(written, space.Tables) else 2
    return assembled(dimension, sections | {"names": [texts.offset(name) for name in names]}, counts, texts)


class BlockCore(CoreSystem):
    """The core's system of a block.

    Raises
    ------
    ValueError
        If the block is not valid, with the core's sentence.
    """

    def __init__(self, data: bytes) -> None:
        message = ffi.new("char[]", MESSAGE_SIZE)
        made = lib.zd_block_create(ffi.from_buffer(data), len(data), message, MESSAGE_SIZE)
        if not made:
            raise WrongValue(text(message))
        self._block = ffi.gc(made, lib.zd_block_free)
        super().__init__(lib.zd_block_system(self._block), (self._block,))

    @property
    def start(self) -> tuple[np.ndarray, np.ndarray] | None:
        """Initial p (nq,) and v (nv,), or None."""
        words = lib.zd_block_start(self._block)
        if not words:
            return None
        numbers = np.array(ffi.unpack(words, self.nq + self.nv))
        return numbers[:self.nq], numbers[self.nq:]

    @property
    def settings(self) -> Any:
        """Settings of a run, a `zd_settings`; t1 is the caller's."""
        made, message = ffi.new("zd_settings *"), ffi.new("char[]", MESSAGE_SIZE)
        status = lib.zd_block_settings(self._block, made, message, MESSAGE_SIZE)
        if status:
            raise error_of(status, text(message))
        return made

    @property
    def constraint_names(self) -> list[str]:
        """Names of the rows of C."""
        to = ffi.new("char[]", MESSAGE_SIZE)

        def name(row: int) -> str:
            self.c.name_constraint(self.c.names, row, to, MESSAGE_SIZE)
            return text(to)

        return [name(row) for row in range(self.m)]

    @property
    def inputs(self) -> dict[str, float]:
        """Inputs with their values."""
        return {text(lib.zd_block_input_name(self._block, i)): lib.zd_block_input(self._block, i)
                for i in range(lib.zd_block_inputs(self._block))}

    def input_unit(self, name: str) -> str:
        """Unit of an input."""
        return text(lib.zd_block_input_unit(self._block, list(self.inputs).index(name)))

    def set_input(self, name: str, value: float) -> None:
        """Sets an input from the next advance on."""
        if lib.zd_block_set_input(self._block, list(self.inputs).index(name), value):
            raise WrongValue(f"input {name!r} must be a finite number, not {value!r}", "not-finite")

    def set_parameter(self, index: int, value: float) -> bool:
        """Changes the words that depend on a parameter; False: the value is outside its range."""
        return not lib.zd_block_set_parameter(self._block, index, value)

    def gaps_in_words(self, p: np.ndarray, *, are_smallest: bool) -> str:
        """Sentence on the gaps of joints at p (nq,), or on the smallest ones from there on, as pages show it."""
        size = 200 + 2 * len(self.words)        # of all names and the sentence around them
        message = ffi.new("char[]", size)
        at = doubles(np.ascontiguousarray(p), len(p))
        status = lib.zd_block_explain_gaps(self._block, at, are_smallest, message, size)
        if status:
            raise error_of(status, text(message))
        return text(message)

    @property
    def words(self) -> bytes:
        """The block with its parameters as set."""
        size = ffi.new("size_t *")
        words = lib.zd_block_words(self._block, size)
        return bytes(ffi.buffer(words, size[0]))
