"""Files and words needed to add an entry to each of the core's tables, and a term: added to a copy, built, tested and counted.

    python tests/stress/new_rows.py [FOLDER]        prints a table; some minutes

A new entry is a new file and one word in `methods.h`, a new kind of joint or force element one entry in the `elements.c` of
its dimension, and a new term one line in `terms.h`. The tests that run were not written for them: they are
parametrized over the core's tables, and selected by the new names. The entries are small, but each one that can have
parameters has one. The joints and force elements, of the plane and of space, are then used from Python, and compared with
closed forms of simple motions and with the same mechanism made of existing joints and constraints. The declarations of
methods for editors, a generated file, are written anew.
"""

import difflib
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
KEPT = shutil.ignore_patterns(".git", "build", "*.egg-info", "__pycache__", "*.so", ".pytest_cache", ".hypothesis", ".venv")
PLANE, SPACE = "csrc/mechanisms/plane/elements.c", "csrc/mechanisms/space/elements.c"
WIDEST = 142        # columns of a line of C
REGISTRY, INTERFACE = "csrc/methods.h", "csrc/include/zerodrift/terms.h"

INTEGRATOR = r"""
/* Explicit Runge-Kutta methods with two stages, of which the second is a part theta of the step away. */
#include "integrator.h"

typedef struct staged {
    double theta;
    int size;
    double *k1, *k2, *stage;        /* (size,) each */
} staged;

static const zd_parameter parameters[] = {
    {"theta", "", "Position of the second stage, as a part of the step.", 1, ZD_POSITIVE, (const double[]){2.0 / 3}},
};

static void *create(zd_arena *arena, const void *table, zd_motion *motion, double *y, int size, const void *given)
{
    (void)table, (void)motion, (void)y;
    size_t n = (size_t)size;
    staged self = {*(const double *)given, size, zd_arena_doubles(arena, n), zd_arena_doubles(arena, n),
                   zd_arena_doubles(arena, n)};
    return zd_arena_copy(arena, &self, sizeof self);
}

static int step(void *memory, const zd_rate *rate, double t, double h, double *y, zd_statistics *statistics)
{
    const staged *self = memory;
    const double theta = self->theta, b = 1 / (2 * theta);
    (void)statistics;
    int status = rate->evaluate(rate->context, t, y, self->k1);
    for (int i = 0; i < rate->size; i++) self->stage[i] = y[i] + theta * h * self->k1[i];
    if (!status) status = rate->evaluate(rate->context, t + theta * h, self->stage, self->k2);
    for (int i = 0; i < rate->size && !status; i++) y[i] += h * ((1 - b) * self->k1[i] + b * self->k2[i]);
    return status;
}

const zd_integrator zd_ralston = {
    .card = {
        .name = "ralston",
        .summary = "Explicit methods of two stages, among them that of the smallest error.",
        .equations = "Ralston, 1962",
        .order = 2, .stability = 2,
        .description = "With theta = 2/3 the bound of the local error is least; theta = 1/2 is the midpoint rule, and theta = 1 "
                       "the method of Heun.",
        .reference = "A. Ralston, Runge-Kutta methods with minimum error bounds, Mathematics of Computation 16 (1962) 431-437",
        .parameters = 1, .parameter = parameters,
    },
    .create = create,
    .step = step,
};
"""

