"""`zd.c_source`: a mechanism as plain C, for embedded use and hardware in the loop."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import resources
from pathlib import Path
from typing import Unpack

import numpy as np

from .._private import checks
from .._private.gateway.mechanisms import blocks
from .._private.types import ArrayLike, Events, Measures, Settings, SystemLike
from ..errors import ExistingFile
from .block import Chosen, choose, written
from .core_files import ENTRIES, CoreFiles, entry

MAKEFILE = """CFLAGS = -O1 -std=c11 -ffp-contract=off -I.
OBJECTS := $(patsubst %.c,%.o,$(shell find . -name '*.c'))

main: $(OBJECTS)
\t$(CC) -o $@ $(OBJECTS) -lm
"""


def c_source(system: SystemLike, folder: str | Path, *, step: float, outputs: Measures = (),
             p0: ArrayLike | None = None, v0: ArrayLike | None = None, t0: float = 0.0, inputs: Sequence[str] = (),
             events: Events | None = None, **chosen: Unpack[Settings]) -> Path:
    """Write a mechanism as a folder of C11 sources, with a program that simulates it.

    The folder has the files of the core that this mechanism and its methods need, the mechanism as one block (see `block`)
    in ``data.h``, a short ``main.c`` with the memory of a sample in ``sample.h``, and a ``Makefile``: ``make -j`` compiles them
    on all processors. They need a C compiler and its standard library, and nothing else; all memory is allocated before the
    first step, except for reactions of redundant constraints.
    ``main T`` simulates T seconds and prints t and the outputs with 17 digits, one line for each step. Compiled with
    ``-ffp-contract=off``, its numbers have the bits of `simulate` with ``vector="baseline"`` and
    ``closed_form=False``.

    Parameters
    ----------
    system : Mechanism or its system
    folder : str or Path
        It is made, and must be empty or not exist.
    step : float
        Size of fixed steps, in s.
    outputs : list of measures or names
        Measures to print, vectors with all components.
    p0, v0, t0, inputs, events, **chosen
        As in `block`. Inputs are set by ``zd_block_set_input``, between steps.

    Returns
    -------
    Path
        The folder.

    Raises
    ------
    FileExistsError
        If the folder has files.
    ValueError
        As `block`.

    Notes
    -----
    The median and the longest of a million steps are measured by ``tests/bench/bench_open_runs.py`` of the repository.

    Examples
    --------
    >>> import tempfile, zerodrift as zd
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     made = zd.c_source(zd.models.four_bar(), folder, step=0.01, outputs=["crank.angle"])
    ...     sorted(path.name for path in made.iterdir() if path.suffix in (".c", ".h"))[:3]
    ['data.h', 'main.c', 'methods.h']
    """
    step = checks.number("step", step, above=0, code="step-size")
    made = choose(system, p0, v0, t0, step, outputs, inputs, events=events, **chosen)
    folder = Path(folder)
    if folder.exists() and any(folder.iterdir()):
        raise ExistingFile(f"the folder must be empty or not exist, and {folder} has files")
    write_core(made, folder)
    for name in ("main.c", "sample.h"):
        (folder / name).write_text(resources.files(__package__).joinpath(name).read_text(encoding="utf-8"), encoding="utf-8")
    (folder / "Makefile").write_text(MAKEFILE, encoding="utf-8")
    return folder


def write_core(made: Chosen, folder: Path) -> None:
    """Write the files of the core that these choices need, and the block."""
    header = data(made)     # before any file, as it refuses what no block can have
    core_of(made).write(folder)
    (folder / "data.h").write_text(header, encoding="utf-8")


def core_of(made: Chosen, more: Sequence[str] = ()) -> CoreFiles:
    """Files of the core for the methods and the dimension of these choices, and `more` of them."""
    names = blocks.method_names(made.core_settings)
    dimension = {2: "zd_block_plane", 3: "zd_block_space"}[made.system._drawing.dimension]
    return CoreFiles({
        "SYSTEM": (), "FORMULATION": [entry("FORMULATION", *names["formulations"])],
        "INTEGRATOR": [entry("INTEGRATOR", *names["integrators"])],
        "CORRECTION": [entry("CORRECTION", name) for name in names["corrections"]], "DIMENSION": [dimension]}, [*ENTRIES, *more])


def data(made: Chosen) -> str:
    """Header with the block and its sizes."""
    system, words = made.system, np.frombuffer(written(made), "<u8")
    sizes = [system._watching.known[name][1] for name in made.outputs or ()]
    counts = {"NQ": system.nq, "NV": system.nv, "M": system.m, "INPUTS": len(made.inputs), "OUTPUTS": sum(sizes),
              "EVENTS": len(made.events)}
    names = " ".join(f"{name}[{size}]" if size > 1 else name for name, size in zip(made.outputs or (), sizes, strict=True))
    lines = [", ".join(f"0x{word:016x}" for word in words[i:i + 6]) for i in range(0, len(words), 6)]
    return "\n".join([
        f"/* Mechanism {_words(system.name)} as words of eight bytes, see block/block.h. Outputs: {_words(names)} */",
        "#include <stdint.h>", "",
        f"enum {{ {', '.join(f'{name} = {count}' for name, count in counts.items())} }};", "",
        f"static const uint64_t block_words[{len(words)}] = {{", *(f"    {line}," for line in lines), "};", ""])


def _words(text: str) -> str:
    """Text that cannot end a comment."""
    return text.replace("*/", "* /").replace("/*", "/ *").replace("\\", "/").replace("\n", " ")
