"""The core's tables, as users read them."""

import pytest

import zerodrift as zd
from support import SYSTEMS
from zerodrift._private import gateway

TABLES = ("systems", "formulations", "integrators", "corrections")
CARDS = {f"{table} {card.name}": card for table in TABLES for card in gateway.cards(table)}


@pytest.mark.parametrize("card", CARDS.values(), ids=CARDS)
def test_a_row_introduces_itself(card):
    """In a sentence, in some, and with where it comes from; and there is room for its parameters in the settings of a run."""
    assert card.name.isidentifier()
    for text in (card.summary, card.description):
        assert text.endswith(".")
    assert len(card.description) > len(card.summary)
    assert card.equations
    assert card.reference
    assert not card.reference.endswith(".")
    assert sum(parameter.size for parameter in card.parameters) <= gateway.ROW_VALUES
    assert len({parameter.name for parameter in card.parameters}) == len(card.parameters)


@pytest.mark.parametrize("table", [zd.formulations, zd.integrators, zd.corrections])
def test_the_tables_introduce_their_rows(table):
    assert table()
    for name, card in table().items():
        assert card.name == name
        assert card.summary in repr(table())
        page = " ".join(repr(card).split())
        for text in (name, card.summary, card.description, card.equations, card.reference):
            assert text in page


def test_integrators_say_how_good_they_are():
    assert all(card.order >= 1 for card in zd.integrators().values())


def test_no_two_integrators_have_the_same_colour():
    assert len(set(zd.plot.COLOURS)) == len(zd.plot.COLOURS) >= len(zd.integrators()), "a colour is missing in plot/style.py"


@pytest.mark.parametrize("name", zd.systems.__all__)
def test_systems_are_documented_from_their_cards(name):
    text, card = " ".join(getattr(zd.systems, name).__doc__.split()), CARDS[f"systems {name}"]
    assert name == SYSTEMS[name].name
    for part in (card.summary, card.description, card.equations, card.reference):
        assert part in text


def test_a_table_handed_out_is_a_copy():
    zd.formulations().clear()
    assert zd.formulations()