FORMULATION = r"""
/* (8) with iterative refinement: what the solution leaves of the equations is solved for again. */
#include "formulation.h"

#include "../point/point.h"

extern const zd_formulation zd_augmented_dense;

typedef struct refined {
    void *inner;
    int n, rows, times;
    double *M_memory, *C_memory;
    const double *M, *C;
    double *force, *rhs, *dx, *lambda, *dlambda;
} refined;

static const zd_parameter parameters[] = {
    {"refinements", "", "How often the remainder is solved for.", 1, ZD_COUNT, (const double[]){1}},
};

static void *create(zd_arena *arena, const zd_system *system, const void *given)
{
    size_t n = (size_t)system->nv, m = (size_t)zd_constraints(system);
    refined self = {
        .inner = zd_augmented_dense.create(arena, system, NULL), .n = (int)n, .times = (int)*(const double *)given,
        .M_memory = zd_arena_doubles(arena, n * n), .C_memory = zd_arena_doubles(arena, m * n),
        .force = zd_arena_doubles(arena, n), .rhs = zd_arena_doubles(arena, m), .dx = zd_arena_doubles(arena, n),
        .lambda = zd_arena_doubles(arena, m), .dlambda = zd_arena_doubles(arena, m),
    };
    return zd_arena_copy(arena, &self, sizeof self);
}

static int factor(void *memory, zd_point *point)
{
    refined *self = memory;
    int status = zd_augmented_dense.factor(self->inner, point);
    self->M = zd_dense_M(point, self->M_memory);
    self->C = zd_dense_C(point, self->C_memory);
    self->rows = point->rows;
    return status;
}

static void refine(refined *self, const double *force, const double *rhs, double *x)
{
    int n = self->n, rows = self->rows;
    for (int i = 0; i < n; i++) {
        self->force[i] = force ? force[i] : 0;
        for (int j = 0; j < n; j++) self->force[i] -= self->M[i * n + j] * x[j];
        for (int k = 0; k < rows; k++) self->force[i] -= self->C[k * n + i] * self->lambda[k];
    }
    for (int k = 0; k < rows; k++) {
        self->rhs[k] = rhs[k];
        for (int j = 0; j < n; j++) self->rhs[k] -= self->C[k * n + j] * x[j];
    }
    zd_augmented_dense.solve(self->inner, self->force, self->rhs, self->dx, self->dlambda);
    for (int i = 0; i < n; i++) x[i] += self->dx[i];
    for (int k = 0; k < rows; k++) self->lambda[k] += self->dlambda[k];
}

static void solve(void *memory, const double *force, const double *rhs, double *x, double *lambda)
{
    refined *self = memory;
    zd_augmented_dense.solve(self->inner, force, rhs, x, self->lambda);
    for (int i = 0; i < self->times; i++) refine(self, force, rhs, x);
    for (int k = 0; lambda && k < self->rows; k++) lambda[k] = self->lambda[k];
}

const zd_formulation zd_refined = {
    .card = {
        .name = "refined",
        .summary = "The matrix of (8), and its solution refined.",
        .equations = "(8), (25)",
        .description = "What the solution leaves of the equations is solved for with the same factors, as often as is asked for. "
                       "It is for this count of files alone.",
        .reference = "J. H. Wilkinson, Rounding Errors in Algebraic Processes, 1963",
        .parameters = 1, .parameter = parameters,
    },
    ZD_DEPENDENT_STATE,
    .create = create,
    .factor = factor,
    .solve = solve,
};
"""

CORRECTION = r"""
/* A part of the velocity violation is taken out after the step: v <- v - share solve(0, Psi), after (25b). */
#include "../constraints/limits.h"
#include "../motion/motion.h"
#include "../point/point.h"

typedef struct relaxation {
    double share;
    double *rhs, *v;        /* (m,), (nv,) */
} relaxation;

static const zd_parameter parameters[] = {
    {"share", "", "Of the violation that a step leaves, how much is taken out.", 1, ZD_POSITIVE, (const double[]){0.5}},
};

static void *create(zd_arena *arena, const zd_system *system, const void *given)
{
    relaxation self = {*(const double *)given, zd_arena_doubles(arena, (size_t)zd_constraints(system)),
                       zd_arena_doubles(arena, (size_t)system->nv)};
    return zd_arena_copy(arena, &self, sizeof self);
}

static int after_step(void *memory, zd_motion *motion)
{
    relaxation *self = memory;
    zd_point *point = motion->point;
    int status = zd_constraints(&motion->system) && (motion->drifts_from & ZD_C) ? ZD_DONE : ZD_PAUSED;
    if (status) return ZD_DONE;
    status = zd_point_need(point, ZD_C | ZD_M | ZD_PHI_T);
    if (!status) status = zd_motion_factor(motion);
    if (status) return status;
    zd_point_velocity_violation(point, self->rhs);
    for (int k = 0; k < zd_constraints(&motion->system); k++) self->rhs[k] *= self->share;
    status = zd_limits_replace(point, ZD_LIMIT_PSI, self->rhs);
    if (status) return status;
    zd_motion_solve(motion, NULL, self->rhs, self->v, NULL);
    for (int i = 0; i < motion->system.nv; i++) self->v[i] = point->v[i] - self->v[i];
    zd_point_move_velocity(point, self->v);
    return ZD_DONE;
}

const zd_correction zd_relaxation = {
    .card = {
        .name = "relaxation",
        .summary = "A part of the velocity violation is taken out after the step.",
        .equations = "(25)",
        .description = "As the projection does it for velocities, but not all of it. It is for this count of files alone.",
        .reference = "W. Blajer, 2002, section 3.1",
        .parameters = 1, .parameter = parameters,
    },
    .create = create,
    .after_step = after_step,
};
"""

