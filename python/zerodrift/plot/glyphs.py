"""Symbols of the parts of planar mechanisms: a function for each kind of shape, which returns its lines and areas.

`size` is the radius of a pin in m. Bodies are light with a dark outline, the ground is hatched, pins are white, and all else is
black, white and grey, so that no information is in a colour alone.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..systems.shapes import DIRECTED, Shape
from .marks import (
    BODY,
    CHAIN,
    DARK,
    DASHED,
    EDGE,
    GREY,
    LOAD,
    PLATE,
    SMOOTH,
    TINT,
    WHITE,
    Mark,
    across,
    arc,
    area,
    arrow,
    box,
    circle,
    hatched,
    hull,
    line,
    lines,
    rim,
    rounded,
    turning_arrow,
    unit,
)

COILS = 6           # of a spring
BAR, SLOTTED = 1.5, 2.9     # half the width of a link, in sizes
BLOCK = 2.8, 1.7    # half the length and half the width of a slider
HALF_GROOVE = 1.6   # half the width of a groove
BESIDE = 2.3        # how far a spring and a damper that belong together are from their middle


# ---- bodies ----


def link(shape: Shape, size: float) -> list[Mark]:
    """Body with points (n, 2): a bar if they are collinear, otherwise a plate; `number` grooves widen it."""
    outline = rounded(shape.points, (SLOTTED if shape.number else BAR) * size)
    return [area(outline, face=BODY if len(hull(shape.points)) < 3 else PLATE, edge=EDGE, width=1.2)]


def disc(shape: Shape, size: float) -> list[Mark]:
    """Body with one known point, and a direction fixed in the body."""
    centre, spoke = shape.points
    return [circle(centre, 4.0 * size, face=BODY, edge=EDGE),
            line([centre, centre + 4.0 * size * spoke], edge=EDGE, width=1.0)]


def particle(shape: Shape, size: float) -> list[Mark]:
    """Point mass."""
    return [circle(shape.points[0], 2.0 * size, face=EDGE, edge=DARK, width=0.8)]


def mark(shape: Shape, size: float) -> list[Mark]:
    """A named point of a body without a joint."""
    return [circle(shape.points[0], 0.6 * size, face=DARK, edge=WHITE, width=0.5)]


def curve(shape: Shape, size: float) -> list[Mark]:
    """Line (n, 2) that does not belong to a body."""
    return [line(shape.points, edge=EDGE, width=1.8)]


# ---- joints ----


def pin(shape: Shape, size: float) -> list[Mark]:
    """The place (1, 2) of a hinge."""
    return [circle(shape.points[0], size, width=1.2)]


def ground(shape: Shape, size: float) -> list[Mark]:
    """Support on hatched ground at a hinge (1, 2)."""
    tip = shape.points[0]
    left, right = tip + size * np.array([[-2.5, -4.4], [2.5, -4.4]])
    wider = size * np.array([1.3, 0.0])
    return [area(hull(np.vstack([arc(tip, 1.5 * size), left, right]))), *hatched(left - wider, right + wider, size)]


def wall(shape: Shape, size: float) -> list[Mark]:
    """A place of the ground at which something is held that comes from a direction: (place, direction)."""
    place, inward = shape.points
    half = 3.4 * size * across(inward)
    return hatched(place + half, place - half, size)


def rail(shape: Shape, size: float) -> list[Mark]:
    """A guide on the ground from one place to another: (place, place, direction away from the ground)."""
    along, down = -across(shape.points[2]), BLOCK[1] * size * shape.points[2]
    start, end = sorted(shape.points[:2] - down, key=lambda place: float(place @ along))
    longer = 1.5 * BLOCK[0] * size * along
    return hatched(start - longer, end + longer, size, aligned=True)


def stop(shape: Shape, size: float) -> list[Mark]:
    """A block at (place, direction towards it), against which a slider comes to rest, or a bar if its number is zero."""
    place, along = shape.points
    return [box(place + ((BLOCK[0] if shape.number else BAR) + 0.7) * size * along, along, 0.7 * size, 1.7 * size, face=DARK)]


def road(shape: Shape, size: float) -> list[Mark]:
    """A line on which a wheel rolls, from one place to another along it: (place, place, axis)."""
    start, end, axis = shape.points
    return hatched(start - 6 * size * axis, end + 6 * size * axis, size, aligned=True)


def surface(shape: Shape, size: float) -> list[Mark]:
    """A bounded line that others may touch, through places (n, 2); free on its left alone if the number is not zero."""
    steps = np.diff(shape.points, axis=0)
    length = np.concatenate([[0.0], np.cumsum(np.hypot(*steps.T))])
    edge = line(shape.points, width=1.4)
    if not shape.number or not length[-1]:
        return [edge]
    places = np.linspace(0.0, length[-1], 2 + int(length[-1] / (1.3 * size)))[1:-1]
    feet = np.column_stack([np.interp(places, length, each) for each in shape.points.T])
    along = steps[np.searchsorted(length, places) - 1]
    along = 1.3 * size * along / np.hypot(*along.T)[:, None]
    return [edge, lines(feet, feet - (0.75 * np.column_stack([-along[:, 1], along[:, 0]]) + 0.65 * along), width=0.8)]


def groove(shape: Shape, size: float) -> list[Mark]:
    """A slot in a moving body from one place to another: (place, place, axis)."""
    start, end, axis = shape.points
    longer = 0.7 * size * axis
    return [area(rounded(np.array([start - longer, end + longer]), HALF_GROOVE * size), edge=EDGE, width=1.0)]


def guide(shape: Shape, size: float) -> list[Mark]:
    """A rod of a moving body on which another one slides, from one place to another: (place, place, axis)."""
    start, end, axis = shape.points
    longer = 1.6 * BLOCK[0] * size * axis
    return [area(rounded(np.array([start - longer, end + longer]), 0.75 * size), face=BODY, edge=EDGE, width=1.0)]


def slider(shape: Shape, size: float) -> list[Mark]:
    """A block (place, axis)."""
    place, axis = shape.points
    return [box(place, axis, BLOCK[0] * size, BLOCK[1] * size, face=BODY, edge=EDGE, width=1.2)]


def block(shape: Shape, size: float) -> list[Mark]:
    """A block (place, axis) in a groove."""
    place, axis = shape.points
    return [box(place, axis, 2.1 * size, HALF_GROOVE * size, face="#D9D9D9", edge=DARK, width=1.0)]


def weld(shape: Shape, size: float) -> list[Mark]:
    """A place at which bodies are one, and a direction of them."""
    place, axis = shape.points
    return [box(place, axis, 1.05 * size, 1.05 * size, face=DARK, width=0.6)]


def rod(shape: Shape, size: float) -> list[Mark]:
    """A massless rod between two places."""
    return [area(rounded(shape.points, 0.5 * size), face=WHITE, width=1.0),
            *(circle(place, 0.75 * size, width=1.2) for place in shape.points)]


def blade(shape: Shape, size: float) -> list[Mark]:
    """A blade, or a wheel from above, at a place along a direction."""
    place, axis = shape.points
    return [area(rounded(np.array([place - 4.5 * size * axis, place + 4.5 * size * axis]), 0.8 * size), face=DARK, width=0.6)]


def wheel(shape: Shape, size: float) -> list[Mark]:
    """A wheel: its centre, a direction that turns with it; its radius."""
    centre, spoke = shape.points
    inner = 0.92 * shape.number
    spokes = [line([centre - inner * each, centre + inner * each], edge=EDGE, width=0.8) for each in (spoke, across(spoke))]
    return [circle(centre, inner, SMOOTH, face=TINT, edge="none"), *spokes,
            line([centre, centre + inner * spoke], edge=EDGE, width=2.0),
            rim(centre, inner, shape.number, face=EDGE, edge=EDGE, width=0.6), circle(centre, 1.7 * size, face=BODY, edge=EDGE)]


# ---- gears and cams ----


def gear(shape: Shape, size: float) -> list[Mark]:
    """The pitch circle of a gear, as of a wheel; a hole shows how it turns."""
    centre, spoke = shape.points
    radius = shape.number
    return [circle(centre, radius, SMOOTH, face=TINT, edge="none"),
            line(arc(centre, radius, corners=SMOOTH), edge=EDGE, width=1.2, dashes=CHAIN),
            line([centre, centre + radius * spoke], edge=EDGE, width=1.0),
            circle(centre, min(2.2 * size, 0.5 * radius), face=BODY, edge=EDGE),
            circle(centre + 0.62 * radius * spoke, min(0.14 * radius, 1.4 * size), edge=EDGE, width=0.9)]


def ring(shape: Shape, size: float) -> list[Mark]:
    """A gear whose teeth are inside, as of a gear."""
    centre, spoke = shape.points
    radius, outer = shape.number, shape.number + 2.6 * size
    return [rim(centre, radius, outer, face=TINT, edge="none"), line(arc(centre, outer, corners=SMOOTH), edge=EDGE, width=1.2),
            line(arc(centre, radius, corners=SMOOTH), edge=EDGE, width=1.2, dashes=CHAIN),
            line([centre + radius * spoke, centre + outer * spoke], edge=EDGE, width=2.0)]


def rack(shape: Shape, size: float) -> list[Mark]:
    """A rack along its pitch line from one place to another: (place, place, direction towards its pinion)."""
    start, end, towards = shape.points
    count = max(2, int(np.hypot(*(end - start)) / (2.2 * size)))
    at = (np.arange(4 * count) + 0.5) / (4 * count)
    heights = np.tile([-0.6, 0.6, 0.6, -0.6], count) * size
    teeth = start + at[:, None] * (end - start) + heights[:, None] * towards
    back = -BLOCK[1] * size * towards
    return [area([start + back, *teeth, end + back], face=BODY, edge=EDGE, width=1.0),
            line([start, end], edge=EDGE, width=0.8, dashes=CHAIN)]


def cam(shape: Shape, size: float) -> list[Mark]:
    """A plate by its corners (n, 2); `number` 1: a cam by the path of its roller's centre, less the roller."""
    path = shape.points
    along = np.roll(path, -1, axis=0) - np.roll(path, 1, axis=0)
    following = np.roll(path, -1, axis=0)
    turn = np.sign(np.sum(path[:, 0] * following[:, 1] - path[:, 1] * following[:, 0]))
    inward = turn * np.column_stack([-along[:, 1], along[:, 0]]) / np.maximum(np.hypot(*along.T), 1e-300)[:, None]
    return [area(path + shape.number * ROLLER * size * inward, face=TINT, edge=EDGE, width=1.6)]


