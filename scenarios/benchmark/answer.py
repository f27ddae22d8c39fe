"""Answer of a diagnoser in a case: evidence that grows with a fault; the probability of each class, if it has these."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from core.block import Block, FloatArray
from core.board.document import Document
from core.board.fold import alike
from core.diagnose.hypothesis import BankParams
from core.errors import InputError
from scenarios.benchmark.figures import classed, surprise
from scenarios.benchmark.track import BenchmarkTrack, Case
from scenarios.run import run

NEUTRAL = {"estimate": 1.0, "loss": 0.0}
"""Outputs of diagnosers without hypotheses that move away from a value when something is wrong."""
WITH_AXES = "is for plants with axes; the devices of this benchmark move along one"
SAYS_NOTHING = "has neither a probability of each hypothesis nor one of the outputs estimate and loss"


def unscored(block: type[Block]) -> str:
    """Say why a diagnoser cannot be scored; "" if it can."""
    if block.axes:
        return WITH_AXES
    return "" if _is_bank(block) or _moved(block) else SAYS_NOTHING


def _is_bank(block: type[Block]) -> bool:
    return issubclass(block.Params, BankParams) and any(port.name == "probability" for port in block.outputs)


def _moved(block: type[Block]) -> str:
    """Return the output that measures the distance from the normal state."""
    return next((port.name for port in block.outputs if port.name in NEUTRAL), "")


def section(block: type[Block], track: BenchmarkTrack) -> Document:
    """Return a diagnoser as it is put on the bench: its own defaults, and the hypotheses of the track if it has any."""
    if not _is_bank(block):
        return {"kind": block.name}
    items = [item.model_dump(exclude_defaults=True) for item in track.hypotheses]
    return {"kind": block.name, "hypotheses": items}


@dataclass(frozen=True)
class CaseProbabilities:
    """The probabilities of one diagnoser in one case, sample by sample.

    Attributes
    ----------
    evidence : ndarray, shape (samples,)
        Minus the logarithm of the probability of the healthy class, or the distance from the output of a healthy
        device.
    classes : ndarray, shape (classes, samples), optional
        Probability of each class.
    digest : str
        SHA-256 over the bits of the outputs behind both.
    """

    evidence: FloatArray
    classes: FloatArray | None
    digest: str


def answers(
    track: BenchmarkTrack, case: Case, diagnosers: Mapping[str, Document], units: Document
) -> dict[str, CaseProbabilities]:
    """Run a case with diagnosers side by side on the same samples; return the answer of each.

    Parameters
    ----------
    track : Track
        Hypotheses and parameters of each diagnoser.
    case : Case
        The case.
    diagnosers : mapping
        The section of each by its name on the bench.
    units : dict
        The user units among them, as a scenario carries them.

    Raises
    ------
    InputError
        When the board stops, which no case of a track may do.
    """
    result = run(case.scenario(diagnosers, units), figures_only=True)
    if result.trip is not None:
        raise InputError(f"stopped in case {case.seed} at sample {result.trip.tick}: {result.trip.reason}")
    return {name: _answer(track, result.trace, name, result.board.diagnosers[name].block) for name in diagnosers}


def said_by(track: BenchmarkTrack, name: str, block: type[Block]) -> list[str]:
    """Return the signals of a diagnoser that its answer and its digest are of."""
    if not _is_bank(block):
        return [f"{name}.{_moved(block)}"]
    return [f"{name}.probability.{item.name}" for item in track.hypotheses]


def _answer(track: BenchmarkTrack, trace: Mapping[str, FloatArray], name: str, block: type[Block]) -> CaseProbabilities:
    if not _is_bank(block):
        output = _moved(block)
        said = np.ascontiguousarray(trace[said_by(track, name, block)[0]])
        return CaseProbabilities(np.abs(said - NEUTRAL[output]), None, _digest(said))
    said = np.ascontiguousarray([trace[signal] for signal in said_by(track, name, block)])
    groups = [*track.classes.values()]
    names = [item.name for item in track.hypotheses]
    places = [next(i for i, group in enumerate(groups) if hypothesis in group) for hypothesis in names]
    p = classed(said, np.array(places, dtype=np.int64), len(groups))
    return CaseProbabilities(surprise(p[0]), p, _digest(said))


def _digest(said: FloatArray) -> str:
    return hashlib.sha256(alike(said.view(np.uint64)).tobytes()).hexdigest()
