"""Means over many seeds, and the confusion of one hypothesis with another."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from core.block import BlockParams, parameter
from core.errors import InputError, unknown
from core.loop.score import Scores
from scenarios.studies.study import Study

if TYPE_CHECKING:
    from core.board.board import Board


class MonteCarlo(Study):
    """Runs the bench with its events once for each seed and scores every diagnoser.

    ``diagnosis.<id>.*`` are means over the runs, a step that was never found counting with its whole length;
    ``.correct_fraction_std`` is the spread from run to run, ``.confusion.<truth>.<verdict>`` the share of the samples
    of a truth, all runs together. ``compare.*`` are the means of the first of two diagnosers over the means of the
    second.
    """

    title = "Monte Carlo"

    class Params(BlockParams):
        """The number of runs and their length."""

        runs: int = parameter(40, "seeds, starting at the seed of the bench", ge=1, le=10_000)
        samples: int = parameter(9000, "length of a run", ge=1, le=10_000_000)
        compare: list[str] = parameter([], "two diagnosers whose means are divided")

    @classmethod
    def figures(cls, board: Board, params: Any) -> dict[str, float]:
        """Return means, spreads and confusion."""
        for name in params.compare:
            if name not in board.spec.diagnosers:
                raise unknown("diagnoser", name, board.spec.diagnosers, "study.compare")
        if len(params.compare) not in (0, 2):
            raise InputError("must name two diagnosers, or none", "study.compare")
        runs = [_run(board, board.spec.seed + i, params.samples) for i in range(params.runs)]
        figures: dict[str, float] = {}
        for name in runs[0]:
            figures |= _means(f"diagnosis.{name}", [run[name] for run in runs])
        if params.compare:
            first, second = (f"diagnosis.{name}." for name in params.compare)
            for key in [key.removeprefix(first) for key in figures if key.startswith(first) and "confusion" not in key]:
                if figures.get(second + key):
                    figures[f"compare.{key}"] = figures[first + key] / figures[second + key]
        return figures


def again(board: Board, seed: int) -> Board:
    """Return the same bench under another seed, at its first tick, the same events waiting."""
    fresh = type(board)({**board.base, "seed": seed})
    for entry in board.pending.as_asked:
        fresh.apply(entry.command, entry.actor)
    return fresh


def _run(board: Board, seed: int, samples: int) -> dict[str, tuple[Scores, list[float]]]:
    fresh = again(board, seed)
    while fresh.tick < samples and fresh.advance(samples - fresh.tick).count:
        pass
    changes = {
        name: [entry.tick for entry in fresh.log if entry.kind == "truth_changed" and entry.text.startswith(f"{name}:")]
        for name in fresh.spec.diagnosers
    }
    return {name: (scores, _delays(scores, [*changes[name], fresh.tick])) for name, scores in fresh.scores().items()}


def _delays(scores: Scores, edges: list[int]) -> list[float]:
    return [
        float(edges[i + 1] - edges[i] if delay is None else delay)
        for i, delay in enumerate(scores.delays)
        if i + 1 < len(edges)
    ]


def _means(prefix: str, runs: list[tuple[Scores, list[float]]]) -> dict[str, float]:
    scores = [entry for entry, _ in runs]
    delays = np.array([delay for _, delay in runs])
    correct = [entry.correct_fraction for entry in scores]
    missed = [sum(delay is None for delay in entry.delays) for entry in scores]
    figures = {
        f"{prefix}.correct_fraction": float(np.mean(correct)),
        f"{prefix}.correct_fraction_std": float(np.std(correct)),
        f"{prefix}.false_switches": float(np.mean([entry.false_switches for entry in scores])),
        f"{prefix}.missed_steps": float(np.mean(missed)),
    }
    if delays.shape[1] > 1:
        figures[f"{prefix}.mean_delay_samples"] = float(delays[:, 1:].mean())
    for step in range(delays.shape[1]):
        figures[f"{prefix}.delay_samples.{step + 1}"] = float(delays[:, step].mean())
        figures[f"{prefix}.missed.{step + 1}"] = float(np.mean([entry.delays[step] is None for entry in scores]))
    confusion = np.sum([entry.confusion for entry in scores], axis=0)
    names = scores[0].names
    for truth, row in zip(names, confusion, strict=True):
        if row.sum():
            for verdict, count in zip(names, row, strict=True):
                figures[f"{prefix}.confusion.{truth}.{verdict}"] = float(count / row.sum())
    return figures
