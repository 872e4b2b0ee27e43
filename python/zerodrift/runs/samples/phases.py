"""Phases and impacts of a run of a system with contacts, from its changes of phase."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

WORDS = {**dict.fromkeys(("one-sided", "one-way"), ("open", "closed", "", "", "closed", "open")),
         "friction": ("", "sticking", "sliding", "sliding", "sticking"),
         "two-sided": ("released", "joined", "", "", "joined"), "absent": ("", "", "", "", "")}
IMPACTS = np.dtype([("t", float), ("name", "U64"), ("impulse", float), ("energy_lost", float)])


class Phase(NamedTuple):
    """Time between two changes of phase, and the state of each contact, stop, joint with friction and latch by name."""

    t0: float                   # s
    t1: float                   # s
    state: dict[str, str]       # "open", "closed", "sticking", "sliding", "released" or "joined"

    def __str__(self) -> str:
        return f"{self.t0:g} to {self.t1:g} s: {', '.join(f'{name} {word}' for name, word in self.state.items())}"


def phases_of(transitions: np.ndarray, groups: Sequence[tuple[str, str]], end: float) -> list[Phase]:
    """The phases of a run that ended at this time; `groups` are the names and kinds of its groups of constraints."""
    ends = [*transitions["t"][1:].tolist(), end][:len(transitions)]
    return [Phase(float(row["t"]), t1, words(row["state"], groups)) for row, t1 in zip(transitions, ends, strict=True)]


def words(state: np.ndarray, groups: Sequence[tuple[str, str]]) -> dict[str, str]:
    """State by name: of a contact with friction whether it sticks or slides."""
    found: dict[str, str] = {}
    for (name, kind), value in zip(groups, state.tolist(), strict=True):
        if word := WORDS[kind][value]:
            found[name] = word
    return found


def impacts_of(transitions: np.ndarray, groups: Sequence[tuple[str, str]]) -> np.ndarray:
    """Rows of each impulse and each loss of energy."""
    rows = [(row["t"], name, impulse, loss) for row in transitions
            for (name, _), impulse, loss in zip(groups, row["impulse"], row["loss"], strict=True) if impulse or loss]
    return np.array(rows, IMPACTS)


def state_from_samples(t: np.ndarray, transitions: np.ndarray) -> np.ndarray | None:
    """State (k, groups) of each group from each sample on; of several samples at one time the last are after the changes.

    None for a system without groups.
    """
    if not len(transitions):
        return None
    changed = transitions["t"]
    until = np.searchsorted(t, changed, side="right")       # first sample after each change
    phase = np.zeros(len(t), int)
    for k in range(1, len(changed)):
        later = int((changed[k:] == changed[k]).sum())      # changes from this one on at the same time have samples of their own
        phase[max(0, until[k] - later):] = k
    return np.ascontiguousarray(transitions["state"][phase])
