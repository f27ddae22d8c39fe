"""Law by fault by severity: the errors of a supervised loop, a fixed PID and an MRAC over the error of a fixed law."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from core.block import BlockParams, FloatArray, parameter
from core.board.commands import Inject
from core.board.document import SUPERVISOR, Document, with_values
from core.board.parse import parse
from core.board.spec import Spec
from core.errors import InputError
from scenarios.measure.errors import rms
from scenarios.studies.laws import label
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
AS_WELL = 1.1
"""A law does as well as another where its error is at most this many times as large."""


class FaultTolerance(Study):
    """Injects each of five faults at four severities, once for each law, and measures the tracking error after it.

    ``tolerance.<law>.<fault>.<severity>`` is the rms error in the second half of the time after the fault, over the
    error of the bench's own law without its supervisor; the severity is a percentage of the largest. The error is
    against the true motion, so it has the part that noise causes through the law.

    With several noises the names of the figures end in the noise in nm, and ``tolerance.<law>.as_well.<noise>`` counts
    the cases of 20 in which a law does as well as the supervised one: its error is at most 1.1 times as large.
    """

    title = "Fault tolerance of laws"

    class Params(BlockParams):
        """Length and number of runs, and the PID."""

        samples: int = parameter(2400, "length of a run; the fault comes after a quarter", ge=100, le=1_000_000)
        runs: int = parameter(1, "seeds of each case, starting at the seed of the bench", ge=1, le=1000)
        pole: float = parameter(1.3, "pole of the PID over w0", gt=0.6, le=5)
        feedforward: float = parameter(1.0, "feed-forward of the PID", ge=0, le=1)
        noises_um: list[float] = parameter([], "noises of the sensor; its own if there are none", "um")

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return the ratios of errors."""
        found: dict[str, float] = {}
        for noise, base in _benches(board, params):
            end = f".{noise}" if noise else ""
            cases = [*_ratios(board, base, params)]
            for case, share, laws in cases:
                for law, ratio in laws.items():
                    found[f"tolerance.{law}.{case}.{round(100 * share)}{end}"] = ratio
            for law in ("pid", "mrac") if noise else ():
                as_well = sum(laws[law] <= AS_WELL * laws["supervised"] for _, _, laws in cases)
                found[f"tolerance.{law}.as_well{end}"] = float(as_well)
        return found

    @classmethod
    def picture(cls, board: Board, params: Any) -> StudyPicture:
        """Return the ratio of each law, in the mean over the faults, over the severity."""
        found: dict[str, dict[float, list[float]]] = {}
        for noise, base in _benches(board, params):
            for _, share, laws in _ratios(board, base, params):
                for law, ratio in laws.items():
                    name = f"{law}, {noise} nm" if noise else law
                    found.setdefault(name, {}).setdefault(100 * share, []).append(ratio)
        curves = [(law, [*at], [float(np.mean(one)) for one in at.values()]) for law, at in found.items()]
        return StudyPicture(("severity over the largest", "%"), ("error over the fixed law's error", ""), curves)


def _benches(board: Board, params: Any) -> Iterator[tuple[str, Document]]:
    """Yield the bench at each noise, with the noise in nm as names of figures have it; without noises the bench."""
    if SUPERVISOR not in board.base:
        raise InputError("compares a supervised loop with others, and this bench has no supervisor", SUPERVISOR)
    if not params.noises_um:
        yield "", board.base
    for noise in params.noises_um:
        yield label(1e3 * noise), with_values(board.base, {"sensor.noise_um": noise})


def _ratios(board: Board, base: Document, params: Any) -> Iterator[tuple[str, float, dict[str, float]]]:
    """Yield each fault and severity with the ratio of each law."""
    bare = {key: value for key, value in base.items() if key != SUPERVISOR}
    pid = {"kind": "pid", "pole": params.pole, "feedforward": params.feedforward}
    others = {"supervised": base, "pid": _law(bare, pid), "mrac": _law(bare, {"kind": "mrac"})}
    fixed, loops = parse(bare), {law: parse(document) for law, document in others.items()}
    for case, (fault, largest) in CASES.items():
        for share in SHARES:
            severity = round(largest * share, 10)
            usual = _error(board, fixed, fault, severity, params)
            yield case, share, {law: _error(board, one, fault, severity, params) / usual for law, one in loops.items()}


def _law(document: Document, table: Document) -> Document:
    return with_values({key: value for key, value in document.items() if key != "diagnosers"}, {"controller": table})


def _error(board: Board, spec: Spec, fault: str, severity: float, params: Any) -> float:
    """Return the rms error of all runs in the second half of the time after the fault; no number after a trip.

    Boards of the same spec share their wiring, and a case takes longer to wire a board than to run it.
    """
    errors: list[FloatArray] = []
    begins = params.samples // 4
    for run in range(params.runs):
        one = type(board)(spec.with_seed(board.spec.seed + run))
        one.apply(Inject(fault=fault, severity=severity, at_sample=begins))
        place, wanted = (one.signals.index(name) for name in ("plant.displacement", "model.displacement"))
        while one.tick < params.samples and (rows := one.advance(params.samples - one.tick)).count:
            late = max(0, (begins + params.samples) // 2 - rows.first_tick)
            errors.append(rows.outputs[late:, place] - rows.outputs[late:, wanted])
        if one.trip is not None:
            return float("nan")
    return rms(np.concatenate(errors))
