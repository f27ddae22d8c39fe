"""Travel: benches are taken to the ends of other journals, and second benches continue from them."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from core.board.board import Board
from core.board.history import History
from core.board.log import Log
from core.board.track import Passage, Track
from core.errors import InputError
from scenarios.lecture import State
from scenarios.run import build
from scenarios.schema import Scenario
from server.bench.bench import LiveBench
from server.bench.build import Builder, rebuilt
from server.bench.description import design_of, experiment_of
from server.bench.engine import Engine
from server.bench.events import Event
from server.bench.journal import Journal
from server.bench.narration import Narration, Told
from server.bench.pacing import usual_scale
from server.bench.status import Origin, Travel
from server.bench.time import STATUS_S
from server.store.experiment import Experiment

if TYPE_CHECKING:
    from server.bench.benches import Benches

T = TypeVar("T")


@dataclass(frozen=True)
class Past:
    """The data of a bench, which continues, to compute its journal up to an earlier tick.

    Parameters
    ----------
    bench : LiveBench
        The bench.
    scenario : Scenario
        Its scenario.
    passage : Passage
        The way to the tick. The samples before it come from ``seen``, or the way begins so much earlier.
    track : Track
        The track of the bench, not followed any further.
    told : Told
        The sentences of the narrator at the beginning of the way.
    seen : History or None
        The samples of the bench, if they go back as far as the panels look.
    jumps : int
        How often the bench had jumped in time; samples that are read after one more may be of another past.
    window_ticks : int
        Ticks before the tick that are included.
    """

    bench: LiveBench
    scenario: Scenario
    passage: Passage
    track: Track
    told: Told
    seen: History | None
    jumps: int
    window_ticks: int

    @classmethod
    def take(cls, bench: LiveBench, tick: int, window_ticks: int, *, is_before: bool = False) -> Past:
        """Take the necessary data of a bench (a job of the engine).

        Parameters
        ----------
        bench : LiveBench
            The bench.
        tick : int
            The end of the journal, with the commands at that tick unless it is before them.
        window_ticks : int
            Ticks before it that are included.
        is_before : bool
            Leave out the commands at that very tick.

        Raises
        ------
        InputError
            For a tick that is not kept or has not come yet, and for a recording that is played.
        """
        track = bench.track
        if track is None:
            raise InputError("a recording that is played has no past to go to", "tick", "seek in it", "conflict")
        now = bench.board.tick
        if tick > now:
            raise InputError(f"tick {tick} has not come yet, the bench is at {now}", "tick")
        begin, history = max(tick - window_ticks, track.first_tick), bench.history
        seen = history if history.first_tick <= begin and tick <= history.end_tick else None
        passage = track.to(tick, 0 if seen else window_ticks, is_before=is_before)
        told = bench.narration.told().at(passage.checkpoint.tick)
        return cls(bench, bench.scenario, passage, track.copy(), told, seen, bench.narration.mark.jumps, window_ticks)

    def is_true(self) -> bool:
        """Whether the bench has not jumped since, so that the samples are of this past (a job of the engine)."""
        bench = self.bench
        return self.seen is None or (bench.history is self.seen and bench.narration.mark.jumps == self.jumps)

    def journal(self, on_share: Callable[[float], None]) -> Journal:
        """Compute the journal up to the tick.

        Parameters
        ----------
        on_share : callable
            Called with the share of the ticks that is done; it may raise an error to end the computation.
        """
        board = Board.restore(self.passage.checkpoint)
        narration = Narration(board.spec, self.bench.signals)
        narration.go_to(self.told, board.spec)
        history = self.bench.empty_history()
        if self.seen is not None:
            history.adopt(self.seen, self.passage.tick - self.window_ticks, board.tick)
        for rows in self.passage.walk(board):
            history.append(rows)
            narration.follow(board.log, rows)
            on_share((board.tick - self.passage.checkpoint.tick) / self.passage.ticks)
        narration.follow(board.log)
        board.log = Log()  # the log of the bench has it all
        return Journal(self.scenario, board.checkpoint(), self.track.until(board), narration.told(), history)


class Travels:
    """Takes benches to other journals, and makes benches from others.

    Parameters
    ----------
    benches : Benches
        The live benches.
    engine : Engine
        Whose thread may read a bench.
    most_ticks : int
        The longest experiment that is repeated.
    """

    def __init__(self, benches: Benches, engine: Engine, most_ticks: int) -> None:
        self._benches, self._engine, self._most_ticks = benches, engine, most_ticks

    async def fork(self, bench: LiveBench, snapshot_id: str | None, *, paused: bool = False) -> LiveBench:
        """Make a bench that continues from this moment of another, or from a snapshot."""
        coming = self._engine.call(forked, bench, snapshot_id, self._benches.builder)
        return await self._benches.admit(coming, bench.is_started and not paused)

    async def fork_at(
        self, bench: LiveBench, tick: int, window_ticks: int, *, is_before: bool = False, paused: bool = False
    ) -> LiveBench:
        """Make a bench that continues from a tick of the past of another, computed again.

        Raises
        ------
        InputError
            For a tick that is not kept.
        """
        past = await self._engine.call(partial(Past.take, bench, tick, window_ticks, is_before=is_before))

        def made(journal: Journal) -> LiveBench:
            board = journal.board()
            twin = self._benches.builder.around(journal.scenario, board, bench.time.pacer.scale)
            twin.events.go_on(bench.events.after(0)[1])
            twin.taken_over = twin.events.last
            twin.origin = Origin(bench=bench.id, tick=tick, window_ticks=window_ticks)
            show(twin, journal, "api", is_before=is_before, board=board)
            return twin

        return await self._benches.admit(self._computed(past, bench, made), bench.is_started and not paused)

    async def seek(self, bench: LiveBench, tick: int, actor: str) -> Event:
        """Show another tick of the past on a bench that shows a past tick; a computation for another tick is cancelled.

        Raises
        ------
        InputError
            For a tick that is not kept, when the bench has gone on, and when another tick is sought meanwhile.
        """
        origin = bench.origin
        assert origin is not None
        of = self._benches.find(origin.bench) or bench
        past = await self._engine.call(Past.take, of, tick, origin.window_ticks)
        bench.sought = past

        def shown(journal: Journal) -> Event:
            if not bench.is_past:
                raise InputError("it has gone on from its past", "kind", "fork the bench at a tick", "conflict")
            bench.origin = origin.model_copy(update={"tick": tick})
            return show(bench, journal, actor)

        return await self._computed(past, bench, shown, lambda: bench.sought is past)

    async def _computed(
        self,
        past: Past,
        asked: LiveBench,
        then: Callable[[Journal], T],
        is_wanted: Callable[[], bool] = lambda: True,
    ) -> T:
        """Compute a journal of the past while it is wanted, and give it to ``then`` (in a job of the engine).

        The bench of the request shows the progress. All steps after the computing are one job: pages get a picture
        after a job, and after several they would wait for the next one.
        """
        tick = past.passage.tick
        travel = asked.travel = Travel(tick=tick, share=0.0)

        def go(share: float) -> None:
            if not is_wanted():
                raise InputError("another moment is sought by now", "tick", code="conflict")
            travel.share = share

        def end() -> None:
            if asked.travel is travel:
                asked.travel = None
                asked.refresh_status()

        def settle(journal: Journal) -> T:
            end()
            if not past.is_true():
                raise InputError("the bench itself has gone to another moment meanwhile", "tick", code="conflict")
            return then(journal)

        computing = asyncio.create_task(asyncio.to_thread(past.journal, go))
        try:
            while not (await asyncio.wait([computing], timeout=STATUS_S))[0]:
                await self._engine.call(asked.refresh_status)
            return await self._engine.call(settle, await computing)
        except BaseException:
            await self._engine.call(end)
            raise

    async def variant(self, bench: LiveBench, values: dict[str, Any]) -> LiveBench:
        """Make a bench that begins as another is set now, with values written over it.

        Raises
        ------
        InputError
            If the values do not fit.
        ApiError
            If there are too many benches.
        """
        document = await self._engine.call(design_of, bench)
        paused, scale = not bench.is_started, bench.time.pacer.scale
        return await self._benches.create(document, values, bench.board.spec.seed, paused, scale)

    async def repeated(self, bench: LiveBench, values: dict[str, Any]) -> LiveBench:
        """Make a bench with the commands of another, with values written over its scenario; it is paused there.

        Raises
        ------
        InputError
            If the values do not fit the scenario or the commands.
        ApiError
            If there are too many benches, or the other has run for too long.
        """
        experiment = await self._engine.call(experiment_of, bench)

        def made() -> LiveBench:
            scenario, board = rebuilt(experiment, self._most_ticks, values)
            other = self._benches.builder.around(scenario, board, experiment.time_scale)
            repeat(other, experiment)
            return other

        return await self._benches.admit(asyncio.to_thread(made), start=False)

    async def cue(
        self, bench: LiveBench | None, state: State, pace: float | None, actor: str, text: str
    ) -> tuple[LiveBench, str]:
        """Put a bench into the state of a cue; return it and its digest.

        A bench of other signals is left alone, and a fresh bench is made.

        Parameters
        ----------
        bench : LiveBench, optional
            The bench; without one, a fresh bench is made.
        state : State
            The state of the cue.
        pace : float, optional
            Device seconds per wall second; the scale of the device by default.
        actor, text : str
            The user, and the text of the log.
        """

        def made() -> LiveBench:
            board = build(state.scenario)
            fresh = self._benches.builder.around(state.scenario, board, pace or usual_scale(board))
            forward(fresh, state.from_tick)
            return fresh

        fresh = await asyncio.to_thread(made)
        start, digest = state.until_tick > state.from_tick, fresh.board.digest()
        if bench is None or not bench.has_signals_of(fresh.board):
            return await self._benches.admit(fresh, start), digest
        await self._engine.call(_be_at_cue, bench, fresh, start, actor, text)
        return bench, digest


def forward(bench: LiveBench, tick: int) -> bool:
    """Bring a new bench to a tick, and carry out the commands that wait for it; return whether it came there."""
    board = bench.board
    while board.tick < tick and bench.advance(tick - board.tick):
        pass
    if isinstance(board, Board) and board.tick == tick:
        board.apply_due()
        bench.done_otherwise()
    return board.tick == tick


def repeat(bench: LiveBench, experiment: Experiment) -> bool:
    """Bring a new bench to the tick of an experiment; return whether its bits equal the original bits."""
    return forward(bench, experiment.tick) and bench.board.digest() == experiment.digest


def reset(bench: LiveBench, scenario: Scenario, board: Board, actor: str, before_tick: int | None = None) -> Event:
    """Begin a bench again with a new board of its signals; given a tick, run at once to shortly before it (a job)."""
    if not bench.has_signals_of(board):
        text = "these values give the bench other signals"
        raise InputError(text, "values", "make a new bench for them", "conflict")
    journal = Journal.beginning(scenario, board, bench.memory.track_bytes)
    event = bench.changes.stand(journal, actor, "reset", "reset to tick 0", board)
    bench.time.is_started = bench.time.is_started or before_tick is not None
    bench.time.fast_forward.begin(before_tick)
    bench.refresh_status()
    return event


def forked(bench: LiveBench, snapshot_id: str | None, builder: Builder) -> LiveBench:
    """Return a bench with the present state of another, or with the state of a snapshot (a job)."""
    if snapshot_id:
        journal = bench.recalled(bench.snapshots.get(snapshot_id).journal).for_another()
    else:
        journal = bench.journal(with_past=True).for_another()
    board = journal.board()
    twin = builder.around(journal.scenario, board, bench.time.pacer.scale)
    twin.stand(journal, "api", "forked", f"forked from bench {bench.id}", board)
    return twin


def show(
    bench: LiveBench, journal: Journal, actor: str, *, is_before: bool = False, board: Board | None = None
) -> Event:
    """Show the end of a journal of the past, or the moment before its commands; later events do not belong to it."""
    end = journal.tick if is_before else journal.tick + 1
    events = bench.events.after(0)[1]
    led = [event.seq for event in events if event.seq <= bench.taken_over and event.tick < end]
    journal = replace(journal, last_event=max(led, default=0))
    return bench.stand(journal, actor, "restored", f"shows tick {journal.tick} as it was", board)


def _be_at_cue(bench: LiveBench, fresh: LiveBench, start: bool, actor: str, text: str) -> None:
    """Stand where a fresh bench does, with its pace (a job)."""
    assert isinstance(fresh.board, Board)
    journal = replace(fresh.journal(), past=fresh.history).for_another()
    bench.changes.stand(journal, actor, "reset", text, fresh.board)
    bench.time.pace(fresh.time.pacer.scale)
    bench.time.is_started = start and bench.board.trip is None
    bench.refresh_status()
