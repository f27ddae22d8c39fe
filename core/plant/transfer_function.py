"""A plant given by its transfer function, exact between samples."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import TICK, BlockParams, Context, Equation, FloatArray, Oscillator, parameter, settled
from core.device.oscillator import held
from core.noise import key, normal
from core.plant.shuttle import (
    ACCELERATION,
    DISPLACEMENT,
    DRIVE_GAIN,
    DRIVE_OFFSET,
    END,
    FIRST_OWN_INPUT,
    MIDDLE,
    STIFFNESS,
    VELOCITY,
    VOLTAGE,
    Shuttle,
    at_rest_sideways,
    coefficients,
)

FORCE, DT, X0, V0, NOISE, NOISE_KEY = range(STIFFNESS + 1, STIFFNESS + 7)
"""Packed parameters behind mass, damping and stiffness."""
X_OUT, V_OUT = FIRST_OWN_INPUT + DISPLACEMENT, FIRST_OWN_INPUT + VELOCITY
KEPT, PHI11, PHI12, PHI21, PHI22, REACH, PUSH = 0, 3, 4, 5, 6, 7, 8


def transfer_function_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Advance over the interval that ends now; the first tick only sets the start."""
    at_rest_sideways(w, io, FIRST_OWN_INPUT, 0.0)
    if w[TICK] == 0.0:
        w[io[X_OUT]] = p[X0]
        w[io[V_OUT]] = p[V0]
        return
    m, b, k = coefficients(p, w, io)
    if m != s[KEPT] or b != s[KEPT + 1] or k != s[KEPT + 2]:
        s[KEPT], s[KEPT + 1], s[KEPT + 2] = m, b, k
        s[PHI11], s[PHI12], s[PHI21], s[PHI22], s[REACH], s[PUSH] = held(m, b, k, p[DT])
    # what an analogue generator does within a sample counts with its mean
    u = (w[io[VOLTAGE]] + 4.0 * w[io[MIDDLE]] + w[io[END]]) / 6.0
    if w[io[MIDDLE]] == w[io[VOLTAGE]] and w[io[END]] == w[io[VOLTAGE]]:
        u = w[io[VOLTAGE]]
    u = w[io[DRIVE_GAIN]] * u + w[io[DRIVE_OFFSET]]
    if p[NOISE] > 0.0:
        u += p[NOISE] * normal(p[NOISE_KEY], w[TICK] - 1.0)
    f = p[FORCE] * u - m * w[io[ACCELERATION]]
    x = w[io[X_OUT]]
    v = w[io[V_OUT]]
    w[io[X_OUT]] = settled(s[PHI11] * x + s[PHI12] * v + s[REACH] * f)
    if m == 0.0:
        v = (f - k * w[io[X_OUT]]) / b
    else:
        v = s[PHI21] * x + s[PHI22] * v + s[PUSH] * f
    w[io[V_OUT]] = settled(v)


class TransferFunction(Shuttle):
    r"""A plant without units, :math:`a_2\ddot x+a_1\dot x+a_0x=b_0u`: chapter 4 and appendix B.

    Exact for a held drive, whatever the signs: :math:`1/(s-0.2)` grows, :math:`1/s^2` drifts. Faults of mass,
    damping and stiffness multiply :math:`a_2, a_1, a_0`; friction, shorts and sideways faults have nothing to act on.
    """

    title = "Transfer function"
    equations = (
        Equation("plant", r"a_2\ddot x+a_1\dot x+a_0x=b_0u", "4.3.1.1, 4.3.1, B.1.3"),
        Equation("between samples", r"x_{i+1}=\Phi x_i+\Gamma u_i,\quad\Phi=e^{Ah},\;\Gamma=\int_0^he^{A\tau}B\,d\tau"),
    )

    class Params(BlockParams):
        """Starting point and noise."""

        initial_displacement_um: float = parameter(
            0.0, "displacement at the start", "um", ge=-20, le=20, equation="4.3.1", live=False
        )
        initial_velocity_um_ms: float = parameter(0.0, "velocity at the start", "um/ms", live=False)
        drive_noise_v: float = parameter(0.0, "white noise on the drive voltage, rms per sample", "V", ge=0)

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse resonators: their force is that of a comb."""
        return "" if device.time_unit_ms > 0.0 else "this device is a resonator; choose linear"

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        plant = context.device
        return np.array(
            [
                plant.mass,
                plant.damping,
                plant.stiffness,
                plant.force,
                context.dt_ms,
                params.initial_displacement_um,
                params.initial_velocity_um_ms,
                params.drive_noise_v,
                key(context.seed, "plant.drive"),
            ]
        )

    @classmethod
    def state(cls, params: Any, context: Context) -> FloatArray:
        """Coefficients of the transition kept, and the transition."""
        return np.zeros(9)

    step = transfer_function_step
