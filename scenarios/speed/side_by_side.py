"""Duration of a run of the seven steps of 5.2.4 with the library's diagnosers side by side."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from core.board.idle import leave_out_idle
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build, run
from scenarios.schema import Scenario
from scenarios.speed.timing import cpu_ns

SAMPLES = 9000
DIAGNOSERS: dict[str, dict[str, Any]] = {
    "kalman": {"kind": "mmae"},
    "imm": {"kind": "imm"},
    "lock_in": {"kind": "lock_in"},
    "self_tuning": {"kind": "self_tuning"},
    "adaptive": {"kind": "self_tuning", "adaptation": "direct"},
    "consistency": {"kind": "consistency"},
}
"""One of each of the library's ids."""


def side_by_side() -> Scenario:
    """Return the seven steps with all diagnosers on the same samples."""
    return with_values(get("ch5-seven-step"), {"diagnosers": DIAGNOSERS, "expect": []})


def wired_seven_steps() -> Callable[[], float]:
    """Return the measurement of a headless run on a bench that is wired, ns: blocks, trace, events, log, digest."""
    scenario = side_by_side()

    def measure() -> float:
        board = build(scenario)
        leave_out_idle(board)

        def work() -> None:
            while board.tick < SAMPLES:
                board.advance(SAMPLES - board.tick)
            board.digest()

        return cpu_ns(work, 1)

    return measure


def whole_seven_steps() -> Callable[[], float]:
    """Return the measurement of the same run from scenario to figures, ns."""
    scenario = side_by_side()
    return lambda: cpu_ns(lambda: run(scenario), 1)
