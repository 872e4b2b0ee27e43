"""Motions of `zd.models` from independent sources: closed forms, equations by hand, and files of references.

Each function has a model's name, takes a motion of it and the model's arguments where they differ, and returns the largest
deviation, in m or rad. Nothing here is computed by the code under test.
"""

import numpy as np
import scipy.integrate

from circles import complex_of, crossing, four_bar_by_circles, jansen_by_circles
from reference_files import definition, number, table


def points_off(sol, expected):
    """Largest distance of points from the expected complex numbers by name, m."""
    return max(np.abs(complex_of(sol, name) - place).max() for name, place in expected.items())


def off(*pairs):
    """The largest deviation of found from expected numbers."""
    return max(np.abs(np.asarray(found) - expected).max() for found, expected in pairs)


# ---- from rest, or let go: against references, closed forms and equations by hand ----


def andrews(sol):
    """The published motion, at the times of its table."""
    reference = table("A03_andrews")
    K = [None, *(sol[f"K{i}.angle"] for i in range(1, 8))]
    told = {"beta": K[1], "theta": K[2] - K[1], "gamma": K[3], "phi": K[4] - K[5], "delta": K[5], "omega": K[6] - K[7],
            "eps": K[7]}
    rows = np.searchsorted(reference["t"], sol.t - 1e-9)
    return off(*((angle, reference[name][rows]) for name, angle in told.items()))


def slider_crank(sol):
    """The reference's motion, at the times of its table."""
    reference = table("sundials_slider_crank")
    rows = np.searchsorted(reference["t"], sol.t - 1e-9)
    return off(*((sol[measure], reference[name][rows]) for name, measure in {
        "q": "crank.angle", "x": "slider.position.x", "p": "rod.angle"}.items()))


def four_bars(sol):
    """The reference's ends, at 1, 4 or 10 s."""
    given = [definition("A02_fourbar")["reference"][f"N2_t{t:.0f}"] for t in sol.t[1:]]
    return off((sol["crank0.end.position"][1:], np.array([number([each["x"], each["y"]]) for each in given])))


def closed_chain(sol, names, lengths, masses):
    """Slender links pinned at both ends, in their angles: (8) with M and all the rest by hand, from where sol starts."""
    n, L, m = len(names), np.array(lengths), np.array(masses)
    carried = np.append(np.cumsum(m[::-1])[::-1][1:], 0.0)      # the masses beyond each link
    last = np.maximum.outer(np.arange(n), np.arange(n))
    share = np.outer(L, L) * ((m / 2 + carried)[last] - np.diag(m / 6))

    def rate(t, y):
        p, v = np.split(y, 2)
        turned = p[:, None] - p
        C = np.array([-L * np.sin(p), L * np.cos(p)])
        right = -9.81 * L * (m / 2 + carried) * np.cos(p) - share * np.sin(turned) @ v**2
        both = np.block([[share * np.cos(turned), C.T], [C, np.zeros((2, 2))]])
        xi = np.array([L * np.cos(p), L * np.sin(p)]) @ v**2
        return np.concatenate([v, np.linalg.solve(both, np.concatenate([right, xi]))[:n]])

    angles, rates = (np.stack([sol[f"{name}.{what}"] for name in names], axis=1) for what in ("angle", "angular_velocity"))
    expected = scipy.integrate.solve_ivp(rate, (0, sol.t[-1]), np.concatenate([angles[0], rates[0]]), method="DOP853",
                                         rtol=1e-13, atol=1e-13, t_eval=sol.t).y
    return off((angles, expected[:n].T))


def four_bar(sol):
    """A closed chain, whose joint is where circles meet."""
    B, C = four_bar_by_circles(sol["crank.angle"], (1.0, 0.3, 1.0, 0.6), 1)
    return max(closed_chain(sol, ("crank", "coupler", "rocker"), (0.3, 1.0, 0.6), (1.5, 5.0, 3.0)),
               points_off(sol, {"crank.end": B, "rocker.start": C}))


def closed_pendulum(sol, links=4, length=1.0):
    """A closed chain of links that are all the same."""
    return closed_chain(sol, [f"link{i + 1}" for i in range(links)], [length] * links, [1.0] * links)


def bicycle(sol):
    """Two balances by hand; see `tests/models/test_bicycle.py`, whose numbers these are."""
    w, b, m, J, m_f, J_f, swing, pace, k_s, c = 1.1, 0.5, 85.0, 10.0, 5.0, 0.3, 0.3, 1.5, 60.0, 4.0

    def rate(t, y):
        _, _, yaw, steer, u, steer_rate = y
        k, slope = np.tan(steer) / w, 1 / (np.cos(steer)**2 * w)
        torque = -k_s * (steer - swing * np.sin(pace * t)) - c * steer_rate
        turning = m * b**2 + J + m_f * w**2
        u_rate = (-turning * k * u * slope * steer_rate - k * torque) / (m + m_f + turning * k**2)
        yaw_rate_rate = u_rate * k + u * slope * steer_rate
        return [u * np.cos(yaw), u * np.sin(yaw), u * k, steer_rate, u_rate, torque / J_f - yaw_rate_rate]

    y = scipy.integrate.solve_ivp(rate, (0, sol.t[-1]), [0, 0, 0, 0, 5.0, 0], method="DOP853", rtol=1e-12, atol=1e-12,
                                  t_eval=sol.t).y
    return off((sol["frame.position"], y[:2].T), (sol["frame.angle"], y[2]), (sol["head.angle"], y[3]))


