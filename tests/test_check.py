"""Arguments in Python: bad ones get a clear error, which names the argument, its value and what is allowed; and nothing else."""

import re
from decimal import Decimal

import numpy as np
import pytest

import zerodrift as zd
from support import SYSTEMS, refused
from zerodrift._private import checks

BAR = SYSTEMS["four_bar"]
SOL = zd.simulate(BAR, 0.1, step=0.01)


def run(**options):
    return zd.simulate(BAR, 1, step=0.1, **options)


NOT_VECTORS = [
    # value, error, message
    ([1.0, 2.0], ValueError, r"must have shape \(3,\), not \(2,\)"),
    ([[1.0, 2.0, 3.0]], ValueError, r"must have shape \(3,\), not \(1, 3\)"),
    (1.0, ValueError, r"must have shape \(3,\), not \(\)"),
    ([], ValueError, r"must have shape \(3,\), not \(0,\)"),
    ([1.0, [2.0, 3.0], 4.0], ValueError, r"must have shape \(3,\), not be a ragged sequence"),
    ([1j, 0, 0], TypeError, "must hold real numbers, not complex128"),
    (["1", "2", "3"], TypeError, "must hold real numbers, not <U1"),
    ("123", TypeError, "must hold real numbers, not <U3"),
    ([True, False, True], TypeError, "must hold real numbers, not bool"),
    ([None, 1, 2], TypeError, "must hold real numbers, not object"),
    ([10**400, 1, 2], TypeError, "must hold real numbers, not object"),
    ({1: 2}, TypeError, "must hold real numbers, not object"),
    (np.zeros(3, dtype="M8[s]"), TypeError, "must hold real numbers, not datetime64"),
    ([1.0, np.nan, 3.0], ValueError, "must be finite, not .*nan"),
    ([1.0, np.inf, 3.0], ValueError, "must be finite, not .*inf"),
]
NOT_NUMBERS = [("1", TypeError), (None, TypeError), (True, TypeError), (1j, TypeError), ([1.0], TypeError),
               (Decimal(1), TypeError), (np.nan, ValueError), (np.inf, ValueError), (-np.inf, ValueError), (10**400, ValueError)]
VECTOR_ARGUMENTS = {
    "simulate p0": ("p0", lambda x: zd.simulate(BAR, 1, x, BAR.v0, step=0.1)),
    "simulate v0": ("v0", lambda x: zd.simulate(BAR, 1, BAR.p0, x, step=0.1)),
    "assemble p": ("p", lambda x: zd.assemble(BAR, x)),
    "assemble v": ("v", lambda x: zd.assemble(BAR, BAR.p0, x)),
    "project p": ("p", lambda x: zd.project(BAR, x, BAR.v0)),
    "project v": ("v", lambda x: zd.project(BAR, BAR.p0, x)),
    "acceleration p": ("p", lambda x: zd.acceleration(BAR, x, BAR.v0)),
    "acceleration v": ("v", lambda x: zd.acceleration(BAR, BAR.p0, x)),
    "evaluate p": ("p", lambda x: BAR.evaluate(x)),
    "evaluate v": ("v", lambda x: BAR.evaluate(BAR.p0, x)),
    "points p": ("p", BAR.points),
    "masses": ("masses", lambda x: zd.systems.four_bar(masses=x)),
}
NUMBER_ARGUMENTS = {
    "t_span": ("t_span[1]", lambda x: zd.simulate(BAR, (0, x), step=0.1)),
    "step": ("step", lambda x: zd.simulate(BAR, 1, step=x)),
    "tol": ("tol", lambda x: zd.Projection(tol=x)),
    "assemble tol": ("tol", lambda x: zd.assemble(BAR, BAR.p0, tol=x)),
    "alpha": ("alpha", lambda x: zd.Baumgarte(alpha=x)),
    "beta": ("beta", lambda x: zd.Baumgarte(beta=x)),
    "assemble t": ("t", lambda x: zd.assemble(BAR, BAR.p0, t=x)),
    "project t": ("t", lambda x: zd.project(BAR, BAR.p0, BAR.v0, x)),
    "acceleration t": ("t", lambda x: zd.acceleration(BAR, BAR.p0, BAR.v0, x)),
    "evaluate t": ("t", lambda x: BAR.evaluate(t=x)),
    "gravity": ("gravity", lambda x: zd.systems.four_bar(gravity=x)),
}


@pytest.mark.parametrize(("name", "call"), VECTOR_ARGUMENTS.values(), ids=VECTOR_ARGUMENTS)
@pytest.mark.parametrize(("value", "error", "message"), NOT_VECTORS, ids=lambda x: repr(x) if not isinstance(x, type) else "")
def test_what_is_not_a_vector(name, call, value, error, message):
    with pytest.raises(error, match=f"^{re.escape(name)} {message}"):
        call(value)


