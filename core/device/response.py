r"""Response of the linear device to a whole record of held voltages."""

from __future__ import annotations

import numpy as np

from core.block import FloatArray, Oscillator
from core.device.oscillator import is_soft, transition, yielded
from core.kernel import kernel

AHEAD = 4


@kernel
def _recur(
    phi: FloatArray, drive: FloatArray, chain: FloatArray, reach: FloatArray, u: FloatArray, x: FloatArray
) -> None:
    """Advance four samples at a time: only one product of matrices depends on the last one.

    ``drive[j]`` is the effect of a voltage on the state j + 1 samples later, ``chain`` is the transition over four
    samples and ``reach[j]`` the first row of the transition over j samples.
    """
    n = u.shape[0]
    p = 0.0
    v = 0.0
    i = 0
    while i + AHEAD < n:
        a, b, c, d = u[i], u[i + 1], u[i + 2], u[i + 3]
        x[i] = p
        x[i + 1] = reach[1, 0] * p + reach[1, 1] * v + drive[0, 0] * a
        x[i + 2] = reach[2, 0] * p + reach[2, 1] * v + (drive[1, 0] * a + drive[0, 0] * b)
        x[i + 3] = reach[3, 0] * p + reach[3, 1] * v + (drive[2, 0] * a + drive[1, 0] * b + drive[0, 0] * c)
        e = drive[3, 0] * a + drive[2, 0] * b + (drive[1, 0] * c + drive[0, 0] * d)
        f = drive[3, 1] * a + drive[2, 1] * b + (drive[1, 1] * c + drive[0, 1] * d)
        p, v = chain[0, 0] * p + chain[0, 1] * v + e, chain[1, 0] * p + chain[1, 1] * v + f
        i += AHEAD
    while i < n:
        x[i] = p
        p, v = (
            phi[0, 0] * p + phi[0, 1] * v + drive[0, 0] * u[i],
            phi[1, 0] * p + phi[1, 1] * v + drive[0, 1] * u[i],
        )
        i += 1


def held_response(device: Oscillator, voltage: FloatArray, dt_ms: float) -> FloatArray:
    r"""Return the displacement at each sample under a held voltage, from rest.

    .. math:: x_{i+1}=\Phi x_i+\Gamma u_i,\quad \Phi=e^{A\,dt},\quad \Gamma=(I-\Phi)\,[k_p,\,0]^T

    Parameters
    ----------
    device : Oscillator
        The device.
    voltage : ndarray, shape (n,)
        Volts, held over the sample that starts there.
    dt_ms : float
        Sample interval.

    Returns
    -------
    ndarray, shape (n,)
        Displacement, um.
    """
    phi = np.array(transition(device.mass, device.damping, device.stiffness, dt_ms)).reshape(2, 2)
    gain = (np.eye(2) - phi) @ np.array([device.static_gain, 0.0])
    of = device.mass, device.damping, device.stiffness, dt_ms
    if is_soft(*of):
        gain[0] = device.force * yielded(*of)
    powers = [np.eye(2)]
    while len(powers) <= AHEAD:
        powers.append(phi @ powers[-1])
    drive = np.array([powers[j] @ gain for j in range(AHEAD)])
    reach = np.array([power[0] for power in powers])
    out = np.empty(len(voltage))
    _recur(phi, drive, powers[-1], reach, np.ascontiguousarray(voltage, dtype=np.float64), out)
    return out
