"""Figures of a gyroscope: the rate that is read, the swing of its axes, two devices in step."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import chain, pairwise
from typing import Any

import numpy as np

from core.block import FloatArray
from core.board.board import Board
from core.device.two_axis import TwoAxis
from core.readout.allan import Allan
from core.units import MS_PER_S, PM_PER_UM
from scenarios.measure.blocks import BLOCK, blocks, is_zero, last_where, mean, stretches, total, width
from scenarios.measure.rate_noise import rate_noise_metrics
from scenarios.measure.stretch import Stretch

SETTLED = 0.05
"""Share of a step within which a rate counts as settled."""
SHORTEST = 0.01
"""Share of a run that a rate must stay the same for to count as a level."""
LONGER = 4
"""Length of a spectrum over the length of its record: the resolution of the frequencies."""
LONGEST = 1 << 18
"""Samples of a step response that are transformed."""
FINE = 0.01
"""Bandwidth over the rate of the samples up to which those between them are not missed."""
READ = ("rate", "quadrature", "angle", "trusted", "bound")
"""Outputs of a controller for its figures."""

Levels = list[tuple[int, int]]


def traced(board: Board) -> list[str]:
    """Return the signals that the figures need."""
    axes = board.spec.axes
    moved = [f"plant.{axis}{of}" for axis in axes for of in ("", "_velocity")]
    return [
        *moved,
        "plant.split",
        *(f"drive.{axis}.force" for axis in axes),
        "rate.rate",
        *(f"{board.spec.active}.{n}" for n in READ),
    ]


def rate_metrics(board: Board, trace: dict[str, FloatArray], stretch: Stretch) -> dict[str, float]:
    r"""Return the figures of a plant with axes.

    The rate is read by the controller that drives at the end. Its reading is compared with the true rate on each level
    of it; a moment at which the rate changes is a step. The last quarter of a level, or the share
    ``metrics.tail_share``, counts as settled.
    """
    true, read = trace["rate.rate"], trace.get(f"{board.spec.active}.rate")
    pieces = levels(true, stretch.start(len(true), board.dt_ms))
    figures = _locus(trace, _settled(pieces[-1], stretch))
    figures |= _scale(board, trace, true, pieces, stretch)
    if read is not None:
        figures |= _reading(board, true, read, pieces, stretch)
    driving = board.spec.active
    if (split := trace.get("plant.split")) is not None:
        figures["rate.split_hz"] = mean(split[_settled(pieces[-1], stretch)])
    if (quadrature := trace.get(f"{driving}.quadrature")) is not None:
        figures["rate.quadrature_dps"] = mean(quadrature[_settled(pieces[-1], stretch)])
    if (trusted := trace.get(f"{driving}.trusted")) is not None:
        for step, (_, end) in enumerate(pieces, 1):
            figures |= _both("gyro.trusted", step, len(pieces), float(trusted[end - 1]))
    if (bound := trace.get(f"{driving}.bound")) is not None:
        for step, piece in enumerate(pieces, 1):
            figures |= _both("gyro.bound_dps", step, len(pieces), float(bound[_settled(piece, stretch)].max()))
    if (angle := trace.get(f"{driving}.angle")) is not None and isinstance(device := board.spec.nominal, TwoAxis):
        gain = device.coriolis_mass / math.sqrt(device.mass * device.mass_y)
        first = pieces[0][0]
        turned = gain * float(total(np.asarray, true[first:-1])) * board.dt_ms / MS_PER_S
        figures["rate.angle_error_deg"] = float(angle[-1] - angle[first]) + turned
    figures |= _in_step(trace, _settled(pieces[-1], stretch))
    for name, section in board.spec.readouts.items():
        if issubclass(section.block, Allan):
            taus = section.block.taus_s(section.params, board.spec.context(section.every))
            figures |= rate_noise_metrics(taus, board.wiring.state(name))
    return {name: value for name, value in figures.items() if math.isfinite(value)}


def levels(rate: FloatArray, start: int = 0) -> Levels:
    """Return first and last sample, the latter not included, of every level of a rate; all of it if it has none."""
    edges = chain(stretches(rate), [len(rate)])
    found = [(max(first, start), end) for first, end in pairwise(edges) if end - first >= SHORTEST * len(rate)]
    return [(first, end) for first, end in found if end > first] or [(start, len(rate))]


def _settled(piece: tuple[int, int], stretch: Stretch) -> slice:
    first, end = piece
    return slice(first + (stretch.tail(end - first).start or 0), end)


def _reading(board: Board, true: FloatArray, read: FloatArray, pieces: Levels, stretch: Stretch) -> dict[str, float]:
    """Compare the reading with the true rate, both as means over the settled part of a level.

    The settling time is the last moment at which the reading is outside 5 % of its step around its mean at the end. A
    step that is smaller than the noise has no settling time.
    """
    figures: dict[str, float] = {}
    for step, piece in enumerate(pieces, 1):
        at, first, end = _settled(piece, stretch), *piece
        known, told = true[at], read[at]
        at_end, meant, is_still = mean(told), mean(known), is_zero(known)
        figures |= _both("rate.read_dps", step, len(pieces), at_end)
        figures["rate.rms_error_dps"] = math.sqrt(_mean_square(np.subtract, told, known))
        if is_still:
            figures["rate.zero_dps"] = at_end
        elif meant * meant > 0.5 * _mean_square(np.asarray, known):  # neither noise alone nor a swing around 0
            figures |= _both("rate.error_pct", step, len(pieces), 100.0 * (at_end / meant - 1.0))
        change, scatter = at_end - float(read[first]), width(told)
        if width(known) == 0.0 and (not is_still or first) and abs(change) > scatter:
            band = at_end, SETTLED * abs(change)
            outside = last_where(lambda values, of=band: ~(np.abs(values - of[0]) <= of[1]), read[first:end])
            figures |= _both("rate.settling_ms", step, len(pieces), outside * board.dt_ms)
            if scatter < SETTLED * abs(change) and first and true[first] != true[first - 1]:
                figures["rate.bandwidth_hz"] = bandwidth_hz(read[first:end], change, board.dt_ms)
    return figures


def bandwidth_hz(read: FloatArray, change: float, dt_ms: float) -> float:
    r"""Return the frequency at which a step response passes :math:`1/\sqrt2`, Hz; nan if it never does.

    The transfer function is the Fourier transform of the response's slope. Of a long record only every n-th sample is
    taken. Where they do not show its first half period well, its first quarter is taken instead.

    Parameters
    ----------
    read : ndarray, shape (samples,)
        The reading from the step on.
    change : float
        By how much it changes.
    """
    every = 1
    while len(read) > every * LONGEST:
        every *= 2
    response = (np.concatenate([block[::every] for (block,) in blocks(read)]) - read[0]) / change
    passed = np.abs(np.fft.rfft(np.diff(response), LONGER * len(response)))
    below = np.flatnonzero(passed < math.sqrt(0.5))
    if every > 1 and not (len(below) and below[0] <= FINE * LONGER * len(response)):
        return bandwidth_hz(read[: len(read) // 4], change, dt_ms)
    return float(below[0]) / (LONGER * len(response) * every * dt_ms / MS_PER_S) if len(below) else math.nan


def _both(name: str, step: int, steps: int, value: float) -> dict[str, float]:
    """Return the figure of a step, under the plain name as well: the last step keeps the plain name."""
    return {name: value} | ({f"{name}.{step}": value} if steps > 1 else {})


def _phasor(q: FloatArray, v: FloatArray, omega: float) -> Any:
    r"""Return :math:`q-j\dot q/\omega`, which turns as :math:`Ae^{j\theta}/j` where :math:`q=A\sin\theta`."""
    return q - 1j * v / omega


def _mean_square(of: Callable[..., FloatArray], *columns: FloatArray) -> float:
    """Return the mean square of the values of a function of columns."""
    return float(total(lambda *block: np.square(of(*block)), *columns) / len(columns[0]))


def _size(swing: FloatArray) -> float:
    """Return the amplitude of a sine."""
    return math.sqrt(2.0 * _mean_square(np.asarray, swing))


def _frequency(x: FloatArray, v: FloatArray) -> float:
    """Return the frequency of an oscillation in rad/ms; nan without motion."""
    size, speed = (float(total(lambda block: np.dot(block, block), q)) for q in (x, v))
    return math.sqrt(speed / size) if size > 0.0 else math.nan


def _over(trace: dict[str, FloatArray], at: slice, one: str, other: str) -> complex:
    """Return the ratio of the phasors of two axes, by least squares; a smooth window removes other tones."""
    omega = _frequency(trace["plant.x"][at], trace["plant.x_velocity"][at])
    if not omega > 0.0:
        return complex(math.nan, math.nan)
    columns = [trace[f"plant.{q}{of}"][at] for q in (one, other) for of in ("", "_velocity")]
    common, power, samples = 0.0j, 0.0, len(columns[0])
    for number, (q, v, other_q, other_v) in enumerate(blocks(*columns)):
        a, b = _phasor(q, v, omega), _phasor(other_q, other_v, omega)
        before = number * BLOCK
        window = _hanning(before, before + len(q), samples)
        common, power = (
            common + complex(np.sum(window * a * np.conj(b))),
            power + float(np.sum(window * np.abs(b) ** 2)),
        )
    return common / power if power > 0.0 else complex(math.nan, math.nan)


def _hanning(first: int, end: int, samples: int) -> FloatArray:
    """Return a part of numpy's window of this length, except its ends, which are 0."""
    at: FloatArray = np.cos(math.pi * (2.0 * np.arange(first, end) + (1 - samples)) / (samples + 1))
    return 0.5 + 0.5 * at


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
    r"""Return the swing of y per rate, where no force holds y.

    It is the change of y over x from the first level to the last, over the change of the rate. With one level, the
    coupling by the cross terms of the nominal device is subtracted instead.
    """
    last = _settled(pieces[-1], stretch)
    device = board.spec.nominal
    if not is_zero(trace["drive.y.force"][last]) or not isinstance(device, TwoAxis):
        return {}
    x = trace["plant.x"][last]
    now, rate = _over(trace, last, "y", "x"), mean(true[last])
    first = _settled(pieces[0], stretch)
    before, start = _over(trace, first, "y", "x"), mean(true[first])
    if start == rate:
        before, start = device.coupled(_frequency(x, trace["plant.x_velocity"][last])), 0.0
    if start == rate or width(true[last]) > 0.0:
        return {}
    return {"rate.scale_pm_per_dps": PM_PER_UM * _size(x) * abs(now - before) / abs(rate - start)}


def _in_step(trace: dict[str, FloatArray], at: slice) -> dict[str, float]:
    """Return the forces, and the distance of y from the y of a partner, or from zero."""
    figures = {}
    for axis, name in (("y", "sync.force_un"), ("x", "sync.drive_force_un")):
        figures[name] = _size(trace[f"drive.{axis}.force"][at])
    if "plant.partner_y" in trace:
        apart = _mean_square(np.subtract, trace["plant.y"][at], trace["plant.partner_y"][at])
        figures["sync.error_rms_nm"] = 1e3 * math.sqrt(apart)
        g = _over(trace, at, "y", "partner_y")
        figures["rate.phase_difference_deg"] = math.degrees(math.atan2(g.imag, g.real))
    return figures
