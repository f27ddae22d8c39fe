r"""Exact transition of a damped oscillator over one interval."""

from __future__ import annotations

import math

from core.block import kernel


@kernel
def transition(mass: float, damping: float, stiffness: float, h: float) -> tuple[float, float, float, float]:
    r"""Return the free transition matrix of :math:`m\ddot x+\beta\dot x+kx=0` over ``h``.

    .. math:: \Phi = e^{-\sigma h}
        \begin{bmatrix} c+\sigma s & s\\ -\omega_0^2 s & c-\sigma s\end{bmatrix},
        \quad \sigma=\frac{\beta}{2m},\; s=\frac{\sin\omega_d h}{\omega_d},\; c=\cos\omega_d h

    with hyperbolic functions beyond critical damping.

    Parameters
    ----------
    mass, damping, stiffness : float
        mg, uN ms/um, uN/um; the mass is positive.
    h : float
        Interval, ms.

    Returns
    -------
    tuple of float
        phi11, phi12 (ms), phi21 (1/ms), phi22.
    """
    sigma = damping / (2.0 * mass)
    square = stiffness / mass
    discriminant = square - sigma * sigma
    decay = math.exp(-sigma * h)
    if discriminant > 0.0:
        omega = math.sqrt(discriminant)
        c = math.cos(omega * h)
        s = math.sin(omega * h) / omega
    elif discriminant < 0.0:
        omega = math.sqrt(-discriminant)
        c = math.cosh(omega * h)
        s = math.sinh(omega * h) / omega
    else:
        c = 1.0
        s = h
    return decay * (c + sigma * s), decay * s, -square * decay * s, decay * (c - sigma * s)
