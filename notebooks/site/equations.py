"""Equations of the site as MathML, and films of stored outputs: made when it is built, they need no network and can be read aloud."""

from __future__ import annotations

import html
import re

from docutils import nodes
from latex2mathml.converter import convert


def mathml(text: str, display: str = "inline") -> str:
    """An equation, whose matrices have a class: the style draws their brackets, as fonts without a table of mathematics do not
    stretch them.
    """
    return re.sub(r"<mo[^>]*>&#x0005B;</mo>(<mtable.*?</mtable>)<mo[^>]*>&#x0005D;</mo>",
                  r'<mrow class="matrix"><mo>[</mo>\1<mo>]</mo></mrow>', convert(text, display=display))


VECTORS = "pvuwqgMdfCADξΦΨλγμδ"       # and matrices of the page that explains a step; E is an index of a scalar
STARTS = (("a", 0x1D482), ("A", 0x1D468), ("α", 0x1D736), ("Α", 0x1D71C))      # first letters, and those in bold italics


def bold(page: str, equation: str) -> str:
    """An equation with vectors and matrices in bold, on the page that explains a step."""
    def letter(found: re.Match[str]) -> str:
        known = html.unescape(found[1])
        if known not in VECTORS:
            return found[0]
        first, start = max((each for each in STARTS if each[0] <= known), key=lambda each: each[0])
        return f"<mi>{chr(start + ord(known) - ord(first))}</mi>"

    return re.sub(r"<mi>([^<]*)</mi>(?!<mi>E)", letter, equation) if page == "theory/computation" else equation


def inline(writer: object, node: nodes.math) -> None:
    """An equation within a line."""
    writer.body.append(bold(writer.builder.current_docname, mathml(node.astext())))
    raise nodes.SkipNode


def block(writer: object, node: nodes.math_block) -> None:
    """An equation of its own, a target of links where it is labelled or has a number, `\\tag{8}`."""
    for name in node.get("ids", []):
        writer.body.append(f'<span id="{name}"></span>')
    text, number = re.subn(r"\s*\\tag\{([^}]*)\}", "", node.astext()), re.search(r"\\tag\{([^}]*)\}", node.astext())
    target = f'<a class="number" id="equation-{number[1]}" href="#equation-{number[1]}">({number[1]})</a>' if number else ""
    writer.body.append(f'<div class="equation">{bold(writer.builder.current_docname, mathml(text[0], display="block"))}{target}</div>')
    raise nodes.SkipNode


def offline(app: object, doctree: nodes.document) -> None:
    """Matplotlib's films in stored outputs: icons from the theme instead of another site, and a text alternative."""
    for each in doctree.findall(nodes.raw):
        text = re.sub(r'<link rel="stylesheet"\s+href="https://maxcdn[^>]*>', "", each.astext())
        text = re.sub(r'<img id="_anim_img', '<img alt="film of the motion" id="_anim_img', text)
        text = re.sub(r'<input id="_anim_slider', '<input aria-label="Time" id="_anim_slider', text)
        if text != each.astext():
            each.children = [nodes.Text(text)]
            each.rawsource = text