SYSTEM = r"""
/* A point mass on a massless rod in space, in Cartesian coordinates. */
#include <math.h>
#include <string.h>

#include "kind.h"

enum { X, Y, Z, N };

typedef struct given {
    double L, m, g, angle, rate;
} given;

static int evaluate(const void *data, int want, double t, const double *p, const double *v, const zd_terms *out)
{
    (void)t;
    const given *q = data;
    if (want & ZD_M) memcpy(out->M, (double[]){q->m, 0, 0, 0, q->m, 0, 0, 0, q->m}, N * N * sizeof(double));
    if (want & ZD_FORCE) memcpy(out->f, (double[]){0, 0, -q->m * q->g}, N * sizeof(double));
    if (want & ZD_PHI) *out->Phi = (p[X] * p[X] + p[Y] * p[Y] + p[Z] * p[Z] - q->L * q->L) / (2 * q->L);
    for (int i = 0; (want & ZD_C) && i < N; i++) out->C[i] = p[i] / q->L;
    if (want & ZD_XI) *out->xi = -(v[X] * v[X] + v[Y] * v[Y] + v[Z] * v[Z]) / q->L;
    if (want & ZD_POTENTIAL) *out->V = q->m * q->g * p[Z];
    return ZD_DONE;
}

static const char *prepare(const double *parameters, double *to)
{
    memcpy(to, parameters, sizeof(given));
    return NULL;
}

static void start(const double *parameters, double *p, double *v)
{
    const given *q = (const given *)parameters;
    memcpy(p, (double[]){q->L * sin(q->angle), 0, -q->L * cos(q->angle)}, N * sizeof *p);
    memcpy(v, (double[]){0, q->rate * p[X], 0}, N * sizeof *v);
}

static void draw(const double *data, const double *p, double *points)
{
    (void)data;
    memcpy(points, (double[]){0, 0, 0, p[X], p[Y], p[Z]}, 6 * sizeof *points);
}

static const zd_parameter parameter[] = {
    {"length", "m", "of the rod", 1, ZD_POSITIVE, (const double[]){1}},
    {"mass", "kg", "", 1, ZD_POSITIVE, (const double[]){1}},
    {"gravity", "m/s^2", "downwards, along -z", 1, ZD_ANY, (const double[]){9.81}},
    {"angle", "rad", "at the start, from hanging straight down towards +x", 1, ZD_ANY, (const double[]){1}},
    {"rate", "rad/s", "at which it goes round at the start", 1, ZD_ANY, (const double[]){2}},
};

static const zd_variable coordinate[] = {{"x", "m"}, {"y", "m"}, {"z", "m"}};
static const zd_variable velocity[] = {{"x_dot", "m/s"}, {"y_dot", "m/s"}, {"z_dot", "m/s"}};
static const zd_variable constraint[] = {{"rod", "m"}};

const zd_kind zd_spherical_pendulum = {
    .card = {
        .name = "spherical_pendulum",
        .summary = "Point mass on a massless rod in space, in Cartesian coordinates.",
        .equations = "(3)",
        .description = "The pendulum with one dimension more, and so with two degrees of freedom. It is for this count of "
                       "files alone.",
        .reference = "L. D. Landau, E. M. Lifshitz, Mechanics, section 14",
    },
    .system = {
        .nq = N, .nv = N, .mh = 1,
        .provides = ZD_M | ZD_FORCE | ZD_PHI | ZD_C | ZD_XI | ZD_POTENTIAL | ZD_TIMELESS,
        .evaluate = evaluate,
    },
    ZD_PREPARED(sizeof(given) / sizeof(double)),
    .coordinate = coordinate, .velocity = velocity, .constraint = constraint,
    .points = 2, .dimension = 3, .draw = draw,
};
"""

