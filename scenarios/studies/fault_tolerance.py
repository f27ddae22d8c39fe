"""Law by fault by severity: the errors of a supervised loop, a fixed PID and an MRAC over the error of a fixed law."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from core.block import BlockParams, FloatArray, parameter
from core.board.commands import Inject
from core.board.document import SUPERVISOR, Document, with_values
from core.errors import InputError
from scenarios.measure.errors import rms
from scenarios.studies.study import Study, StudyPicture

if TYPE_CHECKING:
    from core.board.board import Board

SHARES = (0.25, 0.5, 0.75, 1.0)
"""Severities, over the largest of each fault."""
CASES = {
    "added_mass": ("added_mass", 0.1),
    "stiffness": ("stiffness", 0.1),
    "damping": ("damping", 0.3),
    "softening": ("stiffness", -0.1),
    "drive_gain": ("drive_gain", -0.1),
}
"""Faults and their largest severities; the last two are outside the hypotheses of 5.2.4."""


class FaultTolerance(Study):
    """Injects each of five faults at four severities, once for each law, and measures the tracking error after it.

    ``tolerance.<law>.<fault>.<severity>`` is the rms error in the second half of the time after the fault, over the
    error of the bench's own law without its supervisor; the severity is a percentage of the largest. The error is
    against the true motion, so it has the part that noise causes through the law.
    """

    title = "Fault tolerance of laws"

    class Params(BlockParams):
        """Length and number of runs, and the PID."""

        samples: int = parameter(2400, "length of a run; the fault comes after a quarter", ge=100, le=1_000_000)
        runs: int = parameter(1, "seeds of each case, starting at the seed of the bench", ge=1, le=1000)
        pole: float = parameter(1.3, "pole of the PID over w0", gt=0.6, le=5)
        feedforward: float = parameter(1.0, "feed-forward of the PID", ge=0, le=1)

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return the ratios of errors."""
        return {
            f"tolerance.{law}.{case}.{round(100 * share)}": ratio
            for case, share, laws in _ratios(board, params)
            for law, ratio in laws.items()
        }

    @classmethod
    def picture(cls, board: Board, params: Any) -> StudyPicture:
        """Return the ratio of each law, in the mean over the faults, over the severity."""
        found: dict[str, dict[float, list[float]]] = {}
        for _, share, laws in _ratios(board, params):
            for law, ratio in laws.items():
                found.setdefault(law, {}).setdefault(100 * share, []).append(ratio)
        curves = [(law, [*at], [float(np.mean(one)) for one in at.values()]) for law, at in found.items()]
        return StudyPicture(("severity over the largest", "%"), ("error over the fixed law's error", ""), curves)


def _ratios(board: Board, params: Any) -> Iterator[tuple[str, float, dict[str, float]]]:
    """Yield each fault and severity with the ratio of each law."""
    if SUPERVISOR not in board.base:
        raise InputError("compares a supervised loop with others, and this bench has no supervisor", SUPERVISOR)
    bare = {key: value for key, value in board.base.items() if key != SUPERVISOR}
    pid = {"kind": "pid", "pole": params.pole, "feedforward": params.feedforward}
    others = {"supervised": board.base, "pid": _law(bare, pid), "mrac": _law(bare, {"kind": "mrac"})}
    for case, (fault, largest) in CASES.items():
        for share in SHARES:
            severity = round(largest * share, 10)
            usual = _error(board, bare, fault, severity, params)
            yield case, share, {law: _error(board, one, fault, severity, params) / usual for law, one in others.items()}


def _law(document: Document, table: Document) -> Document:
    return with_values({key: value for key, value in document.items() if key != "diagnosers"}, {"controller": table})


def _error(board: Board, document: Document, fault: str, severity: float, params: Any) -> float:
    """Return the rms error of all runs in the second half of the time after the fault; no number after a trip."""
    errors: list[FloatArray] = []
    begins = params.samples // 4
    for run in range(params.runs):
        one = type(board)({**document, "seed": board.spec.seed + run})
        one.apply(Inject(fault=fault, severity=severity, at_sample=begins))
        place, wanted = (one.signals.index(name) for name in ("plant.displacement", "model.displacement"))
        while one.tick < params.samples and (rows := one.advance(params.samples - one.tick)).count:
            late = max(0, (begins + params.samples) // 2 - rows.first_tick)
            errors.append(rows.outputs[late:, place] - rows.outputs[late:, wanted])
        if one.trip is not None:
            return float("nan")
    return rms(np.concatenate(errors))
