"""Checkpoints of live benches on disk: after a crash each continues at its tick, bit for bit, with its log.

A bench has two files. One holds the board and is replaced as a whole, the other grows by the events. A crash loses the
part after the last write: less than a second.
"""

from __future__ import annotations

import asyncio
import json
import logging
import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from pydantic import BaseModel

from core.board.board import Board
from core.board.document import Document
from core.board.stored import Stored, revived, stored
from core.errors import InputError
from core.own.admission import kept
from scenarios.schema import Scenario
from server.bench.bench import LiveBench
from server.bench.engine import Engine
from server.bench.events import KEPT, Event
from server.bench.view import KeptWatch
from server.clock import Clock
from server.errors import ApiError
from server.store.experiment import THIS_VERSION

log = logging.getLogger(__name__)

EVERY_S, AT_ONCE = 0.7, 16
"""Time between two writings, and benches that are taken between two slices of the engine."""
BOARD, EVENTS, PART, HUNG, DOCUMENT, WATCH = ".npz", ".events", ".part", ".hung", "document", "watch"


class Head(BaseModel):
    """A bench without its board and its events."""

    id: str
    class_id: str
    name: str = ""
    keep: bool = False
    scenario: dict[str, Any]
    created: datetime
    time_scale: float | None
    running: bool
    tick: int
    last_event: int
    version: str
    rules: Document | None = None
    rules_since: int = 0


class State(NamedTuple):
    """The parts of a bench by which a written checkpoint is known to be current."""

    tick: int
    last_event: int
    running: bool
    name: str
    keep: bool

    @classmethod
    def of(cls, bench: LiveBench) -> State:
        """Return the state of a bench."""
        return cls(bench.board.tick, bench.events.last, bench.is_started, bench.name, bench.keep)

    @classmethod
    def written(cls, head: Head) -> State:
        """Return the state in a checkpoint."""
        return cls(*(getattr(head, field) for field in cls._fields))


@dataclass
class Kept:
    """A bench as its files have it, or with the events that are to be added to them."""

    head: Head
    stored: Stored
    events: list[Event]
    watch: KeptWatch | None = None

    def board_of(self) -> tuple[Scenario, Board]:
        """Return the scenario, and the board that continues.

        Raises
        ------
        InputError
            If this version of the code is another.
        """
        if self.head.version != THIS_VERSION:
            raise InputError(f"was kept by version {self.head.version}")
        with kept():
            return Scenario.load(self.head.scenario), revived(self.stored)

    def put_into(self, session: LiveBench) -> None:
        """Restore the stored state into a new bench."""
        session.id, session.created, session.name = self.head.id, self.head.created, self.head.name
        session.keep = session.keep or self.head.keep
        session.events.go_on(self.events)