ROLLER = 1.5        # the radius of a cam's roller


def roller(shape: Shape, size: float) -> list[Mark]:
    """The roller of a follower, by its centre."""
    return [circle(shape.points[0], ROLLER * size, width=1.2), circle(shape.points[0], 0.4 * size, face=DARK, width=0.5)]


def coupled(shape: Shape, size: float) -> list[Mark]:
    """A line through places (n, 2) of which one follows from the others."""
    return [line(shape.points, edge=GREY, width=1.0, dashes=DASHED)]


# ---- springs, dampers, drives ----


def _frame(shape: Shape, size: float, low: float, high: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, list[Mark]]:
    """Frame of an element between two points, offset sideways by its number: start and end of its middle part, transverse
    direction, and marks of its leads.
    """
    start, end = shape.points
    side = across(unit(end - start))
    ends = [start + part * (end - start) for part in (low, high)]
    moved = [place + BESIDE * size * shape.number * side for place in ends]
    leads = [line(points, width=1.2) for points in ([start, ends[0], moved[0]], [moved[1], ends[1], end])]
    eyes = [circle(place, 0.5 * size, face=DARK, width=0.5) for place in (start, end)]
    return moved[0], moved[1], side, [*leads, *eyes]


def spring(shape: Shape, size: float) -> list[Mark]:
    """A zigzag between two points, offset sideways by its number."""
    start, end, side, leads = _frame(shape, size, 0.17, 0.83)
    steps = np.concatenate([[0.0], (np.arange(2 * COILS) + 0.5) / (2 * COILS), [1.0]])
    swings = np.array([0.0, *((-1.0) ** i for i in range(2 * COILS)), 0.0]) * (1.3 if shape.number else 1.9) * size
    return [line(start + steps[:, None] * (end - start) + swings[:, None] * side, width=1.3), *leads]


