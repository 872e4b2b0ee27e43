"""The same mechanisms in other units of length, mass and time."""

import dataclasses

import numpy as np

import energy_models
import zerodrift as zd


@dataclasses.dataclass(frozen=True)
class Units:
    """Conversion factors: numbers are multiplied by the number of new units in an old one."""

    length: float = 1.0
    mass: float = 1.0
    time: float = 1.0

    def of(self, length=0, mass=0, time=0):
        """Conversion factor of a quantity of this dimension."""
        return self.length**length * self.mass**mass * self.time**time

    @property
    def force(self):
        return self.of(1, 1, -2)

    @property
    def energy(self):
        return self.of(2, 1, -2)


def four_bar(u, lengths=(1.0, 0.3, 1.0, 0.6), masses=(1.0, 1.0, 3.0), **options):
    """The paper's, in these units."""
    return zd.systems.four_bar(lengths=u.length * np.array(lengths), masses=u.mass * np.array(masses),
                               gravity=9.81 * u.of(1, 0, -2), crank_rate=1.0 / u.time, **options)


def slider_crank(u):
    return energy_models.slider_crank(
        crank=0.5 * u.length, rod=1.0 * u.length, rest_length=1.0 * u.length, crank_inertia=u.of(2, 1),
        rod_inertia=2.0 * u.of(2, 1), slider_mass=1.0 * u.mass, stiffness=u.of(0, 1, -2), damping=u.of(0, 1, -1),
        pull=u.force, angle=1.0)


def pendulum(u):
    return zd.systems.pendulum(length=u.length, mass=u.mass, gravity=9.81 * u.of(1, 0, -2), angle=1.0, rate=0.5 / u.time)


# The system, and the dimension of its coordinates in powers of length.
MECHANISMS = {"four_bar": (four_bar, (0, 0, 0)), "slider_crank": (slider_crank, (0, 1, 0)), "pendulum": (pendulum, (1, 1))}


def scaled_back(name, u, sol):
    """t, p, v, multipliers and energies in the old units; rows of these closures are lengths."""
    lengths = np.array([u.length**power for power in MECHANISMS[name][1]])
    return {"t": sol.t / u.time, "p": sol.p / lengths, "v": sol.v * (u.time / lengths), "multipliers": sol.multipliers / u.force,
            "position_violation": sol.position_violation / u.length, "kinetic_energy": sol.kinetic_energy / u.energy,
            "energy_violation": sol.energy_violation / u.energy, "iterations": sol.iterations}


def run(name, u, t_end=1.0, steps=40, stabilization="projection", **options):
    """A motion in these units, its numbers scaled back."""
    if isinstance(stabilization, zd.Baumgarte):
        stabilization = zd.Baumgarte(stabilization.alpha / u.time, stabilization.beta / u.time**2)
    control = {} if "rtol" in options else {"step": t_end / steps * u.time}
    system = MECHANISMS[name][0](u)
    return scaled_back(name, u, zd.simulate(system, t_end * u.time, stabilization=stabilization, **control, **options))
