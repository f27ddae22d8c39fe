"""Runs a scenario without a server, at full machine speed."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from core.block import FloatArray
from core.board.board import Board
from core.board.commands import Trip
from core.board.ensemble import Ensemble, make
from core.board.idle import leave_out_idle
from core.board.observer import cautions
from core.board.parse import changed
from core.errors import InputError
from core.signals import Signal
from scenarios.expectation import overall
from scenarios.measure import rate
from scenarios.measure.metrics import device_metrics, measure
from scenarios.measure.verdicts import TRACED_VERDICTS
from scenarios.schema import Scenario

DEFAULT_SAMPLES = 10_000
"""Length of a run whose scenario has no end."""
TRACED_FIGURES = (
    "plant.displacement",
    "sensor.displacement",
    "model.displacement",
    "drive.voltage",
    "reference.voltage",
)


@dataclass
class Result:
    """The result of a run; ``names`` are those of the columns of ``outputs``."""

    scenario: Scenario
    seed: int
    board: Board
    digest: str
    elapsed_s: float
    metrics: dict[str, float]
    warnings: list[str]
    names: list[str]
    outputs: FloatArray
    taps: FloatArray | None = field(default=None, repr=False)

    @property
    def trip(self) -> Trip | None:
        """Why the board stopped, if it did."""
        return self.board.trip

    @property
    def kept(self) -> list[Signal]:
        """Signals whose traces were kept: the outputs, and the taps if the caller asked for them."""
        kept = set(self.names)
        return [s for s in self.board.signals if s.name in kept or (s.kind == "tap" and self.taps is not None)]

    def signal(self, name: str) -> FloatArray:
        """Return the trace of one signal.

        Raises
        ------
        InputError
            When there is no such signal, or it was not kept.
        """
        column = self.board.signals.index(name)
        if name in self.names:
            return self.outputs[:, self.names.index(name)]
        if self.taps is None or column < self.board.signals.outputs:
            raise InputError("was not kept", name)
        return self.taps[:, column - self.board.signals.outputs]

    def expectations(self) -> list[dict[str, Any]]:
        """Return each expectation with the measured figure."""
        return judge(self.scenario, self.metrics)

    def summary(self) -> dict[str, Any]:
        """Return the object ``run --json`` prints."""
        return summarise(
            self.scenario,
            self.seed,
            self.board.tick,
            self.elapsed_s,
            self.metrics,
            self.digest,
            self.trip,
            self.warnings,
        )


def judge(scenario: Scenario, metrics: dict[str, float]) -> list[dict[str, Any]]:
    """Return each expectation of a scenario with the measured figure."""
    return [
        {
            "metric": entry.metric,
            "published": entry.published,
            "expected": entry.text(),
            "measured": metrics.get(entry.metric),
            "ok": entry.holds(metrics.get(entry.metric)),
            "published_value": entry.published_value,
            "verdict": entry.word(metrics.get(entry.metric)),
            "note": entry.note if entry.metric in metrics else "no such metric in this run",
        }
        for entry in scenario.head.expect
    ]


def summarise(
    scenario: Scenario,
    seed: int,
    ticks: int,
    elapsed_s: float,
    metrics: dict[str, float],
    digest: str,
    trip: Trip | None,
    warnings: list[str],
) -> dict[str, Any]:
    """Return the summary of a run, JSON-ready."""
    expectations = judge(scenario, metrics)
    return {
        "scenario": scenario.id,
        "title": scenario.head.title,
        "source": scenario.head.source,
        "claim": scenario.head.claim,
        "verdict": overall(entry["verdict"] for entry in expectations),
        "seed": seed,
        "ticks": ticks,
        "dt_s": scenario.spec.dt_ms / 1e3,
        "elapsed_s": elapsed_s,
        "digest": digest,
        "trip": trip.model_dump() if trip is not None else None,
        "warnings": warnings,
        "metrics": metrics,
        "expectations": expectations,
        "ok": all(entry["ok"] for entry in expectations),
    }


def build(scenario: Scenario, seed: int | None = None, *, compiled: bool = True) -> Board:
    """Return the board of a scenario at its first tick, its events waiting.

    Raises
    ------
    InputError
        When an event could never be carried out.
    """
    spec, twins = scenario.spec, scenario.twins
    if seed is not None:
        spec = changed(spec, {"seed": seed})
        twins = {name: changed(twin, {"seed": seed}) for name, twin in twins.items()}
    board = make(spec, twins, compiled=compiled)
    for text in scenario.warnings:
        board.note("scenario", "warning", text)
    for position, commands in enumerate(scenario.events):
        for command in commands:
            try:
                board.apply(command, "scenario")
            except InputError as error:
                raise error.under(f"events.{position}") from None
    return board


WORKER_BYTES, WORKING_COLUMNS = 460_000_000, 16
"""Memory beside the trace: the process itself (with pandas, which pyarrow loads where it is installed), a piece of the
trace being written, and the columns worked on."""


def run_bytes(board: Board, samples: int, *, taps: bool = False, figures_only: bool = False) -> int:
    """Return the most memory the process of a run takes."""
    columns = len(board.signals) if taps else board.signals.outputs
    return WORKER_BYTES + 8 * samples * ((len(watched(board)) if figures_only else columns) + WORKING_COLUMNS)


def run(
    scenario: Scenario,
    seed: int | None = None,
    *,
    taps: bool = False,
    figures_only: bool = False,
    compiled: bool = True,
    on_tick: Callable[[int], None] | None = None,
) -> Result:
    """Run a scenario from start to end, or until the board trips for good.

    Parameters
    ----------
    scenario : Scenario
        The scenario to run; one without a length runs `DEFAULT_SAMPLES`.
    seed : int, optional
        Instead of the scenario's own.
    taps : bool
        Keep the inner signals as well.
    figures_only : bool
        Keep only the outputs that figures are made of, and do not run controllers that only look on.
    compiled : bool
        Run compiled blocks.
    on_tick : callable, optional
        Called with the tick reached after every chunk; it may raise to end the run.
    """
    board = build(scenario, seed, compiled=compiled)
    if scenario.study is not None:
        return _run_study(scenario, board)
    samples = scenario.samples or DEFAULT_SAMPLES
    names = board.signals.names[: board.signals.outputs]
    if figures_only:
        names = watched(board)
        if not isinstance(board, Ensemble):  # what one of its boards does not need, another may
            leave_out_idle(board)
    columns = np.array([board.signals.index(name) for name in names], dtype=np.int64)
    outputs = np.empty((samples, len(names)))
    kept = np.empty((samples, len(board.signals) - board.signals.outputs)) if taps else None
    began = time.perf_counter()
    while board.tick < samples:
        rows = board.advance(samples - board.tick)
        if rows.count == 0:
            break  # tripped, and no waiting command would reset it
        outputs[rows.first_tick : board.tick] = rows.outputs[:, columns] if figures_only else rows.outputs
        if kept is not None:
            kept[rows.first_tick : board.tick] = rows.taps
        if on_tick is not None:
            on_tick(board.tick)
    elapsed = time.perf_counter() - began
    outputs = outputs[: board.tick]
    trace = dict(zip(names, outputs.T, strict=True))
    metrics = figures(board, trace, scenario)
    if isinstance(board, Ensemble):
        for name, twin in board.twins.items():
            own = figures(twin, trace, scenario, f"{name}:")
            metrics |= {f"twins.{name}.{metric}": value for metric, value in own.items()}
    return Result(
        scenario,
        board.spec.seed,
        board,
        board.digest(),
        elapsed,
        metrics,
        # a warning that came and went is listed once
        list(dict.fromkeys(entry.text for entry in board.log if entry.kind == "warning")),
        names,
        outputs,
        kept[: board.tick] if kept is not None else None,
    )


def figures(board: Board, trace: dict[str, FloatArray], scenario: Scenario, prefix: str = "") -> dict[str, float]:
    """Return the figures of a board from its trace, or those of a twin from the trace of all boards."""
    names = [name for name in figure_signals(board) if prefix + name in trace]
    # numpy adds neighbours in another order than numbers that lie apart
    own = {name: np.ascontiguousarray(trace[prefix + name][: board.tick]) for name in names}
    return measure(board, own, scenario.head.metrics)


def watched(board: Board) -> list[str]:
    """Return the outputs that the figures of a run are made of, those of twins with their prefix."""
    wanted = {*figure_signals(board), *evidence_signals(board)}
    wanted |= {f"{name}.{port}" for name in board.spec.controllers for port in rate.READ if board.spec.axes}
    if isinstance(board, Ensemble):
        for name, twin in board.twins.items():
            wanted |= {f"{name}:{signal}" for signal in figure_signals(twin)}
    return [signal.name for signal in board.signals if signal.kind == "output" and signal.name in wanted]


def evidence_signals(board: Board) -> list[str]:
    """Return the probabilities of all diagnosers that choose between hypotheses."""
    return [f"{name}.probability.{hypothesis}" for name, s in board.scores().items() for hypothesis in s.names]


def figure_signals(board: Board) -> list[str]:
    """Return the signals that the figures of a board are made of."""
    moved = rate.traced(board) if board.spec.axes else TRACED_FIGURES
    names = [*moved, *(f"{name}.{port}" for name in board.spec.diagnosers for port in TRACED_VERDICTS)]
    names += [f"{name}.error_pct" for name in board.spec.identifiers]
    return [name for name in names if name in board.signals]


def _run_study(scenario: Scenario, board: Board) -> Result:
    """Make a study of a bench, without a trace; the digest is the one of the figures."""
    assert scenario.study is not None
    study, params = scenario.study
    nothing = np.empty((0, board.signals.outputs)), np.empty((0, len(board.signals) - board.signals.outputs))
    fresh = Board.restore(board.checkpoint())
    began = time.perf_counter()
    metrics = {**device_metrics(board.spec), **study.figures(board, params)}
    elapsed = time.perf_counter() - began
    figures = np.array([metrics[name] for name in sorted(metrics)])
    digest = hashlib.sha256(figures.tobytes()).hexdigest()
    told = [*scenario.warnings, *cautions(board.spec)]
    names = board.signals.names[: board.signals.outputs]
    return Result(scenario, board.spec.seed, fresh, digest, elapsed, metrics, told, names, *nothing)