PARALLEL = r"""    /* The second body keeps its angle from the first, and its point moves freely: one row. */
    {
        .card = {"parallel", "Keeps the angle between two bodies, and lets them move apart.", "(3), (5)", 0, 0, 0},
        .rows = 1,
        .row = {{.quantity = ZD_PLANE_ANGLE, .zero = ZD_ZERO_ANGLE}},
    },
"""

OFFSET_SLIDER = r"""    /* A slider whose axis runs beside the first body's point, at a distance that is given. */
    {
        .card = {"offset_slider", "Slides a body along an axis that runs beside a point of the other.", "(3), (5)", 0, 0, 0},
        .rows = 2,
        .row = {{.quantity = ZD_PLANE_ACROSS, .zero = ZD_ZERO_LENGTH}, {.quantity = ZD_PLANE_ANGLE, .zero = ZD_ZERO_ANGLE}},
        .coordinate = "displacement", .quantity = ZD_PLANE_ALONG, .zero = ZD_ZERO_ALONG,
        .takes_axis = 1, .takes_length = 1,
    },
"""

SOFT_GUIDE = r"""    /* A point is pulled back to a line of the first body, and moves along it freely. */
    {
        .card = {"soft_guide", "Spring with a damper across a line of the first body.", "(2), (28)", 0, 0, 0},
        .quantities = 1,
        .quantity = {ZD_PLANE_ACROSS}, .zero = {ZD_ZERO_ACROSS},
        .is_spring = 1, .axes = 1,
        .measure = "force", .sign = 1,
    },
"""

SOFT_PLANE = r"""    /* A point is pulled back along an axis of the first body, and moves across it freely. */
    {
        .card = {"soft_plane", "Spring with a damper along an axis of the first body.", "(2), (28)", 0, 0, 0},
        .quantities = 1,
        .quantity = {ZD_PLANE_ALONG}, .zero = {ZD_ZERO_ALONG},
        .is_spring = 1, .axes = 1,
        .measure = "force", .sign = 1,
    },
"""

SPACE_SOFT_PLANE = r"""    /* A point is pulled back along an axis of the first body, and moves across it freely. */
    {
        .card = {"soft_plane", "Spring with a damper along an axis of the first body.", "(2), (28)", 0, 0, 0},
        .quantities = 1,
        .pick = {{.quantity = ZD_SPACE_ALONG, .of_first = A, .zero = ZD_SPACE_ZERO_ALONG}},
        .is_spring = 1, .axes = 1,
        .measure = "force", .sign = 1,
    },
"""

SWIVEL = r"""    /* A body is turned back about an axis of the first body. */
    {
        .card = {"swivel", "Spring with a damper about an axis of the first body.", "(2), (28)", 0, 0, 0},
        .quantities = 1,
        .pick = {{.quantity = ZD_SPACE_ANGLE, .of_first = N, .of_second = N}},
        .is_spring = 1, .axes = 1,
        .measure = "torque", .sign = 1,
    },
"""

POINT_ON_PLANE = r"""    /* The second body's point stays in a plane of the first, whose normal is the axis. */
    {
        .card = {
            .name = "point_on_plane", .summary = "Keeps a point in a plane of the first body.", .equations = "(3), (5)",
            .description = "The body may turn about the point, and the point may slide. It is for this count of files alone.",
        },
        .rows = 1,
        .row = {POINT_IN_PLANE(A)},
        .axes = 1,
    },
"""

