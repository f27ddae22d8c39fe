"""Velocity along the motion, with white noise: the second output a bank may be given."""

from __future__ import annotations

from typing import Any

import numpy as np

from core.block import TICK, Context, Equation, FloatArray, Port, parameter
from core.noise import key, normal
from core.sense.sensor import Sensor, SensorParams

NOISE, KEY = range(2)
TRUE, VELOCITY = range(2)


def velocimeter_step(p: Any, s: Any, w: Any, io: Any) -> None:
    """Read the velocity."""
    w[io[VELOCITY]] = w[io[TRUE]] + p[NOISE] * normal(p[KEY], w[TICK])


class Velocimeter(Sensor):
    r"""Velocity of the shuttle along x plus white noise, :math:`z_i=\dot x_i+v_i`.

    The text reads displacement and velocity (C = I in 5.2.4) without saying how; a laser along the motion would do.
    """

    title = "In-plane velocimeter"
    inputs = (Port("true", "um/ms", "true velocity", source="plant.velocity"),)
    outputs = (Port("velocity", "um/ms", "measured velocity"),)
    equations = (Equation("measurement", r"z_i=\dot x(t_i)+v_i,\quad v_i\sim N(0,\sigma_v^2)", "5.2.4, C = I"),)

    class Params(SensorParams):
        """Noise of the velocimeter."""

        noise_um_ms: float = parameter(
            0.5, "standard deviation of the velocity of a sample (assumed)", "um/ms", ge=0, le=1e4
        )

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the parameters for the step."""
        return np.array([params.noise_um_ms, key(context.seed, "sensor.velocimeter")])

    step = velocimeter_step
