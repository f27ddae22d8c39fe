"""Recovery from two beams: the phase of the pair, unwrapped."""

from __future__ import annotations

import math
from typing import Any

from core.block import Context, Equation, parameter
from core.elementary import atan2, cos, floor, sin
from core.ports import BlockPorts, reads, tap
from core.record import Record
from core.sense.dual_beam import DualBeam
from core.sense.sensor import (
    ERROR_PORT,
    LAST_PORT,
    RECOVERED_PORT,
    SLIPS_PORT,
    TRUE_PORT,
    Sensor,
    SensorParams,
    begin_at,
    calibrated,
    slips,
)

TWO_PI = 2.0 * math.pi


def separation(spacing_um: float, pitch_um: float) -> tuple[float, float]:
    """Return cosine and sine of the phase between the beams.

    Beams half a pitch apart do not show the direction; the unit then amplifies noise, but stays finite.
    """
    delta = TWO_PI * spacing_um / pitch_um
    sine = sin(delta)
    return cos(delta), math.copysign(max(abs(sine), 1e-3), sine)


class QuadratureSensor(Sensor):
    r"""Displacement from the phase of two beams (6.3).

    .. math:: x=x_0+\frac{\Lambda}{2\pi}\,\mathrm{unwrap}\,\mathrm{atan2}(\sin\varphi,\cos\varphi),\qquad
        \sigma_x=\frac{\Lambda}{2\pi\sqrt2}\,\frac{10^{-SNR/20}}{|\sin\delta|}

    This is the root of the mean over a pitch of :math:`\mathrm{var}\,\varphi=\sigma_I^2
    [\cos^2\varphi+\cos^2(\varphi-\delta)]/(c_1\sin\delta)^2`. 14.2 nm at 30 dB for a pitch of 4 um and a spacing of
    1 um. A spacing error of 0.1 um turns the circle into an ellipse, an error of
    about 50 nm at its peak; given the true spacing, the unit corrects it (Heydemann 1981, the phase term only).
    """

    title = "Quadrature with unwrap"
    equations = (
        Equation(
            "phase",
            r"\varphi=\mathrm{atan2}\!\left(\frac{\hat I_b-\hat I_a\cos\delta}{\sin\delta},\hat I_a\right),"
            r"\quad\hat I=\frac{I-\bar I}{c_1},\;\delta=\frac{2\pi s}{\Lambda}",
            "6.3 in words",
        ),
        Equation("displacement", r"x=x_0+\frac{\Lambda}{2\pi}\,\mathrm{unwrap}\,\varphi"),
    )

    class Params(SensorParams):
        """Its assumptions about the pair."""

        spacing_um: float = parameter(1.0, "distance between the beams it assumes", "um", ge=0.01, le=100)

    class Packed(Record):
        """Mean and amplitude of the light, cosine and sine of the phase between the beams, pitch and offset."""

        mean: float
        amplitude: float
        cosine: float
        sine: float
        pitch: float
        offset: float

    class State(Record):
        """Whether it has run, and the unwrapped phase in turns."""

        started: float
        turns: float

    class Ports(BlockPorts):
        """Reads the pair; writes its phase as a displacement."""

        last: float = LAST_PORT
        first: float = reads("dual_beam.first", "1", "light of the first beam")
        second: float = reads("dual_beam.second", "1", "light of the second beam")
        true: float = TRUE_PORT
        displacement: float = RECOVERED_PORT
        error: float = ERROR_PORT
        turn: float = tap("1", "phase of the pair, in turns from -1/2 to 1/2")
        slips: float = SLIPS_PORT

    @classmethod
    def noise_um(cls, params: Any, context: Context) -> float:
        """Return the noise of the phase as displacement."""
        pair = calibrated(context, "dual_beam", DualBeam.Params)
        return pair.phase_noise_um / abs(separation(params.spacing_um, pair.pitch_um)[1])

    @classmethod
    def ambiguity_um(cls, params: Any, context: Context) -> float:
        """Return the pitch of the grating it looks at."""
        return calibrated(context, "dual_beam", DualBeam.Params).pitch_um

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the parameters for the step, with the grating as calibrated."""
        pair = calibrated(context, "dual_beam", DualBeam.Params)
        p = cls.Packed.blank()
        p.mean, p.amplitude = pair.mean, pair.harmonics[0]
        p.cosine, p.sine = separation(params.spacing_um, pair.pitch_um)
        p.pitch, p.offset = pair.pitch_um, pair.offset(context.seed)
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Take the phase of the pair and unwrap it."""
        cosine = (x.first - p.mean) / p.amplitude
        # the second beam measures cos(phase - delta)
        sine = ((x.second - p.mean) / p.amplitude - p.cosine * cosine) / p.sine
        if math.isfinite(cosine) and math.isfinite(sine):
            if s.started == 0.0:
                s.started = 1.0
                s.turns = (begin_at(x.last) - p.offset) / p.pitch
            turn = atan2(sine, cosine) / TWO_PI
            s.turns = turn + floor(s.turns - turn + 0.5)
            x.turn = turn
            x.displacement = p.offset + p.pitch * s.turns
        error = x.displacement - x.true
        x.error = error
        x.slips = slips(error, p.pitch)
