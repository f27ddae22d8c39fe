"""Runs a scenario without a server, at full machine speed."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from core.block import FloatArray
from core.board.board import Board
from core.board.commands import Trip
from core.board.ensemble import Ensemble, make
from core.board.fold import alike
from core.board.hosted import NOTHING, Hosted
from core.board.idle import leave_out_idle
from core.board.outside import Conclusion, Law
from core.board.parse import changed
from core.compile.segment import code_of, kept_code_of
from core.errors import InputError
from core.signals import Signal
from scenarios.measure.estimation import estimation_metrics
from scenarios.measure.metrics import device_metrics, measure
from scenarios.narrator.narrator import Narrator
from scenarios.narrator.sentence import Sentence
from scenarios.samples import Samples, TraceSink
from scenarios.schema import Scenario
from scenarios.signals import PICTURED, figure_signals, traced
from scenarios.summary import judge, summarise

DEFAULT_SAMPLES = 10_000
"""Length of a run whose scenario has no end."""
LONG, VERY_LONG = 200_000, 30_000_000
"""Ticks from which a run loads the code of segments that is kept, and from which it compiles them.

The code saves about 0.1 us a tick; to find and load it takes 10 ms, to compile it 3 s.
"""


@dataclass
class RunResult:
    """The result of a run; ``trace`` has the signals that were kept, the signals of a long run in a temporary file."""

    scenario: Scenario
    seed: int
    board: Board
    digest: str
    elapsed_s: float
    metrics: dict[str, float]
    warnings: list[str]
    trace: dict[str, FloatArray] = field(repr=False)
    narration: list[Sentence] = field(default_factory=list, repr=False)

    @property
    def trip(self) -> Trip | None:
        """Why the board stopped, if it did."""
        return self.board.trip

    @property
    def samples(self) -> int:
        """Length of the traces, 0 of a study."""
        return len(next(iter(self.trace.values()), ()))

    @property
    def kept(self) -> list[Signal]:
        """Signals whose traces were kept."""
        return [signal for signal in self.board.signals if signal.name in self.trace]

    def signal(self, name: str) -> FloatArray:
        """Return the trace of one signal.

        Raises
        ------
        InputError
            When there is no such signal, or it was not kept.
        """
        self.board.signals.index(name)
        if name not in self.trace:
            raise InputError("was not kept", name)
        return self.trace[name]

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
    _await_events(board, scenario)
    return board


def build_hosted(
    scenario: Scenario,
    seed: int | None = None,
    *,
    law: Law | None = None,
    diagnosers: Mapping[str, Conclusion] = NOTHING,
    identifiers: Mapping[str, Conclusion] = NOTHING,
    compiled: bool = True,
) -> Hosted:
    """Return the board of a scenario with parts from outside in place of its own, at its first tick.

    Raises
    ------
    InputError
        As `build`; for a study, for twins, for a plant with axes, with a controller for an analogue drive.
    """
    for name, other in (("study", scenario.study), ("twins", scenario.twins)):
        if other:
            raise InputError("code from outside is asked by one board, and nothing else", name, "leave it out")
    spec = scenario.spec if seed is None else changed(scenario.spec, {"seed": seed})
    board = Hosted(spec, law, diagnosers=diagnosers, identifiers=identifiers, compiled=compiled)
    _await_events(board, scenario)
    return board


def _await_events(board: Board, scenario: Scenario) -> None:
    """Let the events of a scenario wait on its board, and note its warnings and whether it asks for estimates."""
    board.estimates = scenario.asks_estimates
    for text in scenario.warnings:
        board.note("scenario", "warning", text)
    for position, commands in enumerate(scenario.events):
        for command in commands:
            try:
                board.apply(command, "scenario")
            except InputError as error:
                raise error.under(f"events.{position}") from None


def run(
    scenario: Scenario,
    seed: int | None = None,
    *,
    taps: bool = False,
    figures_only: bool = False,
    everything: bool = False,
    compiled: bool = True,
    trace: TraceSink | None = None,
    on_tick: Callable[[int], None] | None = None,
    law: Law | None = None,
    diagnosers: Mapping[str, Conclusion] = NOTHING,
    identifiers: Mapping[str, Conclusion] = NOTHING,
    narrate: bool = False,
) -> RunResult:
    """Run a scenario from start to end, or until the board trips for good.

    The memory it takes does not depend on its length: the samples of a long run are in a temporary file.

    Parameters
    ----------
    scenario : Scenario
        The scenario to run; one without a length runs `DEFAULT_SAMPLES`.
    seed : int, optional
        Instead of the scenario's own.
    taps : bool
        Keep the inner signals as well.
    figures_only : bool
        Keep only the outputs that figures need.
    everything : bool
        Run and keep the blocks in shadow as well, as a live bench does; no figure and no digest depends on it.
    compiled : bool
        Run compiled blocks.
    trace : Trace, optional
        Receives the signals to be kept during the run; of taps, the result then has only the taps that reports show.
    on_tick : callable, optional
        Called with the tick reached after every chunk; it may raise to end the run.
    law : callable, optional
        Drives in place of the controller of the scenario: called with each `core.board.outside.Sample`, it answers with
        a voltage.
    diagnosers, identifiers : mapping
        Callables by id, in place of the callables of the scenario or in addition to them: called with each
        `core.board.outside.Observation`, they answer with the probability of each hypothesis, or with mass, stiffness
        and damping over nominal.
    narrate : bool
        Run the narrator.

    Raises
    ------
    OSError
        When samples have no room in the folder of temporary files, or an error of ``trace``.
    """
    if law or diagnosers or identifiers:
        board: Board = build_hosted(
            scenario, seed, law=law, diagnosers=diagnosers, identifiers=identifiers, compiled=compiled
        )
    else:
        board = build(scenario, seed, compiled=compiled)
    signals = traced(board, taps=taps, figures_only=figures_only, everything=everything)
    kept = [one for one in signals if trace is None or one.kind == "output" or one.name in PICTURED]
    if scenario.study is not None:
        result = _run_study(scenario, board, kept)
        if trace is not None:
            trace.begin(board, signals)
        return result
    if not everything:
        leave_out_idle(board)
    if trace is not None:
        trace.begin(board, signals)
    samples = scenario.samples or DEFAULT_SAMPLES
    split = board.signals.outputs
    _fuse(board, samples)
    outputs = np.array([one.index for one in kept if one.kind == "output"], dtype=np.int64)
    inner = np.array([one.index - split for one in kept if one.kind == "tap"], dtype=np.int64)
    narrator = Narrator(board.spec, list(board.signals)) if narrate else None
    narration: list[Sentence] = []
    began = time.perf_counter()
    with Samples(len(kept), samples) as stored:
        while board.tick < samples:
            rows = board.advance(samples - board.tick)
            if narrator is not None:
                narration += narrator.follow(board.log, rows)
            if rows.count == 0:
                break  # tripped, and no waiting command would reset it
            stored.add(np.hstack([rows.outputs[:, outputs], rows.taps[:, inner]]))
            if trace is not None:
                trace.add(rows)
            if on_tick is not None:
                on_tick(board.tick)
        columns = dict(zip((one.name for one in kept), stored.columns(), strict=True))
    elapsed = time.perf_counter() - began
    metrics = all_figures(board, columns, scenario)
    return RunResult(
        scenario,
        board.spec.seed,
        board,
        board.digest(),
        elapsed,
        metrics,
        # a warning that came and went is listed once
        list(dict.fromkeys(entry.text for entry in board.log if entry.kind == "warning")),
        columns,
        narration,
    )


def _fuse(board: Board, ticks: int) -> None:
    """Let a long run use the code of segments that is kept; a run so long that it pays compiles the rest."""
    if ticks < LONG:
        return
    board.fuse()
    for segment in board.unfused:
        code = (code_of if ticks >= VERY_LONG else kept_code_of)(segment.steps)
        if code is not None:
            segment.load(code)


def all_figures(board: Board, trace: dict[str, FloatArray], scenario: Scenario) -> dict[str, float]:
    """Return the figures of a board and of its twins from the trace of a run."""
    metrics = figures(board, trace, scenario)
    if isinstance(board, Ensemble):
        for name, twin in board.twins.items():
            own = figures(twin, trace, scenario, f"{name}:")
            metrics |= {f"twins.{name}.{metric}": value for metric, value in own.items()}
    return metrics


def figures(board: Board, trace: dict[str, FloatArray], scenario: Scenario, prefix: str = "") -> dict[str, float]:
    """Return the figures of a board from its trace, or the figures of a twin from the trace of all boards."""
    names = [name for name in figure_signals(board) if prefix + name in trace]
    metrics = measure(board, {name: trace[prefix + name][: board.tick] for name in names}, scenario.head.metrics)
    return metrics | (estimation_metrics(board) if scenario.asks_estimates else {})


def _run_study(scenario: Scenario, board: Board, kept: list[Signal]) -> RunResult:
    """Make a study of a bench, without a trace; the digest is the one of the figures."""
    assert scenario.study is not None
    study, params = scenario.study
    fresh = Board.restore(board.checkpoint())
    began = time.perf_counter()
    metrics = {**device_metrics(board.spec), **study.figures(board, params)}
    elapsed = time.perf_counter() - began
    figures = np.array([metrics[name] for name in sorted(metrics)])
    digest = hashlib.sha256(alike(figures.view(np.uint64)).tobytes()).hexdigest()
    told = [*scenario.warnings, *board.spec.cautions]
    nothing = {one.name: np.empty(0) for one in kept}
    return RunResult(scenario, board.spec.seed, fresh, digest, elapsed, metrics, told, nothing)
