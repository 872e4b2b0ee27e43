"""`zd.Structure`, and what systems make of it."""

import pickle

import numpy as np
import pytest

import zerodrift as zd
from native_systems import needs_compiler
from structured import Bodies, bodies_library, chain
from support import assert_same_bits, refused
from zerodrift._private import gateway

PAIR = zd.Structure(blocks=[3, 3], groups=[(2, [0]), (2, [0, 1])], mass="diagonal")


def test_sizes_and_places():
    structure = zd.Structure(blocks=[(4, 3), (1, 1), 2], groups=[(2, [0, 2]), (1, [1])], mass=["", "constant", "diagonal"])
    assert (structure.nq, structure.nv, structure.m) == (7, 6, 3)
    assert structure.offsets("A") == (0, 12, 13, 17)
    assert structure.offsets("M") == (0, 9, 10, 12)
    assert structure.offsets("C") == (0, 10, 11)
    assert structure.expand("M", np.arange(12.0) + 1)[3:].tolist() == [
        [0, 0, 0, 10, 0, 0], [0, 0, 0, 0, 11, 0], [0, 0, 0, 0, 0, 12]]
    assert structure.expand("C", np.arange(11.0) + 1).tolist() == [
        [1, 2, 3, 0, 4, 5], [6, 7, 8, 0, 9, 10], [0, 0, 0, 11, 0, 0]]


@pytest.mark.parametrize("term", ["A", "M", "C"])
def test_what_is_packed_is_expanded_to_the_same(term):
    packed = np.random.default_rng(1).normal(size=PAIR.size(term))
    assert (PAIR.pack(term, PAIR.expand(term, packed)) == packed).all()


def test_a_structure_is_equal_to_its_like_prints_and_pickles():
    assert pickle.loads(pickle.dumps(PAIR)) == PAIR
    assert eval(repr(PAIR), {"Structure": zd.Structure}) in {PAIR}
    assert hash(PAIR) == hash(zd.Structure([3, 3], [(2, [0]), (2, [0, 1])], "diagonal"))
    assert zd.Structure([3, 3], [(2, [0]), (2, [0, 1])]) != PAIR


@pytest.mark.parametrize(("arguments", "code", "sentence"), [
    ({"blocks": 3}, "declared-structure", "blocks"),
    ({"blocks": []}, "declared-structure", "blocks"),
    ({"blocks": [3, 0]}, "out-of-range", r"blocks\[1\].*between 1"),
    ({"blocks": [3.0]}, "wrong-type", r"blocks\[0\].*not 3.0"),
    ({"blocks": [(4, 3, 1)]}, "declared-structure", r"blocks\[0\]"),
    ({"blocks": [3], "groups": 2}, "declared-structure", "groups"),
    ({"blocks": [3], "groups": [2]}, "declared-structure", r"groups\[0\].*not 2"),
    ({"blocks": [3], "groups": [(1, [0], 2)]}, "declared-structure", r"groups\[0\]"),
    ({"blocks": [3], "groups": [(0, [0])]}, "out-of-range", r"groups\[0\].*between 1"),
    ({"blocks": [3], "groups": [(1, [0]), (1, [1])]}, "declared-structure", r"groups\[1\].*block 1.*blocks 0.*to 0"),
    ({"blocks": [3], "groups": [(1, [])]}, "declared-structure", r"groups\[0\]"),
    ({"blocks": [3, 3], "groups": [(1, [1, 0])]}, "declared-structure", r"groups\[0\]"),
    ({"blocks": [3, 3], "groups": [(1, [0, 0])]}, "declared-structure", None),
    ({"blocks": [3], "groups": [(1, [-1])]}, "out-of-range", r"groups\[0\].*between 0"),
    ({"blocks": [3], "mass": "light"}, "unknown-choice", "^mass must.*'', 'constant', 'diagonal', 'constant diagonal'"),
    ({"blocks": [3], "mass": ["", ""]}, "declared-structure", "^mass must.*or 1.*not 2"),
])
def test_what_is_not_a_structure_is_refused(arguments, code, sentence):
    with refused(code, sentence):
        zd.Structure(**arguments)


def test_what_does_not_fit_is_refused():
    with refused("unknown-choice", "^term must.*'A', 'M', 'C', not 'f'"):
        PAIR.size("f")
    with refused("declared-structure", "dense.*6, 6.*2, 2"):
        PAIR.pack("M", np.eye(2))
    with refused("declared-structure", "0, 4.*is 0.5"):
        PAIR.pack("M", np.eye(6) + 0.5 * np.eye(6, k=4))


