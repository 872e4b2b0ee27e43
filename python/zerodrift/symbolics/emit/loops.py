"""Statements that are alike, written as one loop over tables: where there are thousands, a compiler takes minutes for them.

A statement assigns to an element of an array. Its elements and its numbers are marked in its text; two are alike where the text
around the marks is the same, and the arrays. What a loop assigns to, none of its statements uses.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import groupby

ROWS = 12           # of a table, in a line
MARK = re.compile("\x01(\\w*):([^\x02]*)\x02")
Element = tuple[str, str]       # array and index; no array and a number


def element(array: str, index: int) -> str:
    """An element of an array, marked."""
    return f"\x01{array}:{index}\x02"


def number(text: str) -> str:
    """A number, marked."""
    return f"\x01:{text}\x02"


def plain(text: str) -> str:
    """C text of a statement whose marks are replaced by array elements and numbers."""
    return MARK.sub(lambda mark: f"{mark[1]}[{mark[2]}]" if mark[1] else mark[2], text)


def rolled(statements: list[str], least: int) -> list[str]:
    """C for statements one after the other, in loops of `least` or more.

    A mark (`MARK`) stands for an index that a loop can run over. Statements without marks keep their place.
    """
    items: list[str] = []
    for has_marks, group in groupby(statements, key=lambda statement: "\x01" in statement):
        run = list(group)
        items += _in_loops(run, least) if has_marks else run
    return items


def _in_loops(statements: list[str], least: int) -> Iterator[str]:
    groups: dict[tuple[int, str], list[list[Element]]] = {}
    levels: dict[Element, int] = {}     # how many statements one after the other lead to an element
    for statement in statements:
        elements = MARK.findall(statement)
        level = levels[elements[0]] = 1 + max((levels.get(each, 0) for each in elements[1:]), default=0)
        groups.setdefault((level, MARK.sub("\x01\\1\x02", statement)), []).append(elements)
    for (_, skeleton), alike in sorted(groups.items(), key=lambda item: item[0][0]):
        if len(alike) >= least:
            yield _loop(skeleton, alike)
        else:
            yield from (_filled(skeleton, [f"{array}[{index}]" if array else index for array, index in elements])
                        for elements in alike)


def _filled(skeleton: str, texts: list[str]) -> str:
    remaining = iter(texts)
    return re.sub("\x01\\w*\x02", lambda mark: next(remaining), skeleton)


def _loop(skeleton: str, alike: list[list[Element]]) -> str:
    """A loop over statements that are alike, in a block with its tables."""
    indices: list[tuple[str, ...]] = []
    numbers: list[tuple[str, ...]] = []
    texts = []
    for slot in zip(*alike, strict=True):
        array, values = slot[0][0], tuple(value for _, value in slot)
        if len(set(values)) == 1:
            texts.append(f"{array}[{values[0]}]" if array else values[0])
        elif not array:
            texts.append(f"number[i][{len(numbers)}]")
            numbers.append(values)
        elif all(int(value) == int(values[0]) + i for i, value in enumerate(values)):
            texts.append(f"{array}[{values[0]} + i]" if int(values[0]) else f"{array}[i]")
        else:
            texts.append(f"{array}[at[i][{len(indices)}]]")
            indices.append(values)
    longest = max((int(value) for values in indices for value in values), default=0)
    tables = [*_table("unsigned short" if longest < 1 << 16 else "unsigned", "at", indices), *_table("double", "number", numbers)]
    loop = [f"for (int i = 0; i < {len(alike)}; i++)", f"    {_filled(skeleton, texts)}"]
    return "\n".join(["{", *(f"    {line}" for line in [*tables, *loop]), "}"] if tables else loop)


def _table(kind: str, name: str, columns: list[tuple[str, ...]]) -> list[str]:
    if not columns:
        return []
    rows = [f"{{{', '.join(row)}}}" for row in zip(*columns, strict=True)]
    lines = [f"    {', '.join(rows[i : i + ROWS])}," for i in range(0, len(rows), ROWS)]
    return [f"static const {kind} {name}[{len(rows)}][{len(columns)}] = {{", *lines, "};"]
