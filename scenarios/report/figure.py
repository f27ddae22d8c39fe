"""The figure of a run: the subject of its scenario, in its own shape, as on a card of the gallery.

A study shows its curves, or its figures with the expected values. A bench shows the subject of its expectations: the
Allan deviation, the locus, two devices in step, the verdicts of diagnosers, the error of identifiers, the output of a
sensor, the lateral motion of the shuttle, the tracking error.
"""

from __future__ import annotations

import itertools
import math
import re
from collections import deque
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from core.block import FloatArray
from core.board.board import Board
from core.format import format_figure
from core.readout.allan import Allan
from core.theory.rate_noise import LEAST_TIMES, averaging_times
from core.units import DEG_H_PER_DEG_S
from scenarios.measure.blocks import BLOCK, blocks, largest, loaded, mean
from scenarios.metric_name import metric_scale
from scenarios.narrator.words import diagnosis_words
from scenarios.report.axis import Axis
from scenarios.report.palette import LineStyle, hypothesis, signal
from scenarios.report.svg import AreaRow, Bar, Chart, EventMark, Series, thin
from scenarios.run import RunResult

COLUMNS = 160
"""Columns of a trace on a card."""
MOST_LANES, MOST_BARS = 3, 6
PERIODS = 3
"""Periods of a motion that is too fast to be shown whole."""
MANY = 8
"""Periods of a motion above which one sees no more than a block on a card."""
LEAST_ERROR_UM = 1e-6
"""Smaller errors are drawn as this value: the final rest is the rounding of the computer."""
DONE = ("inject", "heal", "set", "switch", "reset_trip", "tripped", "make_safe")
"""Kinds of log entries that are marked."""
TIME = "time"


def figure(result: RunResult) -> Chart:
    """Return the figure of a run."""
    if result.scenario.study is not None:
        return _study(result) or _expected(result)
    if result.samples < 2:
        return _expected(result)
    asked = [re.sub(r"^twins\.[^.]+\.", "", entry.metric) for entry in result.scenario.head.expect]
    for start, shape in SHAPES:
        if any(metric.startswith(start) for metric in asked) and (chart := shape(result)) is not None:
            return chart
    if result.board.spec.axes:
        return _rate(result)
    return _followed(result) if asked else _motion(result)


def marks(result: RunResult) -> list[EventMark]:
    """Return the events of the bench, each at its moment."""
    dt_ms = result.board.dt_ms
    return [EventMark(one.tick * dt_ms, one.text) for one in result.board.log if one.kind in DONE and one.tick]


def _title(result: RunResult) -> str:
    return result.scenario.head.title or result.scenario.id


def _names(result: RunResult) -> set[str]:
    return {one.name for one in result.kept}


def _thin(
    result: RunResult, of: Callable[..., FloatArray], *names: str, at: slice = slice(None)
) -> tuple[list[float], list[float]]:
    """Return the times, ms, and the values of a line made from signals."""
    samples, values = thin(of, *(result.signal(name)[at] for name in names), most=COLUMNS)
    return (((at.start or 0) + samples) * result.board.dt_ms).tolist(), values


def _trace(result: RunResult, name: str, said: str = "", at: slice = slice(None), number: int = 0) -> Series:
    """Return a signal as a line."""
    x, y = _thin(result, np.asarray, name, at=at)
    return Series(said or name, x, y, look=signal(name.rpartition(":")[2], number) if ":" not in name else None)


