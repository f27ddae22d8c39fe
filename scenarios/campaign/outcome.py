"""Outcome of a run: figures, digest, warnings, and the counted verdicts of its diagnosers."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import cast

import numpy as np
from pydantic import BaseModel, computed_field

from core.block import FloatArray, IntArray
from core.board.board import Board
from core.board.commands import Trip
from core.compile.instructions import bits_of
from core.diagnose.hypothesis import ModelList
from core.errors import InputError
from core.kernel import kernel
from core.loop.score import Scores
from core.table import Words
from scenarios.measure.blocks import blocks
from scenarios.run import RunResult, run
from scenarios.schema import Scenario

EVIDENCE = np.linspace(-8.0, 8.0, 161)
"""Thresholds of the evidence of a fault, decimal logarithm of its odds."""
ODDS = 10.0**EVIDENCE
LEAST = 1e-300


class Diagnosis(BaseModel):
    """The results of one diagnoser, sample by sample, counted.

    Attributes
    ----------
    names : list of str
        Hypotheses, in the order of rows (truth) and columns (verdict) of ``confusion``.
    delays : list
        Samples until each change of the truth was found; None for a change that was never found.
    healthy, faulty : list of int
        Samples by evidence of a fault (the bins between `EVIDENCE`, and one at either end), while the truth was healthy
        and while it was faulty; empty if no hypothesis is a healthy device.
    """

    names: list[str]
    confusion: list[list[int]]
    delays: list[int | None]
    healthy: list[int] = []
    faulty: list[int] = []


class RunOutcome(BaseModel):
    """One run, independent of its requests."""

    seed: int
    digest: str = ""
    ticks: int = 0
    elapsed_s: float = 0.0
    ok: bool = False
    stopped: Trip | None = None
    error: Words = ""
    warnings: list[Words] = []
    metrics: dict[str, float] = {}
    diagnosis: dict[str, Diagnosis] = {}

    @computed_field  # type: ignore[prop-decorator]
    @property
    def trip(self) -> str:
        """Why the board stopped, if it did."""
        return self.stopped.reason if self.stopped is not None else ""


def outcome(scenario: Scenario, seed: int, on_tick: Callable[[int], None] | None = None) -> RunOutcome:
    """Run a scenario and count its results; a scenario that cannot be run gives its error."""
    began = time.perf_counter()
    try:
        result = run(scenario, seed, figures_only=True, on_tick=on_tick)
    except InputError as error:
        return RunOutcome(seed=seed, error=str(error))
    found = outcome_of(result)
    found.elapsed_s = time.perf_counter() - began
    return found


def outcome_of(result: RunResult) -> RunOutcome:
    """Return the outcome of a result: the same whether all its outputs were kept or only the outputs of its figures."""
    found = summed(result.scenario, result.board, result.metrics, result.digest, result.trace, result.warnings)
    found.elapsed_s = result.elapsed_s
    return found


def summed(
    scenario: Scenario,
    board: Board,
    metrics: dict[str, float],
    digest: str,
    trace: dict[str, FloatArray],
    warnings: list[str],
) -> RunOutcome:
    """Return the outcome of a run that has come to its end."""
    return RunOutcome(
        seed=board.spec.seed,
        digest=digest,
        ticks=board.tick,
        ok=all(entry.holds(metrics.get(entry.metric)) for entry in scenario.head.expect),
        stopped=board.trip,
        warnings=warnings,
        metrics={name: value for name, value in metrics.items() if math.isfinite(value)},
        diagnosis={name: _diagnosis(board, name, scores, trace) for name, scores in board.scores().items()},
    )


def _diagnosis(board: Board, name: str, scores: Scores, trace: dict[str, FloatArray]) -> Diagnosis:
    counted = Diagnosis.model_construct(names=scores.names, confusion=scores.confusion, delays=scores.delays[1:])
    healthy, none, faults = odds_of(board, name, scores.names)
    if healthy is None or none not in trace or board.tick == 0:
        return counted
    counts = np.zeros((2, len(ODDS) + 1), dtype=np.int64)
    summed = [fault_of(name)] if fault_of(name) in trace else faults
    for truth, no_fault, *probabilities in blocks(*(trace[column] for column in (f"{name}.truth", none, *summed))):
        fault = sum(probabilities[1:], probabilities[0]) if probabilities else np.zeros(len(truth))
        others = np.ascontiguousarray(no_fault), np.ascontiguousarray(truth)
        counts += evidence(np.ascontiguousarray(fault), *others, healthy, ODDS)
    counted.healthy, counted.faulty = counts.tolist()
    return counted


def fault_of(name: str) -> str:
    """Return under which name a trace has the probability that a diagnoser gives to all faults together."""
    return f"{name}.fault"


def odds_of(board: Board, name: str, hypotheses: list[str]) -> tuple[int | None, str, list[str]]:
    """Return which hypothesis of a diagnoser is a healthy device, its probability, and the others."""
    healthy = cast(ModelList, board.diagnosers[name].params).nominal
    columns = [f"{name}.probability.{hypothesis}" for hypothesis in hypotheses]
    return healthy, columns[healthy or 0], [*columns[: healthy or 0], *columns[(healthy or 0) + 1 :]]


def evidence(fault: FloatArray, none: FloatArray, truth: FloatArray, healthy: int, odds: FloatArray) -> IntArray:
    """Count samples by the odds of any fault, those while the truth was healthy and the others.

    Parameters
    ----------
    fault, none : ndarray, shape (samples,)
        Probabilities of any fault and of none.
    truth : ndarray, shape (samples,)
    healthy : int
        The hypothesis of a healthy device.
    odds : ndarray, shape (thresholds,)
        Where one bin ends and the next begins, by equal factors. Odds that are not a number, as before any verdict,
        count as even.

    Returns
    -------
    ndarray of int64, shape (2, thresholds + 1)
    """
    counts = np.zeros((2, len(odds) + 1), dtype=np.int64)
    _count(fault, none, truth, healthy, np.concatenate(([math.nan], odds, [math.nan])), counts)
    return counts


@kernel
def _count(
    fault: FloatArray, none: FloatArray, truth: FloatArray, healthy: int, odds: FloatArray, counts: IntArray
) -> None:
    last = len(odds) - 2
    # the bits of a number are nearly proportional to its logarithm: the bin from them is the right one or next to it
    first, share = bits_of(odds[1]), (last - 1) / (bits_of(odds[last]) - bits_of(odds[1]))
    for i in range(len(fault)):
        over = LEAST if fault[i] < LEAST else fault[i]
        under = LEAST if none[i] < LEAST else none[i]
        ratio = over / under
        ratio = ratio if ratio > 0.0 else 1.0
        found = min(max(int((bits_of(ratio) - first) * share) + 1, 0), last)
        found += (1 if ratio >= odds[found + 1] else 0) - (1 if ratio < odds[found] else 0)
        counts[0 if truth[i] == healthy else 1, found] += 1
