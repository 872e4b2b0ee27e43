"""Scene of a film: shapes whose points move, arrows, graphs, as one JSON object that the player's script draws.

Points that several shapes share are written once; points at rest are not in the table of moving points. Coordinates are 16-bit
integers within the box around all of them: an error of 1e-5 of the picture; vectors of arrows within a box from -1 to 1. Between
samples points move along cubics through four of them; where these would change the shapes, the nearest sample is shown.
"""

from __future__ import annotations

import base64
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._private import checks
from ..errors import WrongValue
from ..runs.dense_samples import dense
from ..runs.samples.columns import columns
from ..runs.samples.solution import Solution
from ..runs.shapes_of_samples import is_upside_down, moments_of, paths_of
from ..systems.shapes import DIRECTED, Shape
from ..units import shown
from .rigid import carried

RATE, RATE_OF_LINES = 20, 60    # samples of points, and of graphs and paths, for each second of the film
MAX_SAMPLES = 900      # of a film; longer ones are thinned
LARGEST, FEWEST = 320_000, 4        # bytes of samples, of which films of more points have fewer; samples of a cubic
SHORTEST, LONGEST = 3.0, 15.0   # s: films of shorter and longer motions are slower and faster than these
RESTS = 1e-9            # of the picture: points that move less rest
SMOOTH = 0.01           # of the size of a shape: cubics through samples that deviate less from the motion are drawn
MOVES = 0.5             # of the size of the picture: its weight beside that of a shape
BETWEEN = 0.382         # of the time between two samples, where they are compared: no simple fraction, as whole turns end there
NODES = -1, 0, 1, 2     # samples of a cubic, between the second and the third of which it is drawn
CUBIC = tuple(np.prod([(BETWEEN - k) / (j - k) for k in NODES if k != j]) for j in NODES)      # weights at the comparison
LEVELS, APART = 65535, 12       # of a coordinate; those by which points in one place deviate at most
PIN = 0.017             # of the picture: a pin's radius
SLENDER = 0.13          # of the short bars, the quarter of all: no pin is larger
ROUND = ("wheel", "gear", "ring")       # kinds of shapes whose number is a radius
ARROW = 0.22            # of the picture: the longest arrow
NOTHING = 1e-9          # of the largest force or torque: torques of hinges are rounding below
FAR = 0.4               # of all its motion: what is smaller than that is followed
FARTHER = 0.1           # of all its motion: what is smaller than that is followed past parts at rest
FOLLOWED = 1.6          # widths of it are seen then
MAX_LOADS = 200        # measures of forces that a film contains for clicks; of more, those of arrows alone


@dataclass(frozen=True)
class Wanted:
    """Contents of a film besides the shapes: arrows, paths, graphs, names, and its speed."""

    forces: Any = False
    path: Any = ()
    graphs: Any = ()
    names: bool = False
    speed: float | None = None
    samples: int = MAX_SAMPLES
    group: str = ""         # films of one group that replace each other go on at the same time

    def __post_init__(self) -> None:
        if self.speed is not None:
            checks.number("speed", self.speed, above=0)


