"""Time that a new user waits: installation, first picture, the README's mechanism, and the first reaction that is plotted, each
in a new process, in a new virtual environment with nothing but this package and what it requires.

    python tests/bench/bench_first_minutes.py
"""

import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from measuring import record

ROOT = Path(__file__).resolve().parents[2]
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"} | {"MPLBACKEND": "Agg"}
PICTURE = """
import zerodrift as zd
zd.plot.mechanism(zd.models.four_bar()).figure.savefig("picture.png")
"""
REACTION = """
zd.plot.measures(sol, ["pin.force", "wrist.force"]).figure.savefig("reaction.png")
"""


def seconds(*command, folder):
    start = time.perf_counter()
    subprocess.run(command, cwd=folder, check=True, env=ENVIRONMENT, stdout=subprocess.DEVNULL)
    return time.perf_counter() - start


def main():
    example = re.search(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL).group(1)
    with tempfile.TemporaryDirectory() as folder:
        rows = [("virtual environment", seconds(sys.executable, "-m", "venv", "env", folder=folder), "s", None)]
        python = Path(folder, "env", "Scripts" if os.name == "nt" else "bin", "python")
        rows.append(("pip install .", seconds(python, "-m", "pip", "install", "-q", ROOT, folder=folder), "s", None))
        for what, code in (("first picture, of a model", PICTURE),
                           ("the README's mechanism, its run, its picture and its film", example),
                           ("the same, with its reactions plotted", example + REACTION)):
            for again in ("", ", again"):
                rows.append((what + again, seconds(python, "-W", "error", "-c", code, folder=folder), "s", None))
        assert {"picture.png", "film.html", "reaction.png"} <= {path.name for path in Path(folder).iterdir()}
    record("first_minutes", rows, ("what", "value", "unit", "at most"))


if __name__ == "__main__":
    main()
