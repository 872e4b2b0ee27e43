"""`record_size`: memory or disk space that the record of a run takes."""

from __future__ import annotations

from typing import Any, NamedTuple

from ..._private import checks, gateway
from ..._private.types import ArrayLike, Measures, SystemLike
from ...systems.base import core_of, system_of
from ..arguments import outputs as _outputs
from ..arguments import settings
from . import memory


class RecordSize(NamedTuple):
    """Size of the record of a run, in memory or in a file.

    Attributes
    ----------
    rows : int or None
        Number of samples; None with adaptive steps and no `t_eval`, as it is not known in advance.
    row : int
        Bytes of one sample.
    total : int or None
        Bytes of all samples.
    """

    rows: int | None
    row: int
    total: int | None

    def __str__(self) -> str:
        each = f"samples of {memory.in_words(self.row)}"
        return each if self.total is None else f"{self.rows} {each}: {memory.in_words(self.total)}"


def record_size(system: SystemLike, t_span: float | tuple[float, float], *, step: float | None = None,
                t_eval: ArrayLike | None = None, save_every: int = 1, outputs: Measures | None = None) -> RecordSize:
    """Size of the record that `simulate` would make with these arguments. Nothing is simulated.

    Parameters
    ----------
    system, t_span, step, t_eval, save_every, outputs
        As of `simulate`.

    Returns
    -------
    RecordSize
        Tuple (rows, row, total): number of samples, bytes of one sample, bytes of all.

    Raises
    ------
    ValueError, TypeError
        For a wrong argument.

    Examples
    --------
    >>> import zerodrift as zd
    >>> print(zd.record_size(zd.systems.four_bar(), 3600.0, step=1e-4))
    36000001 samples of 144 bytes: 5.18 GB
    >>> print(zd.record_size(zd.systems.four_bar(), 3600.0, step=1e-4, save_every=100))
    360001 samples of 144 bytes: 51.8 MB
    """
    system, span = system_of(system), checks.span(t_span)
    core, recorded = core_of(system), None
    if outputs is not None:
        recorded = _outputs.Recorded(_outputs.names(outputs, system), system, core).core
    chosen: dict[str, Any] = {
        "step": None if step is None else checks.number("step", step, above=0, code="step-size"),
        "save_every": checks.count("save_every", save_every)}
    rows = settings.saved_rows(span, chosen)
    if t_eval is not None:
        rows = len(settings.times_to_save(t_eval, chosen["save_every"], span))
    row = gateway.row_bytes(core, recorded)
    return RecordSize(rows, row, None if rows is None else rows * row)