# A plate on a swinging arm, by a new kind of joint and by what there was; it prints how far motions and reactions are apart.
JOINTS_USED = r"""
import tempfile
import numpy as np
import sympy as sp
import zerodrift as zd

MOVED = "plate.position", "plate.angle", "arm.angle", "pin.force"
PLATE = "plate.position", "plate.angle", "arm.angle", "J.torque"
SLIDER = *PLATE, "J.displacement", "J.speed", "J.acceleration", "J.force", "push.power"
AXIS, PUSH = (0.6, 0.8), sp.sin(5 * sp.Symbol("t"))


def swing(join, *more):
    m = zd.Mechanism("swing", gravity=(0.2, -9.81))
    arm = m.link("arm", (0, 0), (0.6, -0.5), mass=1.5)
    m.revolute("pin", m.ground, arm.start)
    plate = m.body("plate", 0.8, 0.03, at=(0.5, 0.9), angle=0.4, com=(0.05, 0.02))
    m.spring("spring", arm.end, plate.center, stiffness=60.0, damping=0.5)
    joint = join(m, arm, plate)
    if more:
        m.motor("push", joint, force=PUSH)
        m.start({"J.speed": 0.0})       # as of a joint coordinate, which a joint outside the tree does not have
    m.start({"arm.angular_velocity": 1.5})
    return m


def parallel(m, arm, plate):
    return m.parallel("J", arm, plate.point((0, 0)))


def coupler(m, arm, plate):
    apart = 0.4 - np.arctan2(-0.5, 0.6)     # as drawn
    return m.coupler("J", sp.Symbol("b") - sp.Symbol("a") - apart, of={"a": arm.angle, "b": plate.angle})


def offset_slider(m, arm, plate):
    return m.offset_slider("J", arm.start, plate.point((0, 0)), axis=AXIS, length=0.2, damping=0.7)


def prismatic(m, arm, plate):
    return m.prismatic("J", arm.point(at=0.2 * np.array([-0.8, 0.6])), plate.point((0, 0)), axis=AXIS, damping=0.7)


def soft_guide(m, arm, plate):
    return m.soft_guide("J", arm, plate.point((0, 0)), axis=arm.pose.direction(np.array([1.0, 0.0])), stiffness=60.0, damping=0.5)


def soft_plane(m, arm, plate):
    return m.soft_plane("J", arm, plate.point((0, 0)), axis=arm.pose.direction(np.array([1.0, 0.0])), stiffness=60.0, damping=0.5)


def bushing_along(m, arm, plate):
    return m.bushing("J", arm, plate.point((0, 0)), stiffness=(60.0, 0.0), damping=(0.5, 0.0))


def bushing(m, arm, plate):
    return m.bushing("J", arm, plate.point((0, 0)), stiffness=(0.0, 60.0), damping=(0.0, 0.5))


def motion(m, layout, names, compiled=False):
    sol = zd.simulate(m.system(layout, compiled=compiled), 1.0, step=0.002)
    return np.hstack([np.asarray(sol[name]).reshape(len(sol.t), -1) for name in names])


for new, old, names, more in ((parallel, coupler, PLATE, ()), (offset_slider, prismatic, SLIDER, ("push",)),
                              (soft_guide, bushing, MOVED, ()), (soft_plane, bushing_along, MOVED, ())):
    m, other = swing(new, *more), swing(old, *more)
    with tempfile.TemporaryDirectory() as folder:
        again = zd.load(m.save(folder + "/m"))
    assert len(m.system()._sketches([m.system().p0])[0]) > 3
    for layout in ("joint", "absolute"):
        moved, expected = motion(m, layout, names), motion(other, layout, names)
        assert np.array_equal(moved, motion(again, layout, names))
        size = np.abs(expected).max(axis=0)
        errors = [np.max(np.abs(each - expected) / np.maximum(size, 1)) for each in (moved, motion(m, layout, names, True))]
        greatest = np.abs(moved[:, 4]).max()
        print(f"{new.__name__:15}{layout:10}{errors[0]:9.1e} compiled {errors[1]:9.1e}   greatest reaction {greatest:.3g}")
        assert max(errors) < 1e-8       # of the steps: coordinates of joints and of bodies are integrated differently
"""

