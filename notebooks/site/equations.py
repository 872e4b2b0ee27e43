"""Equations of the site as MathML, and films of stored outputs: made when it is built, they need no network and can be read aloud."""

from __future__ import annotations

import re

from docutils import nodes
from latex2mathml.converter import convert


def mathml(text: str, display: str = "inline") -> str:
    """An equation, whose matrices have a class: the style draws their brackets, as fonts without a table of mathematics do not
    stretch them.
    """
    return re.sub(r"<mo[^>]*>&#x0005B;</mo>(<mtable.*?</mtable>)<mo[^>]*>&#x0005D;</mo>",
                  r'<mrow class="matrix"><mo>[</mo>\1<mo>]</mo></mrow>', convert(text, display=display))


def inline(writer: object, node: nodes.math) -> None:
    """An equation within a line."""
    writer.body.append(mathml(node.astext()))
    raise nodes.SkipNode


def block(writer: object, node: nodes.math_block) -> None:
    """An equation of its own, a target of links where it is labelled or has a number, `\\tag{8}`."""
    for name in node.get("ids", []):
        writer.body.append(f'<span id="{name}"></span>')
    text, number = re.subn(r"\s*\\tag\{([^}]*)\}", "", node.astext()), re.search(r"\\tag\{([^}]*)\}", node.astext())
    target = f'<a class="number" id="equation-{number[1]}" href="#equation-{number[1]}">({number[1]})</a>' if number else ""
    writer.body.append(f'<div class="equation">{mathml(text[0], display="block")}{target}</div>')
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
