"""Resonant control: an internal model of the tone and its harmonics removes a periodic error."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, Context, Equation, Oscillator, Stage, parameter
from core.control.controller import unsuited_second_order
from core.control.nominal import Following, FollowingPorts, KnownParams, followed, following, known, over_sample
from core.elementary import cos, sin
from core.kernel import flush_tiny
from core.ports import tap
from core.record import Choice, Record, Vector, vector

MOST = 8
"""Harmonics."""


class Resonant(Block):
    r"""A resonator for each harmonic of the reference's tone (Francis and Wonham 1976; repetitive with all of them).

    .. math:: \xi_n\leftarrow e^{jn\omega h}\xi_n+h\,e,\qquad
        u=u_m+\sum_n 2g\,\mathrm{Re}\Bigl\{\frac{\xi_n}{P(e^{jn\omega h})}\Bigr\},\qquad e=y_m-y

    P is the nominal device at the harmonic, so that the error of every harmonic decays with the rate g as long as the
    phase of the true device differs from its phase by less than 90 degrees. A reference without
    a tone has one resonator at 0 Hz, an integrator.
    """

    title = "Resonant"
    place = 5
    equations = (
        Equation("internal model", r"\xi_n\leftarrow e^{jn\omega h}\xi_n+h\,e,\quad e=y_m-y"),
        Equation("law", r"u=u_m+\sum_n2g\,\mathrm{Re}\{\xi_n/P(e^{jn\omega h})\}"),
    )
    structure = (
        Stage("Internal model", "model measured", "error correction", ("internal model",)),
        Stage("Law", "reference model model_velocity correction", "voltage", ("law",)),
    )
    weaknesses = (
        "Where a fault turns the phase of the device at the tone by more than 90 degrees, as a shift of a sharp "
        "resonance across the tone does, the correction grows and the loop is unstable.",
        "It removes the error at its own harmonics alone: noise stays, and the harmonics next to them grow by a tenth.",
    )

    class Params(KnownParams):
        """The assumed device, number of harmonics, and how fast their errors decay."""

        harmonics: int = parameter(1, "harmonics of the tone", ge=1, le=MOST, live=False)
        rate: float = parameter(0.2, "rate of decay of the error, over the decay of the device itself", gt=0, le=2)

    class Packed(Record):
        """Number of resonators, sample interval, the voltage of the model's motion.

        Then, real and imaginary part, the turn of each resonator in a sample, its weight in the voltage, and the part
        of a volt that was not applied that it gives up.
        """

        count: Choice
        dt_ms: float
        following: Following
        turn_real: Vector = vector(MOST)
        turn_imaginary: Vector = vector(MOST)
        weight_real: Vector = vector(MOST)
        weight_imaginary: Vector = vector(MOST)
        back_real: Vector = vector(MOST)
        back_imaginary: Vector = vector(MOST)

    class State(Record):
        """The last voltage of this law, whether it drove, and the resonators."""

        voltage: float
        drove: float
        real: Vector = vector(MOST)
        imaginary: Vector = vector(MOST)

    class Ports(FollowingPorts):
        """Ports of a controller, the velocity of the model, the error, and the part of the resonators."""

        error: float = tap("um", "model minus measured displacement")
        correction: float = tap("V", "voltage of the resonators")

    @classmethod
    def unsuited(cls, device: Oscillator, model: Oscillator) -> str:
        """Refuse devices without mass, and models that do not come to rest."""
        return unsuited_second_order(device, model)

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the resonators below half the sample rate; samples do not show faster tones."""
        device, tone = known(params, context), 1e-3 * context.tone_hz * context.dt_ms
        p = cls.Packed.zeros()
        p.dt_ms = context.dt_ms
        if device.force == 0.0:
            return p  # nothing moves this device
        p.following = following(device, context.model)
        decay = max(0.5 * device.damping / device.mass, 1e-3 * device.natural_frequency)
        own = over_sample(device, context)
        trace, determinant = own.phi11 + own.phi22, own.phi11 * own.phi22 - own.phi12 * own.phi21
        p.count = sum(n * tone < 0.5 for n in range(1, params.harmonics + 1)) if tone > 0.0 else 1.0
        for i in range(int(p.count)):
            c, s = cos(2.0 * math.pi * (i + 1) * tone), sin(2.0 * math.pi * (i + 1) * tone)
            # 1/P of the sampled device, a quotient of two polynomials of z = c + js
            above, above_imaginary = (c - own.phi22) * own.push1 + own.phi12 * own.push2, s * own.push1
            below, below_imaginary = c * c - s * s - trace * c + determinant, 2.0 * c * s - trace * s
            inverse = _quotient(below, below_imaginary, above, above_imaginary)
            response = _quotient(above, above_imaginary, below, below_imaginary)
            gain = (2.0 if tone > 0.0 else 1.0) * params.rate * decay
            back = 2.0 * decay * context.dt_ms / gain
            p.turn_real[i], p.turn_imaginary[i] = c, s
            p.weight_real[i], p.weight_imaginary[i] = gain * inverse[0], gain * inverse[1]
            p.back_real[i], p.back_imaginary[i] = back * response[0], back * response[1]
        return p

    @staticmethod
    def step(p: Packed, s: State, x: Ports) -> None:
        """Give up the voltage that the drive could not apply, turn the resonators, add the error, compute the voltage.

        While another law drives, all resonators are zero.
        """
        e = x.model - x.measured
        x.error = e
        missed = s.voltage - x.applied if s.drove != 0.0 else 0.0
        s.drove = x.engaged
        if not math.isfinite(e):
            e = 0.0
        if x.engaged == 0.0:
            e = 0.0
            missed = 0.0
            for i in range(int(p.count)):
                s.real[i] = 0.0
                s.imaginary[i] = 0.0
        correction = 0.0
        for i in range(int(p.count)):
            real = s.real[i] - p.back_real[i] * missed
            imaginary = s.imaginary[i] - p.back_imaginary[i] * missed
            turned = p.turn_real[i] * real - p.turn_imaginary[i] * imaginary
            s.imaginary[i] = flush_tiny(p.turn_imaginary[i] * real + p.turn_real[i] * imaginary)
            s.real[i] = flush_tiny(turned + p.dt_ms * e)
            correction += p.weight_real[i] * s.real[i] - p.weight_imaginary[i] * s.imaginary[i]
        s.voltage = followed(p.following, x) + correction
        x.voltage = s.voltage
        x.correction = correction


def _quotient(above: float, above_imaginary: float, below: float, below_imaginary: float) -> tuple[float, float]:
    """Return real and imaginary part of a quotient, 0 where it has no value: then the resonator has no effect."""
    square = below * below + below_imaginary * below_imaginary
    if square == 0.0:
        return 0.0, 0.0
    real = (above * below + above_imaginary * below_imaginary) / square
    return real, (above_imaginary * below - above * below_imaginary) / square
