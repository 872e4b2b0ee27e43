"""The command line: ``python -m zerodrift reproduce [--out DIR]``, ``gallery``, and ``explain CODE``."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

DEFAULT_FOLDER = Path("zerodrift-figures")
DEFAULT_GALLERY = Path("zerodrift-gallery")
EXAMPLES = """examples:
  python -m zerodrift reproduce --out figures
  python -m zerodrift gallery --out gallery
  python -m zerodrift explain branch-jump

In Python: `import zerodrift as zd`; `help(zd)` opens with the function for each
task.
"""


def main(arguments: Sequence[str] | None = None) -> int:
    """Do what the arguments say, or list the commands; the exit code."""
    parser = _parser()
    options = parser.parse_args(arguments)
    if options.command is None:
        parser.print_help()
        return 0
    if options.command is _explain:
        return _explain(options.code)
    try:
        import matplotlib.pyplot  # noqa: F401  (only now)
    except ValueError as error:     # of a setting of matplotlib's own, such as the environment variable MPLBACKEND
        print(f"python -m zerodrift: matplotlib refuses its settings (MPLBACKEND, matplotlibrc): {error}", file=sys.stderr)
        return 1
    try:
        options.command(options.out)
    except OSError as error:
        print(f"python -m zerodrift: cannot write to {options.out}: {error.strerror or error}", file=sys.stderr)
        return 1
    except ImportError as error:
        print(f"python -m zerodrift: {error}", file=sys.stderr)
        return 1
    return 0


def _reproduce(folder: Path) -> None:
    from .paper.reproduce import reproduce

    print(reproduce(folder))
    print(f"Figures 4-9 (PNG and SVG), claims.txt and claims.csv are in {folder.resolve()}")


def _gallery(folder: Path) -> None:
    from . import gallery
    from .models._swing import sympy as expressions

    expressions()       # before the first film is made, as some models cannot do without
    page = gallery.write(folder)
    print(f"{len(gallery.exhibits())} models in motion (animated PNG) and the page that shows them, {page.resolve()}")


def _explain(code: str | None) -> int:
    from .explanations import codes, explain

    if code is None:
        for each, (of, _) in sorted(codes().items()):
            print(f"{each:28}{of.__name__}")
        return 0
    try:
        print(explain(code))
    except ValueError as error:
        print(f"python -m zerodrift: {error}", file=sys.stderr)
        return 2
    return 0


def _folder(given: str) -> Path:
    """Path of a folder that need not exist; its name is checked."""
    if not given.strip() or "\0" in given:
        raise argparse.ArgumentTypeError(f"a folder is needed, not {given!r}")
    return Path(given)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m zerodrift", description="Constrained multibody systems without constraint drift.", epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(title="commands")
    parser.set_defaults(command=None)
    for name, does, folder, what in (
            ("reproduce", _reproduce, DEFAULT_FOLDER, "Figures 4-9 of Blajer (2002), and its claims checked"),
            ("gallery", _gallery, DEFAULT_GALLERY, "All models in motion, with the code of each")):
        command = commands.add_parser(name, help=what, description=f"{what}.")
        command.add_argument("--out", type=_folder, default=folder, metavar="DIR",
                             help="folder to write to (default: %(default)s)")
        command.set_defaults(command=does)
    explaining = commands.add_parser("explain", help="Causes and cures of an error, by its code",
                                     description="Causes and cures of an error or a warning.")
    explaining.add_argument("code", nargs="?", metavar="CODE", help="such as branch-jump; left out: all codes")
    explaining.set_defaults(command=_explain)
    return parser


if __name__ == "__main__":
    sys.exit(main())
