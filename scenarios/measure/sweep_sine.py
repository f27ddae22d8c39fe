"""Identifies the device on a board by a stepped sine."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from core.block import FloatArray
from core.board.board import Board
from core.board.commands import SetValues
from core.device.device import Device
from core.device.frequency import figures
from core.device.identification import Identified, SweepTone, identify, tone
from core.errors import InputError

WIDE = (0.25, 2.0)
"""Range of the first pass, in natural frequencies of the nominal device."""
NEAR = 1.5
"""Range of the second pass about the resonance found, in shares of its width."""


@dataclass(frozen=True)
class SineSweep:
    """The measured response, by rising frequency, and the device identified from it."""

    tones: list[SweepTone]
    found: Identified


class _Tripped(Exception):
    """The board has stopped itself; the words are its reason."""


def sweep_sine(
    board: Board,
    *,
    amplitude_v: float = 2.0,
    points: int = 31,
    cycles: float = 40.0,
    settle: float = 12.0,
    start_hz: float | None = None,
    stop_hz: float | None = None,
    most_ticks: int | None = None,
    believed: Device | None = None,
) -> SineSweep:
    """Identify the device of a board in its present state, on a copy; the board itself does not change.

    A first pass of sines spans the range, a second one spans the resonance found. At each tone the sweep waits for the
    transient, then fits that tone to voltage and measured displacement.

    Parameters
    ----------
    board : Board
        The board, its faults and its environment included; commands that wait are left out.
    amplitude_v : float
        Amplitude of the sine.
    points : int
        Tones of each pass.
    cycles : float
        Cycles measured at each tone.
    settle : float
        Time constants waited before.
    start_hz, stop_hz : float, optional
        Range of the first pass instead of 0.25 to 2 natural frequencies.
    most_ticks : int, optional
        Refuse a pass that would take more ticks than this.
    believed : Device, optional
        The device as people know it, where faults are hidden: range, length and force per volt then follow from it
        alone, and a trip keeps its reason.

    Raises
    ------
    InputError
        When the plant has axes or is a record, the board trips, the measurement does not look like a resonator, or the
        sweep would take too long.
    """
    if board.spec.axes:
        moves = f"{board.spec.plant.block.name} moves along {', '.join(board.spec.axes)}"
        raise InputError(f"a swept sine is for one displacement; {moves}", "plant.model")
    if board.spec.record is not None:
        raise InputError("a record cannot be driven by a sine", "plant.model", "calibrate it to find its device")
    copy = Board.restore(board.checkpoint())
    copy.pending.clear()
    device = believed or copy.spec.device
    nominal = figures(**device.resolved)
    if device.signed_force_n_per_v == 0.0:
        raise InputError(
            "the stators pull alike, so that nothing moves", "device.bias_v", "give them different voltages"
        )
    if believed is None:
        decay_ms = nominal["decay_ms"] * copy.value("effects.mass_scale") / copy.value("effects.damping_scale")
    else:
        decay_ms = nominal["decay_ms"] / copy.spec.surroundings[1]
    start = start_hz if start_hz is not None else WIDE[0] * nominal["f0_hz"]
    stop = stop_hz if stop_hz is not None else WIDE[1] * nominal["f0_hz"]
    if not start < stop:
        raise InputError("must be below stop_hz", "study.start_hz")
    if stop > 400.0 * copy.spec.frame.sample_rate_khz:
        raise InputError("too close to half the sample rate", "study.stop_hz")
    held = not copy.spec.is_analogue

    def measure(frequencies: FloatArray) -> list[SweepTone]:
        with np.errstate(over="ignore"):  # endless periods are refused as too long
            periods = float(np.sum(1e3 / frequencies))
        ticks = (len(frequencies) * settle * decay_ms + cycles * periods) / copy.dt_ms
        if most_ticks is not None and ticks > most_ticks:
            hint = "fewer points or cycles, less settling, or a device that rings for a shorter time"
            raise InputError(f"would take {ticks:.3g} ticks, at most {most_ticks:.3g}", "study", hint)
        try:
            return [_measure(copy, f, amplitude_v, cycles, settle * decay_ms, held) for f in frequencies.tolist()]
        except _Tripped as trip:
            reason = f": {trip}" if believed is None else ""
            raise InputError(f"the board tripped{reason}", "study.amplitude_v", "lower the amplitude") from None

    tones = measure(np.geomspace(start, stop, points))
    first = identify(tones, device.signed_force_n_per_v)
    reach = NEAR * first.f0_hz / first.quality_factor
    low, high = max(start, first.f0_hz - reach), min(stop, first.f0_hz + reach)
    if low < high:
        known = {entry.frequency_hz for entry in tones}
        tones += measure(np.array([f for f in np.linspace(low, high, points) if f not in known]))
    tones.sort(key=lambda entry: entry.frequency_hz)
    return SineSweep(tones, identify(tones, device.signed_force_n_per_v))


def _measure(board: Board, hertz: float, amplitude_v: float, cycles: float, settle_ms: float, held: bool) -> SweepTone:
    """Play one tone and fit it."""
    sine = {"kind": "sine", "amplitude_v": amplitude_v, "frequency_hz": hertz}
    board.apply(SetValues(set={"controller.kind": "open_loop", "reference": sine}), "sweep")
    _record(board, math.ceil(settle_ms / board.dt_ms))
    # whole cycles, and from a moment at which the phase does not matter
    voltage, displacement = _record(board, max(16, round(cycles * 1e3 / hertz / board.dt_ms)))
    return tone(hertz, board.dt_ms, voltage, displacement, held=held)


def _record(board: Board, ticks: int) -> tuple[FloatArray, FloatArray]:
    """Advance and return voltage and measured displacement."""
    columns = [board.signals.index(name) for name in ("drive.voltage", "sensor.displacement")]
    record = np.empty((ticks, 2))
    done = 0
    while done < ticks:
        rows = board.advance(ticks - done)
        if board.trip is not None:
            raise _Tripped(board.trip.reason)
        record[done : done + rows.count] = rows.outputs[:, columns]
        done += rows.count
    return record[:, 0], record[:, 1]
