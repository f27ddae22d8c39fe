"""Velocity along the motion, with white noise: the second output a bank may be given."""

from __future__ import annotations

from typing import Any

from core.block import Context, Equation, parameter
from core.noise import normal
from core.ports import BlockPorts, output, reads
from core.record import Record, stream
from core.sense.sensor import Sensor, SensorParams


class Velocimeter(Sensor):
    r"""Velocity of the shuttle along x plus white noise, :math:`z_i=\dot x_i+v_i`.

    The text measures displacement and velocity (C = I in equation 5.2.4) without naming a method; a laser along the
    motion would do it.
    """

    title = "In-plane velocimeter"
    equations = (Equation("measurement", r"z_i=\dot x(t_i)+v_i,\quad v_i\sim N(0,\sigma_v^2)", "5.2.4, C = I"),)

    class Params(SensorParams):
        """Noise of the velocimeter."""

        noise_um_ms: float = parameter(
            0.5, "standard deviation of the velocity of a sample (assumed)", "um/ms", ge=0, le=1e4
        )

    class Packed(Record):
        """The noise and its stream."""

        noise_um_ms: float
        key: float = stream("sensor.velocimeter")

    class Ports(BlockPorts):
        """True and measured velocity."""

        true: float = reads("plant.velocity", "um/ms", "true velocity")
        velocity: float = output("um/ms", "measured velocity")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step."""
        p = cls.Packed.blank()
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Read the velocity."""
        x.velocity = x.true + p.noise_um_ms * normal(p.key, x.tick)