def scene(solutions: Sequence[Solution], labels: Sequence[str], wanted: Wanted) -> dict[str, Any]:
    """The film of solutions of the same time span, drawn over each other, with fewer samples where it would be too large."""
    most = max(FEWEST, min(wanted.samples, LARGEST // sum(map(_bytes, solutions))))
    film = _scene(solutions, labels, wanted, most)
    while (size := 0.75 * sum(len(layer["points"]) for layer in film["layers"])) > LARGEST and most > FEWEST:
        most = max(FEWEST, int(0.95 * most * LARGEST / size))
        film = _scene(solutions, labels, wanted, most)
    return film


def _scene(solutions: Sequence[Solution], labels: Sequence[str], wanted: Wanted, most: int) -> dict[str, Any]:
    first = solutions[0]
    if len({_drawn(sol, sol.t[:1])[1].shape[2] for sol in solutions}) > 1:
        raise WrongValue("solutions must be all of the plane or all of space, to be drawn over each other", "wrong-dimension")
    t0, t1 = float(first.t[0]), float(max(sol.t[-1] for sol in solutions))
    speed = wanted.speed or _speed(t1 - t0)
    times, lines = (np.linspace(t0, t1, int(np.clip(rate * (t1 - t0) / speed, FEWEST, limit)) if t1 > t0 else 1)
                    for rate, limit in ((RATE, most), (RATE_OF_LINES, wanted.samples)))
    times, is_smooth = _times(solutions, times, most)
    layers = [_layer(sol, times, lines, wanted) for sol in solutions]
    every = np.concatenate([layer["table"][:, :layer["vectors"]].reshape(-1, layer["table"].shape[2]) for layer in layers])
    places = np.concatenate([layer["extent"] for layer in layers])
    follow = _follow(layers, places)
    shown = np.full(places.shape[1], follow) if follow else np.ptp(places, axis=0)
    arrow = ARROW * float(np.linalg.norm(shown) or 1.0)
    places = np.concatenate([places, *(_tips(layer, arrow) for layer in layers)])
    low, high = places.min(axis=0), places.max(axis=0)
    box = every.min(axis=0), every.max(axis=0)
    labelled = list(zip(map(dense, solutions), labels, strict=True))
    return {"name": first.system.name, "upside": is_upside_down(first.system),
            "span": [t0, t1], "samples": len(times), "nearest": not is_smooth, "speed": speed,
            "thinned": most < wanted.samples and len(times) == most,
            "dimension": int(places.shape[1]), "low": low.tolist(), "high": high.tolist(), "follow": follow,
            "pin": _pin(layers[0], float(shown.max() or 1.0)), "arrow": arrow,
            "box": [side.tolist() for side in box], "names": wanted.names, "group": wanted.group,
            "layers": [_packed(layer, box, label) for layer, label in zip(layers, labels, strict=True)],
            "graphs": [line for sol, label in labelled for line in _graphs(sol, lines, wanted.graphs, label)],
            "trust": [line for sol, label in labelled for line in _trust(sol, lines, label)]}


def _speed(duration: float) -> float:
    """Seconds of the motion in a second of the film: 1, 2 or 5 times a power of ten."""
    if SHORTEST <= duration <= LONGEST or not duration > 0:
        return 1.0
    wanted = duration / (SHORTEST if duration < SHORTEST else LONGEST)
    power = 10.0 ** np.floor(np.log10(wanted))
    return float(next(times * power for times in (5, 2, 1) if times * power <= wanted * (1 + 1e-12)))


def _bytes(sol: Solution) -> int:
    """Size of a sample: of points that differ, and of forces that clicks show."""
    _, points = _drawn(sol, sol.t[[0, len(sol.t) // 2]])
    different = np.unique(np.round(points.swapaxes(0, 1).reshape(points.shape[1], -1), 9), axis=0)
    return 2 * (len(different) * points.shape[2] + len(_loaded(sol)))


def _times(solutions: Sequence[Solution], times: np.ndarray, most: int) -> tuple[np.ndarray, bool]:
    """Times of samples, more than given, but at most so many, where cubics through them would change the shapes; and whether
    these cubics may be drawn.
    """
    while (deviation := max(_deviation(sol, times) for sol in solutions)) > SMOOTH and len(times) < most:
        count = int(np.ceil(1.1 * len(times) * (deviation / SMOOTH) ** 0.3))      # by a power of their distance
        times = np.linspace(times[0], times[-1], min(count, most))
    return times, deviation <= SMOOTH


def _deviation(sol: Solution, times: np.ndarray) -> float:
    """Largest error of cubics through samples in the shape of a part: of its points as seen from its first one, and of
    its directions, as part of its size; and that of all points, as part of the picture.
    """
    if len(times) < 4:
        return 0.0
    between = times[1:-2] + BETWEEN * np.diff(times)[1:-1]
    shapes, points = _drawn(sol, np.concatenate([times, between]))
    ends = np.cumsum([len(shape.points) for shape in shapes])
    starts = ends - [len(shape.points) for shape in shapes]
    directions = np.concatenate([np.arange(len(shape.points)) >= count_places(shape) for shape in shapes])
    origins = points[:, np.repeat(starts, ends - starts)]
    origins[:, directions] = 0.0
    size = float(np.ptp(points, axis=(0, 1)).max()) or 1.0
    sizes = np.linalg.norm((points - origins)[:len(times)], axis=2).max(axis=0)
    sizes = np.maximum(np.maximum.reduceat(sizes, starts), RESTS * size)
    errors = _errors(points - origins, len(times))
    return float(max((np.maximum.reduceat(errors, starts) / sizes).max(), (_errors(points, len(times)) / (MOVES * size)).max()))


def _errors(points: np.ndarray, count: int) -> np.ndarray:
    """Largest error of cubics through the first samples, at the times between them that follow, for each point."""
    samples, known = np.split(points, [count])
    cubics = sum(weight * samples[i:count - 3 + i] for i, weight in enumerate(CUBIC))
    return np.linalg.norm(known - cubics, axis=2).max(axis=0, initial=0.0)


def _drawn(sol: Solution, times: np.ndarray) -> tuple[list[Shape], np.ndarray]:
    """Shapes of a solution, and the points (times, points, dimension) of all of them."""
    moments = moments_of(sol, _positions(sol, times), times)
    return moments[0], np.array([np.concatenate([shape.points for shape in moment]) for moment in moments])


def _follow(layers: Sequence[dict[str, Any]], places: np.ndarray) -> float:
    """Width in m of a view that moves with what goes far, or 0: the view then rests."""
    all_motion = float(np.ptp(places, axis=0).max())
    for are_all, part in ((True, FAR), (False, FARTHER)):
        seen = [layer["seen"][:, np.full(len(layer["moves"]), True) if are_all else layer["moves"]] for layer in layers]
        size = max((float(np.ptp(each, axis=1).max(initial=0.0)) for each in seen if each.shape[1]), default=0.0)
        if 0 < size < part * all_motion:
            return FOLLOWED * size
    return 0.0


def _layer(sol: Solution, times: np.ndarray, lines: np.ndarray, wanted: Wanted) -> dict[str, Any]:
    """Shapes of a solution at all times, points in a table (times, points, dimension)."""
    shapes, points = _drawn(sol, times)
    sol = dense(sol)
    entries, begin = [], 0
    for shape in shapes:
        entries.append((shape, range(begin, begin + len(shape.points))))
        begin += len(shape.points)
    seen, moves = _seen(points, entries)
    loads = _loads(sol, times)
    arrows, columns_of_arrows = _arrows(sol, times, wanted.forces, _force(loads, float(np.ptp(points, axis=(0, 1)).max() or 1.0)))
    paths = [np.column_stack([np.interp(lines, sol.t, each) for each in path.T]) for path in paths_of(sol, wanted.path or ())]
    return {"table": np.concatenate([points, *columns_of_arrows], axis=1), "entries": entries, "arrows": arrows, "paths": paths,
            "loads": loads, "seen": seen, "moves": moves, "own": points.shape[1], "vectors": points.shape[1] + len(arrows),
            "extent": np.concatenate([seen.reshape(-1, points.shape[2]), *paths])}


def _seen(points: np.ndarray, entries: Sequence[tuple[Shape, range]]) -> tuple[np.ndarray, np.ndarray]:
    """Places of shapes (times, places, dimension), with the ends of round ones; and whether any point of their shape moves."""
    least = RESTS * float(np.ptp(points, axis=(0, 1)).max())
    seen, moves = [], []
    for shape, numbers in entries:
        own = points[:, numbers[:count_places(shape)]]
        if shape.kind in ROUND:
            own = np.concatenate([own, own[:, :1] - shape.number, own[:, :1] + shape.number], axis=1)
        seen.append(own)
        moves += [bool(np.ptp(points[:, numbers], axis=0).max() > least)] * own.shape[1]
    return np.concatenate(seen, axis=1), np.array(moves, dtype=bool)


def count_places(shape: Shape) -> int:
    """The points of a shape that are places; the last ones of some kinds are directions."""
    if shape.points.shape[1] == 3:
        return 1 if shape.kind in ("pin", "sleeve", "patch") else len(shape.points)
    return len(shape.points) - DIRECTED.get(shape.kind, 0)


def _positions(sol: Solution, times: np.ndarray) -> np.ndarray:
    """Coordinates at the times of the film; where values between samples are not to be had, on straight lines between these."""
    within = np.clip(times, sol.t[0], sol.t[-1])
    try:
        return np.asarray(sol(within)[0])
    except ValueError:
        return np.column_stack([np.interp(within, sol.t, column) for column in sol.p.T])


def _force(loads: Sequence[dict[str, Any]], extent: float) -> float:
    """Scale of forces in N: the largest one, or the largest torque over the extent of the picture."""
    return max((max(abs(each["least"]), abs(each["least"] + each["size"])) / (1.0 if each["unit"] == "N" else extent)
                for each in loads), default=0.0)


def _arrows(sol: Solution, times: np.ndarray, forces: Any, scale: float) -> tuple[list[dict[str, Any]], list[np.ndarray]]:
    """Forces as points of the table: places of all, then their vectors, with the largest size of each. All that are rounding
    beside the scale of forces are left out.
    """
    if forces is False or forces is None or (isinstance(forces, list | tuple) and not forces):
        return [], []
    rows = np.unique(np.linspace(0, len(sol.t) - 1, min(len(sol.t), MAX_SAMPLES)).astype(int))
    described, found = list[dict[str, Any]](), []
    for name, places, vectors in sol.system._forces(forces, sol, rows):
        ways = [np.stack([np.interp(times, sol.t[rows], column) for column in each.T], axis=1) for each in (places, vectors)]
        described.append({"name": name, "most": float(np.linalg.norm(vectors, axis=1).max(initial=0.0))})
        found.append(np.stack(ways, axis=1))
    most = max((each["most"] for each in described), default=0.0)
    if most <= NOTHING * scale:
        return [], []
    scaled = [each[:, :1] for each in found] + [each[:, 1:] / most for each in found]
    of = shown("N")
    return [each | {"scale": most, "unit": of.unit, "factor": of.factor} for each in described], scaled


def _pin(layer: dict[str, Any], extent: float) -> float:
    """The radius of a pin: small beside the picture, and beside short bars."""
    bars = [np.linalg.norm(np.ptp(shape.points, axis=0)) for shape, _ in layer["entries"] if shape.kind in ("link", "bar")]
    return min(PIN * extent, SLENDER * float(np.quantile(bars, 0.25)) if bars else np.inf)


def _tips(layer: dict[str, Any], arrow: float) -> np.ndarray:
    """The places to which arrows reach."""
    table, vectors = layer["table"], layer["vectors"]
    return (table[:, layer["own"]:vectors] + arrow * table[:, vectors:]).reshape(-1, table.shape[2])


def _loads(sol: Solution, times: np.ndarray) -> list[dict[str, Any]]:
    """Forces and torques of joints and force elements over time, which a click shows: magnitudes of vectors, signed scalars."""
    found = []
    for name in _loaded(sol):
        values = np.asarray(sol[name], dtype=float)
        values = np.linalg.norm(values, axis=1) if values.ndim == 2 else values
        element, _, kind = name.rpartition(".")
        if np.isfinite(values).all():
            found.append({"name": element, "unit": "N" if kind == "force" else "N m"} | _levels(np.interp(times, sol.t, values)))
    most = max((abs(each["least"]) + each["size"] for each in found), default=0.0)
    return [each for each in found if each["unit"] == "N" or each["size"] + abs(each["least"]) > NOTHING * most]


def _loaded(sol: Solution) -> list[str]:
    """Measures that a film contains for clicks."""
    names = [name for name in sol.measures if name.endswith((".force", ".torque")) and not name.startswith("ground.")]
    return names if len(names) <= MAX_LOADS else []


def _in_display(load: dict[str, Any]) -> dict[str, Any]:
    of = shown(load["unit"])
    return load | {"unit": of.unit, "least": load["least"] * of.factor, "size": load["size"] * of.factor}


def _packed(layer: dict[str, Any], box: tuple[np.ndarray, np.ndarray], label: str) -> dict[str, Any]:
    """Coordinates packed as base64. Moving points are stored once each; fixed points and points of rigid bodies separately."""
    table = layer["table"]
    size = np.maximum(box[1] - box[0], 1e-300)
    is_vector = np.arange(table.shape[1]) >= layer["vectors"]
    low, wide = np.where(is_vector[:, None], -1.0, box[0]), np.where(is_vector[:, None], 2.0, size)
    levels = np.round((table - low) / wide * LEVELS).astype(np.uint16)
    moves = (np.ptp(table, axis=0) > RESTS * wide.max(axis=1, keepdims=True)).any(axis=1)
    followers = carried(table, _bodies(layer, moves), float(size.max()))
    kinds = ["rests" if not moves[i] else "carried" if i in followers else "moves" for i in range(table.shape[1])]
    lists: dict[str, list[int]] = {"rests": [], "moves": [], "carried": []}
    numbers = []
    for i, kind in enumerate(kinds):
        known = lists[kind]
        same = _same(levels, known, i) if not is_vector[i] else None
        numbers.append(len(known) if same is None else same)
        if same is None:
            known.append(i)
    first = {"rests": lambda n: -1 - n, "moves": lambda n: n, "carried": lambda n: n + len(lists["moves"])}
    numbers = [first[kind](n) for kind, n in zip(kinds, numbers, strict=True)]
    shapes = [[shape.kind, shape.name, [numbers[i] for i in those], round(float(shape.number), 9)]
              for shape, those in layer["entries"]]
    of_arrows = numbers[layer["own"]:]
    arrows = [each | {"at": of_arrows[i], "to": of_arrows[len(layer["arrows"]) + i]} for i, each in enumerate(layer["arrows"])]
    return {"label": label, "shapes": shapes, "arrows": arrows, "moving": len(lists["moves"]),
            "vectors": int(is_vector[lists["moves"]].sum()), "points": _text(levels[:, lists["moves"]]),
            "carried": [[[numbers[k] for k in followers[i][0]], np.round(followers[i][1], 6).tolist()] for i in lists["carried"]],
            "fixed": [table[0, i].tolist() for i in lists["rests"]], "paths": [_path(path) for path in layer["paths"]],
            "loads": [_in_display(each) for each in layer["loads"]]}


def _same(levels: np.ndarray, known: list[int], i: int) -> int | None:
    """Place among known points of one that moves as point i: joined points deviate a little between samples of the run."""
    for n in np.flatnonzero(np.abs(levels[0, known].astype(int) - levels[0, i]).max(axis=1, initial=0) <= APART):
        if np.abs(levels[:, known[n]].astype(int) - levels[:, i]).max() <= APART:
            return int(n)
    return None


def _bodies(layer: dict[str, Any], moves: np.ndarray) -> list[list[int]]:
    """Moving points of shapes that share a name, without directions."""
    found: dict[str, list[int]] = {}
    for shape, numbers in layer["entries"]:
        found.setdefault(shape.name, []).extend(i for i in numbers[:count_places(shape)] if moves[i])
    return list(found.values())


def _path(path: np.ndarray) -> dict[str, Any]:
    """Places (k, d) as 16-bit integers within their own box."""
    low, size = path.min(axis=0), np.maximum(np.ptp(path, axis=0), 1e-300)
    return {"low": low.tolist(), "size": size.tolist(), "points": _text(np.round((path - low) / size * LEVELS).astype(np.uint16))}


def _levels(values: np.ndarray) -> dict[str, Any]:
    """Values as 16-bit integers between their least and greatest."""
    low, size = float(values.min()), float(np.ptp(values))
    return {"least": low, "size": size, "values": _text(np.round((values - low) / (size or 1.0) * LEVELS).astype(np.uint16))}


def _graphs(sol: Solution, times: np.ndarray, names: Any, label: str) -> list[dict[str, Any]]:
    names = () if names is None else names
    if not isinstance(names, str) and not len(names):
        return []
    return [_line(variable.name, variable.unit, sol.t, values, times, label) for variable, values in columns(sol, names)]


def _trust(sol: Solution, times: np.ndarray, label: str) -> list[dict[str, Any]]:
    """Constraint violation and energy error over time."""
    found = []
    for name, unit, values in (("position violation", "m", sol.position_violation), ("energy error", "J", sol.energy_violation)):
        if values is not None and np.size(values):
            values = np.abs(np.asarray(values, dtype=float)).reshape(len(sol.t), -1).max(axis=1)
            of = shown(unit)
            found.append(_line(name, of.unit, sol.t, values * of.factor, times, label))
    return found


def _line(name: str, unit: str, t: np.ndarray, values: np.ndarray, times: np.ndarray, label: str) -> dict[str, Any]:
    sampled = np.interp(times, t, values, left=np.nan, right=np.nan).astype(np.float32)     # of shorter runs, until these end
    return {"name": name, "unit": unit, "label": label, "least": float(np.min(values)), "most": float(np.max(values)),
            "values": _text(sampled)}


def _text(array: np.ndarray) -> str:
    """Little-endian numbers in base 64."""
    return base64.b64encode(np.ascontiguousarray(array).astype(array.dtype.newbyteorder("<")).tobytes()).decode("ascii")

