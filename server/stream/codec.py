"""The binary frame: columns of minima and maxima, little-endian, 8-byte aligned."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

WIRE = 2
HEADER = struct.Struct("<BBHIddd")
PANEL = struct.Struct("<HHIddddII")

RUNNING = 1
TRIGGERED, WAITING, FROZEN = 1, 2, 4


@dataclass(frozen=True)
class Picture:
    """The content of a panel.

    Parameters
    ----------
    start, end : float
        Ticks the columns cover; column ``c`` covers ``start + (end - start) * c / columns`` onward.
    trigger : float
        Tick of the trigger, between ticks where the level was crossed; NaN without one.
    flags : int
        ``TRIGGERED``, ``WAITING``, ``FROZEN``.
    columns : ndarray
        float32 ``(n_signals, 2, columns)``: minimum and maximum, NaN where there is no data.
    latest : ndarray
        float32 ``(n_signals,)``: the newest value of each signal.
    """

    start: float
    end: float
    trigger: float
    flags: int
    columns: NDArray[np.float32]
    latest: NDArray[np.float32]

    @cached_property
    def body(self) -> bytes:
        """The samples as they are sent, made once for all pages that show this picture."""
        odd = b"\0\0\0\0" if len(self.latest) % 2 else b""
        return self.columns.tobytes() + self.latest.tobytes() + odd


@dataclass(frozen=True)
class PanelFrame(Picture):
    """The picture of one panel of a page.

    Parameters
    ----------
    panel : int
        The page's number for it.
    revision : int
        How many times the page has subscribed this panel.
    """

    panel: int
    revision: int


@dataclass(frozen=True)
class Moment:
    """The moment a frame shows.

    Parameters
    ----------
    head : int
        First tick not computed yet.
    dt_ms : float
        Device time of one tick.
    cut_s : float
        Time of the cut, on the server's monotonic clock.
    """

    head: int
    dt_ms: float
    cut_s: float


def encode(frame: int, running: bool, moment: Moment, panels: Sequence[tuple[int, int, Picture]]) -> list[bytes]:
    """Encode one frame, in parts to be sent one behind the other.

    Parameters
    ----------
    frame : int
        Its number on this connection.
    running : bool
        Whether time runs.
    moment : Moment
        The moment it shows.
    panels : sequence of (int, int, Picture)
        Number of the panel, revision of its subscription, its picture.
    """
    flags = RUNNING if running else 0
    parts = [HEADER.pack(WIRE, flags, len(panels), frame, moment.head, moment.dt_ms, moment.cut_s)]
    for panel, revision, picture in panels:
        signals, _, columns = picture.columns.shape
        head = (panel, signals, columns, picture.start, picture.end, picture.trigger, revision, picture.flags, 0)
        parts += (PANEL.pack(*head), picture.body)
    return parts


@dataclass(frozen=True)
class Frame:
    """A decoded frame."""

    frame: int
    running: bool
    head: int
    dt_ms: float
    cut_s: float
    panels: list[PanelFrame]


def decode(data: bytes) -> Frame:
    """Decode one frame: the reference for other clients; tests and tools use it.

    Raises
    ------
    ValueError
        If the bytes are not a frame of this version.
    """
    if len(data) < HEADER.size:
        raise ValueError("shorter than a frame header")
    wire, flags, count, frame, head, dt_ms, cut_s = HEADER.unpack_from(data)
    if wire != WIRE:
        raise ValueError(f"wire version {wire}, this is {WIRE}")
    at, panels = HEADER.size, []
    for _ in range(count):
        panel, signals, columns, start, end, trigger, revision, marks, _ = PANEL.unpack_from(data, at)
        at += PANEL.size
        size = signals * 2 * columns
        cut = np.frombuffer(data, "<f4", size, at).reshape(signals, 2, columns)
        at += 4 * size
        latest = np.frombuffer(data, "<f4", signals, at)
        at += 4 * (signals + signals % 2)
        panels.append(PanelFrame(start, end, trigger, marks, cut, latest, panel, int(revision)))
    if at != len(data):
        raise ValueError(f"{len(data) - at} bytes left over")
    return Frame(frame, bool(flags & RUNNING), int(head), dt_ms, cut_s, panels)
