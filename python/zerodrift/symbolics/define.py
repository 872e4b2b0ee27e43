"""`symbolic`: a system from energies, forces and constraints written in SymPy."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

from numpy.typing import ArrayLike

from ..errors import MissingPackage, WrongValue

try:
    import sympy
except ImportError as error:
    raise MissingPackage("symbolic systems need SymPy: pip install 'zerodrift[symbolic]'") from error

from .._private.types import Equations, Expression
from ..systems.one_sided import OneSided, checked, switched
from ..systems.structure import Structure
from .arguments import Definition
from .cache_key import fingerprint
from .compile import cache
from .elimination.steps import Unwritten
from .emit import closed_form, program_writer, splitting
from .graph.blocks import Blocks
from .graph.derivation import Derivation
from .graph.lowering import Lowering
from .graph.pattern import Pattern
from .progress_message import Progress
from .system import Code, SymbolicSystem

_derived: dict[str, Code] = {}


def symbolic(
    coordinates: Sequence[Expression], *, kinetic: Expression | None = None, potential: Expression | float | None = 0,
    force: Equations | None = None, constraints: Equations = (), nonholonomic: Equations = (), speeds: Equations | None = None,
    kinematics: Mapping[Any, Any] | Sequence[Expression] | Expression | None = None,
    parameters: Mapping[Any, float] | None = None, time: sympy.Symbol | None = None, mass: Expression | None = None,
    bias: Sequence[Expression] | Expression | None = None, points: Iterable[Sequence[Expression]] = (),
    quaternions: Sequence[int | str | Expression] = (), units: Sequence[str] | None = None, p0: ArrayLike | None = None,
    v0: ArrayLike | None = None, name: str = "symbolic", progress: bool = True, inputs: Sequence[Expression | str] = (),
    one_sided: Mapping[str, OneSided] | None = None,
) -> SymbolicSystem:
    """System from SymPy expressions: its terms are derived, written as C, compiled and cached.

    Parameters
    ----------
    coordinates : sequence of Symbol or of functions of time
        The coordinates p: symbols, or functions made by `sympy.physics.mechanics.dynamicsymbols`.
    kinetic : Expr
        Kinetic energy in J, in terms of coordinates and velocities: `speeds`, or the derivatives ``q.diff(t)`` of
        coordinates that are functions of time. It may depend on time, and need not be homogeneous in the velocities.
    potential : Expr or None
        V in J; it may depend on time. None: there is none, and there are no energies.
    force : sequence of Expr (nv,) or dict, optional
        Generalized forces that V does not describe, one for each velocity; a dict has them by coordinate or speed.
    constraints : sequence of Expr (mh,) or dict
        Phi of (3), zero on the constraints; a dict gives them names. Instances of `sympy.Eq` are accepted.
    nonholonomic : sequence of Expr (mn,) or dict
        Constraints on velocities, linear in these: C v + Phi_t of (5).
    speeds : sequence of Symbol or functions of time, or dict
        Components of v; left out: the derivatives of the coordinates. A dict gives each in terms of coordinates and their
        derivatives, so that `kinetic` can be written with speeds where there are `kinematics`.
    kinematics : dict, sequence of Expr (nq,) or Matrix (nq, nv), optional
        The derivatives of the coordinates in terms of the speeds, linear: ``pdot = A v`` of (1). Left out: the identity.
    parameters : dict of Symbol or str to float
        Values of all other symbols. They stay symbols: see `with_parameters` of the result.
    time : Symbol, optional
        Left out: the one of dynamicsymbols, ``Symbol("t")``.
    mass, bias : Matrix (nv, nv), sequence of Expr (nv,), optional
        M and d of (2) themselves, instead of `kinetic`.
    points : sequence of (Expr, Expr) or (Expr, Expr, Expr)
        Points of a drawing, joined by lines.
    quaternions : sequence of int, str or Symbol
        As of `zerodrift.System`: where unit quaternions begin in p. They need `kinematics`.
    units : sequence of str
        As of `zerodrift.System`: the unit of each coordinate, and where there are `kinematics` of each velocity, too.
    p0, v0 : array_like (nq,), (nv,), optional
        The start, unless `simulate` is given another.
    name : str
        For tables and plots.
    progress : bool
        If True, report the current stage on stderr when it takes longer than two seconds.
    inputs : sequence of Symbol or str
        Symbols in `force` that a `Run` sets between steps; 0 before, unless `parameters` has other values.
    one_sided : dict of str to OneSided
        Gaps that must not be negative, by name, with restitution and friction.

    Returns
    -------
    SymbolicSystem

    Raises
    ------
    ValueError, TypeError
        If an expression contains an unknown symbol, or a function that C does not have; the message names it.
    CompilationFailed
        If CC cannot be run, the compiler rejects the C source, or its output cannot be loaded.
    ImportError
        Without SymPy, the extra `symbolic`.

    Notes
    -----
    With `kinematics`, the kinetic energy T(p, pdot, t) must be given in terms of the derivatives of coordinates. It is
    differentiated with respect to these, and A projects the result, so nothing symbolic is solved or inverted.

    Jumps, such as those of `Heaviside` or `floor`, have derivative zero.

    Derived terms and compiled libraries are stored in the folder that the environment variable ZERODRIFT_CACHE names, or else the
    user's cache folder. As its content is executed, folder and files must belong to the user or to root, and other users must not
    have write access; otherwise a `CacheWarning` is issued, and the folder is not used. On Windows permissions are not checked:
    there ZERODRIFT_CACHE must name a folder closed to other users, as the user's cache folder is. Administrators may fill a
    folder for all users, as root and readable by all. The compiler is the command in CC, or else cc, gcc or clang, on Windows
    Visual Studio's or MinGW's, or that of the package ziglang. Without a compiler the system is interpreted by the core, with a
    `NoCompilerWarning`. CFLAGS is not read: flags can be part of CC.

    Examples
    --------
    A pendulum of length L in Cartesian coordinates:

    >>> import sympy as sp, zerodrift as zd
    >>> x, y, vx, vy, m, g, L = sp.symbols("x y vx vy m g L")
    >>> pendulum = zd.symbolic(
    ...     [x, y], speeds=[vx, vy],
    ...     kinetic=m * (vx**2 + vy**2) / 2,
    ...     potential=m * g * y,
    ...     constraints=[(x**2 + y**2 - L**2) / 2],
    ...     parameters={m: 1.0, g: 9.81, L: 1.0},
    ...     p0=[1.0, 0.0],
    ... )
    >>> sol = zd.simulate(pendulum, 1.0, step=0.01)
    >>> sol.p[-1].round(5)
    array([-0.98629, -0.16501])
    """
    values, gaps = _with_inputs({} if parameters is None else parameters, inputs), checked(one_sided)
    if gaps:
        constraints = _followed("constraint", constraints, {name: each.gap for name, each in gaps.items()})
        slips = {f"{name}.slip": each.slip for name, each in gaps.items() if each.slip is not None}
        nonholonomic = _followed("nonholonomic", nonholonomic, slips)
    definition = Definition(coordinates, kinetic, potential, force, constraints, nonholonomic, speeds, kinematics,
                            values, time, (mass, bias), points)
    with Progress(name, progress) as say:
        code = _code(definition, say)
        groups = switched(gaps, (*code.coordinates, *code.velocities), *code.sizes[2:])
        return SymbolicSystem(code, definition.values, units, p0, v0, name, say, definition.named(quaternions),
                              inputs=[str(each) for each in inputs], groups=groups)


def _followed(word: str, given: Any, more: Mapping[str, Any]) -> Any:
    """Constraints, and then those of `more`, by name."""
    named = isinstance(given, Mapping)
    rows = [given] if isinstance(given, sympy.Expr | sympy.Equality) else list(given.values() if named else given or ())
    names = list(map(str, given)) if named else [f"{word}{i}" for i in range(len(rows))]
    if twice := {*names} & {*more}:
        raise WrongValue(f"one_sided must have other names than the constraints, and has {min(twice)!r}", "duplicate-name")
    return dict(zip([*names, *more], [*rows, *more.values()], strict=True)) if more else given


def _with_inputs(parameters: Any, inputs: Sequence[Any]) -> Any:
    """Values of parameters and inputs; inputs without a value are 0."""
    if not inputs or not isinstance(parameters, Mapping):
        return parameters
    known = {str(name) for name in parameters}
    return {**parameters, **{each: 0.0 for each in inputs if str(each) not in known}}


def _code(definition: Definition, say: Progress) -> Code:
    """Derived terms of the definition: from memory, from the cache, or derived now."""
    key = fingerprint(definition.expressions)
    code = _derived.get(key or "")
    if code is None and key is not None:
        kept = cache.read(key, dict)
        code = None if kept is None else Code.from_json(kept)
    if code is None:
        code = _derive(definition, say)
        if key is not None:
            cache.write(key, code.as_json())
    if key is not None:
        _derived[key] = code
    return code


def _derive(definition: Definition, say: Progress) -> Code:
    say("deriving")
    reader, given = definition.read()
    derivation = Derivation(reader.graph, given)
    terms = derivation.terms()
    definition.check_linearity(terms)
    say("eliminating common subexpressions")
    lowering = Lowering(reader.graph)
    sizes = given.nq, given.nv, len(given.holonomic), len(given.nonholonomic)
    outputs = {name: [lowering.lower(node) for node in nodes] for name, nodes in terms.items()}
    structure = Pattern(terms, sizes, lambda node: node is reader.graph.zero).structure()
    blocks = Blocks(lowering, _stored(outputs, structure))
    say("writing C")
    c_source, constants, scratch = splitting.source(blocks, definition.heading(), len(definition.values))
    drawing = definition.drawing(reader)
    sketch = Lowering(reader.graph)
    drawn = [sketch.lower(node) for point in drawing for node in point]
    return Code(
        coordinates=definition.coordinate_names, velocities=definition.velocity_names,
        constraints=definition.constraint_names, parameters=tuple(definition.values),
        sizes=sizes, structure=structure, provides=tuple(terms),
        timeless=all(operation.arguments[0] != "t" for operation in lowering.operations if operation.code == "leaf"),
        constants=constants, scratch=scratch, c_source=c_source,
        programs=_or_reason(lambda: program_writer.terms(blocks, len(definition.values), given.nq, given.nv)),
        drawing=len(drawing[0]) if drawing else 0,
        drawing_program=_or_reason(lambda: program_writer.expressions(sketch, drawn, len(definition.values), given.nq)),
        program=closed_form.as_json(lowering, outputs))


def _or_reason(write: Callable[[], Any]) -> Any:
    """Programs, or the reason why they are not written."""
    try:
        return write()
    except Unwritten as reason:
        return str(reason)


def _stored(outputs: dict[str, list[int]], structure: dict[str, Any] | None) -> dict[str, list[int]]:
    """Stored entries of each term; all of them if the system has no structure."""
    if structure is None:
        return outputs
    places = {name: Structure(**structure).places(name) for name in ("A", "M", "C") if name in outputs}
    return outputs | {name: [outputs[name][place] for place in of_term] for name, of_term in places.items()}
