"""A mechanism written out: its equations as compiled code instead of tables that are interpreted.

The numbers of the core's plan stay numbers, which the compiled functions are handed, all but zeros and ones. Whatever else the
equations depend on is in the plan with nodes in place of its numbers: where that is the same, so is the code.
"""

from __future__ import annotations

import ctypes
import warnings
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np

from .. import _gateway
from .._gateway.mechanisms import MechanismCore
from .._gateway.plans import plan_of
from ..errors import NoCompilerWarning
from ..symbolics import cache as kept
from ..symbolics import compilers, compiling
from ..symbolics.direct_functions import DIRECT, DirectFunctions
from ..symbolics.plain import Plain
from . import nodes
from .law_rows import Laws

DATA = "*(const double *const *)data"       # the doubles that functions are handed: csrc/mechanisms/mechanism.h
OF_DIRECT = f"(ZD_LANES == 1 ? {DATA} : (const double *)data)"      # in lanes it is these alone that stand in groups


@dataclass(frozen=True)
class Code:
    """What is the same whatever the numbers are. Everything in it can be written as JSON."""

    provides: list[str]
    timeless: bool
    constants: int
    scratch: int
    c_source: str
    program: dict[str, Any] | str       # as of symbolics/system.py


class Written:
    """The compiled functions of a mechanism, and the numbers that they are handed.

    Parameters
    ----------
    core : MechanismCore
        The interpreted system.
    laws : Laws
    parameters : dict of str to float
        The mechanism's own.
    name : str
        For a warning.

    Attributes
    ----------
    core : MechanismCore
        The compiled system; where there is no compiler, the interpreted one.
    is_compiled : bool
        Whether there is a compiler.
    key : str
        The name of the code: two mechanisms of the same differ in numbers alone.
    """

    def __init__(self, core: MechanismCore, laws: Laws, parameters: dict[str, float], name: str) -> None:
        self._interpreted, self._sizes = core, (core.nq, core.nv, core.mh, core.mn)
        reader = _reader(laws)
        number = nodes.Numbering(reader.graph)
        plan = nodes.with_nodes(plan_of(core), number)
        own = {key: number.new(value) for key, value in parameters.items()}
        self._values = np.array(number.values)
        self.key = kept.digest_of(_writing_code(type(reader)), repr(plan), repr(own), self._sizes, core.packing is None,
                                  _described(laws.rows))
        self._code = _kept_code(self.key) or self._derive(nodes.Equations(plan, reader, self._sizes, laws, own))
        self._library = compiling.library(self._code.c_source)
        self.is_compiled = self._library is not None
        if not self.is_compiled:
            warnings.warn(f"there is no C compiler (looked for {compilers.looked_for()}): the tables of {name} are interpreted",
                          NoCompilerWarning, stacklevel=6)
        self.core = self._compiled(None) if self.is_compiled else core

    def _derive(self, equations: nodes.Equations) -> Code:
        """The code of the equations, which is kept."""
        from ..symbolics import direct, large
        from ..symbolics.blocks import Blocks
        from ..symbolics.derivation import Derivation
        from ..symbolics.lowering import Lowering

        terms, packing = Derivation(equations.graph, equations.given()).terms(), self._interpreted.packing
        lowering = Lowering(equations.graph)
        outputs = {name: [lowering.lower(node) for node in nodes] for name, nodes in terms.items()}
        packed = {name: [outputs[name][place] for place in packing.places(name)] for name in ("M", "C")
                  if packing and name in outputs}
        c_source, constants, scratch = large.source(Blocks(lowering, outputs | packed), ["A mechanism."], len(self._values), DATA)
        knows_time = any(operation.code == "leaf" and operation.arguments[0] == "t" for operation in lowering.operations)
        code = Code(list(terms), not knows_time, constants, scratch, c_source, direct.as_json(lowering, outputs))
        kept.write(self.key, asdict(code))
        _codes[self.key] = code
        return code

    def _compiled(self, direct: DirectFunctions | None, vector: str = "baseline") -> MechanismCore:
        """The system with compiled functions."""
        numbers = np.concatenate([self._values, np.zeros(self._code.constants + (direct.constants if direct else 0) + 1)])
        libraries, address = [self._library], None
        self._library.zd_symbolic_constants(ctypes.c_void_p(numbers.ctypes.data))
        if direct:
            libraries.append(direct.library(vector))
            libraries[1].zd_symbolic_direct_constants(ctypes.c_void_p(numbers.ctypes.data))
            address = _gateway.address_of(libraries[1], DIRECT)
        numbers.flags.writeable = False
        evaluate, code = _gateway.address_of(self._library, "zd_symbolic_evaluate"), self._code
        return self._interpreted.written(evaluate, numbers, code.provides, timeless=code.timeless, scratch=code.scratch,
                                         keep=libraries, direct=address)

    def direct_functions(self, p0: np.ndarray | None, is_length: np.ndarray) -> DirectFunctions:
        """The direct functions; their orders of elimination are those for these numbers and the start p0."""
        return DirectFunctions(self._code.program, self._sizes, self._values, p0, is_length,
                               len(self._values) + self._code.constants, OF_DIRECT)

    def with_direct(self, direct: DirectFunctions, vector: str) -> MechanismCore:
        """The same with direct functions for a vector unit, where there are any."""
        return self._compiled(direct, vector) if self.is_compiled and direct.library(vector) else self.core


def _reader(laws: Laws) -> Any:
    """What the graph is in: with SymPy where a law is an expression."""
    if not any(row.law.has_expression for row in laws.rows):
        return Plain()
    from ..symbolics.reading import Reader

    return Reader()


# ---- the key ----

_codes: dict[str, Code] = {}


def _kept_code(key: str) -> Code | None:
    """What was derived before from the same plan."""
    if key not in _codes and (found := kept.read(key, dict)) is not None:
        _codes[key] = Code(**found)
    return _codes.get(key)


@cache
def _writing_code(reader: type) -> str:
    """The fingerprint of the code that writes: of SymPy's version, too, where it is taken."""
    version = "" if reader is Plain else metadata.version("sympy")
    here = Path(__file__).parent
    files = [*sorted((here.parent / "symbolics").glob("*.py")), *sorted(here.glob("*.py"))]
    return kept.digest_of(version, [file.read_text(encoding="utf-8") for file in files])


def _described(what: Any) -> Any:
    """Laws as JSON: all that their nodes depend on."""
    if hasattr(what, "free_symbols"):
        from sympy import srepr

        return srepr(what)
    if isinstance(what, np.ndarray):
        return what.tolist()
    if isinstance(what, Mapping):
        return [[key, _described(value)] for key, value in what.items() if key not in ("parameters", "what", "_call")]
    if isinstance(what, list | tuple):
        return [_described(each) for each in what]
    return [type(what).__name__, _described(vars(what))] if hasattr(what, "__dict__") else repr(what)
