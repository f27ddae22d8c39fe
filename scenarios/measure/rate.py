"""Figures of a gyroscope: the rate that is read, the swing of its axes, two devices in step."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np

from core.block import FloatArray
from core.board.board import Board
from core.device.two_axis import TwoAxis
from core.units import MS_PER_S, PM_PER_UM
from scenarios.measure.rate_noise import rate_noise_metrics
from scenarios.measure.stretch import Stretch

SETTLED = 0.05
"""Share of a step within which a rate counts as settled."""
SHORTEST = 0.01
"""Share of a run that a rate must stay the same for to count as a level."""
LONGER = 4
"""Length of a spectrum over that of its record: how finely the frequencies lie."""
READ = ("rate", "quadrature", "angle", "trusted")
"""Outputs of a controller that figures are made of."""

Levels = list[tuple[int, int]]


def traced(board: Board) -> list[str]:
    """Return the signals that the figures need."""
    axes = board.spec.axes
    moved = [f"plant.{axis}{of}" for axis in axes for of in ("", "_velocity")]
    return [*moved, *(f"drive.{axis}.force" for axis in axes), "rate.rate", *(f"{board.spec.active}.{n}" for n in READ)]


def rate_metrics(board: Board, trace: dict[str, FloatArray], stretch: Stretch) -> dict[str, float]:
    r"""Return the figures of a plant with axes.

    The rate is read by the controller that drives at the end. What it says is compared with the true rate on each level
    of it, a moment at which the rate changes being a step. The last quarter of a level, or what ``metrics.tail_share``
    says, counts as settled.
    """
    true, read = trace["rate.rate"], trace.get(f"{board.spec.active}.rate")
    pieces = levels(true, stretch.start(len(true), board.dt_ms))
    figures = _locus(trace, _settled(pieces[-1], stretch))
    figures |= _scale(board, trace, true, pieces, stretch)
    if read is not None:
        figures |= _reading(board, true, read, pieces, stretch)
    driving = board.spec.active
    if (quadrature := trace.get(f"{driving}.quadrature")) is not None:
        figures["rate.quadrature_dps"] = float(np.mean(quadrature[_settled(pieces[-1], stretch)]))
    if (trusted := trace.get(f"{driving}.trusted")) is not None:
        figures["gyro.trusted"] = float(trusted[-1])
    if (angle := trace.get(f"{driving}.angle")) is not None and isinstance(device := board.spec.nominal, TwoAxis):
        gain = device.coriolis_mass / math.sqrt(device.mass * device.mass_y)
        first = pieces[0][0]
        turned = gain * float(np.sum(true[first:-1])) * board.dt_ms / MS_PER_S
        figures["rate.angle_error_deg"] = float(angle[-1] - angle[first]) + turned
    figures |= _in_step(trace, _settled(pieces[-1], stretch))
    for name, section in board.spec.readouts.items():
        block: Any = section.block
        taus = block.taus_s(section.params, board.spec.context(section.every))
        figures |= rate_noise_metrics(taus, board.wiring.state(name))
    return {name: value for name, value in figures.items() if math.isfinite(value)}


def levels(rate: FloatArray, start: int = 0) -> Levels:
    """Return first and last sample, the latter not included, of every level of a rate; all of it if it has none."""
    steps = np.flatnonzero(np.diff(rate)) + 1
    edges = [0, *steps.tolist(), len(rate)]
    found = [(max(first, start), end) for first, end in pairwise(edges) if end - first >= SHORTEST * len(rate)]
    return [(first, end) for first, end in found if end > first] or [(start, len(rate))]


def _settled(piece: tuple[int, int], stretch: Stretch) -> slice:
    first, end = piece
    return slice(first + (stretch.tail(end - first).start or 0), end)


def _reading(board: Board, true: FloatArray, read: FloatArray, pieces: Levels, stretch: Stretch) -> dict[str, float]:
    """Compare what is read with the true rate, both as means over the settled part of a level.

    The settling time is the last moment at which the reading is outside 5 % of its step around its mean at the end.
    Where the step does not stand out of the noise there is none.
    """
    figures: dict[str, float] = {}
    for step, piece in enumerate(pieces, 1):
        at, first, end = _settled(piece, stretch), *piece
        known, told = true[at], read[at]
        mean, meant = float(np.mean(told)), float(np.mean(known))
        figures |= _both("rate.read_dps", step, len(pieces), mean)
        figures["rate.rms_error_dps"] = float(np.sqrt(np.mean((told - known) ** 2)))
        if not np.any(known):
            figures["rate.zero_dps"] = mean
        elif meant * meant > 0.5 * float(np.mean(known * known)):  # neither noise alone nor a swing around 0
            figures |= _both("rate.error_pct", step, len(pieces), 100.0 * (mean / meant - 1.0))
        change, scatter = mean - float(read[first]), float(np.ptp(told))
        if np.ptp(known) == 0.0 and (np.any(known) or first) and abs(change) > scatter:
            outside = np.flatnonzero(~(np.abs(read[first:end] - mean) <= SETTLED * abs(change)))
            settling = (float(outside[-1]) + 1.0) * board.dt_ms if len(outside) else 0.0
            figures |= _both("rate.settling_ms", step, len(pieces), settling)
            if scatter < SETTLED * abs(change) and first and true[first] != true[first - 1]:
                response = (read[first:end] - read[first]) / change
                figures["rate.bandwidth_hz"] = bandwidth_hz(response, board.dt_ms)
    return figures


def bandwidth_hz(response: FloatArray, dt_ms: float) -> float:
    r"""Return the frequency at which a step response passes :math:`1/\sqrt2`, Hz; nan if it never does.

    The transfer function is the Fourier transform of the response's slope.

    Parameters
    ----------
    response : ndarray, shape (samples,)
        From 0 to 1.
    """
    passed = np.abs(np.fft.rfft(np.diff(response), LONGER * len(response)))
    below = np.flatnonzero(passed < math.sqrt(0.5))
    return float(below[0]) / (LONGER * len(response) * dt_ms / MS_PER_S) if len(below) else math.nan


def _both(name: str, step: int, steps: int, value: float) -> dict[str, float]:
    """Return the figure of a step, under the plain name as well: that of the last step stays."""
    return {name: value} | ({f"{name}.{step}": value} if steps > 1 else {})


def _phasor(q: FloatArray, v: FloatArray, omega: float) -> Any:
    r"""Return :math:`q-j\dot q/\omega`, which turns as :math:`Ae^{j\theta}/j` where :math:`q=A\sin\theta`."""
    return q - 1j * v / omega


def _size(swing: FloatArray) -> float:
    """Return the amplitude of a sine."""
    return math.sqrt(2.0 * float(np.mean(swing * swing)))


def _frequency(x: FloatArray, v: FloatArray) -> float:
    """Return the frequency of a swing in rad/ms; nan at rest."""
    size = float(np.dot(x, x))
    return math.sqrt(float(np.dot(v, v)) / size) if size > 0.0 else math.nan


def _over(trace: dict[str, FloatArray], at: slice, one: str, other: str) -> complex:
    """Return the swing of one axis over that of another, by least squares; a smooth window takes other tones out."""
    omega = _frequency(trace["plant.x"][at], trace["plant.x_velocity"][at])
    if not omega > 0.0:
        return complex(math.nan, math.nan)
    a, b = (_phasor(trace[f"plant.{q}"][at], trace[f"plant.{q}_velocity"][at], omega) for q in (one, other))
    window = np.hanning(len(a) + 2)[1:-1]
    power = float(np.sum(window * np.abs(b) ** 2))
    return complex(np.sum(window * a * np.conj(b)) / power) if power > 0.0 else complex(math.nan, math.nan)


def _locus(trace: dict[str, FloatArray], at: slice) -> dict[str, float]:
    r"""Return the tilt of the locus, :math:`\tfrac12\arctan2\mathrm{Re}G/(1-|G|^2)` with :math:`G=y/x`."""
    figures = {"rate.amplitude_um": _size(trace["plant.x"][at])}
    for device, name in (("", "gyro.tilt_deg"), ("partner_", "gyro.partner_tilt_deg")):
        if f"plant.{device}x" in trace:
            g = _over(trace, at, f"{device}y", f"{device}x")
            figures[name] = math.degrees(0.5 * math.atan2(2.0 * g.real, 1.0 - abs(g) ** 2))
    return figures


def _scale(
    board: Board, trace: dict[str, FloatArray], true: FloatArray, pieces: Levels, stretch: Stretch
) -> dict[str, float]:
    r"""Return the swing of y that goes with the rate, where no force holds y.

    It is the change of y over x from the first level to the last, over that of the rate. With one level, what the cross
    terms of the nominal device make of x is taken off instead.
    """
    last = _settled(pieces[-1], stretch)
    device = board.spec.nominal
    if np.any(trace["drive.y.force"][last]) or not isinstance(device, TwoAxis):
        return {}
    x = trace["plant.x"][last]
    now, rate = _over(trace, last, "y", "x"), float(np.mean(true[last]))
    first = _settled(pieces[0], stretch)
    before, start = _over(trace, first, "y", "x"), float(np.mean(true[first]))
    if start == rate:
        before, start = device.coupled(_frequency(x, trace["plant.x_velocity"][last])), 0.0
    if start == rate or np.ptp(true[last]) > 0.0:
        return {}
    return {"rate.scale_pm_per_dps": PM_PER_UM * _size(x) * abs(now - before) / abs(rate - start)}


def _in_step(trace: dict[str, FloatArray], at: slice) -> dict[str, float]:
    """Return the forces, and how far y is from that of a partner, or from rest."""
    figures = {}
    for axis, name in (("y", "sync.force_un"), ("x", "sync.drive_force_un")):
        figures[name] = _size(trace[f"drive.{axis}.force"][at])
    if "plant.partner_y" in trace:
        apart = trace["plant.y"][at] - trace["plant.partner_y"][at]
        figures["sync.error_rms_nm"] = 1e3 * float(np.sqrt(np.mean(apart * apart)))
        g = _over(trace, at, "y", "partner_y")
        figures["rate.phase_difference_deg"] = math.degrees(math.atan2(g.imag, g.real))
    return figures
