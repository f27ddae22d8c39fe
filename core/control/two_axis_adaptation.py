r"""The estimates that adaptive controllers of two axes share, and the law that adapts them.

.. math:: \dot{\hat K}=-g_K\,\mathrm{sym}(\dot e\,q_r^T),\quad\dot{\hat D}=-g_D\,\mathrm{sym}(\dot e\,\dot q_r^T),\quad
    \dot{\hat\Omega}=-g_\Omega\,\dot e^TS\dot q_r,\quad\dot{\hat n}=-\tfrac12g_K\,\dot e^TSq_r,\quad
    S=\begin{bmatrix}0&-1\\1&0\end{bmatrix}

:math:`q_r` is the factor of the estimates in the law: the desired motion, or the motion. Everything is per unit of
mass, with time in a unit that each controller names, and y is stretched by :math:`\sqrt{m_y/m_x}`, so that both axes
have one mass and turning pushes them alike, by :math:`m_c/\sqrt{m_xm_y}` of the rate. The estimates begin with 0: the
device is unknown.

A force is held for a sample h. The motion sees it half a sample late and weaker by :math:`\mathrm{sinc}(\omega h/2)`,
so the law takes the desired motion half a sample later, and larger by as much. The velocity ripples within a sample,
and where it is measured, at the edges, the ripple is :math:`-\tfrac1{12}h^2\dot F/m`; the law knows its force, and
takes that off the velocity error. Without both, set A at 100 kHz reads 12 to 39 deg/s too much at every rate. The
remaining error is proportional to the fourth power of the sample, see `rate_bound`.

With two frequencies the cross forces have eight components, and a device has seven parameters. The eighth is
:math:`nS`, an antisymmetric stiffness that no device has. It takes the rest of the model of the sample; without it the
rate swings with the beat by as much.
"""

from __future__ import annotations

import math
from typing import Any

from core.block import Context
from core.control.rate_bound import SLOW_MS, judge
from core.control.two_axis import share_kept, two_axis
from core.control.two_axis_estimates import AxisEstimates, Gains, HeldTones, PackedLaw, TwoAxisEstimatePorts
from core.elementary import sin, sin_of_turns
from core.kernel import kernel
from core.units import RAD_MS_PER_DEG_S


def fill_law(
    p: PackedLaw,
    params: Any,
    context: Context,
    um: tuple[float, float],
    hz: tuple[float, float],
    unit_ms: float,
    velocity_gain: float,
    stiffness_gain: float,
) -> None:
    """Pack the desired motion, with amplitudes in um and frequencies in Hz, gains in a unit of time, and forces."""
    device = two_axis(context)
    p.mass_x, p.mass_y, p.mean_mass = device.mass, device.mass_y, math.sqrt(device.mass * device.mass_y)
    p.stretch, p.angular_gain = p.mean_mass / device.mass, device.coriolis_mass / p.mean_mass
    p.force_x, p.force_y = device.mass / (unit_ms * unit_ms), p.mean_mass / (unit_ms * unit_ms)
    a, h = p.asked, context.dt_ms / unit_ms
    a.amplitude_x, a.amplitude_y, a.unit_ms = um[0], p.stretch * um[1], unit_ms
    a.cycles_x, a.cycles_y = 1e-3 * hz[0], 1e-3 * hz[1]
    a.omega_x, a.omega_y = 2.0 * math.pi * a.cycles_x * unit_ms, 2.0 * math.pi * a.cycles_y * unit_ms
    a.larger_x, a.larger_y = larger(0.5 * h * a.omega_x), larger(0.5 * h * a.omega_y)
    a.ahead_ms, a.ripple = 0.5 * context.dt_ms, h * h / 12.0
    a.beat_ms = 1.0 / abs(a.cycles_x - a.cycles_y) if a.cycles_x != a.cycles_y else math.inf
    p.kept = share_kept(1e3 / (2.0 * math.pi * params.bandwidth_hz), context.dt_ms)
    g = p.gains
    g.velocity, g.stiffness = velocity_gain, stiffness_gain * h
    g.damping, g.rate = params.cross_gain * h, params.rate_gain * h


