r"""Co-energy of one comb with fingers off centre, and its derivatives.

A rotor finger is between two stator fingers at the gap :math:`g`; moved sideways by :math:`\eta` it has
:math:`1/(g-\eta)+1/(g+\eta)=2g/(g^2-\eta^2)` of capacitance per length and :math:`\varepsilon_0t`. A comb overlaps from
:math:`X_s` (stator tip) to :math:`X_r` (rotor tip), and with a rotation :math:`\eta` changes along it:

.. math:: C=n\varepsilon_0t\int_{X_s}^{X_r+x}\frac{2g\,d\xi}{g^2-\eta(\xi)^2},\quad
    \eta=y+\theta\xi,\quad W=\tfrac12V^2C

by five Gauss points, or three where they suffice. All forces are the derivatives of this very sum, so energy is
conserved exactly, even where the sum has an error. Beyond a limit the integrand continues as a straight line, because
the true one has no bound where fingers touch.
"""

from __future__ import annotations

from core.kernel import kernel

Z1, Z2 = 0.538469310105683091, 0.906179845938663993
W0, W1, W2 = 0.568888888888888889, 0.478628670499366468, 0.236926885056189088
"""Points and weights of the Gauss-Legendre rule with five points."""
Z = 0.774596669241483377
V0, V1 = 0.888888888888888889, 0.555555555555555556
TILT = 0.05
"""The same with three, accurate to 1e-9 while a finger tilts by less than this share of the remaining gap."""


@kernel
def point(square: float, limit: float, eta: float) -> tuple[float, float]:
    r"""Return :math:`r=1/(g^2-\eta^2)` and half its derivative, continued straight beyond the limit."""
    inside = min(max(eta, -limit), limit)
    r = 1.0 / (square - inside * inside)
    q = inside * r * r
    return r + 2.0 * q * (eta - inside), q


@kernel
def sums(
    square: float, limit: float, middle: float, half: float, y: float, theta: float
) -> tuple[float, float, float, float]:
    r"""Return the Gauss sums of :math:`r`, :math:`\eta r^2`, :math:`z\eta r^2`, and :math:`r` in the middle.

    Parameters
    ----------
    square, limit : float
        Gap squared, um^2, and the largest displacement at which the force law holds, um.
    middle, half : float
        Middle of the overlap on the x axis and half its length, um.
    y, theta : float
        Displacement at the origin, um, and rotation, rad, misalignment included.
    """
    e0 = y + theta * middle
    lever = theta * half
    if abs(lever) <= TILT * (limit - abs(e0)):
        e1 = e0 - lever * Z
        e2 = e0 + lever * Z
        d0 = square - e0 * e0
        d1 = square - e1 * e1
        d2 = square - e2 * e2
        both = d1 * d2
        inverse = 1.0 / (d0 * both)  # three reciprocals by one division
        r0 = inverse * both
        rest = inverse * d0
        r1 = rest * d2
        r2 = rest * d1
        q1 = e1 * (r1 * r1)
        q2 = e2 * (r2 * r2)
        return (
            V0 * r0 + V1 * (r1 + r2),
            V0 * (e0 * (r0 * r0)) + V1 * (q1 + q2),
            V1 * Z * (q2 - q1),
            r0,
        )
    r0, q0 = point(square, limit, e0)
    r1, q1 = point(square, limit, e0 - lever * Z1)
    r2, q2 = point(square, limit, e0 + lever * Z1)
    r3, q3 = point(square, limit, e0 - lever * Z2)
    r4, q4 = point(square, limit, e0 + lever * Z2)
    return (
        W0 * r0 + (W1 * (r1 + r2) + W2 * (r3 + r4)),
        W0 * q0 + (W1 * (q1 + q2) + W2 * (q3 + q4)),
        W1 * Z1 * (q2 - q1) + W2 * Z2 * (q4 - q3),
        r0,
    )


def co_energy(
    strength: float, square: float, limit: float, tips: tuple[float, ...], x: float, y: float, theta: float
) -> float:
    r"""Return the co-energy of both combs, uN um, for checks: the loop needs only its derivatives.

    Parameters
    ----------
    strength : float
        :math:`n\varepsilon_0tg`, uN um^2/V^2, which is :math:`\tfrac12C'g^2`.
    square, limit : float
        As in ``sums``.
    tips : tuple of float
        Stator and rotor tip, and the squared voltages across the combs at +x and at -x.
    x, y, theta : float
        Position of the shuttle, misalignment included.
    """
    stator, rotor, right, left = tips
    a = 0.5 * (rotor - stator + x)
    b = 0.5 * (rotor - stator - x)
    first = sums(square, limit, stator + a, a, y, theta)
    second = sums(square, limit, -stator - b, b, y, theta)
    return float(strength * (right * a * first[0] + left * b * second[0]))


@kernel
def comb(
    square: float, limit: float, stator: float, half: float, side: float, y: float, theta: float
) -> tuple[float, float, float, float, float]:
    r"""Return the derivatives of :math:`\ell\sum w_ir_i` by x, y and theta, then the middle and :math:`r` there.

    Multiplied by ``strength`` and :math:`V^2` they are force and torque: with the half length :math:`\ell` of the
    overlap and the points :math:`\xi_i=\pm[X_s+\ell(1+z_i)]`, :math:`d\ell/dx=\pm\tfrac12`.

    Parameters
    ----------
    square, limit, stator, half, y, theta : float
        As in ``sums``; ``stator`` is the distance of its tip.
    side : float
        +1 for the comb at +x, -1 for the comb at -x.
    """
    middle = side * (stator + half)
    whole, slope, first, r = sums(square, limit, middle, half, y, theta)
    doubled = half + half
    along = (0.5 * side) * whole + (theta * half) * (slope + side * first)
    return along, doubled * slope, doubled * (middle * slope + half * first), middle, r