def damper(shape: Shape, size: float) -> list[Mark]:
    """A dashpot between two places; beside their line by its number."""
    start, end, side, leads = _frame(shape, size, 0.17, 0.83)
    half, (bottom, piston, rim) = 1.35 * size * side, (start + part * (end - start) for part in (0.22, 0.55, 0.75))
    return [line([rim + half, bottom + half, bottom - half, rim - half], width=1.2), line([start, bottom], width=1.2),
            line([piston + 0.75 * half, piston - 0.75 * half], width=2.6), line([piston, end], width=1.2), *leads]


def cylinder(shape: Shape, size: float) -> list[Mark]:
    """A cylinder between two places: its barrel from the first, its piston rod from the second."""
    start, end = shape.points
    barrel, half = start + 0.58 * (end - start), 1.4 * size * across(unit(end - start))
    return [area(rounded(np.array([barrel, end]), 0.45 * size), face=WHITE, width=1.0),
            area([start + half, barrel + half, barrel - half, start - half], face="#D9D9D9", width=1.2),
            *(circle(place, 0.75 * size, width=1.2) for place in shape.points)]


def spiral(shape: Shape, size: float) -> list[Mark]:
    """A spring about a place, wound by an angle."""
    turns = np.linspace(0, 4.5 * np.pi, 120)
    radius = size * (1.5 + 2.3 * turns / turns[-1])
    angles = turns + shape.number * (1 - turns / turns[-1])
    return [line(shape.points[0] + np.column_stack([radius * np.cos(angles), radius * np.sin(angles)]), width=1.1)]


