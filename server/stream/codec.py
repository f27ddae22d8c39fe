"""The binary frame: columns of minima and maxima, little-endian, 8-byte aligned."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

WIRE = 1
HEADER = struct.Struct("<BBHIdd")
PANEL = struct.Struct("<HHIddddII")

RUNNING = 1
TRIGGERED, WAITING, FROZEN = 1, 2, 4


@dataclass(frozen=True)
class PanelFrame:
    """One panel of a frame.

    Parameters
    ----------
    panel : int
        The client's number for it.
    start, end : float
        Ticks the columns cover; column ``c`` covers ``start + (end - start) * c / columns`` onward.
    trigger : float
        Tick of the trigger, between ticks where the level was crossed; NaN without one.
    revision : int
        How many times the client has subscribed this panel.
    flags : int
        ``TRIGGERED``, ``WAITING``, ``FROZEN``.
    columns : ndarray
        float32 ``(n_signals, 2, columns)``: minimum and maximum, NaN where there is no data.
    latest : ndarray
        float32 ``(n_signals,)``: the newest value of each signal.
    """

    panel: int
    start: float
    end: float
    trigger: float
    revision: int
    flags: int
    columns: NDArray[np.float32]
    latest: NDArray[np.float32]


def encode(frame: int, running: bool, head: int, dt_ms: float, panels: Sequence[PanelFrame]) -> bytes:
    """Encode one frame."""
    parts = [HEADER.pack(WIRE, RUNNING if running else 0, len(panels), frame, head, dt_ms)]
    for panel in panels:
        signals, _, columns = panel.columns.shape
        parts.append(
            PANEL.pack(
                panel.panel,
                signals,
                columns,
                panel.start,
                panel.end,
                panel.trigger,
                panel.revision,
                panel.flags,
                0,
            )
        )
        parts.append(panel.columns.tobytes())
        parts.append(panel.latest.tobytes())
        if signals % 2:
            parts.append(b"\0\0\0\0")
    return b"".join(parts)


@dataclass(frozen=True)
class Frame:
    """A decoded frame."""

    frame: int
    running: bool
    head: int
    dt_ms: float
    panels: list[PanelFrame]


def decode(data: bytes) -> Frame:
    """Decode one frame: the reference for other clients, and what tests and tools read with.

    Raises
    ------
    ValueError
        If the bytes are not a frame of this version.
    """
    if len(data) < HEADER.size:
        raise ValueError("shorter than a frame header")
    wire, flags, count, frame, head, dt_ms = HEADER.unpack_from(data)
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
        panels.append(PanelFrame(panel, start, end, trigger, int(revision), marks, cut, latest))
    if at != len(data):
        raise ValueError(f"{len(data) - at} bytes left over")
    return Frame(frame, bool(flags & RUNNING), int(head), dt_ms, panels)
