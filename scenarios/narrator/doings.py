"""Actions on a bench, and its trips: one sentence for each entry of the log."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from core.board.document import SUPERVISOR
from core.board.log import LogEntry
from core.board.spec import Spec
from core.errors import InputError
from core.faults.fault import FaultParams
from core.format import format_percent, format_short
from core.loop.guard import BEYOND_TRAVEL, ON_THE_RAIL, REASONS
from scenarios.narrator.samples import NarratorSignals, rms
from scenarios.narrator.sentence import Kind, Sentence
from scenarios.narrator.words import change, figure, length, listed, moment, uncapital

TOLD = ("inject", "heal", "switch", "set", "tripped", "make_safe")
"""Kinds of entries with a sentence; of set parameters only a change of the driving controller."""
TRIPS = ("tripped", "make_safe")
SCALES = {"mass": "effects.mass_scale", "stiffness": "effects.stiffness_scale", "damping": "effects.damping_scale"}
MODEL, MEASURED = "model.displacement", "sensor.displacement"
SPAN = 100
"""Ticks over which an error is taken."""


class Doings:
    r"""Writes the sentences about actions on a bench.

    A sentence about a fault or its healing gives the factors of the device relative to the nominal device from that
    tick on. A sentence about a switch gives the root mean square of the measured error over the 100 ticks before,
    :math:`\sqrt{\tfrac1{100}\sum(y_m-y)^2}`. A sentence about a trip gives the value that was too large, and the limit.

    Parameters
    ----------
    spec : Spec
        The bench as it begins.
    """

    def __init__(self, spec: Spec) -> None:
        self._library, self._dt_ms = spec.library, spec.dt_ms
        guard: Any = spec.guard.params
        limits = (name for name in ("travel_um", "rail_ms") if hasattr(guard, name))  # the guard of a record has none
        self._limits = {f"guard.{name}": getattr(guard, name) for name in limits}

    def sentence(self, entry: LogEntry, samples: NarratorSignals) -> Sentence | None:
        """Say an entry; nothing if it is of another kind."""
        command = entry.command or {}
        if entry.actor == SUPERVISOR and entry.kind in ("set", "switch"):
            return self._said("switch", entry.tick, f"the supervisor acts: {entry.text}", [], {})
        if entry.kind == "set":
            old, new = entry.old or {}, entry.new or {}
            self._limits = {path: new.get(path, value) for path, value in self._limits.items()}
            slots = [path for path in new if path == "controller.kind" or path.startswith("slots.")]
            switched = [path for path in slots if old.get(path) != new[path]]
            return self._switch(entry.tick, old.get(switched[0]), new[switched[0]], samples) if switched else None
        if entry.kind == "switch":
            return self._switch(entry.tick, entry.old, command["switch"], samples)
        if entry.kind == "inject":
            return self._fault(entry, command, samples)
        if entry.kind == "heal":
            return self._heal(entry, samples)
        return self._trip(entry) if entry.kind in TRIPS else None

    def _said(self, kind: Kind, tick: int, text: str, signals: list[str], numbers: dict[str, float]) -> Sentence:
        """Return a sentence of one tick."""
        numbers = {"time_ms": tick * self._dt_ms, **numbers}
        text = f"At {moment(numbers['time_ms'])} {text}."
        return Sentence(tick=tick, kind=kind, text=text, signals=signals, span=(tick, tick), numbers=numbers)

    def _switch(self, tick: int, old: Any, new: str, samples: NarratorSignals) -> Sentence:
        came, went = self._title("control", new), self._title("control", old)
        restarts = f"{came} starts anew"
        text = restarts if old == new or not old else f"{came} takes the drive over from {went}"
        numbers, signals = {}, []
        if MODEL in samples and MEASURED in samples and tick > (samples.began or 0):
            first = max(samples.began or 0, tick - SPAN)
            error = rms(samples.values(MODEL, first, tick) - samples.values(MEASURED, first, tick))
            numbers = {"error_um": error, "span_ticks": float(tick - first)}
            signals = [MODEL, MEASURED]
            text += f"; before, the error was {figure(error, 'um')} (RMS over {length((tick - first) * self._dt_ms)})"
        return self._said("switch", tick, text, signals, numbers)

    def _fault(self, entry: LogEntry, command: dict[str, Any], samples: NarratorSignals) -> Sentence:
        name, severity = command["fault"], float(command["severity"])
        title, size = uncapital(self._title("faults", name)), self._severity(name, severity)
        before = (entry.old or {}).get("severity")
        numbers = {"severity": severity} | ({} if before is None else {"severity_before": float(before)})
        begins = f"a fault begins: {title} {size}"
        if before is not None:
            begins = f"a fault changes: {title} goes from {self._severity(name, before)} to {size}"
        numbers_now, changed, signals = self._factors(entry.tick, [name], samples)
        text = f"{begins}{self._course(command.get('profile', {}))}; {changed or f'it changes {self._changes(name)}'}"
        return self._said("fault", entry.tick, text, [f"faults.{name}", *signals], numbers | numbers_now)

    def _heal(self, entry: LogEntry, samples: NarratorSignals) -> Sentence | None:
        names = list(entry.old or {})
        if not names:  # all were to be healed, and none was there
            return None
        numbers, changed, signals = self._factors(entry.tick, names, samples)
        titles = listed([uncapital(self._title("faults", name)) for name in names])
        healed = f"{titles} {'is' if len(names) == 1 else 'are'} healed"
        text = f"{healed}; {changed}" if changed else healed
        faults = {"faults": float(len(names))}
        return self._said("heal", entry.tick, text, [*(f"faults.{name}" for name in names), *signals], faults | numbers)

    def _factors(
        self, tick: int, faults: Sequence[str], samples: NarratorSignals
    ) -> tuple[dict[str, float], str, list[str]]:
        """Return the factors on the nominal device that faults change at a tick, in words too, and their signals."""
        numbers, said, signals = {}, [], []
        blocks = [self._library.blocks("faults").get(name) for name in faults]
        reached = {port.source for block in blocks if block is not None for port in block.inputs}
        for noun, name in SCALES.items():
            if name not in reached or name not in samples:
                continue
            now = samples.at(name, tick)
            before = samples.at(name, tick - 1) if tick > (samples.began or 0) else 1.0
            if now != before:
                numbers[f"{noun}_scale"] = now
                times = "again" if now == 1.0 else f"{format_short(now, '', 3)} times"
                said.append(f"the {noun} is {times} the healthy value")
                signals.append(name)
        return numbers, listed(said) if said else "", signals

    def _trip(self, entry: LogEntry) -> Sentence:
        trip = entry.new if isinstance(entry.new, dict) else {}
        value, numbers, said = trip.get("value"), {}, ""
        reason = trip.get("reason") or entry.text
        limit = {BEYOND_TRAVEL: "guard.travel_um", ON_THE_RAIL: "guard.rail_ms"}
        path = next((path for code, path in limit.items() if REASONS[int(code)][0] == reason), "")
        unit = path.rpartition("_")[2]
        if path:
            numbers["limit"] = float(self._limits[path])
            said = f"at most {figure(numbers['limit'], unit)} allowed"
        if value is not None:
            numbers["value"] = float(value)
            if unit == "um":
                said = f"{figure(abs(value), unit)}, {said}"
        text = f"the board stops itself: {reason}{f' ({said})' if said else ''}" if trip else reason
        return self._said("trip", entry.tick, text, [trip["signal"]] if trip.get("signal") else [], numbers)

    def _severity(self, name: str, value: float) -> str:
        """Write a severity: a share in percent, anything else in its unit."""
        block: Any = self._library.blocks("faults").get(name)
        unit = block.outputs[0].unit if block is not None else "1"
        return change(value) if unit == "1" else f"{'+' if value > 0.0 else ''}{format_short(value, unit, 3)}"

    def _course(self, profile: dict[str, Any]) -> str:
        """Say how a fault comes, if not at once."""
        usual = FaultParams().profile
        if profile.get("kind") == "ramp":
            return f", growing over {length(profile.get('duration_ms', usual.duration_ms))}"
        if profile.get("kind") == "intermittent":
            share = format_percent(profile.get("duty", usual.duty), 0)
            return f", there for {share} of every {length(profile.get('period_ms', usual.period_ms))}"
        return ""

    def _changes(self, name: str) -> str:
        """Return the changes by a fault, without their consequences."""
        block: Any = self._library.blocks("faults").get(name)
        return f"the {getattr(block, 'changes', 'device').partition(';')[0]}"

    def _title(self, family: str, name: Any) -> str:
        """Return the title of a block; its name where this version does not know it."""
        try:
            return self._library.block(family, str(name), "").title
        except InputError:
            return str(name)