# A rod with one end on a tilted plane, by a new kind of joint in space and by a constraint on that end; and a soft plane.
SPACE_USED = r"""
import inspect
import tempfile
import numpy as np
import sympy as sp
import zerodrift as zd

NORMAL, END = np.array([0.6, 0.0, 0.8]), [sp.Symbol(f"rod.end.position.{axis}") for axis in "xyz"]


def slide(join):
    m = zd.Mechanism("slide", dimension=3, gravity=(0.3, 0.2, -9.81))
    rod = m.link("rod", (0.0, 0.1, 0.9), (0.4, 0.2, -0.3), mass=1.2)
    m.body("plate", 0.7, (0.1, 0.2, 0.15), at=(0.0, 0.1, 0.9))
    m.spherical("ball", "plate", rod.start)
    m.spring("spring", m.ground.point((0, 0, 2)), "plate.center", stiffness=40.0, damping=0.3)
    join(m, rod)
    if join is by_joint:
        m.soft_plane("K", m.ground, rod.center, axis=(0, 1, 0), stiffness=25.0, damping=0.2)
    else:
        m.bushing("K", m.ground, rod.center, stiffness=(0, 25.0, 0), damping=(0, 0.2, 0))
    return m


def by_joint(m, rod):
    m.point_on_plane("J", m.ground.point(at=rod.end), rod.end, normal=NORMAL)


def by_constraint(m, rod):
    m.constraint("J", sum(n * (x - x0) for n, x, x0 in zip(NORMAL, END, rod.end.drawn)))


def motion(m, layout):
    sol = zd.simulate(m.system(layout), 1.0, step=0.002)
    return np.hstack([sol[name] for name in ("rod.position", "plate.position", "ball.force")])


assert [*inspect.signature(zd.Mechanism.point_on_plane).parameters][-2:] == ["normal", "at"]
m, other = slide(by_joint), slide(by_constraint)
assert any(shape.kind == "patch" and shape.name == "J" for shape in m.system()._sketches([m.system().p0])[0])
with tempfile.TemporaryDirectory() as folder:
    again = zd.load(m.save(folder + "/m"))
for layout in ("joint", "absolute"):
    moved, expected = motion(m, layout), motion(other, layout)
    assert np.array_equal(moved, motion(again, layout))
    error = np.max(np.abs(moved - expected) / np.maximum(np.abs(expected).max(axis=0), 1))
    force = zd.simulate(m.system(layout), 1.0, step=0.002)["J.force"]
    across = np.abs(np.cross(force, NORMAL)).max() / np.abs(force).max()
    print(f"point_on_plane {layout:10}{error:9.1e} tangential force {across:9.1e}   greatest reaction {np.abs(force).max():.3g}")
    assert error < 1e-8 and across < 1e-12      # steps; rounding
"""

