"""Random mechanisms with redundant constraints, plane and space: welds, braces, doubled joints and idle loops.

Each is run in joint and in absolute coordinates, and both runs are compared with each other and, at several states, with an
independent dense model: residuals, rank by singular values, accelerations.
"""

import re
import warnings
from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation

import zerodrift as zd
from mechanisms.plain_mechanics import Bodies, Model, rows_of
from mechanisms.plain_space import KINDS, Plain
from mechanisms.plain_twists import RANK, Dense, constrained, singular
from mechanisms.random_mechanisms import Maker

SECONDS, STATES = 0.3, 3
RUN = {"integrator": "dop853", "rtol": 1e-10, "atol": 1e-10, "t_eval": np.linspace(0.0, SECONDS, STATES), "max_steps": 3000}
FINE = RUN | {"rtol": 1e-12, "atol": 1e-12}         # of what differs: does it come from steps?
MOTION = 1e-6       # of positions and angles: tolerances of 1e-10, which motions of linkages multiply
HELD = 1e-9         # residuals of positions and velocities, which are projected to 1e-12
ACCELERATION = 1e-9         # of the largest, times the condition of the rows
FAST = 5.0          # m/s and rad/s
CLOSE = 1e-4        # of the largest singular value: below it, a mechanism is near a singular pose


class Planar(Maker):
    """One to three idle joints beside those that close loops."""

    def _grow(self):
        for _ in range(self.random.integers(2, 6)):
            self._body()
        for _ in range(self.random.integers(0, 4)):
            self._loop()
        for _ in range(self.random.integers(1, 4)):
            getattr(self, self.random.choice(["_double", "_brace", "_bars"]))()
        for add in (self._drive, self._spring, self._force, self._effort, self._blade):
            if self.random.random() < 0.5:
                add()

    def _double(self):
        """A joint once more: of a weld or a rail at any place, of all others at the same."""
        if not self.drawn:
            return
        kind, first, second, at, axis = self.drawn[self.random.integers(len(self.drawn))]
        self._joint(kind, first, second, self._place() if kind in ("weld", "prismatic") else at, axis)

    def _brace(self):
        """Any joint between two bodies that are welded together; where none are, a body is welded to another."""
        welded = [drawn[1:3] for drawn in self.drawn if drawn[0] == "weld"]
        if not welded:
            first, second = int(self.random.integers(-1, len(self.bodies))), self._apart()
            self._joint("weld", first, second, self._place())
            welded = [(first, second)]
        kind = self.random.choice(["rod", "slot", "revolute", "prismatic", "weld"])
        self._joint(kind, *welded[self.random.integers(len(welded))], self._place())

    def _bars(self):
        """A body on three parallel bars of one length, of which two would do."""
        first, second, axis = int(self.random.integers(-1, len(self.bodies))), self._apart(), self._axis()
        for _ in range(3):
            self._joint("rod", first, second, self._place(), axis)

    def _axis(self):
        turn = self.random.uniform(0, 6)
        return np.array([np.cos(turn), np.sin(turn)])


