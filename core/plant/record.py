"""A record of a real device as the plant: it plays the samples that were measured."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from core.block import Block, BlockParams, FloatArray, parameter
from core.measured_record import UNLABELLED, PlayedRecord
from core.ports import BlockPorts, output
from core.record import Record, Vector, vector

TAPS = 4
"""Samples from which a voltage between samples is worked out."""
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
        missing: Vector = vector(WINDOW)
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
        x.missing = s.missing[i]
        if x.missing == 0.0:
            x.displacement = s.displacement[i]


def playable(record: PlayedRecord, tick: int, n: int) -> tuple[int, bool]:
    """Return how many of some ticks a record can play now, and whether it ended before the first of them."""
    is_growing = record.is_growing  # read before the samples: the last samples come before the end
    left = record.samples - tick
    return min(n, left), left <= 0 < n and not is_growing


def supply(state: FloatArray, params: Any, record: PlayedRecord, tick: int, n: int) -> None:
    """Put the samples of the next ticks into the state, at most ``WINDOW``: without offset, the voltage delayed."""
    s: Any = RecordPlant.State(state)
    end = min(tick + n, record.samples)
    count, s.first = end - tick, tick
    start = max(tick - int(params.delay_samples) - TAPS, 0)
    drive, displacement, label = record.stretch(start, end)
    s.drive[:count] = delayed(drive, params.delay_samples, tick - start, end - start)
    found = displacement[tick - start :]
    lost = ~np.isfinite(found)
    s.missing[:count] = lost
    s.displacement[:count] = np.where(lost, 0.0, found)  # a board whose state is not finite stops
    if params.offset_um != 0.0:
        s.displacement[:count] -= params.offset_um
    s.label[:count] = UNLABELLED if label is None else label[tick - start :]


def delayed(drive: FloatArray, delay: float, first: int, end: int) -> FloatArray:
    r"""Return samples of a voltage that comes later by a number of samples that need not be whole.

    The voltage is held between samples. A linear device moves under the late voltage as it moves under

    .. math:: \sum_i c_i u_{k-i},\qquad c_i=\prod_{j\ne i}\frac{\tau-j}{i-j},

    up to the fourth power of its frequency over the rate of samples (Laakso et al. 1996): the delays of both have the
    same moments. Before the record the voltage has its first value.
    """
    if delay == int(delay):
        return drive[np.maximum(np.arange(first, end) - int(delay), 0)]
    taps = np.arange(TAPS) + max(int(delay) - (TAPS // 2 - 1), 0)
    found = np.zeros(end - first)
    for tap in taps:
        others = taps[taps != tap]
        weight = float(np.prod((delay - others) / (tap - others)))
        found += weight * drive[np.maximum(np.arange(first, end) - tap, 0)]
    return found
