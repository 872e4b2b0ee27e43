"""Each failure of a run, reached: its exception, its sentence with numbers, and what was computed before it."""

import re

import numpy as np
import pytest

import tolerances as tol
import zerodrift as zd
from large_mechanisms import four_bars
from support import assert_close, motion, refused
from zerodrift._private import gateway


def failed(code, message, call):
    """The solution of the error of a code: consistent, and shorter than the requested span."""
    with refused(code, message) as caught:
        call()
    sol = caught.value.solution
    assert str(caught.value) == f"{sol.message} [zd:{caught.value.code}]"
    assert not sol.success
    assert sol.status < 0
    assert np.isfinite(sol.p).all()
    assert len(sol.t) == len(sol.p) == len(sol.energy_violation)
    assert sol.t[-1] < sol.t_span[1]
    return sol


def without(bar):
    """The paper's case (a), whose drift ends it."""
    return zd.simulate(bar, 8.0, step=0.05, stabilization=None)


def test_a_run_that_blows_up(bar):
    sol = failed("diverged", r"^at t = 7\.\d+ \(step 15\d of 160\): the state left the range of doubles; try a smaller step",
                 lambda: without(bar))
    assert 7.5 <= sol.t[-1] <= 7.7
    before = zd.simulate(bar, 7.0, step=0.05, stabilization=None)
    assert np.array_equal(sol.p[:140], before.p[:140])


def test_a_run_that_blows_up_may_return(bar):
    sol = zd.simulate(bar, 8.0, step=0.05, stabilization=None, on_failure="return")
    with pytest.raises(zd.Diverged) as caught:
        without(bar)
    assert np.array_equal(sol.p, caught.value.solution.p)
    assert str(caught.value) == f"{sol.message} [zd:diverged]"
    assert (sol.success, sol.status) == (False, caught.value.solution.status)


@pytest.mark.parametrize("gains", [zd.Baumgarte(1e300, 0), zd.Baumgarte(1e155, 1e300)], ids=str)
def test_a_run_that_blows_up_within_a_step(bar, gains):
    """The first stage that is not a number fails in some factorization, but what is named is the cause."""
    failed("diverged", r"^at t = 0\.05 \(step 1 of 20\): the state left the range of doubles",
           lambda: motion(bar, 1.0, 20, stabilization=gains))


def test_a_failed_run_is_saved_like_others(bar, tmp_path):
    sol = zd.simulate(bar, 8.0, step=0.05, stabilization=None, on_failure="return")
    again = zd.load(sol.save(tmp_path / "failed"))
    assert not again.success
    assert repr(again) == repr(sol)


def test_an_inconsistent_start(bar):
    message = (r"^the start violates the constraints: max \|Phi\| = 0\.\d+, max \|Psi\| = .* of their sizes \(allowed: 1e-10\), "
               r"most in row \d 'closure_[xy]'; zd\.assemble finds a consistent start nearby \[zd:inconsistent-start\]$")
    with refused("inconsistent-start", message):
        zd.simulate(bar, 1, bar.p0 + 0.1, step=0.1)
    with refused("inconsistent-start", r"max \|Phi\| = 0, max \|Psi\| = 0\.\d+ "):
        zd.simulate(bar, 1, bar.p0, [1, 0, 0], step=0.1)
    zd.simulate(bar, 0.1, *zd.assemble(bar, bar.p0 + 0.1, [1, 0, 0]), step=0.05)


def test_a_tolerance_below_what_doubles_reach(bar):
    message = r"^tol = 1e-17 is below what doubles can reach here: .* near \d.*e-1[67] of its size \[zd:[a-z-]+\]$"
    with refused("unreachable-tolerance", message):
        zd.simulate(bar, 1, step=0.1, stabilization=zd.Projection(tol=1e-17))


def test_a_correction_that_does_not_converge(bar):
    message = (r"^at t = .* \(step \d+ of 160\): the position correction left max .* of its size after 1 iterations, full and "
               r"shortened \(tolerance 1e-15\), also when the step is divided \[zd:correction-failed\]$")
    sol = failed("correction-failed", message,
                 lambda: motion(bar, 8.0, 160, stabilization=zd.Projection(tol=1e-15, max_iterations=1)))
    assert_close(sol.t, 0.05 * np.arange(len(sol.t)), tol.SAME)
    assert sol.stats["max_position_iterations"] == 1


def test_a_step_far_too_large(bar):
    failed("branch-jump", r"the step is divided \[zd:branch-jump\]$", lambda: zd.simulate(bar, 8.0, step=2.0))


def test_an_implicit_step_far_too_large(bar):
    failed("implicit-step",
           r"^at t = .*: the equations of the implicit 'trapezoidal' step .*; try a smaller step \[zd:implicit-step\]$",
           lambda: zd.simulate(bar, 8.0, step=2.0, integrator="trapezoidal"))


def test_a_projection_that_does_not_converge(bar):
    with pytest.raises(zd.CorrectionFailed, match=r"left max \|Phi\| = .* after 2 iterations, .* \(tolerance 1e-12\)"):
        zd.project(bar, bar.p0 + 0.3, bar.v0, projection=zd.Projection(max_iterations=2))
    with pytest.raises(zd.CorrectionFailed, match=r"after 1 iterations, full and shortened \(tolerance 1e-30\)"):
        zd.project(bar, bar.p0 + 1e-3, bar.v0, projection=zd.Projection(tol=1e-30, max_iterations=1))


