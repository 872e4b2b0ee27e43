"""Writer of csrc/systems/closed_form, the closed-form functions of built-in systems, from their
derivations in tests/support/symbolic_counterparts.py:
``python python/write_closed_form.py``, after which the core has to be built again.
"""

import sys
from pathlib import Path

import sympy

ROOT = Path(__file__).resolve().parent.parent
sys.path += [str(ROOT / folder) for folder in ("tests", "tests/support", "python")]     # where it does not run in the test suite

from symbolic_counterparts import OF_PARAMETERS  # noqa: E402
from zerodrift.symbolics.emit import closed_form  # noqa: E402

FOLDER = ROOT / "csrc" / "systems" / "closed_form"
# Offset of the constants of the closed-form functions in the doubles of a system: after its own, or 0 where they are the same.
BEGINS = {"four_bar": 14, "pendulum": 0, "oscillator": 0, "knife_edge": 0}
# Systems that provide D have no independent velocities that are entries of v.
EMBEDS = {"knife_edge": (False,)}
HEADING = (f"/* Written by python/write_closed_form.py with SymPy {sympy.__version__}, "
           "from tests/support/symbolic_counterparts.py. */")


def sources():
    """Text of each file by its name."""
    texts, sizes = {}, {}
    for name, counterpart in OF_PARAMETERS.items():
        system = counterpart()
        symbol, count = f"zd_{name}_closed_form", len(system.parameters)
        heading = [HEADING, f'#include "{name}.h"', "", "#include <math.h>", '#include "../../include/zerodrift/units.h"']
        texts[f"{name}.c"], constants = closed_form.write(
            *system._closed_form._definition, offset=count, symbol=symbol, heading=heading,
            embeds=EMBEDS.get(name, (False, True)),
            file=f"{name}.c", lanes_header='"../../include/zerodrift/lanes.h"',
            data=f"(const double *)data + {BEGINS[name]} * ZD_LANES" if BEGINS[name] else "data")
        sizes[name] = count + constants
    return texts | {f"{name}.h": header(name, size) for name, size in sizes.items()}


def header(name, size):
    capitals = f"ZD_{name.upper()}_CLOSED_FORM"
    return f"""{HEADING}
#pragma once

#include "../../include/zerodrift/system.h"
#include "../../include/zerodrift/units.h"

/* Range of the constants of the closed-form functions among those of the system. */
enum {{ {capitals}_BEGINS = {BEGINS[name]}, {capitals}_ENDS = {BEGINS[name] + size} }};

extern const zd_closed_form zd_{name}_closed_form[];
/* Computes the constants that depend on the parameters alone, which are the first of these doubles. */
void zd_{name}_closed_form_constants(double *k);
"""


if __name__ == "__main__":
    for file, text in sources().items():
        (FOLDER / file).write_text(text)