def larger(half: float) -> float:
    """Return by how much a held sine is made larger, with half a sample in rad, up to two samples a period."""
    reach = min(half, 0.5 * math.pi)
    return reach / sin(reach)


@kernel
def asked(p: HeldTones, t: float) -> tuple[float, float, float, float]:
    """Return desired displacements at a time in ms, and velocities per unit of time."""
    x = p.cycles_x * t
    y = p.cycles_y * t
    return (
        p.amplitude_x * sin_of_turns(x),
        p.amplitude_y * sin_of_turns(y),
        p.amplitude_x * p.omega_x * sin_of_turns(x + 0.25),
        p.amplitude_y * p.omega_y * sin_of_turns(y + 0.25),
    )


@kernel
def held(p: HeldTones, t: float) -> tuple[float, float, float, float]:
    """Return the desired motion as a held force needs it: half a sample later, and larger."""
    q1, q2, v1, v2 = asked(p, t + p.ahead_ms)
    return p.larger_x * q1, p.larger_y * q2, p.larger_x * v1, p.larger_y * v2


@kernel
def velocity_errors(
    p: PackedLaw, s: AxisEstimates, x: TwoAxisEstimatePorts, q1: float, q2: float, v1: float, v2: float
) -> tuple[float, float]:
    """Return the errors of both velocities against the desired velocities, without the ripple of the held force."""
    a = p.asked
    square_x, square_y = a.omega_x * a.omega_x, a.omega_y * a.omega_y
    along, across = push(s, v1, v2, -square_x * q1, -square_y * q2)
    return (
        a.unit_ms * x.x_velocity - v1 + a.ripple * (along - square_x * v1),
        a.unit_ms * p.stretch * x.y_velocity - v2 + a.ripple * (across - square_y * v2),
    )


@kernel
def adapt(g: Gains, s: AxisEstimates, e1: float, e2: float, q1: float, q2: float, v1: float, v2: float) -> None:
    """Adapt the estimates to the velocity error ``e``, with the motion that the law multiplies them with."""
    s.kxx -= g.stiffness * e1 * q1
    s.kxy -= 0.5 * g.stiffness * (e1 * q2 + e2 * q1)
    s.kyy -= g.stiffness * e2 * q2
    s.skew -= 0.5 * g.stiffness * (e2 * q1 - e1 * q2)
    s.dxx -= g.damping * e1 * v1
    s.dxy -= 0.5 * g.damping * (e1 * v2 + e2 * v1)
    s.dyy -= g.damping * e2 * v2
    s.omega -= g.rate * (e2 * v1 - e1 * v2)


@kernel
def push(s: AxisEstimates, q1: float, q2: float, v1: float, v2: float) -> tuple[float, float]:
    r"""Return :math:`(\hat K+\hat nS)q+\hat D\dot q+2\hat\Omega S\dot q`."""
    return (
        s.kxx * q1 + (s.kxy - s.skew) * q2 + s.dxx * v1 + (s.dxy - 2.0 * s.omega) * v2,
        (s.kxy + s.skew) * q1 + s.kyy * q2 + (s.dxy + 2.0 * s.omega) * v1 + s.dyy * v2,
    )


@kernel
def write(p: PackedLaw, s: AxisEstimates, x: TwoAxisEstimatePorts) -> None:
    """Write the estimates, and their trust."""
    unit = p.asked.unit_ms
    s.rate += (1.0 - p.kept) * (s.omega - s.rate)
    judge(p, s, x)
    x.unexciting = 1.0 if p.asked.beat_ms > SLOW_MS and x.engaged != 0.0 else 0.0
    x.rate = s.rate / (p.angular_gain * unit * RAD_MS_PER_DEG_S)
    x.kxx = p.mass_x / (unit * unit) * s.kxx
    x.kxy = p.mean_mass / (unit * unit) * s.kxy
    x.kyy = p.mass_y / (unit * unit) * s.kyy
    x.skew = p.mean_mass / (unit * unit) * s.skew
    x.dxx = p.mass_x / unit * s.dxx
    x.dxy = p.mean_mass / unit * s.dxy
    x.dyy = p.mass_y / unit * s.dyy
