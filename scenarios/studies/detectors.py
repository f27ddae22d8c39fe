"""Detectors at the same rate of false alarms, and their receiver operating characteristics."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from core.block import BlockParams, FloatArray, parameter
from core.errors import InputError, unknown
from scenarios.studies.monte_carlo import again
from scenarios.studies.study import Study

if TYPE_CHECKING:
    from core.board.board import Board

WARM = 500
"""Samples left out at the start of a run."""


class Detectors(Study):
    """Sets the threshold of every statistic by the false alarms of a healthy device, then injects the fault.

    ``detectors.<signal>.delay`` is the mean delay of the runs that detected the fault in time, ``.missed`` the share of
    the others, ``.threshold`` the threshold in the end. ``roc.<signal>.area`` is the area under the curve of
    detections against false alarms within a window of samples, ``.at_1_pct`` the share detected at 1 % false alarms,
    and ``roc.<signal>.<false alarms in %>`` some points of the curve.
    """

    title = "Detectors compared"

    class Params(BlockParams):
        """Which statistics, and how long to look."""

        signals: list[str] = parameter([], "statistics: signals that grow when something is wrong")
        false_alarms_per_sample: float = parameter(1e-5, "false alarms allowed, episodes per sample", gt=0, le=0.1)
        healthy_samples: int = parameter(500_000, "samples of the healthy device", ge=10_000, le=100_000_000)
        runs: int = parameter(40, "runs with the fault", ge=1, le=10_000)
        fault_at: int = parameter(1000, "sample at which the events of the bench begin", ge=WARM, le=1_000_000)
        within: int = parameter(3000, "samples after which a fault counts as missed", ge=10, le=1_000_000)
        window: int = parameter(200, "samples of a decision of the characteristic", ge=1, le=100_000)

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return thresholds, delays, misses and areas."""
        names = list(board.signals.names)
        for i, signal in enumerate(params.signals):
            if signal not in names:
                raise unknown("signal", signal, names, f"study.signals.{i}")
        if not params.signals:
            raise InputError("needs a signal at least", "study.signals")
        columns = [names.index(signal) for signal in params.signals]
        length = WARM + 20_000
        runs = -(-params.healthy_samples // 20_000)
        seed = board.spec.seed
        quiet = [_record(board, seed + i, length, columns, healthy=True)[WARM:] for i in range(runs)]
        end = params.fault_at + params.within
        loud = [_record(board, seed + runs + i, end, columns)[params.fault_at :] for i in range(params.runs)]
        figures: dict[str, float] = {}
        for column, signal in enumerate(params.signals):
            calm = [record[:, column] for record in quiet]
            faulty = [record[:, column] for record in loud]
            threshold = threshold_at(calm, params.false_alarms_per_sample)
            delays = [_first(values, threshold) for values in faulty]
            seen = [delay for delay in delays if delay is not None]
            figures[f"detectors.{signal}.threshold"] = threshold
            figures[f"detectors.{signal}.missed"] = 1.0 - len(seen) / len(delays)
            if seen:
                figures[f"detectors.{signal}.delay"] = float(np.mean(seen))
            figures |= _characteristic(f"roc.{signal}", calm, faulty, params.window)
        return figures


def _record(board: Board, seed: int, samples: int, columns: list[int], *, healthy: bool = False) -> FloatArray:
    """Run the bench, without its events if it is to stay healthy, and return some signals."""
    fresh = again(board, seed)
    if healthy:
        fresh.pending.clear()
    outputs = fresh.signals.outputs
    traces = np.empty((samples, len(columns)))
    while fresh.tick < samples:
        rows = fresh.advance(samples - fresh.tick)
        if rows.count == 0:
            break
        span = slice(rows.first_tick, rows.first_tick + rows.count)
        for i, column in enumerate(columns):
            traces[span, i] = rows.outputs[:, column] if column < outputs else rows.taps[:, column - outputs]
    return traces[: fresh.tick]


def threshold_at(records: list[FloatArray], rate: float) -> float:
    """Return the threshold that a signal crosses from below at a given rate."""
    allowed = rate * sum(len(record) for record in records)
    # a rise from a to b crosses every level from a up to, but not including, b
    rises = [(record[:-1], record[1:]) for record in records]
    feet = np.sort(np.concatenate([a[b > a] for a, b in rises]))
    heads = np.sort(np.concatenate([b[b > a] for a, b in rises]))
    low, high = 0.0, max(float(record.max()) for record in records)
    for _ in range(50):
        middle = 0.5 * (low + high)
        episodes = np.searchsorted(feet, middle, "right") - np.searchsorted(heads, middle, "right")
        low, high = (middle, high) if episodes > allowed else (low, middle)
    return high


def _first(values: FloatArray, threshold: float) -> int | None:
    above = np.flatnonzero(values > threshold)
    return int(above[0]) if len(above) else None


def _characteristic(prefix: str, calm: list[FloatArray], faulty: list[FloatArray], window: int) -> dict[str, float]:
    """Return the area and some points: largest values of windows, healthy ones against the first after the fault."""
    healthy = np.sort(np.concatenate([r[: len(r) // window * window].reshape(-1, window).max(axis=1) for r in calm]))
    wrong = np.array([record[:window].max() for record in faulty])
    # the area is the chance that a window with the fault has a higher value than a window without
    below = np.searchsorted(healthy, wrong, side="left")
    equal = np.searchsorted(healthy, wrong, side="right") - below
    figures = {f"{prefix}.area": float(np.mean((below + 0.5 * equal) / len(healthy)))}
    for percent in (0.1, 1.0, 10.0):
        threshold = np.quantile(healthy, 1.0 - percent / 100.0)
        key = "at_1_pct" if percent == 1.0 else f"at_{percent:g}_pct".replace("0.1", "tenth")
        figures[f"{prefix}.{key}"] = float(np.mean(wrong > threshold))
    return figures
