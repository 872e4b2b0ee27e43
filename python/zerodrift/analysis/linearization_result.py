"""The result of `linearize`: matrices, eigenvalues, modes, inputs and outputs."""

from __future__ import annotations

import copy
import functools
from typing import Any

import numpy as np

from .._private import checks
from ..errors import WrongValue
from . import differences
from .flow import Flow
from .names import dominant, labelled, pivots
from .quantities import find, names_of
from .spectrum import complement, of_matrix
from .state import State, sizes_of, state

LEFT = 1e-9                 # of an output: its part along ignorable coordinates that is rounding
EIGENVALUE_ROUNDING = 1e-12  # of an eigenvalue: a smaller real part is printed as zero


class Linearization:
    """A linear motion z' = rate + A z + B u, y = C z + D u, (p, v) = (p0, v0) + basis z.

    Attributes
    ----------
    system : system
    t, p, v : float, ndarray (nq,), (nv,)
        The state.
    A, B, C, D : ndarray (k, k), (k, inputs), (outputs, k), (outputs, inputs)
    basis : ndarray (nq + nv, k)
        N = [[A W, 0], [Y, V]]; W and V are orthonormal in the mass metric, and N^+ (dp, dv) = (z1, z2) with z1 = W^T M A^+ dp,
        z2 = V^T M (dv - Y z1), where A maps velocities to the rates of coordinates.
    names : tuple of str
        The coordinate or velocity that changes most along each column of the basis.
    inputs, outputs : tuple of str
        Names of the components.
    eigenvalues : ndarray (n,), complex
        In 1/s, sorted by magnitude, zeros of ignorable coordinates left out. At an instant of a motion that is not steady they
        depend on the coordinates, as those of any nonlinear system do away from its equilibria.
    frequencies : ndarray (n,)
        Natural frequencies in Hz, ``abs(eigenvalues) / (2 pi)``.
    damping : ndarray (n,)
        Damping ratios, ``-real / abs``.
    modes : ndarray (nq + nv, n), complex
        Eigenvectors in coordinates and velocities.
    ignored : tuple of str
        A name for each zero that was left out: coordinates on which nothing depends, and their speeds.
    rate : ndarray (k,)
        z' = N^+ (A v, vdot) at the state itself; zero in an equilibrium or a steady motion.
    rotation : ndarray (3,)
        Angular velocity in rad/s of the frame in which the motion is steady.
    phase : dict of str to str
        State of each contact, stop, joint that switches and dry friction: closed, joined or sticking ones are constraints.
    is_exact : bool
        True: the derivatives of the accelerations are the system's own; False: they are finite differences.
    """

    def __init__(self, flow: Flow, B: np.ndarray, C: np.ndarray, D: np.ndarray, inputs: tuple[str, ...],
                 outputs: tuple[str, ...]) -> None:
        at = flow.at
        self._at, self.system, self.t, self.p, self.v = at, at.system, at.t, at.p, at.v
        self.phase: dict[str, str] = getattr(at.system, "phase", {})
        self.A, self.B, self.C, self.D, self.inputs, self.outputs = flow.A, B, C, D, inputs, outputs
        self.basis, self.rate, self.rotation = flow.tangent.basis, flow.rate, flow.Omega
        self.is_exact = flow.derivatives.is_exact
        self._instant = None if flow.is_steady else (flow.vdot, flow.columns[2])    # accelerations and their changes
        self._spectrum = of_matrix(self.A)
        self.eigenvalues, self.frequencies = self._spectrum.eigenvalues, self._spectrum.frequencies
        self.damping, self.modes = self._spectrum.dampings, self.basis @ self._spectrum.vectors
        self.ignored = tuple(pivots(at, self.basis @ self._spectrum.removed))

    @property
    def ABCD(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """The four matrices, as ``scipy.signal.StateSpace(*lin.ABCD)`` takes them."""
        return self.A, self.B, self.C, self.D

    @functools.cached_property
    def names(self) -> tuple[str, ...]:
        """The coordinate or velocity that changes most along each column of the basis."""
        nq = self.system.nq
        speeds = [each.name for each in self.system.velocities]
        return tuple(dominant(self._at, column[:nq]) or speeds[int(np.abs(column[nq:]).argmax())] for column in self.basis.T)

    def dominant(self, mode: int) -> str:
        """The coordinate that moves most in a mode, ignored ones left out."""
        nq = self.system.nq
        name = dominant(self._at, self.modes[:nq, mode], self.ignored)
        return name or self.system.velocities[int(np.abs(self.modes[nq:, mode]).argmax())].name

    def frequency_response(self, omega: Any) -> np.ndarray:
        """Responses ``C (i omega - A)^-1 B + D`` at angular frequencies omega (j,) in rad/s, (j, outputs, inputs), complex.

        They are infinite, ``complex(inf, nan)`` as in python-control, where i omega is an eigenvalue of A: at an undamped
        resonance, and at zero with ignorable coordinates.

        Examples
        --------
        >>> import numpy as np
        >>> import zerodrift as zd
        >>> lin = zd.linearize(zd.systems.oscillator(), (0.0, [0.0], [0.0]), inputs=["x"], outputs=["x"])
        >>> bool(np.isclose(lin.frequency_response([0.5])[0, 0, 0], 1 / (10 - 0.25)))
        True
        """
        return np.array([self._response(w) for w in np.atleast_1d(omega)])

    def _response(self, w: float) -> np.ndarray:
        """The response (outputs, inputs) at an angular frequency."""
        try:
            return self.C @ np.linalg.solve(1j * w * np.eye(len(self.A)) - self.A, self.B) + self.D
        except np.linalg.LinAlgError:
            return np.full(self.D.shape, complex(np.inf, np.nan))

    def in_coordinates(self, names: Any) -> np.ndarray:
        """A (2 n, 2 n) in n quantities of positions and their rates, ignorable coordinates left out.

        Where the motion is not steady, this is the Jacobian of the equations of motion reduced to these quantities x, that of
        (x', x'') with respect to (x, x').

        Parameters
        ----------
        names : sequence of str or measure
            Names of measures of positions, as many as half of the eigenvalues; they must not depend on ignorable coordinates.
            The printed names of rotations, such as ``"frame rotation about x"``, are among them.

        Raises
        ------
        ValueError
            If they do not determine the motion.
        """
        return self._quantities(names_of(names, "names"))[1]

    def _quantities(self, wanted: list[str]) -> tuple[np.ndarray, np.ndarray]:
        """Matrix (2 n, k) from states to quantities and their rates, and A (2 n, 2 n) in these."""
        J, nv = np.vstack([_row(self._at, name) for name in wanted]), self.system.nv
        if self._instant is not None:
            return self._in_quantities(wanted, J @ self._quasi[:nv])
        Q = complement(self._spectrum.removed)
        Y = np.vstack([J @ self._quasi[:nv], J @ self._quasi[nv:] + self._rates(wanted)]) @ Q
        if Y.shape[0] != Y.shape[1] or np.linalg.cond(Y) > 1e9:
            raise WrongValue(f"names must be {Q.shape[1] / 2:g} quantities that determine the motion, not {checks.shown(wanted)}",
                             "wrong-measure")
        return Y @ Q.T, Y @ (Q.T @ self.A @ Q) @ np.linalg.inv(Y)

    def reduced(self, names: Any = None) -> Linearization:
        """The linearization without ignorable coordinates, which SciPy's Riccati and Lyapunov solvers take.

        Parameters
        ----------
        names : sequence of str or measure, optional
            Names of measures of positions, as in `in_coordinates`: states are these and their rates. Left out: states are along
            columns of `basis`, whose number is that of the eigenvalues.

        Returns
        -------
        Linearization
            With A, B, C, D, `names` and `basis` of these states, and nothing in `ignored`.

        Raises
        ------
        ValueError
            If names do not determine the motion, or an output depends on an ignorable coordinate.

        Examples
        --------
        A pole on a cart, whose position is ignorable:

        >>> import zerodrift as zd
        >>> m = zd.Mechanism("cart", gravity=(0, -9.81))
        >>> cart, pole = m.body("cart", 1.0, 0.1), m.link("pole", (0, 0), (0, 1), mass=0.1)
        >>> rail = m.prismatic("rail", m.ground, cart, axis=(1, 0))
        >>> pin = m.revolute("pin", cart.point((0, 0)), pole.start)
        >>> lin = zd.linearize(m, inputs=["rail.force"]).reduced([pin.angle])
        >>> lin.names, lin.A.shape, float(lin.B[1, 0].round(3))
        (('pin.angle', "pin.angle'"), (2, 2), 1.463)
        """
        Q = complement(self._spectrum.removed)
        to, A = (Q.T, Q.T @ self.A @ Q) if names is None else self._quantities(names_of(names, "names"))
        back = np.linalg.pinv(to)
        C = self.C @ back
        missed, size = np.abs(C @ to - self.C).max(axis=1, initial=0.0), np.abs(self.C).max(axis=1, initial=0.0)
        if (left := np.flatnonzero(missed > LEFT * size)).size:
            raise WrongValue(f"outputs must not depend on ignorable coordinates or on others than names, and "
                             f"{self.outputs[left[0]]!r} does", "wrong-measure")
        found = copy.copy(self)
        vars(found).pop("names", None)
        if names is not None:
            wanted = names_of(names, "names")
            vars(found)["names"] = (*wanted, *(f"{name}'" for name in wanted))
        found.A, found.B, found.C, found.basis, found.rate = A, to @ self.B, C, self.basis @ back, to @ self.rate
        found._spectrum, found.ignored = of_matrix(A), ()
        found.eigenvalues, found.frequencies = found._spectrum.eigenvalues, found._spectrum.frequencies
        found.damping, found.modes = found._spectrum.dampings, found.basis @ found._spectrum.vectors
        return found

    def _in_quantities(self, names: list[str], changes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Matrix of quantities and their rates at an instant, if these determine their own motion, and the Jacobian."""
        rates = self._second_rates(names)
        Y = np.vstack([changes, rates[:len(changes)]])
        found = np.linalg.lstsq(Y.T, rates.T, rcond=None)[0].T
        left = np.abs(found @ Y - rates).max(initial=0.0)
        if np.linalg.matrix_rank(Y, tol=1e-9 * np.linalg.norm(Y, 2)) < len(Y) or left > 1e-7 * np.abs(rates).max(initial=0.0):
            raise WrongValue(f"names must be independent quantities that determine their motion, not {checks.shown(names)}",
                             "wrong-measure")
        return Y, found

    @property
    def _quasi(self) -> np.ndarray:
        """The basis in displacements and velocities, (2 nv, k)."""
        nq = self.system.nq
        return np.vstack([np.linalg.lstsq(self._at.A, self.basis[:nq], rcond=None)[0], self.basis[nq:]])

    def _rates(self, names: list[str]) -> np.ndarray:
        """Changes of the rows of these quantities along the basis, times v: zero at rest."""
        at, columns = self._at, []
        basis = self.basis[:self.system.nq].T
        for dp, size in zip(basis, sizes_of(at, basis, np.zeros((len(basis), self.system.nv))), strict=True):
            def rates(h: float, dp: np.ndarray = dp) -> np.ndarray:
                there = state(at.system, at.t, at.p + h * dp, at.v)
                return np.concatenate([_row(there, name) @ at.v for name in names])

            columns.append(differences.along(rates, size))
        return np.array(columns).T

    def _second_rates(self, names: list[str]) -> np.ndarray:
        """Changes (2 n, k) of the rates of these quantities and of their second rates along the basis, at an instant."""
        assert self._instant is not None
        at, (vdot, dvdot), nq, columns = self._at, self._instant, self.system.nq, []
        for direction, change in zip(self.basis.T, dvdot.T, strict=True):
            dp, dv = direction[:nq], direction[nq:]
            size = float(sizes_of(at, dp[None], dv[None])[0])

            def rates(h: float, dp: np.ndarray = dp, dv: np.ndarray = dv, change: np.ndarray = change) -> np.ndarray:
                there = state(at.system, at.t, at.p + h * dp, at.v + h * dv)
                return _rates_of(there, names, vdot + h * change, at)

            columns.append(differences.along(rates, size))
        return np.array(columns).T

    def __repr__(self) -> str:
        lines = [f"<linearization of {self.system.name}: {len(self.A)} states, {len(self.eigenvalues)} eigenvalues>",
                 "    frequency [Hz]   damping ratio   eigenvalue [1/s]            dominant coordinate"]
        for i, value in enumerate(self.eigenvalues):
            if value.imag < 0:
                continue
            is_damped = abs(value.real) > EIGENVALUE_ROUNDING * abs(value)
            number = f"{value.real if is_damped else 0.0:+.6g}" + (f" ± {value.imag:.6g}i" if value.imag else "")
            damping = self.damping[i] if is_damped else 0.0
            lines.append(f"    {self.frequencies[i]:<16.6g} {damping:<15.4g} {number:<27} {self.dominant(i)}")
        if self.phase:
            lines.append(f"  phase: {', '.join(f'{name} {word}' for name, word in self.phase.items())}")
        if self.ignored:
            lines.append(f"  ignored: {', '.join(self.ignored)}")
        if np.any(self.rate):
            lines.append("  not a steady motion: A is that of an instant")
        return "\n".join(lines)


def _row(at: State, name: str) -> np.ndarray:
    """The derivative (size, nv) of the rate of a quantity, or of a rotation of a quaternion, with respect to the velocities."""
    names, rows = labelled(at)
    if _is_rotation(name, names):
        return rows[[names.index(name)]] @ at.A
    found = find(at, name, "names")
    if found.is_velocity:
        raise WrongValue(f"names must be quantities of positions, and {name!r} is a velocity", "wrong-measure")
    return found.row


def _is_rotation(name: str, names: list[str]) -> bool:
    """The name is that of a rotation of a quaternion."""
    return " rotation about " in name and name in names


def _rates_of(at: State, names: list[str], vdot: np.ndarray, reference: State) -> np.ndarray:
    """Rates and second rates (2 n,) of quantities; rotations are the scaled vector parts of quaternions from the reference."""
    (labels, rows), found = labelled(reference), []
    for name in names:
        parts = [(1.0, name)] if not _is_rotation(name, labels) else [
            (by, each.name) for by, each in zip(rows[labels.index(name)], at.system.coordinates, strict=True) if by]
        terms = [(by, find(at, part, "names")) for by, part in parts]
        found.append([sum(by * each.rate for by, each in terms), sum(by * (each.row @ vdot + each.bias) for by, each in terms)])
    return np.hstack(found).ravel()
