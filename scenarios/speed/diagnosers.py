"""Cost of diagnosers, each together with the Kalman bank in the same run."""

from __future__ import annotations

from collections.abc import Iterable

from core.board.document import Document
from scenarios.benchmark.results import Cost
from scenarios.speed.boards import seven_step_bench
from scenarios.speed.timing import block_costs

PEER = "mmae"


def diagnoser_costs(units: Iterable[str], own: Document) -> dict[str, Cost]:
    """Return the cost of a sample on the bench of the seven steps, in ns and over the Kalman bank of six models."""
    names = list(dict.fromkeys([PEER, *units]))
    board = seven_step_bench({"diagnosers": {name: {"kind": name} for name in names}, "units": own})
    ns = block_costs(board, *names)
    return {name: Cost(ns_per_sample=ns[name], over_mmae=ns[name] / ns[PEER]) for name in units}
