"""Whole-angle read-out: the line of oscillation stays where it is while the device turns under it."""

from __future__ import annotations

import math
from typing import Any

from core.block import Block, BlockParams, Context, Equation, Stage, parameter
from core.control.two_axis import TwoAxisMeasuredPorts, share_kept, two_axis
from core.elementary import atan2, cos, floor, sin
from core.ports import output, tap
from core.record import Record
from core.units import RAD_MS_PER_DEG_S

BEGUN = 1e-6
"""Share of the energy below which the swing has to be begun."""
KICK = 1e-2
"""Push that begins it, over that which holds the elastic force at the amplitude."""


class WholeAngle(Block):
    r"""Lets the mass swing along a line that keeps its direction in space; the angle of the line is the angle turned.

    .. math:: \tau=(K-\omega^2+\hat R)q+D\dot q-\gamma\frac{E-E_0}{E_0}\dot q-\kappa\frac{2P}{A^2}Sq,\quad
        E=\tfrac12(|\dot q|^2+\omega^2|q|^2),\;P=x\dot y-y\dot x

    .. math:: \tan2\psi=\frac{2(xy+\dot x\dot y/\omega^2)}{x^2-y^2+(\dot x^2-\dot y^2)/\omega^2},\quad
        \hat\Omega=-\dot\psi/\kappa_m

    Nominal stiffness and damping are tuned away, so that both axes are alike. Energy control holds the amplitude, and
    the force along :math:`Sq` keeps the orbit a line, of area 0. A remaining stiffness difference, as after a fault,
    opens the orbit; the mode tuning learns it, :math:`\dot{\hat b}=-\rho P(x^2-y^2),\;\dot{\hat a}=2\rho Pxy` with
    :math:`\hat R=\begin{bmatrix}a&b\\b&-a\end{bmatrix}`. Unequal damping that is left makes the line drift. All forces
    are computed for half a sample later, because a held force is late by this time, and raised by the loss of holding.
    With two masses the line is straight, and turns evenly, in :math:`q=(x,y\sqrt{m_y/m_x})`; the angular gain is
    :math:`\kappa_m=m_c/\sqrt{m_xm_y}`, 1 for one mass.
    """

    title = "Whole-angle read-out"
    place = 21
    axes = ("x", "y")
    slot = "sense"
    equations = (
        Equation(
            "law",
            r"\tau=(K-\omega^2+\hat R)q+D\dot q-\gamma\frac{E-E_0}{E_0}\dot q-\kappa\frac{2P}{A^2}Sq",
            "Park, Horowitz, Tan 2008",
        ),
        Equation("angle", r"\tan2\psi=\frac{2(xy+\dot x\dot y/\omega^2)}{x^2-y^2+(\dot x^2-\dot y^2)/\omega^2}"),
        Equation("precession", r"\psi(t)=\psi(0)-\int_0^t\Omega\,dt"),
    )
    structure = (
        Stage("Orbit", "x_measured y_measured x_velocity y_velocity", "angle energy area", ("angle",)),
        Stage("Precession", "angle", "rate", ("precession",)),
        Stage("Tuning", "area x_measured y_measured", "tuning_a tuning_b"),
        Stage("Law", "energy area tuning_a tuning_b x_measured y_measured x_velocity y_velocity", "x y", ("law",)),
    )
    weaknesses = (
        "A damping that a fault makes unequal turns the line as a rate does, up to half the difference.",
        "A held force tunes modes that are far apart only roughly: with 674 Hz between them 100 deg/s reads 4 % high "
        "at 100 kHz, 0.24 % at 200 kHz and 0.01 % at 500 kHz.",
        "Modes of 18 kHz are too fast to be tuned at 100 kHz: set B reads almost nothing of any rate, and nothing says "
        "so; at 1 MHz it reads within 3 deg/s.",
    )

    class Params(BlockParams):
        """Amplitude and gains."""

        amplitude_um: float | None = parameter(
            None, "amplitude to hold; the device's own unless given", "um", gt=0, le=100
        )
        energy_gain_per_ms: float = parameter(0.2, "gain gamma of the energy", "1/ms", ge=0, le=100)
        area_gain_per_ms: float = parameter(0.2, "gain kappa of the area", "1/ms", ge=0, le=100)
        tuning_gain: float = parameter(0.0, "gain rho of the mode tuning", "1/(um^4 ms^2)", ge=0, le=1e4)
        bandwidth_hz: float = parameter(20.0, "bandwidth of the low-pass behind the rate", "Hz", gt=0, le=1e5)

    class Packed(Record):
        """Device per mass, target, gains, half a sample, masses, stretch of y, low-pass, angular gain."""

        kxx: float
        kxy: float
        kyy: float
        dxx: float
        dxy: float
        dyy: float
        omega: float
        amplitude: float
        energy: float
        energy_gain: float
        area_gain: float
        tuning: float
        cosine: float
        sine: float
        mass_x: float
        mass_y: float
        stretch: float
        dt_ms: float
        kept: float
        angular_gain: float

    class State(Record):
        """Angle in half turns so far, last angle of the orbit, mode tuning, rate; whether there is an angle."""

        half_turns: float
        last: float
        a: float
        b: float
        rate: float
        begun: float

    class Ports(TwoAxisMeasuredPorts):
        """Forces along both axes, the angle and the rate."""

        x: float = output("uN", "force along x this controller asks for")
        y: float = output("uN", "force along y this controller asks for")
        rate: float = output("deg/s", "rate by which the line of oscillation turns back")
        angle: float = output("deg", "angle of the line of oscillation against x, turns counted")
        energy: float = tap("1", "energy over the one asked for")
        area: float = tap("um^2", "area of the orbit, signed")
        tuning_a: float = tap("1/ms^2", "learned difference of the stiffness of the axes over the mass, half of it")
        tuning_b: float = tap("1/ms^2", "learned cross stiffness over the mass")

    @classmethod
    def pack(cls, params: Any, context: Context) -> Packed:
        """Pack the compensation, and the gains."""
        device = two_axis(context)
        p = cls.Packed.blank()
        mean = math.sqrt(device.mass * device.mass_y)
        p.stretch = mean / device.mass
        p.angular_gain = device.coriolis_mass / mean
        p.omega = omega = device.drive_frequency
        p.amplitude = params.amplitude_um or device.amplitude
        p.energy = 0.5 * (omega * p.amplitude) ** 2
        p.kxx = device.stiffness / device.mass - omega * omega
        p.kyy = device.stiffness_y / device.mass_y - omega * omega
        p.kxy = device.stiffness_xy / mean
        p.dxx, p.dyy = device.damping / device.mass, device.damping_y / device.mass_y
        p.dxy = device.damping_xy / mean
        p.energy_gain, p.area_gain = params.energy_gain_per_ms, params.area_gain_per_ms
        p.tuning, p.dt_ms = params.tuning_gain * context.dt_ms, context.dt_ms
        half = 0.5 * omega * context.dt_ms
        p.cosine, p.sine = cos(half), sin(half)
        held = sin(half) / half
        p.mass_x, p.mass_y = device.mass / held, mean / held
        p.kept = share_kept(1e3 / (2.0 * math.pi * params.bandwidth_hz), context.dt_ms)
        return p

    @staticmethod
    def step(p: Packed, s: State, x: WholeAngle.Ports) -> None:
        """Read the orbit, and hold its energy and its shape."""
        w = p.omega
        q1, q2, v1, v2 = x.x_measured, p.stretch * x.y_measured, x.x_velocity, p.stretch * x.y_velocity
        energy = 0.5 * (v1 * v1 + v2 * v2 + w * w * (q1 * q1 + q2 * q2)) / p.energy
        area = q1 * v2 - q2 * v1
        if energy > BEGUN:
            across = 2.0 * (q1 * q2 + v1 * v2 / (w * w))
            turn = atan2(across, q1 * q1 - q2 * q2 + (v1 * v1 - v2 * v2) / (w * w)) / (2.0 * math.pi)
            change = turn - s.last
            change -= floor(change + 0.5)
            if s.begun == 0.0:
                s.begun = 1.0
                change = turn
            else:
                precession = -math.pi * change / (p.angular_gain * p.dt_ms)
                s.rate += (1.0 - p.kept) * (precession - s.rate)
            s.half_turns += change
            s.last = turn
            if x.engaged != 0.0:
                s.a += 2.0 * p.tuning * area * q1 * q2
                s.b -= p.tuning * area * (q1 * q1 - q2 * q2)
        x.angle = 180.0 * s.half_turns
        x.rate = s.rate / RAD_MS_PER_DEG_S
        x.energy = energy
        x.area = math.pi * area / w
        x.tuning_a = s.a
        x.tuning_b = s.b
        # half a sample later
        a1 = p.cosine * q1 + p.sine / w * v1
        a2 = p.cosine * q2 + p.sine / w * v2
        b1 = p.cosine * v1 - w * p.sine * q1
        b2 = p.cosine * v2 - w * p.sine * q2
        grow = -p.energy_gain * (energy - 1.0)
        straight = -2.0 * p.area_gain * area / (p.amplitude * p.amplitude)
        along = (p.kxx + s.a) * a1 + (p.kxy + s.b) * a2 + (p.dxx + grow) * b1 + p.dxy * b2 - straight * a2
        aside = (p.kxy + s.b) * a1 + (p.kyy - s.a) * a2 + p.dxy * b1 + (p.dyy + grow) * b2 + straight * a1
        if energy <= BEGUN:
            along += KICK * w * w * p.amplitude
        x.x = p.mass_x * along
        x.y = p.mass_y * aside
