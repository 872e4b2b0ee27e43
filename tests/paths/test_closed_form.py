"""Steps on the closed-form path agree with those on the matrix path to rounding, which repeats doubtful ones."""

import functools

import numpy as np
import pytest

import energy_models
import symbolic_counterparts
import tolerances as tol
import zerodrift as zd
from native_systems import needs_compiler
from random_symbolic import random_system
from support import INTEGRATORS, assert_close, refused
from zerodrift._private import gateway
from zerodrift._private.core import ffi
from zerodrift.runs.arguments.settings import VECTOR_UNITS

sp = pytest.importorskip("sympy")
pytestmark = needs_compiler
SPAN = 0.5      # s


@functools.cache
def system(name):
    return getattr(symbolic_counterparts, name)()


SYSTEMS = ["four_bar", "arm", "chaplygin_sleigh", "rolling_disc"]
DEPENDENT = ["augmented", "nullspace", "schur"]
COLUMNS = ("p", "v", "multipliers", "position_violation", "velocity_violation", "kinetic_energy", "potential_energy",
           "energy_input", "energy_violation")
STABILIZATIONS = {
    "none": None, "projection": zd.Projection(), "seldom": zd.Projection(every=3), "positions": zd.Projection(velocities=False),
    "velocities": zd.Projection(positions=False),
    "identity": zd.Projection(metric="identity"),
    "baumgarte": zd.Baumgarte(), "integral": zd.Baumgarte(integral=20.0),
}


def both(moving, span=SPAN, **options):
    """The motion along the matrix path and along the direct one."""
    return [zd.simulate(moving, span, closed_form=closed_form, on_failure="return", **options) for closed_form in (False, None)]


def assert_same_motion(general, closed_form, error=tol.STEPPED):
    assert general.stats["closed_form_steps"] == 0
    assert closed_form.stats["closed_form_steps"] == closed_form.stats["steps"] == general.stats["steps"]
    for name in COLUMNS:
        a, b = getattr(general, name), getattr(closed_form, name)
        if a is not None and a.size:
            allowed = (100 if name == "multipliers" else 1) * error * max(1.0, np.abs(a).max())
            assert np.abs(b - a).max() <= allowed, name


@pytest.mark.parametrize("stabilization", STABILIZATIONS)
@pytest.mark.parametrize("name", SYSTEMS)
def test_both_paths_lead_to_the_same_place(name, stabilization):
    options = {"step": 0.01, "stabilization": STABILIZATIONS[stabilization]}
    if stabilization == "projection" and name != "arm":     # all of whose motion is enforced
        options["energy"] = True
    assert_same_motion(*both(system(name), **options))


@pytest.mark.parametrize("equations", DEPENDENT)
@pytest.mark.parametrize("name", SYSTEMS)
def test_all_dependent_formulations_take_it(name, equations):
    assert_same_motion(*both(system(name), step=0.01, formulation=equations))


@pytest.mark.parametrize("method", [name for name in INTEGRATORS if zd.integrators()[name].stability and name != "rattle"])
def test_integrators_take_it(method):
    assert_same_motion(*both(system("arm"), step=0.01, integrator=method))


def test_steps_that_are_chosen_take_it():
    general, closed_form = both(system("four_bar"), rtol=1e-9, atol=1e-9, integrator="dop853", t_eval=np.linspace(0, SPAN, 7))
    assert closed_form.stats["closed_form_steps"] == closed_form.stats["steps"]
    assert_close(closed_form.p, general.p, 1e-8)     # what the tolerance leaves, as rounding may choose other steps
    assert closed_form.stats["factorizations"] < 5


@pytest.mark.parametrize(("name", "options"), [
    ("rolling_disc", {"formulation": "independent"}), ("knife_edge", {"formulation": "mixed"}),
    ("four_bar", {"integrator": "rattle"}), ("four_bar", {"integrator": "trapezoidal"}), ("four_bar", {"closed_form": False}),
], ids=str)
def test_what_it_does_not_serve_takes_the_matrix_path(name, options, tmp_path):
    """Such as systems with a kinematic matrix, or with a complement of their own."""
    sol = zd.simulate(zd.systems.knife_edge() if name == "knife_edge" else system(name), 0.1, step=0.01, **options)
    assert sol.stats["closed_form_steps"] == 0
    assert sol.settings["vector"] is None
    (name, value), = options.items()
    why = f"{name} {value!r} has none{' for such a system' * (name == 'formulation')}" if value else "closed_form=False"
    assert f"\n  evaluation  matrices, no closed form: {why}\n" in repr(sol)
    assert sol.stats["matrix_path_reason"] == why
    loaded = zd.load(sol.save(tmp_path / "motion"))
    assert repr(loaded) == repr(sol)
    assert loaded.stats == sol.stats


