"""Causes and cures of errors and warnings, by their code: ``python -m zerodrift explain branch-jump``."""

from __future__ import annotations

import difflib
import inspect
import textwrap
from dataclasses import dataclass
from importlib import resources

from . import errors
from ._private.gateway.base import statuses
from .errors import WrongValue


@dataclass(frozen=True)
class Explanation:
    """Text of one code.

    Attributes
    ----------
    causes, cures : tuple of str
        Short sentences, the most frequent first.
    snippet : str
        Python that provokes it, after ``import zerodrift as zd``; empty where it needs more than a few lines.
    """

    causes: tuple[str, ...]
    cures: tuple[str, ...]
    snippet: str = ""


def explanations() -> dict[str, Explanation]:
    """All of them by code, from the file beside this one."""
    text = resources.files(__package__).joinpath("explanations.md").read_text(encoding="utf-8")
    return dict(map(_section, text.split("\n## ")[1:]))


def _section(text: str) -> tuple[str, Explanation]:
    """Code and explanation of one section of the file."""
    code, _, rest = text.partition("\n")
    prose, _, snippet = rest.partition("```python\n")
    causes, cures = (tuple(" ".join(each.split()) for each in ("\n" + part).split("\n* ")[1:])
                     for part in prose.removeprefix("\nCauses:\n").split("\nCures:\n"))
    return code, Explanation(causes, cures, snippet.partition("\n```")[0])


def classes() -> dict[str, type[BaseException]]:
    """Errors and warnings of the package by code."""
    return {each.code: each for each in vars(errors).values()
            if inspect.isclass(each) and issubclass(each, errors._Coded) and "code" in vars(each)}


def codes() -> dict[str, tuple[type[BaseException], str]]:
    """Exception and meaning of each code: of exceptions, of the rules that arguments must keep, and of the core's statuses of
    which several raise the same exception.
    """
    found = {code: (each, " ".join(inspect.cleandoc(each.__doc__ or "").split("\n\n")[0].split()))
             for code, each in classes().items()}
    of_arguments = {code: (errors.WrongArgument, meaning) for code, meaning in errors.OF_ARGUMENTS.items()}
    of_status = {row.code: (getattr(errors, row.error), f"{row.sentence[0].upper()}{row.sentence[1:]}.")
                 for row in statuses() if row.code and row.code not in found}
    return {code: {**found, **of_arguments, **of_status}[code] for code in explanations()}


def explain(code: str) -> str:
    """Meaning, causes and cures of a code, as plain text.

    Raises
    ------
    ValueError
        If there is no such code; the message has the closest.
    """
    code = code.strip().removeprefix("[").removesuffix("]").removeprefix("zd:")
    known = codes()
    if code not in known:
        near = difflib.get_close_matches(code, known, n=3, cutoff=0.4) or sorted(known)
        raise WrongValue(f"code must be one of the package, not {code!r}; the closest are {', '.join(near)}", "wrong-name")
    found = explanations()[code]
    kind, meaning = known[code]
    parts = [f"{code} ({kind.__name__})", *_wrapped(meaning, "")]
    for title, sentences in (("Causes", found.causes), ("Cures", found.cures)):
        parts += ["", title, *(line for each in sentences for line in _wrapped(each, "  "))]
    if found.snippet:
        parts += ["", "Example that provokes it", "", textwrap.indent(found.snippet, "    ")]
    return "\n".join(parts)


def _wrapped(sentence: str, indent: str) -> list[str]:
    return textwrap.wrap(sentence, 96, initial_indent=indent and "  - ", subsequent_indent=indent and "    ")
