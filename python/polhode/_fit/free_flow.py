"""The free motion of a fit at the times of its data, with exact derivatives."""

from __future__ import annotations

import numpy as np

from polhode._algebra.constructors import bivector, multivector
from polhode._algebra.rotor import Rotor
from polhode._fit.parameters import Layout, Parameters
from polhode._mechanics.free_motion import FreeMotion
from polhode._mechanics.inertia import Inertia
from polhode._support.arrays import Array


class FreeFlow:
    """Attitudes and angular velocities of the axes of the data; times count from the start."""

    # Derivatives have errors of rounding.
    precision = float(np.finfo(float).eps)

    def __init__(self, layout: Layout) -> None:
        self._layout = layout

    def _motion(self, at: Parameters) -> FreeMotion:
        """Return the motion of the principal axes."""
        rotor = Rotor.identity() if at.rotor is None else at.rotor
        inertia = Inertia.from_principal_moments(*at.moments.tolist())
        return FreeMotion(inertia, rotor * ~at.axes, at.axes(bivector(at.omega)))

    def states(self, at: Parameters, of_attitudes: Array, of_rates: Array) -> tuple[Rotor, Array]:
        """Return rotors (n,) and angular velocities (m, 3) at the times."""
        motion = self._motion(at)
        rates = motion.at(of_rates).omega_body.components @ at.axes.to_matrix()
        return motion.at(of_attitudes).rotor * at.axes, rates

    def derivatives(self, at: Parameters, of_attitudes: Array, of_rates: Array) -> tuple[Array, Array, Array]:
        """Return turns in space axes (n, 3, k), and those of the rates (m, 3, k) and (m, 3) by time.

        The k parameters are those of the motion. With M the matrix of `axes` and ω the angular velocity in
        principal axes, a small turn δ of the axes changes ``ω(0)`` by ``δ×ω(0)``, the attitude of the
        principal axes at the start by the turn ``−R δ ~R`` in space, and the rates of the data by
        ``Mᵀ(ω×δ)``.
        """
        motion, matrix, of = self._motion(at), at.axes.to_matrix(), self._layout.places
        start = _crosses(matrix @ at.omega)
        turns = np.zeros((len(of_attitudes), 3, self._layout.motion))
        if len(of_attitudes):
            d, rotors = motion.derivatives(of_attitudes), motion.at(of_attitudes).rotor
            parts = (d.d_rotor_d_moments, d.d_rotor_d_omega, d.d_rotor_d_attitude)
            by_moments, by_omega, by_turn = (_turns(x, rotors) for x in parts)
            turns[..., of["shape"]] = by_moments @ at.moments_by_shape()
            turns[..., of["omega"]] = by_omega @ matrix
            turns[..., of["attitude"]] = by_turn
            if self._layout.axes:
                begin = motion.at(0.0).rotor.to_matrix()
                turns[..., of["axes"]] = rotors.to_matrix() - by_turn @ begin - by_omega @ start
        rates = np.zeros((len(of_rates), 3, self._layout.motion))
        d = motion.derivatives(of_rates)
        back = matrix.T
        rates[..., of["shape"]] = back @ d.d_omega_d_moments @ at.moments_by_shape()
        rates[..., of["omega"]] = back @ d.d_omega_d_omega @ matrix
        if self._layout.axes:
            now = _crosses(motion.at(of_rates).omega_body.components)
            rates[..., of["axes"]] = back @ (now - d.d_omega_d_omega @ start)
        return turns, rates, d.d_omega_dt @ matrix


def _turns(columns: Array, rotors: Rotor) -> Array:
    """Return the turns in space axes (n, 3, k) of changes of rotors (n, 4, k): ``−2 dR ~R``."""
    even = np.zeros((*columns.shape[:-2], columns.shape[-1], 8))
    even[..., [0, 4, 5, 6]] = np.swapaxes(columns, -1, -2)
    turned = -2 * multivector(even) * ~rotors[..., np.newaxis]
    return np.swapaxes(turned.grade(2).components, -1, -2)


def _crosses(vectors: Array) -> Array:
    """Return the matrices (..., 3, 3) of the cross products with vectors (..., 3) on the left."""
    x, y, z = np.moveaxis(vectors, -1, 0)
    zero = np.zeros_like(x)
    rows = [[zero, -z, y], [z, zero, -x], [-y, x, zero]]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))