def test_an_unknown_name_of_a_statistic_is_refused():
    sol = zd.simulate(system("four_bar"), 0.1, step=0.01)
    with refused("wrong-name"):
        sol.stats["road"]


def test_redundant_constraints_take_the_matrix_path():
    """Orders are written for rows that are independent around the start, and these are not where the run starts."""
    x, y, z, vx, vy, vz = sp.symbols("x y z vx vy vz")
    made = zd.symbolic([x, y, z], speeds=[vx, vy, vz], kinetic=(vx**2 + vy**2 + vz**2) / 2, potential=10 * y,
                       constraints=[x + y, x + sp.Symbol("a") * y + z * sp.Symbol("b")], parameters={"a": 1.0, "b": 1.0},
                       p0=[0.0, 0.0, 0.0], v0=[0.0, 0.0, 0.0])
    assert zd.simulate(made, 0.1, step=0.01).stats["closed_form_steps"] == 10
    sol = zd.simulate(made.with_parameters(b=0.0), 0.1, step=0.01)
    assert sol.stats["rank"] == 1
    assert sol.stats["closed_form_steps"] == 0
    assert "no closed form: some constraints are redundant" in repr(sol)


def test_values_between_steps_are_those_of_shorter_steps():
    sol = zd.simulate(system("four_bar"), SPAN, step=0.01)
    p, v = sol(0.123)
    again = zd.simulate(system("four_bar"), SPAN, step=0.01, t_eval=[0.123])
    assert (p == again.p[0]).all()
    assert (v == again.v[0]).all()


def test_repeated_to_the_last_bit():
    first, second = (zd.simulate(system("arm"), SPAN, step=0.01) for _ in range(2))
    assert (first.p == second.p).all()
    assert (zd.simulate(first.system, first.t_span, **first.settings).p == first.p).all()


@pytest.mark.parametrize("value", [True, 1, "no"])
def test_only_none_and_false_are_known(value):
    with refused("wrong-value", r"^closed_form must be None, which uses closed-form functions, or False, not "):
        zd.simulate(system("four_bar"), 0.1, step=0.01, closed_form=value)


# ---- formulations in independent velocities ----

INDEPENDENT = ["mixed", "independent"]
MOVING = {"four_bar": 1.0, "arm": 1.0, "chaplygin_sleigh": 1.0, "rolling_disc": 1.0, 2: 0.5, 4: 0.5}      # s


@functools.cache
def moving(name):
    return system(name) if isinstance(name, str) else random_system(name)


@pytest.mark.parametrize("stabilization", ["none", "projection", "seldom", "identity", "baumgarte", "integral"])
@pytest.mark.parametrize("equations", INDEPENDENT)
@pytest.mark.parametrize("name", MOVING)
def test_both_paths_integrate_the_same_independent_velocities(name, equations, stabilization):
    """And choose others at the same steps, each of which the matrix path makes."""
    options = {"step": 0.01, "stabilization": STABILIZATIONS[stabilization], "formulation": equations}
    if stabilization == "projection" and name not in ("arm", 4):     # where all motion is enforced, or nearly
        options["energy"] = True
    of = moving(name)
    general, closed_form = both(of, MOVING[name], **options)
    if equations == "independent" and (of.mh * of.mn or of.evaluate().A is not None):
        assert closed_form.stats["closed_form_steps"] == 0
    else:
        assert_same_motion_but_where_it_is_left(general, closed_form)


