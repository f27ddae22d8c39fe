"""Open-loop read-out: the rate from the swing of y, demodulated by the phase of x."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, BlockParams, Context, Equation, Stage, parameter
from core.control.two_axis import RatePorts, Sense, components, fill_sense, share_kept, two_axis
from core.elementary import cos, sin
from core.kernel import kernel
from core.ports import output, tap
from core.record import Record
from core.units import PM_PER_UM


class ReadPorts(RatePorts):
    """Ports of a read-out of the swing of y."""

    quadrature: float = output("deg/s", "cross stiffness, read as a rate")
    swing: float = tap("pm", "amplitude of y")


class FilteredComponents(Record):
    """Components of y, each behind two low-passes."""

    first_in_step: float
    first_with_velocity: float
    in_step: float
    with_velocity: float


class ReadOut(Record):
    """The sense axis, share kept by the low-passes, the carrier turned by an error of the phase."""

    sense: Sense
    kept: float
    turn_cosine: float
    turn_sine: float
    corrected: float


@kernel
def read(p: ReadOut, s: FilteredComponents, x: ReadPorts) -> None:
    """Demodulate y and write the rate that follows from it."""
    omega = x.frequency * 6.283185307179586e-3
    sine = x.sine * p.turn_cosine + x.cosine * p.turn_sine
    cosine = x.cosine * p.turn_cosine - x.sine * p.turn_sine
    in_step, with_velocity = components(x.y_measured, x.y_velocity, omega, sine, cosine)
    s.first_in_step += (1.0 - p.kept) * (in_step - s.first_in_step)
    s.first_with_velocity += (1.0 - p.kept) * (with_velocity - s.first_with_velocity)
    s.in_step += (1.0 - p.kept) * (s.first_in_step - s.in_step)
    s.with_velocity += (1.0 - p.kept) * (s.first_with_velocity - s.with_velocity)
    # the force that causes this swing of the nominal sense axis, over the amplitude of x
    spring = p.sense.spring - x.softening
    force_cosine = spring * s.with_velocity
    force_sine = spring * s.in_step
    if p.corrected != 0.0:
        force_cosine += p.sense.damper * s.in_step
        force_sine -= p.sense.damper * s.with_velocity
    swing = math.sqrt(s.in_step * s.in_step + s.with_velocity * s.with_velocity)
    x.swing = PM_PER_UM * swing
    if x.amplitude > 1e-6:
        x.rate = -p.sense.dps * force_cosine / x.amplitude
        x.quadrature = -p.sense.dps * force_sine / x.amplitude


def fill_read_out(p: ReadOut, params: Any, context: Context) -> None:
    """Pack the sense axis, the low-passes and the error of the phase."""
    fill_sense(p.sense, two_axis(context))
    p.kept = share_kept(1e3 / (6.283185307179586 * params.bandwidth_hz), context.dt_ms)
    error = params.phase_error_deg * 3.141592653589793 / 180.0
    p.turn_cosine, p.turn_sine, p.corrected = cos(error), sin(error), float(params.correct_phase)


class OpenLoopRate(Block):
    r"""Reads the rate from the swing of y, with no force on it.

    .. math:: y=Y_s\sin\theta+Y_c\cos\theta,\quad
        \hat\Omega=-\frac{\mathrm{Re}\,G\,Y_c}{2m_c\omega A},\quad
        \hat\Omega_q=-\frac{\mathrm{Re}\,G\,Y_s}{2m_c\omega A},\quad
        G=k_{yy}-m_y\omega^2+j\omega d_{yy}

    The part in step with the velocity of x is taken for the rate, the part in step with x for the quadrature. The
    damping of y turns a little of the quadrature into the rate: without rotation it reads
    :math:`[d_{xy}-k_{xy}d_{yy}/(k_{yy}-m_y\omega^2)]/2m_c`. ``correct_phase`` turns it back by the phase of the nominal
    sense axis; the rest is the cross damping, which is indistinguishable from a rate. An error :math:`\varphi` of the
    phase reads :math:`\Omega\cos\varphi-\Omega_q\sin\varphi`.
    """

    title = "Open-loop read-out"
    place = 18
    axes = ("x", "y")
    slot = "sense"
    equations = (
        Equation("rate", r"\hat\Omega=-\frac{(k_{yy}-m_y\omega^2)\,Y_c}{2m_c\omega A}", "6.1.2"),
        Equation(
            "zero rate",
            r"\Omega_0=\frac{1}{2m_c}\left[d_{xy}-\frac{k_{xy}d_{yy}}{k_{yy}-m_y\omega^2}\right]",
            "6.1.2, zero-rate output",
        ),
        Equation("error of the phase", r"\hat\Omega=\Omega\cos\varphi-\Omega_q\sin\varphi"),
    )
    structure = (
        Stage("Demodulation", "y_measured y_velocity frequency", "in_step with_velocity swing"),
        Stage(
            "Rate",
            "in_step with_velocity amplitude frequency",
            "rate quadrature",
            ("rate", "zero rate", "error of the phase"),
        ),
    )
    weaknesses = (
        "Without rotation it reads the zero rate of the nominal device as a rate, -43 deg/s on set A and 1710 on "
        "set B, and nothing says by how much the rate is off.",
        "A drift of the sense frequency is a drift of the scale factor: 1 % of stiffness is 37 % of it at a split of "
        "53 Hz.",
    )

    class Params(BlockParams):
        """Demodulation."""

        bandwidth_hz: float = parameter(20.0, "bandwidth of each of two low-passes", "Hz", gt=0, le=1e5)
        phase_error_deg: float = parameter(0.0, "error of the phase of the demodulation", "deg", ge=-180, le=180)
        correct_phase: bool = parameter(False, "turn y back by the phase of the nominal sense axis")

    class Packed(ReadOut):
        """The read-out."""

    class State(FilteredComponents):
        """The components of y."""

    class Ports(ReadPorts):
        """Ports of the read-out."""

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the read-out."""
        p = cls.Packed.blank()
        fill_read_out(p, params, context)
        return p

    @staticmethod
    def step(p: Packed, s: State, x: OpenLoopRate.Ports) -> None:
        """Read y."""
        read(p, s, x)
