"""Wires a bench: which blocks, in which order, and which port reads which signal."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from core.block import BoolArray, FloatArray, IntArray
from core.board import program
from core.board.facts import numbers
from core.board.instances import Instance, feeds_forward, instances
from core.board.spec import Spec
from core.board.stages import behind
from core.faults.fault import Fault
from core.loop.effects import Effects
from core.plain import plain
from core.ports import RESERVED, Port
from core.sense.sensor import Sensor
from core.signals import Signal, SignalTable

N = TypeVar("N", np.float64, np.int64)

NOTHING = "@nothing"
"""A signal that stays 0; an input whose source ends in ``?`` reads it where no block has that signal."""


@dataclass
class Wiring:
    """All arrays of a board, and where everything is in them."""

    instances: list[Instance]
    signals: SignalTable
    index: dict[str, int]
    table: IntArray
    p: FloatArray
    s: FloatArray
    w: FloatArray
    io: IntArray
    rows: dict[str, int]
    """The row of every instance, by its key."""
    unread: list[bool]
    """Row by row, whether it is a sensor whose signals are not read."""
    absent: list[bool]
    """Row by row, whether its parameters leave it nothing to do, as with a fault of no severity."""
    tap_rows: IntArray
    """The row that every tap comes from."""
    endless: BoolArray
    """Number by number of the states, whether it begins as infinite or as no number, and so may always be."""
    left_out: set[int] = field(default_factory=set)
    """Rows that never run, because their signals are not watched."""
    resting: set[int] = field(default_factory=set)
    places: dict[int, IntArray] = field(default_factory=dict)
    """Row by row, the places of its signals, as far as they were asked for."""
    is_changed: bool = True
    """Whether other rows may have to run than before, or at other ticks."""

    def __deepcopy__(self, _memo: dict[int, Any]) -> Wiring:
        """Return a wiring of its own for a copy of the board; both share what never changes in place."""
        return replace(
            self,
            instances=[*self.instances],
            **{name: getattr(self, name).copy() for name in ("table", "p", "s", "w", "io", "unread", "absent")},
            **{name: getattr(self, name).copy() for name in ("left_out", "resting", "places")},
        )

    def beside(self, order: list[Instance], p: FloatArray, s: FloatArray, w: FloatArray) -> Wiring:
        """Return a wiring of blocks and numbers of its own that shares all else with this one."""
        found = object.__new__(Wiring)
        vars(found).update(vars(self), instances=[*order], p=p, s=s, w=w)
        return found

    @property
    def trip(self) -> int:
        """The place of the signal that stops the board."""
        return self.index[f"{self.instances[-1].prefix}.trip"]  # the guard comes last

    def row(self, key: str) -> int:
        """Return the table row of an instance."""
        return self.rows[key]

    def packed(self, row: int) -> FloatArray:
        """Return the packed parameters of a row, a view."""
        return self._part(self.p, row, program.P_OFFSET)

    def state_of(self, key: str) -> FloatArray:
        """Return the state of an instance, a view."""
        return self._part(self.s, self.rows[key], program.S_OFFSET)

    def parameters(self, key: str) -> Any:
        """Return the parameters of an instance, a record; for a board among others a copy."""
        row = self.rows[key]
        return self.instances[row].block.Packed(np.ascontiguousarray(self.packed(row)))

    def state(self, key: str) -> Any:
        """Return the state of an instance, a record; for a board among others a copy."""
        return self.instances[self.rows[key]].block.State(np.ascontiguousarray(self.state_of(key)))

    def ports(self, row: int) -> IntArray:
        """Return the places of the ports of a row, a view."""
        return self._part(self.io, row, program.IO_OFFSET)

    def bound(self, row: int) -> Callable[[], None]:
        """Return the step of a row in plain Python, bound to its arrays."""
        block = self.instances[row].block
        p, s, io = self.packed(row), self._part(self.s, row, program.S_OFFSET), self.ports(row)
        return partial(plain(block.step), block.Packed(p), block.State(s), block.Ports(self.w, io))

    def _part(self, whole: NDArray[N], row: int, column: int) -> NDArray[N]:
        end = self.table[row + 1, column] if row + 1 < len(self.instances) else len(whole)
        return whole[self.table[row, column] : end]

    def rest(self, spec: Spec) -> list[int]:
        """Return the rows that run; reset the rows that rest, and set their signals to 0."""
        self.is_changed = False
        rows = [row for row in range(len(self.instances)) if row not in self.left_out]
        running = [row for row in rows if not (self.unread[row] or self.absent[row])]
        if len(running) + len(self.resting) != len(self.instances) or not self.resting.isdisjoint(running):
            self.put_to_rest(spec, set(range(len(self.instances))) - {*running} - self.resting)
            self.resting = set(range(len(self.instances))) - {*running}
        return running

    def put_to_rest(self, spec: Spec, rows: set[int]) -> None:
        """Make rows as new, and their signals 0."""
        for row in rows:
            instance = self.instances[row]
            state = self.state_of(instance.key)
            if len(state):
                context = spec.context(instance.every, instance.axis)
                state[:] = instance.block.initial(instance.params, context)
            self.w[self.signals_of_row(row)] = 0.0

    def signals_of_row(self, row: int) -> IntArray:
        """Return the places of the signals of a row."""
        if row not in self.places:
            self.places[row] = self._places(self.instances[row])
        return self.places[row]

    def _places(self, instance: Instance) -> IntArray:
        found: list[int] = []
        for port in (*instance.block.outputs, *instance.block.taps):
            start = self.index[signal_name(instance, port.name)]
            found += range(start, start + len(port.names(instance.params)))
        return np.array(found, dtype=np.int64)

    def idle(self, running: list[int]) -> BoolArray:
        """Return which taps stay 0 while these rows run."""
        idle = np.ones(len(self.instances), dtype=np.bool_)
        idle[running] = False
        return idle[self.tap_rows]


def wire(spec: Spec, like: Wiring | None = None, read: list[set[str]] | None = None) -> Wiring:
    """Lay out the arrays of a bench and connect its ports.

    Parameters
    ----------
    spec : Spec
        The bench, with the faults that act.
    like : Wiring, optional
        Of a bench with the same signals.
    read : list, optional
        Receives for each row which facts of the bench its numbers are made of.
    """
    order = instances(spec)
    if like is not None and [entry.block for entry in order] == [entry.block for entry in like.instances]:
        signals, index, size = like.signals, like.index, len(like.w)
    else:
        signals, index, size = _laid_out(spec, order)
    table = np.zeros((len(order), program.COLUMNS), dtype=np.int64)
    p_parts, s_parts, io_parts = [], [], []
    p_size = s_size = io_size = 0
    for row, instance in enumerate(order):
        if read is not None:
            p, s, facts = numbers(instance, spec)
            read.append(facts)
        else:
            context = spec.context(instance.every, instance.axis)
            p, s = instance.packed(context), instance.block.initial(instance.params, context)
        io = ports_of(spec, instance, index)
        table[row, 1:] = (p_size, s_size, io_size, every_of(instance))
        p_parts.append(p)
        s_parts.append(s)
        io_parts.append(io)
        p_size, s_size, io_size = p_size + len(p), s_size + len(s), io_size + len(io)
    w = np.zeros(size)
    for name, value in Effects.neutral().items():
        w[index[f"effects.{name}"]] = value
    engage(spec, index, w)
    rows = {instance.key: row for row, instance in enumerate(order)}
    s = np.concatenate(s_parts)
    return Wiring(
        instances=order,
        signals=signals,
        index=index,
        table=table,
        p=np.concatenate(p_parts),
        s=s,
        w=w,
        io=np.concatenate(io_parts),
        unread=unread(spec, order),
        absent=[instance.block.rests(instance.params) for instance in order],
        rows=rows,
        tap_rows=np.array([rows[signal.block] for signal in signals.taps], dtype=np.int64),
        endless=~np.isfinite(s),
    )


def every_of(instance: Instance) -> int:
    """Return the ticks between two calls of a step."""
    return 1 if instance.block.every_tick else instance.every


def unread(spec: Spec, order: list[Instance]) -> list[bool]:
    """Return, row by row, whether it is a sensor whose signals are not read."""
    read = needed(spec)
    return [entry.key in spec.sensors and issubclass(entry.block, Sensor) and entry.key not in read for entry in order]


def signals_of(spec: Spec) -> SignalTable:
    """Return the signals of a bench, without its arrays."""
    return _laid_out(spec, instances(spec))[0]


def _laid_out(spec: Spec, order: list[Instance]) -> tuple[SignalTable, dict[str, int], int]:
    """Return the traced signals, the place of every signal, and how many places there are."""
    ports: dict[str, list[tuple[Port, Instance]]] = {"output": [], "tap": [], "hidden": []}
    for instance in order:
        # signals of faults and sensors are worth seeing, but are no outputs of the bench
        aside = issubclass(instance.block, (Fault, Sensor))
        for usual, own in (("output", instance.block.outputs), ("tap", instance.block.taps)):
            for port in own:
                ports["hidden" if port.hidden else "tap" if aside else usual].append((port, instance))
    # traced signals have the order of the trace, so that a row is copied as it is
    index: dict[str, int] = {}
    shown: list[Signal] = []
    size = RESERVED
    for kind, entries in ports.items():
        for port, instance in entries:
            index.setdefault(signal_name(instance, port.name), size)
            for name in (signal_name(instance, name) for name in port.names(instance.params)):
                index[name] = size
                size += 1
                if kind != "hidden":
                    signal = {"name": name, "unit": port.unit, "meaning": port.meaning, "block": instance.key}
                    shown.append(Signal(**signal, kind=kind, index=len(shown)))
    for name in spec.controllers:
        index[f"{name}.engaged"] = size
        size += 1
    index[NOTHING] = size
    return SignalTable(shown), index, size + 1


def engage(spec: Spec, index: dict[str, int], w: FloatArray) -> None:
    """Tell every controller whether it drives in its slot."""
    driving = spec.driving.values()
    for name in spec.controllers:
        w[index[f"{name}.engaged"]] = 1.0 if name in driving else 0.0


def needed(spec: Spec, also: Iterable[str] = ()) -> set[str]:
    """Return the sensor in use, sensors that always run, are read by a diagnoser or are named, and their sources."""
    found: set[str] = set()
    always = [
        name
        for name, unit in spec.sensors.items()
        if issubclass(unit.block, Sensor) and unit.block.runs_always(unit.params)
    ]
    read = [port.source.split(".")[0] for section in spec.diagnosers.values() for port in section.block.inputs]
    waiting = [spec.measuring, *always, *read, *also]
    while waiting:
        name = waiting.pop()
        if name in spec.sensors and name not in found:
            found.add(name)
            waiting += [port.source.split(".")[0] for port in spec.sensors[name].block.inputs]
    return found


def ports_of(spec: Spec, instance: Instance, index: dict[str, int]) -> IntArray:
    """Return the signal indices of an instance's ports: inputs, outputs, taps."""
    inputs = [index[_source(spec, instance, port, index)] for port in instance.block.inputs]
    own = [index[signal_name(instance, port.name)] for port in (*instance.block.outputs, *instance.block.taps)]
    return np.array(inputs + own, dtype=np.int64)


