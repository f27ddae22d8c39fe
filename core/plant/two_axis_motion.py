r"""Motion along two axes of a plane that turns, by the power series of the solution."""

from __future__ import annotations

import math

from core.kernel import kernel
from core.noise import normal
from core.plant.two_axis_body import TwoAxisBody, TwoAxisMotion


@kernel
def advance(b: TwoAxisBody, s: TwoAxisMotion, rate: float, tick: float) -> None:
    r"""Advance over the sample that starts at ``tick``, with the rate held.

    .. math:: a_{n+2}=\frac{M^{-1}\left[h^2f_n-(n+1)\,h\,(D+2m_c\Omega S)\,a_{n+1}-h^2K\,a_n\right]}{(n+1)(n+2)},
        \quad q(t)=\sum_na_n(t/h)^n

    Parameters
    ----------
    b, s
        Nominal device; the device as it is now, with its motion.
    rate : float
        Omega, rad/ms.
    tick : float
        Counts the thermal noise, which has the covariance :math:`2k_BTD`.
    """
    h, parts, terms = b.part_ms, int(b.parts), int(b.terms)
    swirl = 2.0 * s.coriolis_mass * rate
    hx, hy = h / s.mass_x, h / s.mass_y
    d11, d12 = hx * s.damping_x, hx * (s.damping_xy - swirl)
    d21, d22 = hy * (s.damping_xy + swirl), hy * s.damping_y
    hx, hy = h * hx, h * hy
    k11, k12 = hx * s.stiffness_x, hx * s.stiffness_xy
    k21, k22 = hy * s.stiffness_xy, hy * s.stiffness_y
    root_x = math.sqrt(max(s.damping_x, 0.0))
    cross = s.damping_xy / root_x if root_x > 0.0 else 0.0
    root_y = math.sqrt(max(s.damping_y - cross * cross, 0.0))
    share = 1.0 / parts
    for part in range(parts):
        at = part * share
        noise_x, noise_y = 0.0, 0.0
        if b.thermal_x > 0.0:
            count = tick * parts + part
            first, second = normal(b.key_x, count), normal(b.key_y, count)
            noise_x = b.thermal_x * root_x * first
            noise_y = b.thermal_y * (cross * first + root_y * second)
        fx0 = hx * (s.force_x + at * (s.rise_x + at * s.bend_x) + noise_x)
        fy0 = hy * (s.force_y + at * (s.rise_y + at * s.bend_y) + noise_y)
        fx1 = hx * share * (s.rise_x + 2.0 * at * s.bend_x)
        fy1 = hy * share * (s.rise_y + 2.0 * at * s.bend_y)
        fx2, fy2 = hx * share * share * s.bend_x, hy * share * share * s.bend_y
        x0, y0 = s.x, s.y
        x1, y1 = h * s.x_velocity, h * s.y_velocity
        sum_x, sum_y, slope_x, slope_y = x0 + x1, y0 + y1, x1, y1
        for n in range(2, terms + 1):
            # fx0 is the coefficient of the force that this term needs; behind the parabola they are 0
            even, odd = 1.0 / (n * (n - 1)), 1.0 / n
            x2 = even * (fx0 - k11 * x0 - k12 * y0) - (odd * d11 * x1 + odd * d12 * y1)
            y2 = even * (fy0 - k21 * x0 - k22 * y0) - (odd * d21 * x1 + odd * d22 * y1)
            sum_x += x2
            sum_y += y2
            slope_x += n * x2
            slope_y += n * y2
            x0, y0, x1, y1 = x1, y1, x2, y2
            fx0, fy0, fx1, fy1, fx2, fy2 = fx1, fy1, fx2, fy2, 0.0, 0.0
        s.x, s.y = sum_x, sum_y
        s.x_velocity, s.y_velocity = slope_x / h, slope_y / h
