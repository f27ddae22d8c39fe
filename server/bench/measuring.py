"""Measures the run of a live bench by the figures of a headless run: computed again in parallel, so with its bits."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from typing import TYPE_CHECKING

from core.board.board import Board
from core.board.track import Track
from scenarios.run import DEFAULT_SAMPLES, all_figures
from scenarios.samples import Samples
from scenarios.schema import Scenario
from scenarios.signals import traced

if TYPE_CHECKING:
    from server.bench.bench import LiveBench

MOST_TICKS = 2_000_000
"""Longest run that is measured next to its bench."""
AT_ONCE = 200_000
"""Ticks that are computed for one answer."""


@dataclass(frozen=True)
class RunSoFar:
    """How far the present run of a bench is (a job of the engine).

    Parameters
    ----------
    scenario : Scenario
        Its scenario.
    track : Track or None
        Its past, not followed any further; none of a recording that is played.
    jumps : int
        How often the bench has begun again or gone back.
    tick : int
        Where it is.
    digest : str
        Digest of its outputs so far.
    is_stopped : bool
        Whether a trip has stopped it.
    """

    scenario: Scenario
    track: Track | None
    jumps: int
    tick: int
    digest: str
    is_stopped: bool

    @classmethod
    def of(cls, bench: LiveBench) -> RunSoFar:
        """Look at a bench."""
        board, jumps = bench.board, bench.narration.mark.jumps
        stopped = board.trip is not None and not bench.is_running
        track = bench.track.copy() if bench.track is not None else None
        return cls(bench.scenario, track, jumps, board.tick, board.digest(), stopped)

    @property
    def ends_at(self) -> int:
        """Tick at which a headless run of the scenario ends."""
        return self.scenario.samples or DEFAULT_SAMPLES


@dataclass(frozen=True)
class RunFigures:
    """Figures of the first ticks of a run; ``reason`` explains missing figures."""

    tick: int = 0
    metrics: dict[str, float] | None = None
    is_over: bool = False
    reason: str = ""


class Measuring:
    """Follows the run of a bench on a board of its own, from the first request on."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._run: RunSoFar | None = None
        self._board: Board | None = None
        self._samples: Samples | None = None
        self._kept: tuple[list[str], list[int]] = [], []
        self._figures = RunFigures()

    def figures(self, run: RunSoFar) -> RunFigures:
        """Return the figures of the run, at most a number of ticks further than at the last call (in a thread)."""
        with self._lock:
            if run.track is None:
                return RunFigures(reason="a recording that is played is measured by the run it is of")
            if run.track.first_tick > 0:
                return RunFigures(reason="the beginning of this run is not kept")
            if run.ends_at > MOST_TICKS:
                return RunFigures(reason=f"this run is longer than {MOST_TICKS} ticks; run it headless")
            known = self._run
            if known is None or known.jumps != run.jumps or known.scenario is not run.scenario:
                self._begin(run, run.track)
            self._run = run
            return self._follow(run, run.track)

    def _begin(self, run: RunSoFar, track: Track) -> None:
        """Begin at the first tick of a run."""
        board = Board.restore(track.to(0, is_before=True).checkpoint)
        kept = traced(board, figures_only=True)
        self._board, self._samples = board, Samples(len(kept), run.ends_at)
        self._kept = [one.name for one in kept], [one.index for one in kept]
        self._figures = RunFigures()

    def _follow(self, run: RunSoFar, track: Track) -> RunFigures:
        """Go on to where the bench is, or to the end of the run."""
        board, samples = self._board, self._samples
        assert board is not None
        assert samples is not None
        end = min(run.tick, run.ends_at, board.tick + AT_ONCE)
        is_over = end == run.ends_at or (run.is_stopped and end == run.tick)
        if end <= board.tick and is_over == self._figures.is_over and self._figures.metrics is not None:
            return self._figures
        names, places = self._kept
        for rows in track.onward(board, end).walk(board):
            samples.add(rows.outputs[:, places])
        if not self._is_same(run, track, board):
            return RunFigures(reason="a change of this bench was no command, so its run cannot be repeated")
        if end:
            columns = dict(zip(names, samples.columns(), strict=True))
            self._figures = RunFigures(end, all_figures(board, columns, run.scenario), is_over)
        return self._figures

    @staticmethod
    def _is_same(run: RunSoFar, track: Track, board: Board) -> bool:
        """Whether a board has the same outputs as the bench by then, as far as they can be compared."""
        if board.tick == run.tick:
            return board.digest() == run.digest
        return board.tick < run.ends_at or board.digest() == track.to(board.tick).board().digest()
