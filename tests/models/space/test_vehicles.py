"""Whipple's bicycle against the benchmark's matrices and motions, and the double wishbone against distances and weights."""

import numpy as np
import pytest
import scipy.linalg
import scipy.optimize

import zerodrift as zd
from reference_files import definition, number
from support import assert_close
from zerodrift._private.rotations import rotation_of, turn
from zerodrift.models.space.double_wishbone import POINTS

EXACT = {"integrator": "dop853", "step": None, "rtol": 1e-11, "atol": 1e-11}


@pytest.mark.parametrize("case", ["M1", "M2", "M3"])
def test_the_bicycles_motions_of_the_benchmark(case):
    """In the file steer and y are to the left."""
    told = definition("bicycle_whipple")["IFToMM"]
    m = zd.models.whipple_bicycle(speed=told[case]["v"], roll_rate=told[case]["roll_rate"])
    sol = zd.simulate(m, 5.0, t_eval=[0.0, 1.0, 5.0], **EXACT)
    R = sol["frame.rotation"]
    found = {"roll": np.arctan2(R[:, 2, 1], R[:, 2, 2]), "V": sol.potential_energy, "T": sol.kinetic_energy,
             "roll_rate_body": np.einsum("ki,ki->k", R[:, :, 0], sol["frame.angular_velocity"]), "steer": -sol["steer.angle"],
             "steer_rate": -sol["steer.speed"], "xR": sol["rear.position.x"], "yR": -sol["rear.position.y"]}
    for row, moment in ((1, "1"), (2, "5")):
        expected = dict(zip(told["columns"], number(told["values"][case][moment]), strict=True))
        for name, column in found.items():
            assert_close(column[row], expected[name], 1e-8, scale=max(1.0, abs(expected[name])), what=name)


@pytest.mark.parametrize("speed", [2.0, 5.0, 8.0])
def test_small_motions_of_the_bicycle_are_those_of_its_linear_matrices(speed):
    """M q'' + v C1 q' + (g K0 + v^2 K2) q = 0 with q roll and steer; what is left is of third order in 1e-5."""
    told = definition("bicycle_whipple")
    M, C1, K0, K2 = (number(told[name]) for name in ("M", "C1", "K0", "K2"))
    A = np.block([[np.zeros((2, 2)), np.eye(2)],
                  [-np.linalg.solve(M, 9.81 * K0 + speed**2 * K2), -np.linalg.solve(M, speed * C1)]])
    eigenvalues = number(told["eigenvalues"][f"{speed:.0f}"])
    assert_close(np.sort_complex(np.linalg.eigvals(A)), np.sort_complex(eigenvalues @ (1, 1j)), 1e-9)
    for rates in ((1e-5, 0.0), (0.0, 1e-5)):
        m = zd.models.whipple_bicycle(speed=speed, roll_rate=rates[0], steer_rate=rates[1])
        sol = zd.simulate(m, 0.5, t_eval=np.linspace(0, 0.5, 6), integrator="dop853", step=None, rtol=1e-11, atol=1e-13)
        R = sol["frame.rotation"]
        found = np.stack([np.arctan2(R[:, 2, 1], R[:, 2, 2]), sol["steer.angle"]], axis=1) / 1e-5
        expected = np.array([scipy.linalg.expm(A * t) @ (0, 0, *np.array(rates) / 1e-5) for t in sol.t])[:, :2]
        assert_close(found, expected, 1e-6, scale=1.0)


def turning(*chain):
    """Angular velocity and acceleration of what turns about one axis after the other, (axis, angle, rate, its rate) each, and its
    rotation: an axis has the rate omega x axis, with the omega of those before it.
    """
    R, omega, alpha = np.eye(3), np.zeros(3), np.zeros(3)
    for axis, angle, rate, change in chain:
        e = R @ axis
        omega, alpha = omega + rate * e, alpha + change * e + rate * np.cross(omega, e)
        R = R @ rotation_of(turn(angle * np.asarray(axis, dtype=float)))
    return R, omega, alpha


