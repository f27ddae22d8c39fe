"""An ensemble: a board and its twins, which are built otherwise and meet the same reference, noise and faults."""

from __future__ import annotations

import copy
import hashlib
from collections.abc import Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from itertools import takewhile
from typing import Any

import numpy as np

from core.block import FloatArray
from core.board import supervision
from core.board.board import Board, Checkpoint
from core.board.changes import switched
from core.board.commands import Command, ResetTrip, SetValues, Switch
from core.board.document import Document, with_values
from core.board.library import IDENTIFIER
from core.board.log import LogEntry
from core.board.parse import parse
from core.board.rows import Rows
from core.board.segments import SharedSegment
from core.board.spec import Section, Spec
from core.errors import InputError, short, unknown
from core.loop.score import Scores
from core.signals import Signal, SignalTable

MOST = 3
"""Twins of a board; four boards together."""

OWN = ("plant", "slots", "controller", "controllers", "sensor", "sensors", "diagnosers", "supervisor", "readouts",
       "drive", "board", "guard")  # fmt: skip
"""Sections a twin may have of its own; it shares all others with the board."""

SHOWN = ("plant.displacement", "plant.velocity", "sensor.displacement", "model.displacement", "reference.voltage")
"""Signals of a twin that are always seen, besides its controller, drive and diagnosers."""


def twin_documents(document: Document) -> dict[str, Document]:
    """Return the bench of every twin: the bench of the board with the values of the twin written over.

    Raises
    ------
    InputError
        When there are too many twins, or a twin changes a section that all share.
    """
    twins = document.get("twins", {})
    if not isinstance(twins, dict):
        raise InputError(f"must be a table, got {short(twins)}", "twins")
    if len(twins) > MOST:
        raise InputError(f"at most {MOST} twins, got {len(twins)}", "twins")
    base = {key: value for key, value in document.items() if key != "twins"}
    found = {}
    for name, values in twins.items():
        if not IDENTIFIER.fullmatch(name):
            raise InputError("must be a short name of small letters, digits and _", f"twins.{name}")
        if not isinstance(values, dict):
            raise InputError(f"must be a table, got {short(values)}", f"twins.{name}")
        for key in values:
            if key not in OWN:
                raise unknown("table", key, OWN, f"twins.{name}.{key}")
        found[name] = with_values(base, dict(_leaves(values)))
    return found


def twin_specs(document: Document) -> dict[str, Spec]:
    """Return the bench of every twin, checked.

    Raises
    ------
    InputError
        As `twin_documents`, and for the first thing that is not allowed in one, with its dotted path.
    """
    found = {}
    for name, own in twin_documents(document).items():
        try:
            found[name] = parse(own)
            supervision.check(found[name])
        except InputError as error:
            raise error.under(f"twins.{name}") from None
    return found


def _leaves(table: Document, path: str = "") -> Iterator[tuple[str, Any]]:
    """Return the values of nested tables by dotted path."""
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _leaves(value, f"{path}{key}.")
        else:
            yield f"{path}{key}", value


NOTED = {"recognised": "recognised", "tripped": "twin_tripped", "warning": "warning"}
"""Kinds of entries that the log of the board takes from the log of a twin, with their kinds there."""