# Motions with closed forms: a damped oscillator, a slider, a point on a slope, two wheels that turn alike.
CLOSED_FORMS = r"""
import numpy as np
import zerodrift as zd

K, C, MASS, INERTIA, V0 = 30.0, 0.8, 1.3, 0.2, 0.7


def oscillation(t, inertia):
    w, decay = np.sqrt(K / inertia - (C / (2 * inertia))**2), C / (2 * inertia)
    return V0 / w * np.exp(-decay * t) * np.sin(w * t)


def drawn(dimension, gravity=None):
    m = zd.Mechanism("box", dimension=dimension, gravity=gravity or (0.0,) * dimension)
    axis = np.array([0.6, 0.8] if dimension == 2 else [0.6, 0.0, 0.8])
    return m, m.body("box", MASS, INERTIA if dimension == 2 else (INERTIA,) * 3, at=(0.3,) * dimension), axis


def compared(what, m, expected, name):
    for layout in ("joint", "absolute"):
        sol = zd.simulate(m.system(layout), 1.0, step=0.002)
        error = np.max(np.abs(sol[name] - expected(sol)))
        print(f"{what:24}{layout:10}{error:9.1e} of a closed form")
        assert error < 1e-9         # of the steps


def elastic(kind, dimension):
    m, box, axis = drawn(dimension)
    getattr(m, kind)("K", m.ground, box.center, axis=axis, stiffness=K, damping=C)
    along = axis if kind == "soft_plane" else np.array([-axis[1], axis[0]])
    across = np.array([-along[1], along[0]]) if dimension == 2 else np.array([0.0, 1.0, 0.0])
    m.start({"box.velocity": V0 * along + across})
    compared(f"{kind} {dimension}", m, lambda sol: box.pose.origin + np.outer(oscillation(sol.t, MASS), along)
             + np.outer(sol.t, across), "box.position")


def swivel():
    m, box, axis = drawn(3)
    m.swivel("K", m.ground, box.center, axis=axis, stiffness=K, damping=C)
    m.start({"box.angular_velocity": V0 * axis})
    for layout in ("joint", "absolute"):
        sol = zd.simulate(m.system(layout), 1.0, step=0.002)
        angle = oscillation(sol.t, INERTIA)
        error = np.max(np.abs((np.trace(sol["box.rotation"], axis1=1, axis2=2) - 1) / 2 - np.cos(angle)))
        print(f"{'swivel 3':24}{layout:10}{error:9.1e} of a closed form")
        assert error < 1e-9 and np.abs(sol["K.torque"]).max() > 1


def alike():
    m, box, _ = drawn(2)
    other = m.body("other", 1.0, 0.4, at=(1.0, 0.2))
    m.revolute("pin", m.ground, box.center)
    m.parallel("J", box, other.center)
    m.motor("push", "pin", torque=0.5)
    compared("parallel 2", m, lambda sol: 0.5 * sol.t**2 / 2 / (INERTIA + 0.4), "box.angle")


def sliding():
    m, box, axis = drawn(2, gravity=(0.0, -9.81))
    at = box.pose.origin - 0.2 * np.array([-axis[1], axis[0]])
    m.offset_slider("J", m.ground.point(at), box.center, axis=axis, length=0.2, damping=C)
    end = -9.81 * axis[1] * MASS / C
    compared("offset_slider 2", m, lambda sol: end * (sol.t - MASS / C * (1 - np.exp(-C * sol.t / MASS))), "J.displacement")


def slope():
    m, box, normal = drawn(3, gravity=(0.0, 0.0, -9.81))
    m.point_on_plane("J", m.ground.point(box.pose.origin), box.center, normal=normal)
    down = np.array([0.0, 0.0, -9.81]) + 9.81 * normal[2] * normal
    compared("point_on_plane 3", m, lambda sol: box.pose.origin + np.outer(sol.t**2 / 2, down), "box.position")


for kind, dimension in (("soft_guide", 2), ("soft_plane", 2), ("soft_plane", 3)):
    elastic(kind, dimension)
for make in (swivel, alike, sliding, slope):
    make()
"""

LINE_OF_TERM = '    TERM(ZD_HEAT, 0x1000, heat, ZD_VECTOR(nv), ZD_OF_VELOCITIES, "what friction turns into heat, in W") \\\n'


def entry(table, text):
    """Place at the end of a table of joints or force elements, and its replacement with one more entry."""
    return rf"(\}};\n\nenum \{{ {table}_COUNT)", lambda match: text + match[1]