def bushing(shape: Shape, size: float) -> list[Mark]:
    """A soft joint at a place: a ring of rubber in a sleeve."""
    place = shape.points[0]
    return [circle(place, 2.2 * size, face="#707070"), circle(place, 1.1 * size, width=1.0)]


def motor(shape: Shape, size: float) -> list[Mark]:
    """A drive about a place; clockwise where its number is negative."""
    start, angle = (-0.2 * np.pi, 1.4 * np.pi) if shape.number >= 0 else (1.2 * np.pi, -1.4 * np.pi)
    return turning_arrow(shape.points[0], 3.3 * size, start, angle, size, DARK)


def drive(shape: Shape, size: float) -> list[Mark]:
    """A drive at a place along an axis: (place, axis, the side on which there is room)."""
    place, axis, normal = shape.points
    middle = place + (BLOCK[1] + 1.6) * size * normal
    forward = 1.0 if shape.number >= 0 else -1.0
    return [arrow(middle - 3.2 * forward * size * axis, middle + 3.2 * forward * size * axis, size, face=DARK, width=0.5)]


def load(shape: Shape, size: float) -> list[Mark]:
    """A force at a place in a direction."""
    place, direction = shape.points
    return [arrow(place, place + 9 * size * direction, size, face=LOAD, edge=WHITE, width=0.6)]


def load_symbol(shape: Shape, size: float) -> list[Mark]:
    """Hollow arrow: direction of a force beside arrows that are drawn to a scale."""
    place, direction = shape.points
    return [arrow(place, place + 9 * size * direction, size, face=WHITE, edge=GREY, width=0.8)]


def moment(shape: Shape, size: float) -> list[Mark]:
    """A moment about a place; clockwise where its number is negative."""
    start, angle = (-0.75 * np.pi, 1.5 * np.pi) if shape.number >= 0 else (-0.25 * np.pi, -1.5 * np.pi)
    return turning_arrow(shape.points[0], 4.2 * size, start, angle, size, LOAD)


class Glyph(NamedTuple):
    """Symbol of a kind of shape: drawing function, drawing order, and number of trailing points that are directions."""

    draw: Callable[[Shape, float], list[Mark]]
    zorder: float
    directions: int


BACK_TO_FRONT = (ring, gear, cam, ground, wall, rail, road, surface, wheel, disc, coupled, guide, stop, link, curve, groove, rod,
                 cylinder, damper, spring, slider, rack, block, bushing, weld, particle, roller, spiral, pin, blade, mark, motor,
                 drive, load, load_symbol, moment)
GLYPHS = {draw.__name__: Glyph(draw, 1.5 + 0.05 * i, DIRECTED.get(draw.__name__, 0)) for i, draw in enumerate(BACK_TO_FRONT)}
