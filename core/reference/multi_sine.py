"""Sum of sines."""

from __future__ import annotations

from typing import Any

from core.block import BlockParams, Context, Equation, kernel, parameter
from core.device.ranges import Sized
from core.reference.waveform import FIRST, ReferenceParams, Waveform, line, playing, sine_of


class Tone(BlockParams):
    """One tone of the sum."""

    frequency_hz: Sized = parameter(1000.0, "frequency", "Hz", ge=0, le=1e6)
    amplitude: float = parameter(1.0, "share of the amplitude")
    phase_deg: float = parameter(0.0, "phase at t = 0", "deg")


@kernel
def tones(p: Any, t: float) -> float:
    """Sum over the tones."""
    total = 0.0
    for i in range(int(p[FIRST])):
        base = FIRST + 1 + 3 * i
        total += p[base + 1] * sine_of(p[base] * t + p[base + 2])
    return total


class MultiSine(Waveform):
    r"""Sum of tones, :math:`r(t)=r_0+A\sum_i a_i\sin(2\pi f_i t+\varphi_i)`."""

    title = "Sum of sines"
    equations = (Equation("reference", r"r(t)=r_0+A\sum_i a_i\sin(2\pi f_i t+\varphi_i)"),)

    class Params(ReferenceParams):
        """Parameters of a sum of tones."""

        tones: list[Tone] = parameter([Tone(frequency_hz=159.155), Tone(frequency_hz=461.549)], "the tones", live=False)

    @classmethod
    def shape_parameters(cls, params: Any, context: Context) -> list[float]:
        """Return the number of tones, then three numbers each."""
        rows = [[tone.frequency_hz / 1e3, tone.amplitude, tone.phase_deg / 360.0] for tone in params.tones]
        return [float(len(rows)), *(value for row in rows for value in row)]

    @classmethod
    def lines(cls, params: Any) -> list[tuple[float, float]]:
        """Return a line for each tone."""
        return [line(tone.frequency_hz, tone.phase_deg, tone.amplitude) for tone in params.tones]

    step = playing(tones)
