"""Figures of a run, by dotted names."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping
from functools import lru_cache

import numpy as np

from core.block import FloatArray
from core.board.board import Board
from core.board.spec import Spec
from core.kernel import kernel
from core.loop.score import Scores
from scenarios.measure.blocks import BLOCK, blocks, largest, last_where, loaded, mean, stretches
from scenarios.measure.errors import first_peaks, last_step, tracked
from scenarios.measure.lateral import lateral_metrics
from scenarios.measure.rate import rate_metrics
from scenarios.measure.sensing import sensing_metrics
from scenarios.measure.stretch import Stretch
from scenarios.measure.supervision import supervision_metrics
from scenarios.measure.verdicts import verdict_metrics

EXCITED = ("excitation", "excitation_relative", "identifiable")
"""Signals of an identifier that judge the input."""
IDENTIFIED_PCT = 10.0
"""Error of the worst coefficient within which an identifier counts as settled."""
SETTLED = 0.02
"""Share of the model's amplitude within which a loop counts as settled."""


def fundamental(signal: FloatArray, frequency_hz: float, dt_ms: float, first_tick: int = 0) -> complex:
    r"""Return the phasor of one tone by least squares, :math:`x\approx\mathrm{Im}\{Ce^{j\omega t}\}`.

    The normal equations of a long signal are added up block by block.
    """
    if len(signal) <= BLOCK:
        return complex(*weighed(_projection(frequency_hz, dt_ms, first_tick, len(signal)), loaded(signal)))
    squares: FloatArray = np.zeros((3, 3))
    products: FloatArray = np.zeros(3)
    for number, (block,) in enumerate(blocks(signal)):
        rows = _tones(frequency_hz, dt_ms, first_tick + number * BLOCK, len(block))
        squares += rows.T @ rows
        products += rows.T @ block
    return complex(*np.linalg.lstsq(squares, products)[0][:2])


def fundamentals(signals: list[FloatArray], frequency_hz: float, dt_ms: float, first_tick: int) -> list[complex]:
    """Return the phasors of one tone in four signals of one length, as `fundamental` does."""
    if len(signals[0]) > BLOCK:
        return [fundamental(signal, frequency_hz, dt_ms, first_tick) for signal in signals]
    found = np.empty((4, 2))
    first, second, third, last = map(loaded, signals)
    _weigh(_projection(frequency_hz, dt_ms, first_tick, len(first)), first, second, third, last, found)
    return [complex(*parts) for parts in found.tolist()]


@lru_cache(maxsize=32)
def _projection(frequency_hz: float, dt_ms: float, first_tick: int, samples: int) -> FloatArray:
    """Return the two rows that make sine and cosine of a signal, which may have an offset."""
    return np.ascontiguousarray(np.linalg.pinv(_tones(frequency_hz, dt_ms, first_tick, samples))[:2], np.float64)


def _tones(frequency_hz: float, dt_ms: float, first_tick: int, samples: int) -> FloatArray:
    """Return the columns of a tone with an offset."""
    angle = 2.0 * math.pi * frequency_hz * (first_tick + np.arange(samples)) * dt_ms / 1e3
    return np.column_stack([np.sin(angle), np.cos(angle), np.ones(samples)])


@kernel
def weighed(weights: FloatArray, signal: FloatArray) -> tuple[float, float]:
    """Return the sums of a signal under two rows of weights, in the order of its samples, in memory or in a file."""
    first, second = 0.0, 0.0
    for i in range(weights.shape[1]):
        first += weights[0, i] * signal[i]
        second += weights[1, i] * signal[i]
    return first, second


@kernel
def _weigh(
    weights: FloatArray, first: FloatArray, second: FloatArray, third: FloatArray, last: FloatArray, found: FloatArray
) -> None:
    """Write the sums of four signals under two rows of weights, each in the order of its samples."""
    a, b, c, d, e, f, g, h = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(weights.shape[1]):
        sine, cosine = weights[0, i], weights[1, i]
        a += sine * first[i]
        b += cosine * first[i]
        c += sine * second[i]
        d += cosine * second[i]
        e += sine * third[i]
        f += cosine * third[i]
        g += sine * last[i]
        h += cosine * last[i]
    found[0, 0], found[0, 1], found[1, 0], found[1, 1] = a, b, c, d
    found[2, 0], found[2, 1], found[3, 0], found[3, 1] = e, f, g, h


def device_metrics(spec: Spec) -> dict[str, float]:
    """Return the figures of the device in its environment, before any fault."""
    stiffness, damping = spec.surroundings
    # the figures of a gyroscope have a family of names of their own
    figures = {name if "." in name else f"device.{name}": value for name, value in spec.quoted.items()}
    return {**figures, "environment.stiffness_scale": stiffness, "environment.damping_scale": damping}