def _last_periods(values: FloatArray, periods: int = PERIODS) -> slice:
    """Return the last periods of a swing; all of it where it has fewer."""
    centre, rising = mean(values[-len(values) // 4 :]), deque[int](maxlen=periods + 1)
    for number, (block,) in enumerate(blocks(values, more=1)):
        rising.extend((number * BLOCK + np.flatnonzero((block[:-1] < centre) & (block[1:] >= centre))).tolist())
    return slice(rising[0], None) if len(rising) > periods else slice(None)


def _periods(values: FloatArray) -> int:
    return sum(int(np.count_nonzero(np.diff(np.signbit(block)))) for (block,) in blocks(values, more=1)) // 2


def _study(result: RunResult) -> Chart | None:
    """Show the curves of a study."""
    assert result.scenario.study is not None
    study, params = result.scenario.study
    picture = study.picture(Board.restore(result.board.checkpoint()), params)
    if picture is None:
        return None
    lines = [Series(name, x, y, is_stepped=picture.is_stepped) for name, x, y in picture.curves]
    return Chart(_title(result), Axis(*picture.x, is_log=picture.is_log_x), Axis(*picture.y), lines)


def _expected(result: RunResult) -> Chart:
    """Show each measured figure with its expectation."""
    bars = list[Bar]()
    for entry in result.scenario.head.expect:
        value = result.metrics.get(entry.metric, math.nan)
        if math.isfinite(value) and len(bars) < MOST_BARS:
            scale = metric_scale(entry.metric, [value])
            text = format_figure(entry.metric, scale.shown(value), 3)
            bars.append(Bar(scale.title, value, text, *entry.bounds(), entry.holds(value)))
    return Chart(_title(result), bars=bars)


def _allan(result: RunResult) -> Chart | None:
    """Show the Allan deviation over the averaging time."""
    board = result.board
    lines = []
    for name, section in board.spec.readouts.items():
        if not issubclass(section.block, Allan):
            continue
        state = board.wiring.state(name)
        averages = np.array(state.averages)
        known = averaging_times(averages) >= LEAST_TIMES
        taus = np.array(section.block.taus_s(section.params, board.spec.context(section.every)))[known]
        deviation = DEG_H_PER_DEG_S * np.sqrt(0.5 * np.array(state.squares)[known] / averages[known])
        lines.append(Series(name, taus.tolist(), deviation.tolist()))
    if not any(one.x for one in lines):
        return None
    x, y = Axis("averaging time", "s", is_log=True), Axis("Allan deviation", "deg/h", is_log=True)
    return Chart(_title(result), x, y, lines)


def _locus(result: RunResult) -> Chart | None:
    """Show the way of the mass over the plane, for a device and its partner."""
    pairs = [("plant.x", "plant.y", "device"), ("plant.partner_x", "plant.partner_y", "partner")]
    at = _last_periods(result.signal("plant.x"), 12)
    lines = []
    for x, y, said in pairs:
        if {x, y} <= _names(result):
            every = max(1, len(result.signal(x)[at]) // 600)
            across, up = (loaded(result.signal(name)[at], slice(None, None, every)).tolist() for name in (x, y))
            lines.append(Series(said, across, up, look=signal(x, 0)))
    return Chart(_title(result), Axis("x", "um"), Axis("y", "um"), lines)


def _in_step(result: RunResult) -> Chart | None:
    """Show the sense axes of two devices over some periods."""
    if "plant.partner_y" not in _names(result):
        return None
    at = _last_periods(result.signal("plant.y"))
    shown = [("plant.y", "y of the device"), ("plant.partner_y", "y of its partner")]
    shown += [(f"{twin}:plant.partner_y", f"y of its partner, {twin}") for twin in result.scenario.twins]
    lines = [_trace(result, name, said, at) for name, said in shown if name in _names(result)]
    return Chart(_title(result), Axis(TIME, "ms"), Axis("displacement", "um"), lines)


def _rate(result: RunResult) -> Chart:
    """Show the true rate and the reading, on the bench and on its twins."""
    shown = [("rate.rate", "true")]
    shown += [
        (f"{name}:{twin.active}.rate", f"read, {name.replace('_', ' ')}")
        for name, twin in result.scenario.twins.items()
    ]
    lines = [_read(result), *(_trace(result, name, said) for name, said in shown if name in _names(result))]
    settled = [value for one in lines for value in one.y[len(one.y) // 4 :] if math.isfinite(value)]
    span = (min(settled), max(settled)) if settled else (0.0, 0.0)  # the transient of the start is cut off
    air = 0.08 * (span[1] - span[0]) or 1.0
    ends = span[0] - air, span[1] + air
    lines = [replace(one, y=np.clip(one.y, *ends).tolist()) for one in lines]
    return Chart(_title(result), Axis(TIME, "ms"), Axis("rate", "deg/s"), lines, marks(result))


def _read(result: RunResult) -> Series:
    """Return the reading of the rate, from each controller while it drove, as far as its signal was kept."""
    name, until = result.board.spec.active, math.inf
    spans: list[tuple[str, int, float]] = []
    for entry in reversed(result.board.log):
        if entry.kind == "switch" and entry.new == name:
            spans.append((name, entry.tick, until))
            name, until = str(entry.old), entry.tick
    spans.append((name, 0, until))
    x, y = list[float](), list[float]()
    for driver, since, end in reversed(spans):
        if (signal_name := f"{driver}.rate") in _names(result):
            one = _trace(result, signal_name, "read")
            points = [at for at, ms in enumerate(one.x) if since <= round(ms / result.board.dt_ms) < end]
            x += [one.x[at] for at in points]
            y += [one.y[at] for at in points]
    return Series("read", x, y, look=signal("rate", 0))


def _lanes(result: RunResult) -> Chart | None:
    """Show the truth, and below it the verdicts of the first diagnosers, over time."""
    scores = {name: one for name, one in result.board.scores().items() if f"{name}.winner" in _names(result)}
    if not scores:
        return None
    lanes, seen = [], set[int]()
    words = diagnosis_words(result.board.spec.diagnosers)
    names = [words.get(one, one) for one in next(iter(scores.values())).names]
    for name in list(scores)[:MOST_LANES]:
        areas = _areas(result, f"{name}.truth", is_truth=True) + _areas(result, f"{name}.winner", is_truth=False)
        lanes.append(AreaRow(name.replace("_", " "), areas))
        for said in blocks(result.signal(f"{name}.truth"), result.signal(f"{name}.winner")):
            seen |= {int(value) for value in np.unique(said) if value >= 0}
    keys = [(names[i], hypothesis(i)) for i in sorted(seen) if i < len(names)]
    span = (0.0, (result.samples - 1) * result.board.dt_ms)
    return Chart(_title(result), Axis(TIME, "ms", span), marks=marks(result), lanes=lanes, keys=keys)


def _areas(result: RunResult, name: str, *, is_truth: bool) -> list[tuple[float, float, LineStyle, bool]]:
    """Return the hypothesis named at each moment; moments without one stay empty."""
    values = result.signal(name)
    picked = np.linspace(0, len(values) - 1, 2 * COLUMNS).astype(np.int64)
    time, verdict = picked * result.board.dt_ms, loaded(values, picked)
    edges = [0, *(np.flatnonzero(np.diff(verdict)) + 1).tolist(), len(verdict) - 1]
    return [
        (float(time[first]), float(time[end]), hypothesis(int(verdict[first])), is_truth)
        for first, end in itertools.pairwise(edges)
        if end > first and verdict[first] >= 0
    ]


def _identified(result: RunResult) -> Chart | None:
    """Show how far the identifiers are from the truth."""
    shown = [name for name in result.board.spec.identifiers if f"{name}.error_pct" in _names(result)]
    lines = []
    for name in shown:
        x, y = _thin(result, lambda error: np.minimum(error, 150.0), f"{name}.error_pct")
        lines.append(Series(name.replace("_", " "), x, y))
    return Chart(_title(result), Axis(TIME, "ms"), Axis("error", "%"), lines, marks(result)) if lines else None


def _motion(result: RunResult) -> Chart:
    """Show some periods of the motion: of the model, the shuttle, and the measurement."""
    at = _last_periods(result.signal("plant.displacement"))
    shown = [("plant.displacement", "shuttle"), ("model.displacement", "model"), ("sensor.displacement", "measured")]
    lines = [_trace(result, name, said, at) for name, said in shown]
    return Chart(_title(result), Axis(TIME, "ms"), Axis("displacement", "um"), lines)


def _sensed(result: RunResult) -> Chart:
    """Show how far the sensor is from the truth over some periods."""
    at = _last_periods(result.signal("plant.displacement"))
    error = _thin(result, np.subtract, "sensor.displacement", "plant.displacement", at=at)
    line = Series("error", *error, look=LineStyle(3))
    return Chart(_title(result), Axis(TIME, "ms"), Axis("measured less true", "um"), [line])


def _angle(result: RunResult) -> Chart | None:
    """Show the angle that a gyroscope reads instead of a rate."""
    name = f"{result.board.spec.active}.angle"
    if name not in _names(result):
        return None
    line = _trace(result, name, "angle")
    return Chart(_title(result), Axis(TIME, "ms"), Axis("angle", "deg"), [line], marks(result))


def _aside(result: RunResult) -> Chart | None:
    """Show how far the shuttle moves aside as it goes."""
    if "plant.shift" not in _names(result) or _periods(result.signal("plant.displacement")) > MANY:
        return None
    lines = [_trace(result, "plant.displacement", "displacement"), _trace(result, "plant.shift", "shift aside")]
    return Chart(_title(result), Axis(TIME, "ms"), Axis("displacement", "um"), lines, marks(result))


def _followed(result: RunResult) -> Chart:
    """Show the model and the shuttle; where their periods are indistinguishable, the error or the amplitudes."""
    names, time = _names(result), Axis(TIME, "ms")
    periods = _periods(result.signal("plant.displacement"))
    if periods <= MANY:
        shown = [("plant.displacement", "shuttle"), ("model.displacement", "model")]
        shown += [(f"{name}:plant.displacement", f"shuttle, {name}") for name in result.scenario.twins]
        lines = [_trace(result, name, said) for name, said in shown if name in names]
        return Chart(_title(result), time, Axis("displacement", "um"), lines, marks(result))
    if result.board.spec.active == "open_loop":
        amplitudes = [("shuttle", "plant.displacement"), ("model", "model.displacement")]
        lines = [
            Series(said, *_peaks(result, periods, np.asarray, name), look=signal(name, 0)) for said, name in amplitudes
        ]
        top = 1.08 * max(max(one.y) for one in lines) or 1.0
        return Chart(_title(result), time, Axis("amplitude", "um", (0.0, top)), lines, marks(result))
    at, peaks = _peaks(result, periods, np.subtract, "model.displacement", "plant.displacement")
    error = Series("error", at, np.maximum(peaks, LEAST_ERROR_UM).tolist(), look=signal("plant.displacement", 0))
    return Chart(_title(result), time, Axis("peak error", "um", is_log=True), [error], marks(result))


def _peaks(
    result: RunResult, periods: int, of: Callable[..., FloatArray], *names: str
) -> tuple[list[float], list[float]]:
    """Return the largest size of each period, or of each column where there are more periods, with its time, ms."""
    edges = np.linspace(0, result.samples, min(COLUMNS, periods) + 1).astype(np.int64).tolist()
    pieces = [[result.signal(name)[first:end] for name in names] for first, end in itertools.pairwise(edges)]
    sizes = [largest(lambda *values: np.abs(of(*values)), *piece) for piece in pieces]
    return [first * result.board.dt_ms for first in edges[:-1]], sizes


SHAPES: tuple[tuple[tuple[str, ...], Callable[[RunResult], Chart | None]], ...] = (
    (("rate.arw", "rate.bias_instability", "rate.random_walk", "rate.noise"), _allan),
    (("rate.phase_difference", "sync.error"), _in_step),
    (("gyro.tilt", "gyro.partner_tilt"), _locus),
    (("rate.angle",), _angle),
    (("diagnosis.", "estimation."), _lanes),
    (("identify.",), _identified),
    (("sensing.",), _sensed),
    (("lateral.",), _aside),
)
"""The beginning of an expectation, and the shape that shows it; the first that fits is taken."""