class Spatial(Plain):
    """One or two idle joints or loops beside those that close loops."""

    def _add_idle(self, rng):
        for _ in range(rng.integers(1, 3)):
            getattr(self, str(rng.choice(["_double", "_brace", "_four_bar"])))(rng)

    def _double(self, rng):
        """A joint once more, along its axis or anywhere where that changes nothing."""
        kind, first, second, place, axis, normal, other = self.drawn[str(rng.choice(list(self.drawn)))]
        along = place + rng.uniform(0.2, 0.8) * axis
        if kind == "revolute":
            kind = str(rng.choice(["revolute", "cylindrical"]))
        place = {"prismatic": rng.normal(size=3), "weld": rng.normal(size=3), "planar": rng.normal(size=3), "revolute": along,
                 "cylindrical": along, "screw": along}.get(kind, place)
        self._put(f"idle{len(self.drawn)}", kind, first, second, place, axis, normal, other)

    def _brace(self, rng):
        """Any joint between two bodies that are welded together; where none are, a body is welded to another."""
        welded = [each[1:3] for each in self.drawn.values() if each[0] == "weld"]
        if not welded:
            first = self.bodies[rng.integers(len(self.bodies))]
            self._add_body(rng, f"b{len(self.bodies) - 1}")
            self._join(rng, f"idle{len(self.drawn)}", "weld", first, self.bodies[-1])
            welded = [(first, self.bodies[-1])]
        self._join(rng, f"idle{len(self.drawn)}", str(rng.choice(KINDS)), *welded[rng.integers(len(welded))])

    def _four_bar(self, rng):
        """A four-bar linkage in a plane, whose loop has three constraints more than it needs."""
        base, axis = self.bodies[rng.integers(len(self.bodies))], rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        normal = np.cross(axis, AWAY)
        for _ in range(3):
            self._add_body(rng, f"b{len(self.bodies) - 1}")
        chain = [base, *self.bodies[-3:], base]
        for first, second in pairwise(chain):
            place = rng.normal(size=3)
            self._put(f"idle{len(self.drawn)}", "revolute", first, second, place, axis, normal / np.linalg.norm(normal), place)


AWAY = np.array([0.3, 0.5, 0.8])


def started(m, wish):
    """Wishes angular velocities; less of them near a dead point, where they would need velocities that no comparison follows."""
    m.start(wish=wish)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            size = np.abs(m.system("absolute").v0).max(initial=0.0)
    except (zd.ZerodriftError, ValueError):
        return      # the runs will say so
    if size > FAST:
        m.start(wish={name: value * FAST / size for name, value in wish.items()})


class InPlane:
    """One mechanism in the plane, and its dense model at a sample of a run."""

    def __init__(self, seed):
        maker = Planar(seed)
        started(maker.m, {f"{body.name}.angular_velocity": maker.random.uniform(-2, 2) for body in maker.bodies})
        self.m, self.bodies, self.model = maker.m, maker.bodies, Model(maker.d)
        self.measures = [(f"{body.name}.center.{of}", f"{body.name}.{angular}") for of, angular in
                         (("position", "angle"), ("velocity", "angular_velocity"), ("acceleration", "angular_acceleration"))
                         for body in maker.bodies]
        self.numbers = [f"{body.name}.{of}" for body in maker.bodies for of in ("center.position", "angle")]

    def dense(self, sol, k):
        """Accelerations of the run and of the model (n,), residuals of positions and velocities, singular values."""
        q, v, a = np.reshape([[*sol[linear][k], sol[angular][k]] for linear, angular in self.measures], (3, -1))
        C, right, _ = self.model.constraints(sol.t[k], q, v)
        joints = len(C) - len(self.model.d["drives"]) - len(self.model.d["blades"])
        bodies = Bodies(q, v)
        value = [row.value for joint in self.model.d["joints"] for row in rows_of(joint, bodies)]
        found = constrained(np.diag(self.model.M), self.model.forces(sol.t[k], q, v)[0], C, right)
        return a, found, np.abs(value).max(), np.abs(C[:joints] @ v).max(), singular(C)


class InSpace:
    """One mechanism in space, and its dense model at a sample of a run."""

    def __init__(self, seed):
        rng = np.random.default_rng(seed)
        self.plain = Spatial(rng, int(rng.integers(1, 4)), int(rng.integers(0, 3)), None, "absolute")
        self.m, self.model, names = self.plain.m, Dense(self.plain), self.plain.names()
        started(self.m, {f"{name}.angular_velocity": rng.uniform(-1, 1, 3) for name in names})
        self.numbers = [f"{name}.{of}" for name in names for of in ("center.position", "rotation")]

    def dense(self, sol, k):
        """Accelerations of the run and of the model (n,), residuals of positions and velocities, singular values."""
        names = self.plain.names()
        poses = {"ground": self.plain.pose["ground"]} | {
            name: (sol[f"{name}.center.position"][k], Rotation.from_matrix(sol[f"{name}.rotation"][k])) for name in names}
        v, a = (np.concatenate([[*sol[f"{name}.center.{linear}"][k], *sol[f"{name}.{angular}"][k]] for name in names])
                for linear, angular in (("velocity", "angular_velocity"), ("acceleration", "angular_acceleration")))
        return a, *self.model.accelerations(poses, v)