def assert_same_motion_but_where_it_is_left(general, closed_form):
    assert closed_form.status == general.status
    assert closed_form.stats["repartitions"] == general.stats["repartitions"]
    left = closed_form.stats["steps"] - closed_form.stats["closed_form_steps"]
    assert 0 <= left <= max(closed_form.stats["repartitions"], 0.1 * closed_form.stats["steps"])
    closed_form.stats["closed_form_steps"] += left
    assert_same_motion(general, closed_form, 10 * tol.STEPPED)


def test_where_neither_order_nor_choice_lasts_the_matrix_path_does():
    """A chain of seven links between two points has fifteen choices, and orders for four."""
    chain = energy_models.closed_pendulum(6)
    for equations in INDEPENDENT:
        general, closed_form = both(chain, 1.0, step=0.005, formulation=equations)
        assert 0 < closed_form.stats["closed_form_steps"] < closed_form.stats["steps"]
        assert closed_form.stats["repartitions"] == general.stats["repartitions"] > 2
        assert_close(closed_form.p, general.p, 1e-10)


@pytest.mark.parametrize("equations", INDEPENDENT)
def test_independent_velocities_between_steps_and_again(equations):
    options = {"formulation": equations, "step": 0.01}
    sol = zd.simulate(system("four_bar"), SPAN, **options)
    again = zd.simulate(system("four_bar"), SPAN, t_eval=[0.123, 0.3], **options)
    assert again.stats["closed_form_steps"] == again.stats["steps"]
    assert (again.p[1] == sol.p[30]).all()
    p, v = sol(0.123)       # by a shorter step in velocities that are chosen there: here the same
    assert (p == again.p[0]).all()
    assert (v == again.v[0]).all()
    repeated = zd.simulate(sol.system, sol.t_span, **sol.settings)
    assert (repeated.p == sol.p).all()


@pytest.mark.parametrize("equations", INDEPENDENT)
def test_steps_that_are_chosen_take_independent_velocities(equations):
    """Rejected ones, too: these go back to where they began, in the same velocities."""
    options = {"rtol": 1e-9, "atol": 1e-9, "integrator": "dop853", "first_step": 0.3, "formulation": equations}
    general, closed_form = both(system("four_bar"), 4.0, **options)
    assert closed_form.stats["rejected"]
    assert closed_form.stats["closed_form_steps"] > 0.9 * closed_form.stats["steps"]
    assert_close(closed_form.p[-1], general.p[-1], 1e-6)


# ---- random rows that depend on each other, nearly or not at all ----


@functools.cache
def with_a_row_apart(seed, apart):
    """Orders are written for rows that are as far apart as others; it starts with velocities that satisfy them."""
    made = random_system(seed, 1.0) if apart == 1 else with_a_row_apart(seed, 1.0).with_parameters(apart=apart)
    evaluation = made.evaluate(made.p0, np.zeros(made.nv))
    rates = np.zeros(len(evaluation.C)) if evaluation.Phi_t is None else evaluation.Phi_t
    return made.starting(v0=-np.linalg.pinv(evaluation.C) @ rates)


@pytest.mark.parametrize("apart", [1.0, 0.1, 1e-3, 0.0])
@pytest.mark.parametrize("equations", [*DEPENDENT, *INDEPENDENT])
@pytest.mark.parametrize("seed", [0, 18, 20])       # driven, with a nonholonomic row and one held by time; one; the other
def test_both_paths_agree_however_far_rows_are_apart(seed, equations, apart):
    """Constraints that are equal, or nearly equal, are ranked on the matrix path."""
    of = with_a_row_apart(seed, apart)
    general, closed_form = both(of, 0.3, step=0.01, formulation=equations)
    assert general.success
    assert closed_form.stats["rank"] == general.stats["rank"] == len(of.constraints) - (apart == 0)
    if apart <= 1e-3 or (equations == "independent" and of.mh * of.mn):
        assert closed_form.stats["closed_form_steps"] == 0
    elif apart == 1:
        assert closed_form.stats["closed_form_steps"] == closed_form.stats["steps"]
    closed_form.stats["closed_form_steps"] = closed_form.stats["steps"]
    assert_same_motion(general, closed_form, tol.STEPPED / max(apart, 1e-3) ** 2)


# ---- where it is left ----