# What is added: the file that it is in, its text, the file that is changed, where, and by what.
ADDED = {
    "an integrator": ("csrc/integrators/ralston.c", INTEGRATOR, REGISTRY, r"(X\(zd_rattle\))", r"\1 X(zd_ralston)"),
    "a formulation": ("csrc/formulations/refined.c", FORMULATION, REGISTRY, r"(X\(zd_independent\))", r"\1 X(zd_refined)"),
    "a correction with a setting": ("csrc/corrections/relaxation.c", CORRECTION, REGISTRY, r"(X\(zd_projection_row\))",
                                    r"\1 X(zd_relaxation)"),
    "a system": ("csrc/systems/spherical_pendulum.c", SYSTEM, REGISTRY, r"(X\(zd_knife_edge\))",
                 r"\1 X(zd_spherical_pendulum)"),
    "a joint of the plane": (None, "", PLANE, *entry("JOINT", PARALLEL)),
    "a joint that takes something": (None, "", PLANE, *entry("JOINT", OFFSET_SLIDER)),
    "a joint of space": (None, "", SPACE, *entry("JOINT", POINT_ON_PLANE)),
    "a force element of the plane": (None, "", PLANE, *entry("ELEMENT", SOFT_GUIDE)),
    "another force element": (None, "", PLANE, *entry("ELEMENT", SOFT_PLANE)),
    "the same in space": (None, "", SPACE, *entry("ELEMENT", SPACE_SOFT_PLANE)),
    "a force element of space": (None, "", SPACE, *entry("ELEMENT", SWIVEL)),
    "a term": (None, "", INTERFACE, r"(    TERM\(ZD_GAMMA)", lambda match: LINE_OF_TERM + match[1]),
}
# Without tests of what the examples do not do: redundant constraints near bifurcations and of many bodies (the formulation),
# orders at steps as long as those of the built-in systems (the pendulum).
NAMES = ("(ralston or refined or relaxation or spherical_pendulum or heat or parallel or offset_slider or soft_guide "
         "or point_on_plane or soft_plane or swivel) and not small_singular_values and not small_pivot "
         "and not (refined and (many or large_structure)) "
         "and not (spherical_pendulum and (order_of_polynomials or between_rows))")
WHOLE = ["tests/test_registry.py", "tests/test_core.py", "tests/runs/test_methods.py", "tests/point/test_terms.py",
         "tests/test_structure_of_core.py", "tests/mechanisms/plane", "tests/mechanisms/test_joint_verbs.py",
         "tests/mechanisms/test_force_verbs.py", "tests/mechanisms/test_table_verbs.py", "tests/mechanisms/test_files.py",
         "tests/mechanisms/test_compiled.py"]


def words(before, after):
    """Number of words in which two texts differ; a backslash that continues a line is not one."""
    before, after = ([word for word in text.split() if word != "\\"] for text in (before, after))
    blocks = difflib.SequenceMatcher(None, before, after, autojunk=False).get_opcodes()
    return sum(max(b - a, d - c) for tag, a, b, c, d in blocks if tag != "equal")


def broken(text):
    """The text with the long lines of its tables broken."""
    lines = ([line] if len(line) <= WIDEST else [*line[:WIDEST - 2].rpartition(" ")[::2], line[WIDEST - 2:]]
             for line in text.split("\n"))
    return "\n".join(f"{head} \\\n    {''.join(rest)}" if rest else head for head, *rest in lines)


def add(folder, file, text, changed, where, by):
    """Adds one row; returns the files it is in, and how many files, words and lines were changed besides."""
    if file:
        (folder / file).write_text(text.lstrip())
    path = folder / changed
    before = path.read_text()
    after, times = re.subn(where, by, before, count=1)
    assert times == 1, f"{changed} has no {where}"
    path.write_text(after := broken(after))
    lines = sum(line.startswith("+ ") for line in difflib.ndiff(before.splitlines(), after.splitlines()))
    return 1 if file else 0, 1, words(before, after), lines


def run(folder, *command):
    """Output of a command; if it fails, the script exits."""
    folders = (str(folder / each) for each in ("python", "tests", "tests/support"))
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(folders)}
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stdout[-6000:]}\n{done.stderr[-3000:]}")
    return done.stdout


def main(folder):
    shutil.copytree(ROOT, folder, ignore=KEPT, dirs_exist_ok=True)
    print(f"{'':30}{'new files':>12}{'changed files':>16}{'words':>8}{'lines':>8}")
    for what, how in ADDED.items():
        new, changed, count, lines = add(folder, *how)
        print(f"{what:30}{new:12}{changed:16}{count:8}{lines:8}")
    run(folder, sys.executable, "setup.py", "-q", "build_ext", "--inplace")
    for script in (CLOSED_FORMS, JOINTS_USED, SPACE_USED):
        print(run(folder, sys.executable, "-c", script))
    run(folder, sys.executable, "tests/support/stubs.py")        # the generated declarations for editors
    for picked in ([*WHOLE], ["tests", "-k", NAMES]):
        print(run(folder, sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", *picked).splitlines()[-1])


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with tempfile.TemporaryDirectory() as temporary:
            main(Path(temporary))
