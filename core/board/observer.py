"""Observer: puts into words the findings of the diagnosers and the warnings of the blocks."""

from __future__ import annotations

import copy
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from core.block import FloatArray, IntArray
from core.board.document import Document
from core.board.instances import scored
from core.board.spec import Spec
from core.board.wiring import Wiring
from core.diagnose.aliases import equivalents
from core.diagnose.consistency import AMBIGUOUS, ISOLATED, VERDICTS
from core.diagnose.hypothesis import hypotheses_of, names_of
from core.diagnose.regions import REGIONS
from core.format import format_count, format_short, format_si
from core.kernel import kernel

Finding = dict[str, Any]


@kernel
def follow(outputs: FloatArray, taps: FloatArray, columns: IntArray, last: FloatArray, found: IntArray) -> int:
    """Write down where a column differs from the row before, as far as there is room, and return how often."""
    count = 0
    width = outputs.shape[1]
    for i in range(len(outputs)):
        for k in range(len(columns)):
            value = outputs[i, columns[k]] if columns[k] < width else taps[i, columns[k] - width]
            if value != last[k]:
                if count < len(found):
                    found[count, 0] = columns[k]
                    found[count, 1] = i
                count += 1
                last[k] = value
    return count


class Observer:
    """Sees changes of the truth, its recognition, verdicts, regions, alarms and warnings in the rows of a board."""

    def __init__(self, spec: Spec, wiring: Wiring) -> None:
        signals = wiring.signals
        known = set(signals.names)
        self._dt_ms = spec.dt_ms
        self._names: dict[str, list[str]] = {}
        self._scored: dict[str, tuple[int, int]] = {}
        self._said: list[tuple[str, str, int]] = []
        self._consistent: dict[str, list[int]] = {}
        for name, section in spec.diagnosers.items():
            if scored(section.block):
                self._names[name] = names_of(section.params)
                self._scored[name] = signals.index(f"{name}.truth"), signals.index(f"{name}.delay")
            for port in ("verdict", "region", "alarm", "unexcited"):
                if f"{name}.{port}" in known:
                    self._said.append((name, port, signals.index(f"{name}.{port}")))
            if f"{name}.verdict" in known:
                labels = self._names[name]
                self._consistent[name] = [signals.index(f"{name}.consistent.{label}") for label in labels]
        self._warnings = {signals.index(name): text for name, text in warnings(wiring).items()}
        start = {column: 0.0 for _, _, column in self._said} | dict.fromkeys(self._warnings, 0.0)
        for truth, delay in self._scored.values():
            start[truth], start[delay] = -2.0, -1.0
        # followed all at once: most of the time nothing changes
        self._columns = np.array(sorted(start), dtype=np.int64)
        self._last = np.array([start[column] for column in self._columns.tolist()])
        self._found = np.zeros((64, 2), dtype=np.int64)
        self._cautioned: Document | None = None
        self._cautions: set[str] = set()

    def look(self, spec: Spec, first_tick: int, outputs: FloatArray, taps: FloatArray) -> list[Finding]:
        """Return the findings in some rows of a bench as it is now, as the fields of log entries."""
        found: list[Finding] = []
        changes = self._changes(outputs, taps)
        if not changes:
            return found

        def column(index: int) -> FloatArray:
            width = outputs.shape[1]
            return outputs[:, index] if index < width else taps[:, index - width]

        for at, text in self._warnings.items():
            rises = [row for row in changes.get(at, ()) if column(at)[row] > 0.0]
            found += [{"kind": "warning", "text": text, "tick": first_tick + row} for row in rises]
        for name, (truth_at, delay_at) in self._scored.items():
            turned, found_now = changes.get(truth_at, ()), changes.get(delay_at, ())
            if turned or found_now:
                truth, delay = column(truth_at), column(delay_at)
                found += self._recognised(name, turned, found_now, truth, delay, first_tick)
        for name, port, at in self._said:
            for i in changes.get(at, ()):
                value = int(column(at)[i])
                text = self._text(spec, name, port, value, i, column)
                found.append({"kind": port, "text": f"{name}: {text}", "tick": first_tick + i, "new": text})
        return sorted(found, key=lambda finding: int(finding["tick"]))

    def __deepcopy__(self, _memo: dict[int, Any]) -> Observer:
        """Return an independent observer that continues from the values this observer saw."""
        other = copy.copy(self)
        other._last, other._found, other._cautions = self._last.copy(), self._found.copy(), set(self._cautions)
        return other

    @property
    def followed(self) -> tuple[IntArray, FloatArray]:
        """The columns that it follows, outputs before taps, and the numbers they had last."""
        return self._columns, self._last

    def seen(self) -> tuple[FloatArray, list[str]]:
        """Return the values it saw last and its warnings so far; another observer can continue from them."""
        return self._last.copy(), sorted(self._cautions)

    def go_on(self, last: FloatArray, cautions: list[str]) -> None:
        """Continue from the values that another observer of the same bench saw."""
        self._last[:], self._cautions = last, set(cautions)

    def caution(self, spec: Spec, tick: int) -> list[Finding]:
        """Warn before a tick, once, of each block that assumes another course of the voltage than the real one."""
        if spec.document is self._cautioned:  # a fault changes none of these blocks
            return []
        self._cautioned = spec.document
        new = [text for text in spec.cautions if text not in self._cautions]
        self._cautions.update(new)
        return [{"kind": "warning", "text": text, "tick": tick} for text in new]

    def _changes(self, outputs: FloatArray, taps: FloatArray) -> dict[int, list[int]]:
        """Return the rows in which each watched signal changes."""
        last = self._last.copy()
        count = follow(outputs, taps, self._columns, self._last, self._found)
        if count > len(self._found):
            self._found, self._last = np.zeros((count, 2), dtype=np.int64), last
            follow(outputs, taps, self._columns, self._last, self._found)
        changes: dict[int, list[int]] = {}
        for at, row in self._found[:count].tolist():
            changes.setdefault(at, []).append(row)
        return changes

    def _recognised(
        self,
        name: str,
        turned: Sequence[int],
        found_now: Sequence[int],
        truth: FloatArray,
        delay: FloatArray,
        first_tick: int,
    ) -> list[Finding]:
        labels = self._names[name]
        found: list[Finding] = []
        for i in sorted({*turned, *found_now}):
            tick = first_tick + i
            label = labels[int(truth[i])] if truth[i] >= 0 else "none of the hypotheses"
            if i in turned:
                text = f"{name}: the truth is {label}"
                found.append({"kind": "truth_changed", "text": text, "tick": tick, "new": label})
            if i in found_now and delay[i] >= 0:
                samples = int(delay[i])
                time = format_si(samples * self._dt_ms, "ms", 3)
                text = f"{name} found {label} after {format_count(samples, 'sample')} ({time})"
                if samples == 0:  # it found nothing: its verdict was there before the truth
                    text = f"{name} said {label} already"
                found.append({"kind": "recognised", "text": text, "tick": tick, "old": samples, "new": label})
        return found

    def _text(self, spec: Spec, name: str, port: str, value: int, row: int, column: Callable[[int], FloatArray]) -> str:
        if port == "region":
            return REGIONS[value]
        if port == "alarm":
            return "alarm" if value else "alarm over"
        if port == "unexcited":
            return "the drive hardly tells the likeliest two apart" if value else "the drive tells them apart again"
        if value not in (ISOLATED, AMBIGUOUS):
            return VERDICTS[value]
        labels, columns = self._names[name], self._consistent[name]
        left = [label for label, at in zip(labels, columns, strict=True) if column(at)[row] != 0.0]
        aliases = _aliases(spec, name, left[0]) if value == ISOLATED else ""
        return f"{VERDICTS[value]}: {', '.join(left)}{aliases}"


def warnings(wiring: Wiring) -> dict[str, str]:
    """Return the taps that warn when they rise, with the text of each warning."""
    return {
        f"{instance.prefix}.{port.name}": f"{instance.key}: {port.warning}"
        for instance in wiring.instances
        for port in instance.block.taps
        if port.warning
    }


def _aliases(spec: Spec, name: str, label: str) -> str:
    """Name the changes that have the same response at the tones of the drive as a hypothesis."""
    hypotheses = hypotheses_of(spec.diagnosers[name].params)
    found = [
        f"{part} x {format_short(factor, '')}"
        for part, factor in equivalents(hypotheses, label, spec.context().device, spec.tones).items()
    ]
    return f" (the same here: {', '.join(found)})" if found else ""
