"""The trapezoidal rule where stiff forces make rates whose rounding error is all that Newton's iteration can leave."""

import numpy as np
import pytest

import zerodrift as zd

DURATION = 0.2


@pytest.fixture(scope="module")
def sleeve():
    """A sleeve on a rail and an arm on a hinge, joined by a damper whose mode decays at some 1e4 1/s."""
    m = zd.Mechanism("sleeve and arm", gravity=(0, -9.81))
    sleeve, arm = m.body("sleeve", 2.0, 0.01, at=(0, 0.4)), m.link("arm", (0.05, 0.9), (0.8, 0.45), mass=4.0)
    m.prismatic("rail", m.ground, sleeve, axis=(0, 1))
    m.revolute("hinge", m.ground, arm.start)
    m.spring("buffer", sleeve.point((0.05, 0)), arm.point((0.4, 0)), stiffness=5e5, damping=3e4)
    return m


@pytest.mark.parametrize("duration_of_step", [4e-3, 1e-3, 5e-4])
@pytest.mark.parametrize("equations", ["augmented", "nullspace", "schur", "mixed", "independent"])
def test_stiff_forces_in_absolute_coordinates(sleeve, equations, duration_of_step):
    """Entries of the state that are the rounding error of others had no digit that an iteration could find."""
    at_end = []
    for coordinates in ("joint", "absolute"):
        system = sleeve.system(coordinates)
        sol = zd.simulate(system, DURATION, step=duration_of_step, integrator="trapezoidal", formulation=equations)
        at_end.append(np.array([sol["hinge.angle"][-1], sol["rail.displacement"][-1]]))
    # both are trapezoidal rules, in other variables: they differ by their errors, of order two; measured at most 2e-3 at 4 ms
    assert at_end[0] == pytest.approx(at_end[1], abs=5e-3 * (duration_of_step / 4e-3) ** 2 + 1e-9)
