"""Structures: nothing is free to move, and there are more rows than velocities. Against closed forms, and in balance."""

import numpy as np
import pytest

import zerodrift as zd

G = 9.81


def truss(bays, dimension=2):
    """A cantilever of square bays with both diagonals, each of which has one bar too many; a kilogram at each of its nodes."""
    m = zd.Mechanism("truss", dimension=dimension, gravity=(0, -G, 0)[:dimension])
    place = lambda x, y: (x, y, 0)[:dimension]      # noqa: E731
    low, high = m.ground.point(place(0, 0)), m.ground.point(place(0, 1))
    for i in range(1, bays + 1):
        ends = [m.particle(f"{name}{i}", 1.0, at=place(i, y)) for name, y in (("low", 0), ("high", 1))]
        if dimension == 3:
            for end, y in zip(ends, (0, 1), strict=True):
                m.rod(f"across{i}{y}", m.ground.point((i, y, 1)), end)
        bars = {"bottom": (low, ends[0]), "top": (high, ends[1]), "post": ends, "up": (low, ends[1]), "down": (high, ends[0])}
        for name, (first, second) in bars.items():
            m.rod(f"{name}{i}", first, second)
        low, high = ends
    return m


@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_panel_with_a_bar_too_many(dimension, layout, formulation):
    """Its load is odd about half of its height, and what balances itself is even: forces of least effort are odd, too."""
    m = truss(1, dimension)
    assert "constraints is redundant: down1" in str(m)
    sol = zd.simulate(m.system(layout), 0.1, step=0.01, formulation=formulation)
    for bar, force in {"bottom": -G, "top": G, "post": 0, "up": -np.sqrt(2) * G, "down": np.sqrt(2) * G}.items():
        np.testing.assert_allclose(sol[f"{bar}1.tension"], force, atol=1e-12)
    np.testing.assert_allclose(sol.p, np.tile(sol.p[0], (len(sol.t), 1)), rtol=0, atol=1e-14)    # forces balance to rounding


@pytest.mark.parametrize("layout", ["joint", "absolute"])
@pytest.mark.parametrize("bays", [4, 12])
def test_nodes_of_a_cantilever_are_in_balance(bays, layout, formulation):
    """Except roundings of the largest force, as many as the condition of S = C M^-1 C^T, where M is one.

    Twelve bays, more than 40 rows, are solved in blocks with the independent rows, whose condition is a hundred times that of
    all.
    """
    system = truss(bays).system(layout)
    sol = zd.simulate(system, 0.05, step=0.01, formulation=formulation)
    singular = np.linalg.svd(system.evaluate(sol.p[0], sol.v[0]).C, compute_uv=False)
    off = 2.0**-52 * (singular[0] / singular[-1]) ** 2 * (1 if bays == 4 else 256)
    tension = {name: sol[f"{name}.tension"] for name in (f"{bar}{i}" for i in range(1, bays + 1)
                                                          for bar in ("bottom", "top", "post", "up", "down"))}
    for i in range(1, bays + 1):
        after = {bar: tension.get(f"{bar}{i + 1}", 0) for bar in ("bottom", "top", "up", "down")}
        here = {bar: tension[f"{bar}{i}"] for bar in ("bottom", "top", "post", "up", "down")}
        low = (after["bottom"] - here["bottom"] + (after["up"] - here["down"]) / np.sqrt(2),
               here["post"] + (after["up"] + here["down"]) / np.sqrt(2) - G)
        high = (after["top"] - here["top"] + (after["down"] - here["up"]) / np.sqrt(2),
                -here["post"] - (after["down"] + here["up"]) / np.sqrt(2) - G)
        np.testing.assert_allclose([*low, *high], 0, atol=off * max(np.abs(each).max() for each in tension.values()))
    np.testing.assert_allclose(sol.p, np.tile(sol.p[0], (len(sol.t), 1)), atol=1e-8)
