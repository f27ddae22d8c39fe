"""Pick-off: displacement and velocity of an axis with white noise and a converter."""

from __future__ import annotations

from typing import Any

from core.block import BlockParams, Context, Equation, parameter
from core.elementary import floor
from core.flicker import ROOT_VARIANCE, Flicker, PackedFlicker, flicker_now, pack_flicker, start_flicker
from core.noise import normal
from core.ports import BlockPorts, output, reads, tap
from core.record import Record, stream
from core.sense.sensor import Sensor
from core.units import noise_of_sample, um_of_pm

FASTEST_SAMPLES = 10.0
"""Time of correlation of the fastest process of the flicker: its density is 1/f up to a hundredth of the samples."""


class PickOff(Sensor):
    r"""Displacement and velocity of one axis plus noise, :math:`z_i=q\,[(x_i+v_i)/q]`; one for every axis.

    A capacitive pick-off gives the displacement, and a second pick-off under a constant bias a current proportional to
    the velocity. Each has noise of its own, given as a density that is white up to half the sample rate. The
    displacement may have flicker as well, the 1/f noise of its amplifier, with the one-sided density
    :math:`S_{1/f}=c^2/f`: its Allan deviation is flat at :math:`\sqrt{2\ln2}\,c`.
    """

    title = "Pick-off of an axis"
    axes = None
    per_axis = True
    equations = (
        Equation("displacement", r"z_i=x(t_i)+v_i,\quad v_i\sim N\!\left(0,\tfrac{S_x}{2h}\right)"),
        Equation("flicker", r"S_{1/f}(f)=\frac{c^2}f,\quad\sigma(\tau)=\sqrt{2\ln2}\,c", "IEEE Std 952, annex C"),
        Equation("velocity", r"\dot z_i=\dot x(t_i)+w_i,\quad w_i\sim N\!\left(0,\tfrac{S_v}{2h}\right)"),
    )

    weaknesses = (
        "The density of the flicker falls faster than 1/f above a hundredth of the sample rate; a bench of 100 kHz has "
        "1/f up to 1 kHz, below the frequency of most gyroscopes, whose rate therefore hardly shows it.",
    )

    class Params(BlockParams):
        """Noise and converter, the same for every axis."""

        noise_pm_rthz: float = parameter(0.0, "noise density of the displacement", "pm/rtHz", ge=0, le=1e6)
        flicker_pm_rthz: float = parameter(
            0.0, "flicker density of the displacement at 1 Hz", "pm/rtHz", equation="flicker", ge=0, le=1e6
        )
        velocity_noise_nm_s_rthz: float = parameter(0.0, "noise density of the velocity", "nm/s/rtHz", ge=0, le=1e9)
        quantum_pm: float = parameter(0.0, "step of the converter, 0 for none", "pm", ge=0, le=1e7)

    class Packed(Record):
        """Noise of a sample of displacement and velocity, step of the converter, streams."""

        noise_um: float
        noise_um_ms: float
        quantum_um: float
        key: float = stream("sensor.{axis}")
        velocity_key: float = stream("sensor.{axis}.velocity")
        flicker: PackedFlicker

    class State(Record):
        """The flicker."""

        flicker: Flicker

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
        size = um_of_pm(params.flicker_pm_rthz) * ROOT_VARIANCE
        pack_flicker(p.flicker, context, f"sensor.{context.axis}.flicker", size, FASTEST_SAMPLES)
        return p

    @classmethod
    def state(cls, params: Any, context: Context) -> State:
        """Begin the flicker anywhere."""
        s = cls.State.zeros()
        start_flicker(s.flicker, context, f"sensor.{context.axis}.flicker")
        return s

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Read displacement and velocity."""
        z = x.sensed
        if p.flicker.size > 0.0:
            z += flicker_now(p.flicker, s.flicker, x.tick)
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
