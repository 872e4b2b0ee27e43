"""The direct functions of built-in systems, written from their counterparts in SymPy: ``python tests/direct_sources.py`` writes
them anew into csrc/systems/direct, after which the core has to be built again.
"""

import sympy

from support import ROOT
from symbolic_counterparts import OF_PARAMETERS
from zerodrift.symbolics.emit import closed_form

FOLDER = ROOT / "csrc" / "systems" / "direct"
# Where in the doubles of a system those of its direct functions begin: behind its own, or with these where they are the same.
BEGINS = {"four_bar": 14, "driven_four_bar": 18, "pendulum": 0, "slider_crank": 0, "chaplygin_sleigh": 0,
          "oscillator": 0, "knife_edge": 0, "vertical_disc": 0}
# Systems that bring their own D have no independent velocities that are entries of v.
EMBEDS = {"chaplygin_sleigh": (False,), "knife_edge": (False,)}
HEADING = f"/* Written by tests/direct_sources.py with SymPy {sympy.__version__}, from tests/symbolic_counterparts.py. */"


def sources():
    """The text of each file by its name."""
    texts, sizes = {}, {}
    for name, counterpart in OF_PARAMETERS.items():
        system = counterpart()
        symbol, count = f"zd_{name}_direct", len(system.parameters)
        heading = [HEADING, f'#include "{name}.h"', "", "#include <math.h>", '#include "../../include/zerodrift/units.h"']
        texts[f"{name}.c"], constants = closed_form.write(
            *system._direct._definition, offset=count, symbol=symbol, heading=heading, embeds=EMBEDS.get(name, (False, True)),
            file=f"{name}.c", lanes_header='"../../include/zerodrift/lanes.h"',
            data=f"(const double *)data + {BEGINS[name]} * ZD_LANES" if BEGINS[name] else "data")
        sizes[name] = count + constants
    return texts | {f"{name}.h": header(name, size) for name, size in sizes.items()}


def header(name, size):
    capitals = f"ZD_{name.upper()}_DIRECT"
    return f"""{HEADING}
#ifndef {capitals}_H
#define {capitals}_H

#include "../../include/zerodrift/system.h"
#include "../../include/zerodrift/units.h"

/* Range of the constants of the closed-form functions among those of the system. */
enum {{ {capitals}_BEGINS = {BEGINS[name]}, {capitals}_ENDS = {BEGINS[name] + size} }};

extern const zd_direct zd_{name}_direct[];
/* Computes the constants that depend on the parameters alone, which are the first of these doubles. */
void zd_{name}_direct_constants(double *k);

#endif
"""


if __name__ == "__main__":
    for file, text in sources().items():
        (FOLDER / file).write_text(text)