@pytest.mark.parametrize(("name", "call"), NUMBER_ARGUMENTS.values(), ids=NUMBER_ARGUMENTS)
@pytest.mark.parametrize(("value", "error"), NOT_NUMBERS, ids=lambda x: repr(x)[:9])
def test_what_is_not_a_number(name, call, value, error):
    if value is None and name in ("step", "gravity"):
        return      # left out
    says = "must be a real number, not" if error is TypeError else "must be finite, not"
    with pytest.raises(error, match=f"^{re.escape(name)} {says} {'' if error is ValueError else re.escape(repr(value))}"):
        call(value)


@pytest.mark.parametrize("dtype", ["f4", "f8", ">f8", "i4", "u1"])
@pytest.mark.parametrize("layout", [lambda a: a, lambda a: np.repeat(a, 2)[::2], lambda a: a[::-1][::-1], list, tuple])
def test_what_is_a_vector(dtype, layout):
    """Any real numbers in any layout are taken for what they are, read-only ones too; and never written to."""
    given = np.array([1, 2, 3], dtype=dtype)
    given.flags.writeable = False
    p, _ = zd.project(BAR, layout(given), layout(given), projection=zd.Projection(positions=False))
    assert p.tolist() == given.tolist() == [1, 2, 3]
    assert p.dtype == np.float64


@pytest.mark.parametrize(("call", "message"), {
    "step 0": (lambda: zd.simulate(BAR, 1, step=0), "step must be greater than 0, not 0"),
    "step negative": (lambda: zd.simulate(BAR, 1, step=-0.1), "step must be greater than 0, not -0.1"),
    "step left out": (lambda: zd.simulate(BAR, 1, integrator="rk4"), "step must be given: 'rk4' takes fixed steps"),
    "step too small": (lambda: zd.simulate(BAR, (1e6, 1e6 + 1), step=1e-10),
                       r"step must be at least .* for times up to 1e\+06, not 1e-10"),
    "backwards": (lambda: zd.simulate(BAR, (1, 0), step=0.1), "t_span must run forwards: 0 is not after 1"),
    "negative end": (lambda: zd.simulate(BAR, -1, step=0.1), "t_span must run forwards: -1 is not after 0"),
    "no span": (lambda: zd.simulate(BAR, 0, step=0.1), "t_span must run forwards: 0 is not after 0"),
    "endless span": (lambda: zd.simulate(BAR, (-1e308, 1e308), step=1e300), "the length of t_span must be finite"),
    "formulation": (lambda: run(formulation="lagrange"),
                    "formulation must be one of .*'schur'.*, not 'lagrange'"),
    "integrator": (lambda: run(integrator="leapfrog"), "integrator must be one of .*'rk4'.*, not 'leapfrog'"),
    "stabilization": (lambda: run(stabilization="none"),
                      "stabilization must be one of 'projection', 'baumgarte', not 'none'"),
    "on_failure": (lambda: run(on_failure="ignore"), "on_failure must be one of 'raise', 'return', not 'ignore'"),
    "save_every": (lambda: run(save_every=0), "save_every must be between 1 and 2147483647, not 0"),
    "every": (lambda: zd.Projection(every=-1), "every must be between 1 and 2147483647, not -1"),
    "max_iterations": (lambda: zd.Projection(max_iterations=2**31),
                       "max_iterations must be between 1 and 2147483647, not 2147483648"),
    "energy every": (lambda: zd.EnergyCorrection(every=0), "every must be between 1 and 2147483647, not 0"),
    "metric": (lambda: zd.Projection(metric="kinetic"), "metric must be one of 'mass', 'identity', not 'kinetic'"),
    "tol": (lambda: zd.Projection(tol=0.0), "tol must be greater than 0, not 0"),
    "alpha": (lambda: zd.Baumgarte(alpha=-1), "alpha must be at least 0, not -1"),
    "beta": (lambda: zd.Baumgarte(beta=-1), "beta must be at least 0, not -1"),
    "acceleration": (lambda: zd.acceleration(BAR, BAR.p0, BAR.v0, formulation="x"), "formulation must be one of .*, not 'x'"),
    "project": (lambda: zd.project(BAR, BAR.p0, BAR.v0, formulation="x"), "formulation must be one of .*, not 'x'"),
    "hold": (lambda: zd.assemble(BAR, BAR.p0, hold=("alpha1", "beta1")),
             "hold must be one of 'alpha1', .*'alpha3_dot', not 'beta1'"),
    "hold a number": (lambda: zd.assemble(BAR, BAR.p0, hold=(1,)), "hold must be one of 'alpha1', .*'alpha3_dot', not 1"),
    "negative mass": (lambda: zd.systems.four_bar(masses=(1, -1, 1)), r"masses must be positive, not \(1, -1, 1\)"),
    "massless": (lambda: zd.systems.oscillator(mass=0), "mass must be positive, not 0"),
    "inertias": (lambda: zd.systems.four_bar(inertias=(1, 1, -1)), r"inertias must be not negative, not \(1, 1, -1\)"),
    "cannot close": (lambda: zd.systems.four_bar(lengths=(5, 1, 1, 1)),
                     "four_bar: links of these lengths cannot close the loop at this crank_angle"),
    "in line": (lambda: zd.systems.four_bar(lengths=(2, 1, 0.5, 0.5), crank_angle=0),
                "four_bar: links 2 and 3 are in line at this crank_angle"),
    "assembly": (lambda: zd.systems.four_bar(assembly="closed"), "assembly must be one of 'open', 'crossed', not 'closed'"),
}.values(), ids=lambda x: x if isinstance(x, str) else "")
def test_bad_values(call, message):
    with pytest.raises(ValueError, match=f"^{message}"):
        call()