def test_links_that_cannot_close(bar):
    """The crank is held where links 2 and 3 do not reach the ground."""
    short = zd.systems.four_bar(lengths=(1, 0.5, 0.5, 0.4), crank_angle=0.1)
    with pytest.raises((zd.CorrectionFailed, zd.SingularSystem)):
        zd.assemble(short, [np.pi, 0, 0], hold="alpha1")


def test_too_much_is_held(bar):
    with pytest.raises(zd.CorrectionFailed, match=r"; rows \d '.*' and \d 'p.* is held' follow from the others, and may .*$"):
        zd.assemble(bar, bar.p0 + 0.1, hold=("alpha1", "alpha2", "alpha3"))


def test_constraints_that_are_dependent(bar, formulation):
    """All links along the x axis: none of them can move its end along x."""
    with refused("bifurcation", r"^at t = 0 .*\(a bifurcation: row 0 'closure_x' follows from the others\)"):
        zd.acceleration(bar, [0, 0, 0], [0, 0, 0], formulation=formulation)


def massless():
    """Two of three links without mass: M has rank two."""
    return zd.systems.four_bar(masses=(1e-30, 1e-30, 3), inertias=(0, 0, 0))


def test_a_mass_matrix_that_is_not_definite():
    bar = massless()
    start = bar.p0, bar.v0
    for call in (lambda: zd.simulate(bar, 1, step=0.1), lambda: zd.acceleration(bar, *start), lambda: zd.project(bar, *start)):
        with refused("mass-not-definite", r"first seen at velocity \d"):
            call()


def test_a_mass_beyond_doubles(formulation):
    bar = zd.systems.four_bar(masses=(1e308, 1e308, 1e308), lengths=(1000, 300, 1000, 600))
    with pytest.raises(zd.ZerodriftError):
        zd.acceleration(bar, bar.p0, bar.v0, formulation=formulation)


def test_every_error_is_one_of_ours():
    """And one of Python's, where Python has a word for it."""
    for status, error in gateway.ERRORS.items():
        assert status < 0
        assert issubclass(error, zd.ZerodriftError | MemoryError)
    assert issubclass(zd.InconsistentStart, ValueError)
    assert issubclass(zd.SingularSystem, ArithmeticError)
    assert isinstance(gateway.error_of(-10, "unknown"), zd.ZerodriftError)
    assert zd.ZerodriftError.solution is None


# ---- rows by their names ----


def in_line(cells):
    """Cranks and couplers of a row of parallelograms, drawn along one line: as many rows are redundant there."""
    m = zd.Mechanism("in line", gravity=(0, 0))
    cranks = [m.link(f"crank{i}", (2 * i, 0), (2 * i + 1, 0), mass=1.0) for i in range(cells + 1)]
    for i, crank in enumerate(cranks):
        m.revolute(f"A{i}", m.ground, crank.start)
    for i in range(cells):
        bar = m.link(f"bar{i}", (2 * i + 1, 0), (2 * i + 3, 0), mass=1.0)
        m.revolute(f"B{i}", cranks[i].end, bar.start)
        m.revolute(f"C{i}", bar.end, cranks[i + 1].end)
    return m.system("absolute")


CELLS = [2, 14]     # 14 rows, whose matrices may be dense, and 86


@pytest.mark.parametrize("cells", CELLS)
def test_a_start_that_is_inconsistent_names_the_row(cells):
    system = four_bars(cells).system("absolute")
    size = zd.simulate(system, 1e-3, step=1e-3).position_size
    p = system.p0 + 1e-3 * np.random.default_rng(1).normal(size=system.nq)
    worst = int(np.argmax(np.abs(system.evaluate(p, system.v0).Phi) / size))
    with refused("inconsistent-start", f"most in row {worst} '{system.constraints[worst].name}';"):
        zd.simulate(system, 0.1, p, step=0.01)


@pytest.mark.parametrize("cells", CELLS)
def test_redundant_constraints_are_named(cells):
    system = in_line(cells)
    with refused("bifurcation", r"rows \d+ '[ABC]\d+\.[xy]'(, \d+ '[ABC]\d+\.[xy]')* and .* follow") as caught:
        zd.simulate(system, 0.1, step=0.01)
    for row, name in re.findall(r"(\d+) '([ABC]\d+\.[xy])'", str(caught.value)):
        assert system.constraints[int(row)].name == name


def test_what_is_held_is_named():
    system = four_bars(2).system("absolute")
    with pytest.raises(zd.CorrectionFailed, match=r"rows \d+ .*\d+ 'p\[\d+\] is held' .* follow from the others") as caught:
        zd.assemble(system, system.p0 + 0.1 * np.arange(system.nq) ** 2, hold=[each.name for each in system.coordinates])
    assert " 'p[15] is held'" not in str(caught.value)      # there are 15 of them


def test_names_that_are_too_long_are_cut():
    m = zd.Mechanism("long names")
    bar = m.link("bar", (0, 0), (1, 0), mass=1.0)
    m.revolute("long" * 25, m.ground, bar.start)
    system = m.system("absolute")
    with refused("inconsistent-start", r"row 0 '(long){10,15}[long]*';"):
        zd.simulate(system, 0.1, system.p0 + np.array([0.1, 0, 0]), step=0.01)
