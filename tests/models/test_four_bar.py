"""The paper's four-bar from bodies and joints against its one equation of motion, and against the built-in one."""


import known_motions
import zerodrift as zd
from support import assert_close, refused


def test_four_bar_against_its_one_equation_and_the_built_in_one():
    sols = [zd.simulate(bar, 0.8, step=0.01, integrator="dop853") for bar in (zd.models.four_bar(), zd.systems.four_bar())]
    assert known_motions.four_bar(sols[0]) < 1e-9
    assert_close(sols[0]["crank.angle"], sols[1].p[:, 0], 1e-9)
    assert_close(sols[0].kinetic_energy, sols[1].kinetic_energy, 1e-9)


def test_lengths_that_make_no_four_bar():
    with refused("geometry", r"of 1.*and 0\.6.*begin 4\.01123"):
        zd.models.four_bar(lengths=(4.0, 0.3, 1.0, 0.6))
    with refused("out-of-range", r"lengths\[1\].*than 0, not 0"):
        zd.models.four_bar(lengths=(1.0, 0.0, 1.0, 0.6))
