"""Settings classes generated from the core's tables, for all entries and parameters."""

import copy
import dataclasses
import inspect
import pickle

import numpy as np
import pytest

import zerodrift as zd
from support import assert_same_bits, motion, refused

TABLES = {"formulation": zd.formulations(), "integrator": zd.integrators(), "correction": zd.corrections()}
ROWS = [(argument, card) for argument, table in TABLES.items() for card in table.values()]
PARAMETERS = [(card, parameter) for _, card in ROWS for parameter in card.parameters]
all_rows = pytest.mark.parametrize(("argument", "card"), ROWS, ids=[f"{argument} {card.name}" for argument, card in ROWS])
all_parameters = pytest.mark.parametrize(("card", "parameter"), PARAMETERS, ids=[f"{row.name} {p.name}" for row, p in PARAMETERS])

WRONG = {   # by the rule of a parameter: what it cannot be, and what is said of that
    "any": [("1", TypeError, "must be a real number, not '1'"), (np.nan, ValueError, "must be finite, not nan")],
    "positive": [(0.0, ValueError, "must be greater than 0, not 0"), (True, TypeError, "must be a real number, not True")],
    "not negative": [(-1, ValueError, "must be at least 0, not -1"), (np.inf, ValueError, "must be finite, not inf")],
    "choice": [("no word", ValueError, "must be one of '.*', not 'no word'"), (0, ValueError, "must be one of '.*', not 0")],
    "count": [(0, ValueError, "must be between 1 and 2147483647, not 0"), (1.5, TypeError, "must be a whole number, not 1.5")],
    "switch": [(1, TypeError, "must be True or False, not 1"), (None, TypeError, "must be True or False, not None")],
}


def other_value(parameter):
    """A value that the rule of a parameter allows, and that is not its first."""
    match parameter.rule:
        case "choice":
            return parameter.words[-1]
        case "count":
            return int(parameter.initial[0]) + 1
        case "switch":
            return not parameter.initial[0]
    return 1.5 * parameter.initial[0] + 0.125 if parameter.size == 1 else tuple(1.5 * x + 0.125 for x in parameter.initial)


def settings_of(card):
    """Settings of an entry, each with one parameter that differs from its default; combinations that are refused are left out."""
    yield card.settings()
    for parameter in card.parameters:
        try:
            yield card.settings(**{parameter.name: other_value(parameter)})
        except ValueError as clash:
            assert "must be" in str(clash)      # noqa: PT017, as the error is allowed


@all_rows
def test_settings_are_what_the_card_says(argument, card):
    made = card.settings()
    assert [field.name for field in dataclasses.fields(made)] == [parameter.name for parameter in card.parameters]
    assert list(inspect.signature(card.settings).parameters) == [parameter.name for parameter in card.parameters]
    for parameter in card.parameters:
        assert parameter.text
        assert parameter.initial is not None
        assert f"\n{parameter.name} : " in card.settings.__doc__
    assert card.summary in card.settings.__doc__
    for name in [*(parameter.name for parameter in card.parameters), "something"]:
        with pytest.raises((AttributeError, TypeError)):
            setattr(made, name, 1)


@all_parameters
def test_a_parameter_keeps_to_its_rule(card, parameter):
    for value, error, message in WRONG[parameter.rule]:
        with pytest.raises(error, match=rf"^{parameter.name} {message}"):
            card.settings(**{parameter.name: value})


@all_rows
def test_settings_are_values(argument, card):
    """Equal where they say the same; copies and pickles are as good; so is what they are shown as."""
    different = list(settings_of(card))
    for i, made in enumerate(different):
        names = {cls.__name__: cls for cls in {type(made)}}
        for again in (copy.copy(made), copy.deepcopy(made), pickle.loads(pickle.dumps(made)), eval(repr(made), names),
                      dataclasses.replace(made)):
            assert again == made
            assert hash(again) == hash(made)
            assert repr(again) == repr(made)
        assert different.index(made) == i


@all_rows
def test_a_run_takes_settings_and_keeps_them(argument, card, bar, tmp_path):
    """With those that a row has at first, it is the run that its name asks for; and a saved run can be repeated."""
    if argument == "integrator" and card.name not in zd.integrators(bar):
        pytest.skip("takes systems of expressions alone")
    how = {"stabilization": None} if argument == "correction" else {}
    by_name = motion(bar, 0.2, 10, **how, **{argument: card.name})
    for i, made in enumerate(settings_of(card)):
        sol = motion(bar, 0.2, 10, **how, **{argument: made})
        if i == 0:
            assert_same_bits(sol, by_name)
        again = zd.load(sol.save(tmp_path / f"{i}.npz"))
        assert again.settings == sol.settings
        assert_same_bits(zd.simulate(again.system, again.t_span, **again.settings), sol)
        assert card.name in repr(sol) or repr(made) in repr(sol)


def test_several_corrections_are_made_in_the_order_of_the_table(bar):
    named = motion(bar, 1.0, 20, energy=True)
    for given in (["projection", "energy"], [zd.EnergyCorrection(), zd.Projection()], (zd.Projection(), "energy")):
        assert_same_bits(motion(bar, 1.0, 20, stabilization=None, correction=given), named)


def test_what_follows_of_a_step_stands_on_the_page_of_its_row():
    page = repr(zd.corrections()["baumgarte"])
    assert page.startswith("baumgarte: ")
    assert "alpha : float in 1/s, not negative, initially 10.0" in page
    assert "(23)" in page


def test_gains_of_which_the_feedback_is_unstable_are_refused():
    with refused("conflicting-arguments", r"^integral must be less than alpha \* beta = 250, not 250 "):
        zd.Baumgarte(integral=250.0)


def test_settings_of_another_table_are_refused(bar):
    for argument, made in {"formulation": zd.Projection(), "correction": zd.integrators()["rk4"].settings()}.items():
        with pytest.raises((TypeError, ValueError), match=f"^{argument} must be "):
            motion(bar, 0.2, 10, **{argument: made})
