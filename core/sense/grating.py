r"""The grating in the shuttle under a focused beam: transmitted light, and height of the surface.

A bar grating of pitch :math:`\Lambda` with the share :math:`D` open, smoothed by a Gaussian beam of
:math:`1/e^2` radius :math:`w`, is open under the beam by

.. math:: o(x)=D+\sum_m a_m\cos\frac{2\pi m(x-x_0)}{\Lambda},\qquad
    a_m=\frac{2}{\pi m}\sin(\pi mD)\,e^{-(\pi mw/\Lambda)^2/2}

The dissertation gives the 2 um openings (2.2.2) and the 2 um resolution (6.3); the pitch of 4 um follows from
them. Spot, bar transmission and signal to noise ratio are not in the text and are assumptions.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TypeVar

from core.block import Context, parameter
from core.elementary import cos, exp, sin
from core.kernel import kernel
from core.noise import key, uniform
from core.record import Choice, Record, Vector, tail
from core.sense.sensor import SensorParams

HARMONICS = 64
NEGLIGIBLE = 1e-9
LN10 = 2.302585092994046


class Grating(Record):
    """A packed grating: mean, 2 pi over pitch, offset, number of harmonics, their amplitudes."""

    mean: float
    wave: float
    offset: float
    count: Choice
    amplitudes: Vector = tail()


G = TypeVar("G", bound=Grating)


@lru_cache(256)
def amplitudes(pitch: float, spot: float, opening: float) -> tuple[float, ...]:
    """Return the amplitudes a of the harmonics that are large enough to matter."""
    harmonics = []
    for m in range(1, HARMONICS + 1):
        blur = math.pi * m * spot / pitch
        smooth = exp(-0.5 * blur * blur)
        harmonics.append(2.0 / (math.pi * m) * sin(math.pi * m * opening) * smooth)
    while len(harmonics) > 1 and abs(harmonics[-1]) <= NEGLIGIBLE * abs(harmonics[0]):
        harmonics.pop()
    return tuple(harmonics)


class GratingParams(SensorParams):
    """A grating and the beam on it."""

    pitch_um: float = parameter(4.0, "pitch of the grating", "um", gt=0, le=1000, equation="2.2.2")
    opening: float = parameter(0.5, "open share of the pitch", gt=0.01, le=0.99, equation="2.2.2")
    spot_um: float = parameter(1.5, "1/e^2 radius of the beam on the grating (assumed)", "um", gt=0, le=100)
    grating_offset_um: float | None = parameter(
        None,
        "undeflected position of an opening under the beam; drawn by the seed unless given",
        "um",
        ge=-1000,
        le=1000,
    )

    def shape(self) -> list[float]:
        """Return the amplitudes of the open share's harmonics that are large enough to matter."""
        return list(amplitudes(self.pitch_um, self.spot_um, self.opening))

    def offset(self, seed: int) -> float:
        """Return the position of an opening, as given or drawn at random."""
        if self.grating_offset_um is not None:
            return self.grating_offset_um
        return float(self.pitch_um * uniform(key(seed, "sensor.grating"), 0.0))


class BeamParams(GratingParams):
    """A grating, a beam through it and the noise of the detector."""

    bar_transmission: float = parameter(
        0.5, "transmission of the bars at 1310 nm; polysilicon is not opaque (assumed)", ge=0, le=0.99
    )
    snr_db: float = parameter(
        30.0, "signal to noise ratio of a sample: rms of the fundamental over rms of the noise", "dB", ge=-20, le=200
    )

    @property
    def mean(self) -> float:
        """Mean intensity over a pitch, full light being 1."""
        return self.opening + (1.0 - self.opening) * self.bar_transmission

    @property
    def harmonics(self) -> list[float]:
        """Amplitudes of the intensity."""
        return [(1.0 - self.bar_transmission) * a for a in self.shape()]

    @property
    def visibility(self) -> float:
        """Fundamental over mean."""
        return abs(self.harmonics[0]) / self.mean

    @property
    def noise(self) -> float:
        r"""Standard deviation of the intensity, :math:`\frac{c_1}{\sqrt2}10^{-SNR/20}`."""
        return abs(self.harmonics[0]) / math.sqrt(2.0) * exp(-self.snr_db / 20.0 * LN10)

    @property
    def phase_noise_um(self) -> float:
        r"""Displacement noise of a pair in quadrature, :math:`\frac{\Lambda}{2\pi\sqrt2}10^{-SNR/20}`."""
        return self.pitch_um / (2.0 * math.pi * math.sqrt(2.0)) * exp(-self.snr_db / 20.0 * LN10)

    def packed(self, kind: type[G], context: Context) -> G:
        """Return the packed grating of the intensity; all other fields of the record are blank."""
        return pack_grating(kind, self.mean, self.pitch_um, self.offset(context.seed), self.harmonics)


def pack_grating(kind: type[G], mean: float, pitch_um: float, offset_um: float, amplitudes: list[float]) -> G:
    """Return a Fourier series for the kernels below; all other fields of the record are blank."""
    p = kind.blank(len(amplitudes))
    p.mean, p.wave, p.offset = mean, 2.0 * math.pi / pitch_um, offset_um
    p.count = len(amplitudes)
    p.amplitudes[:] = amplitudes
    return p


@kernel
def level(p: Grating, x: float) -> float:
    """Return the value of a series; NaN gives NaN."""
    if not math.isfinite(x):
        return math.nan
    now = cos(p.wave * (x - p.offset))
    twice = 2.0 * now
    before = 1.0
    total = float(p.mean + p.amplitudes[0] * now)
    for m in range(1, int(p.count)):
        after = twice * now - before
        before = now
        now = after
        total += p.amplitudes[m] * now
    return total


@kernel
def series(p: Grating, x: float) -> tuple[float, float, float]:
    """Return value, slope and curvature by displacement of a series."""
    if not math.isfinite(x):
        return math.nan, math.nan, math.nan
    angle = p.wave * (x - p.offset)
    c1 = cos(angle)
    s1 = sin(angle)
    c0 = 1.0
    s0 = 0.0
    twice = 2.0 * c1
    value = float(p.mean)
    first = 0.0
    second = 0.0
    for i in range(int(p.count)):
        m = i + 1.0
        a = p.amplitudes[i]
        value += a * c1
        first -= m * a * s1
        second -= m * m * a * c1
        c2 = twice * c1 - c0
        s2 = twice * s1 - s0
        c0 = c1
        c1 = c2
        s0 = s1
        s1 = s2
    wave = p.wave
    return value, wave * first, wave * wave * second
