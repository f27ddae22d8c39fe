"""Sum of sines."""

from __future__ import annotations

from typing import Any

from core.block import BlockParams, Context, Equation, parameter
from core.device.ranges import Sized
from core.elementary import sin_of_turns
from core.kernel import kernel
from core.record import Choice, Record, Records, tail
from core.reference.waveform import ReferenceParams, Waveform, line


class Tone(BlockParams):
    """One tone of the sum."""

    frequency_hz: Sized = parameter(1000.0, "frequency", "Hz", ge=0, le=1e6)
    amplitude: float = parameter(1.0, "share of the amplitude")
    phase_deg: float = parameter(0.0, "phase at t = 0", "deg")


class PackedTone(Record):
    """Cycles per ms, share of the amplitude, cycles at the start."""

    frequency_per_ms: float
    amplitude: float
    phase: float


class MultiSine(Waveform):
    r"""Sum of tones, :math:`r(t)=r_0+A\sum_i a_i\sin(2\pi f_i t+\varphi_i)`."""

    title = "Sum of sines"
    equations = (Equation("reference", r"r(t)=r_0+A\sum_i a_i\sin(2\pi f_i t+\varphi_i)"),)

    class Params(ReferenceParams):
        """Parameters of a sum of tones."""

        tones: list[Tone] = parameter([Tone(frequency_hz=159.155), Tone(frequency_hz=461.549)], "the tones", live=False)

    class Packed(Waveform.Packed):
        """How many tones, and each."""

        count: Choice
        tones: Records[PackedTone] = tail()

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the number of tones and the tones."""
        p: MultiSine.Packed = super().pack(params, context)
        p.count = len(params.tones)
        for tone, packed in zip(params.tones, p.tones, strict=True):
            packed.frequency_per_ms, packed.phase = tone.frequency_hz / 1e3, tone.phase_deg / 360.0
            packed.amplitude = tone.amplitude
        return p

    @classmethod
    def tails(cls, params: Any) -> int:
        """Return how many tones there are."""
        return len(params.tones)

    @classmethod
    def lines(cls, params: Any) -> list[tuple[float, float]]:
        """Return a line for each tone."""
        return [line(tone.frequency_hz, tone.phase_deg, tone.amplitude) for tone in params.tones]

    @staticmethod
    @kernel
    def shape(p: Packed, t: float) -> float:
        """Sum over the tones."""
        total = 0.0
        for i in range(int(p.count)):
            tone = p.tones[i]
            total += tone.amplitude * sin_of_turns(tone.frequency_per_ms * t + tone.phase)
        return total