def category(error):
    """The reason of a refusal: its class and its first words, without names and numbers."""
    text = re.sub(r"^at t = [^:]*: ", "", str(error))
    text = re.sub(r"'[^']*'(, '[^']*')*|[-+]?\d[\d.e+-]*", "...", text)
    return f"{type(error).__name__}: {text[:70]}"


def off(case, sol):
    """The first finding against the dense model as a word, or None; and whether it comes near a singular pose."""
    close = False
    for k in range(len(sol.t)):
        a, expected, position, velocity, s = case.dense(sol, k)
        rank = int((s > RANK * s[0]).sum())
        smallest = s[:rank].min() / s[0]
        close |= smallest < CLOSE
        if len(a) - rank != sol.system.nv - sol.stats["rank"]:
            return f"has {sol.system.nv - sol.stats['rank']} freedoms, the model {len(a) - rank}", close
        if position > HELD or velocity > HELD * max(1.0, np.abs(a).max()):
            return f"residuals {position:.1e}, {velocity:.1e}", close
        if np.abs(a - expected).max() > ACCELERATION / smallest * max(1.0, np.abs(expected).max()):
            return f"accelerations differ by {np.abs(a - expected).max():.1e} of {np.abs(expected).max():.1e}", close
    return None, close


def runs_of(case, how):
    """Solutions or errors by coordinates, and coordinates whose run warned."""
    found, warned = {}, set()
    for layout in ("joint", "absolute"):
        with warnings.catch_warnings(record=True) as told:
            warnings.simplefilter("always")
            try:
                found[layout] = zd.simulate(case.m.system(layout), SECONDS, **how)
            except (zd.ZerodriftError, ValueError) as error:
                found[layout] = error
        if any(issubclass(each.category, zd.AccuracyWarning) for each in told):
            warned.add(layout)
    return found, warned


def compared(case, how):
    """Findings of one mechanism, [word, sentence] of each run and of both, and the solutions."""
    found, warned = runs_of(case, how)
    words = []
    for layout, sol in found.items():
        if isinstance(sol, Exception):
            words.append([f"{layout}: refused: {category(sol)}", str(sol)[:160]])
            continue
        what, close = off(case, sol)
        word = f"differs, {'warned' if layout in warned else 'in silence'}" if what else "agrees with the model"
        words.append([f"{layout}: {word}", what or ("near a singular pose" if close else "")])
    if (distance := apart(case, *found.values())) is not None:
        word = "agree" if distance < MOTION else f"differ, {'warned' if warned else 'in silence'}"
        words.append([f"both coordinates: {word}", f"{distance:.2g}"])
    return words, found


def apart(case, one, other):
    """Largest difference of two motions; None if either was refused."""
    if isinstance(one, Exception) or isinstance(other, Exception):
        return None
    return max(np.abs(one[name] - other[name]).max() for name in case.numbers)


def outcome(seed):
    """Formulation and findings of a mechanism, in the plane if the seed is even.

    What differs is run again with finer tolerances: either that agrees, or a run differs from itself as much as from the other,
    as the motion multiplies whatever errors there are.
    """
    case, formulation = (InPlane, InSpace)[seed % 2](seed // 2), list(zd.formulations())[seed // 2 % len(zd.formulations())]
    words, found = compared(case, RUN | {"formulation": formulation})
    if any("differ" in word for word, _ in words):
        again, finer = compared(case, FINE | {"formulation": formulation})
        agrees = not any("differ" in word for word, _ in again)
        own = [apart(case, found[layout], finer[layout]) or 0.0 for layout in found]
        for each in words:
            if "differ" in each[0] and agrees:
                each[0] += ", agree with finer tolerances"
            elif each[0].startswith("both coordinates: differ") and 10 * max(own) > float(each[1]):
                each[0] += ", and a run differs from itself with finer tolerances"
                each[1] += f"; from itself {max(own):.2g}"
    return formulation, words
