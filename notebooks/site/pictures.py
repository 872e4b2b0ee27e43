"""Writes the picture of the README, with the package as it is: ``python notebooks/site/pictures.py``. Notebooks hold their own pictures."""

from __future__ import annotations

from pathlib import Path

import matplotlib
from matplotlib.figure import Figure

import zerodrift as zd

FOLDER = Path(__file__).parent


def slider_crank() -> zd.Mechanism:
    """The mechanism of the README."""
    m = zd.Mechanism("slider-crank", gravity=(0, -9.81))
    crank = m.link("crank", (0, 0), (0.1, 0), mass=0.5)
    rod = m.link("rod", (0.1, 0), (0.4, 0), mass=0.3)
    piston = m.particle("piston", 0.4, at=(0.4, 0))
    main = m.revolute("main", m.ground, crank.start)
    m.revolute("pin", crank.end, rod.start)
    m.revolute("wrist", rod.end, piston)
    m.slot("cylinder", m.ground, piston, axis=(1, 0))
    m.motor("drive", main, speed=30.0)
    return m


def mechanisms() -> Figure:
    """Slider-crank with its reactions, Jansen's leg and a quick return with paths of points, and a planetary gear."""
    figure, axes = zd.plot.panels(1, 4, 15, 4.2, width_ratios=(1.35, 1.25, 1.1, 1.05))
    zd.plot.mechanism(zd.simulate(slider_crank(), 1.0), t=0.035, names=True, forces=["pin", "wrist", "cylinder"], ax=axes[0, 0])
    for ax, model, path in ((axes[0, 1], zd.models.jansen(), "F"), (axes[0, 2], zd.models.quick_return(), "ram")):
        zd.plot.mechanism(zd.simulate(model, 1.0, step=0.005), ghosts=3, path=path, ax=ax)
    zd.plot.mechanism(zd.simulate(zd.models.planetary_gear(), 0.6, step=0.002), t=0.1, ax=axes[0, 3])
    for ax in axes.flat:
        ax.axis("off")
    return figure


if __name__ == "__main__":
    matplotlib.use("Agg")
    mechanisms().savefig(FOLDER / "mechanisms.png", dpi=100)