def given(**changed):
    return {"mass": np.eye(6), "constraints": lambda p: np.array([p[0], p[1], p[3] - p[0], p[4] - p[1]]), "p0": np.zeros(6),
            "structure": PAIR} | changed


@pytest.mark.parametrize(("changed", "code", "sentence"), [
    ({"structure": [3, 3]}, "wrong-type", "structure.*zd.Structure"),
    ({"structure": zd.Structure([3], [(4, [0])])}, "declared-structure", "has 3.*has 6"),
    ({"structure": zd.Structure([3, 3], [(2, [0])])}, "declared-structure", "has 2"),
    ({"structure": zd.Structure([(4, 3), (2, 3)], [(4, [0, 1])])}, "declared-structure",
     "block 0.*has 4.*and 3"),
    ({"constraints": lambda p: np.array([p[0], p[1], p[3]]), "nonholonomic": lambda p: np.ones((1, 6))}, "declared-structure",
     "group 1.*rows 2.*to 3.*first 3"),
])
def test_a_system_refuses_a_structure_that_is_not_its_own(changed, code, sentence):
    with refused(code, sentence):
        zd.System(6, **given(**changed))


@pytest.mark.parametrize(("changed", "sentence"), [
    ({"mass": np.eye(6) + 0.1 * np.eye(6, k=3) + 0.1 * np.eye(6, k=-3)}, r"mass\[0, 3\] is 0.1, where the structure has nothing"),
    ({"constraints": lambda p: np.array([p[0], p[5], p[3] - p[0], p[4] - p[1]])}, r"the constraint matrix\[1, 5\] is 1, where"),
    ({"kinematics": lambda p: np.eye(6) + np.eye(6, k=5), "constraints": None, "structure": zd.Structure([3, 3])},
     r"kinematics\[0, 5\] is 1, where"),
])
def test_an_entry_without_a_place_is_never_dropped(changed, sentence):
    with refused("declared-structure", sentence + r".*\(at t = 0\)"):
        zd.simulate(zd.System(6, **given(**changed)), 0.1, step=0.01)


def test_a_term_that_is_not_finite_is_named_as_a_matrix():
    system = zd.System(6, **given(mass=lambda p: np.diag([1, 1, 1, 1, 1, np.nan if p[5] else 1.0])))
    with refused("not-finite"):
        system.evaluate(np.ones(6))     # as anywhere else, it is noticed by the core, which names the callable


def test_systems_with_structure_say_so_are_changed_and_pickled():
    system = zd.System(6, **given(mass=lambda m: m * np.eye(6), parameters={"m": 1.0}, constraints=None, jacobian=None,
                                  structure=zd.Structure([3, 3]), force=np.ones(6)))
    assert repr(system).endswith("2 blocks and 0 groups of constraints>")
    changed = system.with_parameters(m=2.0)
    assert changed.structure == system.structure
    assert zd.acceleration(changed, np.zeros(6), np.zeros(6))[0] == pytest.approx(np.full(6, 0.5))
    assert zd.systems.pendulum().structure is None


@needs_compiler
def test_native_systems_with_structure_are_changed_and_pickled():
    system = chain(3).system()
    copy = pickle.loads(pickle.dumps(system))
    assert copy.structure == system.structure
    assert_same_bits(zd.simulate(system, 0.1, step=0.01), zd.simulate(copy, 0.1, step=0.01))
    assert (system.with_parameters(q2=0.0).evaluate().f == 0).all()


@needs_compiler
def test_a_native_function_that_does_not_write_as_its_structure_says_is_refused():
    options = {"symbol": "dense", "terms": ["M", "f", "Phi", "C", "xi"], "constraints": 4, "scratch": 6, "p0": chain(2).p0,
               "parameters": chain(2).system().parameters, "structure": PAIR}
    with refused("compiled-function", r"it writes beyond M, which is of shape \(6,\)"):
        zd.native(bodies_library(), 6, **options)
    with refused("compiled-function", "terms cannot have D where the structure is declared"):
        zd.native(bodies_library(), 6, **(options | {"terms": [*options["terms"], "D", "gamma"]}))


def test_systems_that_are_off_by_rounding_stay_symmetric():
    random = Bodies(4)
    system = random.system(mass=random.M)
    core = gateway.perturbed(system._core, 2.0**-52, 1)
    one, other = core.evaluate(0.0, random.p, random.v), system.evaluate(random.p, random.v)
    assert (one["M"] == one["M"].T).all()
    for name in ("M", "C", "xi", "f"):
        off = np.abs(one[name] - getattr(other, name))
        assert 0 < off.max() < 1e-13
        assert (off[getattr(other, name) == 0] == 0).all()
