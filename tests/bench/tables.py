"""Tables of the pages in questions/, from the files in results/: ``python tests/bench/tables.py`` writes them anew.

A table stands between ``<!-- results/NAME.csv -->`` and ``<!-- end -->``. Words after the name, with commas, select the lines
with any of them: ``<!-- results/peers_ratios.csv | best -->``.
"""

import csv
import re
from pathlib import Path

BENCH = Path(__file__).resolve().parent
PAGES = sorted((BENCH / "questions").glob("*.md"))
TABLE = re.compile(r"(<!-- (results/\w+\.csv)(?: \| ([^\n]*?))? -->\n).*?(<!-- end -->)", re.DOTALL)


def table(name, words):
    """Lines of a file of results as a table in Markdown."""
    with (BENCH / name).open(newline="", encoding="utf-8") as file:
        header, *lines = csv.reader(file)
    selected = [line for line in lines if not words or any(word in " ".join(line) for word in words.split(", "))]
    cells = [header, ["---"] * len(header), *([("-" if cell == "nan" else cell) for cell in line] for line in selected)]
    return "".join(f"| {' | '.join(line)} |\n" for line in cells)


def with_tables(text):
    """The page with all its tables written anew."""
    return TABLE.sub(lambda found: f"{found[1]}{table(found[2], found[3])}{found[4]}", text)


if __name__ == "__main__":
    for page in PAGES:
        page.write_text(with_tables(page.read_text(encoding="utf-8")), encoding="utf-8")