def control_metrics(board: Board, trace: dict[str, FloatArray], stretch: Stretch) -> dict[str, float]:
    """Return the errors of the shuttle against the model, and the effort.

    The settling time is the last moment at which the error left the band of 2 % of the model's amplitude, counted from
    ``metrics.since_ms``. The effort is the ratio of the fundamental of the applied voltage to the fundamental of the
    reference in the tail; the displacement ratio compares shuttle and model in the same way. The overshoot is measured
    at the last step of a reference that is constant in the tail, as a share of the model's motion.
    """
    dt = board.dt_ms
    x, model = trace["plant.displacement"], trace["model.displacement"]
    u, r = trace["drive.voltage"], trace["reference.voltage"]
    start, tail = stretch.start(len(x), dt), stretch.tail(len(x))
    error, peak, settled, last, effort = tracked(x, model, u, start, tail.start, SETTLED)
    figures = {
        "control.rms_error_um": error,
        "control.tail_rms_error_um": last,
        "control.peak_error_um": peak,
        "control.settling_ms": float(settled) * dt,
        "control.effort_rms_v": effort,
    }
    step = last_step(r)
    before = float(model[step - 1]) if step else 0.0
    rise = mean(model[tail]) - before if step <= tail.start else 0.0
    if abs(rise) > 1e-9:
        peak = largest(lambda values: (values - before) * math.copysign(1.0, rise), x[step:])
        figures["control.overshoot_pct"] = 100.0 * (peak / abs(rise) - 1.0)
    if (peak_of := first_peak(x, model)) is not None:
        figures["control.first_peak_pct"] = peak_of
    frequency = board.spec.tone_hz
    if frequency:
        asked, given, moved, wanted = fundamentals([one[tail] for one in (r, u, x, model)], frequency, dt, tail.start)
        if abs(asked) > 0.0:
            figures["control.effort_ratio"] = abs(given) / abs(asked)
        if abs(wanted) > 0.0:
            figures["control.displacement_ratio"] = abs(moved) / abs(wanted)
        figures["control.amplitude_um"] = abs(moved)
        figures["control.phase_deg"] = math.degrees(math.atan2(moved.imag, moved.real))
    return {name: value for name, value in figures.items() if math.isfinite(value)}


def first_peak(x: FloatArray, model: FloatArray) -> float | None:
    """Return the excess of the first peak over the model's, %; nothing when the model does not turn twice."""
    peak, reached = first_peaks(x, model)
    return 100.0 * (reached / peak - 1.0) if peak > 0.0 else None


def diagnosis_metrics(name: str, scores: Scores, lengths: list[int]) -> dict[str, float]:
    """Return the score of one diagnoser.

    A step that was never figures counts with its whole length in the mean delay, and in ``missed_steps``.
    """
    prefix = f"diagnosis.{name}"
    counted = [length if delay is None else delay for delay, length in zip(scores.delays, lengths, strict=False)]
    figures: dict[str, float] = {
        f"{prefix}.correct_fraction": scores.correct_fraction,
        f"{prefix}.false_switches": float(scores.false_switches),
        f"{prefix}.missed_steps": float(sum(delay is None for delay in scores.delays)),
    }
    if len(counted) > 1:
        figures[f"{prefix}.mean_delay_samples"] = sum(counted[1:]) / (len(counted) - 1)
    for step, delay in enumerate(counted, 1):
        figures[f"{prefix}.delay_samples.{step}"] = float(delay)
    if scores.nis is not None and math.isfinite(scores.nis):
        figures[f"{prefix}.nis"] = scores.nis
    return figures


def identify_metrics(board: Board, name: str, error: FloatArray | None, stretch: Stretch) -> dict[str, float]:
    """Return the errors of one identifier, and whether the input lets it identify the device.

    ``error_pct`` is the mean over the tail of the largest relative error of a coefficient; the settling time is the
    last moment it was above 10 %, counted from ``metrics.since_ms``. ``mass_error_pct`` and the like are errors of the
    estimates at the end.
    """
    prefix = f"identify.{name}"
    known = set(board.signals.names)  # a user's identifier need not judge the input
    last = {port: board.value(f"{name}.{port}") for port in EXCITED if f"{name}.{port}" in known}
    if error is not None:
        counted = error[stretch.start(len(error), board.dt_ms) :]
        last["settling_ms"] = last_where(lambda values: values > IDENTIFIED_PCT, counted) * board.dt_ms
        last["error_pct"] = mean(error[stretch.tail(len(error))])
        for part in ("mass", "stiffness", "damping"):
            estimate, truth = (board.value(f"{name}.{port}.{part}") for port in ("estimate", "truth"))
            last[f"{part}_error_pct"] = 100.0 * (estimate / truth - 1.0)
    return {f"{prefix}.{key}": value for key, value in last.items() if math.isfinite(value)}


def step_lengths(truth: FloatArray) -> list[int]:
    """Return the number of samples of each stretch in which one hypothesis is true."""
    return [end - start for start, end in itertools.pairwise([*stretches(truth), len(truth)]) if truth[start] >= 0.0]


def measure(board: Board, trace: dict[str, FloatArray], stretch: Stretch) -> dict[str, float]:
    """Return every figure of a run."""
    figures = device_metrics(board.spec) | lateral_metrics(board)
    if board.tick > 1:
        if board.spec.axes:
            figures |= rate_metrics(board, trace, stretch)
        elif board.spec.record is None:  # no law drives a record, and no record knows the true motion
            figures |= control_metrics(board, trace, stretch) | sensing_metrics(board, trace, stretch)
    for name in board.spec.identifiers if board.tick > 1 else ():
        figures |= identify_metrics(board, name, trace.get(f"{name}.error_pct"), stretch)
    scores = board.scores()
    for name in board.spec.diagnosers:
        if name in scores and scores[name].samples:  # a score without samples has no figure, not even 0
            figures |= diagnosis_metrics(name, scores[name], step_lengths(trace[f"{name}.truth"]))
    if stretch.beside:
        figures |= delay_ratios(figures, list(scores), stretch.beside)
    return figures | verdict_metrics(board, trace) | supervision_metrics(board, trace, stretch)


def delay_ratios(figures: Mapping[str, float], names: Iterable[str], beside: str) -> dict[str, float]:
    """Return the delay of each diagnoser in each step over the delay of one of them."""
    delays = {name: figures[name] for name in figures if name.startswith(f"diagnosis.{beside}.delay_samples.")}
    found = {}
    for name in names:
        for own, delay in delays.items():
            other = own.replace(f".{beside}.", f".{name}.", 1)
            if name != beside and delay > 0.0 and other in figures:
                found[other.replace("diagnosis.", "compare.", 1)] = figures[other] / delay
    return found