@pytest.mark.parametrize(("call", "message"), [
    (lambda: zd.simulate("four_bar", 1, step=0.1), "system must be one of zd.systems.*, not 'four_bar'"),
    (lambda: zd.simulate(zd.systems.four_bar, 1, step=0.1), "system must be one of zd.systems.*, not <function four_bar"),
    (lambda: zd.assemble("four_bar", [1, 2, 3]), "system must be one of zd.systems.*, not 'four_bar'"),
    (lambda: zd.project("four_bar", [1, 2, 3], [1, 2, 3]), "system must be one of zd.systems.*, not 'four_bar'"),
    (lambda: zd.acceleration("four_bar", [1, 2, 3], [1, 2, 3]), "system must be one of zd.systems.*, not 'four_bar'"),
    (lambda: zd.simulate(BAR, None, step=0.1), r"t_span must be an end time or a pair \(t0, t1\), not None"),
    (lambda: zd.simulate(BAR, (0, 1, 2), step=0.1), r"t_span must be an end time or a pair \(t0, t1\), not \(0, 1, 2\)"),
    (lambda: zd.simulate(BAR, (1,), step=0.1), r"t_span must be an end time or a pair \(t0, t1\), not \(1,\)"),
    (lambda: zd.simulate(BAR, True, step=0.1), "t_span must be a real number, not True"),
    (lambda: run(stabilization=True),
     r"stabilization must be None, 'projection', 'baumgarte', zd.Projection\(...\) or zd.Baumgarte\(...\), not True"),
    (lambda: run(stabilization=zd.Projection), "stabilization must be None, .*, not <class"),
    (lambda: run(energy=1), r"energy must be None, True or zd.EnergyCorrection\(...\), not 1"),
    (lambda: run(progress=1), "progress must be True, False or a callable, not 1"),
    (lambda: run(save_every=1.5), "save_every must be a whole number, not 1.5"),
    (lambda: run(save_every=True), "save_every must be a whole number, not True"),
    (lambda: zd.Projection(positions=1), "positions must be True or False, not 1"),
    (lambda: zd.Projection(velocities=None), "velocities must be True or False, not None"),
    (lambda: zd.project(BAR, BAR.p0, BAR.v0, projection="mass"), r"projection must be zd.Projection\(...\), not 'mass'"),
    (lambda: zd.assemble(BAR, BAR.p0, hold=None), "hold must be names of coordinates and velocities, not None"),
    (lambda: zd.systems.four_bar(length=1), "four_bar has no parameter 'length'; it has lengths, masses, "),
    (lambda: zd.simulate(zd.load), "missing"),
])
def test_bad_types(call, message):
    with pytest.raises(TypeError, match=message):
        call()


def test_energy_correction_needs_a_potential():
    free = zd.System(1, mass=[[1.0]], p0=[0.0], name="free")
    with refused("not-available", r"^energy correction needs V \(potential energy in J\), and free declares none "):
        zd.simulate(free, 1, step=0.1, energy=True)


def test_corrections_are_given_once():
    for given in ("projection", ["energy", "energy"], [zd.Projection()]):
        with refused("duplicate-name"):
            run(correction=given)
    with refused("unknown-choice", "correction.*'baumgarte'.*'none'"):
        run(correction="none")
    with refused("wrong-type", r"^correction must be names or settings of zd.corrections\(\), not 1 "):
        run(correction=1)


def test_a_system_that_is_only_described_is_not_simulated(bar):
    from zerodrift.runs.samples.saving import Described

    description = Described(bar._described())
    with refused("wrong-type", "system.*zd.systems.*four_bar"):
        zd.simulate(description, 1, step=0.1)


def test_whole_numbers_of_any_kind_count():
    assert checks.count("n", np.int8(3)) == 3


def test_masked_and_complex_starts():
    masked = np.ma.masked_array(BAR.p0, [False, True, False])
    with refused("not-finite", "^p0 must"):
        zd.simulate(BAR, 0.1, masked, step=0.01)
    with refused("wrong-type", "^v0 must"):
        zd.simulate(BAR, 0.1, v0=BAR.v0 + 0j, step=0.01)
    assert zd.simulate(BAR, 0.1, np.ma.masked_array(BAR.p0), step=0.01).p.tobytes() == SOL.p.tobytes()
