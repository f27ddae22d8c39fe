"""The narrator: a fold over the rows and the log of a bench, which gives plain sentences about its events."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from itertools import takewhile
from typing import Any

import numpy as np

from core.block import IntArray
from core.board.instances import scored
from core.board.kept import Ticks
from core.board.log import Log, LogEntry
from core.board.spec import Spec
from core.kernel import kernel
from core.signals import Signal
from scenarios.narrator.doings import MEASURED, MODEL, SCALES, TOLD, TRIPS, Doings
from scenarios.narrator.samples import NarratorSignals
from scenarios.narrator.sentence import KINDS, Sentence
from scenarios.narrator.settling import Settling
from scenarios.narrator.verdicts import Verdicts, WinnerTurns

PORTS = ("winner", "truth")
"""Ports of a diagnoser that are followed from tick to tick, and the ports that are read when it changes."""
EACH = ("probability", "residual", "nis")


@kernel
def _turns(values: Any, last: Any, found: IntArray, ends: IntArray) -> int:
    """Write down where each signal differs from the tick before, one signal after another; return how often."""
    count = 0
    for k in range(values.shape[0]):
        for i in range(values.shape[1]):
            if values[k, i] != last[k]:
                found[count] = i
                count += 1
                last[k] = values[k, i]
        ends[k] = count
    return count


class Narrator:
    """Tells faults, healings, switches, verdicts, trips, and when the error is back.

    It reads only the signals and entries it is given, so it cannot report anything else. The sentences do not depend on
    how many rows it is shown at a time.

    Parameters
    ----------
    spec : Spec
        The bench as it begins.
    signals : sequence of Signal
        The signals that sentences may use.
    """

    def __init__(self, spec: Spec, signals: Sequence[Signal]) -> None:
        column = {signal.name: signal.index for signal in signals}
        chosen = [
            name for name, section in spec.diagnosers.items() if scored(section.block) and f"{name}.winner" in column
        ]
        turns = {name: spec.turns(spec.diagnosers[name]) for name in chosen}
        self._verdicts = [
            Verdicts(name, spec.diagnosers[name], turns[name], spec.dt_ms, len(chosen) == 1) for name in chosen
        ]
        self._doings, self._settling = Doings(spec), Settling(spec.dt_ms)
        self._samples = NarratorSignals(
            column, [name for name in (MODEL, MEASURED, *SCALES.values()) if name in column]
        )
        is_known = spec.record is None or spec.record.has_labels  # the truth
        ports = PORTS if is_known else PORTS[:1]
        self._followed = [f"{name}.{port}" for name in chosen for port in ports if f"{name}.{port}" in column]
        self._columns = np.array([column[name] for name in self._followed], dtype=np.int64)
        self._last = np.full(len(self._followed), np.nan, np.float32)
        self._signals = [
            *self._followed,
            *(name for name in (MODEL, MEASURED, *SCALES.values()) if name in column),
            *(name for name in column if name.split(".")[0] in chosen and name.split(".")[1] in EACH),
        ]
        self._heard: list[LogEntry] = []
        self._last_heard = 0

    def hear(self, entry: LogEntry) -> None:
        """Take an entry of the log, before the row of its tick is shown."""
        if entry.kind in TOLD:
            self._heard = [*self._heard, entry]

    def follow(self, log: Log, rows: Ticks | None = None) -> list[Sentence]:
        """Return the sentences after some more rows, or none, of a board with its log."""
        new = list(takewhile(lambda entry: entry.seq > self._last_heard, reversed(log)))
        self._last_heard = log.last
        for entry in reversed(new):
            self.hear(entry)
        return self.tell() if rows is None else self.look(rows)

    def look(self, rows: Ticks) -> list[Sentence]:
        """Return the sentences after some more rows, which may be none."""
        if not rows.count:
            return self.tell()
        self._samples.show(rows)
        found = self.tell()
        found += self._settling.look(self._samples, self._samples.end)
        changes = self._changes(rows)
        found += [said for one in self._verdicts for said in one.look(self._samples, changes)]
        self._samples.hide()
        return sorted(found, key=lambda said: (said.tick, KINDS.index(said.kind)))

    def _changes(self, rows: Ticks) -> dict[str, WinnerTurns]:
        """Return the changes of the winners and truths."""
        values = rows.singles(self._columns, 0, rows.count)
        found, ends = np.empty(values.size, np.int64), np.empty(len(values), np.int64)
        self._last = self._last.copy()  # a copy of this continues independently
        count = _turns(values, self._last, found, ends)
        changes, start = dict[str, WinnerTurns](), 0
        for name, own, end in zip(self._followed, values, ends.tolist() if count else [], strict=False):
            if end > start:
                at, start = found[start:end], end
                changes[name] = WinnerTurns((rows.first_tick + at).tolist(), own[at].astype(np.int64).tolist())
        return changes

    def tell(self) -> list[Sentence]:
        """Return the sentences of the new entries: a trip at once, anything else when its tick has run."""
        end = self._samples.end
        due: list[LogEntry] = []
        later: list[LogEntry] = []
        for entry in self._heard:
            is_due = entry.tick < end or (entry.tick == end and entry.kind in TRIPS)
            (due if is_due else later).append(entry)
        self._heard = later
        found: list[Sentence] = []
        for entry in sorted(due, key=lambda one: one.tick):
            if entry.tick >= (self._samples.began or 0) and (said := self._doings.sentence(entry, self._samples)):
                found += [*self._settling.look(self._samples, said.tick), said]
                self._settling.follow(said)
        return found

    def copy(self) -> Narrator:
        """Return an independent narrator with the same state."""
        twin = copy.copy(self)
        twin._verdicts = [copy.copy(one) for one in self._verdicts]
        twin._doings, twin._settling = copy.copy(self._doings), copy.copy(self._settling)
        twin._samples = self._samples.copy()
        return twin

    @property
    def signals(self) -> list[str]:
        """The signals it reads."""
        return self._signals
