r"""Frequency response of a device: figures of the resonance, and the band within its tolerances.

The phase does not count the 180 degrees of the negative force per volt (1.3.2).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from core.block import FloatArray
from core.elementary import atan2, log

DECIBELS = 20.0 / 2.302585092994046
"""Over the natural logarithm of a ratio."""
ComplexArray = NDArray[np.complex128]


def response(mass_kg: float, damping_ns_m: float, stiffness_n_m: float, frequency_hz: FloatArray) -> ComplexArray:
    r"""Return the compliance, m/N (the same number as nm/nN), :math:`H=1/(k-m\omega^2+j\beta\omega)` (1.3.1)."""
    omega = 2.0 * np.pi * np.asarray(frequency_hz, dtype=np.float64)
    return np.asarray(1.0 / (stiffness_n_m - mass_kg * omega**2 + 1j * damping_ns_m * omega), dtype=np.complex128)


def magnitude(values: ComplexArray) -> FloatArray:
    """Return absolute values, by operations that are exact by the standard."""
    return np.asarray(np.sqrt(values.real * values.real + values.imag * values.imag))


def decibels(ratio: FloatArray) -> FloatArray:
    r"""Return :math:`20\lg r`; libraries pick their logarithm by the processor, this one is the same everywhere."""
    logs = np.reshape([log(float(one)) for one in np.ravel(ratio)], np.shape(ratio))
    return np.asarray(DECIBELS * logs)


def degrees(y: FloatArray, x: FloatArray) -> FloatArray:
    """Return the angles of points, the same bits everywhere."""
    angles = [atan2(float(up), float(across)) for up, across in zip(np.ravel(y), np.ravel(x), strict=True)]
    return np.asarray(np.degrees(np.reshape(angles, np.shape(y))))


def figures(mass_kg: float, damping_ns_m: float, stiffness_n_m: float) -> dict[str, float]:
    r"""Return the figures of the resonance.

    .. math:: \omega_0=\sqrt{k/m},\; \zeta=\frac{\beta}{2\sqrt{km}},\; Q=\frac1{2\zeta},\;
        \omega_p=\omega_0\sqrt{1-2\zeta^2},\; \frac{|H_p|}{|H_0|}=\frac1{2\zeta\sqrt{1-\zeta^2}},\;
        \left(\frac{\omega_{3dB}}{\omega_0}\right)^2=1-2\zeta^2\pm2\zeta\sqrt{1-\zeta^2}

    Without a peak (:math:`\zeta\ge1/\sqrt2`) the figures of the peak are the static figures, and half power is relative
    to them.
    """
    f0 = math.sqrt(stiffness_n_m / mass_kg) / (2.0 * math.pi)
    zeta = damping_ns_m / (2.0 * math.sqrt(stiffness_n_m * mass_kg))
    resonance = {"f0_hz": f0, "quality_factor": 0.5 / zeta, "damping_ratio": zeta}
    centre = 1.0 - 2.0 * zeta * zeta
    if centre > 0.0:
        peak = 1.0 / (2.0 * zeta * math.sqrt(1.0 - zeta * zeta))
        reach = 1.0 / peak
    else:
        peak = 1.0
        reach = math.sqrt(centre * centre + 1.0)
    return {
        **resonance,
        "f_peak_hz": f0 * math.sqrt(max(centre, 0.0)),
        "f_damped_hz": f0 * math.sqrt(max(1.0 - zeta * zeta, 0.0)),
        "peak_db": 20.0 * math.log10(peak),
        "half_power_low_hz": f0 * math.sqrt(max(centre - reach, 0.0)),
        "half_power_high_hz": f0 * math.sqrt(centre + reach),
        "decay_ms": 2e3 * mass_kg / damping_ns_m,
    }


@dataclass(frozen=True)
class Band:
    """Ranges of magnitude (dB re the nominal static displacement) and phase (degrees) at each frequency."""

    frequency_hz: FloatArray
    low_db: FloatArray
    nominal_db: FloatArray
    high_db: FloatArray
    low_deg: FloatArray
    nominal_deg: FloatArray
    high_deg: FloatArray


def tolerance_band(
    mass_kg: tuple[float, float, float],
    damping_ns_m: tuple[float, float, float],
    stiffness_n_m: tuple[float, float, float],
    frequency_hz: FloatArray,
) -> Band:
    r"""Return the exact envelope over all devices with parameters between their limits (figure 1.3.4).

    With :math:`D=k-m\omega^2` in :math:`[k_1-m_2\omega^2,\,k_2-m_1\omega^2]` and :math:`B=\beta\omega`, the magnitude
    is least at the largest :math:`D^2+B^2` and the phase :math:`-\mathrm{atan2}(B,D)` has its ends at the corners.

    Parameters
    ----------
    mass_kg, damping_ns_m, stiffness_n_m : tuple of float
        Lower limit, nominal value, upper limit.
    frequency_hz : ndarray
        Frequencies of the envelope.
    """
    omega = 2.0 * np.pi * np.asarray(frequency_hz, dtype=np.float64)
    least = stiffness_n_m[0] - mass_kg[2] * omega**2
    most = stiffness_n_m[2] - mass_kg[0] * omega**2
    nearest = np.where(least * most <= 0.0, 0.0, np.minimum(np.abs(least), np.abs(most)))
    farthest = np.maximum(np.abs(least), np.abs(most))
    inner, outer = damping_ns_m[0] * omega, damping_ns_m[2] * omega
    at_rest = stiffness_n_m[1]
    corners = np.array([-degrees(b, d) for b in (inner, outer) for d in (least, most)])
    nominal, side = stiffness_n_m[1] - mass_kg[1] * omega**2, damping_ns_m[1] * omega
    return Band(
        frequency_hz=np.asarray(frequency_hz, dtype=np.float64),
        low_db=decibels(at_rest / magnitude(farthest + 1j * outer)),
        nominal_db=decibels(at_rest / magnitude(nominal + 1j * side)),
        high_db=decibels(at_rest / magnitude(nearest + 1j * inner)),
        low_deg=corners.min(axis=0),
        nominal_deg=-degrees(side, nominal),
        high_deg=corners.max(axis=0),
    )