def bar(lengths=(0.3, 1.0, 0.6, 1.0), gravity=9.81, rate=1.0):
    """The symbolic four-bar with other links, at its start where the crank is upright."""
    l1, l2, l3, l0 = lengths
    core = zd.systems.four_bar(lengths=(l0, l1, l2, l3), gravity=gravity, crank_rate=rate)
    return system("four_bar").with_parameters(l1=l1, l2=l2, l3=l3, l0=l0, g=gravity).starting(core.p0, core.v0)


NEAR = {"parallelogram": (0.3, 1.0, 0.3, 1.0), "nearly": (0.3, 1.0, 0.3 + 1e-9, 1.0), "near": (0.3, 1.0, 0.3 + 1e-5, 1.0),
        "next to one": (0.3, 1.0, 0.3 + 1e-3, 1.0)}


@pytest.mark.parametrize("options", [{"step": 1 / 100}, {"step": 1 / 137}, {"rtol": 1e-9, "integrator": "dop853"}], ids=str)
@pytest.mark.parametrize("on_singular", ["stop", "continue"])
@pytest.mark.parametrize("name", NEAR)
def test_bifurcations_are_judged_alike(name, on_singular, options):
    """A turn of a crank, flat at a quarter and at three quarters of it or nearly so."""
    general, closed_form = both(bar(NEAR[name], 0.0, 2 * np.pi), 1.0, on_singular=on_singular, **options)
    assert closed_form.success == general.success
    if not general.success:     # so near to it, rounding decides which of two sentences says so
        errors = {zd.ZerodriftError, type(gateway.error_of(general.status, "")), type(gateway.error_of(closed_form.status, ""))}
        assert errors <= {zd.ZerodriftError, zd.Bifurcation, zd.BranchJump}
        assert abs(closed_form.t[-1] - general.t[-1]) < 0.02
    left = closed_form.stats["steps"] - closed_form.stats["closed_form_steps"]
    if name != "next to one" and closed_form.success:
        assert left
        assert f"closed form ({left} of {closed_form.stats['steps']} steps by matrices)" in repr(closed_form)
    if "step" in options:
        assert closed_form.stats["rank_drops"] == general.stats["rank_drops"]
        assert_close(closed_form.p, general.p, 1e-7)     # near a bifurcation, rounding is divided by the relative pivot


@pytest.mark.parametrize("equations", INDEPENDENT)
@pytest.mark.parametrize("name", ["parallelogram", "nearly", "near"])
def test_bifurcations_are_judged_alike_in_independent_velocities(name, equations):
    """The next to one is too hard for such steps in these: on both paths, the energy is off by a fifth of the kinetic energy."""
    general, closed_form = both(bar(NEAR[name], 0.0, 2 * np.pi), 1.0, step=1 / 137, on_singular="continue", formulation=equations)
    assert closed_form.success == general.success == (name != "nearly")
    assert closed_form.stats["repartitions"] == general.stats["repartitions"]
    assert closed_form.stats["closed_form_steps"] < closed_form.stats["steps"]
    assert abs(closed_form.t[-1] - general.t[-1]) < 0.02
    assert_close(closed_form.p, general.p[:len(closed_form.p)], 1e-6)


def test_a_step_too_long_to_be_known_from_its_ends_leaves_it():
    general, closed_form = both(bar(rate=30.0), 1.0, step=0.05)      # more than a radian in each
    assert closed_form.status == general.status
    assert closed_form.stats["closed_form_steps"] < closed_form.stats["steps"]


def test_a_low_inertia_component_that_its_coupling_makes_singular_leaves_it():
    """D^T M D loses all but 1e-8 of a pivot."""
    x, y, vx, vy, share = sp.symbols("x y vx vy share")
    made = zd.symbolic([x, y], speeds=[vx, vy], kinetic=(vx**2 + vy**2) / 2 + (1 - share) * vx * vy, potential=x**2 + y**2,
                       parameters={share: 0.5}, p0=[1.0, 0.0], v0=[0.0, 0.0])
    assert zd.simulate(made, 0.1, step=0.01).stats["closed_form_steps"] == 10
    assert zd.simulate(made.with_parameters(share=1e-8), 0.1, step=1e-5).stats["closed_form_steps"] == 0


