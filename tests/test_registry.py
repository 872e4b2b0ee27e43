"""The core's tables, as users read them."""

import zerodrift as zd
from support import SYSTEMS


def test_the_tables_introduce_their_rows():
    for table in (zd.formulations(), zd.integrators(), zd.corrections()):
        assert table
        for name, card in table.items():
            assert card.name == name
            assert card.summary.endswith(".")
            assert card.equations
            assert card.summary in repr(table)
    assert all(card.order >= 1 for card in zd.integrators().values())
    assert set(zd.systems.__all__) == {system.name for system in SYSTEMS.values()}


def test_a_table_handed_out_is_a_copy():
    zd.formulations().clear()
    assert zd.formulations()
