"""The loop of direct MRAC in python-control: an oracle in continuous time, and a peer for speed."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from core.block import Context, FloatArray
from core.control.controller import coefficients

AMPLITUDE_V, RAD_PER_MS = 10.0, 1.0
STATES = 21
"""Two of the plant, two of the model, two filters, eight of the regressor, two of G_m[u], four gains, alpha."""


def adaptive_loop(context: Context, stiffness: float = 1.0, gain: float = 1.0) -> Any:
    """Return plant, copied model and controller, interconnected; time in 1/w0.

    Parameters
    ----------
    context : Context
        Context with the device.
    stiffness : float
        True stiffness over nominal.
    gain : float
        Adaptation gain.
    """
    import control

    rate = context.device.natural_frequency
    a1, a2, kp = coefficients(context)[0]

    def oscillator(name: str, spring: float, force: str) -> Any:
        a, b = np.array([[0.0, 1.0], [-spring, -a1]]), np.array([[0.0], [kp]])
        return control.ss(a, b, [[1.0, 0.0]], [[0.0]], name=name, inputs=[force], outputs=[f"{name}_y"])

    weight = np.array([1.0, 1.0, kp**-2, kp**-2])

    def regressor(t: float, x: FloatArray, y: float) -> FloatArray:
        return np.array([AMPLITUDE_V * math.sin(RAD_PER_MS / rate * t), x[0], x[1], y])

    def law(t: float, x: FloatArray, u: FloatArray, _params: Any) -> FloatArray:
        return np.array([x[12:16] @ regressor(t, x, u[0])])

    def adapt(t: float, x: FloatArray, u: FloatArray, _params: Any) -> FloatArray:
        y, model = u
        w = regressor(t, x, y)
        theta, alpha = x[12:16], x[16]
        voltage = theta @ w
        copies = x[2:12].reshape(5, 2)
        moved = np.column_stack([copies[:, 1], kp * np.append(w, voltage) - a1 * copies[:, 1] - a2 * copies[:, 0]])
        bar = copies[:4, 0]
        eta = theta @ bar - copies[4, 0]
        eps = y - model + alpha * eta
        speed = gain * eps / (1.0 + bar @ (weight * bar) + eta * eta)
        filters = [voltage - x[0], y - x[1]]
        return np.concatenate([filters, moved.ravel(), -speed * weight * bar, [-speed * eta]])

    controller = control.nlsys(adapt, law, name="mrac", states=STATES - 4, inputs=["plant_y", "model_y"], outputs=["u"])
    source = control.nlsys(
        None,
        lambda t, _x, _u, _params: np.array([AMPLITUDE_V * math.sin(RAD_PER_MS / rate * t)]),
        name="reference",
        inputs=[],
        outputs=["r"],
    )
    loop = control.interconnect(
        [oscillator("plant", a2 * stiffness, "u"), oscillator("model", a2, "r"), controller, source],
        inputs=[],
        outputs=["plant_y", "model_y", "u"],
    )
    loop.rate = rate
    assert loop.nstates == STATES
    return loop


def simulate(loop: Any, ms: float, points: int = 2) -> Any:
    """Simulate from rest with the gains of the nominal device; return the response, time in 1/w0."""
    import control

    start = np.zeros(STATES)
    start[-5] = start[-1] = 1.0
    times = np.linspace(0.0, ms * loop.rate, points)
    return control.input_output_response(loop, times, 0, start, solve_ivp_kwargs={"rtol": 1e-6, "atol": 1e-9})
