"""FMUs of a crane for all platforms of FMI 3.0 and FMI 2.0, compiled by ziglang on this machine.

Run it with ``python tests/stress/fmu_platforms.py [QEMU FOLDER]``. Each library must have the format and the machine of its
platform and export every function of its version of the standard that FMPy's sources name; FMPy must find the unit valid. That
for x86_64-linux is run by FMPy, on a machine of that kind, beside `simulate`. With a program qemu-aarch64 and the folder of the
libraries of that system, that for aarch64-linux is run by `fmu_steps.c`, too.
"""

import re
import struct
import subprocess
import sys
import tempfile
import time
import zipfile
from pathlib import Path

import fmpy
import numpy as np
from fmpy.validation import validate_fmu

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

import zerodrift as zd
from few_bodies import two_links
from zerodrift.export.fmu_libraries import PLATFORMS
from zerodrift.symbolics.compile import compilers

MACHINES = {"ELF": {62: "x86_64", 183: "aarch64"}, "Mach-O": {0x01000007: "x86_64", 0x0100000C: "aarch64"},
            "PE": {0x8664: "x86_64", 0xAA64: "aarch64"}}
FORMATS = {"linux": "ELF", "darwin": "Mach-O", "windows": "PE"}
# Functions of FMI 2.0 that units for co-simulation need not have.
MODEL_EXCHANGE = {f"fmi2{name}" for name in ("CompletedIntegratorStep", "EnterContinuousTimeMode", "EnterEventMode",
                                             "GetContinuousStates", "GetDerivatives", "GetEventIndicators",
                                             "GetNominalsOfContinuousStates", "NewDiscreteStates", "SetContinuousStates",
                                             "SetTime")}
STEP, STEPS, TORQUE = 1e-3, 1000, 2.0


def format_and_machine(library):
    """Format of a shared library and the number of its machine, from its header."""
    if library[:4] == b"\x7fELF":
        return "ELF", struct.unpack_from("<H", library, 18)[0]
    if library[:4] == b"\xcf\xfa\xed\xfe":
        return "Mach-O", struct.unpack_from("<I", library, 4)[0]
    header, = struct.unpack_from("<I", library, 0x3C)
    assert library[:2] == b"MZ"
    assert library[header:header + 4] == b"PE\0\0"
    return "PE", struct.unpack_from("<H", library, header + 4)[0]


def functions(version):
    """Names of the functions that a library of a version must have, as FMPy binds them."""
    text = (Path(fmpy.__file__).parent / f"fmi{version[0]}.py").read_text(encoding="utf-8")
    return sorted({*re.findall(rf"['\"](fmi{version[0]}[A-Z]\w+)['\"]", text)} - MODEL_EXCHANGE)


def main():
    """Make the units and check them."""
    sol = zd.simulate(two_links(TORQUE), STEP * STEPS, step=STEP, outputs=["upper.angle"], vector="baseline")
    simulated = sol["upper.angle"][-1]
    with tempfile.TemporaryDirectory() as folder:
        for version, platforms in PLATFORMS.items():
            begin = time.perf_counter()
            unit = zd.fmu(two_links(0.0), Path(folder, f"crane{version[0]}"), step=STEP, inputs=["drive.torque"],
                          outputs=["upper.angle"], version=version, platforms=list(platforms))
            print(f"FMI {version}: {len(platforms)} platforms in {time.perf_counter() - begin:.0f} s, "
                  f"{unit.stat().st_size / 1e6:.1f} MB")
            check(unit, version, simulated, folder)


def check(unit, version, simulated, folder):
    """Check the libraries of a unit, and run those that can be run here."""
    assert validate_fmu(str(unit)) == []
    names = functions(version)
    with zipfile.ZipFile(unit) as archive:
        binaries = {Path(name).parts[1]: archive.read(name) for name in archive.namelist() if name.startswith("binaries/")}
    for platform, (machine, system) in PLATFORMS[version].items():
        library = binaries[platform]
        kind, number = format_and_machine(library)
        assert (kind, MACHINES[kind][number]) == (FORMATS[system], machine)
        assert all(re.search(rb"[\0_]" + name.encode() + rb"\0", library) for name in names), platform
        print(f"{platform}: {kind} of {machine}, {len(library) / 1e6:.1f} MB, all {len(names)} functions")
    given = np.array([(0.0, TORQUE), (10.0, TORQUE)], dtype=[("time", float), ("drive.torque", float)])
    found = fmpy.simulate_fmu(str(unit), stop_time=STEP * STEPS, step_size=STEP, output_interval=STEP, input=given)
    print(f"by FMPy on this machine: {found['upper.angle'][-1] - simulated:.1e} rad from simulate")
    if version == "3.0" and len(sys.argv) == 3:
        Path(folder, "crane.so").write_bytes(binaries["aarch64-linux"])
        token = fmpy.read_model_description(str(unit)).instantiationToken
        print(f"aarch64-linux by qemu: {emulated(folder, token) - simulated:.1e} rad from simulate")


def emulated(folder, token):
    """Angle of the crane at the end, by the library in the folder, run by qemu."""
    qemu, libraries = sys.argv[1:]
    program = Path(folder, "steps")
    subprocess.run([compilers.zig(), "cc", "-target", "aarch64-linux-gnu.2.17", "-o", program,
                    Path(__file__).with_name("fmu_steps.c"), "-ldl"], check=True)
    line = [qemu, "-L", libraries, program, Path(folder, "crane.so"), token, str(STEP), str(STEPS), str(TORQUE)]
    return float(subprocess.run(line, check=True, capture_output=True, text=True).stdout)


if __name__ == "__main__":
    main()
