r"""The estimates that adaptive controllers of two axes share, and the law that adapts them.

.. math:: \dot{\hat K}=-g_K\,\mathrm{sym}(\dot e\,q_r^T),\quad\dot{\hat D}=-g_D\,\mathrm{sym}(\dot e\,\dot q_r^T),\quad
    \dot{\hat\Omega}=-g_\Omega\,\dot e^TS\dot q_r,\quad S=\begin{bmatrix}0&-1\\1&0\end{bmatrix}

:math:`q_r` is what the law multiplies the estimates with: the motion asked for, or the motion. Everything is per unit
of mass, with time in a unit that each controller names. The estimates begin with 0: nothing of the device is known.

Two frequencies tell the rate from the other estimates by their beat. The slower it is, the longer the estimates swing
with it, a rate far from the true one among them, and with one frequency there is none. The rate is therefore trusted
when it has kept still for a whole beat.
"""

from __future__ import annotations

import math
from typing import Any

from core.block import Context
from core.control.two_axis import MeasuredPorts, two_axis
from core.elementary import sin_of_turns
from core.kernel import inlined
from core.ports import output, tap
from core.record import Record
from core.units import RAD_MS_PER_DEG_S

STILL = 0.05
"""Most that a trusted rate changes within a beat, over itself, or near 0 over this share of its peak."""
SHORTEST_MS = 10.0
"""The least time to keep still for, however fast the beat."""
SLOW_MS = 100.0
"""A beat that takes longer tells too little."""
NOT_EXCITING = (
    "not persistently exciting: with one frequency along both axes, or two that hardly differ, nothing tells the rate "
    "from stiffness and damping; it is not trusted"
)


class Asked(Record):
    """Amplitudes, frequencies in turns per ms and in rad per unit of time, half a sample, the unit of time; a beat."""

    amplitude_x: float
    amplitude_y: float
    cycles_x: float
    cycles_y: float
    omega_x: float
    omega_y: float
    ahead_ms: float
    unit_ms: float
    beat_ms: float


class Gains(Record):
    """Gains per sample of stiffness, damping and rate, and that of the velocity error."""

    stiffness: float
    damping: float
    rate: float
    velocity: float


class Estimates(Record):
    """Stiffness, damping and rate, per unit of mass; begin of a beat, least and most rate in it, peak, trust."""

    kxx: float
    kxy: float
    kyy: float
    dxx: float
    dxy: float
    dyy: float
    omega: float
    begun_ms: float
    least: float
    most: float
    peak: float
    trusted: float


class PackedLaw(Record):
    """The motion asked for, gains, forces along x and y per unit of acceleration, mass."""

    asked: Asked
    gains: Gains
    force_x: float
    force_y: float
    mass: float


class EstimatePorts(MeasuredPorts):
    """Forces along both axes, the rate, and the other estimates."""

    x: float = output("uN", "force along x this controller asks for")
    y: float = output("uN", "force along y this controller asks for")
    rate: float = output("deg/s", "estimated angular rate")
    trusted: float = output("1", "1 while the motion asked for tells the rate, and it keeps still, else 0")
    error_x: float = tap("um", "displacement along x minus the one asked for")
    error_y: float = tap("um", "displacement along y minus the one asked for")
    kxx: float = tap("N/m", "estimated stiffness along x")
    kxy: float = tap("N/m", "estimated cross stiffness")
    kyy: float = tap("N/m", "estimated stiffness along y")
    dxx: float = tap("uN ms/um", "estimated damping along x")
    dxy: float = tap("uN ms/um", "estimated cross damping")
    dyy: float = tap("uN ms/um", "estimated damping along y")
    unexciting: float = tap("1", "1 while it drives with frequencies that hardly beat", warning=NOT_EXCITING)


