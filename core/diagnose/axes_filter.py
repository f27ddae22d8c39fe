r"""Kalman filter of a device with two axes that rotates at an unknown rate.

The motion depends on the rate, :math:`x^-=(\Phi+\Omega N)x+\Gamma u`, so the rate is one more state. It is estimated
separately from the motion: the motion has the steady gain of a known rate, and the sensitivity of its error to an error
of the rate is carried along. While the rate does not change this is the filter of all five states, without its
covariances (Friedland, IEEE Trans. Automatic Control 14, 1969).
"""

from __future__ import annotations

import math

from core.diagnose.axes_model import FORCES, STATES, AxesModel
from core.elementary import log
from core.kernel import flush_tiny, kernel
from core.record import Record, Vector, vector


class AxesFilter(Record):
    """Motion, its sensitivity to the rate, rate (rad/ms), its variance; last residuals, covariance, gains; room."""

    motion: Vector = vector(STATES)
    sensitivity: Vector = vector(STATES)
    moved: Vector = vector(STATES)
    spread: Vector = vector(STATES)
    gain: Vector = vector(2 * STATES)
    rate: float
    rate_gain_x: float
    rate_gain_y: float
    variance: float
    residual_x: float
    residual_y: float
    psi_x: float
    psi_xy: float
    psi_y: float
    nis: float


@kernel
def predict(m: AxesModel, f: AxesFilter, forces: Vector) -> None:
    r"""Advance over a tick, :math:`x\leftarrow(\Phi+\Omega N)x+\Gamma u,\;V\leftarrow\Phi V+Nx`."""
    for i in range(STATES):
        free = 0.0
        turned = 0.0
        sensitivity = 0.0
        for j in range(STATES):
            free += m.phi[STATES * i + j] * f.motion[j]
            turned += m.turn[STATES * i + j] * f.motion[j]
            sensitivity += m.phi[STATES * i + j] * f.sensitivity[j]
        for j in range(FORCES):
            free += m.push[FORCES * i + j] * forces[j]
        f.moved[i] = free + f.rate * turned
        f.spread[i] = sensitivity + turned
    for i in range(STATES):
        f.motion[i] = flush_tiny(f.moved[i])
        f.sensitivity[i] = flush_tiny(f.spread[i])


@kernel
def correct(m: AxesModel, f: AxesFilter, x: float, y: float) -> float:
    r"""Correct by both displacements; return the logarithm of the density of the residuals, except for a constant.

    .. math:: r=z-Hx^-,\quad S=HV,\quad\psi=\psi_0+SM S^T,\quad\Delta\Omega=MS^T\psi^{-1}r

    .. math:: V\leftarrow V-KS,\quad x=x^-+Kr+V\Delta\Omega,\quad M\leftarrow M-M^2S^T\psi^{-1}S

    The gain of the motion is :math:`K+VMS^T\psi^{-1}`, the gain of the rate :math:`MS^T\psi^{-1}`.
    """
    first = x - f.motion[0]
    second = y - f.motion[1]
    along = f.sensitivity[0]
    across = f.sensitivity[1]
    doubt = f.variance
    psi_x = m.psi_x + doubt * along * along
    psi_xy = m.psi_xy + doubt * along * across
    psi_y = m.psi_y + doubt * across * across
    determinant = psi_x * psi_y - psi_xy * psi_xy
    weighed_x = (psi_y * first - psi_xy * second) / determinant
    weighed_y = (psi_x * second - psi_xy * first) / determinant
    told_x = (psi_y * along - psi_xy * across) / determinant
    told_y = (psi_x * across - psi_xy * along) / determinant
    change = doubt * (along * weighed_x + across * weighed_y)
    f.variance = doubt * (1.0 - doubt * (along * told_x + across * told_y))
    f.rate += change
    f.rate_gain_x = doubt * told_x
    f.rate_gain_y = doubt * told_y
    for i in range(STATES):
        k1 = m.gain[2 * i]
        k2 = m.gain[2 * i + 1]
        f.sensitivity[i] -= k1 * along + k2 * across
        f.motion[i] += k1 * first + k2 * second + f.sensitivity[i] * change
        f.gain[2 * i] = k1 + f.sensitivity[i] * f.rate_gain_x
        f.gain[2 * i + 1] = k2 + f.sensitivity[i] * f.rate_gain_y
    square = first * weighed_x + second * weighed_y
    f.residual_x = first
    f.residual_y = second
    f.psi_x = psi_x
    f.psi_xy = psi_xy
    f.psi_y = psi_y
    f.nis = 0.5 * square
    return float(-0.5 * (square + log(determinant)))


@kernel
def variance_of(m: AxesModel, f: AxesFilter, i: int) -> float:
    r"""Return the variance of a corrected state, :math:`P_{0,ii}+V_i^2M`."""
    return float(m.variance[i] + f.sensitivity[i] * f.sensitivity[i] * f.variance)


@kernel
def is_seen(x: float, y: float) -> bool:
    """Say whether both displacements were measured."""
    return math.isfinite(x) and math.isfinite(y)
