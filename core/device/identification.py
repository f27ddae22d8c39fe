r"""Mass, damping and stiffness from a measured frequency response, with standard errors."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from core.block import FloatArray
from core.device.frequency import ComplexArray, figures
from core.errors import InputError
from core.units import UM_PER_M

ITERATIONS = 30


@dataclass(frozen=True)
class SweepTone:
    """One frequency of a sweep: response in um/V, its standard error, and the share of power at that tone."""

    frequency_hz: float
    response: complex
    error: float
    coherence: float


def tone(frequency_hz: float, dt_ms: float, voltage: FloatArray, displacement: FloatArray, *, held: bool) -> SweepTone:
    r"""Return the response at one tone from a steady record, by least squares.

    A voltage held by a converter reaches the device as :math:`\mathrm{sinc}(fT)\,e^{-j\pi fT}` of its samples; the fit
    takes this factor out. The images of the staircase are beyond the resonance and below 1e-4 of the tone.

    Parameters
    ----------
    frequency_hz : float
        The tone.
    dt_ms : float
        Sample interval.
    voltage, displacement : ndarray, shape (n,)
        A record of whole cycles, in V and um.
    held : bool
        Whether the voltage is held between samples.
    """
    angle = 2.0 * math.pi * frequency_hz * 1e-3 * dt_ms * np.arange(len(voltage))
    basis = np.column_stack([np.cos(angle), -np.sin(angle), np.ones_like(angle)])
    (ur, ui, _), *_ = np.linalg.lstsq(basis, voltage, rcond=None)
    (xr, xi, offset), *_ = np.linalg.lstsq(basis, displacement, rcond=None)
    rest = displacement - basis @ np.array([xr, xi, offset])
    power = float(np.sum((displacement - offset) ** 2))
    drive = complex(ur, ui)
    if held:
        turn = frequency_hz * 1e-3 * dt_ms
        drive *= np.sinc(turn) * np.exp(-1j * math.pi * turn)
    if drive == 0.0:
        raise InputError("there is no voltage at this tone", "reference.amplitude_v")
    spread = math.sqrt(float(rest @ rest) / max(len(rest) - 3, 1)) * math.sqrt(2.0 / len(rest))
    return SweepTone(
        frequency_hz=frequency_hz,
        response=complex(complex(xr, xi) / drive),
        error=spread / abs(drive),
        coherence=1.0 - float(rest @ rest) / power if power > 0.0 else 0.0,
    )


@dataclass(frozen=True)
class Identified:
    """Results of a sweep of a device; ``*_error`` are standard errors.

    The figures of the fit (mass to quality factor) use all tones; the figures read off the curve (``read_*``) use only
    the tones around their subject, and are none where the sweep does not show it.
    """

    mass_kg: float
    damping_ns_m: float
    stiffness_n_m: float
    mass_error_kg: float
    damping_error_ns_m: float
    stiffness_error_n_m: float
    f0_hz: float
    f_peak_hz: float
    quality_factor: float
    f0_error_hz: float
    f_peak_error_hz: float
    quality_factor_error: float
    static_gain_um_per_v: float
    coherence: float
    read_f_peak_hz: float | None
    read_f0_hz: float | None
    read_quality_half_power: float | None
    read_quality_phase_slope: float | None


def identify(tones: list[SweepTone], force_n_per_v: float) -> Identified:
    r"""Fit a mass, a damper and a spring to a sweep.

    .. math:: \min_{m,\beta,k}\sum_i\frac1{\sigma_i^2}\left|H_i-\frac{F}{k-m\omega_i^2+j\beta\omega_i}\right|^2

    by Gauss and Newton from the linear fit of :math:`F/H`; the covariance is
    :math:`s^2(J^TWJ)^{-1}` with the reduced sum of squares :math:`s^2`. A sweep determines only ratios: the force per
    volt sets the scale of all three.

    Parameters
    ----------
    tones : list of Tone
        At least four.
    force_n_per_v : float
        Force per volt, signed.

    Raises
    ------
    InputError
        With too few tones.
    """
    if len(tones) < 4:
        raise InputError("a sweep needs at least four tones", "study.points")
    tones = sorted(tones, key=lambda entry: entry.frequency_hz)
    omega = 2.0 * np.pi * np.array([entry.frequency_hz for entry in tones])
    heard: ComplexArray = np.array([entry.response for entry in tones], dtype=np.complex128)
    measured: ComplexArray = heard / (UM_PER_M * force_n_per_v)
    errors = np.array([entry.error for entry in tones])
    floor = 1e-9 * np.abs(measured)  # without any noise, every tone has the same weight
    weight = 1.0 / np.maximum(errors / UM_PER_M / abs(force_n_per_v), floor)
    inverse = 1.0 / measured
    # scaled so that all three unknowns are of order one
    unit = float(np.sqrt(omega[0] * omega[-1]))
    size = float(np.median(np.abs(inverse)))
    u = omega / unit
    trust = weight * np.abs(measured) ** 2
    start, *_ = np.linalg.lstsq(
        np.vstack([np.column_stack([-(u**2), 0 * u, 0 * u + 1]), np.column_stack([0 * u, u, 0 * u])])
        * np.tile(trust, 2)[:, None],
        np.concatenate([inverse.real, inverse.imag]) / size * np.tile(trust, 2),
        rcond=None,
    )
    theta = start
    for _ in range(ITERATIONS):
        model = 1.0 / ((theta[2] - theta[0] * u**2) + 1j * theta[1] * u)
        slope = np.column_stack([model**2 * u**2, -1j * u * model**2, -(model**2)]) * weight[:, None]
        rest = (measured * size - model) * weight
        jacobian = np.vstack([slope.real, slope.imag])
        residual = np.concatenate([rest.real, rest.imag])
        change, *_ = np.linalg.lstsq(jacobian, residual, rcond=None)
        theta = theta + change
        if np.max(np.abs(change / theta)) < 1e-13:
            break
    freedom = 2 * len(tones) - 3
    covariance = np.linalg.inv(jacobian.T @ jacobian) * float(residual @ residual) / freedom
    spread = np.sqrt(np.diag(covariance))
    scale = size * np.array([1.0 / unit**2, 1.0 / unit, 1.0])
    mass, damping, stiffness = (float(value) for value in theta * scale)
    if min(mass, damping, stiffness) <= 0.0:
        raise InputError("the sweep does not look like a resonator; widen it or raise the amplitude", "study")
    resonance = figures(mass, damping, stiffness)
    wander = _figure_errors(resonance, (mass, damping, stiffness), covariance * np.outer(scale, scale))
    return Identified(
        mass_kg=mass,
        damping_ns_m=damping,
        stiffness_n_m=stiffness,
        mass_error_kg=float(spread[0] * scale[0]),
        damping_error_ns_m=float(spread[1] * scale[1]),
        stiffness_error_n_m=float(spread[2] * scale[2]),
        f0_hz=resonance["f0_hz"],
        f_peak_hz=resonance["f_peak_hz"],
        quality_factor=resonance["quality_factor"],
        f0_error_hz=wander["f0_hz"],
        f_peak_error_hz=wander["f_peak_hz"],
        quality_factor_error=wander["quality_factor"],
        static_gain_um_per_v=force_n_per_v / stiffness * UM_PER_M,
        coherence=min(entry.coherence for entry in tones),
        **_read(omega, measured),
    )


def _figure_errors(resonance: dict[str, float], fitted: tuple[float, ...], covariance: FloatArray) -> dict[str, float]:
    """Propagate the covariance of mass, damping and stiffness to the figures of the resonance, to first order."""
    mass, damping, stiffness = fitted
    f0, quality, peak = resonance["f0_hz"], resonance["quality_factor"], resonance["f_peak_hz"]
    by_f0 = f0 * np.array([-0.5 / mass, 0.0, 0.5 / stiffness])
    by_quality = quality * np.array([0.5 / mass, -1.0 / damping, 0.5 / stiffness])
    # the square of the peak is f0^2 (1 - 1 / 2Q^2); without a peak it stays at zero frequency
    by_peak = (peak / f0) * by_f0 + (f0 * f0 / (2.0 * quality**3 * peak) * by_quality if peak > 0.0 else 0.0 * by_f0)
    rows = {"f0_hz": by_f0, "f_peak_hz": by_peak, "quality_factor": by_quality}
    return {name: float(np.sqrt(slope @ covariance @ slope)) for name, slope in rows.items()}


def _read(omega: FloatArray, measured: ComplexArray) -> dict[str, float | None]:
    """Read peak, resonance and quality factor off the curve, without a model of the whole curve."""
    square = omega**2
    power = np.abs(measured) ** 2
    top = int(np.argmax(power))
    quarter = np.flatnonzero(np.diff(np.sign(measured.real)) < 0)
    peak = half = zero = slope = None
    if 0 < top < len(omega) - 1:
        # 1/|H|^2 of a resonator is a parabola in the square of the frequency
        near = slice(max(top - 2, 0), top + 3)
        a, b, c = np.polyfit((square[near] - square[top]) / square[top], 1.0 / power[near] * power[top], 2)
        peak = math.sqrt(square[top] * max(1.0 - b / (2.0 * a), 0.0)) / (2.0 * math.pi)
        level = 2.0 * (c - b * b / (4.0 * a)) / power[top]
        below = np.flatnonzero(1.0 / power[:top] > level)
        above = np.flatnonzero(1.0 / power[top:] > level)
        if len(below) and len(above):
            low = _crossing(square, 1.0 / power, int(below[-1]), level)
            high = _crossing(square, 1.0 / power, top + int(above[0]) - 1, level)
            # (w2^2 - w1^2) / (w2^2 + w1^2) = tan 2 asin zeta, exact for any damping
            half = 0.5 / math.sin(0.5 * math.atan2(high - low, high + low)) if low < high else None
    if len(quarter):
        at = int(quarter[0])
        zero = math.sqrt(_crossing(square, (1.0 / measured).real, at, 0.0)) / (2.0 * math.pi)
        # -cot(phase) of a resonator is Q (w0/w - w/w0), a straight line through the resonance
        near = slice(max(at - 2, 0), at + 4)
        detuned = 2.0 * math.pi * zero / omega[near]
        detuned = detuned - 1.0 / detuned
        cotangent = -measured[near].real / measured[near].imag
        slope = float(cotangent @ detuned / (detuned @ detuned))
    return {
        "read_f_peak_hz": peak,
        "read_f0_hz": zero,
        "read_quality_half_power": half,
        "read_quality_phase_slope": slope,
    }


def _crossing(where: FloatArray, values: FloatArray, left: int, level: float) -> float:
    """Return where values cross a level between two neighbours, on the parabola through four points."""
    first = max(min(left - 1, len(where) - 4), 0)
    near = slice(first, first + 4)
    size = where[left + 1] - where[left]
    a, b, c = np.polyfit((where[near] - where[left]) / size, values[near] - level, 2)
    shares = [float(root.real) for root in np.roots([a, b, c]) if abs(root.imag) == 0.0 and 0.0 <= root.real <= 1.0]
    straight = (level - values[left]) / (values[left + 1] - values[left])
    return float(where[left] + (shares[0] if len(shares) == 1 else straight) * size)
