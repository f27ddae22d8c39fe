"""Active disturbance rejection against its loop in matrices, written with scipy alone."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.linalg import expm

from core.block import FloatArray, Oscillator
from core.control.adrc import Adrc
from tests.lab import inject, make, play
from tests.physics.loop import faulty, sampled

FAULTS = {"added_mass": {"mass": 1.1}, "stiffness": {"stiffness": 1.3}, "damping": {"damping": 4.0}}


def extended(device: Oscillator, dt_ms: float) -> tuple[FloatArray, FloatArray]:
    """Return displacement, velocity and a constant acceleration of a device over a sample; the last acts on it."""
    whole = np.zeros((4, 4))
    whole[0, 1] = whole[1, 2] = 1.0
    whole[1, :2] = -device.stiffness / device.mass, -device.damping / device.mass
    whole[1, 3] = device.force / device.mass
    over = expm(whole * dt_ms)
    return over[:3, :3], over[:3, 3]


@pytest.mark.parametrize("plant", ["nominal", "integrators"])
@pytest.mark.parametrize("fault", list(FAULTS))
def test_the_loop_is_the_loop_of_the_matrices(plant: str, fault: str) -> None:
    own = {"plant": plant, "controller_bandwidth": 1.5, "observer_bandwidth": 4.0}
    board = make({"controller": {"kind": "adrc", **own}, "reference": {"kind": "step", "amplitude_v": 4.0}})
    context = board.spec.context(1)
    device, model, dt, rate = context.device, context.model, board.dt_ms, context.device.natural_frequency
    scale = next(iter(FAULTS[fault].values())) - 1.0
    inject(board, **{fault: scale})
    trace = play(board, 600)
    assert board.trip is None

    known = device if plant == "nominal" else replace(device, damping=0.0, stiffness=0.0)
    phi, push = extended(known, dt)
    pole = np.exp(-4.0 * rate * dt)
    # the gain that puts the poles of (I - LC) Phi there, from its characteristic polynomial, linear in L
    wanted = np.poly([pole] * 3)[1:]

    def polynomial(gain: Any) -> Any:
        return np.poly((np.eye(3) - np.outer(gain, [1.0, 0.0, 0.0])) @ phi)[1:]

    zero = polynomial(np.zeros(3))
    slopes = np.column_stack([polynomial(column) - zero for column in np.eye(3)])
    gain = np.linalg.solve(slopes, wanted - zero)
    np.testing.assert_allclose(Adrc.Packed(Adrc.packed(Adrc.Params(**own), context)).observer.correct, gain, rtol=1e-6)

    (a, b), (am, bm) = sampled(faulty(device, **FAULTS[fault]), dt), sampled(model, dt)
    x, y, z, u = np.zeros(2), np.zeros(2), np.zeros(3), 0.0
    found = []
    for r in trace["reference.voltage"]:
        z = phi @ z + push * u
        z += gain * (x[0] - z[0])
        acceleration = (model.force * r - model.damping * y[1] - model.stiffness * y[0]) / model.mass
        wish = acceleration + 2 * 1.5 * rate * (y[1] - z[1]) + (1.5 * rate) ** 2 * (y[0] - z[0]) - z[2]
        u = (known.mass * wish + known.damping * z[1] + known.stiffness * z[0]) / known.force
        found.append((x[0], u, z[2]))
        x, y = a @ x + b[:, 0] * u, am @ y + bm[:, 0] * r
    for name, column in zip(("plant.displacement", "adrc.voltage"), np.transpose(found), strict=False):
        np.testing.assert_allclose(trace[name], column, atol=1e-6 * np.abs(column).max())


def test_a_constant_disturbance_is_cancelled() -> None:
    """A bias of the drive is what an extended state is for; a law without it keeps an error."""
    left = {}
    for kind in ("adrc", "lqg"):
        board = make({"controller": {"kind": kind}, "reference": {"kind": "step", "amplitude_v": 4.0}})
        inject(board, stiffness=0.3)
        trace = play(board, 3000)
        left[kind] = abs(trace["plant.displacement"][-1] / trace["model.displacement"][-1] - 1.0)
    assert left["adrc"] < 1e-9
    assert left["lqg"] > 0.02
