"""Observer: puts into words what the diagnosers found, and what blocks warn of."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import FloatArray
from core.board.spec import Spec
from core.board.wiring import Wiring


class Observer:
    """Sees changes of the truth, its recognition, and warnings, in the rows of a board."""

    def __init__(self, spec: Spec, wiring: Wiring) -> None:
        signals = wiring.signals
        self._dt_ms = spec.dt_ms
        self._watched = {
            name: (
                [item.name for item in section.params.hypotheses],  # type: ignore[attr-defined]
                signals.index(f"{name}.truth"),
                signals.index(f"{name}.delay") - signals.outputs,
            )
            for name, section in spec.diagnosers.items()
        }
        self._last = dict.fromkeys(self._watched, (-2.0, -1.0))
        self._warnings = [
            (signals.index(f"{instance.prefix}.{port.name}") - signals.outputs, f"{instance.key}: {port.warning}")
            for instance in wiring.instances
            for port in instance.block.taps
            if port.warning
        ]
        self._warned = [0.0] * len(self._warnings)

    def look(self, first_tick: int, outputs: FloatArray, taps: FloatArray) -> list[dict[str, Any]]:
        """Return what happened in some rows, as the fields of log entries."""
        found: list[dict[str, Any]] = []
        for which, (column, text) in enumerate(self._warnings):
            flag = taps[:, column]
            if self._warned[which] != 0.0 or flag.any():
                rises = np.flatnonzero(np.diff(flag, prepend=self._warned[which]) > 0.0).tolist()
                found += [{"kind": "warning", "text": text, "tick": first_tick + at} for at in rises]
                self._warned[which] = float(flag[-1]) if len(flag) else self._warned[which]
        for name, (labels, truth_column, delay_column) in self._watched.items():
            truth, delay = outputs[:, truth_column], taps[:, delay_column]
            last_truth, last_delay = self._last[name]
            if not len(truth) or ((truth == last_truth).all() and (delay == last_delay).all()):
                continue
            self._last[name] = (truth[-1], delay[-1])
            moved = np.diff(truth, prepend=last_truth) != 0
            recognised = (np.diff(delay, prepend=last_delay) != 0) & (delay >= 0)
            for i in np.flatnonzero(moved | recognised):
                tick = first_tick + int(i)
                label = labels[int(truth[i])] if truth[i] >= 0 else "none of the hypotheses"
                if moved[i]:
                    text = f"{name}: the truth is {label}"
                    found.append({"kind": "truth_changed", "text": text, "tick": tick, "new": label})
                if recognised[i]:
                    samples = int(delay[i])
                    text = f"{name} found {label} after {samples} samples ({samples * self._dt_ms:.3g} ms)"
                    found.append({"kind": "recognised", "text": text, "tick": tick, "old": samples, "new": label})
        return sorted(found, key=lambda finding: int(finding["tick"]))
