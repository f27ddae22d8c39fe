"""The signals behind the ports of a block, which its step reads and writes by name, as ``x``.

A block declares each port once, in a class: ``measured: float = reads("sensor.displacement", "um", "measured
displacement")``. The step reads and writes ``x.measured``.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from inspect import get_annotations
from typing import Any, ClassVar, Protocol

from core.record import Record, Records, record_of

KINDS = INPUT, OUTPUT, TAP = "input", "output", "tap"
"""Kinds of ports, in the order of their places."""
TICK, TIME_MS, RESERVED = 0, 1, 2
"""Places of the signals every step may read without a port: the tick, and device time in ms."""


class Lists(Protocol):
    """Parameters with lists."""

    def __getattribute__(self, name: str) -> Any:
        """Return a parameter."""


@dataclass(frozen=True)
class Port:
    """One signal (or a vector of them) a block reads or writes.

    Parameters
    ----------
    name : str
        Port name; the signal is called ``<instance>.<name>``.
    unit, meaning : str
        Shown to people.
    source : str
        For inputs: the signal it is wired to by default. A signal that ends in ``?`` may be missing and reads 0 then;
        a source that begins with ``^`` is a signal of the block whose name comes before the last dot of this block's
        prefix.
    labels : tuple of str
        For vectors: one name per component.
    each : str
        For vectors: the list parameter whose elements' names are the labels.
    hidden : bool
        Plumbing: neither traced nor offered to scopes.
    warning : str
        For a tap: the text of the log when it rises from 0.
    kind : str
        Input, output or tap.
    vector : bool
        Whether the step sees several numbers.
    record : type, optional
        For vectors: the record that the numbers are several of, if they are.
    """

    name: str
    unit: str = "1"
    meaning: str = ""
    source: str = ""
    labels: tuple[str, ...] = ()
    each: str = ""
    hidden: bool = False
    warning: str = ""
    kind: str = INPUT
    vector: bool = False
    record: type[Record] | None = None

    def names(self, params: Lists) -> tuple[str, ...]:
        """Return the component names below the instance, one for a scalar."""
        labels = self.labels
        if self.each:
            labels = tuple(str(item.name) for item in getattr(params, self.each))
        return tuple(f"{self.name}.{label}" for label in labels) if labels else (self.name,)


def reads(source: str, unit: str = "1", meaning: str = "") -> Any:
    """Declare an input and the signal it is wired to."""
    return Port("", unit, meaning, source, kind=INPUT)


def output(
    unit: str = "1", meaning: str = "", *, labels: tuple[str, ...] = (), each: str = "", hidden: bool = False
) -> Any:
    """Declare an output, one signal or a vector with a label for each component."""
    return Port("", unit, meaning, labels=labels, each=each, hidden=hidden, kind=OUTPUT)


def tap(
    unit: str = "1",
    meaning: str = "",
    *,
    labels: tuple[str, ...] = (),
    each: str = "",
    hidden: bool = False,
    warning: str = "",
) -> Any:
    """Declare a tap: an inner signal, worth a look and no part of the digest."""
    return Port("", unit, meaning, labels=labels, each=each, hidden=hidden, warning=warning, kind=TAP)


class _Signal:
    """Reads and writes the signal behind a port."""

    def __init__(self, place: int) -> None:
        self._place = place

    def __get__(self, ports: Any, owner: Any) -> Any:
        return ports.signals[int(ports.places[self._place])]

    def __set__(self, ports: Any, value: Any) -> None:
        ports.signals[int(ports.places[self._place])] = value


class _Signals:
    """Finds the signals behind a vector port."""

    def __init__(self, place: int) -> None:
        self._place = place

    def __get__(self, ports: Any, owner: Any) -> Any:
        return ports.signals[int(ports.places[self._place]) :]


class _Several:
    """Finds the records behind a port."""

    def __init__(self, place: int, kind: type[Record]) -> None:
        self._place, self._kind = place, kind

    def __get__(self, ports: Any, owner: Any) -> Any:
        return Records(ports.signals[int(ports.places[self._place]) :], self._kind)


class _Reserved:
    """Reads a signal that has no port."""

    def __init__(self, place: int) -> None:
        self._place = place

    def __get__(self, ports: Any, owner: Any) -> float:
        return ports.signals[self._place]  # type: ignore[no-any-return]


class BlockPorts:
    """Ports of a block; a subclass annotates them, ``float``, ``Vector`` or ``Records``, and describes each.

    An instance is a view: of all signals, and of the places of its own among them. Every step may also read ``x.tick``,
    and ``x.time_ms``, which is device time.
    """

    tick = _Reserved(TICK)
    time_ms = _Reserved(TIME_MS)

    declared: ClassVar[tuple[Port, ...]] = ()
    """All ports in the order of their places: inputs, outputs, taps."""

    def __init__(self, signals: Any, places: Any) -> None:
        self.signals, self.places = signals, places

    def __init_subclass__(cls) -> None:
        """Give every port its place: ports of the bases first, then its own, a port declared anew at its old place."""
        ports = {port.name: port for base in cls.__bases__ for port in getattr(base, "declared", ())}
        for name, hint in get_annotations(cls, eval_str=True).items():
            port = cls.__dict__.get(name)
            if not isinstance(port, Port):
                raise TypeError(f"{cls.__qualname__}.{name}: declare reads(...), output(...) or tap(...)")
            vector, record = hint is not float, record_of(hint)
            ports[name] = replace(port, name=name, vector=vector, record=record)
        cls.declared = tuple(sorted(ports.values(), key=lambda port: KINDS.index(port.kind)))
        for place, port in enumerate(cls.declared):
            if port.record is not None:
                setattr(cls, port.name, _Several(place, port.record))
            else:
                setattr(cls, port.name, _Signals(place) if port.vector else _Signal(place))