def signal_name(instance: Instance, port: str) -> str:
    """Return the name of a signal; a fault's severity carries the fault's own name."""
    return instance.prefix if issubclass(instance.block, Fault) else f"{instance.prefix}.{port}"


def _source(spec: Spec, instance: Instance, port: Port, index: dict[str, int]) -> str:
    source = port.source
    if "{" in source:
        source = source.replace("{axis}", instance.axis)
        source = source.replace("{diagnoser}", getattr(instance.params, "diagnoser", ""))
    if source.endswith("?"):
        signal = source.removesuffix("?")
        return signal if signal in index else NOTHING
    if source.startswith("^"):
        return f"{instance.prefix.rpartition('.')[0]}.{source[1:]}"
    if not source.startswith("@"):
        found = behind(spec, instance.block.family, source)
        return found if found in index else source or f"{instance.prefix}.{port.name}"
    slot, dot, name = source[1:].partition(".")
    if dot:
        of = {"active": spec.active, "true": "plant"}.get(slot) or spec.driving.get(slot, "")
        signal = f"{of}.{name}"
        return signal if signal in index else NOTHING
    word, _, rest = slot.partition("_")
    if word == "engaged":
        return f"{instance.prefix}.engaged"
    if word == "measuring":
        sensor = f"{spec.measuring}.{instance.axis}" if instance.axis else spec.measuring
        return f"{sensor}.{rest or 'displacement'}"
    if word == "command":
        return command_of(spec, instance.axis, rest)
    if word == "before":
        earlier = spec.axes[: spec.axes.index(instance.axis)]
        return f"guard.{earlier[-1]}.trip" if earlier else NOTHING
    between = f"_{rest}" if rest and feeds_forward(spec.controllers[spec.active].block) else ""
    return f"{spec.active}.voltage{between}"


def command_of(spec: Spec, axis: str, moment: str = "") -> str:
    """Return the signal that drives an axis: from the controller in the last slot that has an output for it."""
    for name in reversed(spec.driving.values()):
        outputs = {port.name for port in spec.controllers[name].block.outputs}
        if axis in outputs:
            return f"{name}.{axis}_{moment}" if moment and f"{axis}_{moment}" in outputs else f"{name}.{axis}"
    return NOTHING