def quarter_car(sol, body_mass=2500.0, wheel_mass=320.0, stiffness=80e3, damping=350.0, rate=2 * np.pi):
    """M x'' + D x' + K x = (0, k_t w + d_t w'): a forced vibration by the transfer function, and modes of the eigenvalues."""
    k, d, k_t, d_t = stiffness, damping, 500e3, 15020.0
    M, D, K = np.diag([body_mass, wheel_mass]), np.array([[d, -d], [-d, d + d_t]]), np.array([[k, -k], [-k, k + k_t]])
    forced = 0.05 * np.linalg.solve(K + 1j * rate * D - rate**2 * M, [0.0, k_t + 1j * rate * d_t])
    first_order = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])
    values, modes = np.linalg.eig(first_order)
    shares = np.linalg.solve(modes, -np.concatenate([forced.imag, (1j * rate * forced).imag]))      # from rest
    return off(*((sol[f"{name} guide.displacement"],
                  (forced[row] * np.exp(1j * rate * sol.t)).imag + (np.exp(np.outer(sol.t, values)) @ (modes[row] * shares)).real)
                 for row, name in enumerate(("body", "wheel"))))


def snakeboard(sol, wheel_rate=1.0):
    """With the axles at s and -s, the middle goes along the board at u, and yaw' = u tan(s) / l.

    Along that motion, m u' + tan(s) / l (J yaw'' + J_r r'') = 0: J is of all together, r the rotor's angle, and the axles'
    moments cancel.
    """
    half, total, rotor = 0.2, 0.016 + 0.072 + 2 * 0.0013, 0.072

    def rate(t, y):
        _, _, yaw, u = y
        s, s_rate = 0.3 * np.sin(wheel_rate * t), 0.3 * wheel_rate * np.cos(wheel_rate * t)
        k, k_rate = np.tan(s) / half, s_rate / (half * np.cos(s)**2)
        u_rate = -k * (total * u * k_rate - rotor * 0.7 * np.sin(t)) / (6.0 + total * k**2)
        return [u * np.cos(yaw), u * np.sin(yaw), u * k, u_rate]

    x, y, yaw, _ = scipy.integrate.solve_ivp(rate, (0, sol.t[-1]), [0.0] * 4, method="DOP853", rtol=1e-12, atol=1e-14,
                                             t_eval=sol.t).y
    return off((sol["board.position"], np.stack([x, y], axis=1)), (sol["board.angle"], yaw))


# ---- driven: where drives have them, by geometry ----


def jansen(sol, scale=0.01):
    """Circles that meet."""
    return points_off(sol, {name: scale / 0.01 * place for name, place in jansen_by_circles(sol["crank.angle"]).items()})


def klann(sol, scale=0.4):
    """Circles that meet."""
    O, A, B = 1.599 + 0.750j, 1.366 + 1.366j, 1.009 + 0.574j        # noqa: E741 - as the model calls it
    M = O + 0.268 * np.exp(1j * sol["crank.angle"])
    C = crossing(M, B, 0.590, 0.321, -1)
    D = crossing(M, C, 1.105, 0.522, -1)
    E = crossing(D, A, 0.897, 0.518, 1)
    F = crossing(D, E, 0.897, 1.732, -1)
    return points_off(sol, {name: scale * place for name, place in {"M": M, "C": C, "D": D, "E": E, "F": F}.items()})


def stephenson(sol):
    """Circles that meet."""
    B, C = four_bar_by_circles(sol["crank.angle"], (0.135, 0.080, 0.105, 0.120), 1)
    E = B + 0.225 * np.exp(1j * np.radians(20)) * (C - B) / 0.105
    G = crossing(E, 0.195 * np.exp(-1j * np.radians(20)), 0.180, 0.180, 1)
    return points_off(sol, {"B": B, "C": C, "E": E, "G": G})


def hoecken(sol, crank=0.1, ground=2.5, coupler=3.25):
    """B, D and P have one distance from C, so by Thales' theorem B D P is a right angle, and D P is known from D B."""
    to_crank = crank * np.exp(1j * sol["crank.angle"]) - crank * ground
    across = np.sqrt((2 * crank * coupler)**2 - np.abs(to_crank)**2)
    return points_off(sol, {"P": crank * ground - 1j * to_crank / np.abs(to_crank) * across})


