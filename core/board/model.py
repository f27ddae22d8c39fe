"""Reference model: where the shuttle should be."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np

from core.block import Block, BlockParams, Context, Equation, FloatArray, Oscillator, Port, parameter, settled
from core.device.oscillator import transition

PHI11, PHI12, PHI21, PHI22, STATIC, DIRECT, DT = range(7)
X, V, HELD, STARTED = range(4)


def model_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Advance the model over the interval that ends now."""
    if p[DIRECT] != 0.0:
        w[io[3]] = (p[STATIC] * w[io[0]] - w[io[2]]) / p[DT] if s[STARTED] != 0.0 else 0.0
        w[io[2]] = p[STATIC] * w[io[0]]
        s[STARTED] = 1.0
        return
    if s[STARTED] != 0.0:
        rest = p[STATIC] * s[HELD]
        x = s[X] - rest
        v = s[V]
        s[X] = settled(p[PHI11] * x + p[PHI12] * v + rest)
        s[V] = settled(p[PHI21] * x + p[PHI22] * v)
    s[STARTED] = 1.0
    # half a sample later is the mean of an analogue drive, and the same as now for a held one
    s[HELD] = w[io[1]]
    w[io[2]] = s[X]
    w[io[3]] = s[V]


class Model(Block):
    r"""Reference model, :math:`\ddot y_m+a_{m1}\dot y_m+a_{m2}y_m=k_mr`."""

    title = "Reference model"
    inputs = (
        Port("reference", "V", "reference voltage", source="reference.voltage"),
        Port("middle", "V", "reference half a sample later", source="reference.middle"),
    )
    outputs = (Port("displacement", "um", "where the shuttle should be"),)
    taps = (Port("velocity", "um/ms", "how fast it should move"),)
    equations = (Equation("model", r"\ddot y_m+a_{m1}\dot y_m+a_{m2}y_m=k_mr", "3.1.2.4"),)

    class Params(BlockParams):
        """Which model."""

        kind: Literal["copy", "damped", "direct"] = parameter(
            "copy",
            "the nominal device, a damped one of the same resonance, or just the displacement at rest",
            live=False,
        )
        damping_ratio: float = parameter(0.7, "damping ratio of the damped model", gt=0, le=10, live=False)

    @classmethod
    def oscillator(cls, params: Any, device: Oscillator) -> Oscillator:
        """Return the model that belongs to a device."""
        if params.kind != "damped":
            return device
        critical = 2.0 * (device.stiffness * device.mass) ** 0.5
        return Oscillator(device.mass, params.damping_ratio * critical, device.stiffness, device.force)

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        model = context.model
        phi = transition(model.mass, model.damping, model.stiffness, context.dt_ms)
        return np.array([*phi, model.static_gain, float(params.kind == "direct"), context.dt_ms])

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Displacement, velocity, held reference, whether it has run."""
        return np.zeros(4)

    step = model_step
