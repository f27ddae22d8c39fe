"""The benches whose cost is measured."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from core import registry
from core.board.board import CHUNK, Board
from core.board.history import History
from scenarios.edit import with_values
from scenarios.library import get
from scenarios.run import build
from scenarios.speed.side_by_side import DIAGNOSERS
from scenarios.speed.timing import cpu_ns, must_run

SECOND = 100_000
"""Samples of 1 s at 100 kHz."""

ADAPTIVE = {
    "device": {"id": "ch3"},
    "plant": {"model": "linear", "thermal_noise": False},
    "reference": {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 159.15494309189535},
    "controller": {"kind": "mrac"},
    "sensor": {"kind": "ideal"},
    "sample_rate_khz": 100,
}
"""Direct MRAC at 1 krad/s."""

GAIN = {
    "device": {"id": "second-order-gain"},
    "reference": {"kind": "sine", "amplitude_v": 1.0, "frequency_hz": 0.05},
    "controller": {"kind": "gain_adaptation"},
    "sensor": {"kind": "ideal"},
    "sample_rate_khz": 1,
}
"""The plant of appendix B, which has a controller of its own."""

PLANAR = {
    "device": {"id": "lcr-350"},
    "plant": {"model": "planar", "step_us": 0.25},
    "reference": {"kind": "sine", "amplitude_v": 3.0, "frequency_hz": 2000.0},
    "controller": {"kind": "open_loop"},
    "sensor": {"kind": "ideal"},
    "sample_rate_khz": 100,
}
"""Driven at 2 kHz, with all its noise."""

NONLINEAR = {
    **{name: ADAPTIVE[name] for name in ("device", "sensor", "sample_rate_khz")},
    "plant": {"model": "nonlinear", "substeps": 4, "thermal_noise": False},
    "reference": {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 2000.0},
    "controller": {"kind": "open_loop"},
}
"""Driven at 2 kHz, without noise."""

HISTORY_MB = 72.0
"""Memory of the history of a bench; the value of the service unless it is set."""

NOISY = {"plant.drive_noise_v": 0.01}
EVERYTHING = {
    "plant": {"model": "nonlinear", "substeps": 4, "drive_noise_v": 0.01},
    "diagnosers": {name: section for name, section in DIAGNOSERS.items() if name != "lock_in"},
}
"""Nonlinear plant, Kalman bank, IMM, two self-tuning banks of six, consistency; all controllers are on every bench."""


def begun(bench: dict[str, Any]) -> Board:
    """Return the board of a bench after its first ticks."""
    board = Board(bench)
    board.advance(CHUNK)
    return board


def seven_step_bench(values: dict[str, Any] | None = None) -> Board:
    """Return the bench of the seven steps without its events, some values exchanged, after its first ticks."""
    board = build(with_values(get("ch5-seven-step"), {"events": [], "expect": [], **(values or {})}))
    board.advance(CHUNK)
    return board


def with_all_identifiers() -> Board:
    """Return the same bench with every identifier of the library."""
    return seven_step_bench({**NOISY, **{f"identifiers.{name}.kind": name for name in registry.blocks("identify")}})


def with_all_diagnosers() -> Board:
    """Return the same bench with every diagnoser of the library."""
    return seven_step_bench({"diagnosers": DIAGNOSERS})


def live_cost(board: Board, ticks: int = 100 * CHUNK) -> Callable[[], float]:
    """Return the measurement of a tick as a live bench runs it, ns: blocks, digest, log, history.

    The history is full, as it is from some seconds on: before, the system hands out its memory page by page.
    """
    outputs, taps = board.signals.outputs, len(board.signals.taps)
    history = History(outputs, taps, History.ticks_within(HISTORY_MB, outputs, taps))
    while board.tick < history.capacity:
        board.advance_into(history, CHUNK)

    def work() -> None:
        for _ in range(ticks // CHUNK):
            board.advance_into(history, CHUNK)

    def measure() -> float:
        cost = cpu_ns(work, ticks)
        must_run(board)
        return cost

    return measure
