"""The bench of the sensing figures: LCR-350 at 4 um and 2 kHz, 518 kHz, 20 ms, a grating placed by the seed."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.board.board import Board
from tests import lab
from tests.lab import do, play

TICKS = 10_360
DOCUMENT: dict[str, Any] = {
    "sample_rate_khz": 518.0,
    "device": {"id": "lcr-350"},
    "plant": {"model": "linear", "thermal_noise": False},
    "reference": {"kind": "sine", "amplitude_v": 2.85, "frequency_hz": 2000.0},
    "controller": {"kind": "open_loop"},
}


def make(values: dict[str, Any] | None = None, *, seed: int = 1, stiffness: float = 0.0) -> Board:
    board = lab.make({"seed": seed, **(values or {})}, base=DOCUMENT)
    if stiffness:
        do(board, {"fault": "stiffness", "severity": stiffness})
    return board


def errors(values: dict[str, Any], seeds: range, *, stiffness: float = 0.0) -> np.ndarray:
    """Return the error of the sensor in use, um, one row a seed."""
    rows = []
    for seed in seeds:
        trace = play(make(values, seed=seed, stiffness=stiffness), TICKS)
        rows.append(trace["sensor.displacement"] - trace["plant.displacement"])
    return np.array(rows)


def rms_nm(values: np.ndarray) -> float:
    return float(1e3 * np.sqrt(np.mean(np.square(values))))


def lost(error: np.ndarray) -> np.ndarray:
    """Say of each row whether more than 2 % of its samples are off by more than half a pitch of 4 um."""
    return np.mean(np.abs(error) > 2.0, axis=1) > 0.02