class Failing:
    """The four-bar, one of whose closed-form functions does not know from a time on; or only then."""

    def __init__(self, member, fails):
        embeds, functions = member == "embed", system("four_bar")._closed_form
        functions = functions.embedding if embeds else functions
        self.core = system("four_bar")._closed_form_core(embeds=embeds)
        closed_form = self.core.c.closed_form[0]
        order = (closed_form.embedding if embeds else closed_form.order)[0]
        self.order = ffi.new("zd_elimination[1]", [order])
        inner = getattr(order, member)

        def function(order, data, inputs, t, *rest):
            return fails(t[0]) or inner(order, data, inputs, t, *rest)

        self.function = ffi.callback(dict(ffi.typeof("zd_elimination").fields)[member].type, function)
        if member == "correct":     # which is called without finish()
            self.order[0].finish = ffi.NULL
        setattr(self.order[0], member, self.function)
        orders = {"embeddings": 1, "embedding": self.order} if embeds else {"orders": 1, "order": self.order}
        self.closed_form = ffi.new("zd_closed_form[1]", [{"lanes": 1} | orders])
        self.system = system("four_bar").starting()
        address = int(ffi.cast("intptr_t", self.closed_form))
        data = self.system._with_closed_form_data(functions.library(), functions)
        made = self.core.with_closed_form(address, data, self)
        self.system._with_closed_form = dict.fromkeys([(vector, embeds) for vector in VECTOR_UNITS], made)


@pytest.mark.parametrize("options", [
    {"step": 0.01}, {"step": 0.01, "t_eval": [0.103, 0.3]}, {"rtol": 1e-8, "integrator": "dop853"}], ids=str)
@pytest.mark.parametrize(("member", "given"), [
    ("accelerate", {}), ("correct", {}), ("finish", {}), *(("embed", {"formulation": name}) for name in INDEPENDENT)])
def test_functions_that_do_not_know_are_done_without(member, given, options):
    options = options | given
    failing = Failing(member, lambda t: 0.1 < t < 0.2)
    sol = zd.simulate(failing.system, 0.4, **options)
    assert 0 < sol.stats["closed_form_steps"] < sol.stats["steps"]
    general = zd.simulate(failing.system, 0.4, closed_form=False, **options)
    assert sol.stats["steps"] == general.stats["steps"]
    assert_close(sol.p, general.p, tol.STEPPED if "step" in options else 1e-7)     # rounding may choose other steps
    assert_close(sol.multipliers[-1], general.multipliers[-1], 1e-6)


@pytest.mark.parametrize("member", ["correct", "finish"])
def test_a_single_step_does_without_them_too(member):
    failing = Failing(member, lambda t: t > 0.105)
    sol = zd.simulate(system("four_bar"), 0.2, step=0.01)
    other = zd.simulate(failing.system, 0.2, step=0.01)
    assert other.stats["closed_form_steps"] == 10
    assert_close(other(0.115)[0], sol(0.115)[0], tol.STEPPED)


def test_a_value_between_steps_does_without_them_too():
    """Neither the polynomial's value nor the shorter step can be landed: so it is made on the matrix path."""
    options = {"integrator": "dop853", "rtol": 1e-8, "t_eval": [0.1, 0.115, 0.2]}
    sol = zd.simulate(Failing("finish", lambda t: t == 0.115).system, 0.2, **options)
    assert sol.stats["closed_form_steps"] == sol.stats["steps"]
    knowing = zd.simulate(system("four_bar"), 0.2, **options)
    assert_close(sol.p, knowing.p, 1e-7)
    assert_close(sol.p[2], knowing.p[2], tol.STEPPED)       # the run goes on from where it was; accelerations there are made anew


def test_perturbed_systems_have_none():
    core = gateway.perturbed(system("four_bar")._closed_form_core(), 1e-8, 1)
    assert core.c.closed_forms == 0


@pytest.mark.parametrize(("model", "why"), [("four_bar", True), ("chain", False)])
def test_interpreted_tables_are_named(model, why):
    """A mechanism says that code may be generated for it, where that is known to pay."""
    interpreted = zd.simulate(getattr(zd.models, model)(), 1e-3, step=1e-3).stats["interpreted"]
    assert ("compiled=True" in (interpreted or "")) is why
