"""Observer: puts into words what the diagnosers found, and what blocks warn of."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from core.block import FloatArray
from core.board.spec import Spec
from core.board.wiring import Wiring, scored
from core.diagnose.aliases import equivalents
from core.diagnose.consistency import AMBIGUOUS, ISOLATED, VERDICTS
from core.diagnose.regions import REGIONS

Finding = dict[str, Any]


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
                self._names[name] = [item.name for item in section.params.hypotheses]  # type: ignore[attr-defined]
                self._scored[name] = signals.index(f"{name}.truth"), signals.index(f"{name}.delay")
            for port in ("verdict", "region", "alarm", "unexcited"):
                if f"{name}.{port}" in known:
                    self._said.append((name, port, signals.index(f"{name}.{port}")))
            if f"{name}.verdict" in known:
                labels = self._names[name]
                self._consistent[name] = [signals.index(f"{name}.consistent.{label}") for label in labels]
        self._last: dict[int, float] = {column: 0.0 for _, _, column in self._said}
        for truth, delay in self._scored.values():
            self._last[truth], self._last[delay] = -2.0, -1.0
        self._warnings = [
            (signals.index(f"{instance.prefix}.{port.name}") - signals.outputs, f"{instance.key}: {port.warning}")
            for instance in wiring.instances
            for port in instance.block.taps
            if port.warning
        ]
        self._warned = [0.0] * len(self._warnings)

    def look(self, spec: Spec, first_tick: int, outputs: FloatArray, taps: FloatArray) -> list[Finding]:
        """Return what happened in some rows of a bench as it is now, as the fields of log entries."""
        found: list[Finding] = []
        if not len(outputs):
            return found
        for which, (at, text) in enumerate(self._warnings):
            flag = taps[:, at]
            if self._warned[which] != 0.0 or flag.any():
                rises = np.flatnonzero(np.diff(flag, prepend=self._warned[which]) > 0.0).tolist()
                found += [{"kind": "warning", "text": text, "tick": first_tick + row} for row in rises]
                self._warned[which] = float(flag[-1])

        def column(index: int) -> FloatArray:
            width = outputs.shape[1]
            return outputs[:, index] if index < width else taps[:, index - width]

        for name, (truth_at, delay_at) in self._scored.items():
            truth, delay = column(truth_at), column(delay_at)
            moved, found_now = self._changes(truth_at, truth), self._changes(delay_at, delay)
            if moved is not None or found_now is not None:
                rows = np.union1d(moved if moved is not None else [], found_now if found_now is not None else [])
                found += self._recognised(name, rows.astype(int), moved, found_now, truth, delay, first_tick)
        for name, port, at in self._said:
            values = column(at)
            changes = self._changes(at, values)
            for i in changes if changes is not None else ():
                text = self._text(spec, name, port, int(values[i]), int(i), column)
                found.append({"kind": port, "text": f"{name}: {text}", "tick": first_tick + int(i), "new": text})
        return sorted(found, key=lambda finding: int(finding["tick"]))

    def _changes(self, at: int, values: FloatArray) -> Any:
        """Return the rows in which a signal is not what it was before, none if it never is."""
        last = self._last[at]
        if values[0] == last and values[-1] == last and (values == last).all():
            return None
        self._last[at] = values[-1]
        return np.flatnonzero(np.diff(values, prepend=last) != 0)

    def _recognised(
        self, name: str, rows: Any, moved: Any, found_now: Any, truth: FloatArray, delay: FloatArray, first_tick: int
    ) -> list[Finding]:
        labels = self._names[name]
        found: list[Finding] = []
        for i in rows:
            tick = first_tick + int(i)
            label = labels[int(truth[i])] if truth[i] >= 0 else "none of the hypotheses"
            if moved is not None and i in moved:
                text = f"{name}: the truth is {label}"
                found.append({"kind": "truth_changed", "text": text, "tick": tick, "new": label})
            if found_now is not None and i in found_now and delay[i] >= 0:
                samples = int(delay[i])
                text = f"{name} found {label} after {samples} samples ({samples * self._dt_ms:.3g} ms)"
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


def _aliases(spec: Spec, name: str, label: str) -> str:
    """Name the changes that have the same response at the tones of the drive as a hypothesis."""
    waveform: Any = spec.reference.block
    hypotheses: Any = getattr(spec.diagnosers[name].params, "hypotheses")  # noqa: B009
    context = spec.context()
    tones = waveform.tones(spec.reference.params, context)
    found = [f"{part} x {factor:.4g}" for part, factor in equivalents(hypotheses, label, context.device, tones).items()]
    return f" (the same here: {', '.join(found)})" if found else ""