class Ensemble(Board):
    """A board with twins, advanced together: all of them carry out each command to the board at the same tick.

    Their signals are called ``<twin>:<signal>``. A twin keeps its own values: a switch of the controller does
    not reach a twin whose controller was chosen for it. A twin that trips rests until the board is reset.

    Parameters
    ----------
    bench : dict or Spec
        The bench; ``twins`` of its document holds the sections each twin has of its own.
    twins : dict of Spec, optional
        The bench of every twin, where it has been read from that document already.
    compiled : bool
        Run compiled blocks.
    """

    def __init__(
        self, bench: Document | Spec, twins: Mapping[str, Spec] | None = None, *, compiled: bool = True
    ) -> None:
        document = bench.document if isinstance(bench, Spec) else bench
        alone = {key: value for key, value in document.items() if key != "twins"}
        super().__init__(replace(bench, document=alone) if isinstance(bench, Spec) else alone, compiled=compiled)
        values = copy.deepcopy(document.get("twins", {}))
        self.base["twins"] = values
        self.twins: dict[str, Board] = {}
        for name, own in (twin_documents(document) if twins is None else twins).items():
            try:
                self.twins[name] = Board(own, compiled=compiled)
            except InputError as error:
                raise error.under(f"twins.{name}") from None
        self._own = {name: [path for path, _ in _leaves(with_values(own, {}))] for name, own in values.items()}
        self.mirrored = 0
        self.warned: set[str] = set()
        self._table_of_all()

    def _table_of_all(self) -> None:
        """Join the tables of signals, outputs before taps."""
        chosen = [("", self.wiring.signals, list(range(len(self.wiring.signals))))]
        chosen += [(f"{name}:", twin.signals, shown(twin)) for name, twin in self.twins.items()]
        found: list[Signal] = []
        self._columns: list[tuple[list[int], list[int]]] = []
        for kind in ("output", "tap"):
            for prefix, table, columns in chosen:
                for column in columns:
                    signal = table[column]
                    if signal.kind == kind:
                        found.append(signal.model_copy(update={"name": prefix + signal.name, "index": len(found)}))
        for _, table, columns in chosen[1:]:
            outputs = [column for column in columns if column < table.outputs]
            self._columns.append((outputs, [column - table.outputs for column in columns if column >= table.outputs]))
        self._signals = SignalTable(found)

    @property
    def signals(self) -> SignalTable:
        """Table of the traced signals of all."""
        return self._signals

    @property
    def nbytes(self) -> int:
        """Memory that a checkpoint of all takes."""
        return super().nbytes + sum(twin.nbytes for twin in self.twins.values())

    def digest(self) -> str:
        """Return the SHA-256 of the digests of all."""
        parts = [super().digest(), *(twin.digest() for twin in self.twins.values())]
        return hashlib.sha256("".join(parts).encode()).hexdigest()

    @property
    def diagnosers(self) -> dict[str, Section]:
        """Every diagnoser; a diagnoser of a twin is named ``<twin>:<id>``."""
        found = dict(super().diagnosers)
        for name, twin in self.twins.items():
            found |= {f"{name}:{key}": section for key, section in twin.diagnosers.items()}
        return found

    def scores(self) -> dict[str, Scores]:
        """Return the score of every diagnoser; a diagnoser of a twin is named ``<twin>:<id>``."""
        found = super().scores()
        for name, twin in self.twins.items():
            found |= {f"{name}:{key}": scores for key, scores in twin.scores().items()}
        return found

    @property
    def keeps(self) -> bool:
        """The signals of its twins join its own in rows."""
        return False

    def advance(self, n: int) -> Rows:
        """Run up to ``n`` ticks of all; fewer when the board trips. Rows of a tripped twin are NaN."""
        rows = super().advance(n)
        if rows.count == 0:
            return rows
        todo, self.mirrored = self.done[self.mirrored :], len(self.done)
        outputs, taps, idle = [rows.outputs], [rows.taps], [rows.idle]
        for (name, twin), (shown_outputs, shown_taps) in zip(self.twins.items(), self._columns, strict=True):
            for tick, command in todo:
                self._mirror(name, twin, command.at(tick))
            seen = twin.log.last
            own = twin.advance(rows.count)
            new = list(takewhile(lambda entry: entry.seq > seen, reversed(twin.log)))  # noqa: B023
            self._repeat(name, new[::-1])
            outputs.append(_filled(own.outputs[:, shown_outputs], rows.count))
            taps.append(_filled(own.taps[:, shown_taps], rows.count))
            # a twin that tripped in these rows has no numbers for the rest of them
            idle.append(own.idle[shown_taps] & (own.count == rows.count))
        return Rows(rows.first_tick, rows.count, np.hstack(outputs), np.hstack(taps), np.concatenate(idle))

    def own_paths(self, name: str) -> list[str]:
        """Return the dotted paths of the values that a twin has for itself."""
        return self._own[name]

    def _mirror(self, name: str, twin: Board, command: Command) -> None:
        """Carry out a command of the board on a twin at the same tick, except for values the twin has of its own."""
        own = self._own[name]
        if isinstance(command, Switch) and any(path in own for path in switched(twin.spec, command)):
            return
        if isinstance(command, SetValues):
            shared = {path: value for path, value in command.set.items() if not is_own(path, own)}
            if not shared:
                return
            command = command.model_copy(update={"set": shared})
        if isinstance(command, ResetTrip):
            twin.apply_due()  # what made it safe may wait for this very tick
            if twin.trip is not None and command.at_sample is not None:
                twin.tick = command.at_sample  # it rested meanwhile
        with suppress(InputError):  # a twin may refuse it, such as a heal of the cause of its trip
            twin.apply(command)

    def _repeat(self, name: str, entries: list[LogEntry]) -> None:
        """Note the findings of a twin, its warnings that the board does not give, and the reason why it rests."""
        for entry in entries:
            kind = NOTED.get(entry.kind)
            if kind is None or (kind == "warning" and entry.text in self.warned):
                continue
            self.note("board", kind, f"{name}: {entry.text}", tick=entry.tick, old=entry.old, new=entry.new)

    def note(self, actor: str, kind: str, text: str, **rest: Any) -> LogEntry:
        """Write an entry of the log, and remember the warnings of the board."""
        if kind == "warning":
            self.warned.add(text)
        return super().note(actor, kind, text, **rest)

    def checkpoint(self) -> Checkpoint:
        """Return the board and its twins as they are at this tick edge."""
        whole = super().checkpoint()
        twins = {name: twin.checkpoint() for name, twin in self.twins.items()}
        whole.parts.update(twins=twins, _own=self._own, mirrored=self.mirrored, warned=set(self.warned))
        return whole

    @property
    def unfused(self) -> list[SharedSegment]:
        """The segments of the board and of its twins whose code is not loaded."""
        return [*super().unfused, *(segment for twin in self.twins.values() for segment in twin.unfused)]

    def fuse(self) -> None:
        """Run the segments of the board and of its twins as one function each."""
        super().fuse()
        for twin in self.twins.values():
            twin.fuse()

    def renew(self) -> None:
        """Take the code of all steps that has been loaded, also for the twins."""
        super().renew()
        for twin in self.twins.values():
            twin.renew()

    def _revive(self) -> None:
        self.twins = {name: Board.restore(kept) for name, kept in self.twins.items()}  # type: ignore[arg-type]
        self.warned = set(self.warned)
        super()._revive()
        self._table_of_all()


