"""Figures of verdicts, alarms and regions, which do not choose between hypotheses."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from core.block import BoolArray, FloatArray
from core.board.board import Board
from core.board.commands import HealFaults, Inject
from core.diagnose.consistency import AMBIGUOUS, ISOLATED, NORMAL, UNKNOWN
from scenarios.measure.blocks import first_where, total

TRACED_VERDICTS = ("truth", "winner", "verdict", "alarm", "region", "loss", "estimate")
"""Outputs of diagnosers for their figures."""


def verdict_metrics(board: Board, trace: dict[str, FloatArray]) -> dict[str, float]:
    """Return the figures of every diagnoser that has them; stretches run from one fault or healing to the next.

    ``detected``, ``isolated``, ``ambiguous`` and ``unknown`` are shares of the stretches with a fault, by the
    verdict at their end; isolated counts only if the fault is the right one. ``detection_samples`` is the mean delay
    from the start of such a stretch after a healthy one to the first alarm, and ``false_alarm_fraction`` the share of
    healthy samples with an alarm, the second half of each stretch only. ``region.<step>`` and ``loss.<step>`` are the
    performance at the end of each stretch.
    """
    figures: dict[str, float] = {}
    found = edges(board)
    for name in board.spec.diagnosers:
        prefix = f"diagnosis.{name}"
        verdict, alarm = trace.get(f"{name}.verdict"), trace.get(f"{name}.alarm")
        if verdict is not None:
            figures |= _verdicts(prefix, verdict, trace[f"{name}.winner"], trace[f"{name}.truth"], found)
            figures |= _alarms(prefix, verdict, NORMAL, trace[f"{name}.truth"], found)
        elif alarm is not None:
            truth = trace.get(f"{name}.truth")  # without hypotheses there is none: the faults are the truth
            figures |= _alarms(prefix, alarm, 0, _faults(board) if truth is None else truth, found)
        region = trace.get(f"{name}.region")
        if region is not None:
            loss = trace[f"{name}.loss"]
            for step, (_, end) in enumerate(pairwise(found), 1):
                figures[f"{prefix}.region.{step}"] = float(region[end - 1])
                figures[f"{prefix}.loss.{step}"] = float(loss[end - 1])
        if f"{name}.estimate" in trace:
            figures[f"{prefix}.estimate"] = float(trace[f"{name}.estimate"][-1])
    return figures


def edges(board: Board) -> list[int]:
    """Return the ticks at which a fault came or went, with start and end."""
    ticks = {tick for tick, command in board.done if isinstance(command, Inject | HealFaults)}
    return [0, *sorted(tick for tick in ticks if 0 < tick < board.tick), board.tick] if board.tick else []


def _faults(board: Board) -> FloatArray:
    """Return the number of faults at each tick, by the commands that were carried out."""
    number, present = np.zeros(board.tick), set[str]()
    for tick, command in board.done:
        if isinstance(command, Inject):
            present = present | {command.fault} if command.severity else present - {command.fault}
        elif isinstance(command, HealFaults):
            present = set() if command.heal == "all" else present - {*command.heal}
        number[tick:] = len(present)
    return number


def _verdicts(
    prefix: str, verdict: FloatArray, winner: FloatArray, truth: FloatArray, edges: list[int]
) -> dict[str, float]:
    ends = [end - 1 for _, end in pairwise(edges) if truth[end - 1] != 0.0]
    if not ends:
        return {}
    last = verdict[ends]
    return {
        f"{prefix}.detected": float(np.mean(last != NORMAL)),
        f"{prefix}.isolated": float(np.mean((last == ISOLATED) & (winner[ends] == truth[ends]))),
        f"{prefix}.isolated_wrong": float(np.mean((last == ISOLATED) & (winner[ends] != truth[ends]))),
        f"{prefix}.ambiguous": float(np.mean(last == AMBIGUOUS)),
        f"{prefix}.unknown": float(np.mean(last == UNKNOWN)),
    }


def _alarms(prefix: str, alarm: FloatArray, rest: int, truth: FloatArray, edges: list[int]) -> dict[str, float]:
    def rings(values: FloatArray) -> BoolArray:
        return np.not_equal(values, rest)

    delays, false, quiet = [], 0.0, 0
    was_healthy = True
    for start, end in pairwise(edges):
        healthy = truth[end - 1] == 0.0
        if healthy:
            late = alarm[(start + end) // 2 : end]
            false, quiet = false + float(total(rings, late)), quiet + len(late)
        elif was_healthy:
            delays.append(float(first_where(rings, alarm[start:end])))
        was_healthy = healthy
    figures = {f"{prefix}.detection_samples": float(np.mean(delays))} if delays else {}
    return figures | ({f"{prefix}.false_alarm_fraction": false / quiet} if quiet else {})
