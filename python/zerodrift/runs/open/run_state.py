"""Saved states of open runs: inputs, what controllers keep, and the core's flat block, in one sequence of bytes."""

from __future__ import annotations

import hashlib
import pickle
import struct
import weakref
from typing import Any, NamedTuple

import numpy as np

from ..._private import gateway, webassembly
from ...errors import WrongState, ZerodriftError, sentence
from ...systems.base import BaseSystem
from .beginning import Prepared
from .identity import Definition

MAGIC, HEADER = b"zdrun002", struct.Struct("<8sqqq32s")
COUNTED = HEADER.size - 32      # bytes of the header before the checksum, which includes them
DIGITS = 40         # of a fingerprint, beside which the core has room for its own checks
_definitions: weakref.WeakKeyDictionary[BaseSystem, str] = weakref.WeakKeyDictionary()    # digests, as states are saved in loops


class RunState(NamedTuple):
    """Parts of a saved state.

    inputs : ndarray (k,)
        Values of the inputs.
    places : ndarray
        Numbers at their places in the data of the systems.
    controllers : list
        States of the controllers that have one.
    core : bytes
        The core's block.
    """

    inputs: np.ndarray
    places: np.ndarray
    controllers: list[Any]
    core: bytes


def saved(ready: Prepared, core: Any, controllers: list[Any], system: BaseSystem) -> bytes:
    """State of a run of the core, with these states of its controllers; `system` is the one that was given for all runs."""
    webassembly.refuse("the state of a run", "saved on another machine", "addresses have four bytes")
    inputs = core.inputs
    values, places = (inputs.values, inputs.at_places) if inputs else (np.empty(0), np.empty(0))
    return packed(RunState(values, places, controllers, core.save(fingerprint(ready, system)).state))


def packed(state: RunState) -> bytes:
    """A state as bytes, with a checksum."""
    kept = pickle.dumps(state.controllers)
    counts = len(state.inputs), len(state.places), len(kept)
    body = state.inputs.tobytes() + state.places.tobytes() + kept + state.core
    return HEADER.pack(MAGIC, *counts, _checksum(HEADER.pack(MAGIC, *counts, b""), body)) + body


def _checksum(header: bytes, body: bytes) -> bytes:
    return hashlib.sha256(header[:COUNTED] + body).digest()


def unpacked(given: Any) -> RunState:
    """The parts of a state.

    Raises
    ------
    WrongState
        If it was not saved by this version, or is not whole.
    """
    if not isinstance(given, bytes | bytearray | memoryview):
        raise WrongState(f"a state must be the bytes that save() returned, not {type(given).__name__}")
    given = bytes(given)
    if len(given) < HEADER.size or given[:len(MAGIC)] != MAGIC:
        raise WrongState("a state must be the bytes that save() returned, in this version of zerodrift")
    _, inputs, places, kept, checksum = HEADER.unpack_from(given)
    body = given[HEADER.size:]
    if _checksum(given, body) != checksum:
        raise WrongState("a state must be whole and unchanged: some of its bytes are missing or differ")
    numbers, end = np.frombuffer(body, count=inputs + places), 8 * (inputs + places)
    return RunState(numbers[:inputs], numbers[inputs:], pickle.loads(body[end:end + kept]), body[end + kept:])


def fingerprint(ready: Prepared, system: BaseSystem) -> str:
    """Text that identifies the layout of runs and the system with its parameters; `system` has the same definition."""
    of = ready.of
    parameters = sorted((name, repr(value)) for name, value in of.parameters.items())
    names = ready.declared.names if ready.declared else ()
    described = (gateway.LAYOUT, type(of).__name__, of.name, of.coordinates, of.velocities, of.constraints, parameters,
                 names, _definition(system))
    return hashlib.sha256(repr(described).encode()).hexdigest()[:DIGITS]


def _definition(system: BaseSystem) -> str:
    """Digest of what a system has besides its parameters."""
    if system not in _definitions:
        _definitions[system] = Definition().of(system._definition())
    return _definitions[system]


def restored(ready: Prepared, found: RunState, system: BaseSystem) -> Any:
    """The core's run that continues from a state, with its inputs.

    Raises
    ------
    WrongState
        If the block is of another system, other settings or another vector unit.
    """
    try:
        core = ready.created(gateway.OpenRun, gateway.Saved(found.core, fingerprint(ready, system)))
    except (ZerodriftError, ValueError) as error:
        raise WrongState(sentence(error)) from None
    if ready.inputs:
        ready.inputs.restore(found.inputs, found.places)
    return core