class Checkpoints:
    """The files of the benches that are to survive a crash.

    Parameters
    ----------
    folder : Path
        Where they are.
    engine : Engine
        Whose thread may read a bench.
    benches : callable
        Lists the benches to keep.
    """

    def __init__(self, folder: Path, engine: Engine, benches: Callable[[], list[LiveBench]]) -> None:
        self._folder, self._engine, self._benches = folder, engine, benches
        self._written: dict[str, State] = {}
        self._turn = asyncio.Lock()

    async def run(self, clock: Clock) -> None:
        """Write the benches that have changed, again and again."""
        async for _ in clock.every(EVERY_S):
            await self.write()

    async def write(self) -> None:
        """Write the benches that have changed since the last time, several at once: a change of threads is dear."""
        async with self._turn:
            changed = [one for one in self._benches() if self._written.get(one.id) != State.of(one)]
            for at in range(0, len(changed), AT_ONCE):
                taken = await self._engine.call(self._take, changed[at : at + AT_ONCE])
                await asyncio.to_thread(self._save_all, taken)

    async def load(self, bench_id: str) -> Kept | None:
        """Return a bench that was kept; nothing if there is none that can be read."""
        async with self._turn:
            try:
                return await asyncio.to_thread(self._load, bench_id)
            except FileNotFoundError:
                return None
            except Exception:
                log.exception("the checkpoint of bench %s cannot be read", bench_id)
                return None

    async def ids(self) -> list[str]:
        """List the benches that were kept."""
        paths = await asyncio.to_thread(lambda: sorted(self._folder.glob(f"*{BOARD}")))
        return [path.name.removesuffix(BOARD) for path in paths]

    def record_hang(self, bench_id: str) -> None:
        """Note on disk that the engine hangs in a slice of a bench: it is not brought back (on any thread)."""
        self._folder.mkdir(parents=True, exist_ok=True)
        self._path(bench_id, HUNG).touch()

    async def forget(self, bench_id: str) -> None:
        """Delete the checkpoint of a bench."""
        async with self._turn:
            self._written.pop(bench_id, None)
            for suffix in (BOARD, EVENTS, BOARD + PART, HUNG):
                await asyncio.to_thread(self._path(bench_id, suffix).unlink, missing_ok=True)

    async def forget_others(self) -> None:
        """Delete the checkpoints of benches that do not exist."""
        async with self._turn:
            live = {session.id for session in self._benches()}
            for path in list(self._folder.glob("*")):
                if path.name.partition(".")[0] not in live:
                    await asyncio.to_thread(path.unlink, missing_ok=True)

    def _path(self, bench_id: str, suffix: str) -> Path:
        return self._folder / f"{bench_id}{suffix}"

    def _take(self, benches: Sequence[LiveBench]) -> list[Kept]:
        """Return the present state of some benches, with the events that are not written yet (a job of the engine)."""
        found = []
        for bench in benches:
            with _tried(bench.id):
                written = self._written.get(bench.id)
                found.append(_taken(bench, written.last_event if written is not None else 0))
        return found

    def _save_all(self, some: Sequence[Kept]) -> None:
        """Write the state of some benches."""
        for one in some:
            with _tried(one.head.id):
                self._save(one)
                self._written[one.head.id] = State.written(one.head)

    def _save(self, kept: Kept) -> None:
        """Write the events first: those beyond the board are left out when they are read.

        An engine that gives the state of a bench does not hang in it any more.
        """
        head = kept.head
        self._folder.mkdir(parents=True, exist_ok=True)
        if kept.events:
            with self._path(head.id, EVENTS).open("a", encoding="utf-8") as file:
                file.write("".join(f"{event.model_dump_json()}\n" for event in kept.events))
        watch = kept.watch.document if kept.watch is not None else None
        document = {**head.model_dump(), "board": kept.stored.document, WATCH: watch}
        text = json.dumps(document, default=str).encode()
        part = self._path(head.id, BOARD + PART)
        with part.open("wb") as file:
            arrays: dict[str, Any] = {DOCUMENT: np.frombuffer(text, np.uint8), **kept.stored.arrays}
            if kept.watch is not None:
                arrays[WATCH] = kept.watch.samples
            np.savez(file, **arrays)
        os.replace(part, self._path(head.id, BOARD))
        self._path(head.id, HUNG).unlink(missing_ok=True)

    def _load(self, bench_id: str) -> Kept:
        if self._path(bench_id, HUNG).exists():
            raise InputError("the engine hung in it")
        with self._path(bench_id, BOARD).open("rb") as file, np.load(file, allow_pickle=False) as parts:
            document = json.loads(parts[DOCUMENT].tobytes())
            arrays = {name: parts[name] for name in parts.files if name != DOCUMENT}
        board, seen, samples = document.pop("board"), document.pop(WATCH, None), arrays.pop(WATCH, None)
        head, path = Head.model_validate(document), self._path(bench_id, EVENTS)
        lines = path.read_text("utf-8").splitlines() if path.exists() else []
        known: dict[int, Event] = {}
        for line in lines:
            try:
                event = Event.model_validate_json(line)
            except ValueError:
                continue  # the crash came in the middle of it
            if event.seq <= head.last_event:
                known[event.seq] = event
        events = [known[seq] for seq in sorted(known)]
        path.write_text("".join(f"{event.model_dump_json()}\n" for event in events), "utf-8")
        self._written[bench_id] = State.written(head)
        watch = KeptWatch(seen, samples) if seen is not None and samples is not None else None
        return Kept(head, Stored(board, arrays), events[-KEPT:], watch)


@contextmanager
def _tried(bench_id: str) -> Iterator[None]:
    """Try to keep a bench: the others are kept although it fails."""
    try:
        yield
    except ApiError:
        pass  # it has been closed meanwhile
    except Exception:
        log.exception("bench %s could not be kept; it is tried again", bench_id)


def _taken(session: LiveBench, after: int) -> Kept:
    """Return the present state of a bench, with its events after one (a job of the engine)."""
    session.must_be_open()
    watch = session.watch.kept(session) if session.watch is not None else None
    view = session.view
    head = Head(
        id=session.id,
        class_id=session.class_id,
        **State.of(session)._asdict(),
        scenario=session.scenario.document,
        created=session.created,
        time_scale=session.time.pacer.scale,
        version=THIS_VERSION,
        rules=view.rules.model_dump() if view is not None else None,
        rules_since=view.since if view is not None else 0,
    )
    return Kept(head, stored(session.board), session.events.after(after)[1], watch)  # type: ignore[arg-type]
