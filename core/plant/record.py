"""A record of a real device as the plant: it plays the samples that were measured."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np

from core.block import Block, BlockParams, FloatArray, parameter
from core.measured_record import UNLABELLED, PlayedRecord
from core.ports import BlockPorts, output
from core.record import Record, Vector, vector

WINDOW = 512
"""Samples of the record that the state holds: the ticks that a board runs at a stretch."""


def _silent(unit: str, meaning: str) -> float:
    still: float = output(unit, meaning, hidden=True)
    return still


class RecordPlant(Block):
    r"""Plays a measured record: :math:`x_i=y_i`, whatever a controller asks for, and :math:`u_i` from sample i on.

    Nothing can act on a record: controllers run in shadow, faults of the device and other sensors are refused. The
    sensor is ``recorded``. The board trips at the end of the record.
    """

    title = "Record"
    apart = True
    usual_sensor = "recorded"
    takes: ClassVar = {"sense": ("recorded",), "faults": ()}

    class Params(BlockParams):
        """The record."""

        record: str = parameter("", "key of the record, a SHA-256", live=False)
        offset_um: float = parameter(0.0, "displacement that the record shows at rest", "um", ge=-1e6, le=1e6)
        delay_samples: float = parameter(
            0.0, "delay of the displacement behind the voltage, in samples", "samples", ge=0, le=64
        )

    class State(Record):
        """The samples from ``first`` on."""

        first: float
        drive: Vector = vector(WINDOW)
        displacement: Vector = vector(WINDOW)
        label: Vector = vector(WINDOW)

    class Ports(BlockPorts):
        """The record in place of a motion; signals that no record has stay 0."""

        displacement: float = output("um", "recorded displacement")
        drive: float = output("V", "recorded voltage from this sample on", hidden=True)
        missing: float = output("1", "1 where the record lacks a sample", hidden=True)
        label: float = output("1", "index of the label of this sample, -1 for none", hidden=True)
        velocity: float = _silent("um/ms", "not in a record")
        lateral: float = _silent("um", "not in a record")
        contact: float = _silent("1", "not in a record")
        short: float = _silent("1", "not in a record")

    @staticmethod
    def step(p: Record, s: State, x: Ports) -> None:
        """Play one sample."""
        i = int(x.tick - s.first)
        x.drive = s.drive[i]
        x.label = s.label[i]
        y = s.displacement[i]
        if math.isfinite(y):
            x.displacement = y
            x.missing = 0.0
        else:
            x.missing = 1.0


def playable(record: PlayedRecord, tick: int) -> tuple[int, bool]:
    """Return the samples from a tick on, and whether the record has ended."""
    is_growing = record.is_growing  # before its samples: the last of them come before it ends
    left = record.samples - tick
    return left, left <= 0 and not is_growing


def supply(state: FloatArray, params: Any, record: PlayedRecord, tick: int, n: int) -> None:
    """Put the samples of the next ticks into the state, at most ``WINDOW``: without offset, the voltage delayed."""
    s: Any = RecordPlant.State(state)
    end = min(tick + n, record.samples)
    count, s.first = end - tick, tick
    start = max(tick - int(params.delay_samples) - 1, 0)
    drive, displacement, label = record.stretch(start, end)
    s.drive[:count] = delayed(drive, params.delay_samples, tick - start, end - start)
    s.displacement[:count] = displacement[tick - start :]
    if params.offset_um != 0.0:
        s.displacement[:count] -= params.offset_um
    s.label[:count] = UNLABELLED if label is None else label[tick - start :]


def delayed(drive: FloatArray, delay: float, first: int, end: int) -> FloatArray:
    """Return samples of a voltage that comes later; within a sample its mean, before the record its first value."""
    whole = int(delay)
    rest, places = delay - whole, np.arange(first - whole, end - whole)
    found = drive[np.maximum(places, 0)]
    return found if rest == 0.0 else (1.0 - rest) * found + rest * drive[np.maximum(places - 1, 0)]
