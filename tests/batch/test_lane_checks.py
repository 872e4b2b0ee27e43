"""Energy corrections in vector lanes, and what lanes see of steps that resolve too little: as single runs correct, and count."""

import numpy as np
import pytest
import sympy as sp
from sympy.physics.mechanics import dynamicsymbols

import zerodrift as zd
from lanes import ALONE, LANES
from symbolic_counterparts import arm
from zerodrift._private import gateway
from zerodrift.runs.open.diagnosis import unwarned

pytestmark = pytest.mark.skipif(not gateway.has_lanes("baseline"), reason="the compiler has no vectors")
TIMES = np.linspace(0.05, 1.0, 11)
ENERGIES = ("energy_corrections", "energy_skipped")
LOOKS = ("unresolved", "unresolved_time", "part", "stiff")


@pytest.mark.parametrize("options", [
    {"step": 0.02}, {"step": 0.013, "t_eval": TIMES}, {"integrator": "dop853", "rtol": 1e-6, "t_eval": TIMES},
    {"step": 0.02, "energy": zd.EnergyCorrection(every=3)}, {"step": 0.02, "events": zd.Event("alpha1", value=2.0)}],
    ids=["fixed", "within", "chosen", "every third", "events"])
@pytest.mark.parametrize("kind", ["four_bar", "arm"])
def test_energy_is_corrected_as_in_a_single_run(kind, options):
    """That of a driven arm comes in through a constraint, and near rest is too little to scale."""
    system, options = zd.systems.four_bar() if kind == "four_bar" else arm(), {"energy": True} | options
    shares = np.linspace(0.2, 1.5, 9) if kind == "four_bar" else np.ones(9)
    if kind == "arm":
        options.pop("events", None)
    starts = shares[:, None] * system.v0
    with unwarned():
        ens = zd.ensemble(system, 1.0, v0=starts, outputs=[system.coordinates[1].name], threads=1, **options)
        assert (ens._part.paths == LANES).all()
        for run in (0, 5, 8):
            kept, sol = ens[run], zd.simulate(system, 1.0, v0=starts[run], **options)
            events = sum(map(len, sol.t_events or ()))
            for name in ENERGIES:       # what rounding has left nothing of is not counted; single runs keep both sides of events
                assert abs(kept.stats[name] - sol.stats[name]) <= 1 + 2 * events
            assert kept.stats["energy_corrected"] == pytest.approx(sol.stats["energy_corrected"], rel=1e-6, abs=1e-15)
            assert np.array_equal(kept.energy_skipped, sol.energy_skipped)
            for name in ("p", "v", "energy_violation"):
                assert np.abs(getattr(kept, name) - getattr(sol, name)).max() < 1e-10


def test_an_energy_correction_that_follows_nothing_takes_the_matrix_path():
    """Whose speeds lanes do not put back onto the constraints."""
    bar = zd.systems.four_bar()
    ens = zd.ensemble(bar, 0.2, v0=bar.v0[None] * np.ones((3, 1)), step=0.01, stabilization=None, energy=True, threads=1)
    every = zd.ensemble(bar, 0.2, v0=bar.v0[None] * np.ones((3, 1)), step=0.01, energy=zd.EnergyCorrection(every=2),
                        events=zd.Event("alpha1"), threads=1)
    assert (ens._part.paths == ALONE).all()
    assert (every._part.paths == ALONE).all()


@pytest.fixture(scope="module")
def springy():
    """A pendulum with a light mass on a spring, whose frequency and damping vary."""
    x, y, s = dynamicsymbols("x y s")
    g, c, m, d = sp.symbols("g c m d")
    return zd.symbolic([x, y, s], kinetic=(x.diff()**2 + y.diff()**2) / 2 + m * s.diff()**2 / 2, force=[0, 0, -m * d * s.diff()],
                       potential=g * y + m * c**2 * s**2 / 2 + 3 * m * s * x, constraints=[x**2 + y**2 - 1],
                       parameters={g: 9.81, c: 80.0, m: 1e-7, d: 0.0}, p0=[0.6, -0.8, 0.3], v0=[0.0, 0.0, 0.0])


@pytest.mark.parametrize(("options", "name", "values", "count"), [
    ({"step": 0.01}, "c", [5.0, 40.0, 62.0, 90.0, 120.0], "unresolved"),
    ({"integrator": "dormand_prince", "rtol": 1e-4, "atol": 1e-4, "t_eval": [2.0]}, "d", [0.0, 50.0, 400.0, 1600.0], "stiff"),
    ({"integrator": "dop853", "rtol": 1e-3, "atol": 1e-3, "t_eval": [2.0]}, "d", [50.0, 200.0, 1600.0, 3000.0], "stiff")],
    ids=["light", "stiff", "stiff dop853"])
def test_what_single_runs_warn_of_is_seen_in_lanes(springy, options, name, values, count):
    """Counts are those of the single run, though its last digits are others: nothing here is near a limit."""
    with pytest.warns((zd.AccuracyWarning, zd.StabilityWarning), match=r"runs are doubtful"):
        ens = zd.ensemble(springy, 2.0, parameters={name: np.array(values)}, outputs=["x"], threads=1, **options)
    assert (ens._part.paths == LANES).all()
    assert ens.doubtful.any()
    assert not ens.doubtful.all()
    with unwarned():
        for run, value in enumerate(values):
            kept, sol = ens[run], zd.simulate(springy.with_parameters({name: value}), 2.0, **options)
            assert [kept.stats[each] for each in LOOKS] == [sol.stats[each] for each in LOOKS]
            assert kept.stats["part_error"] == pytest.approx(sol.stats["part_error"], rel=1e-6)
            assert (kept.stats[count] > 0) == ens.doubtful[run]


def test_energy_that_is_off_between_the_ends_is_looked_at_again():
    """Such a run is repeated individually: only its samples show whether it deserves a warning, and here its end does not."""
    bar = zd.systems.four_bar()
    options = {"step": 0.04, "integrator": "heun", "stabilization": None}
    with unwarned():
        ens = zd.ensemble(bar, 2.0, v0=np.linspace(0.2, 2, 19)[:, None] * bar.v0, outputs=["alpha1"], threads=1, **options)
        off = [np.abs(ens[run].energy_violation).max() / ens[run].stats["largest_kinetic"] for run in range(19)]
    assert ((np.array(off) > 0.005) <= (ens._part.paths == ALONE)).all()
    assert np.array_equal(ens.doubtful, np.array(off) > 0.005)