def shown(twin: Board) -> list[int]:
    """Return the columns of a twin worth seeing."""
    spec = twin.spec
    blocks = {
        *spec.driving.values(),
        "drive",
        *spec.diagnosers,
        *spec.supervisors,
        *(f"{name}.score" for name in spec.diagnosers),
    }
    if spec.axes:
        blocks |= {"plant", *spec.generators, *spec.readouts}
        blocks |= {f"{part}.{axis}" for part in ("sensor", "drive") for axis in spec.axes}
    return [signal.index for signal in twin.signals if signal.block in blocks or signal.name in SHOWN]


def is_own(path: str, own: list[str]) -> bool:
    """Say whether a path is one the twin was given, or leads to one."""
    return any(path == mine or mine.startswith(f"{path}.") for mine in own)


def _filled(rows: FloatArray, count: int) -> FloatArray:
    """Return as many rows, with NaN in the rows that were not run."""
    if len(rows) == count:
        return rows
    return np.vstack([rows, np.full((count - len(rows), rows.shape[1]), np.nan)])


def make(bench: Document | Spec, twins: Mapping[str, Spec] | None = None, *, compiled: bool = True) -> Board:
    """Return a board, with its twins if it has any."""
    document = bench.document if isinstance(bench, Spec) else bench
    if document.get("twins"):
        return Ensemble(bench, twins, compiled=compiled)
    return Board(bench, compiled=compiled)
