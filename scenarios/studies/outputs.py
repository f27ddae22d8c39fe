"""Outputs of a device before and after its faults, laid over each other."""

from __future__ import annotations

import cmath
import math
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from core.block import BlockParams, FloatArray, parameter
from core.board.commands import Inject
from core.errors import InputError
from core.format import format_short
from scenarios.measure.metrics import fundamental
from scenarios.studies.monte_carlo import again
from scenarios.studies.study import Study, StudyPicture

if TYPE_CHECKING:
    from core.board.board import Board


class Outputs(Study):
    """Runs the bench with its events and keeps the last periods of the motion before each event and at the end.

    The stretches are numbered from 1, the one before the first event. ``outputs.amplitude_um.<stretch>`` is the
    amplitude at the tone of the reference; from the second stretch on, ``amplitude_change_pct`` and ``phase_shift_deg``
    compare it with the first, and ``difference_um`` is the amplitude of the difference of the two motions.
    """

    title = "Outputs laid over each other"

    class Params(BlockParams):
        """How long to look."""

        stretch_samples: int = parameter(1000, "samples run after the last event", ge=10, le=1_000_000)
        periods: int = parameter(2, "periods of the reference kept of each stretch", ge=1, le=100)

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return amplitude and phase of each stretch against the first."""
        phasors = [
            fundamental(motion, _tone_hz(board), board.dt_ms, first) for _, first, motion in _stretches(board, params)
        ]
        results: dict[str, float] = {}
        for number, phasor in enumerate(phasors, 1):
            results[f"outputs.amplitude_um.{number}"] = abs(phasor)
            if number > 1:
                ratio = phasor / phasors[0]
                results[f"outputs.amplitude_change_pct.{number}"] = 100.0 * (abs(ratio) - 1.0)
                results[f"outputs.phase_shift_deg.{number}"] = math.degrees(cmath.phase(ratio))
                results[f"outputs.difference_um.{number}"] = abs(phasor - phasors[0])
        return results

    @classmethod
    def picture(cls, board: Board, params: Any) -> StudyPicture:
        """Return the motion of every stretch over the time since the reference was last at its phase of the start."""
        dt = board.dt_ms
        period = 1e3 / _tone_hz(board)
        curves = []
        for name, first, motion in _stretches(board, params):
            since = (first * dt) % period
            curves.append((name, (since + dt * np.arange(len(motion))).tolist(), motion.tolist()))
        return StudyPicture(("time", "ms"), ("displacement", "um"), curves)


def _tone_hz(board: Board) -> float:
    if not board.spec.tone_hz:
        raise InputError("must be a sine for this study", "reference.kind")
    return float(board.spec.tone_hz)


def _stretches(board: Board, params: Any) -> list[tuple[str, int, FloatArray]]:
    """Return the active fault of each stretch, the first tick that is kept of it, and the motion from there on."""
    fresh = again(board, board.spec.seed)
    waiting = [entry for entry in fresh.pending.as_asked if entry.tick]
    edges = sorted({entry.tick for entry in waiting if entry.tick})
    if not edges:
        raise InputError("needs an event after the first sample", "events")
    kept = round(params.periods * 1e3 / (_tone_hz(board) * board.dt_ms))
    edges = [0, *edges, edges[-1] + params.stretch_samples]
    if min(end - start for start, end in pairwise(edges)) < kept:
        raise InputError(f"must leave {kept} samples between two events", "study.periods")
    names = {
        entry.tick: f"{entry.command.fault} {format_short(100.0 * entry.command.severity, '%', 3)}"
        for entry in waiting
        if isinstance(entry.command, Inject)
    }
    column = fresh.signals.index("plant.displacement")
    motion: list[FloatArray] = []
    while fresh.tick < edges[-1]:
        rows = fresh.advance(edges[-1] - fresh.tick)
        if not rows.count:
            raise InputError("the bench tripped before the end of the last stretch", "events")
        motion.append(np.array(rows.outputs[:, column]))
    whole = np.concatenate(motion)
    return [
        (names.get(start, "healthy").replace("_", " "), end - kept, whole[end - kept : end])
        for start, end in pairwise(edges)
    ]