def chebyshev_lambda(sol, crank=0.1):
    """As Hoecken's, of which it is one."""
    return hoecken(sol, crank, 2.0, 2.5)


def peaucellier(sol, arm=0.25, side=0.12, crank=0.1, amplitude=1.2, rate=2 * np.pi):
    """Inversion in a circle."""
    angle = amplitude * np.sin(rate * sol.t)
    return points_off(sol, {"P": (arm**2 - side**2) / (2 * crank) * (1 + 1j * np.tan(angle / 2))})


def watt(sol, rocker=0.5, coupler=0.2, amplitude=0.35):
    """Circles that meet."""
    B = rocker * np.exp(1j * amplitude * np.sin(2 * np.pi * sol.t))
    return points_off(sol, {"P": (B + crossing(B, 2 * rocker - 1j * coupler, coupler, rocker, -1)) / 2})


def pantograph(sol, ratio=2.0):
    """The figure, which the pen draws larger by the ratio; bars by circles."""
    Q = 0.2 + 0.05 * np.sin(2 * np.pi * sol.t) + 1j * (0.12 + 0.025 * np.sin(4 * np.pi * sol.t))
    A = crossing(0, Q, 0.2, 0.2, 1)
    return points_off(sol, {"Q": Q, "A": A, "B": ratio * A, "C": Q + (ratio - 1) * A, "P": ratio * Q})


def scissor_lift(sol, stages=3, arm=1.0):
    """The height is stages arm sin(angle), and the platform is level."""
    foot = arm * np.cos(0.6) + 0.1 * np.sin(np.pi * sol.t)
    return off((sol["roller.position.x"], foot), (sol["platform.position.y"], stages * np.sqrt(arm**2 - foot**2)),
               (sol["platform.angle"], 0.0))


def quick_return(sol, ground=0.025, crank=0.010, lever=0.065, rod=0.030, height=0.050, speed=-15.0):
    """The lever points to the crank's pin, and the ram is where the rod has it."""
    pin = 1j * ground + crank * np.exp(1j * speed * sol.t)
    angle = np.unwrap(np.angle(pin))
    ram = lever * np.cos(angle) + np.sqrt(rod**2 - (lever * np.sin(angle) - height)**2)
    return off((sol["lever.angle"], angle), (sol["ram.position.x"], ram))


def ram_by_cosines(crank):
    """The toggle press's knee and height of the ram at crank angles (k,)."""
    knee = crossing(0.6j, 0.352 + 0.3j + 0.05 * np.exp(1j * crank), 0.3, 0.3, -1)
    between = np.pi - 2 * np.arcsin(knee.real / 0.3)        # of the two links at the knee
    return knee, 0.6 - np.sqrt(2 * 0.3**2 * (1 - np.cos(between)))


def toggle_press(sol):
    """The law of cosines."""
    knee, height = ram_by_cosines(2 * np.pi * sol.t)
    return max(points_off(sol, {"K": knee}), off((sol["ram.position.y"], height)))


def cam_lift(angle, lift, rise, dwell, fall):
    """The cam's lift and its second derivative at angles within a turn, by NumPy's polynomials."""
    up = np.polynomial.Polynomial([0, 0, 0, 0, 35, -84, 70, -20])
    begin = (2 * np.pi - rise - dwell - fall) / 2
    x, y = (angle - begin) / rise, (begin + rise + dwell + fall - angle) / fall
    where = [(x > 0) & (x < 1), (x >= 1) & (y >= 1), (y > 0) & (y < 1)]
    values = [np.select(where, parts) for parts in (
        [up(x), np.ones_like(x), up(y)], [up.deriv(2)(x) / rise**2, np.zeros_like(x), up.deriv(2)(y) / fall**2])]
    return lift * values[0], lift * values[1]


def cam_follower(sol, rise=np.pi / 2, dwell=np.pi / 2, fall=np.pi / 2):
    """The profile's polynomial."""
    return off((sol["guide.displacement"], cam_lift(2 * np.pi * sol.t, 0.0254, rise, dwell, fall)[0]))


def planetary_gear(sol, sun=40, planet=20, planets=3, sun_speed=-100 * np.pi / 30):
    """Willis's equation, (w_sun - w_carrier) / (w_ring - w_carrier) = -z_ring / z_sun, as angles."""
    carrier, ring = -200 * np.pi / 30, sun + 2 * planet
    turned = {"carrier": carrier, "sun": sun_speed, "ring": carrier - (sun_speed - carrier) * sun / ring}
    arm = 0.0025 * (sun + planet)
    places = {f"planet{i}": arm * np.exp(1j * (2 * np.pi * i / planets + carrier * sol.t)) for i in range(planets)}
    return max(off(*((sol[f"{name}.angle"], speed * sol.t) for name, speed in turned.items())), points_off(sol, places))
