"""Sensor hum."""

from __future__ import annotations

from typing import Any

from core.block import Context, Equation, parameter
from core.elementary import sin_of_turns
from core.faults.fault import Fault, FaultParams, PackedFault, effect, severity, severity_now
from core.ports import BlockPorts
from core.record import Record


class SensorHum(Fault):
    r"""The mains in the measurement, :math:`z\to z+a\sin2\pi ft`.

    One period of 50 Hz lasts 20 ms, as long as many scenarios.
    """

    title = "Sensor hum"
    group, place = "Measurement", 22
    shows = "sensor"
    changes = "measured displacement, whatever the sensor; a controller makes the shuttle follow the mains"
    suggested = 0.2
    axes = None
    equations = (Equation("effect", r"z\to z+a\sin2\pi ft", "not in the text"),)

    class Params(FaultParams):
        """Severity is the amplitude."""

        severity: float = parameter(0.0, "amplitude of the hum", "um", ge=0, le=100)
        frequency_hz: float = parameter(50.0, "frequency of the mains, or of one of its multiples", "Hz", gt=0, le=1e5)

    class Packed(PackedFault):
        """Profile and severity, and the frequency."""

        turns_per_ms: float

    class Ports(BlockPorts):
        """The error added to the measurement."""

        sensor_offset: float = effect("sensor_offset")
        other: float = effect("other")
        severity: float = severity("um", "amplitude of the hum")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack severity, profile and frequency."""
        p: SensorHum.Packed = super().pack(params, context)
        p.turns_per_ms = 1e-3 * params.frequency_hz
        return p

    @staticmethod
    def step(p: Packed, s: Record, x: Ports) -> None:
        """Add the hum; its phase continues while an intermittent fault is off."""
        amplitude = severity_now(p, x.tick)
        x.severity = amplitude
        if amplitude != 0.0:
            turns = p.turns_per_ms * x.time_ms
            x.sensor_offset += amplitude * sin_of_turns(turns)
            x.other += 1.0
