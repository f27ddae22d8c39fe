"""A device in the plane: LCR-350 without drive or noise, and its packed numbers."""

from __future__ import annotations

from typing import Any

from tests.lab import make

EPS = 8.8541878128e-12
N, T, G, XS, XR = 87, 2.0, 2.1, 126.13, 166.13
STRENGTH = N * EPS * T * 1e6 * G  # n eps0 t g, uN um^2/V^2
KT = 1.380649e-23 * 300.0
STILL = {"reference": {"kind": "constant", "amplitude_v": 0.0}}


def bench(bias: float = 10.0, values: dict[str, Any] | None = None, **plant: Any):
    return make(
        {
            "device": {"id": "lcr-350", "bias_v": bias},
            "plant": {"model": "planar", "thermal_noise": False, **plant},
            **STILL,
            **(values or {}),
        }
    )


def insides(board):
    """Packed parameters and state of the plant after a tick."""
    board.advance(1)
    return board.wiring.parameters("plant"), board.wiring.state("plant")
