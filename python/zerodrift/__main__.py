"""The command line: ``python -m zerodrift reproduce [--out DIR]``."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

DEFAULT_FOLDER = Path("zerodrift-figures")


def main(arguments: Sequence[str] | None = None) -> int:
    """Do what the arguments say; the exit code."""
    options = _parser().parse_args(arguments)
    try:
        from .paper.reproduce import reproduce  # with matplotlib: only now
    except ValueError as error:     # of a setting of matplotlib's own, such as the environment variable MPLBACKEND
        print(f"python -m zerodrift: matplotlib refuses its settings (MPLBACKEND, matplotlibrc): {error}", file=sys.stderr)
        return 1
    try:
        table = reproduce(options.out)
    except OSError as error:
        print(f"python -m zerodrift: cannot write to {options.out}: {error.strerror or error}", file=sys.stderr)
        return 1
    print(table)
    print(f"Figures 4-9 (PNG and SVG), claims.txt and claims.csv are in {options.out.resolve()}")
    return 0


def _folder(given: str) -> Path:
    """A folder that may have to be made yet."""
    if not given.strip() or "\0" in given:
        raise argparse.ArgumentTypeError(f"a folder is needed, not {given!r}")
    return Path(given)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m zerodrift", description="Constrained multibody systems without constraint drift.")
    commands = parser.add_subparsers(title="commands", required=True)
    what = "Figures 4-9 of Blajer (2002), and its claims against what we measure"
    command = commands.add_parser("reproduce", help=what, description=f"{what}.")
    command.add_argument("--out", type=_folder, default=DEFAULT_FOLDER, metavar="DIR",
                         help="folder to write to (default: %(default)s)")
    return parser


if __name__ == "__main__":
    sys.exit(main())
