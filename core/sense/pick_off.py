"""Pick-off: displacement and velocity of an axis with white noise and a converter."""

from __future__ import annotations

from typing import Any

from core.block import BlockParams, Context, Equation, parameter
from core.elementary import floor
from core.noise import normal
from core.ports import BlockPorts, output, reads, tap
from core.record import Record, stream
from core.sense.sensor import Sensor
from core.units import noise_of_sample, um_of_pm


class PickOff(Sensor):
    r"""Displacement and velocity of one axis plus white noise, :math:`z_i=q\,[(x_i+v_i)/q]`; one for every axis.

    A capacitive pick-off gives the displacement, and a second pick-off under a constant bias a current proportional to
    the velocity. Each has noise of its own, given as a density that is white up to half the sample rate.
    """

    title = "Pick-off of an axis"
    axes = None
    per_axis = True
    equations = (
        Equation("displacement", r"z_i=x(t_i)+v_i,\quad v_i\sim N\!\left(0,\tfrac{S_x}{2h}\right)"),
        Equation("velocity", r"\dot z_i=\dot x(t_i)+w_i,\quad w_i\sim N\!\left(0,\tfrac{S_v}{2h}\right)"),
    )

    class Params(BlockParams):
        """Noise and converter, the same for every axis."""

        noise_pm_rthz: float = parameter(0.0, "noise density of the displacement", "pm/rtHz", ge=0, le=1e6)
        velocity_noise_nm_s_rthz: float = parameter(0.0, "noise density of the velocity", "nm/s/rtHz", ge=0, le=1e9)
        quantum_pm: float = parameter(0.0, "step of the converter, 0 for none", "pm", ge=0, le=1e7)

    class Packed(Record):
        """Noise of a sample of displacement and velocity, step of the converter, streams."""

        noise_um: float
        noise_um_ms: float
        quantum_um: float
        key: float = stream("sensor.{axis}")
        velocity_key: float = stream("sensor.{axis}.velocity")

    class Ports(BlockPorts):
        """True and measured motion along the axis."""

        sensed: float = reads("plant.{axis}", "um", "displacement along the axis")
        true: float = reads("@true.{axis}", "um", "true displacement, for the error only")
        sensed_velocity: float = reads("plant.{axis}_velocity", "um/ms", "velocity along the axis")
        displacement: float = output("um", "measured displacement")
        velocity: float = output("um/ms", "measured velocity")
        error: float = tap("um", "measured minus true displacement")

    @classmethod
    def runs_always(cls, params: Any) -> bool:
        """Say no: it runs while it is in use."""
        return False

    @classmethod
    def noise_um(cls, params: Any, context: Context) -> float:
        r"""Return the noise of a sample, :math:`\sqrt{S/2h+q^2/12}`."""
        white, quantum = um_of_pm(noise_of_sample(params.noise_pm_rthz, context.dt_ms)), um_of_pm(params.quantum_pm)
        return float((white**2 + quantum**2 / 12.0) ** 0.5)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the noise of a sample and the step of the converter."""
        p = cls.Packed.blank()
        p.noise_um = um_of_pm(noise_of_sample(params.noise_pm_rthz, context.dt_ms))
        p.noise_um_ms = um_of_pm(noise_of_sample(params.velocity_noise_nm_s_rthz, context.dt_ms))
        p.quantum_um = um_of_pm(params.quantum_pm)
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Read displacement and velocity."""
        z = x.sensed
        if p.noise_um > 0.0:
            z += p.noise_um * normal(p.key, x.tick)
        if p.quantum_um > 0.0:
            z = p.quantum_um * floor(z / p.quantum_um + 0.5)
        velocity = x.sensed_velocity
        if p.noise_um_ms > 0.0:
            velocity += p.noise_um_ms * normal(p.velocity_key, x.tick)
        x.displacement = z
        x.velocity = velocity
        x.error = z - x.true