def test_accelerations_of_the_bicycle_leaned_and_steered():
    """One state of the nonlinear equations, whose nine accelerations were published with 13 digits.

    There z is up and the bicycle goes along -x; the frame has turned about z, then x, then z of its own, which is to the left.
    """
    told = definition("bicycle_whipple")["BasuMandal2007_table1"]
    q, rate, change = ({name: float(value) for name, value in told[which].items()} for which in ("q", "qd", "qdd"))
    X, Z = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)
    frame = [(axis, q[name], rate[name], change[name]) for axis, name in ((Z, "theta"), (X, "psi"), (Z, "phi"))]
    ours, own = np.diag([-1.0, 1.0, -1.0]), np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])

    def about(axis, name):
        """A hinge of the model, which turns the other way."""
        return own @ axis, -q[name], -rate[name], -change[name]

    steered = [*frame, about((np.sin(np.pi / 10), 0, np.cos(np.pi / 10)), "psi_f")]
    chains = {"frame": frame, "fork": steered, "rear": [*frame, about((0, 1, 0), "beta_r")],
              "front": [*steered, about((0, 1, 0), "beta_f")]}
    R, omega, _ = turning(*frame)
    m = zd.models.whipple_bicycle()
    m.start({"rear.velocity.x": None, "frame.angular_velocity.x": None, "steer.angle": -q["psi_f"], "steer.speed": -rate["psi_f"],
             "rear axle.speed": -rate["beta_r"], "frame.rotation": ours @ R @ own, "frame.angular_velocity": ours @ omega})
    sol = zd.simulate(m, 1e-6, step=1e-6)
    for measure, expected in (("velocity", rate), ("acceleration", change)):
        assert_close(sol[f"rear.{measure}"][0], ours @ [expected[name] for name in "xyz"], 1e-11, what=measure)
    assert sol["rear.position.z"][0] == pytest.approx(-q["z"], rel=1e-11)
    assert sol["front axle.speed"][0] == pytest.approx(-rate["beta_f"], rel=1e-11)
    for body, chain in chains.items():
        assert_close(sol[f"{body}.angular_acceleration"][0], ours @ turning(*chain)[2], 1e-11, what=body)


def wishbone_by_distances(heave):
    """Camber, steer and the wheel's place above the car, where the lower arm has turned: by six distances between points."""
    P = {name: np.array(place, dtype=float) for name, place in POINTS.items()}
    middle = (P["lower ball"] + P["upper ball"] + P["tie outer"]) / 3
    own = {name: P[name] - middle for name in ("lower ball", "upper ball", "tie outer", "wheel")}
    held = [("lower front", "lower ball"), ("lower rear", "lower ball"), ("upper front", "upper ball"),
            ("upper rear", "upper ball"), ("tie inner", "tie outer")]

    def placed(y):
        R = rotation_of(turn(y[3:]))
        return {name: middle + y[:3] + R @ place for name, place in own.items()}

    def off(y, height):
        now = placed(y)
        return [*(np.linalg.norm(now[outer] - P[inner]) - np.linalg.norm(P[outer] - P[inner]) for inner, outer in held),
                now["wheel"][2] - P["wheel"][2] - height]

    y, found = np.zeros(6), []
    for height in heave:
        y = scipy.optimize.root(off, y, args=(height,), tol=1e-13).x
        found.append(rotation_of(turn(y[3:])))
    return np.array(found)


def test_the_double_wishbone_by_distances_and_weights():
    sol = zd.simulate(zd.models.double_wishbone(), 1.0, step=2e-3, integrator="dop853", save_every=25)
    above = sol["wheel.position.z"] - 0.3 - sol["heave.displacement"]
    assert np.ptp(above) > 0.02
    assert_close(sol["upright.rotation"], wishbone_by_distances(above), 1e-8, scale=1.0)
    masses = {"car": 350.0, "lower arm": 3.0, "upper arm": 2.0, "upright": 8.0, "wheel": 15.0}
    moved = sum(mass * (sol[f"{name}.acceleration.z"] + 9.81) for name, mass in masses.items())
    assert_close(378 * 9.81 + 2e5 * (0.02 * np.sin(12 * sol.t) + 0.3 - sol["wheel.position.z"]), moved, 1e-7)
    slack = np.linalg.norm(np.subtract(POINTS["strut top"], POINTS["strut foot"])) + 6000 / 4e4
    still = sol["strut.length"][0]
    assert sol["strut.force"][0] == pytest.approx(4e4 * (still - slack), rel=1e-9)