def fill_law(p: PackedLaw, params: Any, context: Context, x_hz: float, y_hz: float, unit_ms: float) -> None:
    """Pack the motion asked for, with the usual frequencies, the gains and the forces, in a unit of time."""
    device = two_axis(context)
    a, x, y = p.asked, params.frequency_x_hz or x_hz, params.frequency_y_hz or y_hz
    a.amplitude_x, a.amplitude_y, a.unit_ms = params.amplitude_x_um, params.amplitude_y_um, unit_ms
    a.cycles_x, a.cycles_y = 1e-3 * x, 1e-3 * y
    a.omega_x, a.omega_y = 2.0 * math.pi * a.cycles_x * unit_ms, 2.0 * math.pi * a.cycles_y * unit_ms
    a.ahead_ms = 0.5 * context.dt_ms if params.advance else 0.0
    a.beat_ms = max(1.0 / abs(a.cycles_x - a.cycles_y), SHORTEST_MS) if a.cycles_x != a.cycles_y else math.inf
    g, h = p.gains, context.dt_ms / unit_ms
    g.stiffness, g.damping, g.rate = params.stiffness_gain * h, params.cross_gain * h, params.rate_gain * h
    g.velocity = params.velocity_gain
    p.force_x, p.force_y = device.mass / (unit_ms * unit_ms), device.mass_y / (unit_ms * unit_ms)
    p.mass = device.mass


@inlined
def asked(p: Asked, t: float) -> tuple[float, float, float, float]:
    """Return displacements asked for at a time in ms, and velocities per unit of time."""
    x = p.cycles_x * t
    y = p.cycles_y * t
    return (
        p.amplitude_x * sin_of_turns(x),
        p.amplitude_y * sin_of_turns(y),
        p.amplitude_x * p.omega_x * sin_of_turns(x + 0.25),
        p.amplitude_y * p.omega_y * sin_of_turns(y + 0.25),
    )


@inlined
def adapt(g: Gains, s: Estimates, e1: float, e2: float, q1: float, q2: float, v1: float, v2: float) -> None:
    """Adapt the estimates to the velocity error ``e``, with the motion that the law multiplies them with."""
    s.kxx -= g.stiffness * e1 * q1
    s.kxy -= 0.5 * g.stiffness * (e1 * q2 + e2 * q1)
    s.kyy -= g.stiffness * e2 * q2
    s.dxx -= g.damping * e1 * v1
    s.dxy -= 0.5 * g.damping * (e1 * v2 + e2 * v1)
    s.dyy -= g.damping * e2 * v2
    s.omega -= g.rate * (e2 * v1 - e1 * v2)


@inlined
def push(s: Estimates, q1: float, q2: float, v1: float, v2: float) -> tuple[float, float]:
    r"""Return :math:`\hat Kq+\hat D\dot q+2\hat\Omega S\dot q`."""
    return (
        s.kxx * q1 + s.kxy * q2 + s.dxx * v1 + (s.dxy - 2.0 * s.omega) * v2,
        s.kxy * q1 + s.kyy * q2 + (s.dxy + 2.0 * s.omega) * v1 + s.dyy * v2,
    )


@inlined
def judge(p: Asked, s: Estimates, x: EstimatePorts) -> None:
    """Say whether the rate is trusted: after every beat that it drives, by how much the rate has changed in it."""
    s.peak = max(s.peak, abs(s.omega))
    over = x.time_ms - s.begun_ms >= p.beat_ms
    if over:
        s.trusted = 1.0 if s.most - s.least <= STILL * max(abs(s.omega), STILL * s.peak) else 0.0
    if x.engaged == 0.0:
        s.trusted = 0.0
    if over or x.engaged == 0.0:
        s.begun_ms = x.time_ms
        s.least = s.omega
        s.most = s.omega
    s.least = min(s.least, s.omega)
    s.most = max(s.most, s.omega)
    x.trusted = s.trusted
    x.unexciting = 1.0 if p.beat_ms > SLOW_MS and x.engaged != 0.0 else 0.0


@inlined
def write(p: Asked, s: Estimates, x: EstimatePorts, mass: float) -> None:
    """Write the estimates."""
    per_square = mass / (p.unit_ms * p.unit_ms)
    per_unit = mass / p.unit_ms
    judge(p, s, x)
    x.rate = s.omega / (p.unit_ms * RAD_MS_PER_DEG_S)
    x.kxx = per_square * s.kxx
    x.kxy = per_square * s.kxy
    x.kyy = per_square * s.kyy
    x.dxx = per_unit * s.dxx
    x.dxy = per_unit * s.dxy
    x.dyy = per_unit * s.dyy
