"""Writer of csrc/systems/series, the Taylor series of built-in systems in double and double-double
arithmetic, from their derivations in tests/support/symbolic_counterparts.py:
``python python/write_series.py``, after which the core has to be built again.
"""

import re
import sys
from pathlib import Path

import sympy

ROOT = Path(__file__).resolve().parent.parent
sys.path += [str(ROOT / folder) for folder in ("tests", "tests/support", "python")]     # where it does not run in the test suite

from symbolic_counterparts import OF_PARAMETERS, PRECISE  # noqa: E402
from zerodrift.symbolics.emit import series  # noqa: E402

SYSTEMS = ROOT / "csrc" / "systems"
# Offset of the numbers of the series in the doubles of a system.
BEGINS = {"four_bar": 14}
COEFFICIENTS = re.compile(r"enum \{ ROWS.*?\n}\n", re.DOTALL)       # the text of them, which both precisions have in common
NUMBERS = re.compile(r"(const k = )([^;]*);")
HEADING = (f"/* Written by python/write_series.py with SymPy {sympy.__version__}, "
           "from tests/support/symbolic_counterparts.py. */")


def sources():
    """Text of each file by its path in csrc/systems."""
    texts, names = {}, sorted(OF_PARAMETERS)
    for name in names:
        code = OF_PARAMETERS[name]()._code
        begins = BEGINS.get(name)
        plain = relative(name, "series", series.write(
            code.program, code.sizes, f"(const double *)data + {begins}" if begins else "data"))
        code = PRECISE.get(name, OF_PARAMETERS[name])()._code
        precise = relative(name, "precise", series.write_precise(code.program, code.sizes))
        texts |= shared(name, plain, precise)
    return texts | {"series/series.h": header(names)}


def shared(name, plain, precise):
    """Texts of both files, and of a third with the coefficients where these are the same."""
    own = [COEFFICIENTS.search(text)[0] for text in (plain, precise)]
    common = {NUMBERS.sub(r"\1ZD_SERIES_NUMBERS;", text) for text in own}
    texts = {f"series/{name}.c": plain, f"series/{name}_precise.c": precise}
    if len(common) > 1:
        return texts
    for (path, text), coefficients in zip(list(texts.items()), own, strict=True):
        numbers = NUMBERS.search(coefficients)[2]
        texts[path] = text.replace(coefficients, f'#define ZD_SERIES_NUMBERS {numbers}\n#include "{name}_series.h"\n')
    what = f"/* Taylor coefficients of zd_{name}, in the precision of the numbers that the including file has chosen. */"
    return texts | {f"series/{name}_series.h": f"{HEADING}\n{what}\n{common.pop()}"}


def relative(name, kind, text):
    """The text with the name of its descriptor, and the headers of the core."""
    text = text.replace("/* Written by zerodrift.symbolic. */", HEADING).replace("<zerodrift/", '"../../include/zerodrift/')
    for file in ("series", "system"):
        text = text.replace(f"{file}.h>", f'{file}.h"')
    text = text.replace("\nconst int zd_interface_version = ZD_INTERFACE_VERSION;\n", '#include "series.h"\n')
    return text.replace(f"zd_symbolic_{kind}", f"zd_{name}_{kind}")


def header(names):
    listed = "\n".join(f"extern const zd_{kind} {', '.join(f'zd_{name}_{kind}' for name in names)};"
                       for kind in ("series", "precise"))
    return f"""{HEADING}
/* Taylor series of built-in systems; series and residuals in double-double arithmetic. */
#pragma once

#include "../../include/zerodrift/system.h"

{listed}
"""


if __name__ == "__main__":
    for file, text in sources().items():
        (SYSTEMS / file).parent.mkdir(exist_ok=True)
        (SYSTEMS / file).write_text(text)
