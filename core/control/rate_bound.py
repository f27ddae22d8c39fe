r"""The bound on the error of a constant rate, from the estimates of an adaptive controller of two axes.

.. math:: B=2\Delta_\Omega+2\,|\tilde\Omega|+s\,|\hat\Omega|+2\,(\Omega_D+\Omega_n)

- :math:`\Delta_\Omega`: the swing of the rate in the last whole beats, 50 ms at least.
- :math:`\tilde\Omega`: the part that is not learned yet. The changes of :math:`\hat k_{xy},\hat n,\hat
  d_{xy},\hat\Omega` over these beats, over their gains, are the means of the products :math:`\dot e^Tq_r,\;\dot e^T\dot
  q_r`, and so the part of each velocity error that has the frequency of the other axis, as phasor :math:`E`. The force
  that would remove it is :math:`E_i\,(\gamma-j(k_i-\omega^2)/\omega)`, with the :math:`k_i` of the axis, or of the
  model put in its place. A force along y and x proportional to :math:`\pm2\omega A` of the other axis is a rate.
- :math:`s,\Omega_D`: the remaining errors of holding the force. Beyond the compensation of the law, a held force acts
  as :math:`Z+\epsilon ZPZ` on the device :math:`Z(j\omega)=K-\omega^2+j\omega(D+2\Omega S)`, with
  :math:`\epsilon=h^4/720,\;P=K+3\omega^2-3j\omega(D+2\Omega S)`. Of that a share of the rate is at most
  :math:`s=\epsilon(k_{xx}+k_{yy}+\omega_x^2+\omega_y^2)^2`, and the damping reads as
  :math:`\Omega_D=\tfrac54\epsilon\,|\omega_y^2-\omega_x^2|\,|KD+DK|_{xy}`.
- :math:`\Omega_n=\tfrac14h^2\sqrt{\omega_x\omega_y}\,|\hat n|`, for a law that multiplies by the measured motion: the
  periodic part of the deviation is measured at a sample and acts half a sample later. The factor is measured on set B.

The swing and the learning hold the thermal noise as well. Masses, forces and sensors count as nominal: an error of
theirs is an error of the scale, and the bound does not hold it. The claim is withdrawn as soon as the rate has gone
twice as far, so a rate that changes is not trusted until whole beats agree again.
"""

from __future__ import annotations

import math

from core.control.two_axis_estimates import AxisEstimates, Basis, Gains, HeldTones, PackedLaw, TwoAxisEstimatePorts
from core.kernel import kernel
from core.units import RAD_MS_PER_DEG_S

SHARE = 0.25
"""Most that the bound of a trusted rate is of the rate."""
SHORTEST_MS = 50.0
"""The least time over which changes are looked at, in whole beats."""
SLOW_MS = 100.0
"""A beat that takes longer contains too little information."""
UNKNOWN_DPS = 1e6
"""Bound while nothing can be said, deg/s: 2800 turns a second."""


def fill_basis(p: Basis, a: HeldTones, g: Gains, dt_ms: float, cancels: bool) -> None:
    """Pack the bounds of the rate; ``cancels``: the law multiplies by the measured motion, with a model in place."""
    p.exciting = a.beat_ms <= SLOW_MS and min(g.stiffness, g.damping, g.rate) > 0.0
    p.beats_ms, p.of_stiffness, p.of_damping, p.of_rate = math.inf, 0.0, 0.0, 0.0
    if p.exciting:
        p.beats_ms = math.ceil(SHORTEST_MS / a.beat_ms) * a.beat_ms
        samples = p.beats_ms / dt_ms
        p.of_stiffness, p.of_damping, p.of_rate = (1.0 / (gain * samples) for gain in (g.stiffness, g.damping, g.rate))
    h = dt_ms / a.unit_ms
    p.cancelled, p.held = cancels, h * h * h * h / 720.0
    p.repeats = 0.25 * h * h * math.sqrt(a.omega_x * a.omega_y) if cancels else 0.0


@kernel
def unlearned(p: PackedLaw, s: AxisEstimates) -> float:
    """Return the rate that is still to be learned, from the changes since the beats began."""
    a, c = p.asked, s.claim
    stiffness, skew = p.basis.of_stiffness * (c.kxy - s.kxy), p.basis.of_stiffness * (c.skew - s.skew)
    damping, rate = p.basis.of_damping * (c.dxy - s.dxy), 0.5 * p.basis.of_rate * (c.omega - s.omega)
    square_x, square_y = a.omega_x * a.omega_x, a.omega_y * a.omega_y
    kxx, kyy = s.kxx, s.kyy
    if p.basis.cancelled != 0.0:
        kxx, kyy = square_x, square_y
    speed_x, speed_y = a.amplitude_x * a.omega_x, a.amplitude_y * a.omega_y
    # the velocity error of x at the frequency of y, and the velocity error of y at the frequency of x
    along = 2.0 * (p.gains.velocity * (damping - rate) - (kxx - square_y) * (stiffness - skew)) / (speed_y * speed_y)
    across = 2.0 * (p.gains.velocity * (damping + rate) - (kyy - square_x) * (stiffness + skew)) / (speed_x * speed_x)
    return 0.25 * abs(across - along)


@kernel
def misread(p: PackedLaw, s: AxisEstimates) -> float:
    """Return the rate error of holding the force, as far as the law does not compensate it."""
    a = p.asked
    square_x, square_y = a.omega_x * a.omega_x, a.omega_y * a.omega_y
    stiff = abs(s.kxx) + abs(s.kyy)
    both = stiff + square_x + square_y
    mixed = abs(s.kxy) * (abs(s.dxx) + abs(s.dyy)) + abs(s.dxy) * stiff
    offset = 1.25 * p.basis.held * abs(square_y - square_x) * mixed + p.basis.repeats * abs(s.skew)
    return p.basis.held * both * both * abs(s.omega) + 2.0 * offset


@kernel
def judge(p: PackedLaw, s: AxisEstimates, x: TwoAxisEstimatePorts) -> None:
    """Claim a bound after whole beats, withdraw it when the rate leaves it, and decide whether the rate is trusted."""
    c = s.claim
    over = x.time_ms - c.begun_ms >= p.basis.beats_ms
    if over and p.basis.exciting != 0.0:
        c.bound = 2.0 * (c.most - c.least) + 2.0 * unlearned(p, s) + misread(p, s)
        c.of = s.rate
        c.made = 1.0
    if x.engaged == 0.0 or abs(s.rate - c.of) > 2.0 * c.bound:
        c.made = 0.0
    if over or x.engaged == 0.0:
        c.begun_ms = x.time_ms
        c.kxy, c.skew, c.dxy, c.omega = s.kxy, s.skew, s.dxy, s.omega
        c.least = s.rate
        c.most = s.rate
    c.least = min(c.least, s.rate)
    c.most = max(c.most, s.rate)
    x.trusted = 1.0 if c.made != 0.0 and c.bound <= SHARE * abs(s.rate) else 0.0
    x.bound = UNKNOWN_DPS
    if c.made != 0.0:
        x.bound = min(c.bound / (p.angular_gain * p.asked.unit_ms * RAD_MS_PER_DEG_S), UNKNOWN_DPS)
