"""Angles of all sizes, and what their sines and cosines are with as many digits as it takes."""

import mpmath as mp
import numpy as np

ULPS = 0.8          # half a unit is the last rounding, a sixth of what is rounded before, and the rest of the polynomials
CONTRACTED = 1.0    # as a contracted product keeps what elsewhere is expected to be rounded off
LIMIT = 2.0**19     # beyond, angles are reduced by multiplying with 2/pi


def assert_accurate(found, angles, ulps=ULPS):
    """With enough digits for the reduction of the largest."""
    with mp.workprec(1300):
        for function, values in zip((mp.sin, mp.cos), found, strict=True):
            exact = [function(mp.mpf(angle)) for angle in angles.tolist()]
            units = [mp.mpf(float(np.spacing(abs(float(value))))) for value in exact]
            wrong = [float(abs(mp.mpf(value) - other) / unit)
                     for value, other, unit in zip(values.tolist(), exact, units, strict=True)]
            worst = int(np.argmax(wrong))
            assert wrong[worst] <= ulps, f"{function.__name__} of {angles[worst].hex()}: {wrong[worst]} units"


def near_multiples(multiples):
    """The doubles next to these multiples of pi/2, and their neighbours."""
    with mp.workprec(1300):
        nearest = np.array([float(int(k) * mp.pi / 2) for k in multiples])
    return np.concatenate([nearest, np.nextafter(nearest, np.inf), np.nextafter(nearest, -np.inf)])


def angles_of(kind):
    random = np.random.default_rng(2002)
    signs = random.choice([-1.0, 1.0], 600)
    return {
        "of a quadrant": lambda: random.uniform(-np.pi / 4, np.pi / 4, 600),
        "of a few turns": lambda: random.uniform(-20, 20, 600),
        "of many turns": lambda: random.uniform(-LIMIT, LIMIT, 600),
        "around the limit": lambda: np.concatenate([LIMIT + np.arange(-50, 50) * np.spacing(LIMIT), [-LIMIT, -LIMIT - 1e-9]]),
        "huge": lambda: signs * 2.0 ** random.uniform(19, 1024, 600),
        "tiny": lambda: signs * 2.0 ** random.uniform(-1074, 0, 600),
        "near multiples of a quarter turn": lambda: near_multiples(np.concatenate([np.arange(-100, 101),
                                                                                   random.integers(100, 333772, 200)])),
        "near multiples, far away": lambda: near_multiples(random.integers(2**19, 2**62, 200).astype(object) << 300),
        "the nearest there are": lambda: np.array([float.fromhex("0x1.6ac5b262ca1ffp+849"), 6381956970095103.0 * 2.0**797,
                                                   np.finfo(float).max]),
    }[kind]()


KINDS = ("of a quadrant", "of a few turns", "of many turns", "around the limit", "huge", "tiny",
         "near multiples of a quarter turn", "near multiples, far away", "the nearest there are")


def assert_same(one, other):
    for a, b in zip(one, other, strict=True):
        assert np.array_equal(np.asarray(a).view(np.int64), np.asarray(b).view(np.int64))
