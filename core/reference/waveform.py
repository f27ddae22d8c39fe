"""Base of the references: ports, amplitude in volts or micrometres, values between samples."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Self

from pydantic import model_validator

from core.block import Block, BlockParams, Context, parameter
from core.elementary import sin
from core.errors import InputError
from core.ports import BlockPorts, output
from core.record import Choice, Record


class ReferenceParams(BlockParams):
    """Amplitude in volts, or in micrometres of static displacement of the nominal device."""

    amplitude_v: float | None = parameter(None, "amplitude", "V")
    amplitude_um: float | None = parameter(None, "amplitude as static displacement, instead of volts", "um")
    offset_v: float = parameter(0.0, "constant added", "V")

    @model_validator(mode="after")
    def _one_amplitude(self) -> Self:
        if (self.amplitude_v is None) == (self.amplitude_um is None):
            raise ValueError("needs exactly one of amplitude_v and amplitude_um")
        return self

    def volts(self, context: Context) -> float:
        """Return the amplitude in volts."""
        if self.amplitude_v is not None:
            return self.amplitude_v
        assert self.amplitude_um is not None  # _one_amplitude has checked it
        if context.device.static_gain == 0.0:
            raise InputError("no constant voltage alone displaces this device; give amplitude_v", "amplitude_um")
        return self.amplitude_um / context.device.static_gain


class Waveform(Block):
    """A reference; a subclass gives ``shape(p, t_ms)`` of unit amplitude.

    The plant of a bench with axes may have a waveform as a generator in addition to its rate; a controller turns it
    into a force.
    """

    axes = None

    class Packed(Record):
        """Every reference: ms of a tick, whether it also plays between ticks, amplitude and constant in V."""

        dt_ms: float
        analogue: Choice
        scale: float
        offset: float

    class Ports(BlockPorts):
        """The reference voltage."""

        voltage: float = output("V", "reference voltage now")
        middle: float = output("V", "reference half a sample later", hidden=True)
        end: float = output("V", "reference one sample later", hidden=True)

    def __init_subclass__(cls) -> None:
        """Make the step play the shape of the subclass."""
        super().__init_subclass__()
        cls.step = playing(cls.shape)  # type: ignore[assignment]

    @classmethod
    def pack(cls, params: Any, context: Context) -> Any:
        """Pack the shared parameters; a reference that runs every N ticks is held between them."""
        p = cls.Packed.blank(cls.tails(params))
        p.dt_ms = context.dt_ms / context.every
        p.analogue = context.analogue and context.every == 1
        p.scale, p.offset = params.volts(context), params.offset_v
        return p

    @classmethod
    def tails(cls, params: Any) -> int:
        """Return the length of the packed record's tail."""
        return 0

    @staticmethod
    def shape(p: Any, t: float) -> float:
        """Return the waveform of unit amplitude at a time in ms."""
        raise NotImplementedError

    @classmethod
    def tone_hz(cls, params: Any) -> float:
        """Return the frequency of its one tone in Hz; 0 where there is none, or more than one."""
        return 0.0

    @classmethod
    def tones(cls, params: Any, context: Context) -> list[tuple[float, float]]:
        """Return frequency in Hz and amplitude in V of its lines, a constant at 0 Hz; none if the spectrum is broad."""
        lines = [(hz, params.volts(context) * share) for hz, share in cls.lines(params)]
        if not lines:
            return []
        constant = params.offset_v + sum(volts for hz, volts in lines if hz == 0.0)
        moving = [(hz, volts) for hz, volts in lines if hz > 0.0 and volts != 0.0]
        return [*moving, (0.0, constant)] if constant != 0.0 else moving

    @classmethod
    def lines(cls, params: Any) -> list[tuple[float, float]]:
        """Return frequency in Hz and share of the amplitude of every line; none if there are no lines."""
        return []


def line(hz: float, phase_deg: float, share: float = 1.0) -> tuple[float, float]:
    """Return the line of a sine; at 0 Hz it is a constant given by the phase."""
    return hz, share if hz > 0.0 else share * sin(math.radians(phase_deg))


def playing(shape: Callable[[Any, float], float]) -> Callable[[Any, Any, Any], None]:
    """Return the step that plays ``shape``; a DAC holds it, an analogue generator does not."""

    def step(p: Waveform.Packed, s: Record, x: Waveform.Ports) -> None:
        t = x.tick * p.dt_ms
        now = p.offset + p.scale * shape(p, t)
        x.voltage = now
        if p.analogue != 0.0:
            x.middle = p.offset + p.scale * shape(p, t + 0.5 * p.dt_ms)
            x.end = p.offset + p.scale * shape(p, t + p.dt_ms)
        else:
            x.middle = now
            x.end = now

    return step
