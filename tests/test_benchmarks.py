"""Pages of the benchmarks: one per question, with a claim, a command, and tables that equal the files of results."""

import re
import runpy

import pytest

from support import ROOT

BENCH = ROOT / "tests" / "bench"
if not BENCH.exists():
    pytest.skip("the benchmarks are not in the source distribution", allow_module_level=True)
TABLES = runpy.run_path(str(BENCH / "tables.py"))
PAGES = {page.stem: page.read_text(encoding="utf-8") for page in TABLES["PAGES"]}


@pytest.mark.parametrize("page", PAGES)
def test_tables_are_those_of_the_results(page):
    assert TABLES["with_tables"](PAGES[page]) == PAGES[page]
    assert not re.search(r"^\|", TABLES["TABLE"].sub("", PAGES[page]), re.MULTILINE)      # no table is written by hand


@pytest.mark.parametrize("page", PAGES)
def test_each_page_has_a_question_a_claim_a_command_and_a_date(page):
    assert re.match(r"# [^\n]*\?\n\n\*\*Claim\.\*\* ", PAGES[page])
    assert "**Command.** " in PAGES[page]
    assert re.search(r"\*\*Measured\.\*\* .*202\d", PAGES[page], re.DOTALL)


def test_the_index_names_each_page_and_its_question():
    listed = re.findall(r"\[([^\]]*)\]\(questions/(\w+)\.md\)", (BENCH / "README.md").read_text(encoding="utf-8"))
    assert sorted(listed) == sorted((text.split("\n")[0][2:], page) for page, text in PAGES.items())


def test_each_file_of_results_has_a_page():
    named = re.findall(r"(\w+)\.(?:csv|md|png)\b", "".join(PAGES.values()))
    assert {path.stem for path in (BENCH / "results").iterdir()} - set(named) <= {"mutations", "other_machines"}


def test_words_select_lines():
    selected = TABLES["table"]("results/peers_ratios.csv", "best of SciPy, best of MuJoCo").splitlines()
    assert len(selected) == 2 + 2 * 4
    assert "best of Exudyn" not in "".join(selected)
