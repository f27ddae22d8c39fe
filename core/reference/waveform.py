"""What every reference shares: ports, amplitude in volts or micrometres, values between samples."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, ClassVar, Self

import numpy as np
from pydantic import model_validator

from core.block import TICK, Block, BlockParams, Context, FloatArray, Port, kernel, parameter
from core.errors import InputError

DT, ANALOGUE, SCALE, OFFSET, FIRST = range(5)
"""Packed parameters of every reference; those of the waveform start at ``FIRST``."""


class ReferenceParams(BlockParams):
    """Amplitude in volts, or in micrometres of static displacement of the nominal device."""

    amplitude_v: float | None = parameter(None, "amplitude", "V")
    amplitude_um: float | None = parameter(None, "amplitude as displacement at rest, instead of volts", "um")
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
        assert self.amplitude_um is not None  # _one_amplitude has seen to it
        if context.device.static_gain == 0.0:
            raise InputError("needs a device that moves; these stators give no force", "reference.amplitude_um")
        return self.amplitude_um / context.device.static_gain


@kernel
def sine_of(cycles: float) -> float:
    """Sine of a phase in cycles, kept below one, so that it is as exact after hours as at the start."""
    return math.sin(2.0 * math.pi * (cycles - math.floor(cycles)))


class Waveform(Block):
    """A reference; a subclass gives ``shape(p, t_ms)`` of unit amplitude."""

    inputs: ClassVar = ()
    outputs: ClassVar = (
        Port("voltage", "V", "reference voltage now"),
        Port("middle", "V", "reference half a sample later", hidden=True),
        Port("end", "V", "reference one sample later", hidden=True),
    )

    @classmethod
    def pack(cls, params: Any, context: Context) -> FloatArray:
        """Pack the shared parameters, then those of the waveform; what plays every N ticks is held over them."""
        analogue = context.analogue and context.every == 1
        shared = [context.dt_ms / context.every, float(analogue), params.volts(context), params.offset_v]
        return np.array([*shared, *cls.shape_parameters(params, context)], dtype=np.float64)

    @classmethod
    def shape_parameters(cls, params: Any, context: Context) -> list[float]:
        """Return the packed parameters of the waveform."""
        raise NotImplementedError

    @classmethod
    def tones(cls, params: Any, context: Context) -> list[tuple[float, float]]:
        """Return frequency in Hz and amplitude in V of its lines, a constant at 0 Hz; none when it is broad."""
        own = [(hz, params.volts(context) * share) for hz, share in cls.lines(params)]
        if not own:
            return []
        constant = params.offset_v + sum(volts for hz, volts in own if hz == 0.0)
        moving = [(hz, volts) for hz, volts in own if hz > 0.0 and volts != 0.0]
        return [*moving, (0.0, constant)] if constant != 0.0 else moving

    @classmethod
    def lines(cls, params: Any) -> list[tuple[float, float]]:
        """Return frequency in Hz and share of the amplitude of every line; none when there are no lines."""
        return []


def line(hz: float, phase_deg: float, share: float = 1.0) -> tuple[float, float]:
    """Return the line of a sine; at 0 Hz it is the constant its phase makes it."""
    return hz, share if hz > 0.0 else share * math.sin(math.radians(phase_deg))


def playing(shape: Callable[[Any, float], float]) -> Any:
    """Return the step that plays ``shape``; a DAC holds it, an analogue generator does not."""

    def step(p: Any, s: Any, w: Any, io: Any) -> None:
        t = w[TICK] * p[DT]
        w[io[0]] = p[OFFSET] + p[SCALE] * shape(p, t)
        if p[ANALOGUE] != 0.0:
            w[io[1]] = p[OFFSET] + p[SCALE] * shape(p, t + 0.5 * p[DT])
            w[io[2]] = p[OFFSET] + p[SCALE] * shape(p, t + p[DT])
        else:
            w[io[1]] = w[io[0]]
            w[io[2]] = w[io[0]]

    return step
