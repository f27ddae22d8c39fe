"""A bench to play with, for all tests: a document by dotted paths, its board, its traces."""

from __future__ import annotations

import copy
import hashlib
from collections.abc import Sequence
from typing import Any

import numpy as np

import scenarios  # noqa: F401  (first: it gives compiled kernels their cache)
from core.board.board import Board
from core.board.commands import parse_command
from core.board.document import with_values

QUIET: dict[str, Any] = {
    "sample_rate_khz": 100,
    "seed": 1,
    "device": {"id": "ch3"},
    "plant": {"model": "linear", "thermal_noise": False},
    "reference": {"kind": "sine", "amplitude_v": 10.0, "frequency_hz": 159.15494309189535},
    "controller": {"kind": "open_loop"},
    "sensor": {"kind": "ideal", "noise_um": 0.0},
}
"""A bench without any noise, driven at 1 krad/s."""

RICH: dict[str, Any] = {
    "sample_rate_khz": 100,
    "seed": 3,
    "device": {"id": "ch3"},
    "plant": {"model": "linear", "drive_noise_v": 0.01},
    "reference": {"kind": "sine", "amplitude_v": 8.0, "frequency_hz": 2000.0},
    "controller": {"kind": "open_loop"},
    "sensor": {"kind": "ideal", "noise_um": 0.02, "quantum_um": 0.001},
    "drive": {"quantum_v": 0.005},
    "diagnosers": {
        "kalman": {
            "kind": "mmae",
            "hypotheses": [{"name": "healthy"}, {"name": "m+5", "mass": 1.05}, {"name": "b+30", "damping": 1.3}],
        },
        "slow": {"kind": "mmae", "every": 2, "hypotheses": [{"name": "healthy"}, {"name": "m+5", "mass": 1.05}]},
    },
}
"""A bench with everything on it."""

AXES_RICH: dict[str, Any] = {
    "sample_rate_khz": 100,
    "seed": 3,
    "device": {"id": "gyro-a"},
    "plant": {"model": "gyroscope_pair", "initial_x_um": 0.5},
    "rate": {"kind": "constant", "deg_per_s": 50.0, "angle_random_walk_deg_rt_h": 0.1},
    "slots": {"drive": "drive_tracking"},
    "controller": {"kind": "force_to_rebalance"},
    "sensor": {"kind": "pick_off", "noise_pm_rthz": 0.05, "quantum_pm": 1.0},
    "drive": {"quantum_un": 0.001},
    "diagnosers": {
        "kalman": {"kind": "axes_bank"},
        "slow": {
            "kind": "axes_bank",
            "every": 2,
            "hypotheses": [{"name": "healthy"}, {"name": "q+500", "quadrature_dps": 500.0}],
        },
    },
    "readouts": {"allan": {"kind": "allan", "interval_ms": 0.1}},
}
"""A bench of two devices with two axes each, with everything on it."""

AXES_STORY: list[dict[str, Any]] = [
    {"fault": "added_mass", "severity": 0.01, "at_sample": 20},
    {"fault": "stiffness", "severity": 0.02, "profile": {"kind": "ramp", "duration_ms": 0.4}, "at_sample": 30},
    {"switch": "sense_axis_sync", "at_sample": 50},
    {"switch": "drive_loop", "at_sample": 60},
    {"set": {"rate.angle_random_walk_deg_rt_h": 0.5, "sensors.pick_off.noise_pm_rthz": 0.1}, "at_sample": 70},
    {"switch": "whole_angle", "at_sample": 90},
    {"heal": ["added_mass"], "at_sample": 97},
]
"""Something of everything there."""

STORY: list[dict[str, Any]] = [
    {"fault": "added_mass", "severity": 0.05, "at_sample": 20},
    {"fault": "stiffness", "severity": 0.2, "profile": {"kind": "ramp", "duration_ms": 0.4}, "at_sample": 30},
    {
        "fault": "damping",
        "severity": 0.5,
        "profile": {"kind": "intermittent", "period_ms": 0.2, "duty": 0.3},
        "at_sample": 41,
    },
    {"switch": "mrac", "at_sample": 60},
    {"set": {"reference.amplitude_v": 4.0, "sensors.ideal.noise_um": 0.05}, "when": "plant.velocity > 5"},
    {"switch": "pid", "at_sample": 90},
    {"heal": ["added_mass"], "at_sample": 97},
    {"switch": "open_loop", "at_sample": 110},
]
"""Something of everything, within the first ms or so."""


def document(values: dict[str, Any] | None = None, base: dict[str, Any] = QUIET) -> dict[str, Any]:
    """Return a bench with values written over it at dotted paths."""
    return with_values(copy.deepcopy(base), values or {})


def make(
    values: dict[str, Any] | None = None,
    commands: list[dict[str, Any]] | None = None,
    *,
    base: dict[str, Any] = QUIET,
    compiled: bool = True,
) -> Board:
    """Return a board at its first tick, with commands waiting."""
    board = Board(document(values, base), compiled=compiled)
    for command in commands or []:
        do(board, command)
    return board


def do(board: Board, command: dict[str, Any], actor: str = "test") -> Any:
    """Apply a command given as a document."""
    return board.apply(parse_command(command), actor)


def fault(name: str, severity: float, **rest: Any) -> dict[str, Any]:
    """Return the command that injects a fault."""
    return {"fault": name, "severity": severity, **rest}


def inject(board: Board, **severities: float) -> None:
    """Inject faults at this tick."""
    for fault, severity in severities.items():
        do(board, {"fault": fault, "severity": severity})


def play(board: Board, ticks: int) -> dict[str, np.ndarray]:
    """Advance and return every signal by name; shorter when the board trips."""
    parts: list[np.ndarray] = []
    end = board.tick + ticks
    while board.tick < end:
        rows = board.advance(end - board.tick)
        if rows.count == 0:
            break
        parts.append(np.hstack([rows.outputs, rows.taps]))
    whole = np.vstack(parts) if parts else np.zeros((0, len(board.signals)))
    return {name: whole[:, i] for i, name in enumerate(board.signals.names)}


def run_digest(board: Board, ticks: int) -> str:
    """Advance and return the digest."""
    play(board, ticks)
    return board.digest()


def inner_digest(board: Board) -> str:
    """Return a digest of all that the compiled loop can see."""
    sha = hashlib.sha256()
    for array in (board.wiring.p, board.wiring.s, board.wiring.w, board.wiring.io):
        sha.update(np.ascontiguousarray(array).data)
    return sha.hexdigest()


def pairs(first: Sequence[Any], second: Sequence[Any], third: Sequence[Any]) -> list[tuple[Any, Any, Any]]:
    """Return cases in which each value meets each value of another parameter, the third being the shortest list."""
    rows = [(a, b, third[(i + j) % len(third)]) for i, a in enumerate(first) for j, b in enumerate(second)]
    assert len(third) <= min(len(first), len(second)), "some of them never meet"
    return rows


def phasor(signal: np.ndarray, frequency_hz: float, dt_ms: float, first: int = 0) -> complex:
    """Return C of x = Im(C exp(jwt)) by least squares, with a constant and nothing else."""
    angle = 2e-3 * np.pi * frequency_hz * dt_ms * (first + np.arange(len(signal)))
    basis = np.column_stack([np.sin(angle), np.cos(angle), np.ones_like(angle)])
    sine, cosine, _ = np.linalg.lstsq(basis, signal, rcond=None)[0]
    return complex(sine, cosine)


def rms(values: np.ndarray) -> float:
    """Return the root of the mean square."""
    return float(np.sqrt(np.mean(np.square(values))))
